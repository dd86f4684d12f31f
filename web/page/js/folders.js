// @ts-check
// The files in what is dropped on the page: files, and folders with all that is in them.

/** A file with its path from what was dropped. @typedef {{path: string, file: File}} FoundFile */

/**
 * A dropped thing, in the same words whichever way the browser tells of it.
 * @typedef {object} Dropped
 * @property {string} name
 * @property {() => Promise<File>} [file]  Of a file.
 * @property {() => Promise<Dropped[]>} [children]  Of a folder.
 */

/** The most files that are looked at in folders, and the most folders within one another: a scene has fewer. */
const MOST_FILES = 1000;
const DEEPEST = 16;

/** @param {FileSystemHandle} handle @returns {Dropped} */
function ofHandle(handle) {
  const { name } = handle;
  if (handle instanceof FileSystemFileHandle) return { name, file: () => handle.getFile() };
  return {
    name,
    children: async () => {
      const all = [];
      // TypeScript's list of a folder's methods lacks this one.
      for await (const one of /** @type {any} */ (handle).values()) {
        all.push(ofHandle(one));
        if (all.length > MOST_FILES) break;
      }
      return all;
    },
  };
}

/** @param {FileSystemEntry} entry @returns {Dropped} */
function ofEntry(entry) {
  const { name } = entry;
  if (entry.isFile)
    return { name, file: () => new Promise((...ends) => /** @type {FileSystemFileEntry} */ (entry).file(...ends)) };
  return {
    name,
    children: async () => {
      const reader = /** @type {FileSystemDirectoryEntry} */ (entry).createReader();
      /** @type {Dropped[]} */
      const all = [];
      // They come in parts, and an empty one is the end.
      for (;;) {
        /** @type {FileSystemEntry[]} */
        const part = await new Promise((...ends) => reader.readEntries(...ends));
        if (part.length === 0 || all.length > MOST_FILES) return all;
        all.push(...part.map(ofEntry));
      }
    },
  };
}

/**
 * What is dropped. It must be asked during the event: later a browser has forgotten it.
 * @param {DataTransfer} transfer
 * @returns {Promise<Dropped | null>[]}
 */
const droppedOf = ({ items }) =>
  [...items]
    .filter(({ kind }) => kind === "file")
    .map(async (item) => {
      const entry = item.webkitGetAsEntry?.();
      const file = item.getAsFile();
      // Chromium tells pages from the disk what is in a folder only through handles, and other browsers only through entries.
      if (entry?.isDirectory) {
        const handle = await /** @type {any} */ (item).getAsFileSystemHandle?.();
        return handle ? ofHandle(handle) : ofEntry(entry);
      }
      return file && { name: file.name, file: async () => file };
    });

/**
 * All files in what was dropped. Hidden ones and hidden folders stay aside. Of a single folder, paths begin in it; otherwise the
 * names of folders begin the paths.
 * @param {Dropped[]} things
 * @returns {Promise<FoundFile[]>}
 */
async function filesIn(things) {
  /** @type {FoundFile[]} */
  const found = [];
  /** @param {Dropped} one @param {string} folder @param {number} depth */
  const walk = async (one, folder, depth) => {
    if (one.file) {
      if (found.length === MOST_FILES) throw new Error(`this page looks at ${grouped(MOST_FILES)} files at most`);
      found.push({ path: folder + one.name, file: await one.file() });
    } else if (one.children) {
      if (depth === DEEPEST) throw new Error(`this page looks into ${DEEPEST} folders within one another at most`);
      const inside = await one.children();
      // The same order in every browser.
      inside.sort((a, b) => (a.name < b.name ? -1 : 1));
      for (const child of inside)
        if (!child.name.startsWith(".")) await walk(child, `${folder}${one.name}/`, depth + 1);
    }
  };
  for (const one of things) {
    try {
      await walk(one, "", 0);
    } catch (error) {
      throw new Error(`${one.name}: ${messageOf(error)}; drop the scene file and the files that it names instead`);
    }
  }
  if (things.length !== 1 || !things[0].children) return found;
  const own = things[0].name.length + 1;
  return found.map(({ path, file }) => ({ path: path.slice(own), file }));
}
