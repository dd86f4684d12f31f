//! Primitives that a file lacks and does not count: those behind them have smaller ids than here.
//!
//! So looks a mesh that is read without some of its faces. Which number stands for which primitive, most pixels of each tell; of
//! primitives in the order of the scene, the numbers ascend, and fall behind our ids. A primitive between two that fall
//! behind equally far is there; what is seen and has no number is missing, and shows what lies behind it. The scene is drawn again
//! without those until nothing is left that is missing.

use super::convention::Convention;
use super::draw::draw_those;
use super::drawn::{Drawn, Rows};
use crate::common::frame::NO_PRIMITIVE;
use crate::common::{Scene, View};
use std::borrow::Cow;
use std::collections::HashSet;
use std::ops::Range;

/// Primitives that are missing, and not counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing {
    /// Their number; about that, if they are scattered.
    pub count: u32,
    /// The first and the last id of those among which they are.
    pub among: [u32; 2],
    /// How much smaller the ids behind them are.
    pub shift: u32,
    /// What they are a part of, if they do not lie beside each other.
    pub scattered: Option<Scattered>,
    /// Whether the first or the last primitive of a mesh may be one of them.
    pub at_an_end: bool,
}

/// Missing primitives that do not lie beside each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scattered {
    /// Their object.
    pub object: usize,
    /// Whether it is every second one.
    pub is_every_second: bool,
}

/// What is found of a file.
pub(super) struct Renumbered {
    pub(super) missing: Vec<Missing>,
    /// Whether each pixel differs from the picture without what is missing.
    pub(super) differs: Vec<bool>,
}

/// So often more is looked for behind what is missing.
const MOST_LAYERS: usize = 16;
/// More gaps between ids of one object are no single places.
const FEW_GAPS: usize = 2;
/// One in so many of the differing pixels may be left.
const LEFT: usize = 50;
/// One in so many of the pixels in which something missing should be seen.
const LEFT_IN_HOLES: usize = 4;
/// Fewer primitives with smaller ids are no evidence.
const FEWEST: usize = 2;

/// The primitives that are missing, if that explains nearly all of the differing pixels of a file of ids.
pub(super) fn renumbered(view: &View, truth: &Drawn, ids: &[Option<u64>]) -> Option<Renumbered> {
    let wrong = |pixel: usize| ids[pixel] != seen(truth, pixel).map(u64::from);
    let differing = (0..ids.len()).filter(|&pixel| wrong(pixel)).count();
    let mut gone: HashSet<u32> = HashSet::new();
    let mut drawn = Cow::Borrowed(truth);
    let mut numbers = Numbers::new(&drawn, ids);
    for _ in 0..MOST_LAYERS {
        if !numbers.tell(ids) {
            return None;
        }
        let seen = drawn.ids.iter().filter(|&&id| id != NO_PRIMITIVE);
        let fresh: HashSet<u32> =
            seen.copied().filter(|&id| numbers.number(id).is_none()).collect();
        if fresh.is_empty() {
            break;
        }
        gone.extend(fresh);
        let is_there = |id: u32| !gone.contains(&id);
        drawn = Cow::Owned(draw_those(view, &Convention::default(), Rows::ALL, is_there));
        numbers = Numbers::new(&drawn, ids);
    }
    let expected = |pixel: usize| seen(&drawn, pixel).map(|id| numbers.number(id));
    let differs: Vec<bool> = (0..ids.len())
        .map(|pixel| match expected(pixel) {
            None => ids[pixel].is_some(),
            Some(number) => number.is_none() || ids[pixel] != number,
        })
        .collect();
    let left = differs.iter().filter(|&&differs| differs).count();
    let is_hole = |pixel: &usize| seen(truth, *pixel).is_some_and(|id| gone.contains(&id));
    let holes: Vec<usize> = (0..ids.len()).filter(is_hole).collect();
    let left_in_holes = holes.iter().filter(|&&pixel| differs[pixel]).count();
    let explains = LEFT * left <= differing && LEFT_IN_HOLES * left_in_holes <= holes.len();
    (explains && numbers.tell(ids))
        .then(|| Renumbered { missing: numbers.missing(view.scene), differs })
}

/// The primitive that is seen at a pixel.
fn seen(drawn: &Drawn, pixel: usize) -> Option<u32> {
    Some(drawn.ids[pixel]).filter(|&id| id != NO_PRIMITIVE)
}

/// A primitive, and the number that the file has for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Link {
    id: u32,
    number: u32,
    pixels: usize,
}

impl Link {
    fn shift(self) -> u32 {
        self.id - self.number
    }
}

/// Primitives that have a number in a file, ascending; their numbers ascend, too, and by no more than their ids.
struct Numbers(Vec<Link>);

/// A place between two primitives that have numbers, at which some are missing.
struct Gap {
    ids: Range<u32>,
    count: u32,
    /// The shift behind it.
    shift: u32,
}

impl Numbers {
    /// The numbers of a file by what most pixels of each primitive show.
    fn new(drawn: &Drawn, ids: &[Option<u64>]) -> Numbers {
        let pixels = drawn.ids.iter().zip(ids).filter(|(id, _)| **id != NO_PRIMITIVE);
        let mut votes: Vec<(u32, Option<u64>)> = pixels.map(|(&id, &shown)| (id, shown)).collect();
        votes.sort_unstable();
        let of_primitive = votes.chunk_by(|one, other| one.0 == other.0);
        let links = of_primitive.filter_map(|votes| {
            let most = votes.chunk_by(PartialEq::eq).max_by_key(|votes| votes.len())?;
            let (id, number) = (most[0].0, u32::try_from(most[0].1?).ok()?);
            let is_likely = number <= id && 2 * most.len() > votes.len();
            is_likely.then_some(Link { id, number, pixels: most.len() })
        });
        Numbers(heaviest_chain(links.collect()))
    }

    /// Whether they tell that something is missing: some ids are smaller than ours, and they are those of much of what is shown.
    fn tell(&self, ids: &[Option<u64>]) -> bool {
        let shown = ids.iter().flatten().count();
        let known: usize = self.0.iter().map(|link| link.pixels).sum();
        let smaller = self.0.iter().filter(|link| link.shift() > 0).count();
        smaller >= FEWEST && 4 * known >= shown
    }

    /// The number of a primitive; `None` if it is missing, or nothing tells.
    fn number(&self, id: u32) -> Option<u64> {
        let behind = self.0.partition_point(|link| link.id < id);
        let next = self.0.get(behind)?;
        let before = behind.checked_sub(1).map_or(0, |at| self.0[at].shift());
        (next.id == id || next.shift() == before).then(|| (id - next.shift()).into())
    }

    /// The places at which something is missing.
    fn gaps(&self) -> Vec<Gap> {
        let mut gaps = Vec::new();
        let (mut begin, mut before) = (0, 0);
        for link in &self.0 {
            let shift = link.shift();
            if shift > before {
                gaps.push(Gap { ids: begin..link.id, count: shift - before, shift });
            }
            (begin, before) = (link.id + 1, shift);
        }
        gaps
    }

    /// What is missing, in few words: single places, and objects in which there are many of them.
    fn missing(&self, scene: &Scene) -> Vec<Missing> {
        let object = |id: u32| scene.locate(id.into()).0;
        let mut missing: Vec<Missing> = Vec::new();
        let gaps = self.gaps();
        // A gap that reaches into the next object belongs to the one in which it begins.
        for gaps in gaps.chunk_by(|one, other| object(one.ids.start) == object(other.ids.start)) {
            let object = object(gaps[0].ids.start);
            if gaps.len() <= FEW_GAPS {
                missing.extend(gaps.iter().map(|gap| Missing {
                    count: gap.count,
                    among: [gap.ids.start, gap.ids.end - 1],
                    shift: gap.shift,
                    scattered: None,
                    at_an_end: reaches_an_end(scene, &gap.ids),
                }));
                continue;
            }
            let ids = scene.ids_of(object);
            let last = gaps.last().map_or(0, |gap| gap.shift);
            let [first_id, last_id] = [ids.start, ids.end - 1]
                .map(|id| u32::try_from(id).expect("ids are numbers of 32 bits"));
            let is_every_second = self.is_every_second(first_id..last_id + 1);
            missing.push(Missing {
                count: gaps.iter().map(|gap| gap.count).sum(),
                among: [first_id, last_id],
                shift: last,
                scattered: Some(Scattered { object, is_every_second }),
                at_an_end: false,
            });
        }
        missing
    }

    /// Whether of some primitives nearly all that have a number are the first of two, or the second, and half of all have one.
    fn is_every_second(&self, ids: Range<u32>) -> bool {
        let links: Vec<&Link> = self.0.iter().filter(|link| ids.contains(&link.id)).collect();
        let odd = links.iter().filter(|link| (link.id - ids.start) % 2 == 1).count();
        let are_alike = 50 * odd.min(links.len() - odd) <= links.len();
        let halves = links.windows(2).filter(|pair| {
            let [ids, numbers] = [pair[1].id - pair[0].id, pair[1].number - pair[0].number];
            ids == 2 * numbers
        });
        are_alike && 50 * (halves.count() + 1) >= 49 * links.len()
    }
}

/// Whether the first or the last primitive of an object of several may be among some.
fn reaches_an_end(scene: &Scene, ids: &Range<u32>) -> bool {
    let mut ends = [ids.start, ids.end - 1].into_iter();
    ends.any(|id| {
        let own = scene.ids_of(scene.locate(id.into()).0);
        let is_end = |end: u64| u32::try_from(end).is_ok_and(|end| ids.contains(&end));
        own.end - own.start > 1 && (is_end(own.start) || is_end(own.end - 1))
    })
}

/// Of links with ascending ids those with most pixels of which the numbers ascend, and the shifts do not fall.
fn heaviest_chain(mut links: Vec<Link>) -> Vec<Link> {
    let mut shifts: Vec<u32> = links.iter().map(|link| link.shift()).collect();
    shifts.sort_unstable();
    shifts.dedup();
    // With equal numbers the largest shift comes first: it lies before none of the others.
    links.sort_unstable_by_key(|link| (link.number, std::cmp::Reverse(link.id)));
    // For each shift, the heaviest chain that ends with it or a smaller one, in a tree of prefixes.
    let mut best: Vec<(usize, Option<usize>)> = vec![(0, None); shifts.len() + 1];
    let mut before: Vec<Option<usize>> = Vec::with_capacity(links.len());
    for (at, link) in links.iter().enumerate() {
        let rank = shifts.partition_point(|&shift| shift < link.shift()) + 1;
        let (mut weight, mut last) = (0, None);
        let mut node = rank;
        while node > 0 {
            if best[node].0 > weight {
                (weight, last) = best[node];
            }
            node &= node - 1;
        }
        before.push(last);
        let own = weight + link.pixels;
        let mut node = rank;
        while node < best.len() {
            if best[node].0 < own {
                best[node] = (own, Some(at));
            }
            node += node & node.wrapping_neg();
        }
    }
    let mut chain = Vec::new();
    let mut at = best.iter().max_by_key(|(weight, _)| *weight).and_then(|(_, last)| *last);
    while let Some(link) = at {
        chain.push(links[link]);
        at = before[link];
    }
    chain.reverse();
    chain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn links(of: &[(u32, u32, usize)]) -> Vec<Link> {
        of.iter().map(|&(id, number, pixels)| Link { id, number, pixels }).collect()
    }

    #[test]
    fn the_chain_leaves_out_what_does_not_fit() {
        // One number for two primitives, a number that is too large, and one that falls behind too far.
        let all = links(&[(0, 0, 5), (1, 0, 4), (2, 1, 9), (4, 4, 3), (6, 1, 2), (8, 6, 7)]);
        assert_eq!(heaviest_chain(all), links(&[(0, 0, 5), (2, 1, 9), (8, 6, 7)]));
        assert_eq!(heaviest_chain(Vec::new()), []);
    }

    #[test]
    fn what_lies_between_two_with_one_shift_is_there() {
        let numbers = Numbers(links(&[(2, 2, 1), (5, 4, 1), (9, 8, 1), (12, 8, 1)]));
        let of = |id: u32| numbers.number(id);
        assert_eq!([0, 1, 2].map(of), [Some(0), Some(1), Some(2)]);
        assert_eq!([3, 4].map(of), [None; 2]);
        assert_eq!([5, 7, 9].map(of), [Some(4), Some(6), Some(8)]);
        assert_eq!([10, 12, 13].map(of), [None, Some(8), None]);
    }
}
