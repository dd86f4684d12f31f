//! STL and glTF files on the command line, beside OBJ and PLY: the same mesh has the same ids, whatever carries it.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// The files of independent writers, which show one mesh.
fn file(name: &str) -> PathBuf {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/formats/tests/formats/files");
    PathBuf::from(folder).join(name)
}

fn bothways(home: &TempDir, args: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("bothways").unwrap().current_dir(home).args(args).assert()
}

#[test]
fn the_same_mesh_in_any_format_gives_the_same_ids() {
    let home = tempfile::tempdir().unwrap();
    let ids = |name: &str| {
        let common = ["--size", "40x30", "--buffers", "npy", "--no-times", "-o", "out"];
        bothways(&home, &[&[file(name).to_str().unwrap()], &common[..]].concat()).code(0);
        fs::read(home.path().join("out/object-order.ids.npy")).unwrap()
    };
    let expected = ids("trimesh.obj");
    for name in ["trimesh.ply", "trimesh.stl", "trimesh.glb", "plyfile-big.ply", "numpy-stl.stl"] {
        assert!(ids(name) == expected, "{name}");
    }
}

#[test]
fn the_content_tells_the_format_of_a_file_with_another_name() {
    let home = tempfile::tempdir().unwrap();
    fs::copy(file("trimesh.glb"), home.path().join("a.dat")).unwrap();
    fs::copy(file("numpy-stl.stl"), home.path().join("b.obj")).unwrap();
    let scene =
        "[[object]]\nmesh = \"a.dat\"\n[[object]]\nmesh = \"b.obj\"\ntranslate = [3, 0, 0]\n";
    fs::write(home.path().join("both.toml"), format!("[camera]\neye = [0, 1, 9]\n{scene}"))
        .unwrap();
    bothways(&home, &["both.toml", "--size", "40x30", "-o", "out"]).code(0);
    let report = fs::read_to_string(home.path().join("out/report.json")).unwrap();
    assert!(report.contains("\"primitives\": 12"), "{report}");
    for name in ["a.dat", "b.obj"] {
        bothways(&home, &["scenes", name]).code(0).stdout(contains(format!("mesh = \"{name}\"")));
    }
}

#[test]
fn a_camera_of_a_gltf_file_is_chosen_by_its_name() {
    let home = tempfile::tempdir().unwrap();
    fs::copy(file("pygltflib.glb"), home.path().join("a.glb")).unwrap();
    for source in ["a.glb#front", "a.glb#"] {
        let printed = bothways(&home, &["scenes", source]).code(0);
        printed.stdout(
            contains("eye = [0.0, 1.0, 9.0]")
                .and(contains("image = [720, 480]"))
                .and(contains("viewport = [1.5, 1.0]"))
                .and(contains("mesh = \"a.glb\"")),
        );
        bothways(&home, &[source, "--size", "36x24", "-o", "out"]).code(0);
    }
    let says = "a.glb has no camera \"back\"; its cameras are front";
    bothways(&home, &["a.glb#back"]).code(2).stderr(contains(says));
}

#[test]
fn formats_that_are_read_as_a_whole_are_not_streamed() {
    let home = tempfile::tempdir().unwrap();
    fs::copy(file("trimesh.glb"), home.path().join("a.glb")).unwrap();
    let says = "only a mesh file (.obj, .ply, .stl) can be streamed, and \"a.glb\" is none";
    bothways(&home, &["a.glb", "--order", "object", "--stream"]).code(2).stderr(contains(says));
}

#[test]
fn generated_meshes_are_written_as_stl() {
    let home = tempfile::tempdir().unwrap();
    bothways(&home, &["mesh", "box", "--divisions", "2", "-o", "box.stl"]).code(0);
    let size = fs::metadata(home.path().join("box.stl")).unwrap().len();
    assert_eq!((size - 84) % 50, 0);
    bothways(&home, &["box.stl", "--size", "40x30", "-o", "out"]).code(0);
}

#[test]
fn broken_files_are_named_with_what_is_wrong() {
    let home = tempfile::tempdir().unwrap();
    let mut glb = fs::read(file("trimesh.glb")).unwrap();
    glb.truncate(glb.len() - 8);
    fs::write(home.path().join("a.glb"), glb).unwrap();
    bothways(&home, &["a.glb"]).code(2).stderr(contains("a.glb: it should have"));
    fs::write(home.path().join("a.stl"), "solid a\nfacet normal 0 0 1\nouter lop\n").unwrap();
    bothways(&home, &["a.stl"])
        .code(2)
        .stderr(contains("a.stl:3: \"lop\" stands here in place of \"outer loop\""));
    let scene = "[[object]]\nmesh = \"a.stl\"\n";
    fs::write(home.path().join("a.toml"), scene).unwrap();
    bothways(&home, &["a.toml"]).code(2).stderr(contains("a.stl:3:"));
}
