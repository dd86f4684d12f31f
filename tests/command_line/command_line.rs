//! The command line, for users and for scripts.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// `bothways` in a separate folder.
fn bothways(home: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).env_remove("RAYON_NUM_THREADS").args(args);
    command
}

fn home() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Every file below a folder, with its content.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        if entry.path().is_dir() {
            let inner = files(&entry.path()).into_iter();
            found.insert(format!("{name}/"), Vec::new());
            found.extend(inner.map(|(file, content)| (format!("{name}/{file}"), content)));
        } else {
            found.insert(name, fs::read(entry.path()).unwrap());
        }
    }
    found
}

fn names(folder: &Path) -> Vec<String> {
    files(folder).into_keys().collect()
}

fn report(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("report.json")).unwrap()).unwrap()
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

const PICTURES: [&str; 7] = [
    "difference.png",
    "image-order.png",
    "mask-image-order.png",
    "mask-object-order.png",
    "object-order.png",
    "report.json",
    "side-by-side.png",
];

#[test]
fn without_arguments_the_lecture_s_scene_is_rendered() {
    let home = home();
    let verdict = contains("match: both orders cover the same ");
    bothways(&home, &[]).assert().code(0).stdout(verdict).stderr("");
    assert_eq!(names(&home.path().join("out/lecture")), PICTURES);
}

#[test]
fn render_may_be_left_out() {
    let home = home();
    let short = ["canonical", "--size", "12x8", "--no-times", "-o", "short"];
    let long = ["render", "--size", "12x8", "canonical", "--no-times", "-o", "long"];
    bothways(&home, &short).assert().code(0);
    bothways(&home, &long).assert().code(0);
    assert_eq!(files(&home.path().join("short")), files(&home.path().join("long")));
}

#[test]
fn pictures_have_the_size_of_the_image_and_the_slide_its_own() {
    let home = home();
    bothways(&home, &["canonical", "--size", "13x7", "-o", "."]).assert().code(0);
    let size = |name| image::image_dimensions(home.path().join(name)).unwrap();
    for name in PICTURES.iter().filter(|name| name.ends_with(".png")) {
        let expected = match *name {
            "side-by-side.png" => (1920, 1080),
            // Whole factors, up to 512 pixels.
            "difference.png" => (39 * 13, 39 * 7),
            _ => (13, 7),
        };
        assert_eq!(size(name), expected, "{name}");
    }
    let mask = image::open(home.path().join("mask-image-order.png")).unwrap();
    assert_eq!(mask.color(), image::ColorType::L8);
}

#[test]
fn the_report_has_every_key() {
    let home = home();
    let args = ["canonical", "--size", "12x8", "--samples", "2", "--threads", "2", "--repeat", "3"];
    bothways(&home, &args).args(["-o", "."]).assert().code(0);
    let report = report(home.path());

    let parts = ["coverage", "visible", "depth", "colour", "object_order", "image_order"];
    let mut expected = vec!["scene", "size", "samples", "threads", "primitives"];
    expected.extend(parts);
    expected.sort_unstable();
    assert_eq!(keys(&report), expected);
    assert_eq!(report["size"], serde_json::json!([12, 8]));
    assert_eq!((&report["samples"], &report["threads"]), (&2.into(), &2.into()));

    let coverage = ["both", "image_order", "match", "object_order"];
    let alone = ["only_image_order", "only_object_order"];
    assert_eq!(keys(&report["coverage"]), [&coverage[..], &alone[..]].concat());
    assert_eq!(report["coverage"]["match"], true);
    assert_eq!(keys(&report["visible"]), ["differing_pixels", "first_differing"]);
    assert_eq!(keys(&report["depth"]), ["differing_pixels", "max_relative_difference"]);
    assert_eq!(keys(&report["colour"]), ["differing_pixels", "max_difference"]);
    for order in ["object_order", "image_order"] {
        let order = &report[order];
        let times = ["prepare_ms", "visibility_ms", "shading_ms"];
        let counts_and_times = ["prepare_ms", "shading_ms", "visibility_ms", "work"];
        assert_eq!(keys(order), [&["executed", "method"][..], &counts_and_times].concat());
        assert_eq!(order["method"], "fast");
        for time in times.map(|time| &order[time]) {
            assert_eq!(keys(time), ["max", "median", "min"]);
            let number = |key: &str| time[key].as_f64().unwrap();
            assert!(number("min") <= number("median") && number("median") <= number("max"));
        }
        assert!(order["work"]["tests"].as_u64().unwrap() > 0);
        assert!(order["executed"]["tiles"].as_u64().unwrap() > 0);
    }
    assert!(report["object_order"]["work"]["primitives"].as_u64().unwrap() > 0);
    assert_eq!(report["image_order"]["work"]["rays"], 12 * 8 * 4);
}

#[test]
fn the_report_is_written_in_the_stated_order() {
    let home = home();
    let output = bothways(&home, &["canonical", "--size", "4x4", "--json", "-o", "."]).output();
    let text = String::from_utf8(output.unwrap().stdout).unwrap();
    assert_eq!(text, fs::read_to_string(home.path().join("report.json")).unwrap());
    let keys = ["scene", "size", "samples", "threads", "primitives", "coverage", "visible"];
    let more = ["depth", "colour", "object_order\": {", "image_order\": {"];
    let places = keys.iter().chain(&more).map(|key| text.find(&format!("\n  \"{key}")).unwrap());
    assert!(places.collect::<Vec<_>>().is_sorted());
}

#[test]
fn without_times_every_run_writes_the_same() {
    let home = home();
    let run = |folder: &str, threads: &str| {
        let args = ["canonical", "--size", "40x30", "--no-times", "--buffers", "npy"];
        let mut command = bothways(&home, &args);
        command.args(["--samples", "2", "--threads", threads, "-o", folder]);
        let stdout = command.assert().code(0).get_output().stdout.clone();
        (files(&home.path().join(folder)), String::from_utf8(stdout).unwrap().replace(folder, ""))
    };
    let first = run("first", "2");
    assert_eq!(first, run("second", "2"));

    let (mut one_thread, one_text) = run("third", "1");
    let (mut two_threads, two_text) = first;
    // Only the number of threads differs between the two.
    let report = |files: &mut BTreeMap<String, Vec<u8>>| {
        String::from_utf8(files.remove("report.json").unwrap()).unwrap()
    };
    let (one, two) = (report(&mut one_thread), report(&mut two_threads));
    assert_eq!(one, two.replace("\"threads\": 2", "\"threads\": 1"));
    assert!(one.contains("\"visibility_ms\": null"));
    assert_eq!((one_thread, one_text), (two_threads, two_text));
}

#[test]
fn one_order_alone_writes_its_own_and_has_no_verdict() {
    let home = home();
    let args = ["canonical", "--size", "12x8", "--buffers", "npy", "-o", "."];
    bothways(&home, &args).assert().code(0);
    fs::write(home.path().join("notes.txt"), "mine").unwrap();

    let no_verdict = contains("match").not().and(contains("image order"));
    bothways(&home, &args).args(["--order", "image"]).assert().code(0).stdout(no_verdict);
    let buffers = ["image-order.ids.npy", "image-order.ids.png"];
    let pictures = ["image-order.png", "image-order.t.npy", "mask-image-order.png"];
    let other = ["notes.txt", "report.json"];
    assert_eq!(names(home.path()), [&buffers[..], &pictures, &other].concat());
    let report = report(home.path());
    for key in ["coverage", "visible", "depth", "colour", "object_order"] {
        assert!(report[key].is_null() && report.get(key).is_some(), "{key}");
    }
    assert_eq!(report["image_order"]["work"]["rays"], 96);
}

#[test]
fn both_methods_see_the_same() {
    let home = home();
    for method in ["fast", "textbook"] {
        let args = ["canonical", "--size", "20x20", "--method", method, "--buffers", "npy"];
        bothways(&home, &args).args(["-o", method]).assert().code(0);
        assert_eq!(report(&home.path().join(method))["object_order"]["method"], method);
    }
    for name in ["object-order.ids.npy", "image-order.ids.npy"] {
        let ids = |method: &str| fs::read(home.path().join(method).join(name)).unwrap();
        assert_eq!(ids("fast"), ids("textbook"));
    }
}

#[test]
fn buffers_are_numpy_arrays_of_pixels_and_samples() {
    let home = home();
    for (samples, shape) in [("1", vec![4, 6]), ("3", vec![4, 6, 3, 3])] {
        let args = ["canonical", "--size", "6x4", "--buffers", "npy", "--samples", samples];
        bothways(&home, &args).args(["-o", "."]).assert().code(0);
        let read = |name: &str| fs::read(home.path().join(name)).unwrap();
        for order in ["object-order", "image-order"] {
            let bytes = read(&format!("{order}.ids.npy"));
            let ids = npyz::NpyFile::new(&bytes[..]).unwrap();
            assert_eq!((ids.shape(), ids.order()), (&shape[..], npyz::Order::C));
            let ids: Vec<u32> = ids.into_vec().unwrap();
            let bytes = read(&format!("{order}.t.npy"));
            let t = npyz::NpyFile::new(&bytes[..]).unwrap();
            assert_eq!(t.shape(), &shape[..]);
            let t: Vec<f32> = t.into_vec().unwrap();
            assert!(ids.iter().zip(&t).all(|(id, t)| (*id == u32::MAX) == t.is_infinite()));

            // A pixel of the mask counts the samples that are adjacent in the array.
            let mask = image::open(home.path().join(format!("mask-{order}.png"))).unwrap();
            let per_pixel = ids.len() / 24;
            for (pixel, samples) in mask.to_luma8().iter().zip(ids.chunks(per_pixel)) {
                let covered = samples.iter().filter(|&&id| id != u32::MAX).count();
                assert_eq!((*pixel == 0, *pixel == 255), (covered == 0, covered == per_pixel));
            }
        }
    }
}

#[test]
fn quiet_says_nothing() {
    let home = home();
    let args = ["canonical", "--size", "4x4", "--quiet"];
    bothways(&home, &args).assert().code(0).stdout("").stderr("");
    assert_eq!(names(&home.path().join("out/canonical")), PICTURES);
}

#[test]
fn what_is_printed_to_a_pipe_is_plain() {
    let home = home();
    let plain = contains("\u{1b}").not();
    bothways(&home, &["canonical", "--size", "4x4"]).assert().code(0).stdout(plain);
    let plain = contains("\u{1b}").not();
    bothways(&home, &["no-such-scene"]).env("NO_COLOR", "1").assert().code(2).stderr(plain);
}

#[test]
fn the_camera_can_be_changed() {
    let home = home();
    let ids = |folder: &str, args: &[&str]| {
        let fixed = ["canonical", "--size", "32x32", "--buffers", "npy", "--quiet", "-o", folder];
        bothways(&home, &fixed).args(args).assert().code(0);
        fs::read(home.path().join(folder).join("object-order.ids.npy")).unwrap()
    };
    let plain = ids("plain", &[]);
    let changes: [&[&str]; 7] = [
        &["--projection", "parallel"],
        &["--eye", "-0.5,0.25,1"],
        &["--look-at", "1,-1,-4"],
        &["--up", "1,1,0"],
        &["--distance", "3"],
        &["--viewport", "0.5,0.5"],
        &["--eye=0,0,2", "--look-at=0,0,-3", "--up=0,-1,0", "--projection=parallel"],
    ];
    for change in changes {
        assert_ne!(ids("changed", change), plain, "{change:?}");
    }
    assert_eq!(ids("changed", &["--projection", "perspective"]), plain);
}

/// Runs a command that must fail; it must report the error on stderr, and change no file.
fn check_refused(home: &TempDir, args: &[&str], message: &str) {
    let before = files(home.path());
    let said = contains(message).and(contains("panicked").not());
    bothways(home, args).assert().code(2).stdout("").stderr(said);
    assert_eq!(files(home.path()), before, "{args:?} touched the folder");
}

#[test]
fn bad_input_is_named_and_leaves_earlier_outputs_untouched() {
    let home = home();
    bothways(&home, &["canonical", "--size", "8x8", "--quiet"]).assert().code(0);
    fs::write(home.path().join("typo.toml"), "[camera]\neyes = [0, 0, 0]\n").unwrap();
    fs::write(home.path().join("file"), "no folder").unwrap();

    // The other messages are in `bad_input`.
    check_refused(&home, &["typo.toml"], "eyes");
    check_refused(&home, &["canonical", "--samples", "4000000000"], "at most 65536 samples");
    check_refused(&home, &["canonical", "--distance", "0"], "the distance is 0");
    check_refused(&home, &["canonical", "-o", "file"], "cannot write into the folder file");
}

#[test]
fn an_error_in_a_scene_file_shows_its_place() {
    let home = home();
    fs::write(home.path().join("typo.toml"), "[camera]\neyes = [0, 0, 0]\n").unwrap();
    let shown = contains("typo.toml").and(contains("2 │ eyes = [0, 0, 0]"));
    bothways(&home, &["typo.toml"]).assert().code(2).stderr(shown);
    assert_eq!(names(home.path()), ["typo.toml"]);
}

#[test]
fn a_folder_in_the_place_of_a_file_is_left_alone() {
    let home = home();
    fs::create_dir(home.path().join("report.json")).unwrap();
    fs::write(home.path().join("object-order.png"), "old").unwrap();
    check_refused(&home, &["canonical", "-o", "."], "report.json is a folder");
}

#[test]
fn scenes_are_listed_and_printed() {
    let home = home();
    let list = contains("canonical ").and(contains("lecture "));
    bothways(&home, &["scenes"]).assert().code(0).stdout(list);
    bothways(&home, &["scenes", "canonical"]).assert().code(0).stdout(contains("#"));
    bothways(&home, &["scenes", "no-such-scene"]).assert().code(2).stdout("");
    assert!(names(home.path()).is_empty());
}

#[test]
fn help_and_completions_are_printed() {
    let home = home();
    let examples = contains("Examples:").and(contains("--projection")).and(contains("Exit codes"));
    bothways(&home, &["--help"]).assert().code(0).stdout(examples);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        bothways(&home, &["completions", shell]).assert().code(0).stdout(contains("bothways"));
    }
}

#[test]
fn help_is_a_command_too() {
    let home = home();
    let all = contains("Examples:").and(contains("--projection")).and(contains("Exit codes"));
    bothways(&home, &["help"]).assert().code(0).stdout(all).stderr("");
    let pixel = contains("bothways pixel ties 8 8");
    bothways(&home, &["help", "pixel"]).assert().code(0).stdout(pixel).stderr("");
}

#[test]
fn a_mistyped_command_gets_a_suggestion() {
    let home = home();
    let said: [(&[&str], &str); 6] = [
        (&["pixle", "ties", "3", "4"], "did you mean 'bothways pixel ties 3 4'?"),
        (&["vectros"], "did you mean the command 'bothways vectors'?"),
        (&["--size", "4x4", "vectros"], "did you mean the command 'bothways vectors'?"),
        (&["hlep"], "did you mean the command 'bothways help'?"),
        (&["canonical", "extra"], "'extra' is a word too many: one scene is rendered at a time"),
        (&["lectrue"], "did you mean \"lecture\"?"),
    ];
    for (args, message) in said {
        check_refused(&home, args, message);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_fails_and_a_closed_pipe_does_not() {
    use std::process::Stdio;
    let home = home();
    let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("bothways"));
    command.current_dir(&home).args(["canonical", "--size", "4x4"]).stderr(Stdio::piped());

    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    assert_eq!(command.stdout(writer).output().unwrap().status.code(), Some(0));

    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = command.stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot print"));
}
