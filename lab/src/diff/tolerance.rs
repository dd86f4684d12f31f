//! What two files may differ by, and what of them is left out of the comparison.

use super::aspect::Side;
use crate::common::Crop;
use serde::Serialize;

/// Two depths of one primitive differ if their difference is more than this part of the larger depth.
pub const DEPTH_TOLERANCE: f64 = 1e-5;
/// Two colours differ if their difference is more than this number of the 255 steps of sRGB.
pub const COLOR_TOLERANCE: u8 = 2;
/// Two normals differ if the angle between them is more than this number of degrees. Half-precision floats, in which
/// many programs write normals, turn them by up to 0.03.
pub const NORMAL_TOLERANCE: f64 = 0.1;

/// The largest differences of measured values that still count as equal. Coverage and ids have no tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tolerances {
    /// The part of the larger of two distances.
    pub t: f64,
    /// Degrees between two normals.
    pub normals: f64,
    /// Steps of the 255 of sRGB, in any channel.
    #[serde(rename = "colour")]
    pub color: f32,
}

impl Default for Tolerances {
    fn default() -> Tolerances {
        Tolerances {
            t: DEPTH_TOLERANCE,
            normals: NORMAL_TOLERANCE,
            color: f32::from(COLOR_TOLERANCE),
        }
    }
}

/// How two buffers are compared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CompareOptions {
    /// The differences of measured values that still count as equal.
    pub tolerances: Tolerances,
    /// The number of differing pixels with which a comparison still passes.
    pub allowed_pixels: u64,
    /// The rectangles of pixels that are not compared.
    pub ignored: Vec<Crop>,
    /// Which of the two buffers is known to be right, if one is.
    pub reference: Option<Side>,
    /// Whether nothing is measured and no cause is searched for: counts and classes alone, which take a fraction of the
    /// time.
    pub only_compares: bool,
}
