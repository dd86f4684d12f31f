//! Why a camera is refused.

use super::wording::{readable, readable_vector};
use crate::raster::SizeError;
use glam::Vec3;

/// Why a camera is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// A coordinate is NaN or infinite.
    #[error("{what} has a coordinate that is not finite: {value}; give three finite numbers")]
    NotFinite {
        /// Which vector.
        what: &'static str,
        /// As it was given.
        value: Vec3,
    },
    /// A direction has no length.
    #[error("{what} is zero and so has no direction; give a vector with a length")]
    NoDirection {
        /// Which vector.
        what: &'static str,
    },
    /// The target of the view is the eye.
    #[error("the eye {} is the point it looks at; move one of them", readable_vector(*.eye))]
    LooksAtItself {
        /// The eye.
        eye: Vec3,
    },
    /// The up vector says nothing about which way is up.
    #[error("up {} runs along the direction of view; choose another up", readable_vector(*.up))]
    UpAlongView {
        /// As it was given.
        up: Vec3,
    },
    /// `u`, `v`, `w` are not a camera frame.
    #[error(
        "u, v, w are not a right-handed perpendicular frame: {reason}; \
         give look_at (or direction) and up instead, and the frame is computed"
    )]
    NotAFrame {
        /// What is wrong with them.
        reason: &'static str,
    },
    /// `d`, `vw` or `vh` is out of range.
    #[error(
        "{what} is {}; it must be between 2^-64 and 2^64 (5.4e-20 to 1.8e19)",
        readable(*.value)
    )]
    OutOfRange {
        /// Which length.
        what: &'static str,
        /// As it was given.
        value: f32,
    },
    /// The field of view is too close to 180 degrees.
    #[error(
        "the viewport is {} x {} at distance {}; \
         its sides may be at most 2^20 (about 1e6) times the distance",
        readable(*.width), readable(*.height), readable(*.distance)
    )]
    TooWide {
        /// The viewport's width.
        width: f32,
        /// The viewport's height.
        height: f32,
        /// The distance from the eye.
        distance: f32,
    },
    /// The field of view is no angle that a flat viewport can have.
    #[error(
        "the field of view is {} degrees; it must be greater than 0 and less than 180",
        readable(*.degrees)
    )]
    FieldOfView {
        /// As it was given.
        degrees: f32,
    },
    /// A parallel camera is asked for a field of view.
    #[error(
        "a parallel camera has no field of view, as its rays never part; give a viewport instead"
    )]
    ParallelFieldOfView,
    /// The image has no size that a picture can have.
    #[error(transparent)]
    Size(#[from] SizeError),
}
