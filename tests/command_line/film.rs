//! `bothways film`: its files, its facts and its errors.

use crate::folder::names;
use crate::texts::{bothways, home, printed};
use assert_cmd::Command;
use bothways::wording::grouped;
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// A film of a moment: five frames, and five more for the pause.
const SHORT: [&str; 10] = [
    "film",
    "canonical",
    "--size",
    "16x12",
    "--viewport",
    "1.333,1",
    "--seconds",
    "0.5",
    "--fps",
    "10",
];

fn film(home: &TempDir, more: &[&str]) -> Command {
    let mut command = bothways(home, &SHORT);
    command.args(["--pause", "0.5", "--width", "480"]).args(more);
    command
}

#[test]
fn a_film_says_what_it_is() {
    let home = home();
    let text = printed(film(&home, &["-o", "a.gif"]), 0);
    // The encoder decides about the bytes.
    let bytes = fs::metadata(home.path().join("a.gif")).unwrap().len();
    let text = text.replace(&grouped(bytes), "BYTES");
    insta::assert_snapshot!(text, @r"
    a.gif
    5 frames at 10 a second, 1 s, 480 x 270 pixels, BYTES bytes; 576 steps in object order, 576 in image order
    match: both orders cover the same 119 samples and see the same primitive in each
    ");
    let facts: Value =
        serde_json::from_str(&printed(film(&home, &["-o", "b.gif", "--json"]), 0)).unwrap();
    assert_eq!(facts["bytes"], fs::metadata(home.path().join("b.gif")).unwrap().len());
    assert_eq!((&facts["frames"], &facts["pause_frames"]), (&5.into(), &5.into()));
    assert_eq!(facts["steps"]["object_order"], 3 * 16 * 12);
    let [a, b] = ["a.gif", "b.gif"].map(|name| fs::read(home.path().join(name)).unwrap());
    assert!(a == b, "the same film has the same bytes");
}

#[test]
fn without_a_name_it_is_a_gif_below_out() {
    let home = home();
    film(&home, &["--method", "fast", "--theme", "light"]).assert().code(0);
    assert!(fs::read(home.path().join("out/films/canonical.gif")).unwrap().starts_with(b"GIF89a"));
}

#[test]
fn standard_output_gets_the_gif_alone() {
    let assert = film(&home(), &["-o", "-"]).assert().code(0);
    assert!(assert.get_output().stdout.starts_with(b"GIF89a"));
    assert!(String::from_utf8_lossy(&assert.get_output().stderr).starts_with("standard output\n"));
}

#[test]
fn a_png_shows_the_finished_picture_to_programs_without_animation() {
    let home = home();
    film(&home, &["-o", "film.png"]).assert().code(0);
    film(&home, &["-o", "frames/"]).assert().code(0);
    let [png, last] = ["film.png", "frames/frame-0010.png"]
        .map(|name| image::open(home.path().join(name)).unwrap().into_rgb8());
    assert!(png == last);
}

#[test]
fn a_folder_holds_the_frames_of_one_film() {
    let home = home();
    let folder = home.path().join("frames");
    film(&home, &["-o", "frames"]).assert().code(0);
    assert_eq!(names(&folder).len(), 5 + 5 + 1);
    fs::write(folder.join("mine.txt"), "mine").unwrap();
    let mut shorter = bothways(&home, &SHORT);
    shorter.args(["--pause", "0", "--width", "480", "-o", "frames"]).assert().code(0);
    let frames = (1..=5).map(|number| format!("frame-{number:04}.png"));
    let expected: Vec<String> =
        frames.chain(["frames.txt", "mine.txt"].map(str::to_owned)).collect();
    assert_eq!(names(&folder), expected);
    let size = image::image_dimensions(folder.join("frame-0001.png")).unwrap();
    assert_eq!(size, (480, 270));
}

/// Frames of a hundredth of a second are right where no browser shows them.
#[test]
fn a_folder_may_have_a_hundred_frames_a_second() {
    let home = home();
    let quick = ["film", "canonical", "--size", "8x6", "--viewport", "1.333,1", "--width", "480"];
    let mut command = bothways(&home, &quick);
    command.args(["--seconds", "0.05", "--pause", "0", "--fps", "100", "-o", "quick/"]);
    printed(command, 0);
    let about = fs::read_to_string(home.path().join("quick/frames.txt")).unwrap();
    assert_eq!(about, "5 frames, 100 a second\n");
}

#[test]
fn a_video_needs_a_program() {
    let home = home();
    let mut command = film(&home, &["-o", "film.mp4"]);
    let assert = command.env("PATH", home.path()).assert().code(2).stdout("");
    let stderr = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert_eq!(
        stderr,
        "error: an .mp4 is made by the program ffmpeg, and it is not on the PATH; install it, or write a \
         .gif, a .png or a folder of frames\n"
    );
    assert!(names(home.path()).is_empty());
}

/// Programs in the place of `ffmpeg`: one that keeps what it gets, and one that fails.
#[cfg(unix)]
#[test]
fn a_video_gets_every_frame() {
    use std::os::unix::fs::PermissionsExt;

    let home = home();
    let program = home.path().join("ffmpeg");
    let install = |script: &str| {
        fs::write(&program, format!("#!/bin/sh\n[ \"$1\" = -version ] && exit 0\n{script}\n"))
            .unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    };
    let path = format!("{}:/usr/bin:/bin", home.path().display());
    install("for last in \"$@\"; do :; done; cat > \"$last\"");
    film(&home, &["-o", "film.mp4"]).env("PATH", &path).assert().code(0);
    let bytes = fs::read(home.path().join("film.mp4")).unwrap();
    assert_eq!(bytes.len(), 10 * 480 * 270 * 3);

    install("cat > /dev/null; echo 'no such encoder' >&2; exit 1");
    let assert = film(&home, &["-o", "other.mp4"]).env("PATH", &path).assert().code(2);
    let stderr = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(stderr.starts_with("error: ffmpeg made no video: no such encoder; write"), "{stderr}");
    assert!(!home.path().join("other.mp4").exists());
}
