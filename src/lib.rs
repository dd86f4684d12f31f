//! One scene, rendered in object order (rasterization) and in image order (ray tracing), and the
//! proof that both see the same.
//!
//! [`rasterize`] walks the objects, [`raytrace`] the pixels; both know only [`common`], which says
//! what a scene is and what is true of one sample and one primitive. This crate knows both:
//! [`orders`] runs and measures them, [`diff`] compares what they saw, [`picture`] and [`figure`]
//! show it, [`report`] writes it down for programs, and [`scenes`] finds the scenes. [`cover`]
//! answers for one triangle on a raster, [`pixel`] for one pixel of a scene, [`opengl`] gives a
//! camera's matrices, [`verify`] holds samples of a picture against the textbook, and [`vectors`] is a
//! conformance set for other renderers.
//!
//! ```
//! use bothways::common::{Camera, Object, Options, Scene, Shape, Sphere, View, glam::Vec3};
//! use bothways::{diff, rasterize, raytrace};
//!
//! let ball = Shape::Sphere(Sphere { center: Vec3::new(0.0, 0.0, -3.0), radius: 1.0 });
//! let scene = Scene::new(vec![Object::from(ball)])?;
//! let camera = Camera::canonical(32, 32);
//! let view = View::new(&scene, &camera);
//!
//! let object_order = rasterize::textbook::render(&view, &Options::default());
//! let image_order = raytrace::textbook::render(&view, &Options::default());
//!
//! let comparison = diff::compare(&object_order, &image_order);
//! assert!(comparison.matches(), "{}", comparison.verdict());
//! # Ok::<(), bothways::common::SceneError>(())
//! ```

pub use bothways_common as common;
pub use bothways_formats as formats;
pub use bothways_rasterize as rasterize;
pub use bothways_raytrace as raytrace;

pub mod cover;
pub mod diff;
pub mod figure;
pub mod opengl;
pub mod orders;
pub mod picture;
pub mod pixel;
pub mod progress;
pub mod report;
pub mod scenes;
pub mod vectors;
pub mod verify;
pub mod wording;
