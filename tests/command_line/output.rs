//! The files on the disk after a run: `-o FILE` and `-o DIR`, also if runs stop early or overlap.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::folder::names;
use assert_cmd::Command;
use bothways::common::Mesh;
use bothways::formats::generate::Kind;
use bothways::formats::{obj, ply};
use predicates::str::contains;
use std::fs::{self, File};
use std::io::Read;
use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::Duration;
use std::{process, thread};
use tempfile::TempDir;

fn home() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// `bothways` in a separate folder.
fn bothways(home: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).args(args);
    command
}

fn started(home: &TempDir, args: &[&str]) -> Child {
    let mut command = process::Command::new(assert_cmd::cargo::cargo_bin("bothways"));
    command.current_dir(home).args(args).stdin(Stdio::null());
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// A sphere from the program, and its OBJ file.
fn ball() -> (Mesh, Vec<u8>) {
    let mesh = Kind::Sphere.mesh(Kind::Sphere.default_divisions()).unwrap();
    let mut text = Vec::new();
    obj::write(&mesh, &mut text).unwrap();
    (mesh, text)
}

/// A named pipe, and the text read from it.
fn fifo(home: &TempDir, name: &str) -> thread::JoinHandle<Vec<u8>> {
    let path = home.path().join(name);
    assert!(process::Command::new("mkfifo").arg(&path).status().unwrap().success());
    thread::spawn(move || {
        let mut read = Vec::new();
        File::open(path).unwrap().read_to_end(&mut read).unwrap();
        read
    })
}

#[test]
fn a_link_is_followed_and_stays_a_link() {
    let (home, (_, text)) = (home(), ball());
    let path = |name: &str| home.path().join(name);
    fs::create_dir(path("there")).unwrap();
    fs::write(path("there/old.obj"), "old").unwrap();
    fs::set_permissions(path("there/old.obj"), fs::Permissions::from_mode(0o640)).unwrap();
    symlink("there/old.obj", path("old.obj")).unwrap();
    symlink("old.obj", path("far.obj")).unwrap();
    symlink("there/new/ball.obj", path("new.obj")).unwrap();
    for (name, file) in [("far.obj", "there/old.obj"), ("new.obj", "there/new/ball.obj")] {
        bothways(&home, &["mesh", "sphere", "-o", name]).assert().code(0);
        assert!(path(name).is_symlink());
        assert!(!path(file).is_symlink() && fs::read(path(file)).unwrap() == text);
    }
    assert_eq!(names(home.path()), ["far.obj", "new.obj", "old.obj", "there"]);
    assert_eq!(names(&path("there")), ["new", "old.obj"]);
    // A user without permission to read the old file has no permission to read the new file.
    assert_eq!(fs::metadata(path("there/old.obj")).unwrap().permissions().mode() & 0o777, 0o640);

    symlink("round.obj", path("round.obj")).unwrap();
    bothways(&home, &["mesh", "sphere", "-o", "round.obj"])
        .assert()
        .code(2)
        .stderr(contains("cannot write round.obj: "));
}

#[test]
fn a_pipe_and_a_device_are_written_to_and_stay() {
    let (home, (mesh, text)) = (home(), ball());
    let path = |name: &str| home.path().join(name);
    let read = fifo(&home, "pipe");
    bothways(&home, &["mesh", "sphere", "-o", "pipe"]).assert().code(0);
    assert!(read.join().unwrap() == text);
    let read = fifo(&home, "pipe.ply");
    symlink("pipe.ply", path("link")).unwrap();
    bothways(&home, &["mesh", "sphere", "-o", "pipe.ply"]).assert().code(0);
    let written = ply::parse("pipe.ply", &read.join().unwrap()).unwrap();
    assert_eq!(written.triangles(), mesh.triangles());
    let read = fifo(&home, "mask");
    bothways(&home, &["cover", "0,0 3,0 0,3", "--size", "4x4", "-o", "mask"]).assert().code(0);
    assert_eq!(image::load_from_memory(&read.join().unwrap()).unwrap().width(), 4);
    for name in ["pipe", "pipe.ply", "mask"] {
        assert!(fs::symlink_metadata(path(name)).unwrap().file_type().is_fifo(), "{name}");
    }

    // The same as /dev/stdout: a link to a device.
    symlink("/dev/null", path("null.obj")).unwrap();
    bothways(&home, &["mesh", "sphere", "-o", "null.obj"]).assert().code(0);
    assert!(path("null.obj").is_symlink());
    assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
    assert_eq!(names(home.path()), ["link", "mask", "null.obj", "pipe", "pipe.ply"]);
}

#[test]
fn a_minus_is_standard_output_whatever_that_is() {
    let (home, (_, text)) = (home(), ball());
    let own = home.path().join("stdout");
    // A separate link, so that the link of the system is safe.
    symlink("/dev/fd/1", &own).unwrap();
    for name in ["-", own.to_str().unwrap()] {
        let piped = bothways(&home, &["mesh", "sphere", "-o", name]).output().unwrap();
        assert!(piped.status.success() && piped.stdout == text, "{name}");
        let to_file = File::create(home.path().join("out.obj")).unwrap();
        let mut command = process::Command::new(assert_cmd::cargo::cargo_bin("bothways"));
        command.args(["mesh", "sphere", "-o", name]).stdout(to_file);
        let status = command.current_dir(&home).stderr(Stdio::null()).status().unwrap();
        assert!(status.success() && fs::read(home.path().join("out.obj")).unwrap() == text);
        assert!(own.is_symlink());
    }
    let mask = ["cover", "0,0 3,0 0,3", "--size", "4x4", "-o", "-"];
    let output = bothways(&home, &mask).output().unwrap();
    assert_eq!(image::load_from_memory(&output.stdout).unwrap().width(), 4);
    assert!(String::from_utf8(output.stderr).unwrap().contains("3 pixels covered"));
    assert_eq!(names(home.path()), ["out.obj", "stdout"]);
}

#[test]
fn the_ending_says_the_format_and_missing_folders_are_made() {
    let (home, (mesh, _)) = (home(), ball());
    let path = |name: &str| home.path().join(name);
    bothways(&home, &["mesh", "sphere", "-o", "a/b/ball.PLY"]).assert().code(0);
    let bytes = fs::read(path("a/b/ball.PLY")).unwrap();
    assert!(bytes.starts_with(b"ply\n"));
    let read = ply::read(&path("a/b/ball.PLY")).unwrap();
    assert_eq!((read.positions(), read.triangles()), (mesh.positions(), mesh.triangles()));
    bothways(&home, &["a/b/ball.PLY", "--size", "8x8"]).assert().code(0);
    let mask = ["cover", "0,0 3,0 0,3", "--size", "4x4", "-o", "c/d/mask.png"];
    bothways(&home, &mask).assert().code(0);
    assert_eq!(names(&path("c/d")), ["mask.png"]);
}

#[test]
fn a_full_device_is_named_with_what_to_do() {
    let home = home();
    let full = "cannot write /dev/full: no space is left on the device; free some, or choose \
                another file with -o\n";
    if !Path::new("/dev/full").exists() {
        println!("skipped, /dev/full is absent");
        return;
    }
    let mask = ["cover", "0,0 3,0 0,3", "--size", "4x4", "-o", "/dev/full"];
    for args in [&["mesh", "sphere", "-o", "/dev/full"][..], &mask] {
        bothways(&home, args).assert().code(2).stdout("").stderr(format!("error: {full}"));
        assert!(fs::metadata("/dev/full").unwrap().file_type().is_char_device());
    }
    for args in [
        &["scenes"][..],
        &["canonical", "--size", "4x4"],
        &["mesh", "box", "-o", "-"],
        &["--help"],
        &["diff", "-h"],
        &["help", "diff"],
        &["--version"],
    ] {
        let mut command = process::Command::new(assert_cmd::cargo::cargo_bin("bothways"));
        command.current_dir(&home).args(args).stdout(File::create("/dev/full").unwrap());
        let output = command.output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr.contains("no space is left on the device; free some, or "), "{stderr}");
    }
}

#[test]
fn a_file_that_may_not_grow_is_named_with_what_to_do() {
    let home = home();
    let program = assert_cmd::cargo::cargo_bin("bothways");
    // Half-kibibytes, or kibibytes: less than a slide takes, in any shell, and more than all else.
    let script = "trap '' XFSZ; ulimit -f 40; exec \"$0\" canonical --size 8x8 -o there";
    let mut command = process::Command::new("sh");
    let output = command.current_dir(&home).args(["-c", script]).arg(program).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    let said = "cannot write there/side-by-side.png: files may not become so large; raise the \
                limit, or choose another folder with -o\n";
    assert_eq!((output.status.code(), stderr), (Some(2), format!("error: {said}")));
    assert!(names(home.path()).is_empty());
}

/// The size in the report of a folder, if there is a report; then all files must belong to the same run.
fn whole_run(folder: &Path) -> Option<u64> {
    let report = fs::read(folder.join("report.json")).ok()?;
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    let pictures = [
        "object-order.png",
        "image-order.png",
        "mask-object-order.png",
        "mask-image-order.png",
        "difference.png",
    ];
    let width = report["size"][0].as_u64().unwrap();
    for name in pictures {
        let size = image::image_dimensions(folder.join(name));
        // A tiny difference is enlarged by a whole factor within 512 pixels.
        let expected = if name == "difference.png" { 512 / width * width } else { width };
        assert_eq!(u64::from(size.unwrap().0), expected, "{name} is of another run");
    }
    assert!(folder.join("side-by-side.png").exists());
    Some(width)
}

#[test]
fn runs_that_meet_in_a_folder_leave_the_files_of_one() {
    let home = home();
    let folder = home.path().join("out");
    for round in 0..6 {
        if round % 2 == 0 {
            // A new folder, and an existing folder.
            let _ = fs::remove_dir_all(&folder);
        }
        let runs = ["4x4", "5x4", "6x4", "7x4"].map(|size| {
            started(&home, &["canonical", "--size", size, "--quiet", "--threads", "1", "-o", "out"])
        });
        for mut run in runs {
            assert!(run.wait().unwrap().success());
        }
        assert!((4..=7).contains(&whole_run(&folder).unwrap()));
        assert_eq!(names(&folder).len(), 7);
        assert_eq!(names(home.path()), ["out"]);
    }
}

#[test]
fn a_killed_run_leaves_no_report_beside_other_pictures_and_is_cleaned_up_after() {
    let home = home();
    let folder = home.path().join("out");
    let run = |size: &'static str| {
        started(&home, &["canonical", "--size", size, "--quiet", "--threads", "1", "-o", "out"])
    };
    let begun = std::time::Instant::now();
    assert!(run("4x4").wait().unwrap().success());
    let usual = begun.elapsed();
    for round in 0..40_u32 {
        let mut child = run(if round % 2 == 0 { "5x4" } else { "6x4" });
        // Around the end, where files are moved.
        thread::sleep(usual * (20 + round % 40) / 40);
        child.kill().unwrap();
        child.wait().unwrap();
        whole_run(&folder);
    }
    let dead = || names(&folder).into_iter().filter(|name| name.starts_with(".bothways-")).count();
    // A run that is certainly killed before it can clean up.
    let mut child = started(&home, &["many", "--method", "textbook", "--quiet", "-o", "out"]);
    while dead() == 0 {
        thread::sleep(Duration::from_millis(5));
    }
    thread::sleep(Duration::from_millis(100));
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(dead() >= 1);
    assert!(run("7x4").wait().unwrap().success());
    // The folder of a run that was killed before its lock is removed later.
    let left = names(&folder).into_iter().filter(|name| !folder.join(name).is_dir());
    assert_eq!((whole_run(&folder), left.count()), (Some(7), 7));
    for name in names(&folder) {
        assert!(!folder.join(&name).join("lock").exists(), "{name} is dead");
    }
}

#[test]
fn a_scene_file_of_dots_stays_below_the_out_folder() {
    let home = home();
    let scene =
        "[camera]\nimage = [4, 4]\n[[object]]\nsphere = { center = [0, 0, -3], radius = 1 }\n";
    fs::create_dir(home.path().join("in")).unwrap();
    for name in ["...toml", "..toml", "....toml"] {
        fs::write(home.path().join("in").join(name), scene).unwrap();
        let path = format!("in/{name}");
        bothways(&home, &[path.as_str(), "--quiet"]).assert().code(0);
        assert_eq!(names(home.path()), ["in", "out"], "{name}");
        let inside = names(&home.path().join("out"));
        assert_eq!(inside.len(), 1, "{name}: {inside:?}");
        assert!(home.path().join("out").join(&inside[0]).join("report.json").exists());
        fs::remove_dir_all(home.path().join("out")).unwrap();
    }
}

#[test]
fn only_the_wanted_files_are_written() {
    let home = home();
    let render = |more: &[&str]| {
        let args = [&["canonical", "--size", "8x6", "--no-times", "-o", "out"], more].concat();
        let output = bothways(&home, &args).assert().success().get_output().stdout.clone();
        (names(&home.path().join("out")), String::from_utf8(output).unwrap())
    };
    let (all, table) = render(&[]);
    assert_eq!(all.len(), 7);
    assert!(table.contains("work of the algorithm"));
    // The files of the earlier run go, too.
    let (pictures, table) = render(&["--only", "picture"]);
    assert_eq!(pictures, ["image-order.png", "object-order.png"]);
    assert!(!table.contains("work of the algorithm") && table.contains("match"), "{table}");
    let masks = ["mask-image-order.png", "mask-object-order.png"];
    assert_eq!(render(&["--only", "mask,report"]).0, [&masks[..], &["report.json"]].concat());
    let (slide, table) = render(&["--only", "slide", "--only", "difference"]);
    assert_eq!(slide, ["difference.png", "side-by-side.png"]);
    assert!(table.contains("work of the algorithm"));
    let (ids, _) = render(&["--only", "mask", "--order", "image", "--buffers", "npy"]);
    assert_eq!(ids.len(), 4, "{ids:?}");
    let (_, json) = render(&["--only", "picture", "--json"]);
    assert!(json.contains("depth_tests"), "{json}");
}
