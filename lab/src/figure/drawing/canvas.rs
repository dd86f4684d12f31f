//! The canvas of every drawing.

/// The canvas's width and height in units; in a picture of this size a unit is a pixel.
pub const CANVAS: [f64; 2] = [1920.0, 1080.0];
