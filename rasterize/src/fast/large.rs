//! What the other paths leave, one primitive at a time, set up in `f64`: planes, and triangles that are large,
//! reach to the eye's plane or are almost edge-on, part by part; spheres sample by sample.

use super::bins::region;
use super::block;
use super::depth::{DepthInterval, DepthPlane, sign_in_front};
use super::edges::TriangleSetup;
use super::narrow::{narrow, narrow_plane};
use super::round::{self, Covered};
use super::round_from_afar;
use super::setup::{Affine, MOST_SAMPLES_ACROSS};
use super::tile::{Challenger, Picture, TileBuffer, judge_covers};
use bothways_common::engine::fault::{Fault, Planted, error_bound};
use bothways_common::engine::simd::Simd;
use bothways_common::observe::EventSink;
use bothways_common::raster::Region;
use bothways_common::raster::Sample;
use bothways_common::{Primitive, Projection, Ray, Sign};
use glam::DVec3;
use std::ops::Range;

/// Regions wider than this are cut to what the edge functions leave of each strip.
const WIDE: usize = MOST_SAMPLES_ACROSS.cast_unsigned() as usize;
/// Triangles and planes are drawn in parts of so many columns and rows, which begin at multiples of these. So what
/// comes of a part depends neither on tiles nor on a crop.
const PART: [usize; 2] = [WIDE, 16];

/// One primitive while it is drawn into a tile.
struct Brush<'a, 'b, O: ?Sized> {
    id: u32,
    primitive: Primitive,
    picture: &'a Picture<'a>,
    buffer: &'b mut TileBuffer,
    observer: &'b mut O,
}

/// Draws what of primitives' regions lies in the tile.
#[inline(always)]
pub(super) fn draw<S: Simd, O: EventSink + ?Sized, F: Fault>(
    simd: S,
    ids: &[u32],
    picture: &Picture,
    buffer: &mut TileBuffer,
    observer: &mut O,
) {
    // Several are looked up before they are drawn: so the machine waits for them together.
    for ids in ids.chunks(8) {
        if O::ENABLED && observer.has_enough() {
            return;
        }
        let last = ids.len() - 1;
        let primitives: [Primitive; 8] =
            std::array::from_fn(|k| picture.view.primitive(ids[k.min(last)]));
        for (id, primitive) in ids.iter().zip(primitives) {
            let brush = Brush { id: *id, primitive, picture, buffer, observer };
            brush.draw::<S, F>(simd);
        }
    }
}

impl<O: EventSink + ?Sized> Brush<'_, '_, O> {
    #[inline(always)]
    fn draw<S: Simd, F: Fault>(mut self, simd: S) {
        let Brush { id, primitive, picture, .. } = self;
        let region = region::<F>(&primitive, picture.screen);
        match primitive {
            Primitive::Triangle(corners) => {
                let judge = picture.view.judge();
                if let Some(setup) = TriangleSetup::new::<F>(picture.screen, &judge, &corners) {
                    self.draw_triangle::<S, F>(simd, &setup, &corners, &region);
                }
            }
            Primitive::Sphere { .. } => {
                let here = region.intersection(self.buffer.region());
                self.draw_sphere::<F>(here);
            }
            Primitive::Plane { .. } if self.buffer.is_edge_on(id, &primitive) => {}
            Primitive::Plane { point, normal } => {
                let mut depth = DepthPlane::new(picture.screen, point, normal, normal.abs());
                depth.error = error_bound::<F>(depth.error);
                self.draw_plane::<S, F>(simd, &depth, &region);
            }
        }
    }

    /// Draws a triangle part by part: sixteen samples at a time where `f32` is certain enough of depths,
    /// one by one elsewhere.
    #[inline(always)]
    fn draw_triangle<S: Simd, F: Fault>(
        &mut self,
        simd: S,
        setup: &TriangleSetup,
        corners: &[DVec3; 3],
        region: &Region,
    ) {
        let (screen, keys) = (self.picture.screen, self.picture.keys);
        let here = region.intersection(self.buffer.region());
        for rows in parts(&here.rows, &region.rows, PART[1]) {
            let columns = if region.columns.len() > WIDE {
                let ys = [screen.grid.y()[rows.start], screen.grid.y()[rows.end - 1]];
                setup.span(screen, ys, &region.columns)
            } else {
                region.columns.clone()
            };
            for columns in parts(&here.columns, &columns, PART[0]) {
                let part = Region { rows: rows.clone(), columns };
                let triangle = narrow::<F>(screen, keys, setup, (self.id, corners), &part);
                if let Some(triangle) = triangle {
                    self.draw_blocks::<S, F>(simd, &triangle);
                } else {
                    self.draw_part_of_triangle::<F>(setup, part.intersection(&here));
                }
            }
        }
    }

    fn draw_part_of_triangle<F: Fault>(&mut self, setup: &TriangleSetup, here: Region) {
        let screen = self.picture.screen;
        let (xs, ys) = (screen.grid.x(), screen.grid.y());
        let eye = screen.depth_of_eye();
        let [ab, bc, ca] = &setup.edges;
        for row in here.rows {
            let y = ys[row];
            let on_row = [ab.on_row(y), bc.on_row(y), ca.on_row(y)];
            let depth_on_row = setup.depth.on_row(y);
            for column in here.columns.clone() {
                let (x, sample) = (xs[column], Sample { row, column });
                let e = [
                    on_row[0] + x * ab.across,
                    on_row[1] + x * bc.across,
                    on_row[2] + x * ca.across,
                ];
                self.observer.sample_tested(sample, self.id);
                let out = e[0] < -ab.error || e[1] < -bc.error || e[2] < -ca.error;
                let inside = e[0] > ab.error && e[1] > bc.error && e[2] > ca.error;
                if out || inside {
                    self.tell_edges(sample, setup, &e);
                }
                if out || (!inside && !self.judge_covers::<F>(sample)) {
                    continue;
                }
                let depth = setup.depth.at(depth_on_row, x);
                // A perspective ray meets what it covers in front of the eye; a parallel one may not.
                let behind = screen.projection() == Projection::Parallel
                    && (depth.high < eye
                        || (inside && depth.low <= eye && !self.judge_covers::<F>(sample)));
                if !behind {
                    self.fragment::<F>(sample, depth);
                }
            }
        }
    }

    fn draw_sphere<F: Fault>(&mut self, here: Region) {
        let Primitive::Sphere { center, radius } = self.primitive else { return };
        let screen = self.picture.screen;
        let exact = !F::is(Planted::ZeroErrorBound);
        let waypoint = screen.waypoint;
        let from_waypoint = waypoint.relative(center);
        let is_before_the_eye = {
            let (extent, depth) = (center.abs().element_sum() + radius, -center.dot(screen.w));
            depth - radius >= extent * (-10f64).exp2()
        };
        let covered = |ray: &Ray| {
            if waypoint.t > 0.0 && is_before_the_eye {
                return round_from_afar::covered(from_waypoint, radius, ray, exact);
            }
            match round::covered(screen.projection(), center, radius, ray, exact) {
                // The depth from the eye is not that from the waypoint.
                Covered::At(_) if waypoint.t > 0.0 => Covered::At(DepthInterval::UNKNOWN),
                answer => answer,
            }
        };
        for row in here.rows {
            for column in here.columns.clone() {
                let sample = Sample { row, column };
                let ray = screen.grid.ray(row, column);
                self.observer.sample_tested(sample, self.id);
                let answer = if F::is(Planted::InfiniteErrorBound) {
                    Covered::Unknown
                } else {
                    covered(&ray)
                };
                match answer {
                    Covered::At(depth) => self.fragment::<F>(sample, depth),
                    Covered::No => {}
                    Covered::Unknown => {
                        if self.judge_covers::<F>(sample) {
                            self.fragment::<F>(sample, DepthInterval::UNKNOWN);
                        }
                    }
                }
            }
        }
    }

    /// Draws a plane as a triangle is drawn.
    #[inline(always)]
    fn draw_plane<S: Simd, F: Fault>(&mut self, simd: S, depth: &DepthPlane, region: &Region) {
        let (screen, keys) = (self.picture.screen, self.picture.keys);
        let here = region.intersection(self.buffer.region());
        for rows in parts(&here.rows, &region.rows, PART[1]) {
            for columns in parts(&here.columns, &region.columns, PART[0]) {
                let part = Region { rows: rows.clone(), columns };
                if let Some(plane) = narrow_plane(screen, keys, depth, self.id, &part) {
                    self.draw_blocks::<S, F>(simd, &plane);
                } else {
                    self.draw_part_of_plane::<F>(depth, part.intersection(&here));
                }
            }
        }
    }

    fn draw_part_of_plane<F: Fault>(&mut self, depth: &DepthPlane, here: Region) {
        let screen = self.picture.screen;
        let (side, eye) = (sign_in_front(screen.projection()), screen.depth_of_eye());
        let (xs, ys) = (screen.grid.x(), screen.grid.y());
        for row in here.rows {
            let on_row = depth.on_row(ys[row]);
            for column in here.columns.clone() {
                let sample = Sample { row, column };
                let depth = depth.at(on_row, xs[column]);
                self.observer.sample_tested(sample, self.id);
                // In front of the eye the depth has this side's sign, behind it the other.
                let [near, far] =
                    if side > 0.0 { [depth.low, depth.high] } else { [-depth.high, -depth.low] };
                if near > eye || (far >= eye && self.judge_covers::<F>(sample)) {
                    self.fragment::<F>(sample, depth);
                }
            }
        }
    }

    #[inline(always)]
    fn draw_blocks<S: Simd, F: Fault>(&mut self, simd: S, flat: &Affine) {
        let Brush { picture, buffer, observer, .. } = self;
        block::draw::<S, O, F>(simd, flat, picture, buffer, *observer);
    }

    fn judge_covers<F: Fault>(&mut self, sample: Sample) -> bool {
        judge_covers::<O, F>(self.picture, sample, self.id, &self.primitive, self.observer)
    }

    fn fragment<F: Fault>(&mut self, sample: Sample, depth: DepthInterval) {
        let (index, key) = (self.buffer.index(sample), self.picture.keys.key(depth));
        let challenger = &mut Challenger { id: self.id, primitive: Some(self.primitive) };
        self.buffer.settle_depth::<O, F>(self.picture, index, challenger, key, self.observer);
    }

    /// Tells the observer the edges' signs as far as they are certain, in the orientation of the
    /// contract.
    fn tell_edges(&mut self, sample: Sample, setup: &TriangleSetup, e: &[f64; 3]) {
        let certain = |k: usize| {
            let edge = &setup.edges[k];
            (e[k].abs() > edge.error).then(|| Sign::of(setup.facing * e[k]))
        };
        self.observer.edge_signs(sample, self.id, [certain(0), certain(1), certain(2)]);
    }
}

/// The parts of `all`, cut at multiples of a length, that reach into `here`, a part of it.
fn parts(
    here: &Range<usize>,
    all: &Range<usize>,
    length: usize,
) -> impl Iterator<Item = Range<usize>> + use<> {
    let (all, first, end) = (all.clone(), here.start.max(all.start), here.end.min(all.end));
    let start = if first < end { first / length * length } else { end };
    (start..end)
        .step_by(length)
        .map(move |start| start.max(all.start)..(start + length).min(all.end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_those_of_the_whole() {
        let parts = |here, all| parts(&here, &all, 16).collect::<Vec<_>>();
        assert_eq!(parts(5..40, 5..40), [5..16, 16..32, 32..40]);
        assert_eq!(parts(20..33, 5..40), [16..32, 32..40]);
        assert_eq!(parts(16..33, 20..40), [20..32, 32..40]);
        assert!(parts(20..32, 32..40).is_empty() && parts(20..32, 5..20).is_empty());
        assert!(parts(20..20, 5..40).is_empty());
    }
}
