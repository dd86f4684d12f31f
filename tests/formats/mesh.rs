//! `bothways mesh` on the command line.

use assert_cmd::Command;
use bothways::formats::generate::Kind;
use bothways::formats::obj;

fn bothways(arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("bothways").expect("it is built").args(arguments).assert()
}

#[test]
fn every_kind_is_written_and_read_back() {
    let folder = tempfile::tempdir().unwrap();
    for kind in Kind::ALL {
        let file = folder.path().join(format!("{kind}.obj"));
        let path = file.to_str().unwrap();
        bothways(&["mesh", kind.name(), "-o", path]).success().stdout("");
        let mesh = kind.mesh(kind.default_divisions()).unwrap();
        assert_eq!(obj::read(&file).unwrap(), mesh, "{kind}");
        let corners = (0..mesh.triangles().len()).flat_map(|k| mesh.corners(k));
        let corners: Vec<[f32; 3]> = corners.map(|corner| corner.to_array()).collect();
        assert!(corners_by_tobj(path) == corners, "{kind}: tobj reads other triangles");
        bothways(&[path, "--size", "32x24", "-o", folder.path().join("out").to_str().unwrap()])
            .success();
    }
}

#[test]
fn a_name_in_ply_is_written_as_ply() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["m.ply", "M.PLY", ".ply", "-.ply"] {
        let file = folder.path().join(name);
        bothways(&["mesh", "box", "-o", file.to_str().unwrap()]).success().stdout("");
        assert!(std::fs::read(&file).unwrap().starts_with(b"ply\n"), "{name}");
    }
}

/// The corners of all triangles as the crate `tobj` reads them.
fn corners_by_tobj(path: &str) -> Vec<[f32; 3]> {
    let (models, _) = tobj::load_obj(path, &tobj::LoadOptions::default()).expect("it is OBJ");
    let mesh = &models[0].mesh;
    let corner =
        |vertex: &u32| std::array::from_fn(|axis| mesh.positions[3 * *vertex as usize + axis]);
    mesh.indices.iter().map(corner).collect()
}

#[test]
fn divisions_are_one_number_or_two() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("m.obj");
    let path = file.to_str().unwrap();
    bothways(&["mesh", "grid", "--divisions", "3", "-o", path]).success();
    assert_eq!(obj::read(&file).unwrap().triangles().len(), 18);
    bothways(&["mesh", "grid", "--divisions", "3,2", "-o", path]).success();
    assert_eq!(obj::read(&file).unwrap().triangles().len(), 12);
}

#[test]
fn bad_input_says_what_to_do_and_leaves_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("m.obj");
    std::fs::write(&file, "mine").unwrap();
    let path = file.to_str().unwrap();
    let below = format!("{path}/below.obj");
    let cases = [
        (vec!["mesh", "teapott", "-o", path], "did you mean teapot?"),
        (vec!["mesh", "torus", "--divisions", "2", "-o", path], "at least 3, 3"),
        (vec!["mesh", "torus", "--divisions", "x", "-o", path], "not a number of divisions"),
        (vec!["mesh", "grid", "--divisions", "4000000000", "-o", path], "take fewer"),
        (vec!["mesh", "grid", "-o", &below], "a file is where a folder would be"),
        (vec!["mesh", "grid"], "--output"),
    ];
    for (arguments, message) in cases {
        let assert = bothways(&arguments).code(2);
        let stderr = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
        assert!(stderr.contains(message), "{arguments:?}: {stderr}");
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "mine");
}
