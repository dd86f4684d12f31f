//! How far depths and colours may lie apart.

/// Two depths of one primitive differ beyond this part of the larger.
pub const DEPTH_TOLERANCE: f64 = 1e-5;
/// Two colours differ beyond this many of the 255 steps of sRGB.
pub const COLOR_TOLERANCE: u8 = 2;
