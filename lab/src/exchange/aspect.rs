//! How wide the pixels of a camera are.

use crate::common::Camera;

/// How much wider than high a pixel of the camera's image is: 1 for a square.
pub(super) fn pixel_aspect(camera: &Camera) -> f64 {
    let ([vw, vh], [width, height]) = (camera.viewport(), camera.image().map(f64::from));
    vw * height / (vh * width)
}

/// Whether the pixels are squares, as far as a viewport of two `f32` can say it: each of them is rounded by up to 2⁻²⁴.
pub(super) fn has_square_pixels(camera: &Camera) -> bool {
    (pixel_aspect(camera) - 1.0).abs() <= (-22f64).exp2()
}
