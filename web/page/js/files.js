// @ts-check
// Opens scenes from the user's disk: by a button, or dropped on the page. Nothing leaves the browser.

/** The size of all files together that are read at most, in bytes: 64 MiB. */
const MOST_BYTES = 64 * 2 ** 20;

/** Whether a scene of this name is a file, and none of the built-in ones. @param {string} name */
const isFileName = (name) => /\.(obj|ply|stl|gltf|glb|toml)$/i.test(name);

/** What is opened of files that come together: the one of the first kind that there is. The others are those that it names. */
const KINDS = [/\.toml$/i, /\.(gltf|glb)$/i, /\.(obj|ply|stl)$/i];

/** Some names, and how many more there are. @param {FoundFile[]} files */
function namesOf(files) {
  const names = files.slice(0, 3).map(({ path }) => path);
  return names.join(", ") + (files.length > names.length ? ` and ${files.length - names.length} more` : "");
}

/** In how many folders a file lies. @param {FoundFile} file */
const depthOf = ({ path }) => path.split("/").length;

/**
 * The file that is to be opened, or a text that says why none is. What lies in a folder is meant by what lies beside the folder.
 * @param {FoundFile[]} files
 * @returns {FoundFile | string}
 */
function chosenOf(files) {
  for (const kind of KINDS) {
    const alike = files.filter(({ path }) => kind.test(path));
    const outermost = Math.min(...alike.map(depthOf));
    const meant = alike.filter((file) => depthOf(file) === outermost);
    if (meant.length === 1) return meant[0];
    if (meant.length > 1)
      return `${namesOf(meant)}: which one? Open one of them with the files that it names, or a scene (.toml) that names them`;
  }
  return `${namesOf(files)}: this page opens meshes (.obj, .ply, .stl, .gltf, .glb) and .toml scenes, with the files that they name`;
}

/**
 * Opens one of some files; it may name the others.
 * @param {FoundFile[]} files
 * @param {string} [folder]  The folder that they are all the files of: it may have files that nobody needs.
 */
async function openFiles(files, folder) {
  if (files.length === 0) return folder ? showTrouble(`${folder}: there is no file in this folder`) : undefined;
  const chosen = chosenOf(files);
  if (typeof chosen === "string") return showTrouble(folder ? `${folder}: ${chosen}` : chosen);
  const size = files.reduce((sum, { file }) => sum + file.size, 0);
  if (size > MOST_BYTES) {
    const have = files.length === 1 ? "the file has" : `the ${files.length} files have`;
    showTrouble(
      `${folder ?? namesOf(files)}: ${have} ${grouped(size / 2 ** 20)} MiB, and this page reads at most ${MOST_BYTES / 2 ** 20} MiB; the program bothways takes more`,
    );
    return;
  }
  const { path: name } = chosen;
  try {
    const read = files.map(async ({ path, file }) => ({ name: path, bytes: await file.arrayBuffer() }));
    const what = { name, files: await Promise.all(read), folder: folder !== undefined };
    if (await openScene(what, { byHand: true, ...awaitedFor(name) })) showSceneChoice();
  } catch (error) {
    showTrouble(`${name}: ${messageOf(error)}`);
  }
}

/** Opens what is dropped: files, or a folder. @param {Promise<Dropped | null>[]} dropped */
async function openDropped(dropped) {
  try {
    const things = (await Promise.all(dropped)).filter((one) => one !== null);
    const folders = things.filter(({ children }) => children).map(({ name }) => name);
    await openFiles(await filesIn(things), folders.length > 0 ? folders.join(", ") : undefined);
  } catch (error) {
    showTrouble(messageOf(error));
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
    openFiles([...(input.files ?? [])].map((file) => ({ path: file.name, file })));
    input.value = "";
  });
  selectById("scene").addEventListener("change", async (event) => {
    const select = /** @type {HTMLSelectElement} */ (event.target);
    if (select.selectedOptions[0]?.dataset.own !== undefined) return;
    if (!(await openScene({ name: select.value }, { byHand: true }))) showSceneChoice();
  });
  const holdsFiles = (/** @type {DragEvent} */ event) => event.dataTransfer?.types.includes("Files");
  addEventListener("dragover", (event) => {
    if (!holdsFiles(event)) return;
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) document.body.classList.remove("dropping");
  });
  addEventListener("drop", (event) => {
    document.body.classList.remove("dropping");
    if (!holdsFiles(event)) return;
    event.preventDefault();
    if (event.dataTransfer) openDropped(droppedOf(event.dataTransfer));
  });
  watch(["scene", "own"], showSceneChoice);
  watch(["opened"], () => {
    const { opened } = state;
    if (opened)
      byId("scene-text").textContent =
        `${opened.sentence ?? opened.name} (${counted(opened.objects, "object")}, ${counted(opened.primitives, "primitive")})`;
  });
}
