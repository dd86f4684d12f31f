// A scene of two walls, with a mesh, a material file and a picture: the files that tests drop on the page.

import { readFileSync } from "node:fs";

/** Red and green above, blue and grey below. */
export const FOUR = readFileSync(new URL("../../formats/tests/formats/files/four.png", import.meta.url));

/** The material file of the mesh. */
export const PAINT = "newmtl paint\nKd 1 1 1\nmap_Kd four.png\n";

/** The mesh: a square with the picture on it. */
export const wall = (/** @type {string} */ library) => `mtllib ${library}
usemtl paint
v -0.9 -0.9 0
v 0.9 -0.9 0
v 0.9 0.9 0
v -0.9 0.9 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
f 1/1 2/2 3/3 4/4
`;

/** The scene: the mesh twice, once with its own material and once with the scene's. */
export const walls = (/** @type {string} */ mesh, /** @type {string} */ picture) => `[camera]
eye = [0, 0, 3]
image = [64, 32]
[[light]]
ambient = true
[material.tiles]
texture = { file = "${picture}", filter = "nearest" }
[[object]]
mesh = "${mesh}"
translate = [-1, 0, 0]
[[object]]
mesh = "${mesh}"
material = "tiles"
translate = [1, 0, 0]
`;
