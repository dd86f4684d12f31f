// @ts-check
// The camera as sliders and number fields, in the lecture's terms.

/** @typedef {{slider: HTMLInputElement, number: HTMLInputElement, read: (camera: Camera) => number}} Dial */
/** @type {Dial[]} */
const dials = [];

/**
 * A slider and a number field for one number of the camera.
 * @param {string} label
 * @param {string} words  For screen readers.
 * @param {(camera: Camera) => number} read
 * @param {(camera: Camera, value: number) => Partial<Camera>} write
 * @param {{least?: number}} [options]
 */
function dial(label, words, read, write, { least } = {}) {
  const slider = make("input", { type: "range", step: "any", "aria-label": `${words}, slider` });
  const number = make("input", { type: "number", step: "any", "aria-label": words });
  if (least !== undefined) slider.min = number.min = String(least);
  dials.push({ slider, number, read });
  slider.addEventListener("input", () => {
    if (state.camera) moveCamera(write(state.camera, Number(slider.value)));
  });
  number.addEventListener("change", () => {
    if (state.camera && number.value !== "" && number.validity.valid)
      moveCamera(write(state.camera, number.valueAsNumber));
    else showCamera();
  });
  return make("div", { class: "dial" }, make("span", {}, label), slider, number);
}

/** The sliders get room around the values of the scene that is open. */
function rangeDials() {
  const { camera } = state.opened ?? {};
  if (!camera) return;
  const away = Math.max(4, 2.5 * lengthOf(subtract(camera.eye, pivotOf(camera))));
  for (const { slider, read } of dials) {
    const value = Math.abs(read(camera));
    const isSize = slider.min === "0.01";
    const most = isSize
      ? Math.max(3, 3 * value)
      : Math.max(slider.dataset.range === "turn" ? Math.max(1, lengthOf(camera.direction)) : away, value);
    if (!isSize) slider.min = String(-most);
    slider.max = String(most);
  }
}

/** Shows the camera's numbers, ten times a second at most: while a pointer drags, nobody reads more. */
const showCamera = seldom(100, () => {
  const { camera } = state;
  if (!camera) return;
  for (const { slider, number, read } of dials) {
    const value = read(camera);
    // A number may lie beyond what the slider was made for: a touch on the slider must not change it.
    if (value > Number(slider.max)) slider.max = String(1.5 * value);
    if (value < Number(slider.min)) slider.min = String(1.5 * value);
    if (document.activeElement !== slider || Number(slider.value) !== value) slider.value = String(value);
    if (document.activeElement !== number) number.value = String(Number(value.toPrecision(6)));
  }
  if (document.activeElement !== byId("image-height")) inputById("image-height").value = String(camera.height);
  if (document.activeElement !== byId("image-width")) inputById("image-width").value = String(camera.width);
  setChoice("projection", camera.projection);
  setChoice("projection-outside", camera.projection);
  const formula = byId("camera-formula");
  if (formula.dataset.projection === camera.projection) return;
  formula.dataset.projection = camera.projection;
  formula.replaceChildren(
    ...rich(
      camera.projection === "perspective"
        ? "perspective: all viewing rays begin at the eye. origin = eye, direction = x *u* + y *v* − d *w*"
        : "parallel: all viewing rays have the same direction. origin = eye + x *u* + y *v*, direction = −*w*",
    ),
  );
});

/** Another size of the image. The viewport keeps its height; where pixels were square, they stay so. */
function resizeImage() {
  const [height, width] = [inputById("image-height"), inputById("image-width")];
  if (!state.camera || !height.validity.valid || !width.validity.valid || !height.value || !width.value) {
    showCamera();
    return;
  }
  const { camera } = state;
  const square = Math.abs((camera.vw * camera.height) / (camera.vh * camera.width) - 1) < 1e-6;
  const [rows, columns] = [height.valueAsNumber, width.valueAsNumber];
  moveCamera({ height: rows, width: columns, vw: square ? (camera.vh * columns) / rows : camera.vw });
}

function beginCameraPanel() {
  for (const holder of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("[data-vector]"))) {
    const key = /** @type {"eye" | "direction" | "up"} */ (holder.dataset.vector);
    ["x", "y", "z"].forEach((axis, index) => {
      const row = dial(
        axis,
        `${key} ${axis}`,
        (camera) => camera[key][index],
        (camera, value) => ({ [key]: camera[key].map((old, place) => (place === index ? value : old)) }),
      );
      if (key !== "eye") /** @type {HTMLElement} */ (row.querySelector("input")).dataset.range = "turn";
      holder.append(row);
    });
  }
  const sizes = /** @type {HTMLElement} */ (document.querySelector("[data-sizes]"));
  for (const [key, words] of /** @type {const} */ ([
    ["vw", "width of the viewport"],
    ["vh", "height of the viewport"],
    ["d", "distance from the eye to the viewport"],
  ])) {
    sizes.append(
      dial(
        key,
        words,
        (camera) => camera[key],
        (_, value) => ({ [key]: Math.max(0.01, value) }),
        { least: 0.01 },
      ),
    );
  }
  byId("image-height").addEventListener("change", resizeImage);
  byId("image-width").addEventListener("change", resizeImage);
  onChoice("projection", (value) => project(/** @type {ProjectionName} */ (value)));
  byId("camera-back").addEventListener("click", cameraBack);
  byId("camera-canonical").addEventListener("click", canonicalCamera);
  watch(["opened"], rangeDials);
  watch(["camera"], showCamera);
}
