//! `bothways diff` of two folders: a whole conformance set, or files of the same name.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use super::diff::{bothways, count, json_of, rendered};
use bothways::common::Projection;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::json;
use std::fs;
use tempfile::TempDir;

/// A folder with the conformance set in `vectors`, and another renderer's files in `mine`.
fn with_vectors() -> TempDir {
    let home = tempfile::tempdir().unwrap();
    bothways(&home, &["vectors", "-o", "vectors"]).assert().code(0);
    let mine = home.path().join("mine");
    fs::create_dir(&mine).unwrap();
    for vector in bothways::vectors::all() {
        let (name, from) = (vector.name, |ending| format!("vectors/{}{ending}", vector.name));
        // Masks as PNG under the scene's name, ids of one scene under a name of their own.
        fs::copy(home.path().join(from(".mask.png")), mine.join(format!("{name}.png"))).unwrap();
        if name == "tiles" {
            let to = mine.join("tiles.drawn.npy");
            fs::copy(home.path().join(from(".ids.npy")), to).unwrap();
        }
    }
    home
}

#[test]
fn a_whole_folder_is_held_against_the_vectors() {
    let home = with_vectors();
    let all = contains("74 of 75 pairs").not().and(contains("75 of 75 pairs equal"));
    let said = all.and(contains("tiles.ids ")).and(contains("tiles.mask "));
    bothways(&home, &["diff", "mine", "vectors"]).assert().code(0).stdout(said).stderr("");
    let turned = contains("A  vectors: the conformance set");
    bothways(&home, &["diff", "vectors", "mine"]).assert().code(0).stdout(turned);
    let two_sets = contains("222 of 222 pairs equal");
    bothways(&home, &["diff", "vectors", "vectors"]).assert().code(0).stdout(two_sets);

    // A wrong picture, a missing picture, and a file that belongs to no scene and is no picture.
    let mask = vec![255; 64];
    let mask = image::GrayImage::from_raw(8, 8, mask).unwrap();
    mask.save(home.path().join("mine/square.png")).unwrap();
    fs::remove_file(home.path().join("mine/left-edge.png")).unwrap();
    fs::write(home.path().join("mine/notes.png"), "no picture").unwrap();
    let said = contains(
        "39 pixels of 64 differ, first (0, 0). All sides lie on samples: a square of 5 x 5",
    )
    .and(contains("A lacks 1 scene: left-edge\n"))
    .and(contains("not of the set, and left out: 1 file, such as notes.png"))
    .and(contains("73 of 74 pairs equal, 1 differs, 1 is missing"))
    .and(contains("next: bothways diff mine/square.png vectors/square.mask.png -o out/diff"))
    .and(contains("why:  bothways pixel vectors/square.toml 0 0"));
    let args = ["diff", "mine", "vectors"];
    bothways(&home, &args).args(["-o", "out"]).assert().code(1).stdout(said).stderr("");
    let picture = image::open(home.path().join("out/square.mask.difference.png")).unwrap();
    assert_eq!((picture.width(), count(&home.path().join("out"))), (8, 1));

    let report = json_of(&home, &args);
    assert_eq!((&report["equal"], &report["missing_in_a"]), (&json!(false), &json!(["left-edge"])));
    let pairs = report["pairs"].as_array().unwrap();
    let square = pairs.iter().find(|pair| pair["name"] == "square.mask").unwrap();
    assert_eq!((&square["equal"], &square["differing_pixels"]), (&json!(false), &json!(39)));
    assert!(square["point"].as_str().unwrap().starts_with("All sides lie on samples"));
    assert_eq!(pairs.iter().filter(|pair| pair["equal"] == false).count(), 1);

    // An unreadable file does not stop the comparison of other files, and the exit code is 2.
    fs::write(home.path().join("mine/hair.png"), "no picture").unwrap();
    let said = contains("hair.mask").and(contains("cannot be compared: mine/hair.png is neither"));
    let said = said.and(contains("72 of 74 pairs equal, 1 differs, 1 cannot be compared"));
    bothways(&home, &args).assert().code(2).stdout(said);
}

#[test]
fn the_set_is_never_blamed_for_how_it_is_written() {
    let home = with_vectors();
    let set = "vectors/far-off-corners.ids.npy";
    let mut ids = fs::read(home.path().join(set)).unwrap();
    // The triangle 0 is culled: its pixels show nothing. Ids follow the header of 128 bytes.
    for id in ids[128..].chunks_exact_mut(4).filter(|id| *id == [0; 4]) {
        id.fill(u8::MAX);
    }
    fs::write(home.path().join("mine.npy"), ids).unwrap();
    for (a, b, one) in [("mine.npy", set, "A"), (set, "mine.npy", "B")] {
        let said = contains(format!("{one} never shows the primitive 0 of"));
        let blamed = contains("0 stands for nothing").or(contains("save it as bool"));
        let said = said.and(blamed.not());
        bothways(&home, &["diff", a, b]).assert().code(1).stdout(said);
    }
    // If neither file is known to be right, either file may be wrong.
    fs::copy(home.path().join(set), home.path().join("theirs.npy")).unwrap();
    let blamed = contains("in B, 0 stands for nothing").and(contains("never shows the primitive"));
    bothways(&home, &["diff", "mine.npy", "theirs.npy"]).assert().code(1).stdout(blamed);
}

#[test]
fn files_of_the_same_name_in_two_folders_are_compared() {
    let home = rendered("1");
    let args = ["canonical", "--size", "24x16", "--no-times", "--quiet", "-o", "other"];
    bothways(&home, &args).assert().code(0);
    let said =
        contains("B lacks 6 files: image-order.ids.npy, image-order.ids.png, image-order.t.npy, ")
            .and(contains("mask-object-order"))
            .and(contains("6 are missing"));
    bothways(&home, &["diff", "out", "other"]).assert().code(1).stdout(said);
    fs::create_dir(home.path().join("empty")).unwrap();
    let refused =
        contains("no file of out (PNG, PNM, BMP, JPEG, EXR or NPY) belongs to one of empty");
    bothways(&home, &["diff", "out", "empty"]).assert().code(2).stdout("").stderr(refused);
}

#[test]
fn distances_beside_a_set_become_t_by_its_scenes() {
    let home = tempfile::tempdir().unwrap();
    bothways(&home, &["vectors", "-o", "vectors"]).assert().code(0);
    let mine = home.path().join("mine");
    fs::create_dir(&mine).unwrap();
    for vector in bothways::vectors::all() {
        let mut bytes =
            fs::read(home.path().join(format!("vectors/{}.t.npy", vector.name))).unwrap();
        let camera = vector.camera();
        let [width, height] = camera.image().map(|side| side as usize);
        let unit = match camera.projection() {
            Projection::Perspective => camera.distance(),
            Projection::Parallel => 1.0,
        };
        let start = bytes.len() - 4 * width * height;
        for number in bytes[start..].chunks_exact_mut(4) {
            let t = f32::from_le_bytes(number.try_into().unwrap());
            #[expect(clippy::cast_possible_truncation, reason = "as a renderer stores it")]
            number.copy_from_slice(&((f64::from(t) * unit) as f32).to_le_bytes());
        }
        fs::write(mine.join(format!("{}.npy", vector.name)), bytes).unwrap();
    }
    let args = ["diff", "mine", "vectors", "--depth", "axis"];
    let said = contains("74 of 74 pairs equal\n");
    bothways(&home, &args).assert().code(0).stdout(said).stderr("");
    let args = ["diff", "mine", "vectors", "--depth", "ray"];
    bothways(&home, &args).assert().code(1).stdout(contains(" differ"));
}
