// @ts-check
// The engine: the page's way to a worker. `engine.call("render", {…})` gives a promise of the answer; a refusal is an
// Error with the text for the reader.

/**
 * @typedef {{resolve: (value: any) => void, reject: (error: Error) => void, told?: (done: number, of: number) => void}} Waiting
 */

/** The texts of the worker's script and of the module, which is compiled but once. @type {{script: string, module: any} | undefined} */
let engineParts;

/** Starts a worker with the module. */
function makeEngine() {
  /** @type {Map<number, Waiting>} */
  const waiting = new Map();
  let last = 0;
  /** @type {Worker | undefined} */
  let worker;
  /** @type {Error | undefined} Why there is no worker. */
  let dead;
  /** The last scene that was opened, for a module that has to begin anew. @type {any} */
  let opened;

  /** @param {string} id */
  function textOf(id) {
    const element = document.getElementById(id);
    if (element === null) throw new Error(`the page has no part ${id}`);
    const text = element.textContent ?? "";
    // The page does without it: it is long.
    element.remove();
    return text;
  }

  /** @param {Error} error */
  function rejectAll(error) {
    for (const { reject } of waiting.values()) reject(error);
    waiting.clear();
  }

  /** @param {string} text */
  function fail(text) {
    dead = new Error(text);
    rejectAll(dead);
  }

  function start() {
    if (typeof WebAssembly !== "object") {
      return fail("this browser does not run WebAssembly; open the page in another one");
    }
    try {
      const parts = (engineParts ??= { script: textOf("bothways-worker"), module: textOf("bothways-module") });
      const address = URL.createObjectURL(new Blob([parts.script], { type: "text/javascript" }));
      const started = new Worker(address);
      worker = started;
      // The script is being read; its address is not needed again once it has answered.
      void send("start", { module: parts.module }).then(
        (compiled) => {
          URL.revokeObjectURL(address);
          parts.module = compiled;
        },
        (/** @type {Error} */ error) => fail(`the module does not start: ${error.message}`),
      );
      started.addEventListener("message", ({ data }) => {
        if (worker === started) receive(data);
      });
      started.addEventListener("error", (event) => {
        fail(`the worker does not run: ${event.message || "this browser allows no worker here"}`);
      });
    } catch (error) {
      fail(`this browser allows no worker here: ${error}`);
    }
  }

  /** @param {{id: number, ok: boolean, value?: any, error?: string, broke?: boolean, progress?: [number, number]}} answer */
  function receive({ id, ok, value, error, broke, progress }) {
    if (broke) return beginAnew(String(error));
    const one = waiting.get(id);
    if (progress) return one?.told?.(...progress);
    waiting.delete(id);
    if (ok) one?.resolve(value);
    else one?.reject(new Error(error));
  }

  /**
   * Ends a worker whose module broke, and starts another one with the same scene.
   * @param {string} said
   */
  function beginAnew(said) {
    worker?.terminate();
    rejectAll(new Error(`the module broke, which is a bug, and begins anew; please report this: ${said}`));
    start();
    // If it breaks again by opening the scene, the next one begins without.
    const again = opened;
    opened = undefined;
    if (again !== undefined) void open(again).catch(() => {});
  }

  /**
   * @param {string} name
   * @param {object} args
   * @param {(done: number, of: number) => void} [told]
   * @returns {Promise<any>}
   */
  function send(name, args, told) {
    if (dead !== undefined || worker === undefined) {
      return Promise.reject(dead ?? new Error("the worker has not started"));
    }
    const id = ++last;
    const to = worker;
    return new Promise((resolve, reject) => {
      waiting.set(id, { resolve, reject, told });
      to.postMessage({ ...args, id, call: name });
    });
  }

  /** Opens a scene, and keeps what it was opened from. @param {any} args */
  async function open(args) {
    const value = await send("open", args);
    opened = args;
    return value;
  }

  start();
  return {
    /**
     * Asks the module.
     * @param {string} name
     * @param {any} [args]
     * @param {(done: number, of: number) => void} [told]  Is called with the progress of what takes more than a moment.
     * @returns {Promise<any>}
     */
    call: (name, args = {}, told) => (name === "open" ? open(args) : send(name, args, told)),
    /** What the open scene was opened from. */
    opened: () => opened,
    /** Ends the worker: it answers nothing any more. */
    stop() {
      worker?.terminate();
      fail("stopped");
    },
  };
}

/** The engine of the page. */
const engine = makeEngine();
