//! A chart of a sweep: curves on logarithmic axes, with their slopes, and the place where the orders cross.

use super::drawing::{Anchor, Drawing, Ink, Pen};
use super::marks::mark;
use super::sheet::{BOTTOM, MARGIN, RIGHT, Sheet, TOP};
use super::text::{self, Style};
use super::theme::{Role, Theme};
use crate::orders::{Method, Order};
use crate::sweep::{Axis, Crossing, Curve, Quantity, Slope, Source, Summary, short};

/// The corner of the plot and its size.
const CORNER: [f64; 2] = [MARGIN + 104.0, TOP + 12.0];
const SIZE: [f64; 2] = [1270.0, BOTTOM - 84.0 - CORNER[1]];
/// Where the names of the curves begin, beside the plot.
const NAMES: f64 = CORNER[0] + SIZE[0] + 44.0;
/// The height of a name and its slope.
const NAME: f64 = 66.0;
/// The height of what explains lines and markers, below the names.
const SIGNS: f64 = 104.0;
/// A curve that ends before this part of the plot is named beside its end, in the plot.
const ENDS_EARLY: f64 = 0.62;

/// Draws one quantity along one axis. `conditions` says under which conditions times were measured.
pub fn sweep_chart(summary: &Summary, conditions: &str, image: [u32; 2], theme: Theme) -> Drawing {
    let title = title(summary);
    let mut sheet =
        Sheet::titled(theme, &title, &facts(summary, conditions, image), &point(summary));
    let plot = Plot::around(summary);
    plot.grid(&mut sheet, summary);
    plot.reference(&mut sheet, summary);
    // Of curves that coincide, the one with gaps is drawn last, so that both are seen.
    for curve in summary.curves.iter().rev() {
        plot.curve(&mut sheet, curve);
    }
    plot.crossing(&mut sheet, summary);
    plot.names(&mut sheet, summary);
    signs(&mut sheet, summary);
    sheet.drawing
}

fn title(summary: &Summary) -> String {
    let grows = match summary.axis {
        Axis::Triangles => "more triangles",
        Axis::Pixels => "more pixels",
        Axis::DepthComplexity => "more layers",
        Axis::TriangleSize => "larger triangles",
        Axis::Instances => "more instances",
    };
    match summary.quantity {
        Quantity::Steps => format!("How many steps do {grows} take?"),
        Quantity::Milliseconds => format!("How long do {grows} take?"),
    }
}

fn facts(summary: &Summary, conditions: &str, [width, height]: [u32; 2]) -> String {
    let mut facts = summary.axis.scene().to_owned();
    if summary.axis != Axis::Pixels {
        facts += &format!("   ·   {width} × {height} pixels");
    }
    facts
        + "   ·   "
        + match summary.quantity {
            Quantity::Steps => "counted: the same on every machine",
            Quantity::Milliseconds => conditions,
        }
}

/// What to see: where the fast orders cross.
fn point(summary: &Summary) -> String {
    let said = summary.says(Method::Fast);
    let mut letters = said.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string());
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}

/// The range of an axis, as logarithms to base 10, and its place on the canvas.
struct Scale {
    low: f64,
    high: f64,
    start: f64,
    length: f64,
}

/// The values 1, 2 and 5 of each decade from 10⁻⁹ to 10¹⁵.
fn ticks() -> impl Iterator<Item = f64> {
    (-9..=15).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(power)))
}

fn is_power_of_ten(tick: f64) -> bool {
    (tick.log10() - tick.log10().round()).abs() < 1e-9
}

impl Scale {
    /// The shortest axis that begins and ends at a tick and contains all values.
    fn around(values: impl Iterator<Item = f64>, start: f64, length: f64) -> Scale {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let below = ticks().filter(|tick| *tick <= low * 1.000_001).last().unwrap_or(low);
        let above = ticks().find(|tick| *tick >= high * 0.999_999 && *tick > below).unwrap_or(high);
        Scale { low: below.log10(), high: above.log10(), start, length }
    }

    fn place(&self, value: f64) -> f64 {
        self.start + self.length * (value.log10() - self.low) / (self.high - self.low)
    }

    fn ticks(&self) -> impl Iterator<Item = f64> {
        let range = self.low - 1e-9..=self.high + 1e-9;
        ticks().filter(move |tick| range.contains(&tick.log10()))
    }

    /// The ticks that get a number: as many as have room.
    fn numbered(&self) -> Vec<f64> {
        let powers: Vec<f64> = self.ticks().filter(|tick| is_power_of_ten(*tick)).collect();
        if powers.len() >= 4 { powers } else { self.ticks().collect() }
    }
}

struct Plot {
    x: Scale,
    y: Scale,
}

impl Plot {
    fn around(summary: &Summary) -> Plot {
        let points = || summary.curves.iter().flat_map(|curve| &curve.points);
        Plot {
            x: Scale::around(points().map(|point| point.x), CORNER[0], SIZE[0]),
            // Down on the canvas is up on the axis.
            y: Scale::around(points().map(|point| point.value), CORNER[1] + SIZE[1], -SIZE[1]),
        }
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.x.place(x), self.y.place(y)]
    }

    fn grid(&self, sheet: &mut Sheet, summary: &Summary) {
        let theme = sheet.theme;
        sheet.mat(CORNER, SIZE);
        let bottom = CORNER[1] + SIZE[1];
        let pen = |tick| Pen::new(theme.hairline(), if is_power_of_ten(tick) { 1.6 } else { 0.7 });
        for tick in self.x.ticks() {
            let x = self.x.place(tick);
            sheet.drawing.line(&[[x, CORNER[1]], [x, bottom]], pen(tick));
        }
        for tick in self.y.ticks() {
            let y = self.y.place(tick);
            sheet.drawing.line(&[[CORNER[0], y], [CORNER[0] + SIZE[0], y]], pen(tick));
        }
        let style = theme.label().tabular();
        for tick in self.x.numbered() {
            let at = [self.x.place(tick), bottom + 30.0];
            sheet.drawing.text(at, Anchor::Middle, &short(tick), style);
        }
        for tick in self.y.numbered() {
            let at = [CORNER[0] - 14.0, self.y.place(tick) + 7.0];
            sheet.drawing.text(at, Anchor::Right, &short(tick), style);
        }
        let name = match summary.quantity {
            Quantity::Steps => "steps of a frame",
            Quantity::Milliseconds => "milliseconds a frame",
        };
        let style = theme.text();
        sheet.drawing.text([CORNER[0], CORNER[1] - 16.0], Anchor::Left, name, style);
        let middle = [CORNER[0] + 0.5 * SIZE[0], bottom + 66.0];
        sheet.drawing.text(middle, Anchor::Middle, summary.axis.unit(), style);
    }

    /// Faint lines that rise as what grows linearly does, one for each second power of ten. Larger triangles are fewer:
    /// there the lines fall.
    fn reference(&self, sheet: &mut Sheet, summary: &Summary) {
        let theme = sheet.theme;
        sheet.drawing.window(Some((CORNER, SIZE)));
        let pen = Pen::new(theme.quiet(), 1.2).dashed(2.0, 9.0).alpha(0.75);
        let (low, high) = (10_f64.powf(self.x.low), 10_f64.powf(self.x.high));
        let rises = if summary.axis == Axis::TriangleSize { -1 } else { 1 };
        for power in (-24..=24).step_by(2) {
            let rate = 10_f64.powi(power);
            let line = [low, high].map(|x| [x, x.powi(rises) * rate]);
            sheet.drawing.line(&line.map(|point| self.place(point)), pen);
        }
        sheet.drawing.window(None);
    }

    fn curve(&self, sheet: &mut Sheet, curve: &Curve) {
        let theme = sheet.theme;
        let color = theme.of(curve.order.into());
        let places: Vec<[f64; 2]> =
            curve.points.iter().map(|point| self.place([point.x, point.value])).collect();
        sheet.drawing.line(&places, pen(curve, color));
        for (point, place) in curve.points.iter().zip(&places) {
            if point.most > point.least * 1.02 {
                // The rounds of a time.
                let ends = [point.least, point.most].map(|value| self.place([point.x, value]));
                let ends = ends.map(|[x, y]| [x, y.max(CORNER[1])]);
                sheet.drawing.line(&ends, Pen::new(color, 2.0).alpha(0.6));
            }
            let is_hollow = point.source == Source::ByDefinition;
            marker(&mut sheet.drawing, *place, curve.order, color, is_hollow.then(|| theme.mat()));
        }
    }

    /// Marks where the fast orders cross, if they do.
    fn crossing(&self, sheet: &mut Sheet, summary: &Summary) {
        let Crossing::At { x, value, .. } = summary.fast else { return };
        let theme = sheet.theme;
        let color = theme.of(Role::Focus);
        let place = self.place([x, value]);
        let foot = [place[0], CORNER[1] + SIZE[1]];
        sheet.drawing.line(&[place, foot], Pen::new(color, 2.5).dashed(3.0, 6.0));
        sheet.drawing.ring(place, 17.0, Pen::new(color, 3.0));
        let said = format!("{} {}", short(rounded(x)), summary.axis.unit());
        let style = theme.text().of(color).semi_bold();
        let at = [place[0], 0.5 * (place[1] + foot[1])];
        sheet.drawing.label(at, [1.0, 0.6], &said, style, Some(theme.mat()));
    }

    /// Names every curve beside its end, with its slope.
    fn names(&self, sheet: &mut Sheet, summary: &Summary) {
        let ends: Vec<(&Curve, [f64; 2])> = summary
            .curves
            .iter()
            .filter_map(|curve| {
                let point = curve.points.last()?;
                Some((curve, self.place([point.x, point.value])))
            })
            .collect();
        let early = CORNER[0] + ENDS_EARLY * SIZE[0];
        for is_inside in [true, false] {
            let mut group: Vec<_> =
                ends.iter().filter(|(_, end)| (end[0] < early) == is_inside).copied().collect();
            group.sort_by(|(_, a), (_, b)| a[1].total_cmp(&b[1]));
            let heights: Vec<f64> = group.iter().map(|(_, end)| end[1] - 0.5 * NAME).collect();
            let range =
                [CORNER[1], CORNER[1] + SIZE[1] - NAME - if is_inside { 0.0 } else { SIGNS }];
            for ((curve, end), top) in group.iter().zip(apart(heights, range)) {
                let left = if is_inside { end[0] + 56.0 } else { NAMES };
                self.name(sheet, curve, *end, [left, top]);
            }
        }
    }

    fn name(&self, sheet: &mut Sheet, curve: &Curve, end: [f64; 2], [left, top]: [f64; 2]) {
        let theme = sheet.theme;
        let color = theme.of(curve.order.into());
        let leader = [[end[0] + 14.0, end[1]], [left - 10.0, top + 0.5 * NAME - 2.0]];
        sheet.drawing.line(&leader, Pen::new(color, 1.4).alpha(0.8));
        let name = format!("{}, {}", curve.order.name(), curve.method.name());
        let mut write = |baseline: f64, text: &str, style: Style| {
            sheet.drawing.text_with_halo(
                [left, baseline],
                Anchor::Left,
                text,
                style,
                Some(if left < NAMES { theme.mat() } else { theme.background() }),
            );
        };
        let style = theme.text().of(color).semi_bold();
        let style = style.sized(fitting_size(&name, style, RIGHT - left));
        write(top + 27.0, &name, style);
        let grows = curve.slope.map_or("no slope: too few points".into(), grows);
        write(top + 54.0, &grows, theme.label());
    }
}

/// Explains the lines and markers that have no name, at the foot of the names.
fn signs(sheet: &mut Sheet, summary: &Summary) {
    let has = |source| {
        summary.curves.iter().any(|curve| curve.points.iter().any(|point| point.source == source))
    };
    let dotted = match summary.axis {
        Axis::TriangleSize => "dotted: half of it for twice the size",
        _ => "dotted: twice as much, twice the cost",
    };
    let mut lines = vec![dotted];
    if has(Source::ByDefinition) {
        lines.push("hollow: by definition, without a run");
    }
    if has(Source::Measured) {
        lines.push("bars: up to the slowest round");
    }
    let style = sheet.theme.label();
    let mut baseline = CORNER[1] + SIZE[1] - 30.0 * (lines.len() - 1) as f64;
    for line in lines {
        sheet.drawing.fitting([NAMES, baseline], Anchor::Left, line, style, RIGHT - NAMES);
        baseline += 30.0;
    }
}

/// A slope in words.
fn grows(Slope { value, error, .. }: Slope) -> String {
    let value = if value.abs() < 0.005 { 0.0 } else { value };
    let slope = format!("slope {value:.2}").replace('-', "−");
    // A curve that bends has no one slope: its error says so.
    if error < 0.02 { slope } else { format!("{slope} ± {error:.2}") }
}

/// The size of letters that fit into a width, if smaller ones are needed.
fn fitting_size(text: &str, style: Style, room: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "a size of letters")]
    let fitting = style.size * (room / f64::from(text::width(text, style))) as f32;
    fitting.min(style.size)
}

/// Fast curves are thick. Textbooks are thin, and that of object order has gaps, which show the other where both
/// coincide.
fn pen(curve: &Curve, color: [u8; 3]) -> Pen {
    match (curve.method, curve.order) {
        (Method::Fast, _) => Pen::new(color, 4.5),
        (Method::Textbook, Order::Object) => Pen::new(color, 3.0).dashed(18.0, 18.0),
        (Method::Textbook, Order::Image) => Pen::new(color, 2.2),
    }
}

/// The mark of an order; hollow with this ground.
fn marker(
    drawing: &mut Drawing,
    at: [f64; 2],
    order: Order,
    color: [u8; 3],
    ground: Option<[u8; 3]>,
) {
    mark(drawing, order, at, 8.0, Ink::new(color));
    if let Some(ground) = ground {
        mark(drawing, order, at, 5.0, Ink::new(ground));
    }
}

/// The number, rounded to two digits that count.
fn rounded(value: f64) -> f64 {
    let step = 10_f64.powf(value.log10().floor() - 1.0);
    (value / step).round() * step
}

/// The tops of names, from above, moved so that neighbours do not overlap and all stay within a range.
fn apart(mut tops: Vec<f64>, [first, last]: [f64; 2]) -> Vec<f64> {
    // Names that overlap move apart together, a little at a time; few names need few steps.
    for _ in 0..64 {
        for at in 1..tops.len() {
            let missing = NAME - (tops[at] - tops[at - 1]);
            if missing > 0.0 {
                tops[at - 1] -= 0.5 * missing;
                tops[at] += 0.5 * missing;
            }
        }
        for top in &mut tops {
            *top = top.clamp(first, last);
        }
    }
    for at in 1..tops.len() {
        tops[at] = tops[at].max(tops[at - 1] + NAME);
    }
    tops
}
