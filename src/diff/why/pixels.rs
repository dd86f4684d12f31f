//! The reason for every differing pixel, decided by the exact judge.
//!
//! A pixel may differ because A is wrong, B is wrong, or both are. What a wrong file shows there is explained by two
//! kinds of facts: each primitive that should hide it was lost, and what is shown but does not cover the sample was
//! gained. Each fact has its reason; the pixel has the one that asks for more.

use super::convention::Convention;
use super::draw::{Drawn, Rows, draw};
use super::encoding::{NothingEncoding, Observed, Values};
use super::outline::{
    Linear, TriangleOutline, area_of_sphere, area_of_triangle, plane_distance, whole,
};
use super::rays::ViewingRays;
use super::reason::{Reason, ReasonKind};
use super::search::Explanation;
use crate::common::frame::NO_PRIMITIVE;
use crate::common::glam::DVec3;
use crate::common::{Camera, Judge, Primitive, Projection, Ray, Sign, View};
use crate::diff::aspect::Side;
use crate::diff::buffer::Buffer;
use crate::diff::tolerance::DEPTH_TOLERANCE;
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
    /// The file that is wrong; `None` for both.
    pub wrong: Option<Side>,
    /// The reason.
    pub reason: Reason,
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
    let finder = Finder::new(view, [a, b], &chosen);
    let pixels = (0..chosen.len()).into_par_iter().map(|slot| finder.pixel(chosen[slot], slot));
    Ok(Reasons { pixels: pixels.collect(), differing: differing.len() as u64 })
}

impl Reasons {
    /// Gives the pixels that the conventions of a file explain to these, unless a tie or rounding explains them.
    pub fn explained_by(&mut self, file: Side, explanation: &Explanation) {
        if !explanation.is_coarse() {
            return;
        }
        let explained: HashSet<[u32; 2]> = explanation.pixels.iter().copied().collect();
        for one in &mut self.pixels {
            let exact = matches!(one.reason.kind(), ReasonKind::Tie | ReasonKind::DistanceTie);
            if one.wrong == Some(file) && !exact && explained.contains(&one.pixel) {
                one.reason = Reason::Convention;
            }
        }
    }

    /// The number of pixels of each kind that occurs, scaled to all differing pixels if only some were looked at.
    pub fn counts(&self) -> Vec<(ReasonKind, u64)> {
        let of = |kind| self.pixels.iter().filter(|one| one.reason.kind() == kind).count() as u64;
        let looked = (self.pixels.len() as u64).max(1);
        let counts = ReasonKind::ALL.into_iter().map(|kind| (kind, of(kind)));
        let scaled = counts.map(|(kind, count)| {
            let all = u128::from(count) * u128::from(self.differing) / u128::from(looked);
            (kind, u64::try_from(all).expect("no more than all"))
        });
        scaled.filter(|&(_, count)| count > 0).collect()
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
    files: [Shown; 2],
    /// For each pixel looked at, the primitives that cover its sample or nearly do.
    near: Vec<Vec<u32>>,
}

/// What a file shows, and what it shows nowhere.
struct Shown {
    observed: Option<Observed>,
    shows_back: bool,
    shows_front: bool,
    /// The least depth along the axis at which it agrees with the truth.
    nearest: f64,
    /// Whether meshes may stand in the place of spheres: their outlines lie inside, so that no sample is gained, and
    /// the triangles have ids of their own.
    may_hold_meshes: bool,
}

impl<'a> Finder<'a> {
    fn new(view: &'a View<'a>, files: [&Buffer; 2], chosen: &[[u32; 2]]) -> Finder<'a> {
        let truth = draw(view, &Convention::default(), Rows::ALL);
        let rays = ViewingRays::new(view.camera, &Convention::default());
        let judge = rays.judge();
        let files = files.map(|file| Shown::new(view, &rays, &judge, &truth, Observed::of(file)));
        let near = near(view, &rays, &judge, chosen);
        Finder { view, judge, rays, truth, files, near }
    }

    fn pixel(&self, pixel: [u32; 2], slot: usize) -> PixelReason {
        let [i, j] = pixel.map(|number| number as usize);
        let index = i * self.rays.x.len() + j;
        let truth = Some(self.truth.ids[index]).filter(|&id| id != NO_PRIMITIVE);
        let ray = self.rays.ray(i, j);
        let sample =
            Sample { ray, x: self.rays.x[j], y: self.rays.y[i], truth, near: &self.near[slot] };
        let [a, b] = [0, 1].map(|file| self.reason(&self.files[file], index, &sample));
        let (wrong, reason) = match (a, b) {
            (Some(a), Some(b)) => (None, a.worse(b)),
            (Some(a), None) => (Some(Side::A), a),
            (None, Some(b)) => (Some(Side::B), b),
            (None, None) => (None, Reason::CannotTell),
        };
        PixelReason { pixel, truth, wrong, reason }
    }

    /// Why a file is wrong at a sample; `None` where it is right.
    fn reason(&self, file: &Shown, index: usize, sample: &Sample) -> Option<Reason> {
        let Some(observed) = &file.observed else { return Some(Reason::CannotTell) };
        let covered = observed.covered(index, NothingEncoding::Ours);
        let covering = self.covering(sample);
        match &observed.values {
            Values::Mask(_) => {
                if covered == sample.truth.is_some() {
                    return None;
                }
                Some(self.of_mask(file, covered, &covering, sample))
            }
            Values::Ids(ids) => {
                let shown = ids[index];
                if shown == sample.truth.map(u64::from) {
                    return None;
                }
                let count = u64::from(self.view.scene.primitive_count());
                let shown = match shown {
                    None => None,
                    Some(id) if id < count => Some(u32::try_from(id).expect("less than the count")),
                    Some(_) => return Some(Reason::Unexplained),
                };
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
            let expected = self.judge.distance(&self.view.primitive(id), &sample.ray);
            (t - expected).abs() <= DEPTH_TOLERANCE * t.abs().max(expected)
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
        let primitive = |id: u32| self.view.primitive(id);
        let covers = |id: &u32| self.judge.covers(&primitive(*id), &sample.ray);
        let mut covering: Vec<u32> = sample.near.iter().copied().filter(covers).collect();
        covering.sort_by(|&one, &other| {
            let order = self.judge.compare(&primitive(one), &primitive(other), &sample.ray);
            order.decided.then(one.cmp(&other))
        });
        covering
    }

    /// Whether a primitive that does not cover the sample, but nearly does, lies before one that does: the plane of a
    /// triangle, the middle of a sphere.
    fn lies_before(&self, shown: u32, id: u32, sample: &Sample) -> bool {
        let [shown, id] = [shown, id].map(|id| self.view.primitive(id));
        let t = self.judge.distance(&id, &sample.ray);
        match &shown {
            Primitive::Triangle(corners) => TriangleOutline::new(corners, &self.rays)
                .is_some_and(|outline| outline.t(sample.x, sample.y).0 <= t),
            Primitive::Sphere { center, .. } => {
                let Ray { origin, direction } = sample.ray;
                (*center - origin).dot(direction) / direction.length_squared() <= t
            }
            // What nearly covers it begins at the horizon, infinitely far away.
            Primitive::Plane { .. } => false,
        }
    }

    /// Why the farther of two primitives that both cover a sample is shown: a tie, or nearly one.
    fn exchanged(&self, seen: u32, shown: u32, sample: &Sample) -> Option<Reason> {
        let [one, other] = [seen, shown].map(|id| self.view.primitive(id));
        let both_cover = self.judge.covers(&other, &sample.ray);
        if !both_cover {
            return None;
        }
        let primitives = [seen, shown];
        if self.judge.compare(&one, &other, &sample.ray).at_sample == Ordering::Equal {
            return Some(Reason::DistanceTie { primitives });
        }
        let [near, far] =
            [one, other].map(|primitive| self.judge.distance(&primitive, &sample.ray));
        let relative = (far - near) / far;
        if relative <= DEPTH_REACH {
            return Some(Reason::DistanceRounding { primitives, relative });
        }
        let pixels = self.intersection_distance([&one, &other], sample);
        (pixels <= WITHIN_A_PIXEL).then_some(Reason::Elsewhere { primitive: shown, pixels })
    }

    /// The distance from the sample to the line on which two primitives are equally far, in pixels; infinite if one of
    /// them has no distance half a pixel away.
    fn intersection_distance(&self, primitives: [&Primitive; 2], sample: &Sample) -> f64 {
        let difference = |dx: f64, dy: f64| {
            let ray = self.ray_beside(sample, dx, dy);
            let [near, far] = primitives.map(|primitive| self.judge.distance(primitive, &ray));
            far - near
        };
        let [column, row] = self.spacing();
        let [half_x, half_y] = [column / 2.0, row / 2.0];
        let slope = (difference(half_x, 0.0) - difference(-half_x, 0.0))
            .hypot(difference(0.0, half_y) - difference(0.0, -half_y));
        let pixels = difference(0.0, 0.0).abs() / slope;
        if pixels.is_nan() { f64::INFINITY } else { pixels }
    }

    /// The ray of a point beside the sample, on the viewport.
    fn ray_beside(&self, sample: &Sample, dx: f64, dy: f64) -> Ray {
        let (Ray { origin, direction }, step) = (sample.ray, dx * self.rays.u + dy * self.rays.v);
        match self.rays.projection {
            Projection::Perspective => Ray { origin, direction: direction + step },
            Projection::Parallel => Ray { origin: origin + step, direction },
        }
    }

    /// Why a primitive that covers the sample is missing there.
    fn lost(&self, file: &Shown, id: u32, sample: &Sample) -> Option<Reason> {
        let primitive = self.view.primitive(id);
        let (outline, is_back) = match &primitive {
            Primitive::Triangle(corners) => self.lost_triangle(id, corners, sample),
            Primitive::Sphere { center, radius } => {
                let (pixels, across) = self.sphere_distance(center, *radius, sample);
                let may_be_mesh = file.may_hold_meshes && pixels <= SAGITTA * across;
                (Outline::of(id, pixels, may_be_mesh), None)
            }
            Primitive::Plane { point, normal } => {
                (Outline::of(id, self.horizon_distance(*point, *normal, sample), false), None)
            }
        };
        let culled =
            is_back.filter(|&is_back| if is_back { !file.shows_back } else { !file.shows_front });
        let depth = self.judge.distance(&primitive, &sample.ray) * self.rays.distance.abs();
        let is_before = depth < file.nearest && file.nearest.is_finite();
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
        let signs = self.judge.edge_signs(corners, &sample.ray);
        let ties = signs.at_sample.iter().filter(|&&sign| sign == Sign::Zero).count();
        let is_back = Some(signs.facing == Sign::Positive);
        let reason = match ties {
            0 => {
                TriangleOutline::new(corners, &self.rays).map_or_else(Outline::default, |outline| {
                    let distances = outline.edges.map(|edge| self.pixels(&edge, sample));
                    Outline::of(id, distances.into_iter().fold(f64::INFINITY, f64::min), false)
                })
            }
            1 => Outline { close: Some(Reason::EdgeTie { primitive: id }), far: None },
            _ => Outline { close: Some(Reason::CornerTie { primitive: id }), far: None },
        };
        (reason, is_back)
    }

    /// Why a primitive that does not cover the sample is shown there.
    fn gained(&self, id: u32, sample: &Sample) -> Option<Reason> {
        match &self.view.primitive(id) {
            Primitive::Triangle(corners) => {
                let signs = self.judge.edge_signs(corners, &sample.ray);
                if signs.facing == Sign::Zero {
                    return None;
                }
                let outline = TriangleOutline::new(corners, &self.rays)?;
                let mut farthest = 0.0_f64;
                let mut ties = 0;
                for (edge, sign) in outline.edges.iter().zip(signs.at_sample) {
                    ties += usize::from(sign == Sign::Zero);
                    if sign != Sign::Zero && sign != signs.facing {
                        farthest = farthest.max(self.pixels(edge, sample));
                    }
                }
                match (farthest == 0.0, ties) {
                    (true, 0) => None,
                    (true, 1) => Some(Reason::EdgeTie { primitive: id }),
                    (true, _) => Some(Reason::CornerTie { primitive: id }),
                    (false, _) => Outline::of(id, farthest, false).any(),
                }
            }
            Primitive::Sphere { center, radius } => {
                let (pixels, _) = self.sphere_distance(center, *radius, sample);
                Outline::of(id, pixels, false).any()
            }
            Primitive::Plane { point, normal } => {
                Outline::of(id, self.horizon_distance(*point, *normal, sample), false).any()
            }
        }
    }

    /// The distance from the sample to the line of an edge, in pixels.
    fn pixels(&self, edge: &Linear, sample: &Sample) -> f64 {
        let [column, row] = self.spacing();
        let slope = (edge.along_x * column).hypot(edge.along_y * row);
        edge.at(sample.x, sample.y).abs() / slope
    }

    /// The distance from the sample to the outline of a sphere, and the radius, in pixels.
    fn sphere_distance(&self, center: &DVec3, radius: f64, sample: &Sample) -> (f64, f64) {
        let [column, row] = self.spacing();
        let value = |dx: f64, dy: f64| {
            let Ray { origin, direction } = self.ray_beside(sample, dx, dy);
            let offset = *center - origin;
            let along = offset.dot(direction) / direction.length();
            // How far the ray passes from the middle, in radii.
            (offset.length_squared() - along * along).max(0.0).sqrt() / radius
        };
        let [half_x, half_y] = [column / 2.0, row / 2.0];
        let slope = (value(half_x, 0.0) - value(-half_x, 0.0))
            .hypot(value(0.0, half_y) - value(0.0, -half_y));
        ((1.0 - value(0.0, 0.0)).abs() / slope, 1.0 / slope)
    }

    /// The distance from the sample to the horizon of a plane, in pixels; infinite for a parallel camera, which sees none.
    fn horizon_distance(&self, point: DVec3, normal: DVec3, sample: &Sample) -> f64 {
        let (_, along) = plane_distance(point, normal, normal.length(), &self.rays);
        let pixels = self.pixels(&along, sample);
        if pixels.is_nan() { f64::INFINITY } else { pixels }
    }

    fn spacing(&self) -> [f64; 2] {
        spacing(self.view.camera)
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
    ray: Ray,
    x: f64,
    y: f64,
    truth: Option<u32>,
    near: &'a [u32],
}

/// The distance between two columns and between two rows on the viewport.
fn spacing(camera: &Camera) -> [f64; 2] {
    let ([vw, vh], [width, height]) = (camera.viewport(), camera.image().map(f64::from));
    [vw / width, vh / height]
}

impl Shown {
    fn new(
        view: &View,
        rays: &ViewingRays,
        judge: &Judge,
        truth: &Drawn,
        observed: Option<Observed>,
    ) -> Shown {
        let mut shown = Shown {
            observed: None,
            shows_back: false,
            shows_front: false,
            nearest: f64::INFINITY,
            may_hold_meshes: false,
        };
        let Some(observed) = observed else { return shown };
        let mut seen = HashSet::new();
        for (index, &id) in truth.ids.iter().enumerate() {
            if id == NO_PRIMITIVE || !agrees(&observed, index, id, truth.t[index]) {
                continue;
            }
            shown.nearest = shown.nearest.min(truth.t[index] * rays.distance.abs());
            if seen.insert(id)
                && let Primitive::Triangle(corners) = view.primitive(id)
            {
                let ray = rays.ray(index / rays.x.len(), index % rays.x.len());
                let is_back = judge.facing(&corners, &ray) == Sign::Positive;
                shown.shows_back |= is_back;
                shown.shows_front |= !is_back;
            }
        }
        let gains = |index: usize| {
            truth.ids[index] == NO_PRIMITIVE && observed.covered(index, NothingEncoding::Ours)
        };
        shown.may_hold_meshes =
            !matches!(observed.values, Values::Ids(_)) && !(0..truth.ids.len()).any(gains);
        shown.observed = Some(observed);
        shown
    }
}

fn agrees(observed: &Observed, index: usize, id: u32, t: f64) -> bool {
    match &observed.values {
        Values::Mask(mask) => mask[index],
        Values::Ids(ids) => ids[index] == Some(id.into()),
        Values::Distances(distances) => {
            (distances[index] - t).abs() <= DEPTH_TOLERANCE * t.max(distances[index].abs())
        }
    }
}

/// For each of the pixels, the primitives that cover its sample, or whose outline lies within a pixel.
fn near(view: &View, rays: &ViewingRays, judge: &Judge, chosen: &[[u32; 2]]) -> Vec<Vec<u32>> {
    const NONE: u32 = u32::MAX;
    let width = rays.x.len();
    let mut slots = vec![NONE; width * rays.y.len()];
    for (slot, [i, j]) in (0..).zip(chosen) {
        slots[*i as usize * width + *j as usize] = slot;
    }
    // Rows without any of the pixels are passed over.
    let in_row: Vec<bool> =
        slots.chunks(width).map(|row| row.iter().any(|&slot| slot != NONE)).collect();
    let mut near = vec![Vec::new(); chosen.len()];
    let [column, row] = spacing(view.camera);
    for (id, primitive) in view.primitives() {
        let area = match &primitive {
            Primitive::Triangle(corners) => area_of_triangle(corners, rays, 1.0),
            Primitive::Sphere { center, radius } => area_of_sphere(*center, *radius, rays, 1.0),
            Primitive::Plane { .. } => whole(rays),
        };
        if !area.rows.clone().any(|i| in_row[i]) {
            continue;
        }
        let outline = match &primitive {
            Primitive::Triangle(corners) => match TriangleOutline::new(corners, rays) {
                Some(outline) => Some(outline),
                None => continue,
            },
            _ => None,
        };
        // Below these values a sample lies farther than the reach outside of an edge.
        let least = outline.map(|outline| {
            outline.edges.map(|edge| {
                -WITHIN_A_PIXEL * (edge.along_x * column).hypot(edge.along_y * row) - edge.error
            })
        });
        for i in area.rows.filter(|&i| in_row[i]) {
            for j in area.columns.clone() {
                let slot = slots[i * width + j];
                if slot == NONE {
                    continue;
                }
                let is_near = match (&outline, least) {
                    (Some(outline), Some(least)) => outline
                        .edges
                        .iter()
                        .zip(least)
                        .all(|(edge, least)| edge.at(rays.x[j], rays.y[i]) >= least),
                    _ => match &primitive {
                        Primitive::Plane { point, normal } => {
                            judge.covers(&primitive, &rays.ray(i, j)) || {
                                let (_, along) =
                                    plane_distance(*point, *normal, normal.length(), rays);
                                let slope = (along.along_x * column).hypot(along.along_y * row);
                                along.at(rays.x[j], rays.y[i]).abs() <= WITHIN_A_PIXEL * slope
                            }
                        }
                        // The distance to a sphere's outline is judged later.
                        Primitive::Sphere { .. } | Primitive::Triangle(_) => true,
                    },
                };
                if is_near {
                    near[slot as usize].push(id);
                }
            }
        }
    }
    near
}
