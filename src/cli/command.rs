//! The words of the command line: subcommands, and the options without one.

use super::args::{FilesArgs, RenderArgs};
use super::{
    check, cover, diff, export, figure, film, fuzz, grade, memory, mesh, pixel, rules, show_camera,
    slides, sweep, vectors,
};
use clap::{Parser, Subcommand};
use clap_complete::Shell;

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
pub(super) struct Cli {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) render: RenderArgs,
    #[command(flatten)]
    pub(super) limits: memory::LimitArgs,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
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
