//! `bothways fuzz`: its texts, its files and its ends. What it finds is in `tests/contract/fuzzing.rs`.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use predicates::str::contains;
use std::fs;
use tempfile::TempDir;

/// `bothways fuzz` in a separate folder.
fn fuzz(home: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).env("COLUMNS", "100").arg("fuzz").args(args);
    command
}

fn home() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn printed(home: &TempDir, args: &[&str]) -> String {
    let assert = fuzz(home, args).assert().code(0).stderr("");
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

#[test]
fn a_summary_of_scenes_on_which_all_agree() {
    let home = home();
    insta::assert_snapshot!(printed(&home, &["--seed", "7", "--scenes", "3"]), @r"
    3 scenes, 59 pixels, 64 exact ties, 182 exact fallbacks, 0 disagreements
    both textbooks drew 59 of these pixels, where ties and fallbacks were counted; seed 7
    ");
    // Without a disagreement nothing is written.
    assert_eq!(fs::read_dir(&home).unwrap().count(), 0);
}

#[test]
fn a_summary_for_programs() {
    let args = ["--seed", "7", "--first", "2", "--scenes", "1", "--threads", "1", "--json"];
    insta::assert_snapshot!(printed(&home(), &args), @r#"
    {
      "seed": 7,
      "first_scene": 2,
      "scenes": 1,
      "pixels": 12,
      "textbook_pixels": 12,
      "exact_ties": 4,
      "exact_fallbacks": 49,
      "disagreements": 0,
      "ended_early": false,
      "unfinished": [],
      "findings": []
    }
    "#);
}

#[test]
fn a_seed_means_the_same_on_any_number_of_threads() {
    let on = |threads| {
        printed(&home(), &["--seed", "12", "--scenes", "12", "--json", "--threads", threads])
    };
    assert_eq!(on("1"), on("3"));
}

#[test]
fn a_time_ends_the_run_and_a_new_seed_is_said() {
    let home = home();
    let text = printed(&home, &["--seconds", "0.01", "--threads", "1"]);
    let seed = text.rsplit("seed ").next().unwrap().trim();
    assert!(seed.parse::<u32>().unwrap() < 1_000_000, "{text}");
    assert!(text.contains(", 0 disagreements\n"), "{text}");
}

#[test]
fn bad_numbers_are_refused() {
    let refused = |args: &[&str], message: &'static str| {
        fuzz(&home(), args).assert().code(2).stdout("").stderr(contains(message));
    };
    for seconds in ["0", "-1", "nan", "inf", "1e9", "x"] {
        refused(
            &["--seconds", seconds],
            "give a number of seconds greater than 0, at most a year, such as 60 or 0.5",
        );
    }
    refused(&["--scenes", "0"], "give a whole number from 1 to 4294967295");
    refused(&["--seed", "-1"], "give a whole number from 0 to 4611686018427387904");
    refused(&["--threads", "0"], "give a whole number from 1 to 1024");
    refused(&["--seconds", "1", "--scenes", "1"], "cannot be used with");
}

#[test]
fn a_folder_that_cannot_be_written_is_known_before_the_run() {
    let home = home();
    fs::write(home.path().join("file"), "kept").unwrap();
    // A run that began would take an hour.
    let args = ["--seconds", "3600", "-o"];
    let run =
        |folder: &str| fuzz(&home, &[&args[..], &[folder]].concat()).assert().code(2).stdout("");
    run("file")
        .stderr(contains("cannot write into the folder file: a file is where a folder would be"));
    run("-").stderr(contains("-o - is standard output"));
    assert_eq!(fs::read_to_string(home.path().join("file")).unwrap(), "kept");
}
