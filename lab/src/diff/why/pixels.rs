//! The reason for every differing pixel, decided by the exact judge.
//!
//! A pixel may differ because A is wrong, B is wrong, or both are. What a wrong file shows there is explained by two
//! kinds of facts: each primitive that should hide it was lost, and what is shown but does not cover the sample was
//! gained. Each fact has its reason; the pixel has the one that asks for more.

use super::convention::{Convention, Edges};
use super::distances::SampleDistances;
use super::draw::{covers, draw};
use super::drawn::{Drawn, Rows};
use super::encoding::NothingEncoding;
use super::finding::Explanation;
use super::near::near_primitives;
use super::observed::{Observed, Values};
use super::outline::{PlaneDistance, TriangleOutline};
use super::rays::ViewingRays;
use super::reason::{Reason, ReasonKind, TieRules};
use super::shown::{Shown, is_same_distance};
use crate::common::frame::NO_PRIMITIVE;
use crate::common::glam::DVec3;
use crate::common::{Judge, Primitive, Ray, Sign, View};
use crate::diff::aspect::Side;
use crate::diff::buffer::Buffer;
use rayon::prelude::*;
use std::cmp::Ordering;
use std::collections::HashSet;

/// The reasons for the differing pixels of two files.
#[derive(Clone, Debug, PartialEq)]
pub struct Reasons {
    /// The differing pixels that were looked at, row by row.
    pub pixels: Vec<PixelReason>,
    /// The number of all differing pixels; if it is larger, those looked at are spread evenly over them.
    pub differing: u64,
}

/// The reason for one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelReason {
    /// The pixel `[i, j]`.
    pub pixel: [u32; 2],
    /// The primitive that is visible in truth.
    pub truth: Option<u32>,
    /// The file that is wrong.
    pub wrong: Wrong,
    /// The reason.
    pub reason: Reason,
}

/// Which of two files is wrong at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrong {
    /// A is, and B is right or does not tell.
    A,
    /// B is, and A is right or does not tell.
    B,
    /// Both are.
    Both,
    /// Neither is known to be.
    Neither,
}

/// Why there are no reasons.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReasonError {
    /// A file has several samples a pixel.
    #[error("reasons are found for one sample a pixel, and {name} has {samples} x {samples}")]
    Samples {
        /// A or B.
        name: &'static str,
        /// Samples along a side of a pixel.
        samples: u32,
    },
    /// The camera draws another size.
    #[error(
        "the files have {} x {} pixels and the camera {} x {}; give --size as the files have it",
        .files[0], .files[1], .camera[0], .camera[1]
    )]
    Size {
        /// Width and height of the files.
        files: [u32; 2],
        /// Width and height of the camera's image.
        camera: [u32; 2],
    },
}

/// So many pixels are looked at.
const MOST_PIXELS: usize = 1 << 18;
/// The farthest that rounding moves an edge, in pixels: graphics APIs promise at least four bits below the pixel, so a
/// corner moves by at most 1/32 pixel along each axis.
const REACH: f64 = std::f64::consts::SQRT_2 / 32.0;
/// The farthest that a sample lies from another point of its pixel, if it lies in the middle.
const WITHIN_A_PIXEL: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Distances closer than this part of them are exchanged by rounding: 24 bits of window depth resolve a depth z to
/// z/(near·2²⁴) of it, which is this for z = 1000·near.
const DEPTH_REACH: f64 = 6e-5;
/// A mesh in the place of a sphere has at least eight sides around: its outline lies within 1 − cos(π/8) of the radius.
const SAGITTA: f64 = 0.0762;

/// Finds the reason of each differing pixel. `differing` lists the pixels `[i, j]`, row by row.
///
/// # Errors
///
/// If a file has several samples a pixel, or the camera's image has another size.
pub fn find_reasons(
    view: &View,
    a: &Buffer,
    b: &Buffer,
    differing: &[[u32; 2]],
) -> Result<Reasons, ReasonError> {
    find_reasons_of_samples(view, a, b, differing, 1)
}

/// The same where the pixels of both files and of the camera's image are the samples of larger pixels, `samples` ×
/// `samples` each (see [`Buffer::samples_as_pixels`]): lengths are in these larger pixels.
///
/// # Errors
///
/// The errors of [`find_reasons`].
pub fn find_reasons_of_samples(
    view: &View,
    a: &Buffer,
    b: &Buffer,
    differing: &[[u32; 2]],
    samples: u32,
) -> Result<Reasons, ReasonError> {
    for (name, file) in [("A", a), ("B", b)] {
        if file.samples() != 1 {
            return Err(ReasonError::Samples { name, samples: file.samples() });
        }
        if file.size() != view.camera.image() {
            return Err(ReasonError::Size { files: file.size(), camera: view.camera.image() });
        }
    }
    let step = differing.len().div_ceil(MOST_PIXELS).max(1);
    let chosen: Vec<[u32; 2]> = differing.iter().step_by(step).copied().collect();
    let finder = Finder::new(view, [a, b], &chosen, samples);
    let pixels = (0..chosen.len()).into_par_iter().map(|slot| finder.pixel(chosen[slot], slot));
    Ok(Reasons { pixels: pixels.collect(), differing: differing.len() as u64 })
}

impl Reasons {
    /// Gives the pixels of a file that its conventions explain to these, unless an exact tie explains them.
    pub fn explained_by(&mut self, file: Side, explanation: &Explanation) {
        let wrong = match file {
            Side::A => Wrong::A,
            Side::B => Wrong::B,
        };
        if !explanation.is_coarse() {
            return;
        }
        let explained: HashSet<[u32; 2]> = explanation.pixels.iter().copied().collect();
        for one in &mut self.pixels {
            let exact = matches!(one.reason.kind(), ReasonKind::Tie | ReasonKind::DistanceTie);
            if one.wrong == wrong && !exact && explained.contains(&one.pixel) {
                one.reason = Reason::Convention;
            }
        }
    }

    /// The number of pixels of each kind that occurs, scaled to all differing pixels if only some were looked at.
    pub fn counts(&self) -> Vec<(ReasonKind, u64)> {
        let of = |kind| self.scaled(|one| one.reason.kind() == kind);
        let counts = ReasonKind::ALL.into_iter().map(|kind| (kind, of(kind)));
        counts.filter(|&(_, count)| count > 0).collect()
    }

    /// The number of pixels of the kinds for which a condition holds, scaled likewise.
    pub fn count_of(&self, holds: impl Fn(ReasonKind) -> bool) -> u64 {
        self.scaled(|one| holds(one.reason.kind()))
    }

    /// The same for one kind in one of the files.
    pub fn count(&self, kind: ReasonKind, wrong: Wrong) -> u64 {
        self.scaled(|one| one.reason.kind() == kind && one.wrong == wrong)
    }

    fn scaled(&self, counts: impl Fn(&PixelReason) -> bool) -> u64 {
        let some = self.pixels.iter().filter(|one| counts(one)).count() as u64;
        let looked_at = (self.pixels.len() as u64).max(1);
        let all = u128::from(some) * u128::from(self.differing) / u128::from(looked_at);
        u64::try_from(all).expect("no more than all")
    }

    /// Whether only some of the differing pixels were looked at.
    pub fn is_partial(&self) -> bool {
        self.differing > self.pixels.len() as u64
    }
}

struct Finder<'a> {
    view: &'a View<'a>,
    judge: Judge,
    rays: ViewingRays,
    truth: Drawn,
    /// A and B, unless they hold colours alone.
    files: [Option<Shown>; 2],
    /// For each pixel looked at, the primitives that cover its sample or nearly do.
    near: Vec<Vec<u32>>,
}

impl<'a> Finder<'a> {
    fn new(
        view: &'a View<'a>,
        files: [&Buffer; 2],
        chosen: &[[u32; 2]],
        samples: u32,
    ) -> Finder<'a> {
        let truth = draw(view, &Convention::default(), Rows::ALL);
        let rays = ViewingRays::new(view.camera, &Convention::default()).of_samples(samples);
        let judge = rays.judge();
        let files = files.map(|file| {
            Observed::of(file).map(|observed| Shown::new(view, &rays, &judge, &truth, observed))
        });
        let near = near_primitives(view, &rays, chosen, WITHIN_A_PIXEL);
        Finder { view, judge, rays, truth, files, near }
    }

    fn pixel(&self, pixel: [u32; 2], slot: usize) -> PixelReason {
        let at @ [i, j] = pixel.map(|number| number as usize);
        let index = i * self.rays.x.len() + j;
        let truth = Some(self.truth.ids[index]).filter(|&id| id != NO_PRIMITIVE);
        let distances = SampleDistances::new(&self.rays, at);
        let sample = Sample { distances, truth, near: &self.near[slot] };
        // For each file `None` if it does not tell, `Some(None)` if it is right.
        let [a, b] = self
            .files
            .each_ref()
            .map(|file| file.as_ref().map(|file| self.reason(file, index, &sample)));
        let (wrong, reason) = match (a, b) {
            (Some(Some(a)), Some(Some(b))) => (Wrong::Both, a.worse(b)),
            (Some(Some(a)), _) => (Wrong::A, a),
            (_, Some(Some(b))) => (Wrong::B, b),
            // What differs where both are right in coverage alone is their colour.
            (Some(None), Some(None)) if self.tell_coverage_alone() => {
                (Wrong::Neither, Reason::CannotTell)
            }
            (Some(None), Some(None)) => (Wrong::Neither, Reason::WithinTolerance),
            _ => (Wrong::Neither, Reason::CannotTell),
        };
        PixelReason { pixel, truth, wrong, reason }
    }

    /// Whether both files are held against the truth by what they cover.
    fn tell_coverage_alone(&self) -> bool {
        let is_mask = |file: &Shown| matches!(file.observed.values, Values::Mask(_));
        self.files.iter().flatten().all(is_mask)
    }

    /// Why a file is wrong at a sample; `None` where it is right.
    fn reason(&self, file: &Shown, index: usize, sample: &Sample) -> Option<Reason> {
        let covered = file.observed.covered(index, NothingEncoding::Ours);
        let covering = self.covering(sample);
        match &file.observed.values {
            Values::Mask(_) => (covered != sample.truth.is_some())
                .then(|| self.of_mask(file, covered, &covering, sample)),
            Values::Ids(ids) => {
                let shown = ids[index];
                if shown == sample.truth.map(u64::from) {
                    return None;
                }
                let is_known = |id: &u64| *id < self.view.scene.primitive_count();
                if !shown.iter().all(is_known) {
                    return Some(Reason::Unexplained);
                }
                let shown = shown.map(|id| u32::try_from(id).expect("less than their number"));
                Some(self.of_id(file, shown, &covering, sample))
            }
            Values::Distances(t) => self.of_distance(file, t[index], covered, &covering, sample),
        }
    }

    fn of_mask(&self, file: &Shown, covered: bool, covering: &[u32], sample: &Sample) -> Reason {
        if !covered {
            return self.of_id(file, None, covering, sample);
        }
        // Something near was gained: of several, the one that needs the least.
        let gained = sample.near.iter().filter_map(|&id| self.gained(id, sample));
        gained
            .reduce(|one, other| if one.worse(other) == one { other } else { one })
            .unwrap_or(Reason::Unexplained)
    }

    /// Why a file shows this primitive, or nothing, rather than the truth.
    fn of_id(&self, file: &Shown, shown: Option<u32>, covering: &[u32], sample: &Sample) -> Reason {
        let gained = match shown {
            Some(id) if !covering.contains(&id) => {
                Some(self.gained(id, sample).unwrap_or(Reason::Unexplained))
            }
            _ => None,
        };
        let lost = covering.iter().take_while(|&&id| Some(id) != shown).filter_map(|&id| {
            // What is gained may lie before what is seen.
            if let (Some(shown), Some(_)) = (shown, gained)
                && self.lies_before(shown, id, sample)
            {
                return None;
            }
            let by_distance = shown.and_then(|shown| self.exchanged(id, shown, sample));
            let lost = by_distance.or_else(|| self.lost(file, id, sample));
            Some(lost.unwrap_or(Reason::Unexplained))
        });
        lost.chain(gained).reduce(Reason::worse).unwrap_or(Reason::Unexplained)
    }

    fn of_distance(
        &self,
        file: &Shown,
        t: f64,
        covered: bool,
        covering: &[u32],
        sample: &Sample,
    ) -> Option<Reason> {
        if !covered {
            return sample.truth.is_some().then(|| self.of_id(file, None, covering, sample));
        }
        let is_at = |id: u32| {
            is_same_distance(t, self.judge.distance(&self.view.primitive(id.into()), sample.ray()))
        };
        match sample.truth {
            Some(truth) if is_at(truth) => None,
            // The distance tells which primitive was met.
            Some(_) => Some(match covering.iter().find(|&&id| is_at(id)) {
                Some(&shown) => self.of_id(file, Some(shown), covering, sample),
                None => Reason::Unexplained,
            }),
            None => Some(self.of_mask(file, true, covering, sample)),
        }
    }

    /// The primitives that cover the sample, near to far.
    fn covering(&self, sample: &Sample) -> Vec<u32> {
        let primitive = |id: u32| self.view.primitive(id.into());
        let covers = |id: &u32| self.judge.covers(&primitive(*id), sample.ray());
        let mut covering: Vec<u32> = sample.near.iter().copied().filter(covers).collect();
        covering.sort_by(|&one, &other| {
            let order = self.judge.compare(&primitive(one), &primitive(other), sample.ray());
            order.decided.then(one.cmp(&other))
        });
        covering
    }

    /// Whether a primitive that does not cover the sample, but nearly does, lies before one that does: the plane of a
    /// triangle, the middle of a sphere.
    fn lies_before(&self, shown: u32, id: u32, sample: &Sample) -> bool {
        let [shown, id] = [shown, id].map(|id| self.view.primitive(id.into()));
        let t = self.judge.distance(&id, sample.ray());
        match &shown {
            Primitive::Triangle(corners) => {
                let is_edge_on = TriangleOutline::new(corners, &self.rays).is_none();
                let plane = PlaneDistance::of_triangle(corners, &self.rays);
                !is_edge_on && plane.t(sample.distances.x, sample.distances.y).0 <= t
            }
            Primitive::Sphere { center, .. } => {
                let Ray { origin, direction } = *sample.ray();
                (*center - origin).dot(direction) / direction.length_squared() <= t
            }
            // What nearly covers it begins at the horizon, infinitely far away.
            Primitive::Plane { .. } => false,
        }
    }

    /// Why the farther of two primitives that both cover a sample is shown: a tie, or nearly one.
    fn exchanged(&self, seen: u32, shown: u32, sample: &Sample) -> Option<Reason> {
        let [one, other] = [seen, shown].map(|id| self.view.primitive(id.into()));
        let both_cover = self.judge.covers(&other, sample.ray());
        if !both_cover {
            return None;
        }
        let primitives = [seen, shown];
        if self.judge.compare(&one, &other, sample.ray()).at_sample == Ordering::Equal {
            return Some(Reason::DistanceTie { primitives });
        }
        let [near, far] =
            [one, other].map(|primitive| self.judge.distance(&primitive, sample.ray()));
        let relative = (far - near) / far;
        if relative <= DEPTH_REACH {
            return Some(Reason::DistanceRounding { primitives, relative });
        }
        let pixels = sample.distances.to_intersection(&self.judge, [&one, &other]);
        (pixels <= WITHIN_A_PIXEL).then_some(Reason::Elsewhere { primitive: shown, pixels })
    }

    /// Why a primitive that covers the sample is missing there.
    fn lost(&self, file: &Shown, id: u32, sample: &Sample) -> Option<Reason> {
        let primitive = self.view.primitive(id.into());
        let (outline, is_back) = match &primitive {
            Primitive::Triangle(corners) => self.lost_triangle(id, corners, sample),
            Primitive::Sphere { center, radius } => {
                let (pixels, across) = sample.distances.to_sphere(*center, *radius);
                let may_be_mesh = file.may_hold_meshes && pixels <= SAGITTA * across;
                (Outline::of(id, pixels, may_be_mesh), None)
            }
            Primitive::Plane { point, normal } => {
                (Outline::of(id, sample.distances.to_horizon(*point, *normal), false), None)
            }
        };
        // Where no face is shown at all, much else explains that one is missing; and so where only slivers are.
        let faces = [file.shows_front, file.shows_back];
        let lacks = [file.lacks_front, file.lacks_back];
        let culled =
            is_back.filter(|&is_back| faces == [is_back, !is_back] && lacks[usize::from(is_back)]);
        let depth = self.judge.distance(&primitive, sample.ray()) * self.rays.distance.abs();
        let is_before = file.may_clip && depth < file.nearest && file.nearest.is_finite();
        let near_plane = is_before.then_some(Reason::NearPlane { primitive: id, depth });
        let behind = self.reaches_behind(&primitive);
        outline
            .close
            .or(culled.map(|is_back| Reason::Culled { primitive: id, is_back }))
            .or(near_plane)
            .or(outline.far.filter(|reason| reason.kind() == ReasonKind::Elsewhere))
            .or(behind.then_some(Reason::BehindTheEye { primitive: id }))
            .or(outline.far)
    }

    /// The reason in a triangle's outline, and whether it is a back face.
    fn lost_triangle(
        &self,
        id: u32,
        corners: &[DVec3; 3],
        sample: &Sample,
    ) -> (Outline, Option<bool>) {
        let signs = self.judge.edge_signs(corners, sample.ray());
        let ties = signs.at_sample.iter().filter(|&&sign| sign == Sign::Zero).count();
        let is_back = Some(signs.facing == Sign::Positive);
        let reason = match ties {
            0 => {
                TriangleOutline::new(corners, &self.rays).map_or_else(Outline::default, |outline| {
                    let distances = outline.edges.map(|edge| sample.distances.to_zero(&edge));
                    Outline::of(id, distances.into_iter().fold(f64::INFINITY, f64::min), false)
                })
            }
            _ => Outline { close: Some(self.tie(id, corners, sample)), far: None },
        };
        (reason, is_back)
    }

    /// Why a primitive that does not cover the sample is shown there.
    fn gained(&self, id: u32, sample: &Sample) -> Option<Reason> {
        match &self.view.primitive(id.into()) {
            Primitive::Triangle(corners) => {
                let signs = self.judge.edge_signs(corners, sample.ray());
                if signs.facing == Sign::Zero {
                    return None;
                }
                let outline = TriangleOutline::new(corners, &self.rays)?;
                let mut farthest = 0.0_f64;
                let mut ties = 0;
                for (edge, sign) in outline.edges.iter().zip(signs.at_sample) {
                    ties += usize::from(sign == Sign::Zero);
                    if sign != Sign::Zero && sign != signs.facing {
                        farthest = farthest.max(sample.distances.to_zero(edge));
                    }
                }
                match (farthest == 0.0, ties) {
                    (true, 0) => None,
                    (true, _) => Some(self.tie(id, corners, sample)),
                    (false, _) => Outline::of(id, farthest, false).any(),
                }
            }
            Primitive::Sphere { center, radius } => {
                let (pixels, _) = sample.distances.to_sphere(*center, *radius);
                Outline::of(id, pixels, false).any()
            }
            Primitive::Plane { point, normal } => {
                Outline::of(id, sample.distances.to_horizon(*point, *normal), false).any()
            }
        }
    }

    /// The tie of a triangle whose edge or corner lies exactly on the sample, and the rules that decide it otherwise.
    fn tie(&self, id: u32, corners: &[DVec3; 3], sample: &Sample) -> Reason {
        let primitive = Primitive::Triangle(*corners);
        let covers = |edges| covers(&self.judge, edges, &primitive, sample.ray());
        let owns = covers(Edges::TopLeft);
        let others = [
            Edges::BottomLeft,
            Edges::TopRight,
            Edges::BottomRight,
            Edges::Inclusive,
            Edges::Exclusive,
        ];
        let others = others.map(|edges| Some(edges).filter(|&edges| covers(edges) != owns));
        let rules = TieRules { owns, others };
        let sides = self.judge.edge_values(corners, sample.ray()).sides;
        let mut on_edges = sides.into_iter().flatten();
        match (on_edges.next(), on_edges.next()) {
            (Some(side), None) => Reason::EdgeTie { primitive: id, side, rules },
            _ => Reason::CornerTie { primitive: id, rules },
        }
    }

    fn reaches_behind(&self, primitive: &Primitive) -> bool {
        match primitive {
            Primitive::Triangle(corners) => {
                corners.iter().any(|corner| corner.dot(self.rays.w) >= 0.0)
            }
            Primitive::Sphere { center, radius } => center.dot(self.rays.w) + radius >= 0.0,
            // Every plane does, which explains nothing.
            Primitive::Plane { .. } => false,
        }
    }
}

/// What an outline near a sample explains.
#[derive(Default)]
struct Outline {
    /// A tie, or rounding.
    close: Option<Reason>,
    /// A sample elsewhere in the pixel, or a mesh in the place of a sphere.
    far: Option<Reason>,
}

impl Outline {
    /// Of an outline that is so many pixels away.
    fn of(primitive: u32, pixels: f64, may_be_mesh: bool) -> Outline {
        let close = (pixels <= REACH).then_some(Reason::Rounding { primitive, pixels });
        let far = if may_be_mesh {
            Some(Reason::Tessellation { primitive, pixels })
        } else {
            (pixels <= WITHIN_A_PIXEL).then_some(Reason::Elsewhere { primitive, pixels })
        };
        Outline { close, far }
    }

    fn any(self) -> Option<Reason> {
        self.close.or(self.far)
    }
}

/// A sample that is looked at.
struct Sample<'a> {
    distances: SampleDistances<'a>,
    truth: Option<u32>,
    /// The primitives that cover it, or nearly do.
    near: &'a [u32],
}

impl Sample<'_> {
    fn ray(&self) -> &Ray {
        &self.distances.ray
    }
}
