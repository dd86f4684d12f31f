// @ts-check
// The view of the steps: play, pause, step on and back, scrub; both loops on one clock of work.

/** @type {Record<OrderName, Half>} */
let halves;
/** The total of the clock: the longer of both records. */
let clockEnd = 0;
/** What is recorded now. */
let recordedFor = "";
let playing = false;

const shownOrders = () => /** @type {OrderName[]} */ (state.loops === "both" ? ["object", "image"] : [state.loops]);
const loopsAreShown = () => viewOf(state.chapter) === "loops";

/** Whether a record is being made, and whether that takes more than a moment. */
let [recording, recordingLong] = [false, false];

/** The records of one scene and camera, so that the ways of testing change at once, by what each skips. */
const recorded = { subject: "", records: /** @type {Map<string, Recording>} */ (new Map()) };

/** What is to be recorded; `key` is all that it depends on. */
function wantedRecord() {
  const size = state.stepsSize;
  const camera = { ...state.camera, height: size, width: size, vw: state.camera?.vh };
  const subject = JSON.stringify([sceneKey(), camera]);
  return { key: `${subject} ${state.method}`, subject, camera, size, kind: state.method };
}

/** What one order skips: image order has no use for bounding boxes, and object order none for a hierarchy. */
const skips = (/** @type {OrderName} */ order, /** @type {State["method"]} */ kind) =>
  kind === "textbook" || (kind === "boxes" && order === "image") ? "every pair" : `fewer in ${order} order`;

/** Records the loops, if they were not. */
async function record() {
  if (!loopsAreShown() || !state.camera || !state.opened || scenesOpening > 0) return;
  if (wantedRecord().key === recordedFor) return;
  recordedFor = wantedRecord().key;
  // What is no longer wanted is given up where it takes long. The record that runs begins anew by itself.
  if (recordingLong) recorder.stop();
  if (recording) return;
  recording = true;
  let key = "";
  while (key !== recordedFor) {
    key = recordedFor;
    recordingLong = false;
    const { records, trouble } = await recordBoth(wantedRecord());
    if (key === recordedFor) load(records, trouble);
  }
  [recording, recordingLong] = [false, false];
  byId("recording").hidden = true;
}

/** @param {ReturnType<typeof wantedRecord>} what @returns {Promise<{records: Recording[], trouble: string}>} */
async function recordBoth({ subject, camera, size, kind }) {
  if (recorded.subject !== subject) recorded.records.clear();
  recorded.subject = subject;
  /** How far each order is: the steps done, and all. @type {Map<OrderName, [number, number]>} */
  const progress = new Map();
  const recordOne = async (/** @type {OrderName} */ order) => {
    const key = `${order} ${skips(order, kind)}`;
    const before = recorded.records.get(key);
    if (before) return before;
    const steps = await recorder.steps({ order, kind, height: size, width: size, camera }, (done, of) => {
      progress.set(order, [done, of]);
      showRecording(progress);
    });
    progress.set(order, [steps.count, steps.count]);
    const record = new Recording(steps, order, size);
    if (recorded.subject === subject) recorded.records.set(key, record);
    return record;
  };
  try {
    return { records: await Promise.all([recordOne("object"), recordOne("image")]), trouble: "" };
  } catch (error) {
    // The other order alone is of no use.
    if (recordingLong) recorder.stop();
    return { records: [], trouble: messageOf(error) };
  }
}

/** @param {Recording[]} records  Both, or none. @param {string} trouble */
function load([object, image], trouble) {
  halves.object.load(object ?? null);
  halves.image.load(image ?? null);
  halves.object.background = image ? backgroundOf(image.steps) : null;
  clockEnd = image ? Math.max(object.steps.count, image.steps.count) : 0;
  // The chapter about hierarchies says it itself.
  const note = state.chapter === "skip" && state.method === "hierarchy" ? "" : METHOD_NOTES[state.method];
  noteSteps(image ? note : trouble);
  inputById("scrub").max = inputById("step").max = String(clockEnd);
  byId("steps-total").textContent = `of ${grouped(clockEnd)}`;
  byId("step").style.setProperty("--digits", String(String(clockEnd).length));
  change({ step: clamp(state.step, 0, clockEnd) });
  // What cannot be recorded is not shown half.
  byId("halves").hidden = clockEnd === 0;
  byId("transport").inert = false;
  drawMarks();
  showStep();
}

/**
 * Shows how far a record is that takes more than a moment.
 * @param {Map<OrderName, [number, number]>} progress
 */
function showRecording(progress) {
  const [done, of] = [0, 1].map((place) => [...progress.values()].reduce((sum, one) => sum + one[place], 0));
  if (!recordingLong) {
    stopPlaying();
    noteSteps("");
    say(`recording the steps of both orders`);
  }
  recordingLong = true;
  byId("halves").hidden = true;
  byId("transport").inert = true;
  byId("recording").hidden = false;
  /** @type {HTMLProgressElement} */ (byId("recording-progress")).value = done / of;
  byId("recording-text").textContent = `Recording both orders: ${grouped(done)} of ${grouped(of)} steps`;
}

/** What each order skips. */
const METHOD_NOTES = {
  textbook: "",
  boxes:
    "Object order asks only for the pixels within an object's bounding box. Image order has no use for that: it still tests every pair.",
  hierarchy:
    "Object order keeps to bounding boxes. Image order walks a hierarchy of boxes, and skips all that is in a box that its ray misses.",
};

/** @param {string} text */
function noteSteps(text) {
  byId("steps-note").textContent = text;
  byId("steps-note").hidden = text === "";
}

function showStep() {
  if (!loopsAreShown()) return;
  const step = clamp(state.step, 0, clockEnd);
  inputById("scrub").value = String(step);
  inputById("scrub").setAttribute("aria-valuetext", `step ${step} of ${clockEnd}`);
  if (document.activeElement !== byId("step") || playing) inputById("step").value = String(step);
  for (const order of shownOrders()) halves[order].show(step);
  if (!playing) {
    const texts = shownOrders().map((order) => `${ORDERS[order][0]}: ${halves[order].words.textContent}`);
    say(`step ${step} of ${clockEnd}. ${texts.join(" ")}`);
  }
}

/** Where each object, or each row, begins: object order above, image order below. */
function drawMarks() {
  const prepared = prepareCanvas(canvasById("marks"));
  if (!prepared || clockEnd === 0) return;
  const { context, width, height } = prepared;
  const shown = shownOrders();
  shown.forEach((order, place) => {
    const marks = halves[order].record?.steps.marks ?? [];
    // Where marks are closer than the screen can show, they say nothing.
    if (marks.length > width / 3) return;
    context.fillStyle = colour(order);
    const [top, part] = [(place * height) / shown.length, height / shown.length];
    // The thumb of the slider never reaches the ends: half its width stays free.
    for (const mark of marks) context.fillRect(8 + ((width - 16) * mark) / clockEnd, top, 1.5, part - 1);
  });
}

/** @param {number} by */
function stepBy(by) {
  if (recordingLong) return;
  stopPlaying();
  change({ step: clamp(state.step + by, 0, clockEnd) });
}

/** The next place at which an object or a row begins. @param {1 | -1} way */
function toMark(way) {
  if (recordingLong) return;
  stopPlaying();
  const marks = shownOrders()
    .flatMap((order) => [...(halves[order].record?.steps.marks ?? [])])
    .sort((one, other) => one - other);
  const next =
    way > 0
      ? (marks.find((mark) => mark > state.step) ?? clockEnd)
      : (marks.filter((mark) => mark < state.step).pop() ?? 0);
  change({ step: next });
}

function stopPlaying() {
  if (!playing) return;
  playing = false;
  byId("play").textContent = "Play";
  byId("play").setAttribute("aria-pressed", "false");
}

function togglePlaying() {
  if (playing) {
    stopPlaying();
    showStep();
    return;
  }
  if (clockEnd === 0 || recordingLong) return;
  playing = true;
  byId("play").textContent = "Pause";
  byId("play").setAttribute("aria-pressed", "true");
  if (state.step >= clockEnd) change({ step: 0 });
  let [before, owed] = [performance.now(), 0];
  const tick = (/** @type {number} */ now) => {
    if (!playing) return;
    const speed = Number(selectById("speed").value) || clockEnd / 10;
    owed += (Math.max(0, now - before) / 1000) * speed;
    before = now;
    const steps = Math.floor(owed);
    owed -= steps;
    if (steps > 0) change({ step: Math.min(clockEnd, state.step + steps) });
    if (state.step >= clockEnd) stopPlaying();
    else requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

function showHalves() {
  const orders = shownOrders();
  for (const order of /** @type {OrderName[]} */ (["object", "image"])) {
    halves[order].root.hidden = !orders.includes(order);
    halves[order].root.classList.toggle("alone", orders.length === 1);
  }
  byId("halves").classList.toggle("alone", orders.length === 1);
  setChoice("loops", state.loops);
  setChoice("method", state.method);
  selectById("steps-size").value = String(state.stepsSize);
  requestAnimationFrame(drawMarks);
  showStep();
}

/** Turns one order into the other: the two lines that begin the loops change places, and nothing else. */
function swapLoops() {
  const from = state.loops === "both" ? "object" : state.loops;
  const to = from === "object" ? "image" : "object";
  const lead = state.loops === "both";
  change({ loops: from });
  const turn = () => {
    const places = [...halves[from].code.children].map((item) => item.getBoundingClientRect().top);
    change({ loops: to });
    // After the watchers have shown the other half.
    requestAnimationFrame(() => {
      if (lessMotion.matches) return;
      const items = [...halves[to].code.children];
      const here = items.map((item) => item.getBoundingClientRect().top);
      [
        [0, 1],
        [1, 0],
      ].forEach(([now, before]) => {
        const shift = places[before] - here[now];
        // They pass each other: the one that moves up swings out to the right.
        const [indent, swing] = now === 0 ? [1.1, 3] : [-1.1, -0.5];
        items[now].animate(
          [
            { transform: `translate(${indent}em, ${shift}px)` },
            { transform: `translate(${swing}em, ${shift / 2}px)` },
            { transform: "none" },
          ],
          { duration: 1000, easing: "ease-in-out" },
        );
      });
      halves[to].canvas.animate([{ opacity: 0.25 }, { opacity: 1 }], { duration: 900 });
    });
  };
  if (lead && !lessMotion.matches) setTimeout(turn, 450);
  else requestAnimationFrame(turn);
  say(`the loops are swapped: ${ORDERS[to][0]}`);
}

function beginLoops() {
  halves = { object: new Half("object"), image: new Half("image") };
  byId("halves").append(halves.object.root, halves.image.root);
  onChoice("loops", (value) => change({ loops: /** @type {State["loops"]} */ (value) }));
  onChoice("method", (value) => change({ method: /** @type {State["method"]} */ (value) }));
  selectById("steps-size").addEventListener("change", (event) =>
    change({ stepsSize: Number(/** @type {HTMLSelectElement} */ (event.target).value) }),
  );
  byId("swap").addEventListener("click", swapLoops);
  byId("play").addEventListener("click", togglePlaying);
  byId("to-start").addEventListener("click", () => stepBy(-clockEnd));
  byId("to-end").addEventListener("click", () => stepBy(clockEnd));
  byId("step-back").addEventListener("click", () => stepBy(-1));
  byId("step-on").addEventListener("click", () => stepBy(1));
  inputById("scrub").addEventListener("input", (event) => {
    stopPlaying();
    change({ step: Number(/** @type {HTMLInputElement} */ (event.target).value) });
  });
  inputById("step").addEventListener("change", (event) => {
    stopPlaying();
    const { valueAsNumber } = /** @type {HTMLInputElement} */ (event.target);
    change({ step: clamp(Math.round(valueAsNumber) || 0, 0, clockEnd) });
  });
  drawWhenShown(canvasById("marks"), drawMarks);
  watch(["step"], showStep);
  watch(["loops"], showHalves);
  watch(["chapter", "method", "stepsSize"], showHalves);
  watch(["chapter", "scene", "camera", "method", "stepsSize"], record);
  // The scene before takes room in the recorder, and is of no use there.
  watch(["opened"], () => {
    if (!recording) recorder.stop();
  });
}
