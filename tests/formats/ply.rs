//! PLY files on the command line: in all places where the program takes a mesh file.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use bothways::common::Mesh;
use bothways::formats::generate::Kind;
use bothways::formats::mesh_file::Format;
use bothways::formats::{obj, ply};
use predicates::str::contains;
use std::fs;
use tempfile::TempDir;

/// `bothways` in a folder of its own.
fn bothways(home: &TempDir, args: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("bothways").unwrap().current_dir(home).args(args).assert()
}

/// A mesh as a binary little-endian PLY file.
fn binary(mesh: &Mesh) -> Vec<u8> {
    let (vertices, faces) = (mesh.positions().len(), mesh.triangles().len());
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\n\
         property float y\nproperty float z\nelement face {faces}\n\
         property list uchar uint vertex_indices\nend_header\n"
    );
    let mut bytes = header.into_bytes();
    bytes.extend(mesh.positions().iter().flat_map(|p| p.to_array()).flat_map(f32::to_le_bytes));
    for triangle in mesh.triangles() {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
    }
    bytes
}

/// The teapot's positions and triangles, without normals.
fn teapot() -> Mesh {
    let mesh = Kind::Teapot.mesh(Kind::Teapot.default_divisions()).unwrap();
    Mesh::new(mesh.positions().to_vec(), mesh.triangles().to_vec()).unwrap()
}

#[test]
fn the_same_mesh_as_ply_and_as_obj_gives_the_same_files() {
    let (home, mesh) = (tempfile::tempdir().unwrap(), teapot());
    let path = |name: &str| home.path().join(name);
    fs::create_dir_all(path("ply")).unwrap();
    fs::create_dir_all(path("obj")).unwrap();
    fs::write(path("ply/pot.PLY"), binary(&mesh)).unwrap();
    let mut text = Vec::new();
    obj::write(&mesh, &mut text).unwrap();
    fs::write(path("obj/pot.obj"), text).unwrap();
    assert_eq!(Format::of(&path("ply/pot.PLY")), Some(Format::Ply));
    assert_eq!(ply::read(&path("ply/pot.PLY")).unwrap(), mesh);

    let common = ["--size", "40x30", "--no-times"];
    bothways(&home, &[&["ply/pot.PLY", "-o", "a"], &common[..]].concat()).code(0);
    bothways(&home, &[&["obj/pot.obj", "-o", "b"], &common[..]].concat()).code(0);
    for name in ["object-order.png", "report.json"] {
        assert_eq!(
            fs::read(path("a").join(name)).unwrap(),
            fs::read(path("b").join(name)).unwrap()
        );
    }

    // The scene file that shows it, and one by hand.
    let toml = bothways(&home, &["scenes", "ply/pot.PLY"]).code(0).get_output().stdout.clone();
    fs::write(path("framed.toml"), toml).unwrap();
    fs::write(path("mine.toml"), "[[object]]\nmesh = \"ply/pot.PLY\"\n").unwrap();
    bothways(&home, &["framed.toml", "--size", "40x30", "-o", "c"]).code(0);
    let same =
        |name| fs::read(path("c").join(name)).unwrap() == fs::read(path("a").join(name)).unwrap();
    assert!(same("object-order.png"));
    bothways(&home, &["mine.toml", "--size", "40x30", "-o", "d"]).code(0);
}

#[test]
fn a_ply_file_that_is_wrong_is_named_and_nothing_is_written() {
    let (home, mesh) = (tempfile::tempdir().unwrap(), teapot());
    let whole = binary(&mesh);
    let file = home.path().join("pot.ply");
    let promised = format!("promises {} such elements", mesh.triangles().len());
    for (length, says) in
        [(whole.len() - 1, promised.as_str()), (20, "pot.ply:2: the header has no end")]
    {
        fs::write(&file, &whole[..length]).unwrap();
        bothways(&home, &["pot.ply", "-o", "out"]).code(2).stderr(contains(says));
    }
    fs::write(home.path().join("scene.toml"), "[[object]]\nmesh = \"pot.ply\"\n").unwrap();
    bothways(&home, &["scene.toml"]).code(2).stderr(contains("scene.toml:2:8"));
    bothways(&home, &["none.ply"]).code(2).stderr(contains("none.ply: there is no such file"));
    assert!(!home.path().join("out").exists());
}
