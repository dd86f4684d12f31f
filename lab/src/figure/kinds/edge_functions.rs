//! The three edge functions of a triangle as half-planes, and their intersection.

use super::grid::{edge_function, edges};
use crate::common::glam::DVec3;
use crate::common::{Frame, Primitive, Projection, Ray, View};
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::project::Projector;
use crate::figure::sheet::{MARGIN, RIGHT, Sheet, TOP};
use crate::figure::subject::{FigureError, Subject};
use crate::figure::theme::{Role, Theme, mixed};
use image::{Rgb, RgbImage};
use std::collections::BTreeMap;

const PANEL_TOP: f64 = TOP + 46.0;
/// The edge functions of ab, bc and ca.
const DEFINITIONS: [&str; 3] =
    ["det(𝐚 − 𝐩, 𝐛 − 𝐩, 𝐝)", "det(𝐛 − 𝐩, 𝐜 − 𝐩, 𝐝)", "det(𝐜 − 𝐩, 𝐚 − 𝐩, 𝐝)"];
/// The most samples along a side at which the functions are evaluated.
const MOST: usize = 142;
/// How many steps a ramp has between 0 and its greatest value.
const STEPS: f64 = 6.0;

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let view = &subject.view;
    let frame = subject.frame();
    let (id, corners) = triangle(subject, &frame)?;
    let point = match view.camera.projection() {
        Projection::Perspective => {
            "Each edge function is positive on one side of its edge's line; the triangle is where all three agree."
        }
        Projection::Parallel => {
            "Each edge function is positive on one side of its edge's line; the triangle is where all three agree, and t > 0."
        }
    };
    let mut sheet = Sheet::new(subject, "A triangle is three half-planes", point);
    let extent = Extent::of(view, &corners, &frame, id);
    let values = Values::new(view, &corners, &extent);
    let theme = sheet.theme;
    let panels = Panels::new(&extent);
    for (number, (color, name)) in edges(theme).into_iter().enumerate() {
        let corner = panels.corner(number);
        sheet.heading(corner, panels.room[0], &edge_function(name), "");
        let place = extent.placed(corner, panels.room);
        sheet.drawing.picture(values.ramp(number, theme), place.corner, place.size);
        sheet.drawing.window(Some((place.corner, place.size)));
        hatch(&mut sheet, &values, number, &place);
        zero_line(&mut sheet, &values, number, &place, color);
        sheet.drawing.window(None);
        outline(&mut sheet, view, &corners, &place, number);
        sheet.border(place.corner, place.size);
        let formula = format!("{} = {}", edge_function(name), DEFINITIONS[number]);
        let ([x, y], room) = panels.words(&place);
        sheet.drawing.fitting([x, y], Anchor::Left, &formula, theme.text(), room);
    }
    let corner = panels.corner(3);
    sheet.heading(corner, panels.room[0], "all three", "");
    let place = extent.placed(corner, panels.room);
    sheet.drawing.picture(values.covered(theme), place.corner, place.size);
    sheet.drawing.window(Some((place.corner, place.size)));
    for (number, (color, _)) in edges(theme).into_iter().enumerate() {
        zero_line(&mut sheet, &values, number, &place, color);
    }
    sheet.drawing.window(None);
    sheet.border(place.corner, place.size);
    let ([x, y], room) = panels.words(&place);
    let (object, _) = view.scene.locate(id);
    let name = format!("triangle {id} of object {object}");
    sheet.drawing.fitting([x, y], Anchor::Left, &name, theme.text(), room);
    let samples = format!("{} × {} samples", values.columns, values.rows);
    if panels.beside {
        sheet.drawing.fitting([x, y + 36.0], Anchor::Left, &samples, theme.label(), room);
    }
    legend(&mut sheet, 922.0);
    Ok(sheet.drawing)
}

/// Where the four panels lie: in one row if the extent is high, in two rows with the words beside them if it is wide.
struct Panels {
    room: [f64; 2],
    beside: bool,
}

impl Panels {
    fn new(extent: &Extent) -> Panels {
        let [width, height] = extent.size();
        let beside = width > 1.15 * height;
        Panels { room: if beside { [560.0, 306.0] } else { [426.0, 560.0] }, beside }
    }

    fn corner(&self, number: usize) -> [f64; 2] {
        let (column, row) = if self.beside { (number % 2, number / 2) } else { (number, 0) };
        let step = if self.beside { 900.0 } else { 450.0 };
        [MARGIN + column as f64 * step, PANEL_TOP + row as f64 * 364.0]
    }

    /// Where the words about a panel begin, and how wide they may be.
    fn words(&self, place: &Panel) -> ([f64; 2], f64) {
        let ([x, y], [width, height]) = (place.corner, place.size);
        if self.beside {
            ([x + width + 24.0, y + 30.0], 876.0 - width - 24.0)
        } else {
            ([x, y + height + 42.0], self.room[0])
        }
    }
}

/// The triangle to draw: that of the chosen pixel, else the one that most pixels show.
fn triangle(subject: &Subject, frame: &Frame) -> Result<(u64, [DVec3; 3]), FigureError> {
    let view = &subject.view;
    let corners = |id: u64| match view.primitive(id) {
        Primitive::Triangle(corners) => Some((id, corners)),
        Primitive::Sphere { .. } | Primitive::Plane { .. } => None,
    };
    if let Some([i, j]) = subject.pixel() {
        let seen = frame.id(i as usize, j as usize);
        return seen.and_then(corners).ok_or_else(|| {
            FigureError::new(format!(
                "pixel ({i}, {j}) shows no triangle; choose another with --pixel ROW,COLUMN"
            ))
        });
    }
    let mut pixels: BTreeMap<u64, u32> = BTreeMap::new();
    for id in frame.ids().iter().flatten() {
        *pixels.entry(id).or_default() += 1;
    }
    let triangles = pixels.into_iter().filter_map(|(id, pixels)| Some((pixels, corners(id)?)));
    let most = triangles.max_by_key(|(pixels, (id, _))| (*pixels, std::cmp::Reverse(*id)));
    most.map(|(_, triangle)| triangle)
        .ok_or_else(|| FigureError::new("no pixel shows a triangle; draw another scene"))
}

/// The part of the image around the triangle: first row and column and their ends, in pixels.
struct Extent {
    low: [f64; 2],
    high: [f64; 2],
}

/// The extent on the canvas.
struct Panel {
    corner: [f64; 2],
    size: [f64; 2],
    /// The extent's top left corner on the raster, and units in a pixel.
    first: [f64; 2],
    scale: f64,
}

impl Extent {
    fn of(view: &View, corners: &[DVec3; 3], frame: &Frame, id: u64) -> Extent {
        let projector = Projector { camera: view.camera };
        let places: Option<Vec<[f64; 2]>> =
            corners.iter().map(|corner| projector.place(*corner)).collect();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut include = |at: [f64; 2]| {
            for axis in 0..2 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis]);
            }
        };
        match places {
            Some(places) => places.into_iter().for_each(&mut include),
            // A corner is not before the eye: then what is seen counts.
            None => {
                for row in 0..frame.height() {
                    for column in
                        (0..frame.width()).filter(|column| frame.id(row, *column) == Some(id))
                    {
                        include([column as f64, row as f64]);
                        include([column as f64 + 1.0, row as f64 + 1.0]);
                    }
                }
            }
        }
        let image = view.camera.image().map(f64::from);
        let mut extent = Extent { low: [0.0; 2], high: image };
        for axis in 0..2 {
            let margin = 0.3 * (high[axis] - low[axis]).clamp(2.0, 2.0 * image[axis]);
            extent.low[axis] = (low[axis] - margin).floor().clamp(0.0, image[axis] - 1.0);
            extent.high[axis] =
                (high[axis] + margin).ceil().clamp(extent.low[axis] + 1.0, image[axis]);
        }
        extent
    }

    fn size(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.high[axis] - self.low[axis])
    }

    /// Where it lies in the panel with this corner.
    fn placed(&self, corner: [f64; 2], room: [f64; 2]) -> Panel {
        let size = self.size();
        let scale = (room[0] / size[0]).min(room[1] / size[1]);
        let drawn = size.map(|side| (side * scale).round());
        Panel { corner, size: drawn, first: self.low, scale }
    }
}

impl Panel {
    /// The place on the canvas of a place on the raster.
    fn of(&self, at: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.corner[axis] + (at[axis] - self.first[axis]) * self.scale)
    }
}

/// The edge functions at a grid of samples of the extent.
struct Values {
    rows: usize,
    columns: usize,
    /// Each with the sign that makes the triangle's inside positive.
    values: Vec<[f64; 3]>,
    covered: Vec<bool>,
    /// At the extent's top left, top right and bottom left corners: an edge function is affine on the viewport.
    corners: [[f64; 3]; 3],
}

impl Values {
    fn new(view: &View, triangle: &[DVec3; 3], extent: &Extent) -> Values {
        let judge = view.judge();
        let side = |axis: usize| {
            let pixels = extent.size()[axis];
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "at most the image's side"
            )]
            let pixels = pixels as usize;
            pixels.div_ceil(pixels.div_ceil(MOST))
        };
        let (columns, rows) = (side(0), side(1));
        // The place on the raster as a ray, by the lecture's formulas.
        let ray = |[column, row]: [f64; 2]| -> Ray {
            let ([vw, vh], [width, height]) =
                (view.camera.viewport(), view.camera.image().map(f64::from));
            view.camera.ray_through(vw * (column / width - 0.5), -vh * (row / height - 0.5))
        };
        let at = |x: f64, y: f64| {
            [extent.low[0] + x * extent.size()[0], extent.low[1] + y * extent.size()[1]]
        };
        let value = |place: [f64; 2]| {
            let values = judge.edge_values(triangle, &ray(place));
            values.at_sample.map(|value| value * values.facing.signum())
        };
        let middles = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))).map(
            |(row, column)| {
                at((column as f64 + 0.5) / columns as f64, (row as f64 + 0.5) / rows as f64)
            },
        );
        let middles: Vec<[f64; 2]> = middles.collect();
        let primitive = Primitive::Triangle(*triangle);
        Values {
            rows,
            columns,
            values: middles.iter().map(|place| value(*place)).collect(),
            covered: middles.iter().map(|place| judge.covers(&primitive, &ray(*place))).collect(),
            corners: [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)].map(value),
        }
    }

    fn picture(&self, color: impl Fn(usize) -> [u8; 3]) -> RgbImage {
        let side = |side: usize| u32::try_from(side).expect("at most 142");
        RgbImage::from_fn(side(self.columns), side(self.rows), |x, y| {
            Rgb(color(y as usize * self.columns + x as usize))
        })
    }

    /// One function as a ramp in steps: towards one colour where it is positive, towards another where it is negative.
    fn ramp(&self, edge: usize, theme: Theme) -> RgbImage {
        let greatest = self.values.iter().map(|values| values[edge].abs()).fold(0.0, f64::max);
        self.picture(|index| {
            let value = self.values[index][edge] / if greatest > 0.0 { greatest } else { 1.0 };
            let step = (value.abs() * STEPS).ceil() / STEPS;
            mixed(theme.mat(), side_color(theme, value), 0.12 + 0.7 * step)
        })
    }

    fn covered(&self, theme: Theme) -> RgbImage {
        self.picture(|index| {
            mixed(theme.mat(), theme.of(Role::Good), if self.covered[index] { 0.75 } else { 0.0 })
        })
    }

    /// The function at a part of the width and of the height.
    fn at(&self, edge: usize, [x, y]: [f64; 2]) -> f64 {
        let [origin, right, below] = self.corners.map(|values| values[edge]);
        origin + x * (right - origin) + y * (below - origin)
    }
}

/// Hatches the side where a function is negative.
fn hatch(sheet: &mut Sheet, values: &Values, edge: usize, place: &Panel) {
    const GAP: f64 = 22.0;
    let pen = Pen::new(sheet.theme.bright(), 1.4).alpha(0.5);
    let ([x, y], [width, height]) = (place.corner, place.size);
    let part = |point: [f64; 2]| [(point[0] - x) / width, (point[1] - y) / height];
    let mut sum = x + y;
    while sum < x + y + width + height {
        sum += GAP;
        // A line that rises to the right, within the panel.
        let (from, to) = ([sum - y - height, y + height], [sum - y, y]);
        let (a, b) = (values.at(edge, part(from)), values.at(edge, part(to)));
        let crossing = |t: f64| [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])];
        let (begin, end) = match (a < 0.0, b < 0.0) {
            (true, true) => (0.0, 1.0),
            (true, false) => (0.0, a / (a - b)),
            (false, true) => (a / (a - b), 1.0),
            (false, false) => continue,
        };
        sheet.drawing.line(&[crossing(begin), crossing(end)], pen);
    }
}

/// The line where a function is 0.
fn zero_line(sheet: &mut Sheet, values: &Values, edge: usize, place: &Panel, color: [u8; 3]) {
    let ([x, y], [width, height]) = (place.corner, place.size);
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut ends = Vec::new();
    for k in 0..4 {
        let (from, to): ([f64; 2], [f64; 2]) = (corners[k], corners[(k + 1) % 4]);
        let (a, b) = (values.at(edge, from), values.at(edge, to));
        if (a < 0.0) != (b < 0.0) {
            let t = a / (a - b);
            ends.push([0, 1].map(|axis| from[axis] + t * (to[axis] - from[axis])));
        }
    }
    let line: Vec<[f64; 2]> = ends.iter().map(|[a, b]| [x + a * width, y + b * height]).collect();
    sheet.drawing.line(&line, Pen::new(sheet.theme.background(), 8.0));
    sheet.drawing.line(&line, Pen::new(color, 5.0));
}

/// The triangle itself, thin, with the corners of the edge by name.
fn outline(sheet: &mut Sheet, view: &View, corners: &[DVec3; 3], place: &Panel, edge: usize) {
    let theme = sheet.theme;
    let projector = Projector { camera: view.camera };
    sheet.drawing.window(Some((place.corner, place.size)));
    for line in projector.outline(&Primitive::Triangle(*corners)) {
        let line: Vec<[f64; 2]> = line.into_iter().map(|at| place.of(at)).collect();
        sheet.drawing.line(&line, Pen::new(theme.bright(), 1.8).dashed(3.0, 6.0));
    }
    for corner in [edge, (edge + 1) % 3] {
        let name = ["𝐚", "𝐛", "𝐜"][corner];
        let Some(at) = projector.place(corners[corner]) else { continue };
        sheet.drawing.disc(place.of(at), 6.0, Ink::new(theme.bright()));
        sheet.drawing.label(
            place.of(at),
            [0.5, -1.0],
            name,
            theme.text().semi_bold(),
            Some(theme.mat()),
        );
    }
    sheet.drawing.window(None);
}

fn legend(sheet: &mut Sheet, y: f64) {
    let theme = sheet.theme;
    let steps = 2.0 * STEPS;
    let (left, width) = (MARGIN, 26.0);
    let mut step = -STEPS;
    while step <= STEPS {
        if step != 0.0 {
            let color =
                mixed(theme.mat(), side_color(theme, step), 0.12 + 0.7 * step.abs() / STEPS);
            let place = if step < 0.0 { step + STEPS } else { step + STEPS - 1.0 };
            sheet.drawing.rectangle([left + place * width, y], [width, 24.0], Ink::new(color));
        }
        step += 1.0;
    }
    let half = STEPS * width;
    sheet.drawing.hatch([left, y], [half, 24.0], 11.0, Pen::new(theme.bright(), 1.4).alpha(0.5));
    let words =
        "negative, hatched: outside of this edge      positive: inside      the thick line: 0";
    let x = left + steps * width + 24.0;
    sheet.drawing.fitting([x, y + 20.0], Anchor::Left, words, theme.label(), RIGHT - x);
    let note = "𝐫(t) = 𝐩 + t 𝐝 is the ray through a sample. Here each function has the sign that makes the inside positive. \
                On the raster all three are affine: their level lines are straight and evenly spaced.";
    sheet.drawing.fitting([left, y + 60.0], Anchor::Left, note, theme.label(), RIGHT - left);
}

/// The colour of the side on which a function has this sign.
fn side_color(theme: Theme, value: f64) -> [u8; 3] {
    if value < 0.0 { theme.quiet() } else { theme.of(Role::Good) }
}
