//! Instances of a mesh: written once where a program has words for it, and loaded back at the same places, bit for bit.

use super::super::{Export, Target, export};
use super::{exported, loaded_from};
use crate::common::glam::Vec3;
use crate::common::scene::MeshMaterials;
use crate::common::{
    Camera, Instances, Material, Mesh, Object, Placement, Plane, Scene, Shape, View,
};
use crate::formats::generate::Kind;
use crate::orders::{Method, Order, RenderOptions, render};
use crate::scenes;
use bothways_test_support::{CROWDS, crowd};
use serde_json::Value;
use std::sync::Arc;

/// The ids that an order sees.
fn ids(order: Order, scene: &Scene, camera: &Camera) -> Vec<Option<u64>> {
    let rendered =
        render(order, Method::Fast, &View::new(scene, camera), &RenderOptions::default());
    rendered.unwrap().frame.ids().iter().collect()
}

/// The bits of the corners of each triangle in the order of ids: of each triangle sorted, as a mirror may turn it.
fn bits(scene: &Scene) -> Vec<[[u32; 3]; 3]> {
    let of_triangle = |id| {
        let corners = scene.triangle(id).unwrap();
        let mut bits = corners.map(|corner| corner.to_array().map(f32::to_bits));
        bits.sort_unstable();
        bits
    };
    (0..scene.primitive_count()).map(of_triangle).collect()
}

/// The text of a binary glTF file.
fn json_of(file: &[u8]) -> Value {
    let length = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&file[20..20 + length]).unwrap()
}

fn list<'a>(root: &'a Value, name: &str) -> &'a [Value] {
    root[name].as_array().unwrap()
}

/// Turned, stretched and mirrored, and some skewed or flat, which become meshes of their own.
#[test]
fn instances_come_back_from_gltf_bit_for_bit() {
    let mut shared = 0_u64;
    for seed in 0..CROWDS {
        let (scene, camera, _) = crowd(seed);
        let Export { files, notes } =
            export(&View::new(&scene, &camera), "crowd", Target::Gltf).unwrap();
        // One of eight in each object is skewed, and one flat.
        let skewed = notes.iter().filter(|note| note.contains("skewed or flat")).count();
        assert_eq!(skewed, 3, "{notes:?}");
        let again = loaded_from(&files[0].0, &files[0].1).scene;
        let is_shared = |object: &&Object| matches!(object.shape, Shape::Instances(_));
        shared += again.objects().iter().filter(is_shared).count() as u64;
        assert!(bits(&again) == bits(&scene), "{seed}");
        let expected = ids(Order::Object, &scene, &camera);
        assert!(expected.iter().flatten().count() > 0, "{seed}");
        for order in [Order::Object, Order::Image] {
            assert!(ids(order, &again, &camera) == expected, "{seed}");
        }
    }
    assert!(shared > CROWDS, "{shared}");
}

#[test]
fn ten_thousand_teapots_are_one_mesh_in_gltf() {
    let loaded =
        scenes::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/crowd.toml")).unwrap();
    let camera = Camera::new(loaded.camera).unwrap();
    let Export { files, notes } = exported(&loaded, &camera, Target::Gltf);
    assert!(!notes.iter().any(|note| note.contains("of their own")), "{notes:?}");
    // Copies of all vertices would be hundreds of megabytes.
    assert!(files[0].1.len() < 5_000_000, "{}", files[0].1.len());
    let root = json_of(&files[0].1);
    // The plane's square, and the teapot; a node of each, one for each instance, and the camera's.
    assert_eq!([list(&root, "meshes").len(), list(&root, "nodes").len()], [2, 10_003]);
    let again = loaded_from(&files[0].0, &files[0].1).scene;
    let Shape::Instances(theirs) = &again.objects()[1].shape else { panic!("they share") };
    let Shape::Instances(ours) = &loaded.scene.objects()[1].shape else { panic!("they share") };
    assert_eq!(theirs.placements(), ours.placements());
    assert_eq!(theirs.mesh().triangles().len(), ours.mesh().triangles().len());
}

/// The numbers between two words, at each place where the first is.
fn numbers_between<'t>(text: &'t str, [from, to]: [&'t str; 2]) -> Vec<Vec<f32>> {
    let inside = text.split(from).skip(1).map(|rest| rest.split(to).next().unwrap());
    let number = |number: &str| number.parse().unwrap();
    inside.map(|numbers| numbers.split_whitespace().map(number).collect()).collect()
}

/// pbrt lists a matrix column by column, Mitsuba row by row; both take every map that is not flat.
#[test]
fn ray_tracers_get_a_mesh_once_and_exactly_where_it_is() {
    for seed in [0, 5] {
        let (scene, camera) = (crowd(seed).0, Camera::canonical(40, 40));
        let shapes = scene.objects().iter().map(|object| match &object.shape {
            Shape::Instances(instances) => instances,
            other => panic!("{other:?}"),
        });
        let all: Vec<&Placement> = shapes.flat_map(Instances::placements).collect();
        for target in [Target::Pbrt, Target::Mitsuba] {
            let Export { files, notes } =
                export(&View::new(&scene, &camera), "crowd", target).unwrap();
            let text = std::str::from_utf8(&files[0].1).unwrap();
            let (words, begin, turned) = match target {
                Target::Pbrt => (["Transform [", "]"], "ObjectBegin \"", true),
                _ => (
                    ["/><transform name=\"to_world\"><matrix value=\"", "\""],
                    "type=\"shapegroup\"",
                    false,
                ),
            };
            let row_of = |m: &[f32], row: usize| {
                [0, 1, 2, 3].map(|k| if turned { m[4 * k + row] } else { m[4 * row + k] })
            };
            let placed: Vec<Placement> = numbers_between(text, words)
                .iter()
                .map(|m| {
                    assert_eq!((m.len(), row_of(m, 3)), (16, [0.0, 0.0, 0.0, 1.0]));
                    Placement::from_rows([0, 1, 2].map(|row| row_of(m, row)))
                })
                .collect();
            // In order, but for the flat ones: one of eight.
            let mut rest = all.iter();
            assert!(placed.iter().all(|one| rest.any(|other| one == *other)), "{target:?}");
            let flat = all.len() - placed.len();
            assert!((all.len() / 8 - 3..all.len() / 7).contains(&flat), "{target:?}: {flat}");
            assert_eq!(text.matches(begin).count(), 3, "{target:?}");
            assert_eq!(
                notes.iter().filter(|note| note.contains("flat instances, copied")).count(),
                3
            );
            // A mesh for each object, and those that are flat.
            let meshes = match target {
                Target::Pbrt => text.matches("\"trianglemesh\"").count(),
                _ => files.len() - 1,
            };
            assert_eq!(meshes, 3 + flat, "{target:?}");
        }
    }
}

/// A torus of two materials, the second of which is the object's.
fn torus() -> Arc<Mesh> {
    let mut materials = MeshMaterials::default();
    materials.use_from(0, Some("red"));
    materials.use_from(40, None);
    materials.define("red", Material { color: Vec3::X, ..Material::default() });
    Arc::new(Kind::Torus.mesh([12, 8]).unwrap().with_materials(materials))
}

/// Three objects: two whose instances share a mesh and look alike, and one that has another material; and a plane.
fn family(count: u16) -> Scene {
    let mesh = torus();
    let object = |(k, color): (u16, Vec3)| {
        let place = |n: u16| Vec3::new(3.0 * f32::from(n % 32), f32::from(k), f32::from(n / 32));
        let placements = (0..count).map(|n| Placement::translation(place(n))).collect();
        let shape = Shape::Instances(Instances::new(Arc::clone(&mesh), placements).unwrap());
        Object { shape, material: Material { color, ..Material::default() } }
    };
    let plane = Shape::Plane(Plane { point: Vec3::ZERO, normal: Vec3::Y });
    let mut objects: Vec<Object> = [Vec3::Y, Vec3::Z, Vec3::Y]
        .into_iter()
        .zip(0..)
        .map(|(color, k)| object((k, color)))
        .collect();
    objects.push(plane.into());
    Scene::new(objects).unwrap()
}

#[test]
fn a_mesh_of_several_objects_is_written_once_for_each_look() {
    let (scene, camera) = (family(400), Camera::canonical(40, 30));
    let Export { files, .. } = export(&View::new(&scene, &camera), "a", Target::Gltf).unwrap();
    let root = json_of(&files[0].1);
    let meshes = list(&root, "meshes");
    assert_eq!(meshes.iter().map(|mesh| list(mesh, "primitives").len()).sum::<usize>(), 5);
    assert_eq!(meshes.len(), 3, "the two looks, and the square");
    // A node for each object, with those of its instances below, and the camera's.
    let nodes = list(&root, "nodes");
    assert_eq!(list(&root["scenes"][0], "nodes").len(), 5);
    let children = |node: &Value| node["children"].as_array().map_or(0, Vec::len);
    assert_eq!(nodes.iter().map(children).collect::<Vec<_>>().iter().max(), Some(&400));
    let again = loaded_from(&files[0].0, &files[0].1).scene;
    for id in 0..scene.primitive_count() - 1 {
        let look = |scene: &Scene| {
            let (object, local) = scene.locate(id);
            scene.objects()[object].material_of(local).color
        };
        assert_eq!(again.triangle(id), scene.triangle(id));
        assert_eq!(look(&again), look(&scene), "{id}");
    }
}
