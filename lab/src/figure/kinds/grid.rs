//! A magnified patch of the picture: samples, the edges of a triangle, which samples it covers, the signs of its edge
//! functions, and the tie rule at work.

use super::interest::{best_border, on_boundary};
use super::patch::Patch;
use crate::common::exact::EdgeSigns;
use crate::common::{Frame, Primitive, Projection, Sign, View};
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::formula::subscript;
use crate::figure::project::Projector;
use crate::figure::sheet::{MARGIN, RIGHT, Sheet, TOP};
use crate::figure::subject::{FigureError, Subject};
use crate::figure::theme::{Role, Theme};
use crate::wording::count;
use std::collections::BTreeSet;

/// The room of the patch: its top left corner, its width and height.
const ROOM: ([f64; 2], [f64; 2]) = ([MARGIN, TOP], [1176.0, 800.0]);
/// Where the words begin.
const WORDS: f64 = 1290.0;
/// Rows and columns of the patch, as far as the image has them.
const SIZE: [usize; 2] = [8, 12];

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let view = &subject.view;
    let frame = subject.frame();
    let patch = |pixel| Patch::around(pixel, view.camera.image(), SIZE, ROOM);
    let (pixel, id) = match subject.pixel() {
        Some(pixel) => (pixel, at_or_near(&frame, pixel)),
        None => match best_border(view, &frame, patch) {
            Some((pixel, id)) => (pixel, Some(id)),
            // One primitive fills the picture, or nothing does.
            None => {
                let middle = view.camera.image().map(|side| side / 2);
                let middle = [middle[1], middle[0]];
                (middle, at_or_near(&frame, middle))
            }
        },
    };
    let id = id.ok_or_else(nothing)?;
    let primitive = view.primitive(id);
    let is_triangle = matches!(primitive, Primitive::Triangle(_));
    let parallel = view.camera.projection() == Projection::Parallel;
    let point = if is_triangle && parallel {
        "A triangle covers a sample where its three edge functions are positive, and t > 0. On its border one is 0: a tie."
    } else if is_triangle {
        "A triangle covers a sample where its three edge functions are positive. On its border one is 0: a tie."
    } else {
        "A sample is covered if its viewing ray hits the primitive: what lies between samples is never asked."
    };
    let mut sheet = Sheet::new(subject, "Which samples does it cover?", point);
    let patch = patch(pixel);
    let cells = cells(view, &patch, &primitive);
    draw_cells(&mut sheet, &patch, &cells, &frame);
    draw_outlines(&mut sheet, view, &patch, &frame, id);
    draw_samples(&mut sheet, &patch, &cells);
    name_edges(&mut sheet, view, &patch, id);
    words(&mut sheet, subject, &patch, &cells, id);
    Ok(sheet.drawing)
}

fn nothing() -> FigureError {
    FigureError::new(
        "nothing is seen near these samples; choose a pixel at the edge of something with --pixel ROW,COLUMN",
    )
}

/// A sample of the patch.
struct Cell {
    pixel: [usize; 2],
    covered: bool,
    edges: Option<EdgeSigns>,
}

impl Cell {
    fn is_tie(&self) -> bool {
        self.edges.is_some_and(|edges| on_boundary(&edges))
    }

    /// Whether it lies on the line of an edge, but not on the edge.
    fn is_beyond(&self) -> bool {
        !self.is_tie() && self.edges.is_some_and(|edges| edges.at_sample.contains(&Sign::Zero))
    }
}

fn cells(view: &View, patch: &Patch, primitive: &Primitive) -> Vec<Cell> {
    let judge = view.judge();
    let grid = view.camera.sample_grid(1);
    patch
        .pixels()
        .map(|[row, column]| {
            let coverage = judge.coverage(primitive, &grid.ray(row, column));
            Cell { pixel: [row, column], covered: coverage.covers, edges: coverage.edges }
        })
        .collect()
}

/// The primitive of the pixel, or of the nearest pixel around it that shows something.
fn at_or_near(frame: &Frame, [i, j]: [u32; 2]) -> Option<u64> {
    let (i, j) = (i64::from(i), i64::from(j));
    let within = |at: i64, side: usize| usize::try_from(at).ok().filter(|at| *at < side);
    let around = (-4..=4).flat_map(|down| (-6..=6).map(move |right| (down, right)));
    let mut around: Vec<(i64, i64)> = around.collect();
    around.sort_by_key(|(down, right)| down * down + right * right);
    around.into_iter().find_map(|(down, right)| {
        frame.id(within(i + down, frame.height())?, within(j + right, frame.width())?)
    })
}

/// The ground of each pixel: what covers it in the picture.
fn draw_cells(sheet: &mut Sheet, patch: &Patch, cells: &[Cell], frame: &Frame) {
    let theme = sheet.theme;
    let drawing = &mut sheet.drawing;
    for cell in cells {
        let corner = patch.corner(cell.pixel);
        let size = [patch.cell; 2];
        let seen = frame.id(cell.pixel[0], cell.pixel[1]);
        drawing.rectangle(corner, size, Ink::new(theme.mat()));
        if cell.covered {
            drawing.rectangle(corner, size, theme.ink(Role::Good).alpha(0.34));
        } else if seen.is_some() {
            drawing.rectangle(corner, size, Ink::new(theme.quiet()).alpha(0.16));
        }
    }
    patch.draw_lines(drawing, Pen::new(theme.hairline(), 1.5));
}

/// The outlines of all primitives that are seen in the patch, and of the one that is looked at.
fn draw_outlines(sheet: &mut Sheet, view: &View, patch: &Patch, frame: &Frame, id: u64) {
    const MOST: usize = 400;
    let theme = sheet.theme;
    let projector = Projector { camera: view.camera };
    let seen: BTreeSet<u64> =
        patch.pixels().filter_map(|[row, column]| frame.id(row, column)).collect();
    patch.window(&mut sheet.drawing);
    let place = |line: Vec<[f64; 2]>| -> Vec<[f64; 2]> {
        line.into_iter().map(|at| patch.place(at)).collect()
    };
    for other in seen.into_iter().filter(|other| *other != id).take(MOST) {
        for line in projector.outline(&view.primitive(other)) {
            sheet.drawing.line(&place(line), Pen::new(theme.quiet(), 1.5).alpha(0.55));
        }
    }
    let own = view.primitive(id);
    if let Primitive::Triangle([a, b, c]) = own {
        for ((from, to), (color, _)) in [(a, b), (b, c), (c, a)].into_iter().zip(edges(theme)) {
            if let Some(line) = projector.segment(from, to) {
                sheet.drawing.line(&place(line.to_vec()), Pen::new(color, 5.0));
            }
        }
    } else {
        for line in projector.outline(&own) {
            sheet.drawing.line(&place(line), Pen::new(theme.of(Role::Good), 5.0));
        }
    }
    sheet.drawing.window(None);
}

/// The names of a triangle's edges, beside them.
fn name_edges(sheet: &mut Sheet, view: &View, patch: &Patch, id: u64) {
    let theme = sheet.theme;
    let primitive = view.primitive(id);
    let Primitive::Triangle([a, b, c]) = primitive else { return };
    let projector = Projector { camera: view.camera };
    patch.window(&mut sheet.drawing);
    for ((from, to), (color, name)) in [(a, b), (b, c), (c, a)].into_iter().zip(edges(theme)) {
        let Some(line) = projector.segment(from, to) else { continue };
        if let Some(at) = patch.middle_within(&line.map(|at| patch.place(at))) {
            let style = theme.text().semi_bold().sized(28.0).of(color);
            sheet.drawing.label(at, [1.0, -0.6], name, style, Some(theme.mat()));
        }
    }
    sheet.drawing.window(None);
}

/// The name of an edge's function.
pub(super) fn edge_function(edge: &str) -> String {
    format!("E{}", subscript(edge))
}

/// The colours and names of the edges. Their signs stand in this order, too, so that no colour is needed.
pub(super) fn edges(theme: Theme) -> [([u8; 3], &'static str); 3] {
    [(theme.of(Role::Object), "ab"), (theme.of(Role::Image), "bc"), (theme.of(Role::Camera), "ca")]
}

/// The sign of an edge function that is turned so that the inside is positive.
fn inward(function: Sign, facing: Sign) -> Sign {
    if facing == Sign::Negative { -function } else { function }
}

fn sign(sign: Sign) -> &'static str {
    match sign {
        Sign::Negative => "−",
        Sign::Zero => "0",
        Sign::Positive => "+",
    }
}

fn draw_samples(sheet: &mut Sheet, patch: &Patch, cells: &[Cell]) {
    let theme = sheet.theme;
    let drawing = &mut sheet.drawing;
    let radius = 0.075 * patch.cell;
    for cell in cells {
        let [x, y] = patch.middle(cell.pixel);
        let tie = cell.is_tie();
        let color = if tie { theme.of(Role::Focus) } else { theme.bright() };
        if tie {
            let corner = patch.corner(cell.pixel).map(|part| part + 3.0);
            drawing.frame(corner, [patch.cell - 6.0; 2], Pen::new(color, 3.5));
        }
        if cell.covered {
            drawing.disc([x, y], radius, Ink::new(color));
        } else {
            drawing.ring([x, y], radius, Pen::new(color, 2.5));
        }
        if tie {
            // The nudge: a little to the right, and less down.
            drawing.arrow(
                [x, y],
                [x + 0.3 * patch.cell, y + 0.1 * patch.cell],
                Pen::new(color, 2.5),
            );
        }
        let Some(signs) = cell.edges else { continue };
        let size = letters(0.25 * patch.cell);
        for (place, (at, (edge, _))) in signs.at_sample.into_iter().zip(edges(theme)).enumerate() {
            let x = x + (place as f64 - 1.0) * 0.26 * patch.cell;
            let strong = theme.text().semi_bold().sized(size).of(edge);
            let baseline = y + 0.42 * patch.cell;
            drawing.text_with_halo(
                [x, baseline],
                Anchor::Middle,
                sign(inward(at, signs.facing)),
                strong,
                Some(theme.mat()),
            );
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a size of letters")]
fn letters(size: f64) -> f32 {
    size.clamp(12.0, 30.0) as f32
}

fn words(sheet: &mut Sheet, subject: &Subject, patch: &Patch, cells: &[Cell], id: u64) {
    let theme = sheet.theme;
    let width = RIGHT - WORDS;
    let (text, quiet) = (theme.text(), theme.label());
    let (object, _) = subject.view.scene.locate(id);
    let covered = cells.iter().filter(|cell| cell.covered).count() as u64;
    let mut y = TOP + 26.0;
    let heading = theme.heading().of(theme.of(Role::Good));
    let kind = subject.view.primitive(id).kind();
    y = sheet.lines(
        [WORDS, y],
        width,
        40.0,
        &[(&format!("{kind} {id}, of object {object}"), heading)],
    );
    let rows = patch.name();
    let covers = format!("It covers {} of {} samples here.", covered, cells.len());
    y = sheet.lines([WORDS, y], width, 36.0, &[(&rows, quiet), (&covers, text)]);
    y += 14.0;
    y = legend(sheet, [WORDS, y], cells);
    let Some(facing) = cells.iter().find_map(|cell| cell.edges).map(|edges| edges.facing) else {
        return;
    };
    y += 10.0;
    let [ab, bc, ca] = ["ab", "bc", "ca"].map(edge_function);
    let below =
        format!("Below each sample: the signs of {ab}, {bc} and {ca} there, in this order.");
    y = sheet.paragraph([WORDS, y], width, 34.0, &below, text);
    let turned = match facing {
        Sign::Negative => {
            "The facing F is negative: the corners are seen counter-clockwise. The signs are turned, so that + is inside."
        }
        Sign::Positive => {
            "The facing F is positive: the corners are seen clockwise, and + is inside."
        }
        Sign::Zero => "The facing F is 0: it is seen exactly edge-on, and covers nothing.",
    };
    y = sheet.paragraph([WORDS, y], width, 34.0, turned, text);
    y += 14.0;
    ties(sheet, [WORDS, y], cells);
}

fn legend(sheet: &mut Sheet, [x, y]: [f64; 2], cells: &[Cell]) -> f64 {
    let theme = sheet.theme;
    let mut y = y;
    let mut row = |draw: &dyn Fn(&mut Drawing, [f64; 2]), name: &str| {
        draw(&mut sheet.drawing, [x + 14.0, y - 8.0]);
        sheet.drawing.text([x + 44.0, y], Anchor::Left, name, theme.text());
        y += 36.0;
    };
    let square = |drawing: &mut Drawing, [x, y]: [f64; 2], ink: Ink| {
        drawing.rectangle([x - 14.0, y - 14.0], [28.0; 2], Ink::new(theme.mat()));
        drawing.rectangle([x - 14.0, y - 14.0], [28.0; 2], ink);
        drawing.frame([x - 14.0, y - 14.0], [28.0; 2], Pen::new(theme.hairline(), 1.5));
    };
    row(
        &|drawing, at| {
            square(drawing, at, theme.ink(Role::Good).alpha(0.34));
            drawing.disc(at, 7.0, Ink::new(theme.bright()));
        },
        "a sample that it covers",
    );
    row(
        &|drawing, at| {
            square(drawing, at, Ink::new(theme.quiet()).alpha(0.16));
            drawing.ring(at, 7.0, Pen::new(theme.bright(), 2.5));
        },
        "not covered: another primitive is seen",
    );
    row(
        &|drawing, at| {
            square(drawing, at, Ink::new(theme.mat()));
            drawing.ring(at, 7.0, Pen::new(theme.bright(), 2.5));
        },
        "not covered: nothing is seen",
    );
    if cells.iter().any(Cell::is_tie) {
        let focus = theme.of(Role::Focus);
        row(
            &|drawing, at| {
                drawing.frame(at.map(|part| part - 13.0), [26.0; 2], Pen::new(focus, 2.5));
                drawing.disc(at, 7.0, Ink::new(focus));
            },
            "a tie: exactly on an edge",
        );
    }
    if cells.iter().any(Cell::is_beyond) {
        sheet.drawing.text([x + 14.0, y], Anchor::Middle, "0", theme.text().semi_bold());
        let words = "without a frame: on an edge's line, beyond its end";
        y = sheet.paragraph([x + 44.0, y], RIGHT - x - 44.0, 34.0, words, theme.text()) + 2.0;
    }
    y
}

/// The tie rule, with the ties of this patch.
fn ties(sheet: &mut Sheet, [x, y]: [f64; 2], cells: &[Cell]) {
    let theme = sheet.theme;
    let width = RIGHT - x;
    let ties: Vec<&Cell> = cells.iter().filter(|cell| cell.is_tie()).collect();
    if ties.is_empty() {
        let none = "No sample of this patch lies exactly on an edge. Where one does, the tie rule decides: see the \
                    scene ties.";
        sheet.paragraph([x, y], width, 32.0, none, theme.label());
        return;
    }
    let owned = ties.iter().filter(|cell| cell.covered).count();
    let heading = theme.heading().sized(27.0).of(theme.of(Role::Focus));
    let mut y = sheet.lines([x, y], width, 38.0, &[("The tie rule at work", heading)]);
    let rule = "The sample is moved a little to the right, and less down (the arrow). The side that it comes to \
                decides: left and top edges own it.";
    y = sheet.paragraph([x, y], width, 34.0, rule, theme.text());
    let lost = ties.len() - owned;
    let here = format!("{} here: {owned} covered, {lost} not.", count(ties.len() as u64, "ties"));
    y = sheet.paragraph([x, y], width, 34.0, &here, theme.text());
    for covered in [true, false] {
        let example = ties.iter().find(|cell| cell.covered == covered);
        if let Some(example) = example.and_then(|cell| decision(cell)) {
            y = sheet.paragraph([x, y], width, 34.0, &example, theme.text());
        }
    }
}

/// How the tie rule decided a tie, in a sentence.
fn decision(cell: &Cell) -> Option<String> {
    let edges = cell.edges?;
    let decided: Vec<String> = (["ab", "bc", "ca"].into_iter().enumerate())
        .filter(|(edge, _)| edges.at_sample[*edge] == Sign::Zero)
        .map(|(edge, name)| {
            let nudged = sign(inward(edges.decided[edge], edges.facing));
            format!("{} = 0 becomes {nudged}", edge_function(name))
        })
        .collect();
    let verdict = if cell.covered { "covered" } else { "not covered" };
    let [row, column] = cell.pixel;
    Some(format!("Pixel ({row}, {column}): {}: {verdict}.", decided.join(", ")))
}
