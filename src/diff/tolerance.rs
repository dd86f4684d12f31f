//! The tolerances for depths and colours.

/// Two depths of one primitive differ if their difference is more than this part of the larger depth.
pub const DEPTH_TOLERANCE: f64 = 1e-5;
/// Two colours differ if their difference is more than this number of the 255 steps of sRGB.
pub const COLOR_TOLERANCE: u8 = 2;
