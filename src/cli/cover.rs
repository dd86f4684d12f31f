//! `bothways cover`: the pixels of one triangle in raster coordinates.

use super::args::{pair, size};
use super::failure::Failure;
use super::output::OutputFile;
use super::terminal;
use bothways::common::Sign;
use bothways::common::glam::Vec2;
use bothways::cover::{Containment, Cover, Row, cover};
use bothways::wording::{count, grouped};
use clap::Args;
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use serde::Serialize;
use std::fmt::Write;
use std::io;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub(super) const EXAMPLES: &str = "\
Raster coordinates count pixels, x to the right and y down from the top left corner: the centre
of the pixel in row i and column j is x = j + 0.5, y = i + 0.5. A pixel is covered if its centre
is inside, or exactly on a left or top edge. Coordinates are stored as 32-bit floats, 0.1 as
the nearest one; from there on, every decision is exact.

Examples:
  bothways cover '1,1 9,2 3,7' --size 10x8             drawn in the terminal
  bothways cover '1,1 9,2 3,7' --size 10x8 -o t.png    a mask: 255 covered, 0 not
  bothways cover '1,1 9,2 3,7' --size 10x8 --table     row by row
  bothways cover '-5,0 700,3 80,500' --size 640x480 --json";

/// Which triangle, on which image.
#[derive(Debug, Args)]
pub(super) struct CoverArgs {
    /// The three corners: 'x,y x,y x,y', in quotes or without
    #[arg(value_name = "x,y x,y x,y", allow_hyphen_values = true)]
    corners: String,
    // Three separate arguments: a list argument would take options as words, because its words may begin with a
    // hyphen.
    #[arg(hide = true, allow_hyphen_values = true)]
    second: Option<String>,
    #[arg(hide = true, allow_hyphen_values = true)]
    third: Option<String>,
    /// The image in pixels
    #[arg(long, value_name = "WxH", value_parser = size, allow_hyphen_values = true)]
    size: [u32; 2],
    /// Also write the mask as a PNG file, 255 where covered, 0 elsewhere; - is standard output
    #[arg(short = 'o', long = "output", value_name = "FILE.png")]
    file: Option<PathBuf>,
    /// Print the rows as a table, even where a drawing fits
    #[arg(long, conflicts_with = "json")]
    table: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Computes the covered pixels, writes the mask and prints the result.
pub(super) fn run(args: &CoverArgs) -> Result<ExitCode, Failure> {
    let words = [Some(&args.corners), args.second.as_ref(), args.third.as_ref()];
    let words: Vec<&str> = words.into_iter().flatten().map(String::as_str).collect();
    let corners = corners(&words.join(" "))?;
    let file = args.file.as_deref().map(|name| mask_file(name, args.json)).transpose()?;
    let cover = cover(corners, args.size).map_err(|error| Failure::new(error.to_string()))?;
    let text = if args.json {
        json(&cover)?
    } else {
        let drawing = if args.table { None } else { drawing(&cover, terminal::width()) };
        heading(&cover) + &drawing.unwrap_or_else(|| table(&cover))
    };
    let Some(file) = file else {
        terminal::print(&text)?;
        return Ok(ExitCode::SUCCESS);
    };
    let mask = cover.mask();
    file.write(|out| {
        let [width, height] = cover.image;
        PngEncoder::new(out)
            .write_image(&mask, width, height, ExtendedColorType::L8)
            .map_err(io::Error::other)
    })?;
    if file.is_stdout() {
        // The picture is the result on stdout; the text for the user goes to stderr.
        anstream::eprint!("{text}");
    } else {
        terminal::print(&text)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The destination of the mask.
fn mask_file(name: &Path, json: bool) -> Result<OutputFile, Failure> {
    let file = OutputFile::find(name)?;
    if file.is_stdout() && json {
        return Err(Failure::new(
            "--json and the mask would both go to standard output; name a file with -o",
        ));
    }
    match file.ending().as_deref() {
        None | Some("png") => Ok(file),
        Some(ending) => Err(Failure::new(format!(
            "cannot write {}: a mask is a .png file, and .{ending} is none; end the name in .png",
            file.said()
        ))),
    }
}

fn corners(text: &str) -> Result<[Vec2; 3], Failure> {
    let each = (1..).zip(text.split_whitespace()).map(|(number, word)| {
        pair(word).map(Vec2::from_array).map_err(|problem| {
            Failure::new(format!("corner {number} is '{word}': {problem}; write 'x,y x,y x,y'"))
        })
    });
    let corners = each.collect::<Result<Vec<Vec2>, Failure>>()?;
    let given = corners.len();
    corners.try_into().map_err(|_| {
        let given = count(given as u64, "corners");
        Failure::new(format!("'{text}' has {given}; a triangle has three: 'x,y x,y x,y'"))
    })
}

fn heading(cover: &Cover) -> String {
    // The fewest digits that read back as the stored number.
    let [a, b, c] = cover.triangle.map(|corner| format!("({}, {})", corner.x, corner.y));
    let [width, height] = cover.image;
    let facing = match cover.facing {
        Sign::Zero => "it has no area, and so covers nothing".into(),
        _ => format!("its corners are seen {}", facing(cover)),
    };
    let mut text = format!("triangle {a} {b} {c} on {width} x {height} pixels: {facing}\n");
    text += &format!("{} covered\n", count(cover.covered(), "pixels"));
    let (on_edge, kept) = (cover.on_edge(), cover.on_edge_and_covered());
    if on_edge > 0 {
        let lie = if on_edge == 1 { "lies" } else { "lie" };
        let centres = count(on_edge, "pixel centres");
        text += &format!("{centres} {lie} exactly on an edge: {} covered, ", grouped(kept));
        text += &format!("{} not (top-left rule)\n", grouped(on_edge - kept));
    } else if cover.facing != Sign::Zero {
        text += "no pixel centre lies exactly on an edge\n";
    }
    text
}

fn facing(cover: &Cover) -> &'static str {
    match cover.facing {
        Sign::Negative => "counter-clockwise",
        Sign::Zero => "edge-on",
        Sign::Positive => "clockwise",
    }
}

/// The most rows of a drawing; more rows become a table, or a PNG file.
const MOST_ROWS: usize = 100;

/// A drawing of the pixels that the triangle touches, with a margin of one, two characters per pixel; `None` if the
/// drawing does not fit.
fn drawing(cover: &Cover, width: usize) -> Option<String> {
    let rows = around(cover.rows.iter().map(|row| [row.i, row.i]), cover.image[1])?;
    let touched = cover.rows.iter().map(|row| [row.touched.start, row.touched.end - 1]);
    let columns = around(touched, cover.image[0])?;
    let label = rows.end().to_string().len().max(3);
    if label + 2 + 2 * columns.clone().count() > width || rows.clone().count() > MOST_ROWS {
        return None;
    }
    let (first, last) = (columns.start(), columns.end());
    let mut text = format!("\n{:label$}  columns {first} to {last}\n", "row");
    for i in rows {
        write!(text, "{i:label$} ").expect("a string takes all");
        for j in columns.clone() {
            text.push(' ');
            text.push(letter(cover.place(i, j)));
        }
        text.push('\n');
    }
    text += "\n# covered   + on an edge, covered   o on an edge, not covered   . not covered\n";
    Some(text)
}

/// The range from the least to the greatest index, with one more on both sides within the image.
fn around(runs: impl Iterator<Item = [u32; 2]>, side: u32) -> Option<RangeInclusive<u32>> {
    let [low, high] = runs.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
    Some(low.saturating_sub(1)..=(high + 1).min(side - 1))
}

fn letter(place: Containment) -> char {
    match place {
        Containment::Inside => '#',
        Containment::OnEdge { covered: true } => '+',
        Containment::OnEdge { covered: false } => 'o',
        Containment::Outside => '.',
    }
}

fn table(cover: &Cover) -> String {
    if cover.rows.is_empty() {
        return String::new();
    }
    let mut text =
        format!("\n{:>7}{:>9}{:>9}{:>9}{:>9}\n", "row", "first", "last", "count", "on edge");
    for row in &cover.rows {
        let [first, last] = match ends(row) {
            Some(ends) => ends.map(|column| column.to_string()),
            None => ["-".into(), "-".into()],
        };
        let on_edge = row.touched.len() - row.inside.len();
        let (i, covered) = (row.i, row.covered.len());
        text += &format!("{i:7}{first:>9}{last:>9}{covered:9}{on_edge:9}\n");
    }
    text
}

/// The first and the last covered column.
fn ends(row: &Row) -> Option<[u32; 2]> {
    (!row.covered.is_empty()).then(|| [row.covered.start, row.covered.end - 1])
}

/// The output of `--json`, in this order.
#[derive(Debug, Serialize)]
struct Report {
    triangle: [[f32; 2]; 3],
    size: [u32; 2],
    facing: &'static str,
    covered: u64,
    on_edge: OnEdge,
    rows: Vec<RowReport>,
}

#[derive(Debug, Serialize)]
struct OnEdge {
    samples: u64,
    covered: u64,
}

#[derive(Debug, Serialize)]
struct RowReport {
    row: u32,
    covered: Option<[u32; 2]>,
    on_edge: Vec<u32>,
}

fn json(cover: &Cover) -> Result<String, Failure> {
    let rows = cover.rows.iter().map(|row| RowReport {
        row: row.i,
        covered: ends(row),
        on_edge: row.touched.clone().filter(|column| !row.inside.contains(column)).collect(),
    });
    let report = Report {
        triangle: cover.triangle.map(|corner| corner.to_array()),
        size: cover.image,
        facing: facing(cover),
        covered: cover.covered(),
        on_edge: OnEdge { samples: cover.on_edge(), covered: cover.on_edge_and_covered() },
        rows: rows.collect(),
    };
    terminal::json(&report)
}
