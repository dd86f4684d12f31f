//! Figures: rendered pictures, arranged for readers.

mod fallback;
mod legend;
mod resize;
mod slide;
mod text;

pub use legend::{Entry, with_legend};
pub use slide::{SLIDE_SIZE, Slide};
