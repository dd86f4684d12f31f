//! What is measured.

use super::color::ColorMeasures;
use super::distance::BorderDistance;
use serde::Serialize;

/// The measures of a comparison; `None` for an aspect that was not compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Measures {
    /// How far the masks are apart.
    pub coverage: Option<CoverageMeasures>,
    /// How far the colours are apart.
    #[serde(rename = "colour")]
    pub color: Option<ColorMeasures>,
}

/// How far two masks are apart.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CoverageMeasures {
    /// The number of pixels with a sample that only one of the two covers.
    pub differing_pixels: u64,
    /// What both cover as a part of what any of the two covers, in the unit of the counts; `None` if neither covers
    /// anything, for then there is no evidence of any agreement.
    pub intersection_over_union: Option<f64>,
    /// The differing pixel that is farthest from the other mask; `None` if no pixel differs, or the other mask is
    /// empty.
    pub largest_border_distance: Option<BorderDistance>,
}
