//! What a figure is drawn of, and why it cannot be drawn.

use super::theme::Theme;
use crate::common::{Camera, CameraDescription, Frame, Options, View};
use crate::orders::Rules;
use crate::picture::picture;
use crate::rasterize;
use crate::wording::count;
use image::RgbImage;
use thiserror::Error;

/// What a figure is drawn of, and how.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// The scene's name.
    pub name: &'a str,
    /// The scene in one line.
    pub about: Option<&'a str>,
    /// The scene and its camera.
    pub view: View<'a>,
    /// The pixels to look at, the most important one first; where there are none, the figure chooses telling ones.
    pub pixels: &'a [[u32; 2]],
    /// Samples along a side of a pixel, where a figure shows samples.
    pub samples: u32,
    /// The rules of both orders, where a figure compares them.
    pub rules: Rules,
    /// The colours.
    pub theme: Theme,
}

/// Why a figure cannot be drawn. The message says what to do.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct FigureError(pub(crate) String);

impl FigureError {
    pub(crate) fn new(message: impl Into<String>) -> FigureError {
        FigureError(message.into())
    }
}

impl Subject<'_> {
    /// The chosen pixel that matters most.
    pub(crate) fn pixel(&self) -> Option<[u32; 2]> {
        self.pixels.first().copied()
    }

    /// Checks that the image has the chosen pixels.
    pub(crate) fn check(&self) -> Result<(), FigureError> {
        let [width, height] = self.view.camera.image();
        for [i, j] in self.pixels {
            if *i >= height || *j >= width {
                return Err(FigureError::new(format!(
                    "there is no pixel ({i}, {j}) in an image of {width}x{height}: rows go from 0 to {}, columns \
                     from 0 to {}",
                    height - 1,
                    width - 1
                )));
            }
        }
        Ok(())
    }

    /// The scene in one line, with the numbers that matter for pictures.
    pub(crate) fn facts(&self) -> String {
        let [width, height] = self.view.camera.image();
        let primitives = count(self.view.scene.primitive_count(), "primitives");
        format!("{}   ·   {primitives}   ·   {width} × {height} pixels", self.name)
    }

    /// What is seen, one sample a pixel.
    pub(crate) fn frame(&self) -> Frame {
        seen(&self.view, &Options::default())
    }
}

/// What is seen, shaded.
pub(crate) fn seen(view: &View, options: &Options) -> Frame {
    rasterize::fast::render(&rasterize::fast::prepare(view.scene), view, options)
}

/// The camera with a smaller image.
pub(crate) fn with_image(camera: &Camera, image: [u32; 2]) -> Camera {
    Camera::new(CameraDescription { image, ..*camera.description() })
        .expect("a smaller image is allowed")
}

/// The picture of a view in at most so many pixels along a side, with the form of its image.
pub(crate) fn small_picture(view: &View, most: u32) -> RgbImage {
    picture(&small_frame(view, most))
}

/// The rendered frame of an image that is at most so long on its longer side.
pub(crate) fn small_frame(view: &View, most: u32) -> Frame {
    let image = view.camera.image();
    let longest = image[0].max(image[1]);
    if longest <= most {
        return seen(view, &Options::default());
    }
    let side = |side: u32| {
        let scaled = (u64::from(side) * u64::from(most)).div_ceil(longest.into());
        u32::try_from(scaled).expect("smaller than it was").max(1)
    };
    let camera = with_image(view.camera, image.map(side));
    seen(&View::new(view.scene, &camera), &Options::default())
}
