//! Changes with numbers of their own, which the file suggests: planes that cut off what is near or far, and what is not drawn.
//!
//! They are too many to be tried each. A picture under other conventions tells which of them could explain where the
//! file is not as expected; each is then drawn as any other hypothesis.

use super::blank::blank_part;
use super::convention::{Between, Change, Clip, NearPlane, Omission, Several, ShapeKind};
use super::differences::Differences;
use super::encoding::IdEncoding;
use super::observed::Values;
use crate::common::frame::NO_PRIMITIVE;
use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap};

/// So many primitives, and so many objects, are suggested.
const MOST_OMISSIONS: usize = 2;
/// Fewer pixels are no evidence, nor are those of one row or column alone, unless all of it is blank: rounding takes as many.
const FEWEST_PIXELS: usize = 8;

impl Differences<'_> {
    /// The changes that could explain at least half of the differences.
    pub(super) fn suggested(&self) -> Vec<Change> {
        let differing = self.differs.iter().filter(|&&differs| differs).count();
        if differing < FEWEST_PIXELS {
            return Vec::new();
        }
        let lost = (0..self.differs.len()).filter(|&pixel| self.is_lost(pixel)).count();
        let part = explains(lost, differing).then(|| blank_part(self)).flatten();
        let part = part.map(|part| Change::Omission(Omission::Part(part)));
        let mut changes: Vec<Change> = part.into_iter().collect();
        if self.is_one_line() {
            return changes;
        }
        let seen = self.seen();
        changes.extend(self.omissions(&seen, differing).into_iter().map(Change::Omission));
        changes.extend(self.planes(&seen, differing, part.is_some()));
        changes
    }

    /// What is seen of each primitive.
    fn seen(&self) -> BTreeMap<u32, Seen> {
        let (ids, mut primitives) = (&self.expected.drawn.ids, BTreeMap::new());
        let mut begin = 0;
        for run in ids.chunk_by(PartialEq::eq) {
            let end = begin + run.len();
            if run[0] != NO_PRIMITIVE {
                let differing = self.differs[begin..end].iter().filter(|&&differs| differs).count();
                let one = Counts { seen: run.len(), differing, shown: 0 };
                let primitive = primitives.entry(run[0]).or_insert_with(|| self.unseen(run[0]));
                primitive.counts.add(one);
            }
            begin = end;
        }
        for (id, shown) in self.shown_ids() {
            if let Some(primitive) = primitives.get_mut(&id) {
                primitive.counts.shown = shown;
            }
        }
        primitives
    }

    fn unseen(&self, id: u32) -> Seen {
        let primitive = self.expected.view.primitive(id.into());
        Seen { counts: Counts::default(), shape: ShapeKind::of(&primitive) }
    }

    /// A near and a far plane. In a mask, a near plane is suggested only beside a blank part, as either may be the other.
    fn planes(
        &self,
        seen: &BTreeMap<u32, Seen>,
        differing: usize,
        beside_part: bool,
    ) -> Vec<Change> {
        // A file of ids shows the same number where the nearest hit of a sphere, or of an object, is cut off, and what lies behind
        // it is seen.
        let is_of_ids = matches!(self.observed.values, Values::Ids(_));
        let is_sphere = |id: u32| seen[&id].shape == ShapeKind::Sphere;
        let is_seen_behind_itself =
            |id: u32| is_of_ids && (self.encoding.ids == IdEncoding::OfObjects || is_sphere(id));
        let drawn = self.expected.drawn;
        let pixels = drawn.ids.iter().zip(&drawn.t).zip(&self.differs);
        let pixels = pixels.filter(|((id, _), _)| **id != NO_PRIMITIVE);
        let mut far: Vec<Hit> =
            pixels.map(|((&id, &t), &differs)| Hit { t, id, differs }).collect();
        far.sort_by(|one, other| one.t.total_cmp(&other.t));
        let near = far.iter().filter(|hit| hit.differs || !is_seen_behind_itself(hit.id)).copied();
        // What a mask covers, it covers also where a near plane shows what lies behind.
        let is_mask = matches!(self.observed.values, Values::Mask(_));
        let near = plane(near, differing).filter(|_| !is_mask || beside_part).map(|clip| {
            [false, true].map(|hides_spheres| Change::Near(NearPlane { clip, hides_spheres }))
        });
        // The rim of a sphere is where it is farthest: one that is too small looks like one that is cut off.
        let is_rim = |clip: &Clip| clip.alone.is_some_and(is_sphere);
        let far = plane(far.iter().rev().copied(), differing).filter(|clip| !is_rim(clip));
        near.into_iter().flatten().chain(far.map(Change::Far)).collect()
    }

    /// What the file shows nowhere where it is seen: primitives, objects, and all from some id on; of each those with most
    /// pixels.
    fn omissions(&self, seen: &BTreeMap<u32, Seen>, differing: usize) -> Vec<Omission> {
        let scene = self.expected.view.scene;
        let mut objects: BTreeMap<usize, Counts> = BTreeMap::new();
        for (&id, primitive) in seen {
            objects.entry(scene.locate(id.into()).0).or_default().add(primitive.counts);
        }
        let mut shapes: BTreeMap<ShapeKind, (usize, Counts)> = BTreeMap::new();
        for primitive in seen.values() {
            let (number, counts) = shapes.entry(primitive.shape).or_default();
            *number += 1;
            counts.add(primitive.counts);
        }
        let of_primitive =
            |(&id, one): (&u32, &Seen)| (Omission::of_primitive(scene, id), one.counts);
        let of_object =
            |(object, counts)| Omission::of_object(scene, object).map(|one| (one, counts));
        // A shape of one primitive, or all of the scene, has a name of its own.
        let several_shapes = shapes.len() > 1;
        let of_shape = |(shape, (number, counts))| {
            (number > 1 && several_shapes).then_some((Omission::Shape(shape), counts))
        };
        // A mask shows no difference where something lies behind.
        let hides_behind = matches!(self.observed.values, Values::Mask(_));
        let mut named: Vec<Vec<(Omission, Counts)>> = vec![
            seen.iter().map(of_primitive).collect(),
            objects.into_iter().filter_map(of_object).collect(),
            shapes.into_iter().filter_map(of_shape).collect(),
            last_ones(seen, &self.shown_ids()).into_iter().collect(),
        ];
        for candidates in &mut named {
            candidates.retain(|(_, counts)| {
                let is_missing = hides_behind || counts.is_missing();
                is_missing && explains(counts.differing, differing)
            });
            candidates.sort_by_key(|(_, counts)| Reverse(counts.differing));
            candidates.truncate(MOST_OMISSIONS);
        }
        let mut found = named.concat();
        // What has a name is not listed by its ids, too.
        let several = several(seen).filter(|(_, all)| {
            !hides_behind
                && explains(all.differing, differing)
                && !found.iter().any(|(_, counts)| counts.differing == all.differing)
        });
        found.extend(several);
        found.into_iter().map(|(omission, _)| omission).collect()
    }

    /// In how many pixels the file shows each primitive, if its numbers are those of primitives. What is shown somewhere is
    /// not left out.
    fn shown_ids(&self) -> HashMap<u32, usize> {
        let mut shown = HashMap::new();
        let Values::Ids(ids) = &self.observed.values else { return shown };
        let count = self.expected.view.scene.primitive_count();
        let id_of = |number: u64| match self.encoding.ids {
            IdEncoding::FromZero => Some(number),
            IdEncoding::CountedFrom(first) => number.checked_sub(first),
            IdEncoding::FromTheEnd => count.checked_sub(number.saturating_add(1)),
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

/// What is seen at a pixel, and whether the file differs there.
#[derive(Clone, Copy, Debug)]
struct Hit {
    t: f64,
    id: u32,
    differs: bool,
}

/// A primitive that is seen.
#[derive(Clone, Copy, Debug)]
struct Seen {
    counts: Counts,
    shape: ShapeKind,
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

/// All primitives that are missing, if they are a few.
fn several(seen: &BTreeMap<u32, Seen>) -> Option<(Omission, Counts)> {
    let missing = seen.iter().filter(|(_, one)| one.counts.is_missing());
    let missing = missing.take(Several::MOST + 1);
    let (ids, counts): (Vec<u32>, Vec<Counts>) = missing.map(|(&id, one)| (id, one.counts)).unzip();
    let mut all = Counts::default();
    counts.into_iter().for_each(|one| all.add(one));
    Several::new(&ids).map(|several| (Omission::Several(several), all))
}

/// All primitives from some id on, if the file shows none of them, and several of them are seen.
fn last_ones(
    seen: &BTreeMap<u32, Seen>,
    shown: &HashMap<u32, usize>,
) -> Option<(Omission, Counts)> {
    let mut all = Counts::default();
    let mut missing = Vec::new();
    let mut ids = seen.iter().rev();
    let last_kept = ids.find_map(|(&id, primitive)| {
        let is_kept = !primitive.counts.is_missing();
        if !is_kept {
            all.add(primitive.counts);
            missing.push(id);
        }
        is_kept.then_some(id)
    });
    let first = *missing.last()?;
    // Of those between them nothing is seen, unless the file shows some in the holes: the first that is missing may be any.
    let shown = shown.keys().copied().filter(|&id| id < first).max();
    let least = last_kept?.max(shown.unwrap_or(0)) + 1;
    (missing.len() > 1).then_some((Omission::From { least, first }, all))
}

/// Whether something explains enough of the differing pixels to be drawn.
fn explains(explained: usize, differing: usize) -> bool {
    explained >= FEWEST_PIXELS && 2 * explained >= differing
}

/// The plane before which the file differs, and behind which it does not, in the order of the distances: the one with
/// the fewest exceptions.
fn plane(hits: impl Iterator<Item = Hit>, differing: usize) -> Option<Clip> {
    /// The plane behind so many of the hits.
    struct Best {
        gained: isize,
        explained: usize,
        clip: Clip,
    }
    let (mut gained, mut explained) = (0, 0);
    let mut clipped: Option<u32> = None;
    let mut are_several = false;
    let mut best: Option<Best> = None;
    let mut previous: Option<f64> = None;
    for Hit { t, id, differs } in hits {
        if let Some(before) = previous.filter(|&before| before != t)
            && best.as_ref().is_none_or(|best| gained > best.gained)
        {
            let at = Between { nearer: before.min(t), farther: before.max(t) };
            let alone = clipped.filter(|_| !are_several);
            best = Some(Best { gained, explained, clip: Clip { at, alone } });
        }
        gained += if differs { 1 } else { -1 };
        if differs {
            explained += 1;
            are_several |= clipped.is_some_and(|other| other != id);
            clipped = Some(id);
        }
        previous = Some(t);
    }
    let best = best?;
    (best.gained > 0 && explains(best.explained, differing)).then_some(best.clip)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eight pixels at each distance.
    fn hits(of: &[(f64, u32, bool)]) -> Vec<Hit> {
        let eight = |&(t, id, differs): &(f64, u32, bool)| [Hit { t, id, differs }; 8];
        of.iter().flat_map(eight).collect()
    }

    #[test]
    fn a_plane_lies_between_what_is_lost_and_what_is_kept() {
        let near = hits(&[(1.0, 0, true), (1.5, 1, true), (2.0, 1, false), (3.0, 2, false)]);
        let at = Between { nearer: 1.5, farther: 2.0 };
        assert_eq!(plane(near.iter().copied(), 16), Some(Clip { at, alone: None }));
        let other = near.iter().map(|&hit| Hit { differs: !hit.differs, ..hit });
        let far: Vec<Hit> = other.collect();
        assert_eq!(plane(far.into_iter().rev(), 16), Some(Clip { at, alone: None }));
        // One primitive alone may end there.
        let alone = hits(&[(1.0, 7, true), (2.0, 7, false), (3.0, 8, false)]);
        let at = Between { nearer: 1.0, farther: 2.0 };
        assert_eq!(plane(alone.into_iter(), 8), Some(Clip { at, alone: Some(7) }));
    }

    #[test]
    fn equal_distances_lie_on_one_side_of_a_plane() {
        let one_wall = hits(&[(2.0, 0, true), (2.0, 0, false)]);
        assert_eq!(plane(one_wall.into_iter(), 8), None);
    }

    #[test]
    fn differences_at_all_distances_suggest_no_plane() {
        let mixed = (0..100).map(|k| Hit { t: f64::from(k), id: k, differs: k % 2 == 0 });
        assert_eq!(plane(mixed, 50), None);
    }

    #[test]
    fn a_few_pixels_are_no_evidence() {
        let few = (0..100).map(|k| Hit { t: f64::from(k), id: k, differs: k < 7 });
        assert_eq!(plane(few, 7), None);
        let enough = (0..100).map(|k| Hit { t: f64::from(k), id: k, differs: k < 8 });
        assert!(plane(enough, 8).is_some());
    }

    #[test]
    fn the_first_that_is_missing_lies_behind_what_the_file_shows() {
        let one = |differing: usize| {
            let counts = Counts { seen: 9, differing, shown: 9 - differing };
            Seen { counts, shape: ShapeKind::Triangle }
        };
        let seen = BTreeMap::from([(2, one(0)), (8, one(9)), (9, one(9))]);
        for (shown, least) in [(None, 3), (Some((5, 4)), 6)] {
            let (omission, counts) = last_ones(&seen, &shown.into_iter().collect()).unwrap();
            assert_eq!(omission, Omission::From { least, first: 8 });
            assert_eq!(counts.differing, 18);
        }
    }
}
