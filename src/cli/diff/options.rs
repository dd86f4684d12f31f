//! The options of `diff` that say what counts as equal.

use crate::cli::args::crop;
use bothways::common::Crop;
use bothways::diff::foreign::{BufferComparison, CompareOptions, Side, Tolerances};
use bothways::wording::{count, grouped};
use clap::Args;

/// What counts as equal.
#[derive(Debug, Args)]
#[command(next_help_heading = "What counts as equal")]
pub(in crate::cli) struct ComparisonArgs {
    /// Distances are equal within this part of the larger one [default: 1e-5]
    #[arg(long, value_name = "X", value_parser = tolerance, allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// Colours are equal within so many of the 255 steps of sRGB, in each channel [default: 2]
    #[arg(long, value_name = "STEPS", value_parser = steps, allow_negative_numbers = true)]
    color_tolerance: Option<f32>,
    /// Normals are equal within this angle [default: 0.1]
    #[arg(long, value_name = "DEGREES", value_parser = degrees, allow_negative_numbers = true)]
    normal_tolerance: Option<f64>,
    /// Files are equal enough, with exit code 0, if no more pixels than this differ
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = pixels,
          hide_default_value = true, allow_negative_numbers = true)]
    allow_pixels: u64,
    /// Leave the pixels of a rectangle out of the comparison; may be given several times
    #[arg(long, value_name = "ROW,COLUMN,HEIGHT,WIDTH", value_parser = crop,
          allow_hyphen_values = true)]
    ignore: Vec<Crop>,
}

impl ComparisonArgs {
    /// The same for the library; `reference` is the file that is known to be right.
    pub(in crate::cli) fn options(&self, reference: Option<Side>) -> CompareOptions {
        let usual = Tolerances::default();
        let tolerances = Tolerances {
            t: self.tolerance.unwrap_or(usual.t),
            normals: self.normal_tolerance.unwrap_or(usual.normals),
            color: self.color_tolerance.unwrap_or(usual.color),
        };
        CompareOptions {
            tolerances,
            allowed_pixels: self.allow_pixels,
            ignored: self.ignore.clone(),
            reference,
            only_compares: false,
        }
    }
}

/// `ignored: 12 pixels, of the rectangle 0,0,3,4`, if any pixels are.
pub(super) fn ignored(comparison: &BufferComparison) -> Option<String> {
    let rectangles: Vec<String> =
        comparison.ignored.iter().map(|&crop| Crop::from(crop).to_string()).collect();
    let things = if rectangles.len() == 1 { "rectangle" } else { "rectangles" };
    let pixels = count(comparison.ignored_pixels, "pixels");
    let rectangles = rectangles.join(" and ");
    (comparison.ignored_pixels > 0)
        .then(|| format!("ignored: {pixels}, of the {things} {rectangles}"))
}

/// How many pixels differ, of how many, and how many may: `3 pixels of 384`.
pub(super) fn differing(comparison: &BufferComparison) -> String {
    let pixels = count(comparison.differing_pixels, "pixels");
    let all: u64 = comparison.size.map(u64::from).iter().product();
    let (all, compared) = match comparison.ignored_pixels {
        0 => (all, ""),
        ignored => (all - ignored, " compared"),
    };
    let allowed = grouped(comparison.allowed_pixels);
    let allowed = match comparison.allowed_pixels {
        0 => String::new(),
        _ if comparison.passes => format!(" ({allowed} may)"),
        _ => format!(" (only {allowed} may)"),
    };
    format!("{pixels} of {}{compared}{allowed}", grouped(all))
}

/// A tolerance in a few characters: `1e-5`, `0`.
pub(super) fn short(tolerance: f64) -> String {
    let [plain, scientific] = [tolerance.to_string(), format!("{tolerance:e}")];
    if plain.len() <= 4 { plain } else { scientific }
}

/// A number from 0.
fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if (0.0..f64::INFINITY).contains(&number) => Ok(number),
        _ => Err("give a number from 0, such as 1e-4 for a ten-thousandth of the distance".into()),
    }
}

fn steps(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(number) if (0.0..f32::INFINITY).contains(&number) => Ok(number),
        _ => Err("give a number from 0; 255 is the difference of black and white".into()),
    }
}

fn degrees(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if (0.0..=180.0).contains(&number) => Ok(number),
        _ => Err("give an angle from 0 to 180 degrees".into()),
    }
}

fn pixels(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| "give a whole number of pixels, from 0".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_are_short() {
        assert_eq!(
            [1e-5, 1e-3, 0.0, 0.25, 2.0, 1.0 / 3.0].map(short).join(" "),
            "1e-5 1e-3 0 0.25 2 3.333333333333333e-1"
        );
    }

    #[test]
    fn tolerances_are_numbers_from_0() {
        assert_eq!((tolerance("1e-4"), steps("0"), pixels("12")), (Ok(1e-4), Ok(0.0), Ok(12)));
        assert_eq!(degrees("180"), Ok(180.0));
        for bad in ["-1", "180.5", "x"] {
            assert!(degrees(bad).is_err(), "{bad}");
        }
        for bad in ["-1", "NaN", "inf", "x", "", "1e999"] {
            assert!(
                tolerance(bad).is_err() && steps(bad).is_err() && pixels(bad).is_err(),
                "{bad}"
            );
        }
    }
}
