//! `bothways diff --html`: where the page goes, and what is said about it. The page itself is driven by `.ci/browser`.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::{contains, ends_with, starts_with};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

fn diff(home: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).arg("diff").args(args);
    command
}

/// A folder with two masks that differ in two pixels.
fn masks() -> TempDir {
    let home = tempfile::tempdir().unwrap();
    for (name, pixels) in [("a.png", [0, 255, 255, 0]), ("b.png", [0, 255, 0, 255])] {
        let picture = image::GrayImage::from_raw(2, 2, pixels.to_vec()).unwrap();
        picture.save(home.path().join(name)).unwrap();
    }
    home
}

#[test]
fn the_page_is_written_and_its_path_printed() {
    let home = masks();
    let said = ends_with(
        "differ: 2 pixels of 4, in the bounding box from (1, 0) to (1, 1)\npage written to new/page.html\n",
    );
    diff(&home, &["a.png", "b.png", "--html", "new/page.html"])
        .assert()
        .code(1)
        .stdout(said)
        .stderr("");
    let page = fs::read_to_string(home.path().join("new/page.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
    assert!(page.contains("<span class=\"file\">a.png</span>"));
    // The folder has the page alone: nothing temporary is left.
    assert_eq!(fs::read_dir(home.path().join("new")).unwrap().count(), 1);
}

#[test]
fn the_same_files_give_the_same_page() {
    let home = masks();
    let page = |name: &str| {
        diff(&home, &["a.png", "b.png", "--html", name]).assert().code(1);
        fs::read(home.path().join(name)).unwrap()
    };
    assert_eq!(page("one.html"), page("two.html"));
}

#[test]
fn standard_output_takes_one_thing() {
    let home = masks();
    let report =
        diff(&home, &["a.png", "b.png", "--html", "page.html", "--json"]).output().unwrap();
    let report: Value = serde_json::from_slice(&report.stdout).unwrap();
    assert_eq!(report["differing_pixels"], 2);
    assert!(home.path().join("page.html").exists());
    let page = starts_with("<!DOCTYPE html>").and(contains("page written").not());
    let said = contains("differ: 2 pixels of 4");
    diff(&home, &["a.png", "b.png", "--html", "-"]).assert().code(1).stdout(page).stderr(said);
}

#[test]
fn what_cannot_be_a_page_is_refused_and_nothing_is_written() {
    let home = masks();
    fs::create_dir(home.path().join("folder")).unwrap();
    let refused: [(&[&str], &str); 5] = [
        (
            &["a.png", "b.png", "--html", "page.png"],
            "cannot write page.png: a page is an .html file, and .png is none; end the name in .html",
        ),
        (
            &["a.png", "b.png", "--html", "-", "--json"],
            "--json and the page would both go to standard output; name a file with --html",
        ),
        (
            &["folder", "folder", "--html", "page.html"],
            "--html shows one pair of files, and A and B are folders; name two files",
        ),
        (&["a.png", "b.png", "--html", "folder"], "choose another file with --html"),
        (&["a.png", "missing.png", "--html", "page.html"], "cannot read missing.png"),
    ];
    for (args, message) in refused {
        let said = contains(message).and(contains("panicked").not());
        diff(&home, args).assert().code(2).stdout("").stderr(said);
    }
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 3);
}
