//! Changes with numbers of their own, which the file suggests: planes that cut off what is near or far, and what is not drawn.
//!
//! They are too many to be tried each. A picture under other conventions tells which of them could explain where the
//! file is not as expected; each is then drawn as any other hypothesis.

use super::convention::{Between, Change, NearPlane, Omission};
use super::encoding::{Encoding, IdEncoding};
use super::expected::Expected;
use super::observed::{Observed, Values};
use crate::common::Primitive;
use crate::common::frame::NO_PRIMITIVE;
use crate::diff::why::Placement;
use std::collections::{BTreeMap, HashMap};

/// So many primitives, and so many objects, are suggested.
const MOST_OMISSIONS: usize = 2;

/// Where the file differs from a picture.
pub(super) struct Differences<'a> {
    expected: &'a Expected<'a>,
    observed: &'a Observed,
    encoding: Encoding,
    /// Whether it does, for each pixel of the picture, row by row.
    differs: Vec<bool>,
}

impl<'a> Differences<'a> {
    pub(super) fn new(
        expected: &'a Expected<'a>,
        observed: &'a Observed,
        placement: Placement,
        encoding: Encoding,
    ) -> Differences<'a> {
        let mut differs = Vec::with_capacity(expected.drawn.ids.len());
        expected.each(observed, placement, &encoding, |_, is_other, _| differs.push(is_other));
        Differences { expected, observed, encoding, differs }
    }

    /// The changes that could explain at least half of the differences.
    pub(super) fn suggested(&self) -> Vec<Change> {
        let differing = self.differs.iter().filter(|&&differs| differs).count();
        if differing == 0 {
            return Vec::new();
        }
        let mut changes: Vec<Change> =
            self.omissions(differing).into_iter().map(Change::Omission).collect();
        // What a mask covers, it covers also where a near plane shows what lies behind.
        if matches!(self.observed.values, Values::Mask(_)) {
            return changes;
        }
        let seen = |tells: &dyn Fn(u32) -> bool| {
            let mut seen = self.seen_distances(tells);
            seen.sort_by(|one, other| one.0.total_cmp(&other.0));
            seen
        };
        if let Some(at) = plane(seen(&|id| !self.is_seen_behind_itself(id)).into_iter(), differing)
        {
            let near = [false, true].map(|hides_spheres| NearPlane { at, hides_spheres });
            changes.extend(near.map(Change::Near));
        }
        changes.extend(plane(seen(&|_| true).into_iter().rev(), differing).map(Change::Far));
        changes
    }

    /// The distance of what is seen at each pixel, and whether the file differs there; without those in which it does not, though a
    /// plane may lie behind them.
    fn seen_distances(&self, tells: &dyn Fn(u32) -> bool) -> Vec<(f64, bool)> {
        let drawn = self.expected.drawn;
        let pixels = drawn.ids.iter().zip(&drawn.t).zip(&self.differs);
        let seen =
            pixels.filter(|((id, _), differs)| **id != NO_PRIMITIVE && (**differs || tells(**id)));
        seen.map(|((_, &t), &differs)| (t, differs)).collect()
    }

    /// Whether a file shows the same number where the nearest hit of a primitive is cut off, and what lies behind it is seen: the
    /// other side of a sphere, or of an object.
    fn is_seen_behind_itself(&self, id: u32) -> bool {
        let is_of_ids = matches!(self.observed.values, Values::Ids(_));
        is_of_ids && (self.encoding.ids == IdEncoding::OfObjects || self.is_sphere(id))
    }

    fn is_sphere(&self, id: u32) -> bool {
        matches!(self.expected.view.primitive(id.into()), Primitive::Sphere { .. })
    }

    /// What the file shows nowhere where it is seen: primitives, objects, and all from some id on; of each those with most
    /// pixels.
    fn omissions(&self, differing: usize) -> Vec<Omission> {
        let scene = self.expected.view.scene;
        let primitives = self.primitives();
        let mut objects: BTreeMap<usize, Counts> = BTreeMap::new();
        for (&id, &counts) in &primitives {
            objects.entry(scene.locate(id.into()).0).or_default().add(counts);
        }
        let of_primitive = |(&id, &counts)| Some((Omission::of_primitive(scene, id), counts));
        let of_object =
            |(object, counts)| Omission::of_object(scene, object).map(|one| (one, counts));
        // A mask shows no difference where something lies behind.
        let hides_behind = matches!(self.observed.values, Values::Mask(_));
        let mut found = Vec::new();
        for mut candidates in [
            primitives.iter().filter_map(of_primitive).collect::<Vec<_>>(),
            objects.into_iter().filter_map(of_object).collect(),
            last_ones(&primitives).into_iter().collect(),
        ] {
            candidates.retain(|(_, counts)| {
                let is_missing = hides_behind || counts.is_missing();
                is_missing && explains(counts.differing, differing)
            });
            candidates.sort_by_key(|(_, counts)| std::cmp::Reverse(counts.differing));
            found.extend(candidates.into_iter().take(MOST_OMISSIONS).map(|(omission, _)| omission));
        }
        found
    }

    /// The primitives that are seen.
    fn primitives(&self) -> BTreeMap<u32, Counts> {
        let mut primitives: BTreeMap<u32, Counts> = BTreeMap::new();
        for (&id, &differs) in self.expected.drawn.ids.iter().zip(&self.differs) {
            if id != NO_PRIMITIVE {
                let one = Counts { seen: 1, differing: differs.into(), shown: 0 };
                primitives.entry(id).or_default().add(one);
            }
        }
        for (id, shown) in self.shown_ids() {
            if let Some(counts) = primitives.get_mut(&id) {
                counts.shown = shown;
            }
        }
        primitives
    }

    /// In how many pixels the file shows each primitive, if its numbers are those of primitives. What is shown somewhere is
    /// not left out.
    fn shown_ids(&self) -> HashMap<u32, usize> {
        let mut shown = HashMap::new();
        let Values::Ids(ids) = &self.observed.values else { return shown };
        let count = self.expected.view.scene.primitive_count();
        let id_of = |number: u64| match self.encoding.ids {
            IdEncoding::FromZero => Some(number),
            IdEncoding::FromOne => number.checked_sub(1),
            IdEncoding::FromTheEnd => count.checked_sub(number + 1),
            IdEncoding::OfObjects | IdEncoding::OneToOne => None,
        };
        for run in ids.chunk_by(PartialEq::eq) {
            if let Some(id) = run[0].and_then(id_of).and_then(|id| u32::try_from(id).ok()) {
                *shown.entry(id).or_insert(0) += run.len();
            }
        }
        shown
    }
}

/// In how many pixels something is seen, in how many of them the file differs, and in how many pixels the file shows it.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    seen: usize,
    differing: usize,
    shown: usize,
}

impl Counts {
    fn add(&mut self, other: Counts) {
        self.seen += other.seen;
        self.differing += other.differing;
        self.shown += other.shown;
    }

    /// Whether the file shows it nowhere. A few pixels may be right by accident, or show it by mistake.
    fn is_missing(self) -> bool {
        32 * (self.seen - self.differing) <= self.seen && 32 * self.shown <= self.seen
    }
}

/// All primitives from some id on, if the file shows none of them, and several of them are seen.
fn last_ones(primitives: &BTreeMap<u32, Counts>) -> Option<(Omission, Counts)> {
    let missing = primitives.iter().rev().take_while(|(_, counts)| counts.is_missing());
    let (mut all, mut first, mut number) = (Counts::default(), 0, 0);
    for (&id, &counts) in missing {
        all.add(counts);
        (first, number) = (id, number + 1);
    }
    (number > 1).then_some((Omission::From(first), all))
}

/// Whether something explains enough of the differing pixels to be drawn.
fn explains(explained: usize, differing: usize) -> bool {
    2 * explained >= differing
}

/// The plane before which the file differs, and behind which it does not, in the order of the distances: the one with
/// the fewest exceptions.
fn plane(seen: impl Iterator<Item = (f64, bool)>, differing: usize) -> Option<Between> {
    let (mut gained, mut explained) = (0_isize, 0);
    let mut best: Option<(isize, usize, Between)> = None;
    let mut previous: Option<f64> = None;
    for (t, differs) in seen {
        if let Some(before) = previous.filter(|&before| before != t)
            && best.is_none_or(|(most, ..)| gained > most)
        {
            let between = Between { nearer: before.min(t), farther: before.max(t) };
            best = Some((gained, explained, between));
        }
        gained += if differs { 1 } else { -1 };
        explained += usize::from(differs);
        previous = Some(t);
    }
    let (gained, explained, between) = best?;
    (gained > 0 && explains(explained, differing)).then_some(between)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_lies_between_what_is_lost_and_what_is_kept() {
        let near = [(1.0, true), (1.5, true), (2.0, false), (3.0, false)];
        let found = plane(near.into_iter(), 2);
        assert_eq!(found, Some(Between { nearer: 1.5, farther: 2.0 }));
        let far = near.map(|(t, differs)| (t, !differs));
        let found = plane(far.into_iter().rev(), 2);
        assert_eq!(found, Some(Between { nearer: 1.5, farther: 2.0 }));
    }

    #[test]
    fn equal_distances_lie_on_one_side_of_a_plane() {
        let one_wall = [(2.0, true), (2.0, true), (2.0, false), (2.0, false)];
        assert_eq!(plane(one_wall.into_iter(), 2), None);
    }

    #[test]
    fn differences_at_all_distances_suggest_no_plane() {
        let mixed = (0..100_u32).map(|k| (f64::from(k), k % 2 == 0));
        assert_eq!(plane(mixed, 50), None);
    }
}
