// @ts-check
// The chapters, in the lecture's order: each has a title, a sentence, a view, and the scene that it is about.

/** @typedef {"pictures" | "loops" | "pixel" | "edge" | "outside" | "break" | "quiz" | "questions" | "work"} View */

/**
 * @typedef {object} Chapter
 * @property {string} id
 * @property {string} title
 * @property {string} brief  For the list of chapters.
 * @property {string} text
 * @property {View} view
 * @property {string} [scene]
 * @property {Partial<State>} [state]  What else the chapter begins with.
 */

/** @type {Chapter[]} */
const CHAPTERS = [
  {
    id: "algorithms",
    title: "Two rendering algorithms",
    brief: "The same two loops, swapped.",
    view: "pictures",
    scene: "lecture",
    text: "Both are the same two loops, swapped: object order walks the objects and asks for pixels, image order walks the pixels and asks for objects.",
  },
  {
    id: "loops",
    title: "The loops, step by step",
    brief: "One pair of an object and a pixel a step.",
    view: "loops",
    scene: "canonical",
    state: { method: "textbook", loops: "both" },
    text: "One step tests one pair of an object and a pixel. Where every pair is tested, both loops make the same tests, in another order.",
  },
  {
    id: "projection",
    title: "We lose a dimension",
    brief: "Perspective, or parallel.",
    view: "outside",
    scene: "canonical",
    state: { rays: "all" },
    text: "The world is 3D, and images are 2D. In perspective all viewing rays begin at the eye; in parallel projection all have the same direction.",
  },
  {
    id: "ray",
    title: "The viewing ray of a pixel",
    brief: "From pixel (i, j) to *p* + t *d*.",
    view: "pixel",
    scene: "canonical",
    text: "A ray is half a line: an origin *p*, a direction *d*, and *r*(t) = *p* + t *d* for t > 0. Of all that it meets, the object with the smallest t is seen.",
  },
  {
    id: "problems",
    title: "Problems, in groups",
    brief: "Rays by hand, checked.",
    view: "questions",
    text: "Generate a viewing ray, intersect it with a plane, then take away one assumption about the camera after the other.",
  },
  {
    id: "frame",
    title: "Pointing the camera elsewhere",
    brief: "The frame *u*, *v*, *w*.",
    view: "outside",
    scene: "lecture",
    state: { rays: "row" },
    text: "The camera's pose is a frame: *u* points right, *v* up, *w* back. The ray has origin = eye and direction = x *u* + y *v* − d *w*.",
  },
  {
    id: "coverage",
    title: "Which samples a triangle owns",
    brief: "A shared edge has one owner.",
    view: "edge",
    text: "A triangle covers a pixel if it covers its middle. A sample exactly on a shared edge, between its ends, belongs to exactly one of the two triangles.",
  },
  {
    id: "nearest",
    title: "The nearest along the ray",
    brief: "Edge functions, t, and ties.",
    view: "pixel",
    scene: "ties",
    text: "Edge functions say what covers the sample, t says what is nearest. Here edges and vertices lie exactly on samples.",
  },
  {
    id: "skip",
    title: "Skipping work",
    brief: "Bounding boxes, and a hierarchy.",
    view: "loops",
    scene: "canonical",
    state: { method: "hierarchy", loops: "both" },
    text: "Each order skips its own inner loop: object order skips pixels outside of a bounding box, image order skips objects whose boxes the ray misses.",
  },
  {
    id: "cost",
    title: "Work and cost",
    brief: "More triangles, more pixels.",
    view: "work",
    text: "Every test is counted by observers of the loops that draw. More triangles and more pixels cost each order differently.",
  },
  {
    id: "break",
    title: "Break it",
    brief: "Ordinary rules, and their pixels.",
    view: "break",
    scene: "ties",
    state: { objectRule: "inclusive" },
    text: "Ordinary renderers follow simpler rules. Give one to either order, and see which pixels it gets wrong, and why.",
  },
  {
    id: "quiz",
    title: "What did this renderer do wrong?",
    brief: "One mistake: which?",
    view: "quiz",
    text: "One rule of this renderer is not the exact one. Its picture tells which.",
  },
];

/** @param {string} id */
const chapterOf = (id) => CHAPTERS.find((chapter) => chapter.id === id) ?? CHAPTERS[0];
/** @param {string} id @returns {View} */
const viewOf = (id) => chapterOf(id).view;

/** Views without the scene that is open: they have no use for its camera. */
const WITHOUT_SCENE = new Set(["edge", "quiz", "questions", "work"]);

/**
 * Turns to a chapter, with the scene that it is about, unless the user has chosen one.
 * @param {string} id
 */
async function visit(id) {
  const chapter = chapterOf(id);
  closeChapters();
  stopPlaying();
  change({ chapter: chapter.id, step: 0, ...chapter.state });
  if (chapter.scene && chapter.scene !== askedScene && !state.byHand) await openScene({ name: chapter.scene });
  say(`chapter ${CHAPTERS.indexOf(chapter) + 1}: ${chapter.title}`);
}

/** @param {number} by */
function turnChapter(by) {
  const place = CHAPTERS.findIndex(({ id }) => id === state.chapter) + by;
  if (place >= 0 && place < CHAPTERS.length) {
    visit(CHAPTERS[place].id);
    scrollTo({ top: 0 });
  }
}

function closeChapters() {
  byId("chapters").classList.remove("open");
  byId("chapters-open").setAttribute("aria-expanded", "false");
}

let cameraShownFor = "";

function showChapter() {
  const chapter = chapterOf(state.chapter);
  const place = CHAPTERS.indexOf(chapter);
  byId("chapter-title").textContent = chapter.title;
  byId("chapter-text").replaceChildren(...rich(chapter.text));
  byId("chapter-place").textContent = `${place + 1}/${CHAPTERS.length}  ${chapter.title}`;
  document.title = `${chapter.title} · object order and image order`;
  for (const view of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll(".view")))
    view.hidden = view.id !== `view-${chapter.view}`;
  byId("camera").hidden = WITHOUT_SCENE.has(chapter.view);
  if (chapter.id !== cameraShownFor)
    /** @type {HTMLDetailsElement} */ (byId("camera")).open = chapter.view === "pictures" || chapter.view === "outside";
  cameraShownFor = chapter.id;
  for (const link of document.querySelectorAll("#chapters a")) {
    if (/** @type {HTMLElement} */ (link).dataset.chapter === chapter.id) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
  buttonById("previous-chapter").disabled = place === 0;
  buttonById("next-chapter").disabled = place === CHAPTERS.length - 1;
  const about = byId("chapter-scene");
  // The other views make the same point with any scene.
  about.hidden = chapter.view !== "pixel" || chapter.scene === state.scene || !state.opened;
  if (!about.hidden && chapter.scene) {
    /** @type {HTMLElement} */ (about.querySelector("span")).textContent =
      `You look at ${state.scene}; this chapter was written about another scene.`;
    /** @type {HTMLElement} */ (about.querySelector("button")).textContent = `Open ${chapter.scene}`;
  }
}

function beginChapters() {
  /** @type {HTMLElement} */ (document.querySelector("#chapters ol")).append(
    ...CHAPTERS.map(({ id, title, brief }) => {
      const link = make("a", { href: `#chapter=${id}`, "data-chapter": id }, title, make("small", {}, ...rich(brief)));
      link.addEventListener("click", (event) => {
        event.preventDefault();
        visit(id);
      });
      return make("li", {}, link);
    }),
  );
  byId("previous-chapter").addEventListener("click", () => turnChapter(-1));
  byId("next-chapter").addEventListener("click", () => turnChapter(1));
  byId("chapters-open").addEventListener("click", () => {
    const open = byId("chapters").classList.toggle("open");
    byId("chapters-open").setAttribute("aria-expanded", String(open));
  });
  byId("chapter-scene").addEventListener("click", (event) => {
    const { scene } = chapterOf(state.chapter);
    if (scene && event.target instanceof HTMLButtonElement)
      openScene({ name: scene }).then(() => change({ byHand: false }));
  });
  watch(["chapter", "scene", "opened"], showChapter);
}
