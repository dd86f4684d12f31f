//! One function that renders a view in either order and by any rules, counts the work and measures the time.

mod counts;
mod drawing;
mod measure;
mod options;
pub(crate) mod order;
mod render;
mod rendered;
mod renderer;
mod rules;
mod source;
mod times;

pub use counts::{Counts, most_steps};
pub use options::RenderOptions;
pub use order::{Method, Order};
pub use render::render;
pub use rendered::Rendered;
pub use rules::{Rule, Rules};
pub use source::Source;
pub use times::{Spread, Times};

#[cfg(test)]
mod tests;
