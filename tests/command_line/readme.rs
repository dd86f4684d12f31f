//! Every command in the README works: it runs, and ends without an error. And the picture in the README is the
//! present output of the program, including the counts.
//!
//! After a change that moves pixels or counts, look at the new picture, and put it into `docs/`:
//!
//! ```sh
//! BOTHWAYS_WRITE_GOLDEN=1 cargo test --test command_line readme
//! ```

use crate::arguments::arguments;
use assert_cmd::Command;
use bothways::diff::foreign;
use std::fs;
use std::path::Path;

#[test]
fn every_command_of_the_readme_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = std::fs::read_to_string(root.join("README.md")).unwrap();
    let shell = readme.split("```sh").skip(1).filter_map(|block| block.split("```").next());
    let lines = shell.flat_map(str::lines).filter(|line| line.starts_with("cargo run --release"));
    // A separate folder, below a folder that may contain `../shared`.
    let outside = tempfile::tempdir().unwrap();
    let inside = outside.path().join("clone");
    std::fs::create_dir_all(inside.join("out")).unwrap();
    let shared = root.join("../shared");
    let mut commands = 0;
    for line in lines {
        let rest = line.trim_start_matches("cargo run --release").trim_start();
        // The lecture page is built by a program of its own, which `.ci/web` runs.
        if rest.starts_with("-p ") {
            continue;
        }
        let mut arguments = arguments(rest.strip_prefix("--").unwrap_or(rest));
        if rest.starts_with("--") && rest.get(2..3).is_some_and(|next| next != " ") {
            continue;
        }
        if arguments.iter().any(|argument| argument.starts_with("../shared")) && !shared.exists() {
            println!("skipped, ../shared is absent: {line}");
            continue;
        }
        for argument in &mut arguments {
            if let Some(file) = argument.strip_prefix("../shared") {
                *argument = format!("{}{file}", shared.display());
            }
        }
        // Films and slides take long where nothing is optimised: here they show a small scene, and `.ci/run` runs the
        // README's own lines in a release build.
        let command = arguments.first().cloned().unwrap_or_default();
        let quicker: &[&str] = match command.as_str() {
            "film" => &["--size", "16x12"],
            "slides" => &["--no-films"],
            _ => &[],
        };
        if !quicker.is_empty() {
            for argument in arguments.iter_mut().filter(|argument| *argument == "lecture") {
                *argument = "canonical".into();
            }
            arguments.extend(quicker.iter().map(|word| (*word).to_owned()));
        }
        let mut command = Command::cargo_bin("bothways").unwrap();
        command.args(&arguments).current_dir(&inside).assert().success();
        commands += 1;
    }
    assert!(commands >= 10, "{commands} commands found");
    let vectors = format!("writes {} small scenes", bothways::vectors::all().len());
    assert!(readme.contains(&vectors), "not in the README: {vectors}");
}

#[test]
fn the_readme_s_picture_shows_what_the_program_counts() {
    let published = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/side-by-side.png");
    let home = tempfile::tempdir().unwrap();
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.args(["--no-times", "--quiet", "-o", "."]).current_dir(&home).assert().success();
    let drawn = home.path().join("side-by-side.png");
    if std::env::var_os("BOTHWAYS_WRITE_GOLDEN").is_some() {
        fs::copy(drawn, published).unwrap();
        return;
    }
    // A wrong figure changes hundreds of pixels by far more than the tolerance for colours. Differences in the
    // rounding of text are within the tolerance.
    let read = |path: &Path| foreign::read(path, None).unwrap();
    let comparison = foreign::compare(&read(&published), &read(&drawn)).unwrap();
    if !comparison.equal {
        let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("readme-side-by-side.png");
        fs::copy(drawn, &kept).unwrap();
        panic!(
            "{} pixels of docs/side-by-side.png are not what the program draws, which is in {}; if it is right, \
             BOTHWAYS_WRITE_GOLDEN=1 cargo test --test command_line readme takes it over",
            comparison.differing_pixels,
            kept.display()
        );
    }
}
