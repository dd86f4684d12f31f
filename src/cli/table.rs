//! The output of `render`: a short table of what each order needs, executes and takes, and the verdict.

use anstyle::{AnsiColor, Style};
use bothways::common::{Crop, Executed, Work};
use bothways::diff::{COLOR_TOLERANCE, Comparison, DEPTH_TOLERANCE};
use bothways::orders::{Counts, Rendered, Spread, Times};
use bothways::report::Report;
use bothways::wording::{count, grouped, milliseconds, pixels_shown};
use std::fmt::Write;
use std::path::Path;

/// The table for readers.
pub(super) fn table(
    report: &Report,
    rendered: &[Rendered],
    comparison: Option<&Comparison>,
    folder: &Path,
) -> String {
    let names: Vec<String> = rendered.iter().map(Rendered::name).collect();
    let wide = column_width(&names);
    let mut text = heading(report, rendered);
    let method = rendered.first().map_or("", |one| one.method.name());
    line(&mut text, method, &names, wide);
    line(&mut text, "samples covered", &each(rendered, |one| grouped(one.covered())), wide);
    for (heading, rows) in sections(rendered) {
        writeln!(text, "{heading}").expect("a string takes all");
        for (label, figures) in rows {
            line(&mut text, &format!("  {label}"), &figures, wide);
        }
    }
    for (label, figures) in times(rendered) {
        line(&mut text, label, &figures, wide);
    }
    if let Some(comparison) = comparison {
        text += &beyond_tolerance(comparison, wide);
    }
    text.push('\n');
    for one in rendered {
        if let Counts::TooMany { most } = one.work {
            let (order, most) = (one.order.name(), grouped(most));
            text += &format!(
                "note: the work of {order} was not counted: it is more than {most} steps \
                 (--no-counts does not try)\n"
            );
        }
    }
    if let Some(comparison) = comparison {
        let style = verdict_style(comparison.matches());
        text += &format!("{style}{}{style:#}\n", comparison.verdict());
    }
    let dimmed = Style::new().dimmed();
    if let Some(verified) = &report.verified {
        let style = verdict_style(verified.matches);
        text += &format!("{style}{}{style:#}\n", verified.verdict());
        text += &format!("{dimmed}of these samples {}{dimmed:#}\n", verified.places());
    }
    text += &format!("{dimmed}written to {}{dimmed:#}\n", folder.display());
    text
}

fn verdict_style(matches: bool) -> Style {
    let color = if matches { AnsiColor::Green } else { AnsiColor::Yellow };
    color.on_default().bold()
}

const LABEL_WIDTH: usize = 28;
const COLUMN_WIDTH: usize = 18;

/// The width of every column; rules make the names longer.
fn column_width(names: &[String]) -> usize {
    let longest = names.iter().map(String::len).max().unwrap_or(0);
    COLUMN_WIDTH.max(longest + 2)
}

fn heading(report: &Report, rendered: &[Rendered]) -> String {
    let bold = Style::new().bold();
    let pixels = pixels_shown(report.size, report.crop.map(Crop::from), "x");
    let samples = match report.samples {
        1 => "1 sample a pixel".into(),
        n => format!("{n} x {n} samples a pixel"),
    };
    let primitives = count(report.primitives, "primitives");
    let mut text = format!("{bold}{}{bold:#}: {primitives}, {pixels}, {samples}", report.scene);
    if rendered.iter().any(|one| one.times.is_some()) {
        text += ", ";
        text += &count(report.threads as u64, "threads");
    }
    text += "\n\n";
    text
}

fn line(text: &mut String, label: &str, figures: &[String], wide: usize) {
    write!(text, "{label:LABEL_WIDTH$}").expect("a string takes all");
    for figure in figures {
        write!(text, "{figure:>wide$}").expect("a string takes all");
    }
    text.push('\n');
}

/// A label, and a figure for each order.
type Row = (&'static str, Vec<String>);

fn each(rendered: &[Rendered], figure: impl Fn(&Rendered) -> String) -> Vec<String> {
    rendered.iter().map(figure).collect()
}

/// The rows under their headings. The two sorts of counts never stand under one.
fn sections(rendered: &[Rendered]) -> Vec<(&'static str, Vec<Row>)> {
    let mut sections = Vec::new();
    if rendered.iter().any(|one| one.work().is_some()) {
        sections.push((ALGORITHM, work(rendered)));
    }
    if rendered.iter().any(|one| one.executed.is_some()) {
        sections.push((EXECUTED, executed(rendered)));
    }
    sections
}

const ALGORITHM: &str = "work of the algorithm, for each primitive or ray alone";
const EXECUTED: &str = "executed for a frame, by tiles";

fn work(rendered: &[Rendered]) -> Vec<Row> {
    let row =
        |label, figure: fn(&Work) -> u64| counts(label, rendered, |one| one.work().map(figure));
    vec![
        row("primitives", |work| work.primitives),
        row("rays", |work| work.rays),
        row("boxes tested", |work| work.nodes),
        row("primitive x sample tested", |work| work.tests),
        row("of these, covered", |work| work.fragments),
        row("depth comparisons", |work| work.depth_tests),
        row("left to the exact judge", |work| work.judged_coverage + work.judged_nearest),
    ]
}

fn executed(rendered: &[Rendered]) -> Vec<Row> {
    let row = |label, figure: fn(&Executed) -> u64| {
        counts(label, rendered, |one| one.executed.as_ref().map(figure))
    };
    vec![
        row("tiles", |executed| executed.tiles),
        row("of these, skipped", |executed| executed.tiles_skipped),
        row("nodes opened", |executed| executed.nodes_opened),
        row("boxes tested", |executed| executed.boxes_tested),
        row("clusters in tiles", |executed| executed.clusters),
        row("of these, skipped", |executed| executed.clusters_skipped),
        row("triangles looked at", |executed| executed.triangles),
        row("of these, set up", |executed| executed.set_ups),
        row("primitives one by one", |executed| executed.one_by_one),
        row("steps of 8 or 16 lanes", |executed| executed.lane_steps),
        row("blocks of 16 samples", |executed| executed.blocks),
        row("samples one by one", |executed| executed.single_samples),
    ]
}

fn counts(
    label: &'static str,
    rendered: &[Rendered],
    count: impl Fn(&Rendered) -> Option<u64>,
) -> Row {
    let figures = each(rendered, |one| match count(one) {
        None => "not counted".into(),
        Some(0) => "-".into(),
        Some(number) => grouped(number),
    });
    (label, figures)
}

fn times(rendered: &[Rendered]) -> Vec<Row> {
    if rendered.iter().all(|one| one.times.is_none()) {
        return vec![];
    }
    let row = |label, figure: fn(&Times) -> Spread| {
        let time = |times| milliseconds(figure(&times).median);
        (label, each(rendered, |one| one.times.map_or("-".into(), time)))
    };
    vec![
        row("time to prepare", |times| times.prepare),
        row("time for visibility", |times| times.visibility),
        row("time for shading", |times| times.shading),
    ]
}

/// The differences that the verdict ignores, if they are more than rounding explains: one row of the table each.
fn beyond_tolerance(comparison: &Comparison, wide: usize) -> String {
    let style = AnsiColor::Yellow.on_default();
    let mut text = String::new();
    let mut row = |label: String, pixels: u64, most: String| {
        if pixels > 0 {
            let figure = format!("{}, by at most {most}", count(pixels, "pixels"));
            let wide = 2 * wide;
            writeln!(text, "{style}{label:LABEL_WIDTH$}{figure:>wide$}{style:#}")
                .expect("a string takes all");
        }
    };
    let depth = comparison.depth;
    let most = format!("{:.1e}", depth.max_relative_difference);
    row(format!("depths beyond {DEPTH_TOLERANCE:e}"), depth.differing_pixels, most);
    let color = comparison.color;
    let most = format!("{} of 255", color.max_difference);
    row(format!("colours beyond {COLOR_TOLERANCE} of 255"), color.differing_pixels, most);
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways::common::{Camera, Frame, Options};
    use bothways::diff::{Color, Depth, compare};

    #[test]
    fn what_is_beyond_tolerance_has_its_rows() {
        let nothing = Frame::new(&Camera::canonical(2, 2), &Options::default());
        let mut comparison = compare(&nothing, &nothing);
        assert_eq!(beyond_tolerance(&comparison, COLUMN_WIDTH), "");
        comparison.depth = Depth { max_relative_difference: 0.5, differing_pixels: 1 };
        comparison.color = Color { max_difference: 108, differing_pixels: 12_345 };
        let plain =
            anstream::adapter::strip_str(&beyond_tolerance(&comparison, COLUMN_WIDTH)).to_string();
        assert_eq!(
            plain,
            "depths beyond 1e-5                    1 pixel, by at most 5.0e-1\n\
             colours beyond 2 of 255     12,345 pixels, by at most 108 of 255\n"
        );
        assert!(comparison.matches());
    }
}
