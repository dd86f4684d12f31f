//! The measures of a comparison, in words.

use bothways::diff::foreign::{BufferComparison, ColorMeasures, CoverageMeasures};

/// A line for each measure, and an empty line after them.
pub(super) fn text(comparison: &BufferComparison) -> String {
    let mut rows = Vec::new();
    if let Some(coverage) = &comparison.measures.coverage {
        rows.extend(of_coverage(coverage));
    }
    if let Some(color) = &comparison.measures.color {
        rows.extend(of_color(color));
    }
    if rows.is_empty() {
        return String::new();
    }
    let line = |[label, value, more]: &[String; 3]| format!("{label:30}{value:>14}{more}\n");
    let lines = rows.iter().map(line);
    lines.collect::<String>() + "\n"
}

fn of_coverage(coverage: &CoverageMeasures) -> Vec<[String; 3]> {
    let CoverageMeasures { intersection_over_union, largest_border_distance, .. } = coverage;
    let overlap = match intersection_over_union {
        Some(part) => rounded_down(*part),
        None => "no evidence: neither covers anything".into(),
    };
    let mut rows = vec![row("intersection over union", overlap)];
    rows.extend(largest_border_distance.map(|farthest| {
        let [i, j] = farthest.at;
        let pixels = format!("{} px", short(farthest.pixels));
        ["farthest from the other mask".to_owned(), pixels, format!(", at ({i}, {j})")]
    }));
    rows
}

fn of_color(color: &ColorMeasures) -> Vec<[String; 3]> {
    let [mean, rms] =
        [color.mean_difference, color.rms_difference].map(|steps| format!("{}/255", short(steps)));
    let psnr = color.psnr.map_or("infinite".into(), |psnr| format!("{psnr:.2} dB"));
    let mut rows = vec![
        row("mean difference in colour", mean),
        row("root mean square", rms),
        row("PSNR", psnr),
    ];
    rows.extend(color.ssim.map(|ssim| row("SSIM", rounded_down(ssim))));
    rows
}

fn row(label: &str, value: String) -> [String; 3] {
    [label.to_owned(), value, String::new()]
}

/// Three decimals at most.
fn short(number: f64) -> String {
    let decimals = format!("{number:.3}");
    let without_zeros = decimals.trim_end_matches('0').trim_end_matches('.');
    if number > 0.0 && without_zeros == "0" { "below 0.001".into() } else { without_zeros.into() }
}

/// A part of 1 with four decimals; nothing but 1 itself is shown as 1.
fn rounded_down(part: f64) -> String {
    let part = (part * 1e4).floor() / 1e4;
    if part == 1.0 { "1".into() } else { format!("{part:.4}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let shown = [0.0, 1.0, 10.0, 13.0_f64.sqrt(), 1e-9].map(short);
        assert_eq!(shown, ["0", "1", "10", "3.606", "below 0.001"]);
    }

    #[test]
    fn only_1_looks_like_1() {
        let shown = [1.0, 0.999_999, 0.5, -0.1].map(rounded_down);
        assert_eq!(shown, ["1", "0.9999", "0.5000", "-0.1000"]);
    }
}
