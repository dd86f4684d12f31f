//! What the `f32` paths leave: triangles that are large, reach to the eye's plane or are almost edge-on,
//! spheres and planes. One primitive at a time, one sample at a time, in `f64`.

use super::bins::region;
use super::depth::{DepthInterval, DepthPlane, sign_in_front};
use super::edges::TriangleSetup;
use super::round::{self, Covered};
use super::setup::MOST_SAMPLES_ACROSS;
use super::tile::{Challenger, Picture, TileBuffer, judge_covers};
use bothways_common::fault::{Fault, Planted};
use bothways_common::frame::Region;
use bothways_common::observe::{Sample, Watcher};
use bothways_common::{Primitive, Projection, Sign};

/// Regions wider than this are cut to the span of each row.
const WIDE: usize = MOST_SAMPLES_ACROSS.cast_unsigned() as usize;

/// One primitive while it is drawn into a tile.
struct Brush<'a, 'b, O: ?Sized> {
    id: u32,
    primitive: Primitive,
    picture: &'a Picture<'a>,
    buffer: &'b mut TileBuffer,
    observer: &'b mut O,
}

/// Draws what of a primitive's region lies in the tile.
pub(super) fn draw<O: Watcher + ?Sized, F: Fault>(
    id: u32,
    picture: &Picture,
    buffer: &mut TileBuffer,
    observer: &mut O,
) {
    let primitive = picture.view.primitive(id);
    let region = region::<F>(&primitive, picture.screen);
    let here = region.intersection(buffer.region());
    let mut brush = Brush { id, primitive, picture, buffer, observer };
    match primitive {
        Primitive::Triangle(corners) => {
            let judge = picture.view.judge();
            if let Some(setup) = TriangleSetup::new::<F>(picture.screen, &judge, &corners) {
                brush.draw_triangle::<F>(&setup, here, region.columns.len() > WIDE);
            }
        }
        Primitive::Sphere { .. } => brush.draw_sphere::<F>(here),
        Primitive::Plane { .. } if brush.buffer.is_edge_on(id, &primitive) => {}
        Primitive::Plane { point, normal } => {
            let mut depth = DepthPlane::new(picture.screen, point, normal, normal.abs());
            if F::is(Planted::ZeroErrorBound) {
                depth.error = 0.0;
            }
            brush.draw_plane::<F>(&depth, here);
        }
    }
}

impl<O: Watcher + ?Sized> Brush<'_, '_, O> {
    fn draw_triangle<F: Fault>(&mut self, setup: &TriangleSetup, here: Region, wide: bool) {
        let screen = self.picture.screen;
        let (xs, ys) = (screen.grid.x(), screen.grid.y());
        let [ab, bc, ca] = &setup.edges;
        for row in here.rows {
            let y = ys[row];
            let on_row = [ab.on_row(y), bc.on_row(y), ca.on_row(y)];
            let depth_on_row = setup.depth.on_row(y);
            let columns =
                if wide { setup.span(screen, y, &here.columns) } else { here.columns.clone() };
            for column in columns {
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
                    && (depth.high < 0.0
                        || (inside && depth.low <= 0.0 && !self.judge_covers::<F>(sample)));
                if !behind {
                    self.fragment::<F>(sample, depth);
                }
            }
        }
    }

    fn draw_sphere<F: Fault>(&mut self, here: Region) {
        let Primitive::Sphere { center, radius } = self.primitive else { return };
        let screen = self.picture.screen;
        let projection = screen.projection();
        for row in here.rows {
            for column in here.columns.clone() {
                let sample = Sample { row, column };
                let ray = screen.grid.ray(row, column);
                self.observer.sample_tested(sample, self.id);
                let exact = !F::is(Planted::ZeroErrorBound);
                match round::covered(projection, center, radius, &ray, exact) {
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

    fn draw_plane<F: Fault>(&mut self, depth: &DepthPlane, here: Region) {
        let screen = self.picture.screen;
        let side = sign_in_front(screen.projection());
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
                if near > 0.0 || (far >= 0.0 && self.judge_covers::<F>(sample)) {
                    self.fragment::<F>(sample, depth);
                }
            }
        }
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
