//! Image order, or ray tracing: for each pixel in the image, for each object its ray may hit.
//!
//! [`textbook`] is the lecture's double loop on one page; [`fast`] gives the same answers sooner.
//! Both say what is seen; [`shade`](fn@shade) gives it its look. The twin of this crate,
//! `bothways-rasterize`, has the same names with the loops swapped.

pub mod fast;
mod shade;
pub mod textbook;

pub use bothways_common as common;
pub use bothways_common::{Frame, Options, View};
pub use shade::shade;
