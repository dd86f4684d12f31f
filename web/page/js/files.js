// @ts-check
// Opens scenes from the user's disk: by a button, or dropped on the page. Nothing leaves the browser.

/** The size of a file that is read at most, in bytes: 64 MiB. */
const LARGEST_FILE = 64 * 2 ** 20;

/** Whether a scene of this name is a file, and none of the built-in ones. @param {string} name */
const isFileName = (name) => /\.(obj|ply|stl|gltf|glb|toml)$/i.test(name);

/** @param {File} file */
async function openFile(file) {
  if (file.size > LARGEST_FILE) {
    showTrouble(
      `${file.name}: the file has ${grouped(file.size / 2 ** 20)} MiB, and this page reads at most ${LARGEST_FILE / 2 ** 20} MiB; the program bothways takes larger ones`,
    );
    return;
  }
  if (!isFileName(file.name)) {
    showTrouble(`${file.name}: this page opens meshes (.obj, .ply, .stl, .gltf, .glb) and .toml scenes`);
    return;
  }
  try {
    const bytes = await file.arrayBuffer();
    if (await openScene({ file: { name: file.name, bytes } }, { byHand: true, ...awaitedFor(file.name) }))
      showSceneChoice();
  } catch (error) {
    showTrouble(`${file.name}: ${messageOf(error)}`);
  }
}

/** The built-in scenes, and the file that is open. */
async function listScenes() {
  const scenes = await engine.call("scenes");
  selectById("scene").replaceChildren(
    ...scenes.map((/** @type {{name: string, sentence: string}} */ { name, sentence }) =>
      make("option", { value: name, title: sentence }, name),
    ),
  );
  showSceneChoice();
}

function showSceneChoice() {
  const select = selectById("scene");
  if (![...select.options].some(({ value }) => value === state.scene))
    select.append(make("option", { value: state.scene, "data-own": true }, state.scene));
  select.value = state.scene;
}

function beginFiles() {
  const input = inputById("file");
  byId("open-file").addEventListener("click", () => input.click());
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    if (file) openFile(file);
    input.value = "";
  });
  selectById("scene").addEventListener("change", async (event) => {
    const select = /** @type {HTMLSelectElement} */ (event.target);
    if (select.selectedOptions[0]?.dataset.own !== undefined) return;
    if (!(await openScene({ name: select.value }, { byHand: true }))) showSceneChoice();
  });
  const holdsFile = (/** @type {DragEvent} */ event) => event.dataTransfer?.types.includes("Files");
  addEventListener("dragover", (event) => {
    if (!holdsFile(event)) return;
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) document.body.classList.remove("dropping");
  });
  addEventListener("drop", (event) => {
    document.body.classList.remove("dropping");
    if (!holdsFile(event)) return;
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (file) openFile(file);
  });
  watch(["scene", "own"], showSceneChoice);
  watch(["opened"], () => {
    const { opened } = state;
    if (opened)
      byId("scene-text").textContent =
        `${opened.sentence ?? opened.name} (${counted(opened.objects, "object")}, ${counted(opened.primitives, "primitive")})`;
  });
}
