//! Errors on the command line: the message about every bad value of every option.
//!
//! A message names the value and the remedy, so that a reader can act on it.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod camera;
mod others;
mod render;
mod two_files;

use crate::arguments::arguments;
use crate::folder::names;
use crate::texts::COMMANDS;
use assert_cmd::Command;
use std::collections::BTreeSet;
use std::fs;
use tempfile::TempDir;

/// The tested command lines, and the beginnings of the messages.
fn refused() -> impl Iterator<Item = (String, &'static str)> {
    let of_camera = camera::COMMANDS.iter().flat_map(|command| {
        camera::REFUSED.iter().map(move |(flags, message)| (format!("{command} {flags}"), *message))
    });
    let of_limits = COMMANDS.iter().map(|command| {
        let message =
            "invalid value '2X' for '--max-memory <SIZE>': write a whole number with K, M, G or T";
        (format!("{command} --max-memory 2X"), message)
    });
    let others = render::REFUSED.iter().chain(two_files::REFUSED).chain(others::REFUSED);
    others.map(|(line, message)| ((*line).to_owned(), *message)).chain(of_camera).chain(of_limits)
}

fn bothways(home: &TempDir, args: &[String]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).env_remove("RAYON_NUM_THREADS").args(args);
    command
}

/// The files that the command lines name.
fn home() -> TempDir {
    let home = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &[u8]| fs::write(home.path().join(name), content).unwrap();
    write("file", b"no folder");
    write("empty.obj", b"v 0 0 0\n");
    write("damaged.png", b"\x89PNG\r\n\x1a\n");
    write("empty.png", b"");
    fs::create_dir(home.path().join("cut")).unwrap();
    write("cut/index.json", b"{\n  \"set\":");
    write("a.pgm", b"P2 2 1 1\n0 1\n");
    write("b.pgm", b"P2 1 2 1\n0 1\n");
    home
}

/// The message without its label, with its lines joined, and without the usage text that may follow.
fn message(stderr: &str) -> String {
    let first = stderr.split("\n\n").next().unwrap();
    let words: Vec<&str> = first.split_whitespace().collect();
    words.join(" ").strip_prefix("error: ").unwrap_or_else(|| panic!("{stderr}")).to_owned()
}

#[test]
fn bad_input_is_named_and_nothing_is_written() {
    let home = home();
    let before = names(home.path());
    for (line, expected) in refused() {
        let assert = bothways(&home, &arguments(&line)).assert().code(2).stdout("");
        let stderr = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
        let message = message(&stderr);
        assert!(message.starts_with(expected), "{line}\n  {message}\n  {expected}");
        assert!(!stderr.contains("panicked") && !stderr.contains("os error"), "{line}: {stderr}");
        assert_eq!(names(home.path()), before, "{line} wrote something");
    }
}

/// The long options in a help text.
fn options(help: &str) -> BTreeSet<&str> {
    let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
    let long = |line: &str| line.find("--").map(|at| at + 2);
    let names = lines.filter_map(|line| {
        let rest = &line[long(line)?..];
        rest.split(|c: char| !c.is_ascii_lowercase() && c != '-').next()
    });
    names.filter(|name| !["help", "version"].contains(name)).collect()
}

#[test]
fn no_option_is_left_out() {
    let home = home();
    let said = |args: &[&str]| {
        let args: Vec<String> = args.iter().map(|&word| word.to_owned()).collect();
        let assert = bothways(&home, &args).assert().code(0);
        String::from_utf8(assert.get_output().stdout.clone()).unwrap()
    };
    let help = said(&["-h"]);
    let commands = help.split("Commands:").nth(1).unwrap().split("\n\n").next().unwrap();
    // Continued lines have a deeper indentation.
    let names = commands.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    let commands: Vec<&str> = names.filter(|name| !["", "help"].contains(name)).collect();
    assert!(commands.len() >= 9, "{commands:?}");
    for command in &commands {
        let help = said(&[command, "-h"]);
        let lines: Vec<Vec<String>> = refused().map(|(line, _)| arguments(&line)).collect();
        // A command line without a subcommand is rendered.
        let of_command = lines.iter().filter(|words| match words[0].as_str() {
            word if commands.contains(&word) => word == *command,
            _ => *command == "render",
        });
        let tried: Vec<&String> = of_command.flatten().collect();
        assert!(!tried.is_empty(), "{command}");
        for option in options(&help) {
            let name = format!("--{option}");
            let is_tried = tried.iter().any(|word| word.split('=').next() == Some(&name));
            assert!(is_tried, "{command} {name}: no bad value is tried");
        }
    }
}
