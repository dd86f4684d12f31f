//! Scenes of many instances of meshes with hundreds of triangles.

use crate::{Dice, PROJECTIONS, turned};
use bothways_common::glam::{DAffine3, DMat3, DVec3, EulerRot, Vec3};
use bothways_common::{
    Camera, CameraDescription, Instances, Mesh, Options, Placement, Plane, Projection, Scene,
    Shape, Sphere,
};
use std::f32::consts::TAU;

/// How many crowds [`crowd`] knows.
pub const CROWDS: u64 = 12;

/// A crowd of blobs, turned, stretched, sheared and mirrored, some flattened; around the eye, in front of it and behind it.
/// Some are there twice, and tie with themselves; far ones lie at coordinates with few digits left.
pub fn crowd(seed: u64) -> (Scene, Camera, Options) {
    let mut dice = Dice(seed);
    let near = crowd_of(&mut dice, blob(9, 7, seed), 40, 5.0, Vec3::ZERO);
    let far =
        crowd_of(&mut dice, blob(30, 24, seed + 1), 120, 7.0, Vec3::new(900.0, -400.0, -30_000.0));
    let small = crowd_of(&mut dice, blob(3, 3, seed), 200, 9.0, Vec3::new(0.0, 0.0, -8.0));
    let scene = Scene::new(vec![near.into(), far.into(), small.into()]).expect("it is a scene");
    let target = if seed % 3 == 2 { [900.0, -400.0, -30_000.0] } else { [0.3, 0.1, -6.0] };
    let eye = if seed % 3 == 2 { [905.0, -395.0, -29_960.0] } else { [0.2, 0.3, 2.0] };
    // Several tiles of both orders.
    let camera = turned(PROJECTIONS[(seed % 2) as usize], eye, target, [140, 100]);
    let options = Options { samples: if seed % 4 == 3 { 8 } else { 1 }, ..Options::default() };
    (scene, camera, options)
}

/// A hundred thousand instances of two triangles that every tile meets, among a plane and a sphere, and a camera of each
/// projection. All instances of the second object lie where those of the first lie, and of these half where others do.
pub fn instances_in_one_place() -> (Scene, [Camera; 2]) {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.3, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.2 * x));
    let mesh = Mesh::new(corners.to_vec(), vec![[0, 1, 2], [2, 1, 0]]).expect("it is a mesh");
    let placements = (0..50_000_u32).map(|k| {
        let [x, y, z] = [37, 53, 101].map(|factor| (k % 25_000 * factor % 997) as f32 / 997.0);
        Placement::translation(Vec3::new(3.0 * x - 2.5, 3.0 * y - 2.0, -4.0 - 6.0 * z))
    });
    let instances = Instances::new(mesh, placements.collect()).expect("they are near");
    let plane = Plane { point: Vec3::new(0.0, 0.0, -7.0), normal: Vec3::new(0.1, 0.2, 1.0) };
    let sphere = Sphere { center: Vec3::new(0.4, 0.3, -3.0), radius: 0.5 };
    let objects = vec![
        Shape::Plane(plane).into(),
        Shape::from(instances.clone()).into(),
        Shape::Sphere(sphere).into(),
        Shape::from(instances).into(),
    ];
    let scene = Scene::new(objects).expect("it is a scene");
    let cameras = [(Projection::Perspective, [1.0, 0.75]), (Projection::Parallel, [4.0, 3.0])];
    let cameras = cameras.map(|(projection, viewport)| {
        let description =
            CameraDescription { projection, viewport, image: [48, 36], ..Default::default() };
        Camera::new(description).expect("it is a camera")
    });
    (scene, cameras)
}

/// A closed mesh about the origin with this many rows and columns of quads.
fn blob(rows: u32, columns: u32, seed: u64) -> Mesh {
    let mut dice = Dice(seed ^ 77);
    let mut positions = Vec::new();
    for row in 0..=rows {
        for column in 0..columns {
            let [theta, phi] =
                [row as f32 / rows as f32 * 3.1, column as f32 / columns as f32 * TAU];
            let radius = 1.0 + 0.2 * dice.next();
            positions.push(
                radius * Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()),
            );
        }
    }
    let mut triangles = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let right = (column + 1) % columns;
            let [a, b] = [row * columns + column, row * columns + right];
            let [c, d] = [a + columns, b + columns];
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    Mesh::new(positions, triangles).expect("it is a mesh")
}

fn crowd_of(dice: &mut Dice, mesh: Mesh, count: usize, spread: f32, middle: Vec3) -> Shape {
    let mut placements: Vec<Placement> = Vec::new();
    for k in 0..count {
        let mut three = || DVec3::from_array([0; 3].map(|_| f64::from(dice.next())));
        let [angles, stretch, by] = [3.2 * three(), three(), three()];
        let turn = DMat3::from_euler(EulerRot::XYZ, angles.x, angles.y, angles.z);
        let shape = match k % 8 {
            0 => DMat3::IDENTITY,
            1 => turn * DMat3::from_diagonal(stretch),
            2 => turn * DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0)),
            3 => DMat3::from_cols(stretch, by, angles),
            4 => turn * DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)),
            5 if k > 8 => {
                placements.push(placements[k - 8]);
                continue;
            }
            _ => turn,
        };
        let translation = middle.as_dvec3() + f64::from(spread) * by;
        placements.push(Placement::from_affine(&DAffine3 { matrix3: shape, translation }));
    }
    Shape::Instances(Instances::new(mesh, placements).expect("they are near"))
}
