//! Figures: rendered pictures, and drawings of what the renderers do, arranged for readers.

mod chart;
mod drawing;
mod fallback;
mod film_page;
mod formula;
mod kinds;
mod legend;
mod marks;
mod project;
mod resize;
mod sheet;
mod slide;
mod still_page;
mod subject;
mod text;
mod theme;

pub use chart::sweep_chart;
pub use drawing::{Bands, CANVAS, Drawing};
pub(crate) use film_page::{CodeLine, FilmHalf, FilmPage};
pub use kinds::{Kind, WorkMap, work_at_samples, work_figure, work_maps};
pub use legend::{Entry, with_legend};
pub(crate) use project::{Projector, corners_of_box};
pub(crate) use resize::within;
pub use slide::Slide;
pub(crate) use still_page::{Still, StillPage};
pub use subject::{FigureError, Subject};
pub use theme::Theme;
