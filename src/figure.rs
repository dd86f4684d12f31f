//! Figures: rendered pictures, and drawings of what the renderers do, arranged for readers.

mod drawing;
mod fallback;
mod kinds;
mod film_page;
mod legend;
mod project;
mod resize;
mod sheet;
mod slide;
mod subject;
mod text;
mod theme;

pub use drawing::{CANVAS, Drawing};
pub use kinds::{Kind, WorkMap, work_maps};
pub(crate) use film_page::{CodeLine, FilmHalf, FilmPage};
pub use legend::{Entry, with_legend};
pub use slide::Slide;
pub use subject::{FigureError, Subject};
pub use theme::Theme;
