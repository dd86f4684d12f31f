//! `render --verify N`: the textbook also answers some samples of a picture.

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;
use std::path::Path;

fn bothways(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").expect("it is built");
    command.args(arguments).arg("-o").arg(folder);
    command
}

fn report(arguments: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("there is room");
    let run = bothways(folder.path(), arguments).arg("--json").assert().success();
    let written = std::fs::read(folder.path().join("report.json")).expect("it is written");
    assert_eq!(written, run.get_output().stdout);
    serde_json::from_slice(&written).expect("it is JSON")
}

#[test]
fn the_verdict_and_the_report_say_what_was_verified() {
    let folder = tempfile::tempdir().expect("there is room");
    let says = "verified: 64 samples answered by the textbook as well, none differs";
    bothways(folder.path(), &["ties", "--size", "64x64", "--verify", "64"])
        .assert()
        .success()
        .stdout(contains(says).and(contains("at exact ties")).and(contains("at random")));

    let report = report(&["ties", "--size", "64x64", "--verify", "64"]);
    let verified = &report["verified"];
    assert_eq!((&verified["samples"], &verified["match"]), (&64.into(), &true.into()));
    let kinds = ["differing", "ties", "silhouettes", "edges", "at_random"];
    let all = kinds.iter().map(|kind| verified[kind].as_u64().expect("it is a count")).sum::<u64>();
    assert_eq!(all, 64);
    for order in ["object_order", "image_order"] {
        assert_eq!(verified[order]["differing_samples"], 0);
        assert_eq!(verified[order]["first_differing"], Value::Array(Vec::new()));
    }
}

#[test]
fn one_order_is_held_against_its_own_textbook() {
    let report = report(&["overlap", "--size", "40x30", "--verify", "50", "--order", "image"]);
    assert_eq!(report["verified"]["object_order"], Value::Null);
    assert_eq!(report["verified"]["image_order"]["differing_samples"], 0);
}

#[test]
fn nothing_is_said_where_nothing_is_asked() {
    assert_eq!(report(&["canonical", "--size", "8x6"]).get("verified"), None);
}

#[test]
fn a_part_of_the_picture_is_verified_there() {
    let crop = ["--crop", "10,20,5,4", "--samples", "2", "--verify", "1000"];
    let report = report(&[&["canonical", "--size", "64x48"], &crop[..]].concat());
    assert_eq!(report["verified"]["samples"], 5 * 4 * 4);
}

#[test]
fn what_cannot_be_verified_is_refused() {
    let folder = tempfile::tempdir().expect("there is room");
    let fails = |arguments: &[&str], says: &str| {
        let run = bothways(folder.path(), arguments).assert().code(2);
        run.stderr(contains(says));
        assert_eq!(std::fs::read_dir(folder.path()).expect("it is a folder").count(), 0);
    };
    fails(&["ties", "--verify", "0"], "give a whole number from 1");
    fails(&["ties", "--verify", "9", "--method", "textbook"], "leave one of them out");
    fails(&["mesh.ply", "--verify", "9", "--stream", "--order", "object"], "--stream");
}
