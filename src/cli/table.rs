//! What `render` prints: a short table of what each order did, and the verdict.

use anstyle::{AnsiColor, Style};
use bothways::common::{Crop, Work};
use bothways::diff::{COLOUR_TOLERANCE, Comparison, DEPTH_TOLERANCE};
use bothways::orders::{Counts, Rendered, Spread, Times};
use bothways::report::Report;
use bothways::wording::{count, grouped, milliseconds, pixels_shown};
use std::fmt::Write;
use std::path::Path;

/// The table, for people.
pub(super) fn table(
    report: &Report,
    rendered: &[Rendered],
    comparison: Option<&Comparison>,
    folder: &Path,
) -> String {
    let mut text = heading(report, rendered);
    for (label, figures) in rows(rendered) {
        line(&mut text, label, &figures);
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
        text += &notes(comparison);
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
    let colour = if matches { AnsiColor::Green } else { AnsiColor::Yellow };
    colour.on_default().bold()
}

const LABEL_WIDTH: usize = 26;
const COLUMN_WIDTH: usize = 18;

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
    let names: Vec<String> = rendered.iter().map(|one| one.order.name().into()).collect();
    line(&mut text, rendered.first().map_or("", |one| one.method.name()), &names);
    text
}

fn line(text: &mut String, label: &str, figures: &[String]) {
    write!(text, "{label:LABEL_WIDTH$}").expect("a string takes all");
    for figure in figures {
        write!(text, "{figure:>COLUMN_WIDTH$}").expect("a string takes all");
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

/// What the verdict does not judge, if it is more than rounding explains.
fn notes(comparison: &Comparison) -> String {
    let mut text = String::new();
    let depth = comparison.depth;
    if depth.differing_pixels > 0 {
        let pixels = count(depth.differing_pixels, "pixels");
        let most = depth.max_relative_difference;
        text += &format!(
            "note: depths differ by more than {DEPTH_TOLERANCE:e} in {pixels}, at most by {most:.1e}\n"
        );
    }
    let colour = comparison.colour;
    if colour.differing_pixels > 0 {
        let pixels = count(colour.differing_pixels, "pixels");
        let most = colour.max_difference;
        text += &format!(
            "note: colours differ by more than {COLOUR_TOLERANCE} of 255 in {pixels}, at most by {most}\n"
        );
    }
    text
}
