//! The loop of every rule: for each object in the scene, for each sample that it may affect, the depth test.

use super::clip::Clip;
use super::projection::{CameraMap, Vertex, covering};
use crate::quadric;
use crate::real::{Real, Vector, position, vector};
use crate::samples::Samples;
use bothways_common::frame::{Tile, stored_t};
use bothways_common::{Frame, Plane, Projection, Region, Shape, Sphere, Triangle, View};
use glam::Vec3;
use rayon::prelude::*;

/// A rule at work.
pub(super) trait Rasterizer: Sync {
    /// The arithmetic for spheres and planes.
    type Real: Real;
    /// A triangle, set up.
    type Triangle: Fragments;

    fn samples(&self) -> &Samples<'_>;
    fn map(&self) -> &CameraMap<Self::Real>;
    /// The depth along the axis of view that must be exceeded.
    fn near(&self) -> f64;
    /// A position of the world in the camera's axes.
    fn vertex(&self, world: Vec3) -> Vertex {
        self.map().vertex(world)
    }
    /// A triangle that was clipped, in the camera's axes; `None` if it covers nothing.
    fn set_up(&self, corners: [Vertex; 3]) -> Option<Self::Triangle>;
    /// What the depth buffer holds for a sphere or a plane at this `t`.
    fn key(&self, t: f64) -> f64 {
        t
    }
}

/// Something that is drawn sample by sample.
pub(super) trait Fragments: Send + Sync {
    /// The samples that it may cover, within the picture.
    fn bounds(&self, picture: &Region) -> Region;
    /// What it is at a sample, if it covers it.
    fn fragment(&self, row: usize, column: usize) -> Option<Fragment>;
}

/// What is drawn at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fragment {
    /// What the depth buffer compares: the smaller is the nearer.
    pub(super) key: f64,
    /// In lengths of the viewing ray.
    pub(super) t: f64,
}

/// One primitive, or a part of it, ready to be drawn.
struct Item<T, R> {
    id: u32,
    bounds: Region,
    form: Form<T, R>,
}

enum Form<T, R> {
    Triangle(T),
    Sphere { center: Vector<R>, radius: R },
    Plane { point: Vector<R>, normal: Vector<R> },
}

/// How many primitives are set up at once: memory does not grow with the scene.
const CHUNK: u32 = 1 << 16;
/// How many rows of samples one thread draws.
const BAND: usize = 16;

/// Draws all primitives in scene order. Of equal keys, the first stays.
pub(super) fn draw<A: Rasterizer>(rule: &A, view: &View, frame: &mut Frame) {
    let (width, picture) = (frame.width(), frame.region().clone());
    let mut keys = vec![f64::INFINITY; picture.area()];
    let count = u32::try_from(view.scene.primitive_count()).expect("rules draw narrow ids alone");
    let clip = clip_of(rule);
    for first in (0..count).step_by(CHUNK as usize) {
        let ids = first..count.min(first.saturating_add(CHUNK));
        let items: Vec<Item<A::Triangle, A::Real>> = ids
            .into_par_iter()
            .map_init(Vec::new, |polygon, id| set_up(rule, &clip, view, id, &picture, polygon))
            .flatten_iter()
            .collect();
        let mut rest = keys.as_mut_slice();
        let bands = frame.tiles_mut(BAND, picture.columns.end).into_iter().map(|tile| {
            let (keys, others) =
                std::mem::take(&mut rest).split_at_mut(tile.region.rows.len() * width);
            rest = others;
            let Tile { region, ids, t } = tile;
            (region, ids.narrow(), t, keys)
        });
        let bands: Vec<_> = bands.collect();
        bands.into_par_iter().for_each(|(region, mut ids, mut t, keys)| {
            for item in &items {
                let both = item.bounds.intersection(&region);
                for row in both.rows {
                    let in_tile = row - region.rows.start;
                    let keys = &mut keys[in_tile * width..][..width];
                    for column in both.columns.clone() {
                        let Some(fragment) = item.fragment(rule, row, column) else { continue };
                        let at = column - region.columns.start;
                        if fragment.key < keys[at] {
                            keys[at] = fragment.key;
                            ids[in_tile][at] = item.id;
                            t[in_tile][at] = stored_t(fragment.t);
                        }
                    }
                }
            }
        });
    }
}

fn clip_of<A: Rasterizer>(rule: &A) -> Clip {
    let map = rule.map();
    let [to_device, half] = [map.to_device, map.half].map(|pair| pair.map(Real::double));
    Clip::new(rule.near(), map.projection, to_device, half)
}

/// The parts of a primitive that may be seen: of a triangle that is clipped there may be several.
fn set_up<A: Rasterizer>(
    rule: &A,
    clip: &Clip,
    view: &View,
    id: u32,
    picture: &Region,
    polygon: &mut Vec<Vertex>,
) -> Vec<Item<A::Triangle, A::Real>> {
    let (object, local) = view.scene.locate(id.into());
    let corners = match &view.scene.objects()[object].shape {
        Shape::Triangle(Triangle { a, b, c }) => [*a, *b, *c],
        Shape::Mesh(mesh) => mesh.corners(local),
        Shape::Instances(instances) => instances.corners(local),
        Shape::Sphere(sphere) => return vec![set_up_sphere(rule, id, *sphere, picture)],
        Shape::Plane(plane) => return vec![set_up_plane(rule, id, *plane, picture)],
    };
    let vertices = corners.map(|corner| rule.vertex(corner));
    if !vertices.iter().flatten().all(|coordinate| coordinate.is_finite()) {
        // Beyond the numbers of the rule's arithmetic.
        return Vec::new();
    }
    clip.clip(vertices, polygon);
    let fan = (2..polygon.len()).map(|last| [polygon[0], polygon[last - 1], polygon[last]]);
    let drawn = fan.filter_map(|part| {
        let triangle = rule.set_up(part)?;
        let bounds = triangle.bounds(picture);
        (!bounds.is_empty()).then_some(Item { id, bounds, form: Form::Triangle(triangle) })
    });
    drawn.collect()
}

fn offset<A: Rasterizer>(rule: &A, world: Vec3) -> Vector<A::Real> {
    let eye = position(rule.samples().camera().eye());
    crate::real::minus(position(world), eye)
}

fn set_up_plane<A: Rasterizer>(
    rule: &A,
    id: u32,
    Plane { point, normal }: Plane,
    picture: &Region,
) -> Item<A::Triangle, A::Real> {
    let form = Form::Plane { point: offset(rule, point), normal: position(normal) };
    Item { id, bounds: picture.clone(), form }
}

fn set_up_sphere<A: Rasterizer>(
    rule: &A,
    id: u32,
    Sphere { center, radius }: Sphere,
    picture: &Region,
) -> Item<A::Triangle, A::Real> {
    let bounds = sphere_bounds(rule, center, f64::from(radius), picture);
    let form =
        Form::Sphere { center: offset(rule, center), radius: A::Real::of(f64::from(radius)) };
    Item { id, bounds, form }
}

/// The samples around the box of a sphere in the camera's axes; all, if the box reaches behind the eye.
fn sphere_bounds<A: Rasterizer>(rule: &A, center: Vec3, radius: f64, picture: &Region) -> Region {
    let map = CameraMap::<f64>::new(rule.samples());
    let [x, y, depth] = map.vertex(center);
    // Rounding in the rule's arithmetic may make it a little larger.
    let radius = radius * (1.0 + 1e-3);
    let is_parallel = map.projection == Projection::Parallel;
    if !is_parallel && depth - radius <= 1e-3 * (depth.abs() + radius) {
        return picture.clone();
    }
    let mut least = [f64::INFINITY; 2];
    let mut most = [f64::NEG_INFINITY; 2];
    for corner in 0..8 {
        let sign = |bit: u8| if corner & bit == 0 { -radius } else { radius };
        let at = map.raster([x + sign(1), y + sign(2), depth + sign(4)]);
        for axis in 0..2 {
            least[axis] = least[axis].min(at[axis]);
            most[axis] = most[axis].max(at[axis]);
        }
    }
    Region {
        columns: covering(least[0], most[0], &picture.columns),
        rows: covering(least[1], most[1], &picture.rows),
    }
}

impl<T: Fragments, R: Real> Item<T, R> {
    fn fragment<A: Rasterizer<Real = R, Triangle = T>>(
        &self,
        rule: &A,
        row: usize,
        column: usize,
    ) -> Option<Fragment> {
        if let Form::Triangle(triangle) = &self.form {
            return triangle.fragment(row, column);
        }
        let ray = rule.samples().ray(row, column);
        let (origin, direction) = (vector(ray.origin), vector(ray.direction));
        let least = match rule.map().projection {
            Projection::Perspective => rule.near() / rule.samples().camera().distance(),
            Projection::Parallel => rule.near(),
        };
        let is_seen = |t: &R| t.double() > least;
        let t = match &self.form {
            Form::Triangle(_) => None,
            Form::Sphere { center, radius } => {
                quadric::sphere(origin, direction, *center, *radius)?.into_iter().find(is_seen)
            }
            Form::Plane { point, normal } => {
                quadric::plane(origin, direction, *point, *normal).filter(is_seen)
            }
        }?;
        let t = t.double();
        t.is_finite().then(|| Fragment { key: rule.key(t), t })
    }
}
