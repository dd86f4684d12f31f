//! Object order, or rasterization: for each object in the scene, for each pixel it may affect.
//!
//! [`textbook`] is the lecture's double loop on one page; [`fast`] gives the same answers sooner.
//! Both say what is seen; [`shade`](fn@shade) gives it its look. [`stream`] draws meshes that
//! are larger than memory. The twin of this crate, `bothways-raytrace`, has the same names with the
//! loops swapped, but no stream: any ray may need any object.

pub mod fast;
mod shade;
pub mod stream;
pub mod textbook;

pub use bothways_common as common;
pub use bothways_common::{Frame, Options, View};
pub use shade::shade;
