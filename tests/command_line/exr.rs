//! `render --buffers exr`: one file with the layers of both orders, read back by the library that others use.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::arguments::arguments;
use assert_cmd::Command;
use bothways::common::frame::NO_PRIMITIVE;
use exr::prelude::*;
use predicates::prelude::*;
use predicates::str::contains;
use std::collections::BTreeMap;
use std::fs;
use tempfile::TempDir;

/// The channels of one order.
const CHANNELS: [&str; 14] = [
    "B",
    "G",
    "R",
    "coverage",
    "depth.Z",
    "id",
    "id_color.B",
    "id_color.G",
    "id_color.R",
    "normal.X",
    "normal.Y",
    "normal.Z",
    "t",
    "work",
];

fn bothways(home: &TempDir, line: &str) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).env_remove("RAYON_NUM_THREADS").args(arguments(line));
    command
}

/// A file that was read: its windows, and its channels by name.
struct Read {
    display: [usize; 2],
    /// Column, row, width and height.
    data: [usize; 4],
    channels: BTreeMap<String, FlatSamples>,
}

impl Read {
    fn of(home: &TempDir, folder: &str) -> Read {
        let path = home.path().join(folder).join("buffers.exr");
        let image = read_first_flat_layer_from_file(path).unwrap();
        let layer = image.layer_data;
        assert_eq!(layer.encoding.compression, Compression::ZIP16);
        let Vec2(width, height) = layer.size;
        let Vec2(column, row) = layer.attributes.layer_position.to_usize("position").unwrap();
        let channels = layer.channel_data.list.into_iter();
        let channels = channels.map(|one| (one.name.to_string(), one.sample_data)).collect();
        let Vec2(across, down) = image.attributes.display_window.size;
        Read { display: [across, down], data: [column, row, width, height], channels }
    }

    fn floats(&self, name: &str) -> &[f32] {
        let FlatSamples::F32(values) = &self.channels[name] else { panic!("{name} is not f32") };
        values
    }

    fn ids(&self, name: &str) -> &[u32] {
        let FlatSamples::U32(values) = &self.channels[name] else { panic!("{name} is not u32") };
        values
    }

    /// The bits of all channels in a part of the picture, given by column, row, width and height.
    fn part(&self, [column, row, width, height]: [usize; 4]) -> BTreeMap<&str, Vec<u32>> {
        let bits = |values: &FlatSamples| -> Vec<u32> {
            let all: Vec<u32> = match values {
                FlatSamples::U32(values) => values.clone(),
                FlatSamples::F32(values) => values.iter().map(|value| value.to_bits()).collect(),
                FlatSamples::F16(_) => panic!("a half holds too little"),
            };
            let rows = (row..row + height).map(|row| row * self.data[2] + column);
            rows.flat_map(|start| all[start..start + width].to_vec()).collect()
        };
        self.channels.iter().map(|(name, values)| (name.as_str(), bits(values))).collect()
    }
}

/// A NumPy array's values, sample by sample in the order of the picture's rows.
fn array<T: npyz::Deserialize>(home: &TempDir, path: &str) -> Vec<T> {
    let bytes = fs::read(home.path().join(path)).unwrap();
    npyz::NpyFile::new(bytes.as_slice()).unwrap().into_vec().unwrap()
}

#[test]
fn an_exr_holds_what_the_arrays_hold_and_more() {
    let home = tempfile::tempdir().unwrap();
    for (scene, is_parallel) in [("canonical", false), ("parallel", true)] {
        bothways(&home, &format!("{scene} --size 24x16 --buffers npy -o npy")).assert().code(0);
        bothways(&home, &format!("{scene} --size 24x16 --buffers exr -o exr")).assert().code(0);
        let read = Read::of(&home, "exr");
        assert_eq!((read.display, read.data), ([24, 16], [0, 0, 24, 16]));
        let names: Vec<&str> = read.channels.keys().map(String::as_str).collect();
        let of = |layer: &str| CHANNELS.map(|name| format!("{layer}.{name}"));
        assert_eq!(names, [of("image"), of("object")].concat());
        for (layer, stem) in [("object", "object-order"), ("image", "image-order")] {
            let ids = read.ids(&format!("{layer}.id"));
            assert_eq!(ids, array::<u32>(&home, &format!("npy/{stem}.ids.npy")));
            let t = read.floats(&format!("{layer}.t"));
            assert_eq!(t, array::<f32>(&home, &format!("npy/{stem}.t.npy")));
            // The viewing rays of a parallel camera have length 1; the canonical camera has d = 1.
            assert_eq!(read.floats(&format!("{layer}.depth.Z")), t, "{is_parallel}");
            let coverage = read.floats(&format!("{layer}.coverage"));
            let normal = ["X", "Y", "Z"].map(|axis| read.floats(&format!("{layer}.normal.{axis}")));
            for (at, &id) in ids.iter().enumerate() {
                let seen = id != NO_PRIMITIVE;
                assert_eq!(coverage[at], if seen { 1.0 } else { 0.0 });
                assert_eq!(t[at].is_finite(), seen);
                let length = normal.iter().map(|part| part[at] * part[at]).sum::<f32>();
                assert!((length - if seen { 1.0 } else { 0.0 }).abs() < 1e-5);
            }
            assert!(read.floats(&format!("{layer}.work")).iter().sum::<f32>() > 0.0);
            let color = read.floats(&format!("{layer}.id_color.R"));
            assert!(color.iter().all(|part| (0.0..=1.0).contains(part)));
        }
    }
}

#[test]
fn depth_is_measured_along_the_axis() {
    let home = tempfile::tempdir().unwrap();
    bothways(&home, "canonical --size 12x8 --distance 2 --buffers exr -o .").assert().code(0);
    let read = Read::of(&home, ".");
    let (depth, t) = (read.floats("image.depth.Z"), read.floats("image.t"));
    assert!(depth.iter().zip(t).all(|(depth, t)| *depth == 2.0 * t));
    assert!(t.iter().any(|t| t.is_finite()));
}

#[test]
fn samples_are_pixels_and_a_crop_is_a_part_of_the_display_window() {
    let home = tempfile::tempdir().unwrap();
    let line = "behind --size 20x12 --samples 2 --no-times --buffers exr";
    bothways(&home, &format!("{line} -o whole")).assert().code(0);
    bothways(&home, &format!("{line} --crop 3,5,6,7 -o part")).assert().code(0);
    let (whole, part) = (Read::of(&home, "whole"), Read::of(&home, "part"));
    assert_eq!((whole.display, whole.data), ([40, 24], [0, 0, 40, 24]));
    assert_eq!((part.display, part.data), ([40, 24], [10, 6, 14, 12]));
    assert_eq!(part.part([0, 0, 14, 12]), whole.part([10, 6, 14, 12]));
}

#[test]
fn an_exr_says_only_what_is_known() {
    let home = tempfile::tempdir().unwrap();
    let names = |line: &str| -> Vec<String> {
        bothways(&home, &format!("{line} --size 12x8 --buffers exr -o .")).assert().code(0);
        Read::of(&home, ".").channels.into_keys().collect()
    };
    let object = CHANNELS.map(|name| format!("object.{name}"));
    assert_eq!(names("canonical --order object"), object);
    assert_eq!(names("canonical --order object --no-counts"), object[..13]);
    assert_eq!(names("ties --order object --object-rules inclusive"), object[..13]);
    let textbook = names("canonical --method textbook");
    assert!(textbook.contains(&"image.work".to_owned()));
    let read = Read::of(&home, ".");
    let work = read.floats("image.work");
    assert!(work.iter().all(|tests| *tests == work[0]));

    bothways(&home, "mesh torus -o torus.obj").assert().code(0);
    assert_eq!(names("torus.obj --order object --stream"), object[..13]);
    let read = Read::of(&home, ".");
    assert!(read.floats("object.normal.Z").iter().any(|part| *part > 0.9));
}

#[test]
fn diff_reads_the_layers_by_their_channels() {
    let home = tempfile::tempdir().unwrap();
    bothways(&home, "ties --object-rules inclusive --size 40x32 --buffers npy -o npy")
        .assert()
        .code(1);
    bothways(&home, "ties --size 40x32 --buffers exr -o .").assert().code(0);
    let asked = contains("choose what to read of it with --channels NAME[,NAME...]; its channels");
    bothways(&home, "diff buffers.exr buffers.exr").assert().code(2).stderr(asked);
    let pair = |names: &str| format!("diff buffers.exr buffers.exr {names}");
    for (names, said) in [
        ("--channels object.id --channels image.id", "equal in everything compared: coverage, ids"),
        ("--channels object.t --channels image.depth.Z", "A  buffers.exr: distances t"),
        (
            "--channels object.normal.X,object.normal.Y,object.normal.Z \
             --channels image.normal.X,image.normal.Y,image.normal.Z",
            "A  buffers.exr: normals",
        ),
        ("--channels object.R,object.G,object.B --channels image.R,image.G,image.B", "colo"),
        ("--channels object.coverage --channels image.coverage", "A  buffers.exr: mask"),
    ] {
        bothways(&home, &pair(names)).assert().code(0).stdout(contains(said));
    }
    let line = "diff npy/object-order.ids.npy buffers.exr --channels image.id";
    bothways(&home, line).assert().code(1).stdout(contains("B  buffers.exr: ids"));
    bothways(&home, "ties --size 40x32 --crop 5,30,11,7 --buffers exr -o part").assert().code(0);
    let said = contains("its crop at (5, 30) of 40 x 32");
    let line = "diff part/buffers.exr part/buffers.exr --channels object.id --channels image.id";
    bothways(&home, line).assert().code(0).stdout(said);
}

#[test]
fn the_next_run_removes_the_file_and_every_run_writes_the_same() {
    let home = tempfile::tempdir().unwrap();
    let line = "canonical --size 24x16 --no-times";
    let run = |threads: u32| {
        let line = format!("{line} --threads {threads} --buffers exr -o .");
        bothways(&home, &line).assert().code(0);
        fs::read(home.path().join("buffers.exr")).unwrap()
    };
    assert!(run(1) == run(2), "threads change the bytes");
    bothways(&home, &format!("{line} --buffers npy -o .")).assert().code(0);
    assert!(!home.path().join("buffers.exr").exists());
    assert!(home.path().join("image-order.t.npy").exists());
    run(1);
    assert!(!home.path().join("image-order.t.npy").exists());
    let refused = contains("invalid value 'tiff' for '--buffers").and(contains("exr"));
    bothways(&home, "canonical --buffers tiff").assert().code(2).stderr(refused);
}
