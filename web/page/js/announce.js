// @ts-check
// Tells screen readers what has changed, once it has come to rest.

let toSay = "";
const sayNow = debounced(700, () => {
  byId("said").textContent = toSay;
});

/** @param {string} text */
function say(text) {
  toSay = text;
  sayNow();
}

/**
 * Shows what went wrong, as the command line would say it; an empty text takes it away.
 * @param {string} text
 */
function showTrouble(text) {
  const trouble = byId("trouble");
  if (trouble.textContent !== text) trouble.textContent = text;
  trouble.hidden = text === "";
}

/** @param {unknown} error */
const messageOf = (error) => (error instanceof Error ? error.message : String(error));
