// @ts-check
// Records the loops, in workers of their own: the textbooks take seconds for thousands of objects, and meanwhile the page's
// other questions must not wait. The workers start with the first record.

/** Of scenes with more primitives, the page does not hold a copy for each order. */
const MANY = 100_000;

const recorder = (() => {
  /** The workers, and what is open in each. @type {Map<string, {engine: ReturnType<typeof makeEngine>, open: any}>} */
  const workers = new Map();

  return {
    /**
     * The record of one order of the scene that is open.
     * @param {{order: OrderName, [argument: string]: unknown}} args
     * @param {(done: number, of: number) => void} told  Is called if it takes more than a moment.
     * @returns {Promise<Steps>}
     */
    async steps(args, told) {
      const name = (state.opened?.primitives ?? 0) > MANY ? "both" : args.order;
      const worker = workers.get(name) ?? { engine: makeEngine(), open: undefined };
      workers.set(name, worker);
      const scene = engine.opened() ?? worker.open;
      if (worker.open !== scene) await worker.engine.call("open", scene);
      worker.open = scene;
      return worker.engine.call("steps", args, told);
    },
    /** Gives up what is being recorded, and forgets the scene. */
    stop() {
      for (const { engine: own } of workers.values()) own.stop();
      workers.clear();
    },
  };
})();
