//! What is exported is loaded back, and seen as it was.

mod instances;
mod looks;

use super::{Export, ExportError, Target, export};
use crate::common::{Camera, CameraDescription, Projection, Scene, Shape, View};
use crate::formats::source::{GivenFile, InputFile};
use crate::orders::{Method, Order, RenderOptions, render};
use crate::scenes::{self, BUILT_IN, LoadedScene};

fn exported(loaded: &LoadedScene, camera: &Camera, target: Target) -> Export {
    export(&View::new(&loaded.scene, camera), &loaded.name, target).unwrap()
}

fn ids(scene: &Scene, camera: &Camera) -> Vec<Option<u64>> {
    let view = View::new(scene, camera);
    render(Order::Object, Method::Fast, &view, &RenderOptions::default())
        .unwrap()
        .frame
        .ids()
        .iter()
        .collect()
}

fn is_of_triangles(loaded: &LoadedScene) -> bool {
    let objects = loaded.scene.objects().iter();
    objects
        .map(|object| &object.shape)
        .all(|shape| matches!(shape, Shape::Mesh(_) | Shape::Triangle(_)))
}

/// The scene of an exported file.
fn loaded_from(name: &str, bytes: &[u8]) -> LoadedScene {
    let file = GivenFile::new(name, bytes);
    scenes::load_file(&InputFile::given(&[file], 0), None).unwrap()
}

#[test]
fn triangles_come_back_with_the_same_ids() {
    let all = BUILT_IN.iter().map(|scene| scenes::load(scene.name).unwrap());
    let of_triangles: Vec<LoadedScene> = all.filter(is_of_triangles).collect();
    assert!(of_triangles.len() > 1, "{}", of_triangles.len());
    for loaded in of_triangles {
        let name = &loaded.name;
        for projection in [Projection::Perspective, Projection::Parallel] {
            let camera = CameraDescription { image: [96, 72], projection, ..loaded.camera };
            let camera = Camera::new(camera).unwrap();
            let expected = ids(&loaded.scene, &camera);
            for target in [Target::Gltf, Target::Obj, Target::Ply] {
                let Export { files, .. } = exported(&loaded, &camera, target);
                let folder = tempfile::tempdir().unwrap();
                for (file, bytes) in &files {
                    std::fs::write(folder.path().join(file), bytes).unwrap();
                }
                let file = folder.path().join(&files[0].0);
                let again = scenes::load(file.to_str().unwrap()).unwrap();
                assert_eq!(again.warnings, [""; 0], "{name}, {target:?}");
                assert_eq!(
                    ids(&again.scene, &camera),
                    expected,
                    "{name}, {target:?}, {projection:?}"
                );
            }
        }
    }
}

#[test]
fn a_camera_and_colors_come_back_from_gltf() {
    for name in ["lecture", "canonical", "parallel"] {
        let loaded = scenes::load(name).unwrap();
        let camera = Camera::new(loaded.camera).unwrap();
        let Export { files, .. } = exported(&loaded, &camera, Target::Gltf);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(&files[0].0);
        std::fs::write(&path, &files[0].1).unwrap();
        let again = scenes::load(&format!("{}#camera", path.display())).unwrap();
        let size = CameraDescription { image: loaded.camera.image, ..again.camera };
        let back = Camera::new(size).unwrap();
        assert_eq!(back.projection(), camera.projection(), "{name}");
        assert_eq!(back.eye(), camera.eye(), "{name}");
        for (ours, theirs) in
            [(camera.u(), back.u()), (camera.v(), back.v()), (camera.w(), back.w())]
        {
            assert!((ours - theirs).length() < 1e-6, "{name}: {ours} {theirs}");
        }
        let form = |camera: &Camera| {
            camera.viewport().map(|side| match camera.projection() {
                Projection::Perspective => side / camera.distance(),
                Projection::Parallel => side,
            })
        };
        for (ours, theirs) in form(&camera).into_iter().zip(form(&back)) {
            assert!((ours / theirs - 1.0).abs() < 1e-6, "{name}: {ours} {theirs}");
        }
        let colors = |loaded: &LoadedScene| {
            let objects = loaded.scene.objects().iter();
            let of_all = objects.flat_map(|object| {
                (0..object.shape.primitive_count()).map(|local| object.material_of(local).color)
            });
            of_all.collect::<Vec<_>>()
        };
        let back = colors(&again);
        assert!(colors(&loaded).iter().all(|color| back.contains(color)), "{name}: {back:?}");
    }
}

#[test]
fn a_sphere_and_a_plane_become_triangles_where_there_are_no_others() {
    let loaded = scenes::load("canonical").unwrap();
    let camera = Camera::new(CameraDescription { image: [160, 160], ..loaded.camera }).unwrap();
    let Export { files, notes } = exported(&loaded, &camera, Target::Gltf);
    assert!(notes.iter().any(|note| note.contains("is a sphere, and becomes")), "{notes:?}");
    assert!(notes.iter().any(|note| note.contains("is a plane without an end")), "{notes:?}");
    let again = loaded_from(&files[0].0, &files[0].1);
    // By the colour of what is seen: a polygon lies within its circle, by less than a pixel here.
    let color_of = |scene: &Scene, id: Option<u64>| {
        id.map(|id| {
            let (object, local) = scene.locate(id);
            scene.objects()[object].material_of(local).color
        })
    };
    let (ours, theirs) = (ids(&loaded.scene, &camera), ids(&again.scene, &camera));
    let differs = |(ours, theirs): &(&Option<u64>, &Option<u64>)| {
        color_of(&loaded.scene, **ours) != color_of(&again.scene, **theirs)
    };
    let differ = ours.iter().zip(&theirs).filter(differs).count();
    assert!(differ < 60, "{differ} of {} pixels", ours.len());
}

#[test]
fn texts_for_ray_tracers_have_what_the_scene_has() {
    let loaded = scenes::load("lecture").unwrap();
    let camera = Camera::new(loaded.camera).unwrap();
    let pbrt = exported(&loaded, &camera, Target::Pbrt);
    let text = String::from_utf8(pbrt.files[0].1.clone()).unwrap();
    assert_eq!(pbrt.files.len(), 1);
    let count = |text: &str, what: &str| text.matches(what).count();
    assert_eq!(count(&text, "Shape \"sphere\""), 1);
    assert_eq!(count(&text, "AttributeBegin"), count(&text, "AttributeEnd"));
    assert_eq!(count(&text, "LightSource"), loaded.scene.lights.len());
    assert_eq!(text.lines().filter(|line| *line == "WorldBegin").count(), 1);
    // As many positions as the largest index says, and three indices for each triangle.
    let mesh = text.split("Shape \"trianglemesh\"").nth(1).unwrap();
    let numbers = |name: &str| {
        let inside = mesh.split(name).nth(1).unwrap().split(['[', ']']).nth(1).unwrap();
        inside.split_whitespace().map(|number| number.parse::<f64>().unwrap()).collect::<Vec<_>>()
    };
    let (indices, positions) = (numbers("integer indices"), numbers("point3 P"));
    assert_eq!(indices.len() % 3, 0);
    let largest = indices.iter().copied().fold(0.0, f64::max);
    assert_eq!(positions.len() as f64, 3.0 * (largest + 1.0));

    let mitsuba = exported(&loaded, &camera, Target::Mitsuba);
    let xml = String::from_utf8(mitsuba.files[0].1.clone()).unwrap();
    for (name, _) in &mitsuba.files[1..] {
        assert_eq!(count(&xml, &format!("value=\"{name}\"")), 1, "{name}");
    }
    assert_eq!(count(&xml, "\"filename\""), mitsuba.files.len() - 1);
    assert_eq!(count(&xml, "<emitter"), loaded.scene.lights.len());
    assert_eq!(count(&xml, "<shape"), count(&xml, "</shape>"));
}

#[test]
fn what_cannot_be_said_is_an_error() {
    let scene = Scene::new(Vec::new()).unwrap();
    let camera = Camera::canonical(8, 8);
    let refused = export(&View::new(&scene, &camera), "empty", Target::Ply);
    assert!(matches!(refused, Err(ExportError::Empty)));
    let loaded = scenes::load("canonical").unwrap();
    let wide = CameraDescription { viewport: [2.0, 1.0], ..loaded.camera };
    let camera = Camera::new(wide).unwrap();
    let refused = export(&View::new(&loaded.scene, &camera), "wide", Target::Mitsuba);
    assert!(matches!(refused, Err(ExportError::Camera(_))), "{refused:?}");
}
