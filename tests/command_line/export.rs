//! `bothways export`: scenes for other programs.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::folder::names;
use assert_cmd::Command;
use std::path::Path;

fn export(home: &Path, args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).env("NO_COLOR", "1").arg("export").args(args);
    command
}

#[test]
fn every_system_gets_its_files() {
    let home = tempfile::tempdir().unwrap();
    let expected: [(&str, &[&str]); 5] = [
        ("pbrt", &["canonical.pbrt"]),
        ("mitsuba", &["canonical-0.ply", "canonical-2.ply", "canonical.xml"]),
        ("gltf", &["canonical.glb"]),
        ("obj", &["canonical.mtl", "canonical.obj"]),
        ("ply", &["canonical.ply"]),
    ];
    for (system, files) in expected {
        export(home.path(), &["canonical", "--as", system]).assert().code(0).stdout("");
        assert_eq!(names(&home.path().join(format!("out/canonical-{system}"))), files, "{system}");
    }
}

#[test]
fn what_is_not_as_in_the_scene_is_said() {
    let home = tempfile::tempdir().unwrap();
    let said = export(home.path(), &["canonical", "--as", "gltf", "-o", "there"]).assert().code(0);
    let said = String::from_utf8(said.get_output().stderr.clone()).unwrap();
    insta::assert_snapshot!(said);
    // What is there can be rendered, through its camera.
    let mut render = Command::cargo_bin("bothways").unwrap();
    render.current_dir(home.path()).args(["there/canonical.glb#camera", "--quiet"]);
    render.assert().code(0);
}

#[test]
fn what_a_system_cannot_say_leaves_nothing() {
    let home = tempfile::tempdir().unwrap();
    let mut refused = export(home.path(), &["canonical", "--as", "mitsuba", "--viewport", "2,1"]);
    let refused = refused.assert().code(2).stdout("");
    insta::assert_snapshot!(String::from_utf8(refused.get_output().stderr.clone()).unwrap());
    assert!(names(home.path()).is_empty());
}
