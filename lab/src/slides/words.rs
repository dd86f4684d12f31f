//! What stands below each slide, and what the lecturer says to it.

/// A caption, and the notes.
pub(super) type Words = [&'static str; 2];

pub(super) const IMAGE: Words = [
    "An image is rows and columns of pixels; to draw is to decide the colour of each.",
    "Begin with the smallest thing there is: canvas[i, j] = color. Ask which pixels of the patch belong to the object, \
     and how one would know. Everything after this answers that question, in two orders.",
];

pub(super) const OBJECT_ORDER: Words = [
    "The outer loop goes through the scene: for each object, for each pixel.",
    "Read the loops aloud. Let the class say which pixels change next. A pixel can be painted again by a nearer object: \
     so the program must remember how near the stored one is. That memory is the z-buffer.",
];

pub(super) const IMAGE_ORDER: Words = [
    "The outer loop goes through the picture: for each pixel, for each object.",
    "The same two loops, swapped. Here one variable is enough to remember the nearest object, because a pixel is finished \
     before the next one begins. Ask which order needs the whole scene in memory, and which the whole picture.",
];

pub(super) const PERSPECTIVE: Words = [
    "Perspective: all viewing rays start at the eye.",
    "Derive the ray on the board before showing the numbers. Half a pixel: the ray goes through the middle of its pixel. \
     The minus in y: rows count down, v points up. Everything on one ray falls on one pixel: so a D is lost.",
];

pub(super) const PARALLEL: Words = [
    "Parallel: all viewing rays have the same direction.",
    "Compare with the slide before: origin and direction have swapped roles. Lengths do not shrink with distance, so \
     engineers measure in such drawings.",
];

pub(super) const CAMERA: Words = [
    "The camera of this scene, and what some of its rays hit.",
    "Ask which projection it is before reading the title: do the rays meet in a point, or have they one direction?",
];

pub(super) const EDGES: Words = [
    "A triangle is the intersection of three half-planes.",
    "One edge function answers on which side of one edge a sample lies. Three answers make 'if inside triangle'. On the \
     raster each is affine: one addition leads from a pixel to the next, which is why rasterizers like them.",
];

pub(super) const GRID: Words = [
    "Only samples are asked: a pixel is covered if its middle is.",
    "Pick a pixel that the triangle touches without covering. Nothing between samples is ever asked. Count signs in one \
     cell together. Samples a pixel more would see more; they never see all.",
];

pub(super) const TIES: Words = [
    "A sample exactly on an edge belongs to exactly one side.",
    "Why a rule at all? Two triangles share an edge: without a rule its samples are drawn twice, or never. Moving the sample \
     a little decides every tie in the same way, for both orders, without any epsilon.",
];

pub(super) const RAY: Words = [
    "Of all crossings with t > 0 the nearest is seen.",
    "r(t) = p + t d. The ray need not test everything: a box that it misses spares all that is in it. The textbook's number \
     of tests stands beside it.",
];

pub(super) const DEPTH: Words = [
    "How many surfaces lie behind one another at each pixel.",
    "Object order meets all of them and keeps one; image order may stop early. The mean is what overdraw costs.",
];

pub(super) const WORK: Words = [
    "The same picture, and how many tests each pixel takes.",
    "The textbooks test every pair: both loops do the same work, in another order. Bounds and hierarchies save nearly all of \
     it. The numbers count each primitive and each ray by itself; a timed frame shares more.",
];

pub(super) const HIERARCHY: Words = [
    "Boxes, so that most pairs are never looked at.",
    "Each order skips its own inner loop: image order skips objects by boxes around them, object order skips pixels by \
     boxes and tiles on the raster.",
];

pub(super) const ORDER: Words = [
    "The pixels in the order in which each loop decided them.",
    "This is the swap of the loops, seen as colour: objects on one side, lines on the other. With tiles and hierarchies the \
     patterns change, and the picture stays the same.",
];

pub(super) const TRIANGLES: Words = [
    "The textbooks grow with the triangles; the fast renderers hardly do.",
    "Steps are counted, so this chart is the same on every machine. A slope of 1 means: twice the triangles, twice the \
     work. Ask what a hierarchy must do so that the slope is near 0, and what no hierarchy can avoid.",
];

pub(super) const PIXELS: Words = [
    "With more pixels every loop has more to do.",
    "Here no hierarchy helps: each pixel is decided at least once. For times, run bothways sweep on the machine in the room.",
];

pub(super) const AGREE: Words = [
    "Both orders cover the same samples and see the same primitive in each.",
    "The difference is computed, not claimed: ids are compared without tolerance. They agree because what is true of a sample \
     is decided by exact arithmetic, in one place, and neither loop can change it.",
];

pub(super) const REASONS: Words = [
    "A common rule, 'inside or on the edge', and each pixel that it gets wrong.",
    "Here object order counts edges as inside on both sides. Each coloured pixel has a reason that the exact judge \
     found. Most bug reports about renderers are of this kind.",
];

pub(super) const ZOOM: Words = [
    "The same pixels in every buffer.",
    "Coverage can agree while ids do not: the union of shared edges is the same, and the owner is not. A picture alone would \
     hide it.",
];

pub(super) const FILM: Words = [
    "Both loops draw one picture, on one clock of work done.",
    "Let it run twice. First watch the pictures, then the lit lines. Ask before the end: when does either order know that it \
     is finished?",
];

pub(super) const FAST_FILM: Words = [
    "The same with bounds and hierarchies.",
    "The clock counts tests of primitives and boxes, each ray by itself. It is no clock of seconds: one step of one order may \
     take longer than one of the other.",
];
