//! Tests of loading, and of the messages for scenes that do not load.

use super::*;
use crate::common::Camera;
use crate::formats::scene_file;
use crate::formats::source::{Files, Reach};

#[test]
fn every_built_in_scene_loads_and_says_its_point() {
    for BuiltIn { name, about, toml } in BUILT_IN {
        let loaded = load(name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((loaded.name.as_str(), loaded.toml.as_str()), (*name, *toml));
        assert!(loaded.scene.primitive_count() > 0, "{name}");
        Camera::new(loaded.camera).unwrap();
        assert_eq!(toml.lines().next(), Some(format!("# {about}").as_str()));
        assert!(toml.lines().all(|line| line.len() <= 120), "{name}");
    }
    assert_eq!(BUILT_IN[0].name, DEFAULT);
}

#[test]
fn many_has_about_a_hundred_thousand_triangles() {
    let triangles = load("many").unwrap().scene.primitive_count();
    assert!((90_000..110_000).contains(&triangles), "{triangles}");
}

#[test]
fn an_unknown_name_lists_the_known_ones() {
    let says = |name| load(name).unwrap_err().to_string();
    let list = "the built-in scenes are lecture, canonical, ties, behind, slivers, overlap, \
                parallel, inside, many; a scene file (.toml) or a mesh file (.obj, .ply, \
                .stl, .gltf, .glb) can be named, too";
    let near = format!("there is no built-in scene \"lectuer\"; did you mean \"lecture\"? {list}");
    assert_eq!(says("lectuer"), near);
    assert_eq!(says("bunny"), format!("there is no built-in scene \"bunny\"; {list}"));
    assert_eq!(says(""), format!("there is no built-in scene \"\"; {list}"));
}

#[test]
fn an_unknown_kind_of_file_is_refused_by_name() {
    for path in ["meshes/bunny.off", "bunny.off", "meshes/bunny"] {
        let says = load(path).unwrap_err().to_string();
        let reason = "is neither a scene file (.toml) nor a mesh file (.obj, .ply, .stl, .gltf, .glb); no others are read";
        assert_eq!(says, format!("{path} {reason}"));
    }
}

#[test]
fn a_missing_scene_file_is_named() {
    let says = load("no-such.toml").unwrap_err().to_string();
    assert_eq!(says, "no-such.toml: there is no such file");
}

#[test]
fn a_mesh_file_is_framed_and_its_scene_file_reads_back() {
    let folder = std::env::temp_dir().join(format!("bothways-scenes-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("a \"triangle\".OBJ");
    std::fs::write(&path, "v 0.1 0 0\nv 1 0.3 0\nv 0 1 -0.7\nf 1 2 3\n").unwrap();

    let loaded = load(path.to_str().unwrap()).unwrap();
    assert_eq!(loaded.name, "a \"triangle\"");
    assert!(!loaded.viewport_stated);
    let files = Files::in_folder(&folder, Reach::Folder);
    let again = scene_file::parse("again.toml", &loaded.toml, &files).unwrap();
    assert_eq!((again.scene, again.camera), (loaded.scene, loaded.camera));
    assert!(!again.viewport_stated);

    let saved = folder.join("saved.toml");
    std::fs::write(&saved, &loaded.toml).unwrap();
    let from_file = load(saved.to_str().unwrap()).unwrap();
    assert_eq!((from_file.name.as_str(), from_file.camera), ("saved", loaded.camera));
    assert_eq!(from_file.toml, loaded.toml);

    std::fs::write(&path, "v 1 1 1\nf 1 1 1\n").unwrap();
    let says = load(path.to_str().unwrap()).unwrap_err().to_string();
    assert!(says.ends_with("all triangles lie in one point, so no camera can frame them"));
    std::fs::remove_dir_all(&folder).unwrap();
}

/// A triangle and a camera that states an aspect ratio of 2.
const WITH_CAMERA: &str = r#"{ "asset": { "version": "2.0" },
"nodes": [{ "mesh": 0 }, { "camera": 0, "translation": [0, 0, 4] }],
"cameras": [{ "name": "wide", "type": "perspective", "perspective": { "yfov": 0.8, "aspectRatio": 2, "znear": 1 } }],
"meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
"accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] }],
"bufferViews": [{ "buffer": 0, "byteLength": 36 }],
"buffers": [{ "byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" }] }"#;

#[test]
fn the_scene_file_of_a_gltf_camera_keeps_its_aspect_ratio() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.gltf"), WITH_CAMERA).unwrap();
    let source = folder.path().join("a.gltf#wide").display().to_string();
    let load = |image| load_with(&source, LoadOptions { image, ..LoadOptions::default() }).unwrap();
    let loaded = load(None);
    let files = Files::in_folder(folder.path(), Reach::Folder);
    let again = scene_file::parse("again.toml", &loaded.toml, &files).unwrap();
    assert_eq!((again.camera, again.viewport_stated), (loaded.camera, true));
    // So both keep the viewport in an image of another shape.
    let square = load(Some([40, 40]));
    assert_eq!((square.camera.viewport, square.viewport_stated), ([2.0, 1.0], true));
}
