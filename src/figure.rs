//! Figures: rendered pictures, arranged for readers.

mod fallback;
mod resize;
mod slide;
mod text;

pub use slide::{SLIDE_SIZE, Slide};
