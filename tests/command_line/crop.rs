//! `--crop`: the output is a part of the output for the whole picture.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::arguments::arguments;
use assert_cmd::Command;
use bothways::common::frame::NO_PRIMITIVE;
use bothways::formats::generate::Kind;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A `bothways` that renders into a folder.
fn bothways(home: &TempDir, line: &str, folder: &str) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).env_remove("RAYON_NUM_THREADS");
    command.args(arguments(line)).args(["--no-times", "--buffers", "npy", "-o", folder]);
    command.assert().code(0)
}

fn report(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("report.json")).unwrap()).unwrap()
}

/// A NumPy array of `u32` or `f32`: its shape, and the bits of its values.
fn array(path: &Path) -> (Vec<u64>, Vec<u32>) {
    let bytes = fs::read(path).unwrap();
    let file = npyz::NpyFile::new(bytes.as_slice()).unwrap();
    let shape = file.shape().to_vec();
    let bits = if path.to_str().unwrap().ends_with(".ids.npy") {
        file.into_vec::<u32>().unwrap()
    } else {
        file.into_vec::<f32>().unwrap().into_iter().map(f32::to_bits).collect()
    };
    (shape, bits)
}

/// The values of an array of the whole image in rows 5 to 15 and columns 30 to 36.
fn part_of((shape, values): &(Vec<u64>, Vec<u32>)) -> Vec<u32> {
    let width = usize::try_from(shape[1]).unwrap();
    let per_pixel = values.len() / (width * usize::try_from(shape[0]).unwrap());
    let rows = (5..16).map(|row| (row * width + 30) * per_pixel);
    rows.flat_map(|start| values[start..start + 7 * per_pixel].to_vec()).collect()
}

#[test]
fn the_files_of_a_crop_are_parts_of_the_files_of_the_whole() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name);
    for (line, samples) in
        [("ties --size 40x32", 1), ("behind --size 40x32 --samples 2 --method textbook", 2)]
    {
        bothways(&home, line, "whole");
        let heading = contains("crop of 7 x 11 pixels at (5, 30) in 40 x 32");
        let match_found = contains("match: both orders cover the same");
        bothways(&home, &format!("{line} --crop 5,30,11,7"), "part")
            .stdout(heading.and(match_found));
        for order in ["object-order", "image-order"] {
            for buffer in ["ids", "t"] {
                let name = format!("{order}.{buffer}.npy");
                let (whole, (shape, part)) =
                    (array(&at("whole").join(&name)), array(&at("part").join(&name)));
                let expected = if samples == 1 { vec![11, 7] } else { vec![11, 7, 2, 2] };
                assert_eq!(shape, expected, "{name}");
                assert_eq!(part, part_of(&whole), "{line}: {name}");
                assert!(buffer == "t" || part.iter().any(|&id| id != NO_PRIMITIVE), "{name}");
            }
            for name in
                [format!("{order}.png"), format!("mask-{order}.png"), format!("{order}.ids.png")]
            {
                let open = |folder: &str| image::open(at(folder).join(&name)).unwrap();
                let expected = open("whole").crop_imm(30, 5, 7, 11);
                assert!(open("part") == expected, "{line}: {name}");
            }
        }
        // The whole difference is enlarged by 512 / 40; that of a crop has the crop's size.
        let open = |name: &str| image::open(at(name)).unwrap();
        let whole = open("whole/difference.png");
        assert_eq!((whole.width(), whole.height()), (12 * 40, 12 * 32));
        let expected = whole.thumbnail_exact(40, 32).crop_imm(30, 5, 7, 11);
        assert!(open("part/difference.png") == expected, "{line}: difference.png");
        assert_eq!(image::image_dimensions(at("part/side-by-side.png")).unwrap(), (1920, 1080));
        let (whole, part) = (report(&at("whole")), report(&at("part")));
        assert_eq!(whole.get("crop"), None);
        assert_eq!((&part["crop"], &part["size"]), (&json!([5, 30, 11, 7]), &json!([40, 32])));
        assert_eq!(part["coverage"]["match"], true);
    }
    // `diff` accepts files of a crop in the same way as other files.
    let mut diff = Command::cargo_bin("bothways").unwrap();
    diff.current_dir(&home).args(["diff", "part/object-order.ids.npy", "part/image-order.ids.npy"]);
    diff.assert().code(0);
}

#[test]
fn one_order_alone_and_a_streamed_mesh_can_be_cropped() {
    let home = tempfile::tempdir().unwrap();
    let teapot = Kind::Teapot.mesh([5, 5]).unwrap();
    let mut file = Vec::new();
    bothways::formats::obj::write(&teapot, &mut file).unwrap();
    fs::write(home.path().join("teapot.obj"), file).unwrap();
    let ids = |folder: &str, order: &str| {
        array(&home.path().join(folder).join(format!("{order}.ids.npy")))
    };
    bothways(&home, "teapot.obj --size 48x40", "whole");
    let expected = part_of(&ids("whole", "object-order"));
    assert!(expected.iter().any(|&id| id != NO_PRIMITIVE));
    bothways(&home, "teapot.obj --size 48x40 --crop 5,30,11,7 --order image", "image");
    assert_eq!(ids("image", "image-order").1, expected);
    let line = "teapot.obj --size 48x40 --crop 5,30,11,7 --order object --stream";
    bothways(&home, line, "stream").stdout(contains("crop of 7 x 11 pixels at (5, 30)"));
    assert_eq!(ids("stream", "object-order"), (vec![11, 7], expected));
    bothways(&home, "teapot.obj --size 48x40 --order object --stream", "streamed");
    let open =
        |folder: &str| image::open(home.path().join(folder).join("object-order.png")).unwrap();
    assert!(open("stream") == open("streamed").crop_imm(30, 5, 7, 11));
}
