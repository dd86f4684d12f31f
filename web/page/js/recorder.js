// @ts-check
// Records the loops, in a worker of its own: the textbooks take seconds for thousands of objects, and meanwhile the page's
// other questions must not wait. The worker starts with the first record.

/** @typedef {(done: number, of: number) => void} ProgressListener */

const recorder = (() => {
  /** @type {ReturnType<typeof makeEngine> | undefined} */
  let own;
  /** What is open in it. @type {any} */
  let open;

  return {
    /**
     * The record of the scene that is open.
     * @param {object} args
     * @param {ProgressListener} told  Is called if it takes more than a moment.
     * @returns {Promise<Steps>}
     */
    async steps(args, told) {
      own ??= makeEngine();
      const scene = engine.opened() ?? open;
      if (open !== scene) await own.call("open", scene);
      open = scene;
      return own.call("steps", args, told);
    },
    /** Gives up what is being recorded, and forgets the scene. */
    stop() {
      own?.stop();
      own = open = undefined;
    },
  };
})();
