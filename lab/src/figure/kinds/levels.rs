//! The level of the texture that each order reads at each pixel, where they differ, and why: along one column.

use super::counts::scale_bar;
use crate::common::frame::{Ids, LEVELS_OF, NO_LEVEL};
use crate::common::{Frame, Options, View};
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::marks::mark;
use crate::figure::sheet::{MARGIN, RIGHT, Sheet, TOP, number};
use crate::figure::subject::{FigureError, Subject};
use crate::figure::theme::{Role, Theme, mixed, ramp};
use crate::orders::Order;
use crate::picture::picture;
use crate::{rasterize, raytrace};
use image::{Rgb, RgbImage};

/// The room of a map; three of them stand side by side.
const MAP: [f64; 2] = [560.0, 390.0];
const GAP: f64 = 48.0;
const MAPS_TOP: f64 = TOP + 40.0;
/// The room below: of the picture, and of the chart.
const BELOW: f64 = 726.0;
const PICTURE: [f64; 2] = [330.0, 234.0];
const CHART_LEFT: f64 = MARGIN + 470.0;
/// The most rows of the chart.
const MOST_ROWS: usize = 24;
/// A difference of levels that has the full colour.
const FULL: f64 = 0.1;

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let frames = Order::ALL.map(|order| shaded(&subject.view, order));
    let levels = Levels::new(&subject.view, &frames);
    let reach = levels.reach().ok_or_else(|| {
        FigureError::new(
            "no sample reads a texture: nothing that is seen has texture coordinates; look at a sphere, a plane, or a mesh that has \
             some (lines \"vt\" of an OBJ file)",
        )
    })?;
    let mut sheet =
        Sheet::new(subject, "Which level of its texture does a sample read?", reach.point());
    let mut left = MARGIN;
    let most = levels.most;
    for (k, order) in Order::ALL.into_iter().enumerate() {
        let how = match order {
            Order::Object => "by differences of neighbouring pixels",
            Order::Image => "by ray differentials",
        };
        let map = levels.map(sheet.theme, |at| Some(ramp(levels.shown(k, at)? / most as f64)));
        let size = sheet.picture(map, [left, MAPS_TOP], MAP);
        sheet.heading([left, MAPS_TOP], MAP[0], order.name(), how);
        let bar = [left, MAPS_TOP + size[1] + 14.0];
        scale_bar(&mut sheet, bar, size[0], &(0..=most).collect::<Vec<u64>>());
        left += MAP[0] + GAP;
    }
    let theme = sheet.theme;
    let map = levels.map(theme, |at| Some(apart(theme, levels.difference(at)?)));
    let size = sheet.picture(map, [left, MAPS_TOP], MAP);
    sheet.heading([left, MAPS_TOP], MAP[0], "difference", "object order minus image order");
    difference_bar(&mut sheet, [left, MAPS_TOP + size[1] + 14.0], size[0]);
    let style = theme.label();
    let each = "each next level is half as wide and high";
    let says = match levels.assumed {
        Some(side) => format!(
            "no texture is seen here: these are the levels of one of {side} × {side} texels, level 0; {each}"
        ),
        None => {
            format!("level 0 is the picture itself, {each}, level {most} the last: a single texel")
        }
    };
    let baseline = MAPS_TOP + size[1] + 86.0;
    sheet.drawing.fitting([MARGIN, baseline], Anchor::Left, &says, style, 2.0 * MAP[0]);
    let says = "orange: object order reads a smaller picture";
    let says = if theme == Theme::Light { says.replace("orange", "brown") } else { says.into() };
    sheet.drawing.fitting(
        [left, baseline],
        Anchor::Left,
        &says,
        style.of(theme.of(Role::Object)),
        MAP[0],
    );
    below(&mut sheet, &levels, reach, &frames[0]);
    Ok(sheet.drawing)
}

/// What an order sees, with the levels that it finds.
fn shaded(view: &View, order: Order) -> Frame {
    let options = Options::default();
    let mut frame = Frame::new(view.camera, &options).with_levels();
    match order {
        Order::Object => {
            let prepared = rasterize::fast::prepare(view.scene);
            rasterize::fast::determine_visibility(&prepared, view, &options, &mut frame, &mut ());
            rasterize::shade(view, &mut frame);
        }
        Order::Image => {
            let prepared = raytrace::fast::prepare(view.scene);
            raytrace::fast::determine_visibility(&prepared, view, &options, &mut frame, &mut ());
            raytrace::shade(view, &mut frame);
        }
    }
    frame
}

/// The levels of both orders.
struct Levels<'a> {
    of: [&'a [f32]; 2],
    /// What is seen.
    ids: Ids<'a>,
    width: usize,
    height: usize,
    /// The last level of the largest texture, which has a single texel.
    most: u64,
    /// The side of the texture that is assumed where nothing has one, in texels.
    assumed: Option<usize>,
}

impl<'a> Levels<'a> {
    fn new(view: &View, frames: &'a [Frame; 2]) -> Levels<'a> {
        let materials = view.scene.objects().iter().flat_map(|object| {
            let named = object.shape.mesh().and_then(|mesh| mesh.materials());
            let of_mesh = named.into_iter().flat_map(|materials| materials.named());
            of_mesh.filter_map(|named| named.material.as_ref()).chain([&object.material])
        });
        let textures = materials.filter_map(|material| material.texture.as_ref());
        let [side, _] = LEVELS_OF;
        let of_textures = textures.map(|texture| texture.pyramid.levels().len() - 1).max();
        let most = of_textures.unwrap_or(side.ilog2() as usize).max(1) as u64;
        let assumed = of_textures.is_none().then_some(side);
        let of = frames.each_ref().map(|frame| frame.levels());
        let (width, height) = (frames[0].width(), frames[0].height());
        Levels { of, ids: frames[0].ids(), width, height, most, assumed }
    }

    /// The level that an order reads, from 0 to the last one.
    fn shown(&self, order: usize, at: usize) -> Option<f64> {
        let level = self.of[order][at];
        (level != NO_LEVEL).then(|| f64::from(level).clamp(0.0, self.most as f64))
    }

    /// Which levels are read; `None` if no sample has one.
    fn reach(&self) -> Option<Reach> {
        let samples = 0..self.width * self.height;
        let shown = |order| samples.clone().filter_map(move |at| self.shown(order, at));
        let all = shown(0).chain(shown(1));
        let (least, greatest) = all
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), level| {
                (level.min(least), level.max(greatest))
            });
        if least > greatest {
            None
        } else if greatest <= 0.0 {
            Some(Reach::First)
        } else if least >= self.most as f64 {
            Some(Reach::Last)
        } else {
            Some(Reach::Several)
        }
    }

    /// How much higher the level of object order is.
    fn difference(&self, at: usize) -> Option<f64> {
        Some(self.shown(0, at)? - self.shown(1, at)?)
    }

    /// A picture of a colour for each sample; samples without a level have the ground's.
    fn map(&self, theme: Theme, color: impl Fn(usize) -> Option<[u8; 3]>) -> RgbImage {
        let side = |side: usize| u32::try_from(side).expect("an image's side");
        RgbImage::from_fn(side(self.width), side(self.height), |x, y| {
            let at = y as usize * self.width + x as usize;
            Rgb(color(at).unwrap_or(theme.mat()))
        })
    }

    /// The column and some rows of one surface where the orders differ most: away from its outline, and not where one of them
    /// reads the last level already.
    fn telling(&self) -> Option<(usize, Vec<usize>)> {
        let is_between = |at: usize| {
            let between = |order| {
                self.shown(order, at).is_some_and(|level| level > 0.0 && level < self.most as f64)
            };
            between(0) && between(1)
        };
        let is_same = |at: usize, other: Option<usize>| {
            let other = other.filter(|&other| other < self.width * self.height);
            other.is_some_and(|other| self.ids.get(other) == self.ids.get(at))
        };
        let is_within = |at: usize, rows: usize| {
            is_same(at, at.checked_sub(2 * self.width))
                && is_same(at, at.checked_add(rows * self.width))
        };
        let apart = |at: &usize| self.difference(*at).unwrap_or(0.0).abs();
        // A large surface tells more than one of a few rows.
        let most = [MOST_ROWS / 2, 2].into_iter().find_map(|rows| {
            (0..self.width * self.height)
                .filter(|&at| is_between(at) && is_within(at, rows))
                .max_by(|a, b| apart(a).total_cmp(&apart(b)))
        })?;
        let (row, column) = (most / self.width, most % self.width);
        let is_shown = |row: &usize| {
            let at = row * self.width + column;
            self.ids.get(at) == self.ids.get(most) && self.difference(at).is_some()
        };
        let above = (0..row).rev().take_while(is_shown).take(2).count();
        let rows: Vec<usize> =
            (row - above..self.height).take_while(is_shown).take(MOST_ROWS).collect();
        Some((column, rows))
    }
}

/// Which levels the samples of a picture read.
#[derive(Clone, Copy)]
enum Reach {
    /// The picture itself alone.
    First,
    /// The single texel alone.
    Last,
    Several,
}

impl Reach {
    /// What the figure says in one line.
    fn point(self) -> &'static str {
        match self {
            Reach::First => {
                "A sample's size decides the level: here all samples are smaller than a texel, and both orders read the picture itself."
            }
            Reach::Last => {
                "A sample's size decides the level: here each sample is as large as the whole texture, and both orders read its mean."
            }
            Reach::Several => {
                "A sample's size decides the level. Object order subtracts neighbours, in pairs; image order differentiates its ray: \
                 they part where sizes change fast."
            }
        }
    }

    /// Why there is no column to look at.
    fn without_column(self) -> &'static str {
        match self {
            Reach::First => {
                "All samples read level 0: all that is seen is near. Look from farther away."
            }
            Reach::Last => {
                "All samples read the last level: all that is seen is far. Look from nearer."
            }
            Reach::Several => {
                "No surface that reads between two levels is five rows high. Draw more pixels."
            }
        }
    }
}

/// The colour of a difference: that of the order whose level is higher.
fn apart(theme: Theme, difference: f64) -> [u8; 3] {
    let order = if difference > 0.0 { Role::Object } else { Role::Image };
    mixed(theme.hairline(), theme.of(order), (difference.abs() / FULL).min(1.0))
}

/// The colours of differences.
fn difference_bar(sheet: &mut Sheet, [x, y]: [f64; 2], width: f64) {
    const PARTS: u32 = 96;
    let theme = sheet.theme;
    let part = width / f64::from(PARTS);
    for step in 0..PARTS {
        let place = (f64::from(step) + 0.5) / f64::from(PARTS);
        let color = apart(theme, FULL * (2.0 * place - 1.0));
        let wide = part + if step + 1 < PARTS { 0.8 } else { 0.0 };
        sheet.drawing.rectangle([x + f64::from(step) * part, y], [wide, 16.0], Ink::new(color));
    }
    sheet.drawing.frame([x, y], [width, 16.0], Pen::new(theme.hairline(), 1.5));
    let label = theme.label();
    let ends = [
        (x, Anchor::Left, -FULL),
        (x + 0.5 * width, Anchor::Middle, 0.0),
        (x + width, Anchor::Right, FULL),
    ];
    for (at, anchor, value) in ends {
        sheet.drawing.text([at, y + 42.0], anchor, &number(value, 2), label);
    }
}

/// The picture with the column that is looked at, and the levels along it.
fn below(sheet: &mut Sheet, levels: &Levels, reach: Reach, frame: &Frame) {
    let theme = sheet.theme;
    let top = BELOW + 40.0;
    let size = sheet.picture(picture(frame), [MARGIN, top], PICTURE);
    sheet.heading([MARGIN, top], PICTURE[0], "the picture", "");
    let Some((column, rows)) = levels.telling() else {
        let (at, says) = ([CHART_LEFT, top + 60.0], reach.without_column());
        sheet.drawing.text(at, Anchor::Left, says, theme.text());
        return;
    };
    let [across, down] = [size[0] / levels.width as f64, size[1] / levels.height as f64];
    let corner = [MARGIN + column as f64 * across - 3.0, top + rows[0] as f64 * down - 3.0];
    let marked = [across + 6.0, rows.len() as f64 * down + 6.0];
    sheet.drawing.frame(corner, marked, Pen::new(theme.of(Role::Focus), 3.0));
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    let note = format!("column {column}, rows {first} to {last}, framed in the picture");
    sheet.heading([CHART_LEFT, top], RIGHT - CHART_LEFT, "level by row", &note);
    chart(sheet, levels, column, &rows, [CHART_LEFT, top]);
}

fn chart(sheet: &mut Sheet, levels: &Levels, column: usize, rows: &[usize], corner: [f64; 2]) {
    let theme = sheet.theme;
    let size = [RIGHT - corner[0], PICTURE[1]];
    sheet.mat(corner, size);
    let at = |row: usize| row * levels.width + column;
    let shown = |order: usize, row: usize| levels.shown(order, at(row)).unwrap_or(0.0);
    let all = || rows.iter().flat_map(|&row| [shown(0, row), shown(1, row)]);
    let low = all().fold(f64::INFINITY, f64::min).floor();
    let high = all().fold(low + 1.0, f64::max).ceil();
    let step = size[0] / rows.len() as f64;
    let place = |row: usize, level: f64| {
        let x = corner[0] + ((row - rows[0]) as f64 + 0.5) * step;
        [x, corner[1] + size[1] * (0.93 - 0.86 * (level - low) / (high - low))]
    };
    // The pairs of object order, from an even row on.
    for &row in rows.iter().filter(|&row| row % 2 == 0) {
        let x = corner[0] + (row - rows[0]) as f64 * step;
        let wide = (2.0 * step).min(corner[0] + size[0] - x);
        if row % 4 == 0 {
            sheet.drawing.rectangle([x, corner[1]], [wide, size[1]], Ink::new(theme.background()));
        }
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "levels are few")]
    let (first, last) = (low as u64, high as u64);
    for level in first..=last {
        let y = place(rows[0], level as f64)[1];
        sheet.drawing.rectangle([corner[0], y], [size[0], 1.0], Ink::new(theme.hairline()));
        let label = theme.label().tabular();
        sheet.drawing.text([corner[0] - 12.0, y + 7.0], Anchor::Right, &level.to_string(), label);
    }
    for (k, order) in Order::ALL.into_iter().enumerate() {
        let line: Vec<[f64; 2]> = rows.iter().map(|&row| place(row, shown(k, row))).collect();
        let color = theme.of(order.into());
        sheet.drawing.line(&line, Pen::new(color, 3.0));
        for point in &line {
            mark(&mut sheet.drawing, order, *point, 6.0, Ink::new(color));
        }
        let (anchor, x) = match order {
            Order::Object => (Anchor::Right, RIGHT - 300.0),
            Order::Image => (Anchor::Right, RIGHT - 24.0),
        };
        let style = theme.label().of(color).semi_bold();
        sheet.drawing.text([x, corner[1] + 34.0], anchor, order.name(), style);
    }
    sheet.border(corner, size);
}
