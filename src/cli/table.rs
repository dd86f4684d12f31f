//! The output of `render`: a short table of the work of each order, and the verdict.

use anstyle::{AnsiColor, Style};
use bothways::common::{Crop, Work};
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
    for (label, figures) in rows(rendered) {
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

const LABEL_WIDTH: usize = 26;
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
    let primitives = count(report.primitives.into(), "primitives");
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

fn rows(rendered: &[Rendered]) -> Vec<(&'static str, Vec<String>)> {
    let each =
        |figure: &dyn Fn(&Rendered) -> String| rendered.iter().map(figure).collect::<Vec<_>>();
    let counts = |figure: fn(&Work) -> u64| {
        each(&|one| match one.work().map(figure) {
            None => "not counted".into(),
            Some(0) => "-".into(),
            Some(number) => grouped(number),
        })
    };
    let mut rows = vec![("samples covered", each(&|one| grouped(one.covered())))];
    if rendered.iter().any(|one| one.work().is_some()) {
        rows.extend([
            ("primitives", counts(|work| work.primitives)),
            ("rays", counts(|work| work.rays)),
            ("boxes tested", counts(|work| work.nodes)),
            ("primitive x sample tested", counts(|work| work.tests)),
            ("of these, covered", counts(|work| work.fragments)),
            ("depth comparisons", counts(|work| work.depth_tests)),
            ("left to the exact judge", counts(|work| work.judged_coverage + work.judged_nearest)),
        ]);
    }
    let times = |figure: fn(&Times) -> Spread| {
        each(&|one| one.times.map_or("-".into(), |times| milliseconds(figure(&times).median)))
    };
    if rendered.iter().any(|one| one.times.is_some()) {
        rows.push(("time to prepare", times(|times| times.prepare)));
        rows.push(("time for visibility", times(|times| times.visibility)));
        rows.push(("time for shading", times(|times| times.shading)));
    }
    rows
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
            "depths beyond 1e-5                  1 pixel, by at most 5.0e-1\n\
             colours beyond 2 of 255   12,345 pixels, by at most 108 of 255\n"
        );
        assert!(comparison.matches());
    }
}
