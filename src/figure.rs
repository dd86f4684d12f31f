//! Figures: what was rendered, arranged to be shown to people.

mod fallback;
mod resize;
mod slide;
mod text;

pub use slide::{SLIDE_SIZE, Slide};
