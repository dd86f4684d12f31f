//! Every command in the README does what it says: it runs, and ends well.

mod support;

use assert_cmd::Command;
use std::path::Path;
use support::arguments;

#[test]
fn every_command_of_the_readme_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = std::fs::read_to_string(root.join("README.md")).unwrap();
    let shell = readme.split("```sh").skip(1).filter_map(|block| block.split("```").next());
    let lines = shell.flat_map(str::lines).filter(|line| line.starts_with("cargo run --release"));
    // In a folder of its own, one below which `../shared` may be.
    let outside = tempfile::tempdir().unwrap();
    let inside = outside.path().join("clone");
    std::fs::create_dir_all(inside.join("out")).unwrap();
    let shared = root.join("../shared");
    let mut commands = 0;
    for line in lines {
        let rest = line.trim_start_matches("cargo run --release").trim_start();
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
        let mut command = Command::cargo_bin("bothways").unwrap();
        command.args(&arguments).current_dir(&inside).assert().success();
        commands += 1;
    }
    assert!(commands >= 10, "{commands} commands found");
}
