//! What both orders cost as a scene grows: in triangles, in pixels, in depth complexity, and in the size of its
//! triangles.
//!
//! A sweep is a list of [`Task`]s, one measurement each. A [`Bench`] carries them out; a [`Table`] keeps what they found,
//! as CSV, so that a sweep can be interrupted and continued; a [`Summary`] fits slopes, looks for crossings and puts both
//! into words. Counts are the same on every machine, times are not: they are never mixed in one chart.
//!
//! ```
//! use bothways_lab::orders::Method;
//! use bothways_lab::sweep::{Axis, Bench, Plan, Quantity, Summary, Table};
//!
//! let plan = Plan { image: [40, 30], most: 1000, times: false, ..Plan::default() };
//! let mut bench = Bench::default();
//! let mut table = Table::default();
//! for task in plan.tasks(&[Axis::Triangles]) {
//!     table.insert(task, bench.measure(&task));
//! }
//! let summary = Summary::of(&table, Axis::Triangles, Quantity::Steps).expect("there are points");
//! let textbook = summary.curves.iter().find(|curve| curve.method == Method::Textbook);
//! let textbook = textbook.and_then(|curve| curve.slope).expect("there are enough points");
//! assert!((textbook.value - 1.0).abs() < 0.01, "every triangle at every sample");
//! ```

mod bench;
mod case;
mod fit;
mod json;
mod plan;
mod point;
mod summary;
mod table;

pub use bench::{Bench, steps};
pub use case::{Axis, Case};
pub use fit::{Crossing, Slope};
pub use json::json;
pub use plan::{Plan, Quantity, Task};
pub use point::Point;
pub use summary::{Curve, Summary, short};
pub use table::{Measured, ReadTableError, Source, Table};

#[cfg(test)]
mod tests;
