//! Films: both orders draw one picture, on one clock of work done.
//!
//! A step of the clock is a pair of a primitive and a sample that is tested, or a box of the hierarchy: what
//! [`Work`](crate::common::Work) counts as `tests` and `nodes`. Frame `k` of `F` shows both pictures after `k/F` of the
//! steps that the longer order takes. So a film shows which order is ahead at each moment; it says nothing about seconds, as a
//! step of one order may take longer than one of the other. Building the hierarchy of image order, and placing vertices
//! and filling bins in object order, are no steps: the counts of work do not have them either.
//!
//! What is shown comes from the loops that render: they run for an observer, which records every change of the stored
//! picture, and where the loops are at each frame. The last frame shows the rendered pictures. For an observer, the fast
//! renderers tell their events tile after tile, whatever the threads, and the fast ray tracer, which walks its hierarchy
//! with many rays at once, walks it with each ray alone: a film shows, as the counts do, what each ray needs.
//!
//! ```
//! use bothways_lab::common::{Camera, CameraDescription, View};
//! use bothways_lab::figure::Theme;
//! use bothways_lab::film::{Film, Length};
//! use bothways_lab::orders::Method;
//! use bothways_lab::scenes;
//!
//! let loaded = scenes::load("canonical")?;
//! let camera = Camera::new(CameraDescription { image: [16, 16], ..loaded.camera })?;
//! let view = View::new(&loaded.scene, &camera);
//! let film = Film::record(&loaded.name, &view, Method::Textbook, Length::new(1.0, 10, 0.5)?)?;
//! let gif = film.write_gif(Vec::new(), Theme::Dark, 480, &mut |_| {})?;
//! assert!(gif.starts_with(b"GIF89a"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod apng;
mod change;
mod code;
mod frames;
mod gif;
mod keeper;
mod length;
mod outlines;
mod palette;
mod recorded;
mod recorder;
mod shots;
mod size;
mod step;
mod steps;
mod track;

pub use frames::Frames;
pub use length::{
    FASTEST_IN_BROWSERS, FRAME_RATES, Length, LengthError, MOST_FRAMES, MOST_SECONDS, rates,
};
pub use outlines::{Lines, outline, outline_of_box};
pub use recorded::Film;
pub use recorder::{Line, Position};
pub use shots::{OrderShot, Shot, Shots};
pub use size::default_size;
pub use step::{Outcome, Run, Step, Tested, Told};
pub use steps::{MOST_FAST_STEPS, MOST_TEXTBOOK_STEPS, Steps, StoredChange, TooManySteps};

use crate::common::View;
use crate::diff::{Comparison, compare_shown};
use crate::figure::{Theme, within};
use crate::orders::{Method, Order};
use crate::wording::grouped;
use image::RgbImage;
use std::io;
use track::Loops;

/// The most steps that one order may take in a film by the textbook: about a minute of work.
const MOST_STEPS: u64 = 1 << 30;
/// The most pixels of a picture in a film: more than 1920 × 1080.
const MOST_PIXELS: u64 = 1 << 21;
/// The narrowest and the widest film.
pub const WIDTHS: [u32; 2] = [480, 3840];
/// The width of a film is a multiple of this: then its height is even, as video needs it.
pub const WIDTH_STEP: u32 = 32;

/// Why there is no film of a scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FilmError {
    /// The loops take too long to be shown.
    #[error(
        "the textbook would take {} steps, {} objects at {} pixels, and a film shows at most {}; {advice}",
        grouped(*.steps), grouped(*.primitives), grouped(*.pixels), grouped(MOST_STEPS)
    )]
    TooManySteps {
        /// The steps of each order.
        steps: u64,
        /// The primitives of the scene.
        primitives: u64,
        /// The pixels of the picture.
        pixels: u64,
        /// What to do.
        advice: String,
    },
    /// Even the fast method takes too long to be shown.
    #[error(
        "the fast method takes {} steps, and a film shows at most {}; take a smaller --size",
        grouped(*.steps), grouped(MOST_STEPS)
    )]
    FastTakesLong {
        /// The steps of the longer order.
        steps: u64,
    },
    /// The picture has too many pixels.
    #[error(
        "a film shows pictures of at most {} pixels, and {}x{} has {}; take a smaller --size",
        grouped(MOST_PIXELS), size[0], size[1], grouped(u64::from(size[0]) * u64::from(size[1]))
    )]
    TooManyPixels {
        /// Width and height.
        size: [u32; 2],
    },
}

impl<'a> Film<'a> {
    /// Renders a view in both orders, one sample a pixel, and records both.
    ///
    /// # Errors
    ///
    /// Each [`FilmError`]: scene or picture are too large.
    pub fn record(
        scene: &str,
        view: &View<'a>,
        method: Method,
        length: Length,
    ) -> Result<Film<'a>, FilmError> {
        check(view, method)?;
        let loops = |order| Loops::new(order, method, *view);
        let (object_order, image_order) =
            rayon::join(|| loops(Order::Object), || loops(Order::Image));
        let longest = object_order.steps.max(image_order.steps);
        if longest > MOST_STEPS {
            return Err(FilmError::FastTakesLong { steps: longest });
        }
        let moments = moments(longest, length.frames());
        let ((by_object, object_order), (by_image, image_order)) =
            rayon::join(|| object_order.record(&moments), || image_order.record(&moments));
        let tracks = [object_order, image_order];
        let pictures = tracks.each_ref().map(|track| &track.picture);
        let comparison = compare_shown([&by_object, &by_image], pictures);
        let mut film = Film {
            scene: scene.into(),
            view: *view,
            method,
            length,
            moments,
            tracks,
            finished: Vec::new(),
            comparison,
        };
        film.finished =
            film.shots([[0; 3]; 2]).map(|shot| shot.orders.map(|order| order.finished)).collect();
        Ok(film)
    }

    /// What each frame shows. Where pixels store nothing yet, there is a chequerboard of the colours `nothing`.
    pub fn shots(&self, nothing: [[u8; 3]; 2]) -> Shots<'_> {
        Shots::new(&self.moments, &self.tracks, nothing)
    }

    /// The frames as pictures of this width.
    ///
    /// # Panics
    ///
    /// If the width is not within [`WIDTHS`], or no multiple of [`WIDTH_STEP`].
    pub fn frames(&self, theme: Theme, width: u32) -> Frames<'_> {
        assert!((WIDTHS[0]..=WIDTHS[1]).contains(&width) && width.is_multiple_of(WIDTH_STEP));
        Frames::new(self, theme, width)
    }

    /// Writes the film as a GIF with a palette of its own, and gives the writer back. `progress` gets the number of
    /// each frame that is written.
    ///
    /// # Errors
    ///
    /// Those of the writer.
    ///
    /// # Panics
    ///
    /// As [`Film::frames`].
    pub fn write_gif<W: io::Write>(
        &self,
        out: W,
        theme: Theme,
        width: u32,
        progress: &mut dyn FnMut(u32),
    ) -> io::Result<W> {
        gif::write(self, out, theme, width, progress)
    }

    /// Writes the film as an animated PNG; programs that do not know these show the finished picture.
    ///
    /// # Errors
    ///
    /// Those of the writer.
    ///
    /// # Panics
    ///
    /// As [`Film::frames`].
    pub fn write_apng<W: io::Write>(
        &self,
        out: W,
        theme: Theme,
        width: u32,
        progress: &mut dyn FnMut(u32),
    ) -> io::Result<()> {
        apng::write(self, out, theme, width, progress)
    }

    /// The comparison of both orders.
    pub fn comparison(&self) -> &Comparison {
        &self.comparison
    }

    /// The length.
    pub fn length(&self) -> Length {
        self.length
    }

    /// All steps of object order and of image order.
    pub fn steps(&self) -> [u64; 2] {
        self.tracks.each_ref().map(|track| track.steps)
    }

    /// The finished pictures of object order and of image order.
    pub fn pictures(&self) -> [&RgbImage; 2] {
        self.tracks.each_ref().map(|track| &track.picture)
    }
}

/// Refuses what would take too long, before it is rendered.
fn check(view: &View, method: Method) -> Result<(), FilmError> {
    let size = view.camera.image();
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    if pixels > MOST_PIXELS {
        return Err(FilmError::TooManyPixels { size });
    }
    let primitives = view.scene.primitive_count();
    let steps = primitives.saturating_mul(pixels);
    if (method == Method::Fast && !view.scene.has_wide_ids()) || steps <= MOST_STEPS {
        return Ok(());
    }
    if view.scene.has_wide_ids() {
        let advice = "film a scene of fewer instances".into();
        return Err(FilmError::TooManySteps { steps, primitives, pixels, advice });
    }
    let smaller = within(size, MOST_STEPS / primitives);
    let fits = smaller.map(|[width, height]| format!(", or a --size of at most {width}x{height}"));
    let advice = format!("take --method fast{}", fits.unwrap_or_default());
    Err(FilmError::TooManySteps { steps, primitives, pixels, advice })
}

/// The clock at each of so many frames: the last shows all.
fn moments(longest: u64, frames: u32) -> Vec<u64> {
    let at = |frame: u32| u128::from(longest) * u128::from(frame) / u128::from(frames);
    (1..=frames).map(|frame| u64::try_from(at(frame)).expect("a part of the steps")).collect()
}

#[cfg(test)]
mod tests;
