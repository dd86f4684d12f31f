//! `diff --scene`: why two files differ.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::texts::{bothways, home, printed};
use assert_cmd::Command;
use tempfile::TempDir;

/// A folder with ids of a scene by the exact rules (`image-order`) and by those of an ordinary rasterizer.
fn by_rule(rule: &str, scene: &str, size: &str) -> TempDir {
    let home = home();
    let args = [
        scene,
        "--size",
        size,
        "--object-rules",
        rule,
        "--buffers",
        "npy",
        "--no-counts",
        "--quiet",
        "-o",
        "r",
    ];
    bothways(&home, &args).assert().code(1);
    home
}

/// The message on stderr; nothing is printed.
fn refused(mut command: Command) -> String {
    let assert = command.assert().code(2).stdout("");
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

const EXACT: &str = "r/image-order.ids.npy";
const RULED: &str = "r/object-order.ids.npy";

#[test]
fn samples_at_pixel_corners_are_named() {
    let home = by_rule("corner", "lecture", "96x72");
    let args = ["diff", EXACT, RULED, "--scene", "lecture"];
    insta::assert_snapshot!("why_corner", printed(bothways(&home, &args), 1));
}

#[test]
fn what_fits_equally_well_is_named_too() {
    let home = by_rule("inclusive", "ties", "64x64");
    let args = ["diff", EXACT, RULED, "--scene", "ties", "-o", "out"];
    insta::assert_snapshot!("why_equally_well", printed(bothways(&home, &args), 1));
    let names = ["difference.png", "reasons.png"];
    assert!(names.iter().all(|name| home.path().join("out").join(name).is_file()));
}

#[test]
fn one_pixel_has_its_evidence() {
    let home = by_rule("float32", "slivers", "320x240");
    let of = |pixel: &str, code: i32| {
        printed(
            bothways(&home, &["diff", EXACT, RULED, "--scene", "slivers", "--pixel", pixel]),
            code,
        )
    };
    insta::assert_snapshot!("why_pixel", of("83,123", 1));
    insta::assert_snapshot!("why_equal_pixel", of("0,0", 1));
    let outside = ["diff", EXACT, RULED, "--scene", "slivers", "--pixel", "240,0"];
    insta::assert_snapshot!("why_no_such_pixel", refused(bothways(&home, &outside)));
}

#[test]
fn files_of_other_sizes_are_explained_where_something_does() {
    let home = by_rule("corner", "lecture", "96x72");
    let rendered = |size: &str, out: &str| {
        let args = [
            "lecture",
            "--size",
            size,
            "--order",
            "image",
            "--buffers",
            "npy",
            "--no-counts",
            "--quiet",
            "-o",
            out,
        ];
        bothways(&home, &args).assert().code(0);
    };
    rendered("97x72", "wide");
    let args = ["diff", EXACT, "wide/image-order.ids.npy"];
    insta::assert_snapshot!("why_sizes", refused(bothways(&home, &args)));
}

#[test]
fn rows_for_columns_are_said_from_two_files_alone() {
    let home = home();
    let picture = |name: &str, turned: bool| {
        let lit = |i: u32, j: u32| if i < 2 && j > 3 || i == j { 255 } else { 0 };
        let [width, height] = if turned { [5, 7] } else { [7, 5] };
        let mask = image::GrayImage::from_fn(width, height, |x, y| {
            image::Luma([if turned { lit(x, y) } else { lit(y, x) }])
        });
        mask.save(home.path().join(name)).unwrap();
    };
    picture("a.png", false);
    picture("b.png", true);
    let expected = "error: A = a.png, B = b.png: A is 7 x 5 pixels and B is 5 x 7; compare files of one size (are rows \
                    and columns swapped?); B agrees with A once it is transposed (its rows are A's columns)\n";
    assert_eq!(refused(bothways(&home, &["diff", "a.png", "b.png"])), expected);
}

#[test]
fn json_has_reasons_and_conventions() {
    let home = by_rule("corner", "lecture", "96x72");
    let args = ["diff", EXACT, RULED, "--scene", "lecture", "--json"];
    let json: serde_json::Value =
        serde_json::from_str(&printed(bothways(&home, &args), 1)).unwrap();
    let why = &json["why"];
    assert_eq!(why["a"]["finding"], "true");
    assert_eq!(why["b"]["finding"], "explained");
    let sentences = why["b"]["explanations"][0]["sentences"].as_array().unwrap();
    assert_eq!(sentences.len(), 1);
    let kinds: Vec<&str> = why["reasons"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["kind"].as_str().unwrap())
        .collect();
    assert!(kinds.contains(&"convention"), "{kinds:?}");
    assert!(why["telling"].is_array());
}

#[test]
fn several_samples_a_pixel_are_explained_one_by_one() {
    let home = home();
    let args = ["ties", "--size", "16x16", "--samples", "2", "--object-rules", "inclusive"];
    let more = ["--buffers", "npy", "--no-counts", "--quiet", "-o", "r"];
    bothways(&home, &[&args[..], &more].concat()).assert().code(1);
    let of = |more: &[&str]| {
        let args = ["diff", EXACT, RULED, "--scene", "ties"];
        printed(bothways(&home, &[&args[..], more].concat()), 1)
    };
    insta::assert_snapshot!("why_samples", of(&["-o", "out"]));
    insta::assert_snapshot!("why_pixel_of_samples", of(&["--pixel", "8,8"]));
    assert!(home.path().join("out/reasons.png").is_file());
    let json: serde_json::Value = serde_json::from_str(&of(&["--json"])).unwrap();
    assert_eq!(json["why"]["samples"], 2);
    let [row, column] = [0, 1].map(|axis| json["why"]["telling"][axis].as_u64().unwrap());
    assert!(row < 16 && column < 16);
}
