//! `bothways slides`: the whole set of slides for a lecture, into a folder.

use super::failure::Failure;
use super::film::progress::Progress;
use super::output::Staging;
use super::terminal;
use bothways::figure::Theme;
use bothways::scenes::{self, DEFAULT, LoadedScene};
use bothways::slides::{Content, Deck};
use bothways::wording::count;
use clap::Args;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

pub(super) const EXAMPLES: &str = "\
The set follows the lecture: what is an image; object order; image order; the camera; coverage and
ties; the nearest; work; when both orders agree, and when real systems do not; films. The first
scene gets all of it, each further scene a chapter of its own.

Examples:
  bothways slides                              the lecture's scene, into out/slides
  bothways slides lecture bunny.obj -o talk    and a chapter about a mesh of your own
  bothways slides --theme light --no-films     for paper

Open out/slides/index.html in a browser: the arrow keys leaf, n shows the lecturer's notes.";

/// Which scenes, and where to.
#[derive(Debug, Args)]
pub(super) struct SlidesArgs {
    /// Built-in scenes, .toml scene files, or mesh files (framed automatically)
    #[arg(value_name = "SCENE", default_value = DEFAULT)]
    scenes: Vec<String>,
    /// dark, for projectors in dim rooms, or light, for paper
    #[arg(long, default_value = "dark")]
    theme: Theme,
    /// Leave out the films, which take most of the time
    #[arg(long)]
    no_films: bool,
    /// The folder to write into. It shows one run: slides of an earlier run that this one does not write
    /// are removed, other files are left alone
    #[arg(short = 'o', long = "output", value_name = "DIR", default_value = "out/slides")]
    folder: PathBuf,
}

/// The most slides of a set: their names are known, so that a later set can remove them.
const LIST: &str = "slides.txt";

/// Draws all slides, writes them and says where they are.
pub(super) fn run(args: &SlidesArgs) -> Result<ExitCode, Failure> {
    let loaded = args.scenes.iter().map(|name| scenes::load(name));
    let loaded = loaded.collect::<Result<Vec<LoadedScene>, _>>()?;
    for scene in &loaded {
        terminal::warn(&scene.warnings);
    }
    let deck = Deck::new(&loaded, args.theme, !args.no_films)
        .map_err(|error| Failure::new(error.to_string()))?;
    let mut staging = Staging::begin_with(&args.folder, names(&deck, args))?;
    let progress = Progress::new(0);
    let all = deck.slides().len();
    for (number, slide) in deck.slides().iter().enumerate() {
        progress.say(format!("slide {} of {all}: {}", number + 1, slide.title));
        let content = deck.draw(slide).map_err(|error| {
            Failure::new(format!("cannot draw the slide '{}': {error}", slide.title))
        })?;
        let bytes = match content {
            Content::Drawing(drawing) => drawing.svg().into_bytes(),
            Content::Film(film) => film,
        };
        staging.write(&slide.file, |out| out.write_all(&bytes))?;
    }
    staging.write("README.md", |out| out.write_all(deck.readme().as_bytes()))?;
    let list: String = deck.slides().iter().map(|slide| format!("{}\n", slide.file)).collect();
    staging.write(LIST, |out| out.write_all(list.as_bytes()))?;
    // Last: where there is a page, all of its slides are there.
    staging.write("index.html", |out| out.write_all(deck.page().as_bytes()))?;
    staging.commit()?;
    progress.finish();
    let page = args.folder.join("index.html");
    terminal::print(&format!("{}\n", page.display()))?;
    anstream::eprintln!("wrote {} into {}", count(all as u64, "slides"), args.folder.display());
    Ok(ExitCode::SUCCESS)
}

/// The names of all files of this set, and of the set that the folder holds: those are replaced or removed.
fn names(deck: &Deck, args: &SlidesArgs) -> Vec<String> {
    let mut names: Vec<String> = deck.slides().iter().map(|slide| slide.file.clone()).collect();
    let earlier = std::fs::read_to_string(args.folder.join(LIST)).unwrap_or_default();
    let is_slide = |name: &&str| {
        let numbered = name.len() > 3 && name.as_bytes()[..2].iter().all(u8::is_ascii_digit);
        numbered
            && !name.contains(['/', '\\'])
            && (name.ends_with(".svg") || name.ends_with(".gif"))
    };
    for name in earlier.lines().filter(is_slide) {
        if !names.iter().any(|known| known == name) {
            names.push(name.into());
        }
    }
    names.extend(["README.md", LIST, "index.html"].map(str::to_owned));
    names
}
