//! A picture as the numbers of a file should show it, and how far a file is from it.

use super::convention::{Convention, Placement};
use super::draw::Drawn;
use super::encoding::{DistanceEncoding, Encoding, IdEncoding, NothingEncoding, linear, window};
use super::observed::{Observed, Values};
use super::rays::ViewingRays;
use super::renaming::Renaming;
use crate::common::View;
use crate::common::frame::NO_PRIMITIVE;
use crate::diff::tolerance::DEPTH_TOLERANCE;

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
}

/// A picture as the numbers of a file should show it.
pub(super) struct Expected<'a> {
    pub(super) view: &'a View<'a>,
    pub(super) drawn: &'a Drawn,
    rays: ViewingRays,
}

/// The most pixels by which an encoding is chosen.
const PROBES: usize = 512;

impl<'a> Expected<'a> {
    pub(super) fn new(view: &'a View<'a>, convention: &Convention, drawn: &'a Drawn) -> Self {
        Expected { view, drawn, rays: ViewingRays::new(view.camera, convention) }
    }

    /// The encoding under which the file agrees best with the picture, by a few of their pixels.
    pub(super) fn encoding(
        &self,
        observed: &Observed,
        placement: Placement,
        nothing: NothingEncoding,
    ) -> Encoding {
        let base = Encoding { nothing, ..Encoding::default() };
        let probes = self.probes(observed, placement, nothing);
        let mut encodings = vec![base];
        match &observed.values {
            Values::Mask(_) => return base,
            Values::Ids(ids) => {
                let from_one = IdEncoding::CountedFrom(1);
                let others = [from_one, IdEncoding::FromTheEnd, IdEncoding::OfObjects];
                let others = others.into_iter().chain(self.first_number(ids, &probes));
                encodings.extend(others.map(|ids| Encoding { ids, ..base }));
            }
            Values::Distances(t) => {
                let others = self.distance_encodings(t, &probes);
                let with = |distances| Encoding { distances, ..base };
                encodings.extend(others.into_iter().map(with));
            }
        }
        let agree = |encoding: &Encoding| {
            probes.iter().filter(|probe| self.agrees(observed, probe, encoding)).count()
        };
        // Of equals the first, which is ours.
        let mut best = (encodings[0], agree(&encodings[0]));
        for encoding in &encodings[1..] {
            let count = agree(encoding);
            if count > best.1 {
                best = (*encoding, count);
            }
        }
        best.0
    }

    /// Pixels that both cover, evenly spread.
    fn probes(
        &self,
        observed: &Observed,
        placement: Placement,
        nothing: NothingEncoding,
    ) -> Vec<Probe> {
        let pixels = self.drawn.ids.len();
        let place = IndexMap::new(placement, self.size());
        let step = (pixels / (PROBES * 4)).max(1);
        let width = self.rays.x.len();
        let probe = |pixel: usize| {
            let (row, column) = (self.drawn.rows[pixel / width], pixel % width);
            let index = place.index([row, column]);
            let both = self.drawn.ids[pixel] != NO_PRIMITIVE && observed.covered(index, nothing);
            both.then_some(Probe { pixel, index, row, column })
        };
        let found: Vec<Probe> = (0..pixels).step_by(step).filter_map(probe).collect();
        let step = found.len().div_ceil(PROBES).max(1);
        found.into_iter().step_by(step).collect()
    }

    /// Width and height of the picture.
    pub(super) fn size(&self) -> [usize; 2] {
        [self.rays.x.len(), self.rays.y.len()]
    }

    /// The number above 1 from which most primitives count, of those at the probes. One primitive alone counts from any.
    fn first_number(&self, ids: &[Option<u64>], probes: &[Probe]) -> Option<IdEncoding> {
        let difference = |probe: &Probe| {
            let id = self.drawn.ids[probe.pixel];
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
        let depth = |probe: &Probe| self.number(probe, DistanceEncoding::AlongAxis);
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
        let distance = |probe: &Probe| self.number(probe, DistanceEncoding::T);
        let middle = f64::midpoint(distance(ends[0]), distance(ends[1]));
        let off = |probe: &Probe| (distance(probe) - middle).abs();
        let between = probes.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
        let point = |probe: &Probe| [distance(probe), t[probe.index]];
        linear([ends[0], between, ends[1]].map(point))
    }

    /// The number that an encoding writes for the distance at a probe.
    fn number(&self, probe: &Probe, encoding: DistanceEncoding) -> f64 {
        let t = self.drawn.t[probe.pixel];
        let axis = || t * self.rays.axis().length();
        let ray = || t * self.rays.ray(probe.row, probe.column).direction.length();
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

    /// Whether the file agrees with the picture at a pixel that both cover.
    fn agrees(&self, observed: &Observed, probe: &Probe, encoding: &Encoding) -> bool {
        match &observed.values {
            Values::Mask(_) => true,
            Values::Ids(ids) => {
                let id = self.drawn.ids[probe.pixel];
                ids[probe.index] == Some(self.id_number(id, encoding.ids))
            }
            Values::Distances(t) => {
                let (number, expected) = (t[probe.index], self.number(probe, encoding.distances));
                let tolerance = match encoding.distances {
                    // A window depth is stored as `f32`, with 24 bits or fewer.
                    DistanceEncoding::Window { .. } | DistanceEncoding::ReversedWindow { .. } => {
                        1e-5
                    }
                    _ => DEPTH_TOLERANCE * number.abs().max(expected.abs()),
                };
                (number - expected).abs() <= tolerance
            }
        }
    }

    /// The number that stands for a primitive; its id where names are its own.
    pub(super) fn id_number(&self, id: u32, encoding: IdEncoding) -> u64 {
        match encoding {
            IdEncoding::FromZero | IdEncoding::OneToOne => id.into(),
            IdEncoding::CountedFrom(first) => first.saturating_add(id.into()),
            IdEncoding::FromTheEnd => self.view.scene.primitive_count() - 1 - u64::from(id),
            IdEncoding::OfObjects => self.view.scene.locate(id.into()).0 as u64,
        }
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
        if encoding.ids == IdEncoding::OneToOne && !renaming.is_general() {
            score.differing = u64::MAX;
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
            for column in 0..width {
                tell(line * width + column, place.index([row, column]), [row, column]);
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
        mut tell: impl FnMut(usize, bool, bool),
    ) -> Renaming {
        let mut renaming = Renaming::default();
        self.each_pixel(placement, |pixel, index, [row, column]| {
            let id = self.drawn.ids[pixel];
            let expected = self.is_something(id, observed, encoding);
            let covered = observed.covered(index, encoding.nothing);
            let differs = if covered != expected {
                true
            } else if !covered {
                false
            } else if encoding.ids == IdEncoding::OneToOne
                && let Values::Ids(ids) = &observed.values
            {
                !renaming.holds(id, ids[index])
            } else {
                let probe = Probe { pixel, index, row, column };
                !self.agrees(observed, &probe, encoding)
            };
            tell(index, differs, covered != expected);
        });
        renaming
    }

    /// Whether the file should show something where a primitive is visible. If 0 is nothing and ids count from 0, the
    /// first primitive looks like nothing.
    fn is_something(&self, id: u32, observed: &Observed, encoding: &Encoding) -> bool {
        let is_zero = matches!(observed.values, Values::Ids(_))
            && encoding.nothing == NothingEncoding::Number(0.0)
            && encoding.ids != IdEncoding::OneToOne;
        id != NO_PRIMITIVE && !(is_zero && self.id_number(id, encoding.ids) == 0)
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

/// A pixel of the picture and of the file.
#[derive(Clone, Copy, Debug)]
struct Probe {
    /// The index among the drawn pixels.
    pixel: usize,
    /// The index in the file.
    index: usize,
    row: usize,
    column: usize,
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
        }
    }
}
