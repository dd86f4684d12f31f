//! `bothways cover`: the drawing, the table, JSON and the mask.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::fs;
use tempfile::TempDir;

fn bothways(home: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).arg("cover").args(args);
    command
}

fn home() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn printed(args: &[&str]) -> String {
    let output = bothways(&home(), args).assert().code(0).stderr("").get_output().stdout.clone();
    String::from_utf8(output).unwrap()
}

const CORNERS: &str = "0.5,0.5 0.5,3.5 3.5,0.5";

#[test]
fn a_small_triangle_is_drawn() {
    insta::assert_snapshot!(printed(&[CORNERS, "--size", "9x5"]), @r"
    triangle (0.5, 0.5) (0.5, 3.5) (3.5, 0.5) on 9 x 5 pixels: its corners are seen counter-clockwise
    6 pixels covered
    9 pixel centres lie exactly on an edge: 5 covered, 4 not (top-left rule)

    row  columns 0 to 4
      0  + + + o .
      1  + # o . .
      2  + o . . .
      3  o . . . .
      4  . . . . .

    # covered   + on an edge, covered   o on an edge, not covered   . not covered
    ");
}

#[test]
fn a_table_lists_the_rows() {
    insta::assert_snapshot!(printed(&[CORNERS, "--size", "9x5", "--table"]), @r"
    triangle (0.5, 0.5) (0.5, 3.5) (3.5, 0.5) on 9 x 5 pixels: its corners are seen counter-clockwise
    6 pixels covered
    9 pixel centres lie exactly on an edge: 5 covered, 4 not (top-left rule)

        row    first     last    count  on edge
          0        0        2        3        4
          1        0        1        2        2
          2        0        0        1        2
          3        -        -        0        1
    ");
}

#[test]
fn what_is_too_wide_to_draw_is_a_table() {
    let text = printed(&["0,0 300,0 0,3", "--size", "640x480"]);
    assert!(text.contains("first") && !text.contains('#'), "{text}");
    let text = printed(&["300,200 309,200 300,207", "--size", "640x480"]);
    assert!(text.contains("columns 299 to 308"), "{text}");
}

#[test]
fn json_has_every_fact() {
    let report: Value =
        serde_json::from_str(&printed(&[CORNERS, "--size", "9x5", "--json"])).unwrap();
    let expected = json!({
        "triangle": [[0.5, 0.5], [0.5, 3.5], [3.5, 0.5]],
        "size": [9, 5],
        "facing": "counter-clockwise",
        "covered": 6,
        "on_edge": { "samples": 9, "covered": 5 },
        "rows": [
            { "row": 0, "covered": [0, 2], "on_edge": [0, 1, 2, 3] },
            { "row": 1, "covered": [0, 1], "on_edge": [0, 2] },
            { "row": 2, "covered": [0, 0], "on_edge": [0, 1] },
            { "row": 3, "covered": null, "on_edge": [0] },
        ],
    });
    assert_eq!(report, expected);
}

#[test]
fn a_triangle_without_area_covers_nothing() {
    let text = printed(&["1,1 3,3 2,2", "--size", "4x4"]);
    assert!(text.contains("it has no area, and so covers nothing"), "{text}");
    assert!(text.contains("0 pixels covered"), "{text}");
}

#[test]
fn numbers_are_as_short_as_they_read_back() {
    let corners = "0.1,0 8,0.5 4,9.123456789";
    let text = printed(&[corners, "--size", "8x8"]);
    assert!(text.starts_with("triangle (0.1, 0) (8, 0.5) (4, 9.123457) on"), "{text}");
    let json = printed(&[corners, "--size", "8x8", "--json"]);
    assert!(json.contains("0.1,") && json.contains("9.123457\n"), "{json}");
    // A program reads exactly the tested number.
    assert_eq!("9.123457".parse::<f32>(), "9.123456789".parse::<f32>());
}

#[test]
fn corners_may_be_negative() {
    let corners = "-1,-2 9,0 0,9";
    let text = printed(&[corners, "--size", "4x4"]);
    assert!(text.starts_with("triangle (-1, -2) (9, 0) (0, 9) on 4 x 4 pixels"), "{text}");
    assert_eq!(printed(&["--size", "4x4", corners]), text);
    assert_eq!(printed(&["--size", "4x4", "--", corners]), text);
}

#[test]
fn the_corners_may_be_one_argument_or_several() {
    let quoted = printed(&["-1,1 9,2 3,7", "--size", "10x8"]);
    for args in [
        ["-1,1", "9,2", "3,7", "--size", "10x8"].as_slice(),
        &["--size", "10x8", "-1,1", "9,2", "3,7"],
        &["-1,1 9,2", "3,7", "--size=10x8"],
    ] {
        assert_eq!(printed(args), quoted, "{args:?}");
    }
    let refused = contains("'1,1 9,2 3,7 4,4' has 4 corners; a triangle has three");
    let args = ["1,1 9,2", "3,7", "4,4", "--size", "10x8"];
    bothways(&home(), &args).assert().code(2).stdout("").stderr(refused);
    let refused = contains("unexpected argument '4,4'");
    let args = ["1,1", "9,2", "3,7", "4,4", "--size", "10x8"];
    bothways(&home(), &args).assert().code(2).stdout("").stderr(refused);
}

#[test]
fn the_mask_is_written_at_once_or_not_at_all() {
    let home = home();
    bothways(&home, &[CORNERS, "--size", "9x5", "-o", "mask.png"]).assert().code(0);
    let mask = image::open(home.path().join("mask.png")).unwrap();
    assert_eq!(mask.color(), image::ColorType::L8);
    let mask = mask.to_luma8();
    assert_eq!(mask.dimensions(), (9, 5));
    assert_eq!(mask.iter().filter(|&&pixel| pixel == 255).count(), 6);
    assert_eq!(fs::read_dir(&home).unwrap().count(), 1);

    let refused = contains("cannot write mask.png/mask.png").and(contains("-o"));
    let args = [CORNERS, "--size", "9x5", "-o", "mask.png/mask.png"];
    bothways(&home, &args).assert().code(2).stdout("").stderr(refused);
    assert_eq!(fs::read_dir(&home).unwrap().count(), 1);
}
