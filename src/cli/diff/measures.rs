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
    let lines = rows.iter().map(|[label, value]| format!("{label:30}{value:>14}\n"));
    lines.collect::<String>() + "\n"
}

fn of_coverage(coverage: &CoverageMeasures) -> Vec<[String; 2]> {
    let CoverageMeasures { intersection_over_union, largest_border_distance, .. } = coverage;
    let overlap = match intersection_over_union {
        Some(part) => rounded_down(*part, 4),
        None => "no evidence: neither covers anything".into(),
    };
    let mut rows = vec![["intersection over union".to_owned(), overlap]];
    rows.extend(largest_border_distance.map(|farthest| {
        let [i, j] = farthest.at;
        let pixels = short(farthest.pixels);
        ["farthest from the other mask".to_owned(), format!("{pixels} px, at ({i}, {j})")]
    }));
    rows
}

fn of_color(color: &ColorMeasures) -> Vec<[String; 2]> {
    let [mean, rms] =
        [color.mean_difference, color.rms_difference].map(|steps| format!("{}/255", short(steps)));
    let psnr = color.psnr.map_or("infinite".into(), |psnr| format!("{psnr:.2} dB"));
    let mut rows = vec![
        ["mean difference in colour".to_owned(), mean],
        ["root mean square".to_owned(), rms],
        ["PSNR".to_owned(), psnr],
    ];
    rows.extend(color.ssim.map(|ssim| ["SSIM".to_owned(), rounded_down(ssim, 4)]));
    rows
}

/// Three decimals at most.
fn short(number: f64) -> String {
    let decimals = format!("{number:.3}");
    let without_zeros = decimals.trim_end_matches('0').trim_end_matches('.');
    if number > 0.0 && without_zeros == "0" { "below 0.001".into() } else { without_zeros.into() }
}

/// A part of 1 with decimals; nothing but 1 itself is shown as 1.
fn rounded_down(part: f64, decimals: i32) -> String {
    let scale = 10.0_f64.powi(decimals);
    let part = (part * scale).floor() / scale;
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
        let shown = [1.0, 0.999_999, 0.5, -0.1].map(|part| rounded_down(part, 4));
        assert_eq!(shown, ["1", "0.9999", "0.5000", "-0.1000"]);
    }
}
