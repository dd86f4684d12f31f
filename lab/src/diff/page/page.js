// What the reader may do, and what the page answers.

const [divider, groupList] = [byId("divider"), byId("groups")];
const lessMotion = matchMedia("(prefers-reduced-motion: reduce)");
const names = facts.sides.map((_, side) => document.querySelectorAll(".file")[side].textContent);
// Without their folders, unless those tell them apart.
const bare = names.map((name) => name.split(/[\\/]/).at(-1));
const captions = bare[0] === bare[1] ? names : bare;
const say = (text) => (byId("said").textContent = text);

// The read-out of one pixel.

function readOut(pixel) {
  const number = pixel && pixel[0] * width + pixel[1];
  const named = pixel && [facts.origin[0] + pixel[0], facts.origin[1] + pixel[1]];
  byId("place").textContent = pixel ? `row ${named[0]}, column ${named[1]}` : "point at one";
  ["a", "b"].forEach((side, index) => {
    byId(`value-${side}`).textContent = pixel ? pixelText(sides[index], number) : "–";
  });
  const reasons = pixel ? groupsAt(number) : [];
  byId("reasons").replaceChildren(...reasons.map(reasonItem));
  byId("why").hidden = !(facts.why && pixel);
  if (facts.why && pixel) byId("why").querySelector("code").textContent = `${facts.why} ${named.join(" ")}`;
  return reasons;
}

function reasonItem({ name, explanation, color }) {
  const item = document.createElement("li");
  const text = document.createElement("span");
  text.textContent = explanation ? `${name}: ${explanation}` : name;
  item.append(swatch(color), text);
  return item;
}

function swatch(color) {
  const swatch = document.createElement("span");
  swatch.className = "swatch";
  swatch.style.background = `rgb(${color.join(" ")})`;
  return swatch;
}

// Puts the cursor onto a pixel [row, column], and says what is there.
function pin(pixel, prefix = "") {
  shown.cursor = pixel;
  const reasons = readOut(pixel);
  const [row, column] = [facts.origin[0] + pixel[0], facts.origin[1] + pixel[1]];
  [byId("row").value, byId("column").value] = [row, column];
  const values = ["a", "b"].map((side) => `${side.toUpperCase()}: ${byId(`value-${side}`).textContent}`);
  const why = reasons.map(({ name }) => name).join(", ") || "no difference";
  say(`${prefix}row ${row}, column ${column}. ${values.join(". ")}. ${why}.`);
  draw();
}

// Makes the cursor visible in all panes.
function reveal([row, column], alwaysCentre) {
  const room = visiblePanes().map(({ canvas }) => [canvas.width, canvas.height]);
  const isNear = room.every(
    ([across, down]) =>
      Math.abs(column + 0.5 - view.x) * view.scale < across / 2 - 8 && Math.abs(row + 0.5 - view.y) * view.scale < down / 2 - 8,
  );
  if (alwaysCentre || !isNear) {
    view.fits = false;
    moveTo(column + 0.5, row + 0.5);
  }
}

// How to read the pictures, where their colours are not those of the files.
function noteText() {
  const [a, b] = ["a", "b"].map((side) => byId(`picture-${side}`).closest("figure").querySelector(".note")?.textContent);
  if (a === b) return a ? `A and B: ${a}.` : "";
  return [a && `A: ${a}.`, b && `B: ${b}.`].filter(Boolean).join(" ");
}

// Groups.

function listGroups() {
  groupList.replaceChildren(...groups.map(groupItem));
  document.querySelector(".legend").replaceChildren(...groups.map(reasonItem));
  if (!groups.length) groupList.textContent = "No pixel differs.";
}

function groupItem(group, number) {
  const item = document.createElement("li");
  const label = document.createElement("label");
  const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: true, id: `show-${number}` });
  const name = Object.assign(document.createElement("span"), { textContent: group.name });
  const count = Object.assign(document.createElement("span"), { className: "number", id: `count-${number}` });
  box.addEventListener("change", () => {
    group.shown = box.checked;
    filter();
  });
  label.append(box, swatch(group.color), name, count);
  item.append(label);
  if (group.explanation) {
    item.append(Object.assign(document.createElement("small"), { textContent: group.explanation, id: `about-${number}` }));
    box.setAttribute("aria-describedby", `about-${number}`);
  }
  return item;
}

function filter() {
  markGroups();
  groups.forEach(({ pixels }, number) => (byId(`count-${number}`).textContent = grouped(pixels.length)));
  showPosition();
  draw();
}

// Which of the marked pixels the cursor is on.
function showPosition() {
  const at = shown.cursor ? shown.cursor[0] * width + shown.cursor[1] : -1;
  let [all, before] = [0, 0];
  for (let pixel = 0; pixel < marked.length; pixel++) {
    if (!marked[pixel]) continue;
    all++;
    if (pixel <= at) before++;
  }
  const text = at >= 0 && marked[at] ? `${grouped(before)} of ${grouped(all)}` : `${grouped(all)} to see`;
  byId("position").textContent = groups.length ? text : "";
  byId("next").disabled = byId("previous").disabled = all === 0;
  return text;
}

// Jumps to the next marked pixel after the cursor, or before it; past the last comes the first.
function jump(step) {
  const count = marked.length;
  const start = shown.cursor ? shown.cursor[0] * width + shown.cursor[1] : step > 0 ? -1 : count;
  for (let away = 1; away <= count; away++) {
    const pixel = (((start + step * away) % count) + count) % count;
    if (!marked[pixel]) continue;
    const place = [Math.floor(pixel / width), pixel % width];
    const scale = SCALES.find((scale) => scale >= 16 * devicePixelRatio);
    if (view.scale < scale) zoomTo(scale, [view.x, view.y]);
    reveal(place, true);
    shown.cursor = place;
    pin(place, `${showPosition()}: `);
    return;
  }
}

// The divider, and the choice of views.

function divide(percent) {
  shown.divider = Math.min(100, Math.max(0, percent));
  const rounded = Math.round(shown.divider);
  divider.style.left = `${shown.divider}%`;
  divider.setAttribute("aria-valuenow", rounded);
  const text = { 0: "all of B", 100: "all of A" }[rounded] ?? `A on the left ${rounded} %, B on the right ${100 - rounded} %`;
  divider.setAttribute("aria-valuetext", text);
  draw();
}

function choose(name) {
  view.name = name;
  document.querySelector(`input[name="view"][value="${name}"]`).checked = true;
  document.querySelector(".panes").dataset.view = name;
  byId("blinking").hidden = name !== "blink";
  byId("beside").disabled = name === "pair" || name === "difference";
  divider.hidden = name !== "slider";
  if (name !== "blink") alternate(false);
  showSide(name === "blink" ? shown.side : 0);
  resize();
}

// Blinking.

let timer = 0;

function showSide(side) {
  shown.side = side;
  const isBlink = view.name === "blink";
  byId("main-left").textContent = isBlink ? "AB"[side] : "A";
  byId("main-right").hidden = isBlink;
  byId("main-left-name").textContent = captions[side];
  byId("main-right-name").textContent = isBlink ? "" : captions[1];
  byId("swap").textContent = `Show ${"BA"[side]}`;
  draw();
}

function alternate(plays) {
  clearInterval(timer);
  const mayPlay = plays && !lessMotion.matches;
  if (mayPlay) timer = setInterval(() => showSide(1 - shown.side), 1000 / Number(byId("rate").value));
  byId("play").setAttribute("aria-pressed", String(mayPlay));
  byId("play").textContent = mayPlay ? "Stop" : "Alternate";
}

const isPlaying = () => byId("play").getAttribute("aria-pressed") === "true";

function obeyMotion() {
  if (lessMotion.matches) alternate(false);
  byId("play").disabled = byId("rate").disabled = lessMotion.matches;
  byId("still").hidden = !lessMotion.matches;
}

// Hands on a picture: dragging moves, a click puts the cursor, two fingers and the wheel zoom.

function obeyPointer(pane) {
  const { canvas } = pane;
  const held = new Map();
  let [travelled, spread, wheel] = [0, 0, 0];
  const distance = () => {
    const [one, two] = [...held.values()];
    return Math.hypot(one.clientX - two.clientX, one.clientY - two.clientY);
  };
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, event);
    travelled = held.size > 1 ? Infinity : 0;
    if (held.size === 2) spread = distance();
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (!before) {
      const pixel = pixelAt(pane, event);
      readOut(pixel ?? shown.cursor);
      return;
    }
    held.set(event.pointerId, event);
    if (held.size === 2) {
      const steps = Math.trunc(4 * Math.log2(distance() / spread));
      if (steps) spread = distance();
      if (steps) zoomBy(Math.sign(steps), placeAt(pane, event));
      return;
    }
    const [right, down] = [event.clientX - before.clientX, event.clientY - before.clientY];
    travelled += Math.abs(right) + Math.abs(down);
    if (travelled < 5) return;
    canvas.classList.add("dragged");
    view.fits = false;
    const factor = devicePixelRatio / view.scale;
    moveTo(view.x - right * factor, view.y - down * factor);
  });
  const release = (event) => {
    if (!held.delete(event.pointerId)) return;
    canvas.classList.remove("dragged");
    const pixel = pixelAt(pane, event);
    if (event.type === "pointerup" && travelled < 5 && pixel) {
      pin(pixel);
      showPosition();
    }
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", () => readOut(shown.cursor));
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    wheel += event.deltaY * (event.deltaMode === 1 ? 33 : 1);
    if (Math.abs(wheel) < 50) return;
    zoomBy(-Math.sign(wheel), placeAt(pane, event));
    wheel = 0;
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => obeyArrows(event));
}

// The arrow keys move the cursor from pixel to pixel.
function obeyArrows(event) {
  const steps = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };
  const step = steps[event.key];
  if (!step || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  const [row, column] = shown.cursor ?? [Math.floor(view.y), Math.floor(view.x)].map((at) => at);
  const length = !shown.cursor ? 0 : event.shiftKey ? 10 : 1;
  const within = (at, side) => Math.min(side - 1, Math.max(0, at));
  const pixel = [within(row + length * step[0], height), within(column + length * step[1], width)];
  reveal(pixel, false);
  pin(pixel);
  showPosition();
}

function obeyDivider() {
  const follow = (event) => {
    const box = divider.parentElement.getBoundingClientRect();
    divide((100 * (event.clientX - box.left)) / box.width);
  };
  divider.addEventListener("pointerdown", (event) => {
    divider.setPointerCapture(event.pointerId);
    divider.focus();
    event.preventDefault();
  });
  divider.addEventListener("pointermove", (event) => divider.hasPointerCapture(event.pointerId) && follow(event));
  divider.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 10 : 1;
    const to = {
      ArrowLeft: shown.divider - step, ArrowDown: shown.divider - step, PageDown: shown.divider - 10,
      ArrowRight: shown.divider + step, ArrowUp: shown.divider + step, PageUp: shown.divider + 10,
      Home: 0, End: 100,
    }[event.key];
    if (to === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    divide(to);
  });
}

// Keys of the whole page.

const KEYS = {
  n: () => jump(1),
  p: () => jump(-1),
  "+": () => zoomBy(1),
  "=": () => zoomBy(1),
  "-": () => zoomBy(-1),
  0: fit,
  1: () => choose("slider"),
  2: () => choose("blink"),
  3: () => choose("pair"),
  4: () => choose("difference"),
  m: () => byId("marks").click(),
  d: () => byId("beside").click(),
  b: () => (view.name === "blink" ? showSide(1 - shown.side) : choose("blink")),
  "?": () => byId("help").showModal(),
};

function obeyKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || byId("help").open || !byId("letters").checked) return;
  if (event.target.matches('input[type="number"]')) return;
  if (event.key === " " && view.name === "blink" && !event.target.matches("button, input")) {
    event.preventDefault();
    alternate(!isPlaying());
    return;
  }
  const act = KEYS[event.key.toLowerCase()];
  if (!act) return;
  event.preventDefault();
  act();
}

function go(event) {
  event.preventDefault();
  const pixel = [byId("row").valueAsNumber - facts.origin[0], byId("column").valueAsNumber - facts.origin[1]];
  reveal(pixel, true);
  pin(pixel);
  showPosition();
}

function obey() {
  document.querySelectorAll('input[name="view"]').forEach((choice) => choice.addEventListener("change", () => choose(choice.value)));
  byId("zoom-in").addEventListener("click", () => zoomBy(1));
  byId("zoom-out").addEventListener("click", () => zoomBy(-1));
  byId("fit").addEventListener("click", fit);
  byId("swap").addEventListener("click", () => showSide(1 - shown.side));
  byId("play").addEventListener("click", () => alternate(!isPlaying()));
  byId("rate").addEventListener("input", () => {
    byId("rate-text").textContent = `${byId("rate").value} a second`;
    alternate(isPlaying());
  });
  byId("marks").addEventListener("change", () => {
    shown.marks = byId("marks").checked;
    draw();
  });
  byId("beside").addEventListener("change", () => {
    document.querySelector(".panes").classList.toggle("alone", !byId("beside").checked);
    resize();
  });
  byId("next").addEventListener("click", () => jump(1));
  byId("previous").addEventListener("click", () => jump(-1));
  byId("go").addEventListener("submit", go);
  byId("help-open").addEventListener("click", () => byId("help").showModal());
  document.addEventListener("keydown", obeyKey);
  lessMotion.addEventListener("change", obeyMotion);
  panes.forEach(obeyPointer);
  obeyDivider();
}

async function begin() {
  document.documentElement.classList.add("live");
  document.documentElement.style.setProperty("--aspect", `${width} / ${height}`);
  panes.forEach(({ name, figure }) => {
    if (name === "a" || name === "b") figure.querySelector(".name").textContent = captions["ab".indexOf(name)];
  });
  [["row", height, 0], ["column", width, 1]].forEach(([id, side, axis]) => {
    Object.assign(byId(id), { min: facts.origin[axis], max: facts.origin[axis] + side - 1 });
  });
  byId("notes").textContent = noteText();
  listGroups();
  obey();
  obeyMotion();
  divide(50);
  choose("slider");
  const observer = new ResizeObserver(resize);
  panes.forEach(({ canvas }) => observer.observe(canvas));
  await readPictures();
  draw();
  if (!("DecompressionStream" in globalThis)) {
    byId("notice").textContent = "This browser cannot unpack the values and the groups; a newer one can.";
    return;
  }
  await readGroups();
  filter();
  if (facts.omitted) byId("notice").textContent = facts.omitted;
  else await readValues();
  readOut(shown.cursor);
}

begin().then(
  () => (document.documentElement.dataset.ready = "yes"),
  (error) => {
    byId("notice").textContent = `The page cannot be shown in full: ${error.message}`;
    throw error;
  },
);
