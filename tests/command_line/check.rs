//! `check` and `grade`: a whole renderer, and a whole course.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::texts::{bothways, home, printed};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// A folder with the conformance set in `vectors`, and its masks, turned upside down, in `mine`.
fn upside_down() -> TempDir {
    let home = home();
    bothways(&home, &["vectors", "-o", "vectors"]).assert().code(0);
    fs::create_dir(home.path().join("mine")).unwrap();
    for entry in fs::read_dir(home.path().join("vectors")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if let Some(scene) = name.strip_suffix(".mask.png") {
            let mask = image::open(&path).unwrap().flipv();
            mask.save(home.path().join("mine").join(format!("{scene}.png"))).unwrap();
        }
    }
    home
}

#[test]
fn a_renderer_is_summed_up_by_cause() {
    let home = upside_down();
    fs::remove_file(home.path().join("mine/fan.png")).unwrap();
    insta::assert_snapshot!("check", printed(bothways(&home, &["check", "mine"]), 1));
    let json = printed(bothways(&home, &["check", "mine", "vectors", "--json"]), 1);
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["causes"][0]["certainty"], "convention");
    assert_eq!(json["missing"], serde_json::json!(["fan"]));
    assert_eq!(json["set"], "vectors");
    let files = json["files"].as_array().unwrap();
    let wrong = files.iter().filter(|file| file["right"] == false).count();
    assert_eq!(json["causes"][0]["files"].as_array().unwrap().len(), wrong);
    // Where most files are noise, what explains the others is a guess.
    let mut dice = fastrand::Rng::with_seed(3);
    let mut entries: Vec<_> = fs::read_dir(home.path().join("mine")).unwrap().collect();
    entries.sort_by_key(|entry| entry.as_ref().unwrap().file_name());
    for entry in entries.into_iter().skip(14) {
        let path = entry.unwrap().path();
        let mut mask = image::open(&path).unwrap().into_luma8();
        mask.pixels_mut().for_each(|pixel| pixel.0 = [if dice.bool() { 255 } else { 0 }]);
        mask.save(&path).unwrap();
    }
    let said = printed(bothways(&home, &["check", "mine"]), 1);
    assert!(said.contains("a guess, which explains less than half:"), "{said}");
    assert!(said.contains("a guess: it is upside down"), "{said}");
}

#[test]
fn the_next_step_compares_what_the_file_holds() {
    let home = upside_down();
    let mine = home.path().join("mine");
    fs::remove_dir_all(&mine).unwrap();
    fs::create_dir(&mine).unwrap();
    // The distances of another scene of the same size.
    let other = home.path().join("vectors/top-edge.t.npy");
    fs::copy(other, mine.join("one-triangle.npy")).unwrap();
    let said = printed(bothways(&home, &["check", "mine", "vectors"]), 1);
    let next = "next: bothways diff mine/one-triangle.npy vectors/one-triangle.t.npy --scene \
                vectors/one-triangle.toml\n";
    assert!(said.ends_with(next), "{said}");
    // A shell takes the command as it is.
    for (from, to) in [("mine", "my pictures"), ("vectors", "it's the set")] {
        fs::rename(home.path().join(from), home.path().join(to)).unwrap();
    }
    let said = printed(bothways(&home, &["check", "my pictures", "it's the set"]), 1);
    let next = "next: bothways diff 'my pictures/one-triangle.npy' 'it'\\''s the set/one-triangle.t.npy' --scene \
                'it'\\''s the set/one-triangle.toml'\n";
    assert!(said.ends_with(next), "{said}");
    for (from, to) in [("mine", "my pictures"), ("vectors", "it's the set")] {
        fs::rename(home.path().join(to), home.path().join(from)).unwrap();
    }
    // Colours alone tell what is covered by their background, here nothing of the left half.
    let (mine, background) = (home.path().join("mine"), image::Rgb([16, 20, 24]));
    fs::remove_file(mine.join("one-triangle.npy")).unwrap();
    let mask = image::open(home.path().join("vectors/one-triangle.mask.png")).unwrap();
    let half =
        |x: u32, _: u32| if 2 * x < mask.width() { background } else { image::Rgb([200; 3]) };
    let picture = image::RgbImage::from_fn(mask.width(), mask.height(), half);
    picture.save(mine.join("one-triangle.png")).unwrap();
    let args = ["check", "mine", "vectors", "--background", "#101418"];
    let said = printed(bothways(&home, &args), 1);
    let next = "next: bothways diff mine/one-triangle.png vectors/one-triangle.mask.png --scene \
                vectors/one-triangle.toml --background '#101418'\n";
    assert!(said.ends_with(next), "{said}");
}

#[test]
fn a_file_that_cannot_be_compared_is_named_beside_json() {
    let home = upside_down();
    let mine = home.path().join("mine");
    image::GrayImage::new(3, 5).save(mine.join("fan.png")).unwrap();
    fs::write(mine.join("left-edge.png"), "no picture").unwrap();
    let assert = bothways(&home, &["check", "mine", "vectors", "--json"]).assert().code(2);
    let output = assert.get_output();
    let said = String::from_utf8(output.stderr.clone()).unwrap();
    assert!(said.starts_with("error: ") && said.lines().count() == 1, "{said}");
    assert!(said.contains(" (and 1 other file) cannot be compared: "), "{said}");
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(json["verdict"].as_str().unwrap().contains("; 2 cannot be compared"), "{json}");
}

#[test]
fn the_set_itself_passes_and_a_page_is_written() {
    let home = upside_down();
    let args = ["check", "vectors", "vectors", "--html", "check.html"];
    let said = printed(bothways(&home, &args), 0);
    assert!(
        said.contains("all 222 files are right") && said.ends_with("page written to check.html\n"),
        "{said}"
    );
    let page = fs::read_to_string(home.path().join("check.html")).unwrap();
    assert!(page.starts_with("<!doctype html>") && page.ends_with("</html>\n"));
}

/// Files of the canonical scene: one right, one from another eye, one that is none, one of another size.
fn handed_in() -> TempDir {
    let home = home();
    let drawn = |out: &str, code: i32, more: &[&str]| {
        let args = ["canonical", "--buffers", "npy", "--no-counts", "--quiet", "-o", out];
        bothways(&home, &[&args[..], more].concat()).assert().code(code);
    };
    drawn("ada", 0, &["--size", "60x40"]);
    drawn("bob", 1, &["--size", "60x40", "--object-rules", "corner"]);
    drawn("cy", 0, &["--size", "40x40"]);
    fs::write(home.path().join("dee.npy"), "not an array").unwrap();
    home
}

const FILES: [&str; 4] =
    ["ada/object-order.ids.npy", "bob/object-order.ids.npy", "cy/object-order.ids.npy", "dee.npy"];

#[test]
fn a_course_is_graded() {
    let home = handed_in();
    let args =
        [&["grade", "canonical", "--size", "60x40", "--csv", "marks.csv"], &FILES[..]].concat();
    insta::assert_snapshot!("grade", printed(bothways(&home, &args), 1));
    let table = fs::read_to_string(home.path().join("marks.csv")).unwrap();
    insta::assert_snapshot!("grade_table", table);
    let args = [&["grade", "canonical", "--size", "60x40", "--json"], &FILES[..1]].concat();
    let json: Value = serde_json::from_str(&printed(bothways(&home, &args), 0)).unwrap();
    assert_eq!(json["grades"][0]["score"], 100.0);
    assert_eq!(json["formula"], "score = 100 (right + explained / 2^mistakes) / seen");
}

#[test]
fn a_table_on_standard_output_is_alone_there() {
    let home = handed_in();
    let args = [&["grade", "canonical", "--size", "60x40", "--csv", "-"], &FILES[..1]].concat();
    let assert = bothways(&home, &args).assert().code(0);
    let output = assert.get_output();
    let (table, said) = (&output.stdout, String::from_utf8(output.stderr.clone()).unwrap());
    assert!(table.starts_with(b"file,verdict,score"), "{}", String::from_utf8_lossy(table));
    assert!(said.contains("1 of 1 file right"), "{said}");
}
