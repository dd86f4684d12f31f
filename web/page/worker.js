// @ts-check
// The worker: it holds the module and answers the page's messages, one after another.
//
// It is made from a text, behind the JavaScript of wasm-bindgen, which defines `wasm_bindgen`. A message is
// {id, call, ...arguments} and gets {id, ok: true, value} or {id, ok: false, error}; with `broke: true` if the module is in no
// known state from now on: then the page ends this worker. Long ones are told of by {id, progress: [done, of]} before. The first
// message is {id, call: "start", module}, with the module's bytes, compressed by gzip, in base64, or with the compiled module that
// another worker has answered this message with.
"use strict";

/**
 * @typedef {{
 *   json(): string, buffers(): number, path(index: number): string, kind(index: number): BufferKind, free(): void,
 *   u8(index: number): Uint8ClampedArray<ArrayBuffer>,
 *   u32(index: number): Uint32Array<ArrayBuffer>, f32(index: number): Float32Array<ArrayBuffer>,
 *   f64(index: number): Float64Array<ArrayBuffer>
 * }} Reply
 * @typedef {"u8" | "u32" | "f32" | "f64"} BufferKind
 * @typedef {{call(name: string, args: string, bytes?: Uint8Array): Reply}} Module
 * @typedef {{name: string, bytes: ArrayBuffer}} GivenFile
 * @typedef {{id: number, call: string, files?: GivenFile[], [argument: string]: unknown}} Message
 */

/** @type {any} The name that the JavaScript of wasm-bindgen defines. */
// @ts-ignore
const bindgen = wasm_bindgen;

/** @type {Module | undefined} */
let module;

/** @param {string} base64 */
function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let index = 0; index < text.length; index++) bytes[index] = text.charCodeAt(index);
  return bytes;
}

/** @param {Uint8Array<ArrayBuffer>} bytes */
async function decompressed(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

/** @param {unknown} given  The module's bytes, compressed; or the compiled module. */
async function start(given) {
  const compiled =
    given instanceof WebAssembly.Module
      ? given
      : await WebAssembly.compile(await decompressed(bytesOf(String(given))));
  bindgen.initSync({ module: compiled });
  module = new bindgen.Module();
  return compiled;
}

/** The message that is being answered, and when its progress was told last, in milliseconds. */
const turn = { id: 0, told: 0 };
/** The milliseconds between two words about progress: what takes less is not told of. */
const MOMENT = 150;

/** Called by the module. @param {number} done @param {number} of */
// @ts-ignore
function tellProgress(done, of) {
  const now = performance.now();
  if (now - turn.told < MOMENT) return;
  turn.told = now;
  postMessage({ id: turn.id, progress: [done, of] });
}

/** The bytes of files, one after another. @param {GivenFile[]} files */
function joined(files) {
  const bytes = new Uint8Array(files.reduce((sum, file) => sum + file.bytes.byteLength, 0));
  let at = 0;
  for (const file of files) {
    bytes.set(new Uint8Array(file.bytes), at);
    at += file.bytes.byteLength;
  }
  return bytes;
}

/**
 * Asks the module. The bytes of files stand beside the arguments.
 * @param {Message} message
 */
function ask(message) {
  const { id, call, files, ...args } = message;
  if (module === undefined) throw new Error("the module has not started");
  if (files === undefined) return module.call(call, JSON.stringify(args));
  const listed = files.map(({ name, bytes }) => ({ name, bytes: bytes.byteLength }));
  return module.call(call, JSON.stringify({ ...args, files: listed }), joined(files));
}

/**
 * The value of a reply: its JSON, with the typed arrays at their places.
 * @param {Reply} reply
 * @returns {{value: any, buffers: ArrayBuffer[]}}
 */
function valueOf(reply) {
  const value = JSON.parse(reply.json());
  /** @type {ArrayBuffer[]} */
  const buffers = [];
  for (let index = 0; index < reply.buffers(); index++) {
    const names = reply.path(index).split(".");
    const last = /** @type {string} */ (names.pop());
    let at = value;
    for (const name of names) at = at[name];
    const array = reply[reply.kind(index)](index);
    at[last] = array;
    buffers.push(array.buffer);
  }
  reply.free();
  return { value, buffers };
}

/** @param {Message} message */
async function answer(message) {
  const { id } = message;
  turn.id = id;
  turn.told = performance.now();
  try {
    if (message.call === "start") {
      return postMessage({ id, ok: true, value: await start(message.module) });
    }
    const { value, buffers } = valueOf(ask(message));
    postMessage({ id, ok: true, value }, { transfer: buffers });
  } catch (error) {
    // The module's own texts are strings. A trap, such as the end of a panic or of memory, is a RuntimeError.
    const broke = error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
    const said = broke && module !== undefined ? bindgen.panicText() : "";
    postMessage({ id, ok: false, error: said || String(error), broke });
  }
}

// Messages wait for one another: the first one compiles the module.
let last = Promise.resolve();
addEventListener("message", (event) => {
  last = last.then(() => answer(event.data));
});
