//! The primitives that a ray may meet: all of the scene, but for triangles of instances in boxes that it certainly misses.

use crate::common::glam::{DVec3, Vec3};
use crate::common::{Instances, Mesh, Placement, Primitive, Ray, Shape, View};

/// Triangles of a mesh, one after another, in one box.
const IN_BOX: usize = 256;

/// All primitives that cover a ray's sample, or have it on their boundary, and others, with their ids, in scene order.
pub(super) fn candidates<'a>(
    view: &'a View,
    ray: &'a Ray,
) -> Box<dyn Iterator<Item = (u64, Primitive)> + 'a> {
    let objects = view.scene.objects();
    if !objects.iter().any(|object| matches!(object.shape, Shape::Instances(_))) {
        return Box::new(view.primitives());
    }
    let of_objects = objects.iter().enumerate().flat_map(move |(object, described)| {
        let first_id = view.scene.first_id(object);
        let found: Box<dyn Iterator<Item = u64>> = match &described.shape {
            Shape::Instances(instances) => Box::new(of_instances(view, ray, instances)),
            shape => Box::new(0..shape.primitive_count() as u64),
        };
        found.map(move |local| first_id + local)
    });
    Box::new(of_objects.map(|id| (id, view.primitive(id))))
}

/// The numbers of the triangles in boxes that the ray may meet.
fn of_instances<'a>(
    view: &'a View,
    ray: &'a Ray,
    instances: &'a Instances,
) -> impl Iterator<Item = u64> + 'a {
    let mesh = instances.mesh();
    let (all, boxes) = (mesh.bounds(), boxes(mesh));
    let triangles = mesh.triangles().len();
    let met = instances.placements().iter().enumerate().filter(move |(_, placement)| {
        all.is_some_and(|bounds| !is_missed(view, ray, placed(placement, bounds)))
    });
    met.flat_map(move |(number, placement)| {
        let first = number as u64 * triangles as u64;
        let met = (0..).zip(boxes.clone()).filter(move |(_, bounds)| {
            boxes_are_few(triangles) || !is_missed(view, ray, placed(placement, *bounds))
        });
        met.flat_map(move |(index, _): (usize, _)| {
            let own = index * IN_BOX..triangles.min((index + 1) * IN_BOX);
            own.map(move |triangle| first + triangle as u64)
        })
    })
}

/// Whether a mesh is so small that its own box is enough.
fn boxes_are_few(triangles: usize) -> bool {
    triangles <= 4 * IN_BOX
}

/// Boxes around the triangles of a mesh, so many at a time.
fn boxes(mesh: &Mesh) -> Vec<[Vec3; 2]> {
    let around = |triangles: &[[u32; 3]]| {
        let vertices = triangles.as_flattened().iter();
        let nothing = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        vertices.fold(nothing, |[low, high], &vertex| {
            let position = mesh.positions()[vertex as usize];
            [low.min(position), high.max(position)]
        })
    };
    mesh.triangles().chunks(IN_BOX).map(around).collect()
}

/// A box around what lies in a box of the mesh: [`Placement::position`] is monotonic.
fn placed(placement: &Placement, bounds: [Vec3; 2]) -> [Vec3; 2] {
    let nothing = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    (0..8).fold(nothing, |[low, high], corner| {
        let side = |axis: usize| bounds[corner >> axis & 1][axis];
        let position = placement.position(Vec3::new(side(0), side(1), side(2)));
        [low.min(position), high.max(position)]
    })
}

/// Whether a ray certainly meets no point of a box.
///
/// A line meets a box if none of its three shadows along the axes misses that of the box: a shadow misses where the cross
/// product of the direction and the way to the middle is larger than that of the direction and the half, both by their
/// sizes. These numbers carry fewer than twenty roundings of `f64`, each of less than 2·10⁻¹⁶ of what it is computed from;
/// the slack is 10⁻⁹ of that.
fn is_missed(view: &View, ray: &Ray, [low, high]: [Vec3; 2]) -> bool {
    const SLACK: f64 = 1e-9;
    let eye = view.camera.eye().as_dvec3();
    let [low, high] = [low, high].map(Vec3::as_dvec3);
    let half = 0.5 * (high - low) + SLACK * (low.abs().max(high.abs()) + eye.abs());
    let way = 0.5 * (low + high) - eye - ray.origin;
    let half = half + SLACK * ray.origin.abs();
    let size = ray.direction.abs();
    let away = way.cross(ray.direction).abs();
    let sum = |v: DVec3| {
        DVec3::new(
            v.y * size.z + v.z * size.y,
            v.z * size.x + v.x * size.z,
            v.x * size.y + v.y * size.x,
        )
    };
    let is_beside = away.cmpgt(sum(half) + SLACK * sum(way.abs())).any();
    // What a ray meets lies in front of where it begins.
    let is_behind = way.dot(ray.direction) + half.dot(size) < -SLACK * way.abs().dot(size);
    is_beside || is_behind
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{Camera, CameraDescription, Object, Plane, Projection, Scene};
    use crate::formats::generate::Kind;

    #[test]
    fn nothing_that_a_ray_meets_is_left_out() {
        let mesh = Kind::Sphere.mesh([48, 24]).unwrap();
        assert!(!boxes_are_few(mesh.triangles().len()));
        let placements = (0..60).map(|k| {
            let [x, y, z] = [7, 11, 5].map(|factor| (k * factor % 13) as f32 / 13.0);
            let row = |k: usize, at: f32| {
                std::array::from_fn(
                    |j| if j == 3 { at } else { 0.3 + 0.4 * ((j + k) % 3) as f32 * x },
                )
            };
            Placement::from_rows([
                row(0, 6.0 * x - 3.0),
                row(1, 4.0 * y - 2.0),
                row(2, 3.0 - 9.0 * z),
            ])
        });
        let instances = Instances::new(mesh, placements.collect()).unwrap();
        let plane = Plane { point: Vec3::new(0.0, -1.0, 0.0), normal: Vec3::new(0.0, 1.0, 0.1) };
        let objects: Vec<Object> = vec![Shape::Plane(plane).into(), Shape::from(instances).into()];
        let scene = Scene::new(objects).unwrap();
        let mut found = 0;
        for projection in [Projection::Perspective, Projection::Parallel] {
            let description =
                CameraDescription { projection, image: [12, 9], ..CameraDescription::default() };
            let camera = Camera::new(description).unwrap();
            let (view, grid) = (View::new(&scene, &camera), camera.sample_grid(1));
            let judge = view.judge();
            for pixel in 0..12 * 9 {
                let ray = grid.ray(pixel / 12, pixel % 12);
                let covers = |(_, primitive): &(u64, Primitive)| judge.covers(primitive, &ray);
                let ids = |one: (u64, Primitive)| one.0;
                let all: Vec<u64> = view.primitives().filter(covers).map(ids).collect();
                assert!(candidates(&view, &ray).filter(covers).map(ids).eq(all.iter().copied()));
                found += all.len();
            }
        }
        assert!(found > 300, "{found}");
    }
}
