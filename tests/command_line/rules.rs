//! The rules of ordinary renderers on the command line: how they are listed, reported and refused.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

fn bothways(home: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).env("COLUMNS", "100").args(args);
    command
}

fn home() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn printed(args: &[&str], code: i32) -> String {
    let home = home();
    let assert = bothways(&home, args).assert().code(code).stderr("");
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

fn refused(args: &[&str]) -> String {
    let home = home();
    let assert = bothways(&home, args).assert().code(2).stdout("");
    assert!(!home.path().join("out").exists());
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

#[test]
fn all_rules_are_listed() {
    insta::assert_snapshot!(printed(&["rules"], 0));
}

#[test]
fn the_list_is_json_as_well() {
    let list: Value = serde_json::from_str(&printed(&["rules", "--json"], 0)).unwrap();
    let snapped = &list["object_order"][3];
    assert_eq!(snapped["rule"], "snapped:B");
    assert_eq!(snapped["scene"], "slivers");
    assert_eq!(snapped["command"], "bothways slivers --object-rules snapped:8");
    assert_eq!(list["image_order"].as_array().unwrap().len(), 7);
}

#[test]
fn every_command_of_the_list_differs() {
    let list: Value = serde_json::from_str(&printed(&["rules", "--json"], 0)).unwrap();
    for order in ["object_order", "image_order"] {
        for rule in list[order].as_array().unwrap() {
            let command = rule["command"].as_str().unwrap();
            let home = home();
            let words: Vec<&str> = command.split(' ').skip(1).chain(["--quiet"]).collect();
            bothways(&home, &words).assert().code(1);
        }
    }
}

#[test]
fn the_table_names_the_rules() {
    let args = ["ties", "--no-times", "--no-counts"];
    let with = |rules: &[&str], code| printed(&[&args, rules].concat(), code);
    insta::assert_snapshot!(with(&["--object-rules", "inclusive"], 1), @r"
    ties: 522 primitives, 64 x 64 pixels, 1 sample a pixel

    fast                          object order, inclusive              image order
    samples covered                                 4,096                    4,032
    executed for a frame, by tiles
      tiles                                   not counted                        4
      of these, skipped                       not counted                        -
      nodes opened                            not counted                       10
      boxes tested                            not counted                      118
      clusters in tiles                       not counted                        -
      of these, skipped                       not counted                        -
      triangles looked at                     not counted                      838
      of these, set up                        not counted                      588
      primitives one by one                   not counted                        -
      steps of 8 or 16 lanes                  not counted                      131
      blocks of 16 samples                    not counted                      798
      samples one by one                      not counted                        -
    colours beyond 2 of 255                      118 pixels, by at most 125 of 255

    differ: the orders see different primitives in 784 pixels, first at (0, 4); 64 samples are covered by one of them only
    written to out/ties
    ");
    insta::assert_snapshot!(
        with(&["--object-rules", "snapped:8", "--image-rules", "moller-trumbore"], 1), @r"
    ties: 522 primitives, 64 x 64 pixels, 1 sample a pixel

    fast                               object order, snapped:8  image order, moller-trumbore
    samples covered                                      4,032                         4,096
    colours beyond 2 of 255                                108 pixels, by at most 125 of 255

    differ: the orders see different primitives in 774 pixels, first at (0, 4); 64 samples are covered by one of them only
    written to out/ties
    ");
    // Without rules, nothing changes.
    let exact = ["--object-rules", "exact", "--image-rules", "exact"];
    assert_eq!(with(&exact, 0), with(&[], 0));
}

#[test]
fn work_is_counted_for_the_exact_order_alone() {
    let home = home();
    let args = ["ties", "--image-rules", "corner", "--no-times", "--quiet"];
    bothways(&home, &args).assert().code(1).stdout("").stderr("");
    let report = fs::read_to_string(home.path().join("out/ties/report.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["image_order"]["rules"], "corner");
    assert_eq!(report["image_order"]["work"], Value::Null);
    assert!(report["object_order"].get("rules").is_none());
    assert!(report["object_order"]["work"]["tests"].as_u64().unwrap() > 0);
    assert_eq!(report["coverage"]["match"], false);
}

#[test]
fn one_order_alone_has_no_verdict() {
    printed(&["ties", "--order", "image", "--image-rules", "jittered:7", "--no-times"], 0);
}

#[test]
fn what_cannot_be_is_refused() {
    let messages: Vec<String> = [
        &["--object-rules", "watertight"][..],
        &["--object-rules", "snapped:17"],
        &["--object-rules", "near-clip"],
        &["--image-rules", "corner:1"],
        &["--image-rules", "jittered:x"],
        &["--image-rules", "snapped"],
        &["--image-rules", "corner", "--order", "object"],
        &["--object-rules", "corner", "--method", "textbook"],
        &["--object-rules", "corner", "--order", "object", "--stream"],
        &["--image-rules", "one-origin", "--verify", "9"],
    ]
    .map(|rules| refused(&[&["ties"], rules].concat()))
    .into();
    insta::assert_snapshot!(messages.join("---\n"), @r"
    error: invalid value 'watertight' for '--object-rules <RULE>': there is no such rule of object order; choose exact or one of float32, inclusive, exclusive, snapped:B, corner, near-clip:Z, depth24 ('bothways rules' explains them)

    For more information, try '--help'.
    ---
    error: invalid value 'snapped:17' for '--object-rules <RULE>': snapped:B takes a whole number of bits from 0 to 16, such as snapped:8

    For more information, try '--help'.
    ---
    error: invalid value 'near-clip' for '--object-rules <RULE>': near-clip:Z takes a positive depth along the axis of view, such as near-clip:0.5

    For more information, try '--help'.
    ---
    error: invalid value 'corner:1' for '--image-rules <RULE>': corner takes no number; write it as corner

    For more information, try '--help'.
    ---
    error: invalid value 'jittered:x' for '--image-rules <RULE>': jittered:SEED takes a whole number from 0 to 18446744073709551615, such as jittered:7

    For more information, try '--help'.
    ---
    error: invalid value 'snapped' for '--image-rules <RULE>': there is no such rule of image order; choose exact or one of moller-trumbore, watertight, float32, corner, one-origin, flip-rows, jittered:SEED ('bothways rules' explains them)

    For more information, try '--help'.
    ---
    error: --image-rules corner is for image order, which --order leaves out; drop one of them
    ---
    error: --object-rules corner cannot be used with --method textbook, which is exact; leave one of them out
    ---
    error: --object-rules corner cannot be used with --stream, which is exact; leave one of them out
    ---
    error: --image-rules one-origin cannot be used with --verify, which holds exact renderers against their textbook; leave one of them out
    ");
}
