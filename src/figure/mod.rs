//! Figures: what was rendered, arranged to be shown to people.

mod resize;
mod slide;
mod text;

pub use slide::{SLIDE_SIZE, Slide};
