//! Draws charts with logarithmic axes as SVG, for light pages and dark ones.
//!
//! Both axes have the same scale: a curve that grows linearly rises at 45 degrees.

use std::fmt::Write;

/// The length of a decade on both axes, in pixels.
const DECADE: f64 = 130.0;
/// The margins to the left, above, to the right and below, in pixels.
const LEFT: f64 = 76.0;
const ABOVE: f64 = 64.0;
const RIGHT: f64 = 130.0;
const BELOW: f64 = 84.0;
/// The least distance between two names, in pixels.
const LINE: f64 = 20.0;

/// A chart.
pub(crate) struct Chart {
    pub(crate) title: String,
    /// The fixed conditions of the measurements.
    pub(crate) note: String,
    pub(crate) x: &'static str,
    pub(crate) y: &'static str,
    pub(crate) curves: Vec<Curve>,
}

/// A curve of at least two points, with positive coordinates.
pub(crate) struct Curve {
    pub(crate) name: &'static str,
    /// The colours on light pages and on dark ones.
    pub(crate) colors: [&'static str; 2],
    pub(crate) points: Vec<[f64; 2]>,
}

/// The range of an axis, as logarithms to base 10.
struct Axis {
    low: f64,
    high: f64,
}

impl Axis {
    /// The shortest axis that begins and ends at a tick and contains all values.
    fn around(values: impl Iterator<Item = f64>) -> Axis {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let below = ticks().filter(|tick| *tick <= low).last().unwrap_or(low);
        let above = ticks().find(|tick| *tick >= high).unwrap_or(high);
        Axis { low: below.log10(), high: above.log10() }
    }

    fn length(&self) -> f64 {
        DECADE * (self.high - self.low)
    }

    fn place(&self, value: f64) -> f64 {
        DECADE * (value.log10() - self.low)
    }

    fn ticks(&self) -> impl Iterator<Item = f64> {
        ticks().filter(|tick| (self.low..=self.high).contains(&tick.log10()))
    }
}

/// The values 1, 2 and 5 of each decade from 10⁻⁹ to 10¹².
fn ticks() -> impl Iterator<Item = f64> {
    (-9..=12).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(power)))
}

impl Chart {
    /// The chart as the text of an SVG file.
    pub(crate) fn svg(&self) -> String {
        let values =
            |k: usize| self.curves.iter().flat_map(move |c| c.points.iter().map(move |p| p[k]));
        let (x, y) = (Axis::around(values(0)), Axis::around(values(1)));
        let (width, height) = (LEFT + x.length() + RIGHT, ABOVE + y.length() + BELOW);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" \
             width=\"{width:.0}\" height=\"{height:.0}\" role=\"img\">\n<title>{}</title>\n",
            self.title
        );
        svg += &self.style();
        let place = |[a, b]: [f64; 2]| [LEFT + x.place(a), ABOVE + y.length() - y.place(b)];
        let mut text = |class: &str, [a, b]: [f64; 2], text: &str| {
            writeln!(svg, "<text class=\"{class}\" x=\"{a:.1}\" y=\"{b:.1}\">{text}</text>")
        };
        let _ = text("title", [LEFT, 26.0], &self.title);
        let _ = text("middle", [LEFT + 0.5 * x.length(), height - 40.0], self.x);
        let _ = text("note", [LEFT, height - 14.0], &self.note);
        let _ = text("y", [LEFT - 60.0, ABOVE - 16.0], self.y);
        svg += &grid(&x, &y);
        for (number, curve) in self.curves.iter().enumerate() {
            let points = curve.points.iter().map(|point| place(*point));
            let points: Vec<String> = points.map(|[a, b]| format!("{a:.1},{b:.1}")).collect();
            let _ =
                writeln!(svg, "<polyline class=\"c{number}\" points=\"{}\"/>", points.join(" "));
            for [a, b] in curve.points.iter().map(|point| place(*point)) {
                let _ = writeln!(
                    svg,
                    "<circle class=\"d{number}\" cx=\"{a:.1}\" cy=\"{b:.1}\" r=\"3.5\"/>"
                );
            }
        }
        let ends = self.curves.iter().map(|curve| place(curve.points[curve.points.len() - 1]));
        for (number, (curve, [a, b])) in self.curves.iter().zip(apart(ends.collect())).enumerate() {
            let (a, b) = (a + 12.0, b + 5.0);
            let _ = writeln!(
                svg,
                "<text class=\"d{number}\" x=\"{a:.1}\" y=\"{b:.1}\">{}</text>",
                curve.name
            );
        }
        svg + "</svg>\n"
    }

    fn style(&self) -> String {
        let colors = |page: usize, ink: &str, line: &str| {
            let mut rules = format!("text{{fill:{ink}}} .grid{{stroke:{line}}}");
            for (number, curve) in self.curves.iter().enumerate() {
                let color = curve.colors[page];
                let _ = write!(rules, " .c{number}{{stroke:{color}}} .d{number}{{fill:{color}}}");
            }
            rules
        };
        format!(
            "<style>\ntext{{font:15px system-ui,sans-serif}} .title{{font-size:18px;font-weight:600}}\n\
             .note{{font-size:13px;opacity:.8}} .middle{{text-anchor:middle}} .right{{text-anchor:end}}\n\
             .grid{{stroke-width:1}} polyline{{fill:none;stroke-width:2.5}}\n{}\n\
             @media(prefers-color-scheme:dark){{{}}}\n</style>\n",
            colors(0, "#24292f", "#d0d7de"),
            colors(1, "#e6edf3", "#3d444d"),
        )
    }
}

/// The lines and numbers at the ticks.
fn grid(x: &Axis, y: &Axis) -> String {
    let mut svg = String::new();
    let (right, bottom) = (LEFT + x.length(), ABOVE + y.length());
    let mut line = |from: [f64; 2], to: [f64; 2]| {
        let ([a, b], [c, d]) = (from, to);
        let _ = writeln!(
            svg,
            "<line class=\"grid\" x1=\"{a:.1}\" y1=\"{b:.1}\" x2=\"{c:.1}\" y2=\"{d:.1}\"/>"
        );
    };
    for at in x.ticks().map(|tick| LEFT + x.place(tick)) {
        line([at, ABOVE], [at, bottom]);
    }
    for at in y.ticks().map(|tick| bottom - y.place(tick)) {
        line([LEFT, at], [right, at]);
    }
    let mut text = |class: &str, [a, b]: [f64; 2], value: f64| {
        let _ = writeln!(
            svg,
            "<text class=\"{class}\" x=\"{a:.1}\" y=\"{b:.1}\">{}</text>",
            short(value)
        );
    };
    // On the x axis there is room only for powers of ten.
    for tick in x.ticks().filter(|tick| tick.log10().fract().abs() < 1e-9) {
        text("middle", [LEFT + x.place(tick), bottom + 20.0], tick);
    }
    for tick in y.ticks() {
        text("right", [LEFT - 8.0, bottom - y.place(tick) + 5.0], tick);
    }
    svg
}

/// A number as written beside an axis: 0.05, 20, 500 k, 2 M.
fn short(value: f64) -> String {
    let (part, unit) = match value {
        1e6.. => (value / 1e6, " M"),
        1e3.. => (value / 1e3, " k"),
        _ => (value, ""),
    };
    // Powers of ten below 1 are not exact in binary.
    format!("{}{unit}", (part * 1e6).round() / 1e6)
}

/// The positions of the names, in the order of the curves, moved up and down so that neighbours do not overlap.
fn apart(mut ends: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_by(|a, b| ends[*a][1].total_cmp(&ends[*b][1]));
    for pair in order.windows(2) {
        let missing = LINE - (ends[pair[1]][1] - ends[pair[0]][1]);
        if missing > 0.0 {
            ends[pair[0]][1] -= 0.5 * missing;
            ends[pair[1]][1] += 0.5 * missing;
        }
    }
    ends
}
