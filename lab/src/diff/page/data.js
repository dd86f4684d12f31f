// What the page knows: facts, groups, and the values of each sample.

const byId = (id) => document.getElementById(id);
const facts = JSON.parse(byId("facts").textContent);
const [width, height] = facts.size;

// The types of array elements: a view of their numbers, and the bytes of an element.
const KINDS = {
  u8: [Uint8Array, 1],
  u32: [Uint32Array, 4],
  u64: [BigUint64Array, 8],
  f32: [Float32Array, 4],
  f64: [Float64Array, 8],
  f32x3: [Float32Array, 12],
  u8x4: [Uint8Array, 4],
  f32x4: [Float32Array, 16],
};

// Reads an array: Base64, deflated, planes of bytes, each byte less the one that was expected (see arrays.rs).
async function readArray(id, kind, base) {
  const letters = atob(byId(id).textContent);
  const packed = new Uint8Array(letters.length);
  for (let at = 0; at < packed.length; at++) packed[at] = letters.charCodeAt(at);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const [View, bytes] = KINDS[kind];
  const elements = planes.length / bytes;
  const read = new Uint8Array(planes.length);
  const expected = base && new Uint8Array(base.buffer);
  for (let place = 0; place < bytes; place++) {
    let before = 0;
    const plane = planes.subarray(place * elements, (place + 1) * elements);
    for (let element = 0, at = place; element < elements; element++, at += bytes) {
      before = (plane[element] + (expected ? expected[at] : before)) & 255;
      read[at] = before;
    }
  }
  byId(id).remove();
  return new View(read.buffer);
}

// The groups, each with the numbers of its pixels in rising order.
const groups = facts.groups.map((group) => ({ ...group, shown: true, pixels: new Uint32Array(0) }));

async function readGroups() {
  for (const [number, group] of groups.entries()) {
    group.pixels = await readArray(`group-${number}`, "u32", null);
  }
}

// The arrays of both sides by name; null until they are read.
const sides = facts.sides.map((side) => ({ ...side, read: null }));

async function readValues() {
  const [a, b] = sides;
  const inA = {};
  for (const { name, kind } of a.arrays) {
    inA[name] = await readArray(`a-${name}`, kind, null);
  }
  a.read = inA;
  const inB = {};
  for (const { name, kind, from_a: fromA } of b.arrays) {
    inB[name] = await readArray(`b-${name}`, kind, fromA ? inA[name] : null);
  }
  b.read = inB;
}

function holds(sorted, number) {
  let [low, high] = [0, sorted.length];
  while (low < high) {
    const middle = (low + high) >>> 1;
    if (sorted[middle] < number) low = middle + 1;
    else high = middle;
  }
  return sorted[low] === number;
}

// The groups that a pixel is in.
const groupsAt = (pixel) => groups.filter((group) => holds(group.pixels, pixel));

// The fewest digits that read back as the same number.
function distanceText(t, isSingle) {
  if (!isSingle) return String(t);
  for (let digits = 1; digits < 9; digits++) {
    const text = t.toPrecision(digits);
    if (Math.fround(Number(text)) === t) return String(Number(text));
  }
  return String(Number(t.toPrecision(9)));
}

function colorText(channels) {
  if (channels.every(Number.isInteger)) {
    return "#" + channels.map((channel) => channel.toString(16).padStart(2, "0")).join("");
  }
  return `(${channels.map((channel) => channel.toFixed(2)).join(" ")}) of 255`;
}

// The colour of a pixel of one side, or null.
function colorAt(side, pixel) {
  const { color, covered } = side.read;
  if (!color || (covered && !covered[pixel])) return null;
  return Array.from(color.subarray(4 * pixel, 4 * pixel + (side.alpha ? 4 : 3)));
}

// One sample in words.
function sampleText(side, sample) {
  const { ids, t, normals, covered, color } = side.read;
  const parts = [];
  if (ids) {
    const id = ids[sample];
    if (id === (typeof id === "bigint" ? 0xffffffffffffffffn : 0xffffffff)) return "nothing";
    parts.push(`id ${id}`);
  }
  if (t) {
    if (!Number.isFinite(t[sample])) return "nothing";
    parts.push(`t ${distanceText(t[sample], t instanceof Float32Array)}`);
  }
  if (covered && !covered[sample]) return "nothing";
  if (normals) parts.push(`normal (${[0, 1, 2].map((axis) => normals[3 * sample + axis].toFixed(4)).join(" ")})`);
  if (covered && !color && !normals) return "covered";
  return parts.join(", ");
}

// What one side says at a pixel: its samples in order, with equal neighbours counted, and its colour.
function pixelText(side, pixel) {
  if (!side.read) return facts.omitted ? "–" : "…";
  const count = side.samples ** 2;
  const runs = [];
  for (let sample = count * pixel; sample < count * (pixel + 1); sample++) {
    const text = sampleText(side, sample);
    if (runs.length && runs.at(-1).text === text) runs.at(-1).length++;
    else runs.push({ text, length: 1 });
  }
  const said = runs.slice(0, 8).map(({ text, length }) => (length > 1 ? `${text} (×${length})` : text));
  if (runs.length > 8) said.push("…");
  const color = colorAt(side, pixel);
  return [said.filter(Boolean).join("; "), color && colorText(color)].filter(Boolean).join(", ");
}

// A whole number with its digits in groups of three.
const grouped = (number) => String(number).replace(/\B(?=(\d{3})+$)/g, ",");

