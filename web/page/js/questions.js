// @ts-check
// The lecture's problems with random numbers: the engine makes the question, knows the answer and checks it.

/** The problems of the lecture, in its order. */
const QUESTION_KINDS = /** @type {const} */ ([
  ["ray", "1  A viewing ray"],
  ["plane", "2  Intersect a plane"],
  ["eye", "3  The eye elsewhere"],
  ["viewport", "4  vh ≠ vw ≠ 1"],
  ["distance", "5  d ≠ 1"],
  ["frame", "6  A turned frame"],
]);

/**
 * @typedef {object} Question
 * @property {string} title
 * @property {string[]} text
 * @property {{name: string, label: string}[]} fields
 * @property {string[]} hints
 * @property {Camera} [camera]
 * @property {number} [row]
 * @property {number} [column]
 */
/** @type {Question | null} */
let question = null;
/** Its kind and seed: what is asked once is asked no second time, and keeps what was typed. */
let asked = "";
let hintsGiven = 0;
/** @type {{outside: Outside, rays: ViewingRay[]} | null} */
let answerPicture = null;

async function askQuestion() {
  if (viewOf(state.chapter) !== "questions") return;
  const kind = state.question || QUESTION_KINDS[0][0];
  setChoice("question", kind);
  const wanted = `${kind} ${state.seed}`;
  if (wanted === asked) return;
  asked = wanted;
  /** @type {Question} */
  let answer;
  try {
    answer = await engine.call("question", { kind, seed: state.seed });
  } catch (error) {
    if (wanted === asked) asked = "";
    showTrouble(messageOf(error));
    return;
  }
  // Meanwhile another was asked for.
  if (wanted !== asked) return;
  question = answer;
  hintsGiven = 0;
  answerPicture = null;
  byId("question-picture").hidden = true;
  byId("question-verdict").textContent = "";
  byId("question-hints").replaceChildren();
  buttonById("question-hint").disabled = question.hints.length === 0;
  byId("question-text").replaceChildren(
    make("h3", {}, question.title),
    ...question.text.map((paragraph) => make("p", {}, paragraph)),
  );
  byId("question-fields").replaceChildren(...fieldRows(question.fields));
}

/**
 * A field for each number that is asked; those of one vector stand in one row.
 * @param {Question["fields"]} fields
 */
function fieldRows(fields) {
  /** @type {Map<string, HTMLElement>} */
  const rows = new Map();
  for (const { name, label: text } of fields) {
    const [, vector, axis] = /^(.+) ([xyz])$/.exec(text) ?? [null, text, ""];
    const input = make("input", {
      type: "text",
      inputmode: "text",
      autocomplete: "off",
      "data-field": name,
      "aria-label": text,
      spellcheck: "false",
      required: true,
      placeholder: axis || "−3/8",
    });
    const row = rows.get(vector) ?? make("div", { class: "field" }, make("span", {}, vector));
    row.append(input);
    rows.set(vector, row);
  }
  return rows.values();
}

const questionFields = () => /** @type {HTMLInputElement[]} */ ([...byId("question-fields").querySelectorAll("input")]);

/** @param {SubmitEvent} event */
async function checkQuestion(event) {
  event.preventDefault();
  if (!question) return;
  const fields = questionFields();
  try {
    const kind = state.question || QUESTION_KINDS[0][0];
    const {
      right,
      wrong = [],
      message = "",
    } = await engine.call("check", { kind, seed: state.seed, values: fields.map(({ value }) => value.trim()) });
    fields.forEach((field, index) =>
      wrong.includes(index) ? field.setAttribute("aria-invalid", "true") : field.removeAttribute("aria-invalid"),
    );
    const verdict = byId("question-verdict");
    verdict.className = right ? "right" : "wrong";
    verdict.textContent = message || (right ? "Right." : "Not yet: look at what is marked.");
    if (right) showAnswer();
  } catch (error) {
    const verdict = byId("question-verdict");
    verdict.className = "wrong";
    verdict.textContent = messageOf(error);
  }
}

function giveHint() {
  if (!question || hintsGiven >= question.hints.length) return;
  const hint = make("li", {}, question.hints[hintsGiven]);
  byId("question-hints").append(hint);
  hintsGiven++;
  say(`hint ${hintsGiven}: ${hint.textContent}`);
  buttonById("question-hint").disabled = hintsGiven === question.hints.length;
}

/** The picture that shows the answer: the question's camera with the ray that was asked for. */
async function showAnswer() {
  if (!question?.camera || question.row === undefined || question.column === undefined) return;
  const { camera, row, column } = question;
  const kind = state.question || QUESTION_KINDS[0][0];
  try {
    const place = { kind, seed: state.seed, camera };
    answerPicture = {
      outside: await engine.call("outside", place),
      rays: (await engine.call("rays", { ...place, row, column })).rays,
    };
  } catch {
    return;
  }
  byId("question-picture").hidden = false;
  requestAnimationFrame(drawAnswer);
}

function drawAnswer() {
  if (!answerPicture || !question?.camera || byId("question-picture").hidden) return;
  const prepared = prepareCanvas(canvasById("question-canvas"));
  if (!prepared) return;
  const { context, width, height } = prepared;
  const { outside, rays } = answerPicture;
  const target = rays[0]?.point ?? add(outside.eye, scaled(outside.w, -1.2 * outside.d));
  const observer = besideCamera(outside, target);
  // A question has planes at most, which hide nothing here.
  const drawing = { context, map: stageMap(observer, width, height), surface: null };
  drawObjects(drawing, outside, observer);
  drawRays(
    drawing,
    rays.map((ray) => drawnRay(outside, ray)),
    true,
  );
  drawCamera(drawing, outside, question.camera, [question.row ?? 0, question.column ?? 0], 0.16 * observer.size);
}

function beginQuestions() {
  byId("question-kinds").append(
    ...QUESTION_KINDS.map(([value, text]) =>
      make("label", {}, make("input", { type: "radio", name: "question", value }), make("span", {}, text)),
    ),
  );
  onChoice("question", (value) => change({ question: value }));
  byId("question-form").addEventListener("submit", checkQuestion);
  byId("question-hint").addEventListener("click", giveHint);
  byId("question-new").addEventListener("click", () => change({ seed: newSeed() }));
  drawWhenShown(canvasById("question-canvas"), drawAnswer);
  watch(["chapter", "question", "seed"], askQuestion);
}
