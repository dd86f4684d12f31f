// @ts-check
// The values that the engine answers with, as types: nothing here runs.

/** @typedef {[number, number, number]} Vector */
/** @typedef {[number, number]} Pixel  Row and column, counted from 0 from the top left. */
/** @typedef {"object" | "image"} OrderName */
/** @typedef {"perspective" | "parallel"} ProjectionName */

/**
 * The camera in the scene file's terms.
 * @typedef {object} Camera
 * @property {Vector} eye
 * @property {Vector} direction
 * @property {Vector} up
 * @property {number} vw
 * @property {number} vh
 * @property {number} d
 * @property {ProjectionName} projection
 * @property {number} height
 * @property {number} width
 * @property {Vector} [look_at]  Stands for the direction, as long as nothing has moved the camera.
 * @property {Vector} [u]  With `v` and `w`: stand for direction and up.
 * @property {Vector} [v]
 * @property {Vector} [w]
 */

/**
 * @typedef {object} Opened
 * @property {string} name
 * @property {string | null} sentence
 * @property {Camera} camera
 * @property {number} objects
 * @property {number} primitives
 * @property {number} triangles
 * @property {string[]} warnings
 */

/** What one order drew; the ids are there once the camera rests. */
/** @typedef {{rgba: Uint8ClampedArray, ids?: Uint32Array, ms: {visibility: number, shading: number}, work: Record<string, number> | null}} OrderPicture */

/**
 * @typedef {object} Verdict
 * @property {string} text
 * @property {boolean} equal
 * @property {boolean} coverageEqual
 * @property {boolean} idsEqual
 * @property {number} pixels
 * @property {[number, number]} covered  In object order, in image order.
 * @property {number} differ
 * @property {number} onlyObject
 * @property {number} onlyImage
 */

/**
 * @typedef {object} Rendered
 * @property {OrderPicture} object
 * @property {OrderPicture} image
 * @property {{rgba: Uint8ClampedArray, ms: number}} difference
 * @property {Verdict} verdict
 */

/**
 * The steps of one order, in runs of the inner loop; see `Recording.step`.
 * @typedef {object} Steps
 * @property {number} count
 * @property {{first: Uint32Array, object: Uint32Array, node: Uint32Array, pixel: Uint32Array}} runs  The number of the first
 *   step of each, its primitive or box, the other one being `NOTHING`, and its pixel, counted row by row.
 * @property {{step: Uint32Array, result: Uint8Array, t: Float32Array}} told  What came of the steps that found something: the
 *   others found that the object does not affect the pixel. See `RESULT`.
 * @property {string[]} pseudocode
 * @property {Uint32Array} marks  The steps at which each object (object order) or each row (image order) begins.
 * @property {{step: Uint32Array, row: Uint32Array, column: Uint32Array, id: Uint32Array, rgb: Uint8Array}} changes
 * @property {string[]} [kinds]  The kind of each primitive, in words.
 * @property {number} pairs  Of a primitive and a pixel.
 * @property {number} skipped  Those that no step looks at.
 * @property {{primitives: Lines, boxes: Lines & {number: Uint32Array}}} outlines
 */

/**
 * The lines that bound things on the raster, for thing after thing.
 * @typedef {object} Lines
 * @property {Float32Array} points  Column and row of each point.
 * @property {Uint32Array} lines  The end of each line, counted in points.
 * @property {Uint32Array} ends  The end of each thing, counted in lines.
 */

/** What a step found. */
const RESULT = { none: 0, first: 1, nearer: 2, behind: 3, missed: 4, entered: 5 };

/** Stands for no primitive in buffers of ids. */
const NOTHING = 0xffffffff;

/**
 * @typedef {object} EdgeReport
 * @property {Record<string, any>} [edges]
 */

/**
 * @typedef {object} SampleReport
 * @property {number} x
 * @property {number} y
 * @property {Vector} origin_from_eye
 * @property {Vector} direction
 * @property {any[]} covering
 * @property {any[]} touching
 * @property {{id: number | null, t: number | null, work: Record<string, number>}} object_order
 * @property {{id: number | null, t: number | null, work: Record<string, number>}} image_order
 */

/**
 * @typedef {object} PixelReport
 * @property {Pixel} pixel
 * @property {[number, number]} size  Width and height.
 * @property {Vector} eye
 * @property {boolean} agree
 * @property {SampleReport[]} at
 * @property {string[]} [lines]
 */

/**
 * @typedef {object} Outside
 * @property {Vector} eye
 * @property {Vector} u
 * @property {Vector} v
 * @property {Vector} w
 * @property {Vector[]} corners  Of the viewport: top left, top right, bottom right, bottom left.
 * @property {number} d
 * @property {ProjectionName} projection
 * @property {{point: Vector, normal: Vector, colour: Vector}[]} planes
 */

/** @typedef {{row: number, column: number, origin: Vector, direction: Vector, t: number | null, id: number | null, point: Vector | null}} ViewingRay */
