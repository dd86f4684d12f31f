//! Both orders behind one door, and what is made of them: comparison, reasons, figures, films, sweeps.
//!
//! This crate is the library of `bothways` without its command line. Where `bothways::` stands in other documentation,
//! `bothways_lab::` has the same modules.
//!
//! ```
//! use bothways_lab::common::{Camera, CameraDescription, View};
//! use bothways_lab::orders::{self, Method, Order, RenderOptions};
//! use bothways_lab::{diff, scenes};
//!
//! let loaded = scenes::load("ties")?;
//! let camera = Camera::new(CameraDescription { image: [32, 32], ..loaded.camera })?;
//! let view = View::new(&loaded.scene, &camera);
//! let draw = |order, method| orders::render(order, method, &view, &RenderOptions::default());
//!
//! // Every order and every method sees the same: here the lecture's two loops, and the fast ones.
//! let textbook = draw(Order::Object, Method::Textbook)?;
//! for (order, method) in [(Order::Image, Method::Textbook), (Order::Object, Method::Fast), (Order::Image, Method::Fast)] {
//!     assert!(diff::compare(&textbook.frame, &draw(order, method)?.frame).matches());
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! - **Both orders**: [`orders`] renders a scene that [`scenes`] loads, counts the work and measures the time;
//!   [`verify`] holds samples of it to the textbook.
//! - **Comparing**: [`diff`], and [`diff::why`] for the reasons; [`check`] and [`grade`] do this for many files.
//! - **Showing**: [`picture`], [`figure`], [`film`], [`slides`], [`sweep`].
//! - **Single questions**: [`cover`], [`pixel`], [`opengl`]; [`exchange`] writes a camera for other systems,
//!   [`export`] a whole scene.
//! - **Testing**: [`vectors`] is a conformance set, [`fuzz`] draws random scenes.

pub use bothways_common as common;
pub use bothways_formats as formats;
pub use bothways_rasterize as rasterize;
pub use bothways_raytrace as raytrace;
pub use bothways_rules as rules;

pub mod check;
pub mod cover;
pub mod diff;
pub mod exchange;
pub mod export;
pub mod figure;
pub mod film;
pub mod fuzz;
pub mod grade;
pub mod opengl;
pub mod orders;
pub mod picture;
pub mod pixel;
pub mod progress;
pub mod report;
mod sample_map;
pub mod scenes;
pub mod slides;
pub mod sweep;
pub mod vectors;
pub mod verify;
pub mod wording;
