//! One pixel's ray: every hit at its `t`, the boxes that it hits, what was tested, and what won.

use super::one_ray::{Path, telling};
use crate::common::glam::{DVec3, Vec3};
use crate::common::{Options, Ray, View};
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::marks::crosshair;
use crate::figure::sheet::{MARGIN, RIGHT, Sheet, TOP, number};
use crate::figure::subject::{FigureError, Subject, small_picture};
use crate::figure::theme::{Role, ramp};
use crate::pixel::{self, Covering, SampleReport};
use crate::raytrace::{self, fast::HierarchyBox};
use crate::wording::{count, grouped};
use std::collections::HashMap;

const PICTURE: ([f64; 2], [f64; 2]) = ([MARGIN, TOP + 44.0], [540.0, 372.0]);
/// The words beside the picture.
const WORDS: [f64; 2] = [MARGIN + 590.0, TOP + 44.0];
const WORDS_WIDTH: f64 = 640.0;
/// The table of hits.
const TABLE: [f64; 2] = [MARGIN + 1290.0, TOP + 44.0];
/// The most rows of the table.
const MOST_ROWS: usize = 8;
/// The axis of `t`: from where to where, and its height.
const AXIS: [f64; 2] = [MARGIN + 250.0, RIGHT - 40.0];
const AXIS_TOP: f64 = 690.0;
const AXIS_Y: f64 = 880.0;
/// The most levels of boxes that have a row of their own.
const ROWS: usize = 5;

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let view = &subject.view;
    let pixel = subject.pixel().map_or_else(|| telling(view), Ok)?;
    let [i, j] = pixel;
    let report = pixel::report(view, &Options::default(), i, j).remove(0);
    let prepared = raytrace::fast::prepare(view.scene);
    let path = Path::of(view, &prepared, pixel);
    let boxes: HashMap<u32, HierarchyBox> =
        prepared.boxes().into_iter().map(|one| (one.number, one)).collect();
    let point = "The ray tests boxes first, then the primitives in those that it hits; the hit with the least t > 0 is seen.";
    let mut sheet = Sheet::new(subject, &format!("The viewing ray of pixel ({i}, {j})"), point);
    picture(&mut sheet, subject, pixel);
    words(&mut sheet, subject, &report, &path);
    let boxes_hit: Vec<(HierarchyBox, [f64; 2])> = path
        .opened
        .iter()
        .filter(|(_, hit)| *hit)
        .filter_map(|(number, _)| {
            let one = boxes.get(number)?;
            Some((*one, interval(view, &report.ray, one)?))
        })
        .collect();
    axis(&mut sheet, &report, &boxes_hit);
    Ok(sheet.drawing)
}

/// From which `t` to which a ray is in a box.
fn interval(view: &View, ray: &Ray, one: &HierarchyBox) -> Option<[f64; 2]> {
    let [low, high]: [DVec3; 2] = [one.low, one.high].map(|corner: Vec3| view.offset(corner));
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let (origin, along) = (ray.origin[axis], ray.direction[axis]);
        if along != 0.0 {
            let (a, b) = ((low[axis] - origin) / along, (high[axis] - origin) / along);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
    }
    (enter <= leave && enter.is_finite()).then_some([enter, leave])
}

/// The picture with the pixel marked.
fn picture(sheet: &mut Sheet, subject: &Subject, [i, j]: [u32; 2]) {
    let theme = sheet.theme;
    let (corner, room) = PICTURE;
    sheet.heading(corner, room[0], "the pixel", "");
    let picture = small_picture(&subject.view, 1040);
    let [width, height] = sheet.picture(picture, corner, room);
    let image = subject.view.camera.image().map(f64::from);
    let x = corner[0] + (f64::from(j) + 0.5) / image[0] * width;
    let y = corner[1] + (f64::from(i) + 0.5) / image[1] * height;
    sheet.drawing.window(Some((corner, [width, height])));
    crosshair(&mut sheet.drawing, [x, y], theme);
    sheet.drawing.window(None);
}

fn words(sheet: &mut Sheet, subject: &Subject, report: &SampleReport, path: &Path) {
    let theme = sheet.theme;
    let [x, top] = WORDS;
    let width = WORDS_WIDTH;
    let vector = |vector: DVec3| {
        format!("({}, {}, {})", number(vector.x, 4), number(vector.y, 4), number(vector.z, 4))
    };
    let eye = subject.view.camera.eye().as_dvec3();
    let hit = path.opened.iter().filter(|(_, hit)| *hit).count() as u64;
    let all = subject.view.scene.primitive_count();
    let seen = match report.covering.first() {
        None => "It hits nothing: the background is seen.".to_owned(),
        Some(nearest) => {
            format!("Seen: {}, id {}, at t = {}.", nearest.kind, nearest.id, number(nearest.t, 6))
        }
    };
    sheet.heading([x, top], width, "the ray, and what it tests", "");
    let origin = format!("origin 𝐩 = {}", vector(eye + report.ray.origin));
    let direction = format!("direction 𝐝 = {}", vector(report.ray.direction));
    let boxes = format!(
        "{} tested, {} of them hit",
        count(path.opened.len() as u64, "boxes"),
        grouped(hit)
    );
    let tested = format!(
        "{} tested; the textbook tests all {}",
        count(path.tested, "primitives"),
        grouped(all)
    );
    let judged = format!("{} left to the exact judge", count(path.judged, "decisions"));
    let text = theme.text();
    let rows = [
        ("𝐫(t) = 𝐩 + t 𝐝", text),
        (origin.as_str(), text),
        (&direction, text),
        (&boxes, text),
        (&tested, text),
        (&judged, text),
        (&seen, text.semi_bold().of(theme.of(Role::Good))),
    ];
    sheet.lines([x, top + 34.0], width, 50.0, &rows);
    table(sheet, report);
}

/// What the ray hits, near to far: of a sphere, its first hit.
fn table(sheet: &mut Sheet, report: &SampleReport) {
    let theme = sheet.theme;
    let [x, top] = TABLE;
    let width = RIGHT - x;
    let all = report.covering.len();
    sheet.heading([x, top], width, "primitives hit", &grouped(all as u64));
    let shown = if all > MOST_ROWS { MOST_ROWS - 1 } else { all };
    for (row, covering) in report.covering.iter().take(shown).enumerate() {
        let baseline = top + 34.0 + 44.0 * row as f64;
        let style =
            if row == 0 { theme.text().semi_bold().of(theme.of(Role::Good)) } else { theme.text() };
        let t = format!("t = {}", number(covering.t, 6));
        let taken = sheet.drawing.text([x + width, baseline], Anchor::Right, &t, style.tabular());
        let name = format!("{}, id {}", covering.kind, covering.id);
        sheet.drawing.fitting([x, baseline], Anchor::Left, &name, style, width - taken - 20.0);
    }
    if all > shown {
        let more = format!("and {} more behind them", grouped((all - shown) as u64));
        let baseline = top + 34.0 + 44.0 * shown as f64;
        sheet.drawing.text([x, baseline], Anchor::Left, &more, theme.label());
    }
    if all == 0 {
        sheet.drawing.text([x, top + 34.0], Anchor::Left, "none", theme.text());
    }
}

/// The axis of `t`, with boxes above it and hits on it.
fn axis(sheet: &mut Sheet, report: &SampleReport, boxes_hit: &[(HierarchyBox, [f64; 2])]) {
    let theme = sheet.theme;
    let hits: Vec<f64> = report.covering.iter().map(|covering| covering.t).collect();
    let nearest = hits.first().copied();
    let boxes =
        boxes_hit.iter().flat_map(|(_, ends)| ends.iter().copied()).filter(|t| t.is_finite());
    let farthest = hits.iter().copied().chain(boxes).fold(0.0, f64::max);
    // A far hit, such as a floor near its horizon, must not squeeze the others.
    let most = match nearest {
        Some(near) if farthest > 12.0 * near => 12.0 * near,
        _ if farthest > 0.0 => farthest,
        _ => 1.0,
    };
    let end = 1.06 * most;
    let place = |t: f64| AXIS[0] + (AXIS[1] - AXIS[0]) * (t / end).min(1.0);
    let shown: Vec<&Covering> = report.covering.iter().filter(|one| one.t <= end).collect();
    if shown.len() < report.covering.len() {
        let farther = format!("{} farther", grouped((report.covering.len() - shown.len()) as u64));
        let at = [AXIS[1] + 8.0, AXIS_Y - 20.0];
        sheet.drawing.text(at, Anchor::Right, &farther, theme.label());
    }
    levels(sheet, boxes_hit, &place);
    let line = Pen::new(theme.bright(), 3.0);
    sheet.drawing.arrow([AXIS[0] - 24.0, AXIS_Y], [AXIS[1] + 36.0, AXIS_Y], line);
    sheet.drawing.text(
        [AXIS[1] + 30.0, AXIS_Y - 16.0],
        Anchor::Middle,
        "t",
        theme.text().semi_bold(),
    );
    sheet.drawing.disc([AXIS[0], AXIS_Y], 8.0, theme.ink(Role::Camera));
    sheet.drawing.text([AXIS[0], AXIS_Y + 40.0], Anchor::Middle, "0", theme.label());
    sheet.drawing.text([MARGIN, AXIS_Y + 8.0], Anchor::Left, "hits", theme.text());
    let behind = Pen::new(theme.quiet(), 3.0);
    for (place_in_order, covering) in shown.iter().enumerate().rev() {
        let x = place(covering.t);
        let winner = place_in_order == 0;
        sheet.drawing.disc(
            [x, AXIS_Y],
            if winner { 13.0 } else { 9.0 },
            Ink::new(theme.background()),
        );
        if winner {
            sheet.drawing.disc([x, AXIS_Y], 11.0, theme.ink(Role::Good));
        } else {
            sheet.drawing.ring([x, AXIS_Y], 7.0, behind);
        }
    }
    labels(sheet, &shown, &place);
}

/// The names of the hits below the axis: those that fit, nearest first, in two rows.
fn labels(sheet: &mut Sheet, shown: &[&Covering], place: &impl Fn(f64) -> f64) {
    let theme = sheet.theme;
    let mut free = [AXIS[0] + 30.0, AXIS[0] + 30.0];
    // Where the upper row has words, through which no line may go.
    let mut written: Vec<[f64; 2]> = Vec::new();
    for (number_in_order, covering) in shown.iter().enumerate() {
        let x = place(covering.t);
        let style = theme.label();
        let style =
            if number_in_order == 0 { style.semi_bold().of(theme.of(Role::Good)) } else { style };
        let text = format!("id {}: t = {}", covering.id, number(covering.t, 5));
        let half = 0.5 * f64::from(crate::figure::text::width(&text, style));
        let middle = x.clamp(AXIS[0] + half, RIGHT - half);
        let is_crossed = || written.iter().any(|[from, to]| (from - 6.0..to + 6.0).contains(&x));
        let fits = |row: &usize| middle - half >= free[*row] && (*row == 0 || !is_crossed());
        let Some(row) = (0..2).find(fits) else { continue };
        if row == 0 {
            written.push([middle - half, middle + half]);
        }
        free[row] = middle + half + 22.0;
        let baseline = AXIS_Y + 46.0 + 34.0 * row as f64;
        sheet
            .drawing
            .line(&[[x, AXIS_Y + 16.0], [x, baseline - 20.0]], Pen::new(theme.quiet(), 1.2));
        sheet.drawing.text([middle, baseline], Anchor::Middle, &text, style);
    }
}

/// The boxes that the ray hits, a row a level.
fn levels(sheet: &mut Sheet, boxes_hit: &[(HierarchyBox, [f64; 2])], place: &impl Fn(f64) -> f64) {
    let theme = sheet.theme;
    if boxes_hit.is_empty() {
        let none = "It hits no box: planes have none, and nothing else is near.";
        sheet.drawing.text([MARGIN, AXIS_TOP + 30.0], Anchor::Left, none, theme.label());
        return;
    }
    let deepest = boxes_hit.iter().map(|(one, _)| one.level).max().unwrap_or(0);
    let rows = (deepest + 1).min(ROWS);
    let step = ((AXIS_Y - 50.0 - AXIS_TOP) / rows as f64).min(44.0);
    let top = AXIS_Y - 46.0 - step * rows as f64;
    sheet.heading(
        [MARGIN, top - 6.0],
        RIGHT - MARGIN,
        "boxes that it hits",
        "from where to where the ray is in each",
    );
    for row in 0..rows {
        let y = top + step * row as f64;
        // The last row stands for all deeper levels.
        let here = |level: usize| level == row || (row + 1 == rows && level > row);
        let of_row: Vec<&(HierarchyBox, [f64; 2])> =
            boxes_hit.iter().filter(|(one, _)| here(one.level)).collect();
        let deeper = if row + 1 == rows && deepest >= rows { " and deeper" } else { "" };
        let name = format!("level {}{deeper}: {}", row + 1, grouped(of_row.len() as u64));
        sheet.drawing.text(
            [MARGIN, y + 0.72 * step],
            Anchor::Left,
            &name,
            theme.text().sized(23.0),
        );
        let color = ramp(0.25 + 0.65 * row as f64 / rows as f64);
        for (_, [enter, leave]) in of_row {
            let (from, to) = (place(*enter), place(*leave));
            let corner = [from, y + 0.16 * step];
            let size = [(to - from).max(2.5), 0.68 * step];
            sheet.drawing.rectangle(corner, size, Ink::new(color).alpha(0.35));
            sheet.drawing.frame(corner, size, Pen::new(color, 1.5));
        }
    }
}
