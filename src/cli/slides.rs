//! `bothways slides`: the whole set of slides for a lecture, into a folder.

use super::args::FilesArgs;
use super::failure::Failure;
use super::output::Staging;
use super::status_line::StatusLine;
use super::terminal;
use bothways::figure::Theme;
use bothways::scenes::{DEFAULT, LoadedScene};
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
    #[command(flatten)]
    files: FilesArgs,
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

/// The file that lists a set's slides, so that a later set can remove them, and its first line.
const LIST: &str = "slides.txt";
const MARK: &str = "# what bothways slides wrote here";
/// The files of every set beside its slides.
const BESIDE: [&str; 3] = ["README.md", LIST, "index.html"];

/// Draws all slides, writes them and says where they are.
pub(super) fn run(args: &SlidesArgs) -> Result<ExitCode, Failure> {
    let loaded = args.scenes.iter().map(|name| args.files.load_narrow(name, None, "slides show"));
    let loaded = loaded.collect::<Result<Vec<LoadedScene>, _>>()?;
    for scene in &loaded {
        terminal::warn(&scene.warnings);
    }
    let mut deck = Deck::new(&loaded, args.theme, !args.no_films)
        .map_err(|error| Failure::new(error.to_string()))?;
    let earlier = earlier(args)?;
    let mut staging = Staging::begin_with(&args.folder, names(&deck, &earlier))?;
    let line = StatusLine::new("drawing");
    let all = deck.slides().len();
    let mut left_out = Vec::new();
    for (number, slide) in deck.slides().iter().enumerate() {
        line.say(format!("slide {} of {all}: {}", number + 1, slide.title));
        let bytes = match deck.draw(slide) {
            Ok(Content::Drawing(drawing)) => drawing.svg().into_bytes(),
            Ok(Content::Film(film)) => film,
            // A scene may have nothing of what one slide is about: the others are drawn.
            Err(error) => {
                left_out.push((slide.file.clone(), format!("no slide '{}': {error}", slide.title)));
                continue;
            }
        };
        staging.write(&slide.file, |out| out.write_all(&bytes))?;
    }
    drop(line);
    for (file, warning) in &left_out {
        anstream::eprintln!("warning: {warning}");
        deck.leave_out(file);
    }
    staging.write("README.md", |out| out.write_all(deck.readme().as_bytes()))?;
    let files: String = deck.slides().iter().map(|slide| format!("{}\n", slide.file)).collect();
    let list = format!("{MARK}\n{files}");
    staging.write(LIST, |out| out.write_all(list.as_bytes()))?;
    // Last: where there is a page, all of its slides are there.
    staging.write("index.html", |out| out.write_all(deck.page().as_bytes()))?;
    staging.commit()?;
    let page = args.folder.join("index.html");
    terminal::print(&format!("{}\n", page.display()))?;
    anstream::eprintln!(
        "wrote {} into {}",
        count(deck.slides().len() as u64, "slides"),
        args.folder.display()
    );
    Ok(ExitCode::SUCCESS)
}

/// The names of the slides that the folder holds from an earlier run. A folder with a README or a page that no such run
/// wrote is refused: they are not ours to replace.
fn earlier(args: &SlidesArgs) -> Result<Vec<String>, Failure> {
    let list = std::fs::read_to_string(args.folder.join(LIST)).unwrap_or_default();
    let mut lines = list.lines();
    if lines.next() == Some(MARK) {
        return Ok(lines.filter(|name| is_slide(name)).map(str::to_owned).collect());
    }
    match BESIDE.into_iter().map(|name| args.folder.join(name)).find(|path| path.exists()) {
        None => Ok(Vec::new()),
        Some(taken) => Err(Failure::new(format!(
            "{} is not of an earlier run of slides, and would be replaced; choose another folder with -o",
            taken.display()
        ))),
    }
}

/// Whether a name is one that slides have: nothing else is ever removed.
fn is_slide(name: &str) -> bool {
    let numbered = name.len() > 3 && name.as_bytes()[..2].iter().all(u8::is_ascii_digit);
    numbered && !name.contains(['/', '\\']) && (name.ends_with(".svg") || name.ends_with(".gif"))
}

/// The names of all files of this set and of the earlier one: those are replaced or removed.
fn names(deck: &Deck, earlier: &[String]) -> Vec<String> {
    let mut names: Vec<String> = deck.slides().iter().map(|slide| slide.file.clone()).collect();
    for name in earlier {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names.extend(BESIDE.map(str::to_owned));
    names
}
