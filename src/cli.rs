//! The command line: `bothways [render] [SCENE]` and what goes with it.
//!
//! To add a subcommand, give it a file of its own here, a variant of [`Command`] and an arm of
//! [`run`].

mod args;
mod beside;
mod camera;
mod check;
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
mod rules;
mod run;
mod show_camera;
mod slides;
mod status_line;
mod sweep;
mod table;
mod terminal;
mod usage;
mod vectors;

use args::{FilesArgs, RenderArgs};
use bothways::scenes;
use clap::{Parser, Subcommand};
use clap_complete::Shell;
use failure::Failure;
use std::process::ExitCode;

const ABOUT: &str = "Renders one scene in object order (rasterization) and in image order (ray \
tracing), and proves that both see the same.";

const EXAMPLES: &str = "\
Examples:
  bothways                                   the lecture's scene, into out/lecture
  bothways canonical --size 64x64 -o small   a built-in scene, in small
  bothways bunny.obj --projection parallel   a mesh file, framed automatically
  bothways model.glb#front                   a glTF file, through its camera of this name
  bothways scene.toml --order object         one order alone
  bothways --crop 100,200,48,64              a part of the picture alone, to the last bit
  bothways huge.ply --order object --stream  a mesh that is larger than memory
  bothways render --repeat 20 --json         measured times, for a program to read
  bothways scenes                            what is built in
  bothways ties --object-rules inclusive     what an ordinary renderer gets wrong
  bothways diff a.png b.png                  which pixels of two files differ, and how
  bothways figure camera                     a drawing of the camera and its rays, for a slide
  bothways check mine                        a whole renderer at once: which scenes, and why
  bothways pixel ties 20 30                  why a pixel shows what it shows
  bothways film lecture                      both orders at work, as a film
  bothways slides                            the whole set for a lecture, into out/slides
  bothways cover '1,1 9,2 3,7' --size 10x8   which pixels a triangle covers

Exit codes: 0 both orders see the same, 1 they differ, 2 something went wrong.";

#[derive(Debug, Parser)]
#[command(name = "bothways", version, about = ABOUT, after_help = EXAMPLES)]
#[command(args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    render: RenderArgs,
    #[command(flatten)]
    limits: memory::LimitArgs,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render a scene both ways and compare (what happens without a subcommand)
    #[command(after_help = EXAMPLES)]
    Render(Box<RenderArgs>),
    /// Compare two masks, pictures or buffers of any origin
    #[command(after_help = diff::EXAMPLES)]
    Diff(Box<diff::DiffArgs>),
    /// Hold a renderer's pictures of a whole conformance set to the truth, and sum up the causes
    #[command(after_help = check::EXAMPLES)]
    Check(check::CheckArgs),
    /// Give marks for pictures of one scene: how much is right, and the likely mistake
    #[command(after_help = grade::EXAMPLES)]
    Grade(Box<grade::GradeArgs>),
    /// Draw a figure for a lecture: camera, samples and edges, rays, work, and more, as SVG or PNG
    #[command(after_help = figure::examples())]
    Figure(Box<figure::FigureArgs>),
    /// Draw the whole set of slides for a lecture, with a page to leaf through them
    #[command(after_help = slides::EXAMPLES)]
    Slides(slides::SlidesArgs),
    /// List the built-in scenes, or print one as TOML
    #[command(after_help = SCENES_EXAMPLES)]
    Scenes {
        /// A built-in scene, or a scene or mesh file: prints its TOML
        name: Option<String>,
        #[command(flatten)]
        files: FilesArgs,
    },
    /// List the rules of ordinary renderers that either order can have, and what each gets wrong
    #[command(after_help = rules::EXAMPLES)]
    Rules(rules::RulesArgs),
    /// Tell which pixels a triangle in raster coordinates covers, exactly
    #[command(after_help = cover::EXAMPLES)]
    Cover(cover::CoverArgs),
    /// Derive one pixel's viewing ray; tell what covers it, and what each order saw and did there
    #[command(after_help = pixel::EXAMPLES)]
    Pixel(Box<pixel::PixelArgs>),
    /// Film both orders at work on one picture, on one clock of work done: GIF, PNG, MP4 or frames
    #[command(after_help = film::EXAMPLES)]
    Film(Box<film::FilmArgs>),
    /// Print a scene's camera: eye, frame, viewport, field of view, OpenGL matrices; or for other systems
    #[command(after_help = show_camera::EXAMPLES)]
    Camera(Box<show_camera::ShowCameraArgs>),
    /// Write a whole scene for another program: pbrt, Mitsuba, glTF, OBJ or PLY
    #[command(after_help = export::EXAMPLES)]
    Export(Box<export::ExportArgs>),
    /// Generate a mesh and write it as an OBJ, PLY or STL file
    #[command(after_help = mesh::EXAMPLES)]
    Mesh(mesh::MeshArgs),
    /// Write a conformance set for other renderers: small scenes and what is seen of each
    #[command(after_help = vectors::EXAMPLES)]
    Vectors(vectors::VectorsArgs),
    /// Draw random hostile scenes by all four renderers, and shrink what they disagree on
    #[command(after_help = fuzz::EXAMPLES)]
    Fuzz(fuzz::FuzzArgs),
    /// Measure what both orders cost as a scene grows, and draw it: slopes, and where the orders cross
    #[command(after_help = sweep::EXAMPLES)]
    Sweep(sweep::SweepArgs),
    /// Print a completion script for a shell
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions {
        /// The shell
        shell: Shell,
    },
}

const SCENES_EXAMPLES: &str = "\
Examples:
  bothways scenes                        list the built-in scenes
  bothways scenes canonical > mine.toml  begin a scene file of your own
  bothways scenes bunny.obj              the camera that frames a mesh";

const COMPLETIONS_EXAMPLES: &str = "\
Example:
  bothways completions bash > ~/.local/share/bash-completion/completions/bothways";

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
    use clap::CommandFactory;

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
