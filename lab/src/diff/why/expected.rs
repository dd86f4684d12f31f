//! A picture as the numbers of a file should show it, and how far a file is from it.

use super::convention::{Convention, Placement};
use super::drawn::Drawn;
use super::encoding::{DistanceEncoding, Encoding, IdEncoding, NothingEncoding, linear, window};
use super::numbering::Numbering;
use super::observed::{Observed, Values};
use super::rays::ViewingRays;
use super::renaming::Renaming;
use crate::common::View;
use crate::common::frame::NO_PRIMITIVE;
use std::cell::OnceCell;

/// How far a file differs from a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Score {
    /// Pixels that differ in anything.
    pub(super) differing: u64,
    /// Pixels that differ in coverage.
    pub(super) coverage: u64,
    /// Pixels in which the file has what it should, and not our number of nothing. (Where another number stands for nothing,
    /// pixels of nothing count, too.)
    pub(super) shown: u64,
    /// Pixels that contradict the number that a primitive has elsewhere, where each has a number of its own.
    pub(super) contradicting: u64,
}

/// A picture as the numbers of a file should show it.
pub(super) struct Expected<'a> {
    pub(super) view: &'a View<'a>,
    pub(super) drawn: &'a Drawn,
    rays: ViewingRays,
    /// Evenly spread pixels that show something, of which the probes are some.
    seen: OnceCell<Vec<DrawnPixel>>,
}

/// The most pixels by which an encoding is chosen.
const PROBES: usize = 512;

impl<'a> Expected<'a> {
    pub(super) fn new(view: &'a View<'a>, convention: &Convention, drawn: &'a Drawn) -> Self {
        let rays = ViewingRays::new(view.camera, convention);
        Expected { view, drawn, rays, seen: OnceCell::new() }
    }

    /// The encoding under which the file agrees best with the picture, by a few of their pixels.
    pub(super) fn encoding(
        &self,
        observed: &Observed,
        placement: Placement,
        nothing: NothingEncoding,
    ) -> Encoding {
        let base = Encoding { nothing, ..Encoding::default() };
        match &observed.values {
            Values::Mask(_) => base,
            Values::Ids(ids) => {
                let probes = self.probes(observed, placement, nothing);
                let from_one = IdEncoding::CountedFrom(1);
                let others = [from_one, IdEncoding::FromTheEnd, IdEncoding::OfObjects];
                let others = others.into_iter().chain(self.first_number(ids, &probes));
                let others = others.map(|ids| Encoding { ids, ..base });
                most_agreeing(base, others, |encoding| {
                    let numbering = self.numbering(encoding.ids);
                    let number = |probe: &Probe| numbering.number(self.drawn.ids[probe.at.pixel]);
                    probes.iter().filter(|probe| ids[probe.index] == Some(number(probe))).count()
                })
            }
            Values::Distances(t) => {
                let probes = self.probes(observed, placement, nothing);
                let others = self.distance_encodings(t, &probes).into_iter();
                let others = others.map(|distances| Encoding { distances, ..base });
                most_agreeing(base, others, |encoding| {
                    let encoding = encoding.distances;
                    let number = |probe: &Probe| self.number(probe.at, encoding);
                    let agrees = |probe: &&Probe| encoding.holds(t[probe.index], number(probe));
                    probes.iter().filter(agrees).count()
                })
            }
        }
    }

    /// Pixels that both cover, evenly spread.
    fn probes(
        &self,
        observed: &Observed,
        placement: Placement,
        nothing: NothingEncoding,
    ) -> Vec<Probe> {
        let place = IndexMap::new(placement, self.size());
        let seen = self.seen.get_or_init(|| self.some_that_are_seen()).iter();
        let placed = seen.map(|&at| Probe { at, index: place.index([at.row, at.column]) });
        let mut found: Vec<Probe> =
            placed.filter(|probe| observed.covered(probe.index, nothing)).collect();
        let step = found.len().div_ceil(PROBES);
        if step > 1 {
            found = found.into_iter().step_by(step).collect();
        }
        found
    }

    /// Evenly spread pixels, those of them that show something.
    fn some_that_are_seen(&self) -> Vec<DrawnPixel> {
        let (pixels, width) = (self.drawn.ids.len(), self.rays.x.len());
        let step = (pixels / (PROBES * 4)).max(1);
        let is_seen = |pixel: &usize| self.drawn.ids[*pixel] != NO_PRIMITIVE;
        let seen = (0..pixels).step_by(step).filter(is_seen);
        let at = |pixel: usize| {
            let (row, column) = (self.drawn.rows[pixel / width], pixel % width);
            DrawnPixel { pixel, row, column }
        };
        seen.map(at).collect()
    }

    /// Width and height of the picture.
    pub(super) fn size(&self) -> [usize; 2] {
        [self.rays.x.len(), self.rays.y.len()]
    }

    /// The number above 1 from which most primitives count, of those at the probes. One primitive alone counts from any.
    fn first_number(&self, ids: &[Option<u64>], probes: &[Probe]) -> Option<IdEncoding> {
        let difference = |probe: &Probe| {
            let id = self.drawn.ids[probe.at.pixel];
            Some((ids[probe.index]?.checked_sub(id.into())?, id))
        };
        let mut counted: Vec<(u64, u32)> = probes.iter().filter_map(difference).collect();
        counted.sort_unstable();
        counted.dedup();
        let of_number = counted.chunk_by(|one, other| one.0 == other.0);
        let several = of_number.filter(|ids| ids[0].0 > 1 && ids.len() > 1);
        let (number, _) = several.max_by_key(|ids| ids.len())?[0];
        Some(IdEncoding::CountedFrom(number))
    }

    fn distance_encodings(&self, t: &[f64], probes: &[Probe]) -> Vec<DistanceEncoding> {
        use DistanceEncoding::{
            AlongAxis, AlongRay, NegativeAlongAxis, NegativeAlongRay, NegativeT,
        };
        let mut encodings =
            vec![AlongAxis, AlongRay, NegativeT, NegativeAlongAxis, NegativeAlongRay];
        // A window depth is A + B/z: two probes, as far from each other as can be, give A and B.
        let depth = |probe: &Probe| self.number(probe.at, DistanceEncoding::AlongAxis);
        let nearest = probes.iter().min_by(|a, b| depth(a).total_cmp(&depth(b)));
        let farthest = probes.iter().max_by(|a, b| depth(a).total_cmp(&depth(b)));
        if let (Some(nearest), Some(farthest)) = (nearest, farthest) {
            let [z0, z1] = [nearest, farthest].map(depth);
            let [w0, w1] = [nearest, farthest].map(|probe| t[probe.index]);
            encodings.extend(window([z0, w0], [z1, w1]));
            encodings.extend(self.linear_encoding(t, probes, [nearest, farthest]));
        }
        encodings
    }

    /// A linear function of `t`, by the nearest and the farthest probe and the one that is nearest to the middle of both.
    fn linear_encoding(
        &self,
        t: &[f64],
        probes: &[Probe],
        ends: [&Probe; 2],
    ) -> Option<DistanceEncoding> {
        let distance = |probe: &Probe| self.number(probe.at, DistanceEncoding::T);
        let middle = f64::midpoint(distance(ends[0]), distance(ends[1]));
        let off = |probe: &Probe| (distance(probe) - middle).abs();
        let between = probes.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
        let point = |probe: &Probe| [distance(probe), t[probe.index]];
        linear([ends[0], between, ends[1]].map(point))
    }

    /// The number that an encoding writes for the distance in a pixel.
    fn number(&self, at: DrawnPixel, encoding: DistanceEncoding) -> f64 {
        let t = self.drawn.t[at.pixel];
        let axis = || t * self.rays.axis().length();
        let ray = || t * self.rays.ray(at.row, at.column).direction.length();
        match encoding {
            DistanceEncoding::T => t,
            DistanceEncoding::AlongAxis => axis(),
            DistanceEncoding::AlongRay => ray(),
            DistanceEncoding::NegativeT => -t,
            DistanceEncoding::NegativeAlongAxis => -axis(),
            DistanceEncoding::NegativeAlongRay => -ray(),
            DistanceEncoding::Linear { factor, offset } => factor * t + offset,
            DistanceEncoding::Window { near, far } => far / (far - near) * (1.0 - near / axis()),
            DistanceEncoding::ReversedWindow { near, far } => {
                1.0 - far / (far - near) * (1.0 - near / axis())
            }
        }
    }

    /// The `t` for which an encoding writes a number in a pixel; `None` where it tells only with what lies in other pixels.
    pub(super) fn t_of(
        &self,
        number: f64,
        [row, column]: [usize; 2],
        encoding: DistanceEncoding,
    ) -> Option<f64> {
        let along_ray = || self.rays.ray(row, column).direction.length();
        let t = match encoding {
            DistanceEncoding::T => number,
            DistanceEncoding::AlongAxis => number / self.rays.axis().length(),
            DistanceEncoding::AlongRay => number / along_ray(),
            DistanceEncoding::NegativeT => -number,
            DistanceEncoding::NegativeAlongAxis => -number / self.rays.axis().length(),
            DistanceEncoding::NegativeAlongRay => -number / along_ray(),
            _ => return None,
        };
        Some(t).filter(|t| t.is_finite() && *t > 0.0)
    }

    /// The numbers that stand for the primitives of the scene.
    pub(super) fn numbering(&self, encoding: IdEncoding) -> Numbering<'a> {
        Numbering::new(self.view.scene, encoding)
    }

    /// The pixels in which the file differs from the picture, among the drawn rows. Names of a few primitives are no
    /// numbering: then all pixels differ, and more.
    pub(super) fn score(
        &self,
        observed: &Observed,
        placement: Placement,
        encoding: &Encoding,
    ) -> Score {
        let mut score = Score::default();
        let renaming = self.each(observed, placement, encoding, |at, differs, covers_otherwise| {
            score.differing += u64::from(differs);
            score.coverage += u64::from(covers_otherwise);
            score.shown += u64::from(!differs && observed.covered(at, NothingEncoding::Ours));
        });
        if encoding.ids == IdEncoding::OneToOne {
            score.contradicting = renaming.contradicting();
            if !renaming.is_general() {
                score.differing = u64::MAX;
            }
        }
        score
    }

    /// How well a hypothesis does. If nothing is seen under it, and something in the file, all pixels differ: to see nothing
    /// explains no file that shows something, however much of it is missing there.
    pub(super) fn score_of_hypothesis(
        &self,
        observed: &Observed,
        placement: Placement,
        encoding: &Encoding,
    ) -> Score {
        let mut score = self.score(observed, placement, encoding);
        let sees_nothing = self.drawn.ids.iter().all(|&id| id == NO_PRIMITIVE);
        if sees_nothing && score.coverage > 0 {
            let pixels = self.drawn.ids.len() as u64;
            score.differing = score.differing.max(pixels);
            score.coverage = pixels;
        }
        score
    }

    /// How deep along the axis of the view lies what a pixel shows, from the eye of a perspective camera or the viewport of a
    /// parallel one.
    pub(super) fn depth(&self, pixel: usize) -> f64 {
        self.depth_of(self.drawn.t[pixel])
    }

    /// How deep lies what is seen at `t`.
    pub(super) fn depth_of(&self, t: f64) -> f64 {
        t * self.rays.distance
    }

    /// Tells of every drawn pixel: its index among the drawn ones, the index in the file, its row and its column.
    pub(super) fn each_pixel(
        &self,
        placement: Placement,
        mut tell: impl FnMut(usize, usize, [usize; 2]),
    ) {
        let place = IndexMap::new(placement, self.size());
        let width = self.rays.x.len();
        for (line, &row) in self.drawn.rows.iter().enumerate() {
            for ((column, index), pixel) in place.row(row, width).enumerate().zip(line * width..) {
                tell(pixel, index, [row, column]);
            }
        }
    }

    /// Tells of every drawn pixel: the index in the file, whether the two differ, and whether they differ in coverage.
    /// Returns the names of the primitives, if they have names of their own.
    pub(super) fn each(
        &self,
        observed: &Observed,
        placement: Placement,
        encoding: &Encoding,
        tell: impl FnMut(usize, bool, bool),
    ) -> Renaming {
        let mut renaming = Renaming::default();
        let (drawn, nothing) = (self.drawn, encoding.nothing);
        let is_seen = |pixel: &usize| drawn.ids[*pixel] != NO_PRIMITIVE;
        // What kind of file it is, is asked once, and not in each of the many pixels.
        match &observed.values {
            Values::Mask(mask) => {
                let shown = |index| nothing.covers(mask[index]).then_some(());
                let expected = |pixel, _| Some(pixel).filter(is_seen).map(|_| ());
                self.compare(placement, shown, expected, |(), ()| true, tell);
            }
            Values::Ids(ids) => {
                let shown = |index: usize| ids[index].filter(|&id| !nothing.matches_id(id));
                let seen = |pixel| Some(pixel).filter(is_seen).map(|pixel| drawn.ids[pixel]);
                if encoding.ids == IdEncoding::OneToOne {
                    let agree = |number, id| renaming.holds(id, number);
                    self.compare(placement, shown, |pixel, _| seen(pixel), agree, tell);
                } else {
                    let numbering = self.numbering(encoding.ids);
                    // If 0 is nothing and ids count from 0, the first primitive looks like nothing.
                    let is_zero = nothing == NothingEncoding::Number(0.0);
                    let expected = |pixel, _| {
                        let number = seen(pixel).map(|id| numbering.number(id));
                        number.filter(|&number| !(is_zero && number == 0))
                    };
                    self.compare(placement, shown, expected, |shown, own| shown == own, tell);
                }
            }
            Values::Distances(t) => {
                let encoding = encoding.distances;
                let shown = |index: usize| Some(t[index]).filter(|&t| !nothing.matches_distance(t));
                let expected = |pixel, [row, column]: [usize; 2]| {
                    let seen = Some(pixel).filter(is_seen);
                    seen.map(|pixel| self.number(DrawnPixel { pixel, row, column }, encoding))
                };
                let agree = |shown, expected| encoding.holds(shown, expected);
                self.compare(placement, shown, expected, agree, tell);
            }
        }
        renaming
    }

    /// Tells of every drawn pixel: its index in the file, whether the two differ, and whether they differ in coverage. `shown` is
    /// what the file has at an index, `expected` what it should have for a drawn pixel; both are `None` for nothing.
    fn compare<Shown, Number>(
        &self,
        placement: Placement,
        shown: impl Fn(usize) -> Option<Shown>,
        expected: impl Fn(usize, [usize; 2]) -> Option<Number>,
        mut agree: impl FnMut(Shown, Number) -> bool,
        mut tell: impl FnMut(usize, bool, bool),
    ) {
        self.each_pixel(placement, |pixel, index, at| match (shown(index), expected(pixel, at)) {
            (Some(shown), Some(expected)) => tell(index, !agree(shown, expected), false),
            (None, None) => tell(index, false, false),
            _ => tell(index, true, true),
        });
    }
}

/// How far a file is from the true picture; in all pixels if rows and columns are exchanged in a picture that is not square.
pub(super) fn score_of_truth(
    view: &View,
    observed: &Observed,
    placements: &[Placement],
    truth: &Drawn,
) -> Score {
    if !placements.contains(&Placement::Upright) {
        return Score { differing: truth.ids.len() as u64, ..Score::default() };
    }
    let expected = Expected::new(view, &Convention::default(), truth);
    expected.score(observed, Placement::Upright, &Encoding::default())
}

/// The encoding under which most pixels agree; of equals the first, and `ours` before all.
fn most_agreeing(
    ours: Encoding,
    others: impl Iterator<Item = Encoding>,
    agreeing: impl Fn(&Encoding) -> usize,
) -> Encoding {
    let mut best = (ours, agreeing(&ours));
    for encoding in others {
        let count = agreeing(&encoding);
        if count > best.1 {
            best = (encoding, count);
        }
    }
    best.0
}

/// A pixel of the picture.
#[derive(Clone, Copy, Debug)]
struct DrawnPixel {
    /// The index among the drawn pixels.
    pixel: usize,
    row: usize,
    column: usize,
}

/// A pixel that the picture and the file cover.
#[derive(Clone, Copy, Debug)]
struct Probe {
    at: DrawnPixel,
    /// The index in the file.
    index: usize,
}

/// The index in the file of a pixel of the picture.
struct IndexMap {
    base: isize,
    per_row: isize,
    per_column: isize,
}

impl IndexMap {
    #[expect(clippy::cast_possible_wrap, reason = "at most 2^30 pixels")]
    fn new(placement: Placement, [width, height]: [usize; 2]) -> IndexMap {
        let size = [width as isize, height as isize];
        let stride = if placement.swaps_sides() { size[1] } else { size[0] };
        // The index is linear in the row and the column of the picture.
        let index = |pixel: [isize; 2]| {
            let [row, column] = placement.in_file(pixel, size);
            row * stride + column
        };
        let base = index([0, 0]);
        IndexMap { base, per_row: index([1, 0]) - base, per_column: index([0, 1]) - base }
    }

    #[expect(
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        reason = "at most 2^30 pixels, and never before the first"
    )]
    fn index(&self, [i, j]: [usize; 2]) -> usize {
        (self.base + i as isize * self.per_row + j as isize * self.per_column) as usize
    }

    /// The indices of a row of the picture, from its first column on.
    fn row(&self, i: usize, width: usize) -> impl Iterator<Item = usize> {
        let (first, per_column) = (self.index([i, 0]), self.per_column);
        (0..width).scan(first, move |next, _| {
            let index = *next;
            *next = index.wrapping_add_signed(per_column);
            Some(index)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_where_the_placement_says() {
        let size @ [width, height] = [5, 3];
        for placement in Placement::ALL {
            let place = IndexMap::new(placement, size);
            let stride = if placement.swaps_sides() { height } else { width };
            for index in 0..width * height {
                let pixel = placement.pixel([index / stride, index % stride], size);
                assert_eq!(place.index(pixel), index, "{placement:?}");
            }
            for i in 0..height {
                let row = (0..width).map(|j| place.index([i, j]));
                assert!(place.row(i, width).eq(row), "{placement:?}");
            }
        }
    }
}
