// @ts-check
// The quiz: what did this renderer do wrong? The engine plants the mistake, and knows it.

/** @typedef {{rgba: Uint8ClampedArray}} QuizPicture */
/**
 * @typedef {object} Quiz
 * @property {QuizPicture} truth
 * @property {QuizPicture} renderer
 * @property {QuizPicture} difference
 * @property {string[]} choices
 * @property {number} height
 * @property {number} width
 */
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
  byId("quiz-answer").textContent = byId("quiz-finder").textContent = "";
  byId("quiz-finder-ask").hidden = true;
  byId("quiz-choices").replaceChildren(
    ...quiz.choices.map((text, index) =>
      make(
        "label",
        {},
        make("input", { type: "radio", name: "quiz", value: index, required: true }),
        make("span", {}, text),
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
    if (right) byId("quiz-finder-ask").hidden = false;
    byId("quiz-score").textContent = `${quizRight} of ${quizAsked} right at once`;
  } catch (error) {
    showTrouble(messageOf(error));
  }
}

/** What the convention finder makes of the same picture: it knows only the picture and the scene. */
async function askQuizFinder() {
  const { seed } = state;
  byId("quiz-finder-ask").hidden = true;
  const holder = byId("quiz-finder");
  holder.textContent = "It draws the picture under hundreds of conventions; this takes some seconds …";
  try {
    const { sentence } = await engine.call("quizFinder", { seed });
    if (seed === state.seed) holder.textContent = sentence;
  } catch (error) {
    holder.textContent = messageOf(error);
  }
}

function beginQuiz() {
  byId("quiz-finder-ask").addEventListener("click", askQuizFinder);
  byId("quiz-form").addEventListener("submit", answerQuiz);
  byId("quiz-new").addEventListener("click", () => change({ seed: newSeed() }));
  const ask = () => {
    if (viewOf(state.chapter) === "quiz") askQuiz(state.seed);
  };
  watch(["chapter", "seed"], ask);
}

/** A number that chooses a question: it stands in the link, so that all can have the same. */
const newSeed = () => 1 + Math.floor(Math.random() * 9999);
