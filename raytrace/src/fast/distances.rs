//! The distances of hits whose keys say too little: again in `f64`, eight triangles at a time, and by the judge.

use super::answer::{NARROW, Trust, narrow_middle};
use super::camera_map::CameraMap;
use super::one_primitive;
use super::tile::TileBuffer;
use bothways_common::engine::roundoff::EPS53;
use bothways_common::engine::simd::{
    Simd, SimdBase, SimdCombine, SimdMask, SimdWiden, best_level, dispatch, f32x8, f64x8, mask64x8,
};
use bothways_common::frame::stored_t;
use bothways_common::look::bands::Rays;
use bothways_common::look::lanes::{DVec3x8, Lanes, each};
use bothways_common::raster::Sample;
use bothways_common::{Mesh, Primitive, Ray, Scene, Shape, View};
use glam::Vec3;
use std::ops::Range;

/// Finds the distances of some lanes of the block of samples that begins at an index. It is a function of its own, with vectors
/// of its own: within the loops that write tiles, it would take their registers.
#[cold]
#[inline(never)]
pub(super) fn find_distances(
    map: &CameraMap,
    tile: &TileBuffer,
    from: usize,
    lanes: u64,
    ids: &[u32; 16],
    t: &mut [f32; 16],
) {
    /// Fewer are found one by one, as is what begins with another primitive: to gather them would take longer.
    const FEW: u32 = 4;
    let first = (lanes.trailing_zeros() & 15) as usize;
    // Beyond the picture there is nothing to look up.
    if lanes.count_ones() >= FEW && tile.sample(from + first).is_some() {
        let object = LastObject::of(map.view.scene, tile.names.id(ids[first]));
        if object.has_triangles {
            let which = (lanes, ids, object);
            return dispatch!(best_level(), simd => find_in_lanes(simd, map, tile, from, which, t));
        }
    }
    for lane in (0..16).filter(|lane| lanes >> lane & 1 == 1) {
        if let Some(Sample { row, column }) = tile.sample(from + lane) {
            let primitive = tile.names.primitive(&map.view, ids[lane]);
            t[lane] = distance(map, &map.grid.ray(row, column), &primitive);
        }
    }
}

#[inline(always)]
fn find_in_lanes<S: Simd>(
    simd: S,
    map: &CameraMap,
    tile: &TileBuffer,
    from: usize,
    (mut lanes, ids, mut last): (u64, &[u32; 16], LastObject),
    t: &mut [f32; 16],
) {
    let scene = map.view.scene;
    let mut pairs = Pairs::default();
    while lanes != 0 {
        let lane = (lanes.trailing_zeros() & 15) as usize;
        lanes &= lanes - 1;
        let Some(Sample { row, column }) = tile.sample(from + lane) else { continue };
        let (id, place) = (tile.names.id(ids[lane]), [map.grid.x()[column], map.grid.y()[row]]);
        if !last.ids.contains(&id) {
            last = LastObject::of(scene, id);
        }
        // Corners of a mesh are read from where they are: to copy three vectors takes longer than all else here.
        if let Some(corners) = last.corners(id) {
            pairs.add(lane, place, corners);
        } else if let Some([a, b, c]) = scene.triangle(id) {
            pairs.add(lane, place, [&a, &b, &c]);
        } else {
            t[lane] = distance(map, &map.grid.ray(row, column), &map.view.primitive(id));
        }
        if pairs.count == 8 {
            pairs.find(simd, map, t);
        }
    }
    if pairs.count > 0 {
        pairs.find(simd, map, t);
    }
}

/// The object of the primitive that was looked at last: mostly the next one is of it, too.
struct LastObject<'a> {
    ids: Range<u64>,
    has_triangles: bool,
    /// It, if it is a mesh.
    mesh: Option<&'a Mesh>,
}

impl<'a> LastObject<'a> {
    /// The object of this primitive.
    fn of(scene: &'a Scene, id: u64) -> LastObject<'a> {
        let (object, _) = scene.locate(id);
        let (has_triangles, mesh) = match &scene.objects()[object].shape {
            Shape::Mesh(mesh) => (true, Some(mesh)),
            Shape::Triangle(_) | Shape::Instances(_) => (true, None),
            Shape::Sphere(_) | Shape::Plane(_) => (false, None),
        };
        LastObject { ids: scene.ids_of(object), has_triangles, mesh }
    }

    /// The corners of one of its triangles, if it is a mesh.
    #[inline(always)]
    fn corners(&self, id: u64) -> Option<[&'a Vec3; 3]> {
        let mesh = self.mesh?;
        let local = usize::try_from(id - self.ids.start).expect("a mesh fits into memory");
        let [a, b, c] = mesh.triangles()[local];
        Some(each!(vertex in [a, b, c] => &mesh.positions()[vertex as usize]))
    }
}

/// The distance of one hit, as it is stored.
fn distance(map: &CameraMap, ray: &Ray, primitive: &Primitive) -> f32 {
    let rounded = one_primitive::distance(ray, primitive, Trust::Sound).and_then(narrow_middle);
    stored_t(rounded.unwrap_or_else(|| map.view.judge().distance(primitive, ray)))
}

/// Up to eight rays, each with the triangle that it hits.
#[derive(Default)]
struct Pairs {
    count: usize,
    lanes: [usize; 8],
    /// Where the rays meet the viewport, `x` and `y`.
    places: [[f64; 8]; 2],
    /// The corners in the world, a row for each coordinate.
    corners: [[[f32; 8]; 3]; 3],
}

impl Pairs {
    #[inline(always)]
    fn add(&mut self, lane: usize, place: [f64; 2], corners: [&Vec3; 3]) {
        let at = self.count & 7;
        self.lanes[at] = lane;
        [self.places[0][at], self.places[1][at]] = place;
        for (rows, corner) in self.corners.iter_mut().zip(corners) {
            [rows[0][at], rows[1][at], rows[2][at]] = corner.to_array();
        }
        self.count += 1;
    }

    /// The rays, and the corners of their triangles relative to the eye.
    #[inline(always)]
    fn vectors<S: Simd>(&self, simd: S, view: &View) -> (Rays<S>, [DVec3x8<S>; 3]) {
        let places = each!(k in [0, 1] => f64x8::load_array_ref(simd, &self.places[k]));
        let eye = DVec3x8::splat(simd, view.camera.eye().as_dvec3());
        let corners = each!(k in [0, 1, 2] => {
            let [x, y, z] = each!(axis in [0, 1, 2] => {
                let (low, high) = f32x8::load_array_ref(simd, &self.corners[k][axis]).widen();
                low.combine(high)
            });
            Lanes { x, y, z } - eye
        });
        (Rays::of_camera(simd, view.camera, places), corners)
    }

    /// Finds their distances, and forgets them.
    #[inline(always)]
    fn find<S: Simd>(&mut self, simd: S, map: &CameraMap, t: &mut [f32; 16]) {
        let (distances, known) = self.distances(simd, &map.view);
        let (distances, known) = (distances.to_array(), known.to_bitmask());
        for (at, &lane) in self.lanes.iter().enumerate().take(self.count) {
            t[lane] = if known >> at & 1 == 1 {
                stored_t(distances[at])
            } else {
                self.find_alone(map, at)
            };
        }
        self.count = 0;
    }

    #[cold]
    fn find_alone(&self, map: &CameraMap, at: usize) -> f32 {
        let ray = map.view.camera.ray_through(self.places[0][at], self.places[1][at]);
        let corner = |rows: [[f32; 8]; 3]| map.view.offset(Vec3::from(rows.map(|row| row[at])));
        distance(map, &ray, &Primitive::Triangle(self.corners.map(corner)))
    }

    /// What [`narrow_middle`] makes of [`super::triangle::crossing`], bit for bit; and where that is something.
    #[inline(always)]
    fn distances<S: Simd>(&self, simd: S, view: &View) -> (f64x8<S>, mask64x8<S>) {
        let splat = |value: f64| f64x8::splat(simd, value);
        let (Rays { origin, direction }, [a, b, c]) = self.vectors(simd, view);
        let (along_b, along_c, point) = (b - a, c - a, a - origin);
        let normal = along_b.cross(along_c);
        let permanent = permanent(along_b, along_c);
        let (p, q) = (normal.dot(point), normal.dot(direction));
        let least = splat(f64::MIN_POSITIVE);
        let p_error = splat(9.0 * EPS53) * permanent.dot(magnitudes(point)) + least;
        let q_error = splat(8.0 * EPS53) * permanent.dot(magnitudes(direction)) + least;
        let room = q.abs() - q_error;
        let t = p / q;
        let error = (p_error + t.abs() * q_error) / room + splat(2.0 * EPS53) * t.abs();
        // Once by the crossing, once by `distance_around`.
        let error = error * splat(1.0 + 8.0 * EPS53) * splat(1.0 + 8.0 * EPS53);
        let (low, high) = (t - error, t + error);
        let middle = splat(0.5) * (low + high);
        let known = room.simd_gt(splat(0.0))
            & low.simd_le(high)
            & middle.abs().simd_lt(splat(f64::INFINITY))
            & (high - low).simd_le(splat(NARROW) * middle);
        (middle, known)
    }
}

#[inline(always)]
fn magnitudes<S: Simd>(vector: DVec3x8<S>) -> DVec3x8<S> {
    Lanes { x: vector.x.abs(), y: vector.y.abs(), z: vector.z.abs() }
}

/// [`bothways_common::engine::roundoff::cross_permanent`] of eight pairs.
#[inline(always)]
fn permanent<S: Simd>(p: DVec3x8<S>, q: DVec3x8<S>) -> DVec3x8<S> {
    let (p, q) = (magnitudes(p), magnitudes(q));
    Lanes { x: p.y * q.z + p.z * q.y, y: p.z * q.x + p.x * q.z, z: p.x * q.y + p.y * q.x }
}

#[cfg(test)]
mod tests {
    use super::super::triangle;
    use super::*;
    use bothways_common::engine::simd::levels;
    use bothways_common::glam::{DAffine3, DVec3};
    use bothways_common::{
        Camera, CameraDescription, Instances, Object, Placement, Plane, Projection, Sphere,
        Triangle,
    };

    #[test]
    fn an_object_has_the_corners_of_its_triangles() {
        let fan = |count: u16| {
            let places = (0..count).map(|k| Vec3::new(f32::from(k), f32::from(k * k), 1.0));
            let triangles = (2..u32::from(count)).map(|k| [0, k - 1, k]);
            Mesh::new(places.collect(), triangles.collect()).unwrap()
        };
        let [a, b, c] = [Vec3::X, Vec3::Y, Vec3::Z];
        let placement = Placement::from_affine(&DAffine3::from_scale(DVec3::splat(2.0)));
        let shapes = [
            Shape::Mesh(fan(30)),
            Shape::Triangle(Triangle { a, b, c }),
            Shape::from(Instances::new(fan(7), vec![placement; 3]).unwrap()),
            Shape::Sphere(Sphere { center: a, radius: 1.0 }),
            Shape::Mesh(fan(40)),
            Shape::Plane(Plane { point: a, normal: b }),
        ];
        let scene = || Scene::new(shapes.iter().cloned().map(Object::from).collect()).unwrap();
        for scene in [scene(), scene().with_wide_ids()] {
            let mut meshes = 0;
            for id in 0..scene.primitive_count() {
                let (object, expected) = (LastObject::of(&scene, id), scene.triangle(id));
                assert!(object.ids.contains(&id), "{id}");
                assert_eq!(object.has_triangles, expected.is_some());
                if let Some(corners) = object.corners(id) {
                    assert_eq!(Some(corners.map(|corner| *corner)), expected);
                    meshes += 1;
                }
            }
            assert!(meshes > 50, "{meshes}");
        }
    }

    #[test]
    fn eight_at_a_time_are_as_one_by_one() {
        let random = &mut fastrand::Rng::with_seed(5);
        let mut known_in_all = 0;
        for projection in [Projection::Perspective, Projection::Parallel] {
            let eye = Vec3::new(0.7, -1.1, 3.0);
            let camera = CameraDescription { projection, eye, ..CameraDescription::default() };
            let (scene, camera) = (Scene::new(Vec::new()).unwrap(), Camera::new(camera).unwrap());
            let view = View::new(&scene, &camera);
            for _ in 0..1000 {
                let scale = 10f32.powi(random.i32(-6..6));
                let mut vector =
                    |size: f32| Vec3::from_array([0; 3].map(|_| size * (random.f32() - 0.5)));
                let mut pairs = Pairs::default();
                let mut all = Vec::new();
                for lane in 0..8 {
                    let (place, a) = (vector(2.0).as_dvec3(), vector(100.0));
                    // Some are thin, and some have no area at all.
                    let c = a + vector(if lane % 3 == 0 { 0.0 } else { 1.0 });
                    let corners = [a, a + vector(scale), c];
                    pairs.add(lane, [place.x, place.y], corners.each_ref());
                    let ray = camera.ray_through(place.x, place.y);
                    all.push((ray, corners.map(|corner| view.offset(corner))));
                }
                for level in levels() {
                    let (distances, known) = dispatch!(level, simd => {
                        let (distances, known) = pairs.distances(simd, &view);
                        (distances.to_array(), known.to_bitmask())
                    });
                    for (at, (ray, corners)) in all.iter().enumerate() {
                        let expected =
                            triangle::crossing(ray, corners, Trust::Sound).and_then(narrow_middle);
                        let found = (known >> at & 1 == 1).then_some(distances[at]);
                        assert_eq!(
                            found.map(f64::to_bits),
                            expected.map(f64::to_bits),
                            "{ray:?} {corners:?}"
                        );
                        known_in_all += usize::from(found.is_some());
                    }
                }
            }
        }
        assert!(known_in_all > 1000, "{known_in_all}");
    }
}
