//! Several samples a pixel: each is looked at as a pixel of its own.

use crate::common::{Camera, CameraDescription};

/// The camera whose image has each sample of a pixel as a pixel of its own, `samples` × `samples` for each; `None` if the
/// image would be too large. [`Buffer::samples_as_pixels`](crate::diff::foreign::Buffer::samples_as_pixels) is what it
/// sees.
///
/// ```
/// use bothways_lab::common::Camera;
/// use bothways_lab::diff::why::camera_of_samples;
///
/// let fine = camera_of_samples(&Camera::canonical(3, 4), 2).expect("it is small");
/// assert_eq!(fine.image(), [8, 6]);
/// // The first sample of a pixel lies a quarter of it from its corner.
/// assert_eq!(fine.sample_grid(1).x(), Camera::canonical(3, 4).sample_grid(2).x());
/// ```
pub fn camera_of_samples(camera: &Camera, samples: u32) -> Option<Camera> {
    let [width, height] = camera.image();
    let image = [width.checked_mul(samples)?, height.checked_mul(samples)?];
    Camera::new(CameraDescription { image, ..*camera.description() }).ok()
}
