// @ts-check
// Light and dark, and the colours for what is drawn on a canvas.

const prefersDark = matchMedia("(prefers-color-scheme: dark)");
/** @type {"light" | "dark" | null} */
let chosenTheme = null;

const isDark = () => (chosenTheme ? chosenTheme === "dark" : prefersDark.matches);

function applyTheme() {
  document.documentElement.dataset.theme = isDark() ? "dark" : "light";
  byId("theme").textContent = isDark() ? "Light" : "Dark";
  drawnColours.clear();
  document.dispatchEvent(new Event("themechange"));
}

function toggleTheme() {
  chosenTheme = isDark() ? "light" : "dark";
  applyTheme();
}

/** @type {Map<string, string>} */
const drawnColours = new Map();

/**
 * A colour of the page, by the name of its custom property.
 * @param {string} name
 */
function colour(name) {
  let value = drawnColours.get(name);
  if (!value) {
    value = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
    drawnColours.set(name, value);
  }
  return value;
}

/** Large type for the lecture room. */
function togglePresenting() {
  const root = document.documentElement;
  const presenting = root.dataset.presenting === undefined;
  if (presenting) root.dataset.presenting = "yes";
  else delete root.dataset.presenting;
  byId("present").setAttribute("aria-pressed", String(presenting));
  if (presenting) root.requestFullscreen?.().catch(() => {});
  else if (document.fullscreenElement) document.exitFullscreen().catch(() => {});
  document.dispatchEvent(new Event("themechange"));
  say(presenting ? "presenter mode: Page Down and Page Up turn the chapters, f leaves it" : "presenter mode is off");
}

function beginTheme() {
  applyTheme();
  byId("theme").addEventListener("click", toggleTheme);
  byId("present").addEventListener("click", togglePresenting);
  prefersDark.addEventListener("change", applyTheme);
  // Escape leaves the full screen, and with it the mode.
  document.addEventListener("fullscreenchange", () => {
    if (!document.fullscreenElement && document.documentElement.dataset.presenting !== undefined) togglePresenting();
  });
}
