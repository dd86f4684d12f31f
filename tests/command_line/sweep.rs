//! `bothways sweep`: its table and files, its ends and new beginnings.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::arguments::arguments;
use assert_cmd::Command;
use assert_cmd::assert::Assert;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use tempfile::TempDir;

/// Small pictures and few triangles.
const SMALL: &str = "--size 64x36 --most 3k";

fn sweep(home: &TempDir, line: &str) -> Assert {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).env("COLUMNS", "100").env_remove("RAYON_NUM_THREADS").arg("sweep");
    command.args(arguments(line)).assert()
}

fn home() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn files(home: &TempDir, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(home.path().join(folder)).unwrap().map(|entry| entry.unwrap());
    let read = |entry: fs::DirEntry| {
        (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())
    };
    entries.map(read).collect()
}

fn csv(home: &TempDir, folder: &str) -> String {
    fs::read_to_string(home.path().join(folder).join("sweep.csv")).unwrap()
}

#[test]
fn counts_are_printed_with_slopes_and_crossings() {
    let home = home();
    let done = sweep(&home, &format!("triangles {SMALL} --no-times -o .")).code(0).stderr("");
    let text = String::from_utf8(done.get_output().stdout.clone()).unwrap();
    insta::assert_snapshot!(text);
    let names: Vec<String> = files(&home, ".").into_keys().collect();
    assert_eq!(names, ["sweep-triangles-steps.svg", "sweep.csv", "sweep.json"]);
    insta::assert_snapshot!("sweep_csv", csv(&home, "."));
    let json: Value = serde_json::from_slice(&files(&home, ".")["sweep.json"]).unwrap();
    assert_eq!((&json["size"], &json["times"]), (&serde_json::json!([64, 36]), &Value::Null));
    let chart = &json["charts"][0];
    assert_eq!((&chart["axis"], &chart["quantity"]), (&"triangles".into(), &"steps".into()));
    let slope = chart["curves"][2]["slope"].as_f64().unwrap();
    assert!((slope - 1.0).abs() < 0.01, "object order, textbook: {slope}");
    assert!(text.contains(chart["fast"]["says"].as_str().unwrap()));
}

#[test]
fn without_times_every_run_writes_the_same_bytes() {
    let home = home();
    let line = format!("triangles triangle-size {SMALL} --no-times --png --theme light");
    sweep(&home, &format!("{line} -o one --threads 1")).code(0);
    sweep(&home, &format!("{line} -o two --threads 2")).code(0);
    let one = files(&home, "one");
    assert!(one == files(&home, "two"));
    assert_eq!(one.len(), 6);
    let png = image::load_from_memory(&one["sweep-triangle-size-steps.png"]).unwrap();
    assert_eq!((png.width(), png.height()), (1920, 1080));
    // Again in the same folder: nothing is left to measure.
    sweep(&home, &format!("{line} -o one")).code(0);
    assert!(one == files(&home, "one"));
    // Charts that a run does not draw are removed.
    sweep(&home, &format!("triangles {SMALL} --no-times -o one")).code(0);
    let names: Vec<String> = files(&home, "one").into_keys().collect();
    assert_eq!(names, ["sweep-triangles-steps.svg", "sweep.csv", "sweep.json"]);
    // But no measurement is.
    assert_eq!(one["sweep.csv"], files(&home, "one")["sweep.csv"]);
}

#[test]
fn an_interrupted_run_goes_on_where_it_stopped() {
    let home = home();
    let line = "triangles --size 32x18 --most 3k --rounds 2 -o .";
    sweep(&home, line).code(0);
    let whole = csv(&home, ".");
    let times = |text: &str| -> Vec<String> {
        let is_time = |line: &&str| line.contains(",milliseconds,");
        text.lines().filter(is_time).map(str::to_owned).collect()
    };
    // Five scenes, both orders: two rounds of the fast methods, one of the textbooks.
    assert_eq!(times(&whole).len(), 5 * 2 * 3);
    assert!(whole.contains("thread of"));

    // What an interruption leaves: some measurements, and no more.
    let kept: Vec<&str> =
        whole.lines().enumerate().filter(|(n, _)| n % 3 != 2).map(|(_, l)| l).collect();
    fs::write(home.path().join("sweep.csv"), kept.join("\n") + "\n").unwrap();
    sweep(&home, line).code(0);
    let again = csv(&home, ".");
    assert_eq!(again.lines().count(), whole.lines().count());
    assert!(kept.iter().all(|line| again.lines().any(|other| other == *line)));

    // One more round, and more triangles, keep what is there.
    sweep(&home, "triangles --size 32x18 --most 10k --rounds 3 -o .").code(0);
    let more = csv(&home, ".");
    assert!(again.lines().all(|line| more.lines().any(|other| other == line)));
    assert!(times(&more).len() > times(&again).len());
    let names: Vec<String> = files(&home, ".").into_keys().collect();
    let charts = ["sweep-triangles-steps.svg", "sweep-triangles-times.svg"];
    assert_eq!(names, [&charts[..], &["sweep.csv", "sweep.json"]].concat());

    sweep(&home, &format!("{line} --fresh")).code(0);
    assert!(!csv(&home, ".").contains(",10000,"));
}

#[test]
fn other_conditions_are_refused_and_nothing_changes() {
    let home = home();
    sweep(&home, &format!("triangles {SMALL} --rounds 1 --threads 1 -o .")).code(0);
    let before = files(&home, ".");
    for (line, said) in [
        (format!("triangles {SMALL} --threads 2 -o ."), "it has times of \"1 thread of "),
        (format!("triangles {SMALL} --no-times -o ."), "and this run takes none; give --fresh"),
        (
            "triangles --size 64x40 --most 3k -o .".to_owned(),
            "it has 100 triangles in 64x36 pixels along triangles, which is no scene",
        ),
    ] {
        let said = contains("cannot go on with ./sweep.csv: ").and(contains(said));
        sweep(&home, &line).code(2).stdout("").stderr(said.and(contains("another folder with -o")));
        assert!(before == files(&home, "."), "{line}");
    }
    fs::write(home.path().join("sweep.csv"), "mine\n").unwrap();
    let said = contains("line 1 is not what a sweep writes (its columns are others)");
    sweep(&home, &format!("triangles {SMALL} -o .")).code(2).stderr(said);
}

#[test]
fn json_is_what_the_file_holds() {
    let home = home();
    let done = sweep(&home, &format!("depth-complexity {SMALL} --no-times --json -o .")).code(0);
    assert_eq!(done.get_output().stdout, files(&home, ".")["sweep.json"]);
}
