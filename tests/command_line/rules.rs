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
    insta::assert_snapshot!(with(&["--object-rules", "inclusive"], 1), @"");
    insta::assert_snapshot!(
        with(&["--object-rules", "snapped:8", "--image-rules", "moller-trumbore"], 1), @"");
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
    insta::assert_snapshot!(messages.join("---\n"), @"");
}
