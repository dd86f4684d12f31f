//! The command line: `bothways [render] [SCENE]` and what goes with it.
//!
//! To add a subcommand, give it a file of its own here, a variant of [`Command`] in `command.rs` and an arm of
//! [`run`].

mod args;
mod beside;
mod camera;
mod check;
mod color;
mod command;
mod completions;
mod cover;
mod diff;
mod export;
mod exr;
mod failure;
mod figure;
mod film;
mod forecast;
mod fuzz;
mod grade;
mod interrupt;
mod memory;
mod mesh;
mod npy;
mod output;
mod patience;
mod pixel;
mod progress;
mod reason;
mod rules;
mod run;
mod shell;
mod show_camera;
mod slides;
mod status_line;
mod sweep;
mod table;
mod terminal;
mod thread_pool;
mod usage;
mod vectors;

use args::FilesArgs;
use bothways::scenes;
use clap_complete::Shell;
use command::{Cli, Command};
use failure::Failure;
use std::process::ExitCode;

/// Runs the program: 0 is a match, 1 a difference, 2 a failure.
pub(crate) fn main() -> ExitCode {
    memory::fail_where_memory_ends();
    interrupt::clean_up();
    usage::parse().and_then(run).unwrap_or_else(|failure| {
        failure.print();
        ExitCode::from(2)
    })
}

fn run(cli: Cli) -> Result<ExitCode, Failure> {
    memory::obey(&cli.limits)?;
    match cli.command {
        None => run::run(&cli.render),
        Some(Command::Render(args)) => run::run(&args),
        Some(Command::Diff(args)) => diff::run(&args),
        Some(Command::Check(args)) => check::run(&args),
        Some(Command::Grade(args)) => grade::run(&args),
        Some(Command::Figure(args)) => figure::run(&args),
        Some(Command::Slides(args)) => slides::run(&args),
        Some(Command::Scenes { name, files }) => print_scenes(name.as_deref(), files),
        Some(Command::Rules(args)) => rules::run(&args),
        Some(Command::Cover(args)) => cover::run(&args),
        Some(Command::Pixel(args)) => pixel::run(&args),
        Some(Command::Film(args)) => film::run(&args),
        Some(Command::Camera(args)) => show_camera::run(&args),
        Some(Command::Export(args)) => export::run(&args),
        Some(Command::Mesh(args)) => mesh::run(&args),
        Some(Command::Vectors(args)) => vectors::run(&args),
        Some(Command::Fuzz(args)) => fuzz::run(&args),
        Some(Command::Sweep(args)) => sweep::run(&args),
        Some(Command::Completions { shell }) => print_completions(shell),
    }
}

fn print_scenes(name: Option<&str>, files: FilesArgs) -> Result<ExitCode, Failure> {
    let text = match name {
        Some(name) => files.load(name, None)?.toml,
        None => scene_list(),
    };
    terminal::print(&text)?;
    Ok(ExitCode::SUCCESS)
}

fn scene_list() -> String {
    let widest = scenes::BUILT_IN.iter().map(|scene| scene.name.len()).max().unwrap_or(0);
    let line = |scene: &scenes::BuiltIn| format!("{:widest$}  {}\n", scene.name, scene.about);
    scenes::BUILT_IN.iter().map(line).collect()
}

fn print_completions(shell: Shell) -> Result<ExitCode, Failure> {
    terminal::print(&completions::script(shell))?;
    Ok(ExitCode::SUCCESS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{CommandFactory, Parser};

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn render_is_what_happens_without_a_subcommand() {
        let scene_of = |line: &[&str]| match Cli::parse_from(line) {
            Cli { command: None, render, .. } => render.scene,
            Cli { command: Some(Command::Render(args)), .. } => args.scene,
            Cli { command: Some(_), .. } => panic!("another subcommand"),
        };
        assert_eq!(scene_of(&["bothways"]), "lecture");
        assert_eq!(scene_of(&["bothways", "canonical"]), "canonical");
        assert_eq!(scene_of(&["bothways", "x.obj", "--size", "64x64"]), "x.obj");
        assert_eq!(scene_of(&["bothways", "--size", "64x64", "x.obj"]), "x.obj");
        assert_eq!(scene_of(&["bothways", "render", "-o", "there", "x.toml"]), "x.toml");
    }

    #[test]
    fn no_built_in_scene_shares_its_name_with_a_subcommand() {
        let command = Cli::command();
        for scene in scenes::BUILT_IN {
            assert!(command.get_subcommands().all(|sub| sub.get_name() != scene.name));
            assert_ne!(scene.name, "help");
        }
    }
}
