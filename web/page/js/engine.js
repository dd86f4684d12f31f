// @ts-check
// The engine: the page's way to the worker. `engine.call("render", {…})` gives a promise of the answer; a refusal is an
// Error with the text for the reader.

/**
 * @typedef {{resolve: (value: any) => void, reject: (error: Error) => void}} Waiting
 */

const engine = (() => {
  /** @type {Map<number, Waiting>} */
  const waiting = new Map();
  let last = 0;
  /** @type {Worker | undefined} */
  let worker;
  /** @type {Error | undefined} Why there is no worker. */
  let dead;

  /** @param {string} id */
  function textOf(id) {
    const element = document.getElementById(id);
    if (element === null) throw new Error(`the page has no part ${id}`);
    const text = element.textContent ?? "";
    // It is needed once, and it is long.
    element.remove();
    return text;
  }

  /** @param {string} text */
  function fail(text) {
    dead = new Error(text);
    for (const { reject } of waiting.values()) reject(dead);
    waiting.clear();
  }

  function start() {
    if (typeof WebAssembly !== "object") {
      return fail("this browser does not run WebAssembly; open the page in another one");
    }
    try {
      const script = new Blob([textOf("bothways-worker")], { type: "text/javascript" });
      const address = URL.createObjectURL(script);
      worker = new Worker(address);
      // The script is being read; its address is not needed again once it has answered.
      void send("start", { module: textOf("bothways-module") }, []).then(
        () => URL.revokeObjectURL(address),
        (/** @type {Error} */ error) => fail(`the module does not start: ${error.message}`),
      );
      worker.addEventListener("message", ({ data: { id, ok, value, error } }) => {
        const one = waiting.get(id);
        waiting.delete(id);
        if (ok) one?.resolve(value);
        else one?.reject(new Error(error));
      });
      worker.addEventListener("error", (event) => {
        fail(`the worker does not run: ${event.message || "this browser allows no worker here"}`);
      });
    } catch (error) {
      fail(`this browser allows no worker here: ${error}`);
    }
  }

  /**
   * @param {string} name
   * @param {object} args
   * @param {Transferable[]} transfer
   * @returns {Promise<any>}
   */
  function send(name, args, transfer) {
    if (dead !== undefined || worker === undefined) {
      return Promise.reject(dead ?? new Error("the worker has not started"));
    }
    const id = ++last;
    const to = worker;
    return new Promise((resolve, reject) => {
      waiting.set(id, { resolve, reject });
      to.postMessage({ ...args, id, call: name }, transfer);
    });
  }

  start();
  return {
    /**
     * Asks the module. The bytes of a file leave the page.
     * @param {string} name
     * @param {any} [args]
     * @returns {Promise<any>}
     */
    call(name, args = {}) {
      const bytes = args.file?.bytes;
      return send(name, args, bytes instanceof ArrayBuffer ? [bytes] : []);
    },
  };
})();
