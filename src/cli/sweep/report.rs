//! The table of a sweep: how each renderer grows, and where the orders cross.

use anstyle::{AnsiColor, Style};
use bothways::orders::{Method, Order};
use bothways::sweep::{Quantity, Slope, Summary, short};
use std::path::Path;

/// Times of one point that differ by more than this factor from round to round are not of a quiet machine.
const BUSY: f64 = 1.25;

/// The table for readers.
pub(super) fn text(summaries: &[Summary], folder: &Path) -> String {
    let mut text = String::new();
    for summary in summaries {
        text += &chart(summary);
    }
    let spread = summaries.iter().filter_map(Summary::spread).fold(1.0, f64::max);
    if spread > BUSY {
        let yellow = AnsiColor::Yellow.on_default();
        text += &format!(
            "{yellow}times of one point differ by a factor of {spread:.1} from round to round: this machine is \
             busy, so that small differences tell nothing{yellow:#}\n"
        );
    }
    let dimmed = Style::new().dimmed();
    text + &format!("{dimmed}written to {}{dimmed:#}\n", folder.display())
}

fn chart(summary: &Summary) -> String {
    let bold = Style::new().bold();
    let quantity = match summary.quantity {
        Quantity::Steps => "steps",
        Quantity::Milliseconds => "milliseconds",
    };
    let (axis, scene) = (summary.axis.name(), summary.axis.scene());
    let mut text = format!("{bold}{quantity} against {axis}{bold:#}: {scene}\n");
    for curve in &summary.curves {
        let name = format!("{}, {}", curve.order.name(), curve.method.name());
        let (Some(first), Some(last)) = (curve.points.first(), curve.points.last()) else {
            continue;
        };
        let ends = format!(
            "{} at {}, {} at {}",
            value(first.value),
            short(digits(first.x)),
            value(last.value),
            short(digits(last.x))
        );
        text += &format!("  {name:24}{:24}{ends}\n", slope(curve.slope));
    }
    let methods = [Method::Fast, Method::Textbook].into_iter().filter(|method| {
        let has = |order| {
            summary.curves.iter().any(|curve| (curve.order, curve.method) == (order, *method))
        };
        Order::ALL.into_iter().all(has)
    });
    for method in methods {
        text += &format!("  {}: {}\n", method.name(), summary.says(method));
    }
    text + "\n"
}

fn slope(slope: Option<Slope>) -> String {
    match slope {
        None => "too few points".into(),
        Some(Slope { value, error, .. }) => {
            let value = if value.abs() < 0.005 { 0.0 } else { value };
            format!("slope {value:.2} ± {error:.2}")
        }
    }
}

/// A value with three digits that count.
fn value(value: f64) -> String {
    short(digits(value))
}

fn digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
