//! The choice of pixels for the textbook check.

use crate::common::exact::Sign;
use crate::common::{Frame, Primitive, View};
use rayon::prelude::*;
use std::cmp::Ordering;
use std::collections::{BTreeSet, BinaryHeap};

/// A pixel for the textbook check, and the reason for the choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The row and the column in the whole image.
    pub pixel: [u32; 2],
    /// The first reason that applies.
    pub reason: Reason,
}

/// The reason for the choice of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
    /// The orders see different primitives.
    Differs,
    /// A sample lies exactly on an edge of a primitive visible in the pixel or in a neighbour, or two primitives are
    /// equally near.
    Tie,
    /// The pixel shows a primitive and a neighbour shows nothing, or the other way round.
    Silhouette,
    /// A neighbour shows another primitive.
    Edge,
    /// No reason.
    Random,
}

/// One pixel in this number is random: a renderer may also be wrong where no decision looks close.
const LEFT_TO_CHANCE: usize = 4;
/// The search for ties covers this multiple of the requested number of pixels.
const CANDIDATES: usize = 16;

/// Chooses pixels of a picture, from the frame of one order or from both frames: pixels where the orders differ; then
/// pixels at ties, silhouettes and edges in turn, up to three quarters; then pixels anywhere. Each kind is spread
/// over the picture, the same in every run. If the picture has no more pixels than requested, the choice is all
/// pixels.
///
/// # Panics
///
/// If there is no frame.
pub fn choose(view: &View, frames: &[&Frame], pixels: usize) -> Vec<Choice> {
    let frame = frames[0];
    let candidates = pixels.saturating_mul(CANDIDATES);
    let mut differing = Least::new(pixels);
    let mut silhouettes = Least::new(candidates);
    let mut edges = Least::new(candidates);
    let mut anywhere = Least::new(pixels.saturating_mul(2));
    for pixel in frame.pixels() {
        if frames.iter().any(|other| differs(frame, other, pixel)) {
            differing.offer(pixel);
        }
        match border(frame, pixel) {
            Some(Reason::Silhouette) => silhouettes.offer(pixel),
            Some(_) => edges.offer(pixel),
            None => {}
        }
        anywhere.offer(pixel);
    }
    let tied = |pixels: Least| -> (Vec<[u32; 2]>, Vec<[u32; 2]>) {
        pixels.sorted().into_par_iter().partition(|pixel| is_tie(view, frame, *pixel))
    };
    let ((ties, silhouettes), (more, edges)) = (tied(silhouettes), tied(edges));
    let ties = [ties, more].concat();

    let mut chosen = Chosen { all: Vec::new(), pixels: BTreeSet::new() };
    chosen.take(&[(Reason::Differs, differing.sorted())], pixels);
    let closely = [(Reason::Tie, ties), (Reason::Silhouette, silhouettes), (Reason::Edge, edges)];
    chosen.take(&closely, pixels - pixels.div_ceil(LEFT_TO_CHANCE));
    chosen.take(&[(Reason::Random, anywhere.sorted())], pixels);
    chosen.all
}

/// The chosen pixels, each once.
struct Chosen {
    all: Vec<Choice>,
    pixels: BTreeSet<[u32; 2]>,
}

impl Chosen {
    /// Takes pixels from each kind in turn, up to the count, or until no pixel is left.
    fn take(&mut self, kinds: &[(Reason, Vec<[u32; 2]>)], count: usize) {
        let longest = kinds.iter().map(|(_, pixels)| pixels.len()).max().unwrap_or(0);
        for turn in 0..longest {
            for (reason, pixels) in kinds {
                let Some(&pixel) = pixels.get(turn) else { continue };
                if self.all.len() < count && self.pixels.insert(pixel) {
                    self.all.push(Choice { pixel, reason: *reason });
                }
            }
        }
    }
}

/// A given number of the offered pixels, in a choice that looks random.
struct Least {
    count: usize,
    /// A heap with the largest number at the top.
    heap: BinaryHeap<(u64, [u32; 2])>,
}

impl Least {
    fn new(count: usize) -> Least {
        Least { count, heap: BinaryHeap::new() }
    }

    fn offer(&mut self, [i, j]: [u32; 2]) {
        let entry = (scattered(u64::from(i) << 32 | u64::from(j)), [i, j]);
        if self.heap.len() < self.count {
            self.heap.push(entry);
        } else if self.heap.peek().is_some_and(|largest| entry < *largest) {
            self.heap.pop();
            self.heap.push(entry);
        }
    }

    fn sorted(self) -> Vec<[u32; 2]> {
        self.heap.into_sorted_vec().into_iter().map(|(_, pixel)| pixel).collect()
    }
}

/// A number that looks random, different for each input (the finalizer of `SplitMix64`: Steele, Lea and Flood, "Fast
/// Splittable Pseudorandom Number Generators", OOPSLA 2014).
fn scattered(number: u64) -> u64 {
    let mut bits = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}

/// Whether two frames show different primitives in a pixel.
fn differs(frame: &Frame, other: &Frame, [i, j]: [u32; 2]) -> bool {
    let mut samples = frame.samples_of(i as usize, j as usize);
    samples.any(|sample| frame.ids().get(sample) != other.ids().get(sample))
}

/// The rows and columns of a pixel's samples.
fn samples(frame: &Frame, [i, j]: [u32; 2]) -> impl Iterator<Item = [usize; 2]> + use<> {
    let n = frame.samples() as usize;
    let (top, left) = (i as usize * n, j as usize * n);
    (top..top + n).flat_map(move |row| (left..left + n).map(move |column| [row, column]))
}

/// The primitives at a sample and at its neighbours, within the frame.
fn around(frame: &Frame, [row, column]: [usize; 2]) -> impl Iterator<Item = Option<u64>> {
    let region = frame.region();
    let beside = [
        [row, column],
        [row.wrapping_sub(1), column],
        [row, column.wrapping_sub(1)],
        [row, column + 1],
        [row + 1, column],
    ];
    let inside = beside
        .into_iter()
        .filter(|[row, column]| region.rows.contains(row) && region.columns.contains(column));
    inside.map(|[row, column]| frame.id(row, column))
}

/// Whether a silhouette or an edge runs through a pixel or beside it.
fn border(frame: &Frame, pixel: [u32; 2]) -> Option<Reason> {
    let mut found = None;
    for sample in samples(frame, pixel) {
        let here = frame.id(sample[0], sample[1]);
        for beside in around(frame, sample) {
            if beside.is_some() != here.is_some() {
                return Some(Reason::Silhouette);
            }
            if beside != here {
                found = Some(Reason::Edge);
            }
        }
    }
    found
}

/// Whether one of the samples of a pixel lies exactly on an edge of a primitive visible there or in a neighbour,
/// inside the primitive's other edges; or two of these primitives are equally near.
fn is_tie(view: &View, frame: &Frame, pixel: [u32; 2]) -> bool {
    let (judge, grid) = (view.judge(), view.camera.sample_grid(frame.samples()));
    samples(frame, pixel).any(|sample| {
        let ray = grid.ray(sample[0], sample[1]);
        let seen: BTreeSet<u64> = around(frame, sample).flatten().collect();
        let primitives: Vec<Primitive> = seen.into_iter().map(|id| view.primitive(id)).collect();
        let on_edge = |primitive: &Primitive| {
            let Some(edges) = judge.coverage(primitive, &ray).edges else { return false };
            let has = |sign| edges.at_sample.contains(&sign);
            has(Sign::Zero) && !(has(Sign::Negative) && has(Sign::Positive))
        };
        let covering: Vec<&Primitive> =
            primitives.iter().filter(|primitive| judge.covers(primitive, &ray)).collect();
        let as_near = |pair: &[&Primitive]| {
            judge.compare(pair[0], pair[1], &ray).at_sample == Ordering::Equal
        };
        primitives.iter().any(on_edge) || covering.windows(2).any(as_near)
    })
}
