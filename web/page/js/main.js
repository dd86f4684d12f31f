// @ts-check
// Begins: the page's parts first, then the engine, then the scene that the address asks for.

async function begin() {
  beginTheme();
  measureBars();
  beginChapters();
  beginPictures();
  beginVerdict();
  beginCameraPanel();
  beginLoops();
  beginMicroscope();
  beginNeighbourhood();
  beginSharedEdge();
  beginOutside();
  beginBreaking();
  beginQuiz();
  beginQuestions();
  beginWork();
  beginFiles();
  beginSaving();
  beginKeys();
  beginDrawing();
  showChapter();
  await followLink();
  if (state.camera) await firstAnswer;
  document.documentElement.dataset.running = "yes";
  showPictures();
  await listScenes();
  listRules().catch((error) => console.warn(messageOf(error)));
  beginLinks();
}

begin().then(
  () => (document.documentElement.dataset.ready = "yes"),
  (error) => {
    showTrouble(`This page cannot run here: ${messageOf(error)}`);
    throw error;
  },
);
