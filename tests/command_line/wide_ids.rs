//! A scene of more primitives than have ids of 32 bits: pictures, reports and files as of any other, with ids of 64 bits.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::arguments::arguments;
use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// 2³² triangles: 65,536 rings of as many. The eye looks down onto the last ones.
const SCENE: &str = "\
[camera]
eye = [255, 3, 255]
direction = [0, -1, 0]
up = [0, 0, -1]
image = [64, 48]

[[object]]
generate = { kind = 'torus', divisions = [256, 128] }
scale = 0.3
instances = { grid = { count = [256, 1, 256], spacing = [2, 1, 2] } }
";

fn home() -> TempDir {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("rings.toml"), SCENE).unwrap();
    home
}

fn bothways(home: &TempDir, line: &str) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).env_remove("RAYON_NUM_THREADS").args(arguments(line));
    command
}

fn ids(home: &TempDir, file: &str) -> Vec<u64> {
    let bytes = fs::read(home.path().join(file)).unwrap();
    npyz::NpyFile::new(bytes.as_slice()).unwrap().into_vec::<u64>().unwrap()
}

#[test]
fn both_orders_write_ids_of_64_bits_that_diff_reads() {
    let home = home();
    bothways(&home, "render rings.toml --buffers npy -o npy").assert().code(0);
    bothways(&home, "render rings.toml --buffers exr -o exr").assert().code(0);
    let report: Value =
        serde_json::from_slice(&fs::read(home.path().join("npy/report.json")).unwrap()).unwrap();
    assert_eq!(report["primitives"], 1_u64 << 32);
    assert_eq!(report["visible"]["differing_pixels"], 0);

    let by_object = ids(&home, "npy/object-order.ids.npy");
    assert_eq!(by_object, ids(&home, "npy/image-order.ids.npy"));
    let seen = by_object.iter().filter(|id| **id != u64::MAX);
    // The last ring is in the corner of the grid.
    assert!(seen.clone().all(|id| (1 << 31..1 << 32).contains(id)));
    assert!(seen.clone().any(|id| *id >= (1 << 32) - 65_536));

    let files = "npy/object-order.ids.npy exr/buffers.exr";
    let equal = contains("equal in everything compared: coverage, ids");
    bothways(&home, &format!("diff {files} --channels object.id"))
        .assert()
        .code(0)
        .stdout(equal.and(contains("channels object.id, object.id_high")));
    // One half of the ids is not the ids.
    bothways(&home, &format!("diff {files} --channels object.id_high")).assert().code(1);
}

#[test]
fn a_pixel_names_its_primitive() {
    let home = home();
    bothways(&home, "render rings.toml --order image --buffers npy -o npy").assert().code(0);
    let ids = ids(&home, "npy/image-order.ids.npy");
    let at = ids.iter().rposition(|id| *id != u64::MAX).unwrap();
    let output = bothways(&home, &format!("pixel rings.toml {} {} --json", at / 64, at % 64))
        .assert()
        .code(0)
        .get_output()
        .stdout
        .clone();
    let pixel: Value = serde_json::from_slice(&output).unwrap();
    let text = pixel.to_string();
    assert!(text.contains(&format!("\"id\":{}", ids[at])), "{text}");
}

#[test]
fn what_looks_at_each_primitive_refuses_so_many() {
    let home = home();
    for line in [
        "film rings.toml -o film.gif",
        "figure order rings.toml -o order.svg",
        "export rings.toml --as obj -o rings",
        "render rings.toml --object-rules snapped:8 -o ruled",
        "slides rings.toml -o slides",
    ] {
        bothways(&home, line)
            .assert()
            .code(2)
            .stderr(contains("rings has 4,294,967,296 primitives with all instances, and"))
            .stderr(contains("at most 4,294,967,294; leave some instances out"));
    }
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 1);
    bothways(&home, "camera rings.toml --as opengl").assert().code(0);
}
