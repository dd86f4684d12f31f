//! What the numbers of a file stand for: ids from 1, depths along the axis, 0 for nothing, ….

use super::convention::{Convention, Placement};
use super::draw::Drawn;
use super::rays::ViewingRays;
use crate::common::View;
use crate::common::frame::NO_PRIMITIVE;
use crate::diff::buffer::{Buffer, Content};
use crate::diff::tolerance::DEPTH_TOLERANCE;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

/// What the numbers of a file stand for. The default is ours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Encoding {
    /// The number of a primitive.
    pub ids: IdEncoding,
    /// The number of a distance.
    pub distances: DistanceEncoding,
    /// The number of nothing.
    pub nothing: NothingEncoding,
}

impl Encoding {
    /// Whether the numbers of a file stand for what ours stand for.
    pub fn is_ours(&self) -> bool {
        self.parts() == 0
    }

    /// How many of them do not.
    pub(super) fn parts(&self) -> usize {
        let ours = Encoding::default();
        usize::from(self.ids != ours.ids)
            + usize::from(self.distances != ours.distances)
            + usize::from(self.nothing != ours.nothing)
    }
}

/// The number of a primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IdEncoding {
    /// Counted from 0 in the order of the scene.
    #[default]
    FromZero,
    /// Counted from 1.
    FromOne,
    /// Counted from the end of the scene.
    FromTheEnd,
    /// The number of the object, for all its primitives.
    OfObjects,
    /// Some number of its own for each primitive.
    OneToOne,
}

/// The number of a distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DistanceEncoding {
    /// `t`, in lengths of the ray's direction.
    #[default]
    T,
    /// The depth along the axis of the camera, `t·d`.
    AlongAxis,
    /// The distance along the ray, `t·|(x, y, −d)|`.
    AlongRay,
    /// `−t`.
    NegativeT,
    /// `−t·d`: the z of the camera's axes.
    NegativeAlongAxis,
    /// `−t·|(x, y, −d)|`.
    NegativeAlongRay,
    /// The window depth of OpenGL, from 0 at the near plane to 1 at the far plane.
    Window {
        /// Depth of the near plane along the axis.
        near: f64,
        /// Depth of the far plane along the axis.
        far: f64,
    },
    /// The same from 1 at the near plane to 0 at the far plane.
    ReversedWindow {
        /// Depth of the near plane along the axis.
        near: f64,
        /// Depth of the far plane along the axis.
        far: f64,
    },
}

/// The number of nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum NothingEncoding {
    /// All ones in ids, an infinity or NaN in distances, false in masks.
    #[default]
    Ours,
    /// This number.
    Number(f64),
    /// The opposite: a mask of what is not covered.
    Inverted,
}

/// A file as the search for conventions reads it: one sample a pixel.
#[derive(Clone, Debug)]
pub(super) struct Observed {
    pub(super) size: [usize; 2],
    pub(super) values: Values,
}

/// The values of a file, row by row.
#[derive(Clone, Debug)]
pub(super) enum Values {
    Mask(Vec<bool>),
    Ids(Vec<Option<u64>>),
    Distances(Vec<f64>),
}

impl Observed {
    /// The values of a buffer; `None` for colours alone, and for several samples a pixel.
    pub(super) fn of(buffer: &Buffer) -> Option<Observed> {
        if buffer.samples() != 1 || !buffer.has_coverage() {
            return None;
        }
        let samples = || buffer.all_samples();
        let values = match buffer.content() {
            Content::Ids(_) | Content::Frame(_) => {
                Values::Ids(samples().map(|sample| buffer.id(sample)).collect())
            }
            Content::Distances(t) => Values::Distances(t.clone()),
            Content::Mask(_) | Content::Normals(_) | Content::Picture(_) => {
                let covered = |sample| buffer.covered(sample) == Some(true);
                Values::Mask(samples().map(covered).collect())
            }
        };
        Some(Observed { size: buffer.size().map(|side| side as usize), values })
    }

    pub(super) fn covered(&self, index: usize, nothing: NothingEncoding) -> bool {
        match (&self.values, nothing) {
            (Values::Mask(mask), NothingEncoding::Inverted) => !mask[index],
            (Values::Mask(mask), _) => mask[index],
            (Values::Ids(ids), NothingEncoding::Number(number)) =>
            {
                #[expect(clippy::cast_precision_loss, reason = "an id that is large is not 0")]
                ids[index].is_some_and(|id| id as f64 != number)
            }
            (Values::Ids(ids), _) => ids[index].is_some(),
            (Values::Distances(t), NothingEncoding::Number(number)) => {
                t[index].is_finite() && t[index] != number
            }
            (Values::Distances(t), _) => t[index].is_finite(),
        }
    }

    /// How many pixels are covered.
    pub(super) fn covered_count(&self, nothing: NothingEncoding) -> u64 {
        let pixels = 0..self.size[0] * self.size[1];
        pixels.filter(|&index| self.covered(index, nothing)).count() as u64
    }

    /// The meanings of nothing that this file may have: ours, and others where nothing has our number.
    pub(super) fn meanings_of_nothing(&self) -> Vec<NothingEncoding> {
        let mut meanings = vec![NothingEncoding::Ours];
        match &self.values {
            Values::Mask(_) => meanings.push(NothingEncoding::Inverted),
            _ if self.has_our_nothing() => {}
            Values::Ids(ids) => {
                if ids.contains(&Some(0)) {
                    meanings.push(NothingEncoding::Number(0.0));
                }
            }
            Values::Distances(t) => meanings.extend(repeated(t).map(NothingEncoding::Number)),
        }
        meanings
    }

    /// Whether the file has our number of nothing somewhere.
    pub(super) fn has_our_nothing(&self) -> bool {
        (0..self.size[0] * self.size[1]).any(|index| !self.covered(index, NothingEncoding::Ours))
    }
}

/// The number that most of the pixels have, if many have it: 0, −1, 1e30, the far plane, ….
fn repeated(values: &[f64]) -> Option<f64> {
    let mut counts: HashMap<u64, usize> = HashMap::new();
    // Some thousand of them are enough to find a number that fills a part of the picture.
    let step = values.len().div_ceil(1 << 14).max(1);
    let some = values.iter().step_by(step);
    let looked_at = some.len();
    for value in some {
        *counts.entry(value.to_bits()).or_default() += 1;
    }
    let most = counts.into_iter().max_by_key(|&(bits, count)| (count, bits))?;
    (most.1 >= 2 && most.1 * 100 >= looked_at).then(|| f64::from_bits(most.0))
}

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
            Values::Ids(_) => {
                let others = [IdEncoding::FromOne, IdEncoding::FromTheEnd, IdEncoding::OfObjects];
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

    fn size(&self) -> [usize; 2] {
        [self.rays.x.len(), self.rays.y.len()]
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
        }
        encodings
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
            DistanceEncoding::Window { near, far } => far / (far - near) * (1.0 - near / axis()),
            DistanceEncoding::ReversedWindow { near, far } => {
                1.0 - far / (far - near) * (1.0 - near / axis())
            }
        }
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

    fn id_number(&self, id: u32, encoding: IdEncoding) -> u64 {
        match encoding {
            IdEncoding::FromZero | IdEncoding::OneToOne => id.into(),
            IdEncoding::FromOne => u64::from(id) + 1,
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

    /// Tells of every drawn pixel: the index in the file, whether the two differ, and whether they differ in coverage.
    /// Returns the names of the primitives, if they have names of their own.
    pub(super) fn each(
        &self,
        observed: &Observed,
        placement: Placement,
        encoding: &Encoding,
        mut tell: impl FnMut(usize, bool, bool),
    ) -> Renaming {
        let place = IndexMap::new(placement, self.size());
        let width = self.rays.x.len();
        let mut renaming = Renaming::default();
        for (line, &row) in self.drawn.rows.iter().enumerate() {
            for column in 0..width {
                let (pixel, index) = (line * width + column, place.index([row, column]));
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
            }
        }
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

/// What stands for a far plane at infinity.
pub(super) const INFINITELY_FAR: f64 = 1e30;

/// A far plane that is farther than the near one by this factor cannot be told from none by depths in `f32`.
const MOST_FAR: f64 = 1e6;

/// The window depth that takes two depths to two numbers, if it has planes in front of the eye.
fn window([z0, w0]: [f64; 2], [z1, w1]: [f64; 2]) -> Option<DistanceEncoding> {
    let possible = 0.0..=1.0;
    if !possible.contains(&w0) || !possible.contains(&w1) {
        return None;
    }
    let slope = (w0 - w1) / (1.0 / z0 - 1.0 / z1);
    let limit = w0 - slope / z0;
    let depth_of = |number: f64| slope / (number - limit);
    let [zero, one] = [0.0, 1.0].map(depth_of);
    let in_front = |near: f64, far: f64| near > 0.0 && far > near && near.is_finite();
    // A far plane that is infinitely far away: 1/far rounds to 0 or to less, or to a few units of the last of 24 bits.
    let far_plane = |near: f64, far: f64| {
        let is_near = far > 0.0 && far < MOST_FAR * near;
        if is_near { far } else { INFINITELY_FAR }
    };
    if slope < 0.0 && in_front(zero, far_plane(zero, one)) {
        Some(DistanceEncoding::Window { near: zero, far: far_plane(zero, one) })
    } else if slope > 0.0 && in_front(one, far_plane(one, zero)) {
        Some(DistanceEncoding::ReversedWindow { near: one, far: far_plane(one, zero) })
    } else {
        None
    }
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
        let (w, h) = (width as isize, height as isize);
        // The row and the column in the file are linear in the row `i` and the column `j` of the picture.
        let (row, column) = match placement {
            Placement::Upright => ([0, 1, 0], [0, 0, 1]),
            Placement::UpsideDown => ([h - 1, -1, 0], [0, 0, 1]),
            Placement::LeftToRight => ([0, 1, 0], [w - 1, 0, -1]),
            Placement::HalfTurn => ([h - 1, -1, 0], [w - 1, 0, -1]),
            Placement::Transposed => ([0, 0, 1], [0, 1, 0]),
            Placement::TurnedLeft => ([w - 1, 0, -1], [0, 1, 0]),
            Placement::TurnedRight => ([0, 0, 1], [h - 1, -1, 0]),
            Placement::OtherDiagonal => ([w - 1, 0, -1], [h - 1, -1, 0]),
        };
        let stride = if placement.swaps_sides() { h } else { w };
        let [base, per_row, per_column] = [0, 1, 2].map(|part| row[part] * stride + column[part]);
        IndexMap { base, per_row, per_column }
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

/// A name in the file for each primitive, as far as it was met. A first meeting explains nothing: it differs.
#[derive(Default)]
pub(super) struct Renaming {
    forth: HashMap<u32, u64>,
    back: HashMap<u64, u32>,
    /// Primitives that were met where the file has the name of another one.
    disputed: HashSet<u32>,
}

impl Renaming {
    /// Whether at least half of the primitives, and two of them, have another number than ours; and whether four of five have
    /// a name of their own: where one name stands for two primitives again and again, it is not one to one.
    fn is_general(&self) -> bool {
        let renamed = self.forth.iter().filter(|&(&id, &name)| u64::from(id) != name).count();
        let nameless = self.disputed.iter().filter(|&id| !self.forth.contains_key(id)).count();
        renamed >= 2 && 2 * renamed >= self.forth.len() && 4 * nameless <= self.forth.len()
    }

    fn holds(&mut self, id: u32, name: Option<u64>) -> bool {
        let Some(name) = name else { return false };
        match (self.forth.entry(id), self.back.entry(name)) {
            (Entry::Vacant(forth), Entry::Vacant(back)) => {
                forth.insert(name);
                back.insert(id);
                // Its own number needs no name.
                u64::from(id) == name
            }
            (Entry::Occupied(forth), Entry::Occupied(back)) => {
                *forth.get() == name && *back.get() == id
            }
            (Entry::Vacant(_), Entry::Occupied(_)) => {
                self.disputed.insert(id);
                false
            }
            (Entry::Occupied(_), Entry::Vacant(_)) => false,
        }
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

    #[test]
    fn a_window_depth_is_found_by_two_depths() {
        let at = |z: f64| [z, 100.0 / 99.5 * (1.0 - 0.5 / z)];
        let Some(DistanceEncoding::Window { near, far }) = window(at(0.7), at(20.0)) else {
            panic!("no window depth");
        };
        assert!((near - 0.5).abs() < 1e-12 && (far - 100.0).abs() < 1e-9, "{near} {far}");
        let reversed = |z: f64| [z, 0.5 / z];
        let found = window(reversed(0.7), reversed(20.0));
        assert!(
            matches!(found, Some(DistanceEncoding::ReversedWindow { near, .. }) if (near - 0.5).abs() < 1e-12)
        );
        assert_eq!(window([1.0, 1.0], [2.0, 2.0]), None);
    }

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "a depth that is stored as `f32`")]
    fn a_far_plane_at_infinity_is_found_by_rounded_depths() {
        let rounded = |depth: f64| f64::from(depth as f32);
        for k in 1..400_u32 {
            let (a, b) = (1.1 + 0.01 * f64::from(k), 7.3 + 0.03 * f64::from(k));
            for (name, number) in
                [("window", (|z| 1.0 - 0.1 / z) as fn(f64) -> f64), ("reversed", |z| 1.0 / z)]
            {
                let found = window([a, rounded(number(a))], [b, rounded(number(b))]);
                let (DistanceEncoding::Window { far, .. }
                | DistanceEncoding::ReversedWindow { far, .. }) = found.unwrap()
                else {
                    panic!("{name}: {found:?}");
                };
                assert_eq!(far, INFINITELY_FAR, "{name}: {found:?}");
            }
        }
    }

    #[test]
    fn the_number_of_nothing_is_the_one_that_is_repeated() {
        let mut t = vec![1e30; 40];
        (0..60_u32).for_each(|i| t.push(f64::from(i) + 0.5));
        assert_eq!(repeated(&t), Some(1e30));
        assert_eq!(repeated(&t[40..]), None);
    }

    #[test]
    fn a_few_exchanged_ids_are_no_numbering() {
        let named = |names: &[(u32, u64)]| {
            let mut renaming = Renaming::default();
            names.iter().for_each(|&(id, name)| _ = renaming.holds(id, Some(name)));
            renaming.is_general()
        };
        assert!(named(&[(0, 5), (1, 3), (2, 2)]));
        assert!(!named(&[(0, 0), (1, 1), (2, 2), (3, 4), (4, 3)]));
        assert!(!named(&[(0, 1)]));
    }

    #[test]
    fn one_number_for_two_primitives_is_no_numbering() {
        let general = |primitives: u32, name: fn(u32) -> u64| {
            let mut renaming = Renaming::default();
            (0..primitives).for_each(|id| _ = renaming.holds(id, Some(name(id))));
            renaming.is_general()
        };
        assert!(general(12, |id| u64::from(11 - id)));
        // Two triangles are one square.
        assert!(!general(12, |id| u64::from(id / 2)));
        // One triangle of twelve is hidden behind another one's number.
        assert!(general(12, |id| u64::from(11 - id).max(1)));
    }

    #[test]
    fn a_renaming_is_held_to_its_first_names() {
        let mut renaming = Renaming::default();
        assert!(!renaming.holds(3, Some(7)));
        assert!(renaming.holds(3, Some(7)));
        assert!(!renaming.holds(4, Some(7)));
        assert!(!renaming.holds(3, Some(8)));
        assert!(renaming.holds(5, Some(5)));
    }
}
