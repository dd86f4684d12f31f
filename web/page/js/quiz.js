// @ts-check
// The quiz: what did this renderer do wrong? The engine plants the mistake, and knows it.

/** @typedef {{truth: {rgba: Uint8ClampedArray}, renderer: {rgba: Uint8ClampedArray}, difference: {rgba: Uint8ClampedArray}, choices: string[], height: number, width: number}} Quiz */
/** @type {Quiz | null} */
let quiz = null;
let [quizRight, quizAsked, quizAnswered] = [0, 0, false];

/** @param {number} seed */
async function askQuiz(seed) {
  try {
    quiz = await engine.call("quiz", { seed });
  } catch (error) {
    showTrouble(messageOf(error));
    return;
  }
  if (!quiz) return;
  quizAnswered = false;
  byId("quiz-answer").textContent = "";
  byId("quiz-choices").replaceChildren(
    ...quiz.choices.map((text, index) =>
      make(
        "label",
        {},
        make("input", { type: "radio", name: "quiz", value: index, required: true }),
        // What stands in parentheses is about the command line.
        make("span", {}, text.replaceAll(/ \([^)]*\)/g, "")),
      ),
    ),
  );
  drawQuiz();
}

function drawQuiz() {
  if (!quiz) return;
  const { width, height } = quiz;
  for (const [id, { rgba }] of /** @type {const} */ ([
    ["quiz-truth", quiz.truth],
    ["quiz-drawn", quiz.renderer],
    ["quiz-difference", quiz.difference],
  ])) {
    const canvas = canvasById(id);
    canvas.style.setProperty("--form", String(width / height));
    canvas.style.imageRendering = "pixelated";
    paintPixels(canvas, rgba, width, height);
  }
}

/** @param {SubmitEvent} event */
async function answerQuiz(event) {
  event.preventDefault();
  const choice = /** @type {HTMLInputElement | null} */ (document.querySelector("input[name=quiz]:checked"));
  if (!choice || !quiz) return;
  try {
    const { right, sentence } = await engine.call("answer", { seed: state.seed, choice: Number(choice.value) });
    const answer = byId("quiz-answer");
    answer.className = right ? "right" : "wrong";
    answer.textContent = `${right ? "Right." : "Not this."} ${sentence}`;
    if (!quizAnswered) {
      quizAsked++;
      if (right) quizRight++;
      quizAnswered = true;
    }
    byId("quiz-score").textContent = `${quizRight} of ${quizAsked} right at once`;
  } catch (error) {
    showTrouble(messageOf(error));
  }
}

function beginQuiz() {
  byId("quiz-form").addEventListener("submit", answerQuiz);
  byId("quiz-new").addEventListener("click", () => change({ seed: newSeed() }));
  const ask = () => {
    if (viewOf(state.chapter) === "quiz") askQuiz(state.seed);
  };
  watch(["chapter", "seed"], ask);
}

/** A number that chooses a question: it stands in the link, so that all can have the same. */
const newSeed = () => 1 + Math.floor(Math.random() * 9999);
