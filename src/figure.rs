//! Figures: rendered pictures, arranged for readers.

mod drawing;
mod fallback;
mod legend;
mod resize;
mod slide;
mod text;
mod theme;

pub use drawing::{CANVAS, Drawing};
pub use legend::{Entry, with_legend};
pub use slide::Slide;
pub use theme::Theme;
