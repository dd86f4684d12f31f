//! Why a camera cannot be written for a system.

use super::aspect::pixel_aspect;
use super::system::System;
use crate::common::Camera;
use crate::wording::readable;
use thiserror::Error;

/// Why a camera cannot be written for a system: that system cannot express it, or the stated depths are none.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ExchangeError {
    /// The system knows central projections alone.
    #[error(
        "{} has no parallel camera: all its rays meet in one point; --projection perspective gives it one that sees \
         what is looked at in the same size",
        system.name()
    )]
    Parallel {
        /// Which system.
        system: System,
    },
    /// The system's perspective camera has square pixels alone.
    #[error(
        "{}'s perspective camera has square pixels, but a viewport of {} x {} makes those of an image of {width}x{height} \
         {} times as wide as high; --viewport {},{} makes them square",
        system.name(), readable(viewport[0]), readable(viewport[1]), rounded(*aspect),
        readable(*square), readable(viewport[1])
    )]
    NotSquare {
        /// Which system.
        system: System,
        /// `vw` and `vh`.
        viewport: [f32; 2],
        /// `W`.
        width: u32,
        /// `H`.
        height: u32,
        /// A pixel's width over its height.
        aspect: f64,
        /// The `vw` that makes pixels square.
        square: f32,
    },
    /// Pixels that are longer than the system has them.
    #[error(
        "Blender has pixels of up to 200 times as wide as high, or as high as wide, and these are {} times as wide as \
         high; make --viewport or --size more like the other",
        rounded(*aspect)
    )]
    LongPixels {
        /// A pixel's width over its height.
        aspect: f64,
    },
    /// An image that is smaller than the system has them.
    #[error(
        "Blender's images have at least 4x4 pixels, and this one has {width}x{height}; give a larger --size"
    )]
    SmallImage {
        /// `W`.
        width: u32,
        /// `H`.
        height: u32,
    },
    /// The system has neither a near nor a far plane.
    #[error("{} has no near and no far plane; leave --near and --far out", system.name())]
    NoDepths {
        /// Which system.
        system: System,
    },
    /// A near plane at or before the least depth that is possible.
    #[error("the near plane is at {near}, but {what}; give a larger --near")]
    Near {
        /// The stated depth.
        near: f64,
        /// What depth it needs, and why.
        what: &'static str,
    },
    /// A depth that is no number, or infinite.
    #[error(
        "the {plane} plane is at {depth}, which is no finite number; leave --far out where it is endless"
    )]
    NotFinite {
        /// `near` or `far`.
        plane: &'static str,
        /// The stated depth.
        depth: f64,
    },
    /// A far plane that does not lie behind the near plane.
    #[error(
        "the far plane at {far} does not lie behind the near plane at {near}; give a larger --far or a smaller --near"
    )]
    Far {
        /// The depth of the near plane.
        near: f64,
        /// The depth of the far plane.
        far: f64,
    },
}

impl ExchangeError {
    pub(super) fn not_square(system: System, camera: &Camera) -> ExchangeError {
        let [width, height] = camera.image();
        ExchangeError::NotSquare {
            system,
            viewport: camera.description().viewport,
            width,
            height,
            aspect: pixel_aspect(camera),
            square: camera.description().width_of_square_pixels(),
        }
    }
}

/// Four digits, for people.
fn rounded(number: f64) -> String {
    let digits: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    digits.to_string()
}
