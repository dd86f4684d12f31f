//! One scene, rendered in object order (rasterization) and in image order (ray tracing), and the
//! proof that both see the same.
//!
//! [`rasterize`] walks the objects, [`raytrace`] the pixels. Both know only [`common`], which says
//! what a scene is and what is true of one sample and one primitive. [`formats`] reads scenes and meshes.
//! [`bothways_lab`] knows all of them; this crate shows them under one name, and adds the program.
//!
//! # A tour
//!
//! A scene and a camera are plain data; a [`View`](common::View) is the scene as the camera sees it. [`orders`] renders a
//! view in either order, counts the work and measures the time. [`diff`] compares what both saw.
//!
//! ```
//! use bothways::common::{Camera, CameraDescription, View};
//! use bothways::orders::{self, Method, Order, RenderOptions};
//! use bothways::picture::{mask, picture};
//! use bothways::{diff, scenes};
//!
//! let loaded = scenes::load("canonical")?;
//! let camera = Camera::new(CameraDescription { image: [48, 48], ..loaded.camera })?;
//! let view = View::new(&loaded.scene, &camera);
//!
//! let options = RenderOptions::default();
//! let object_order = orders::render(Order::Object, Method::Fast, &view, &options)?;
//! let image_order = orders::render(Order::Image, Method::Fast, &view, &options)?;
//!
//! let comparison = diff::compare(&object_order.frame, &image_order.frame);
//! assert!(comparison.matches(), "{}", comparison.verdict());
//! assert_eq!(mask(&object_order.frame), mask(&image_order.frame));
//!
//! let difference = comparison.classes().picture(&picture(&object_order.frame));
//! assert_eq!(difference.dimensions(), (48, 48));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The renderers can be called directly, too. Each has a `textbook`, the lecture's loop on one page, and a `fast` one
//! that gives the same answers:
//!
//! ```
//! use bothways::common::{Camera, Object, Options, Scene, Sphere, View, glam::Vec3};
//! use bothways::{rasterize, raytrace};
//!
//! let ball = Sphere { center: Vec3::new(0.0, 0.0, -3.0), radius: 1.0 };
//! let scene = Scene::new(vec![Object::from(ball)])?;
//! let camera = Camera::canonical(32, 32);
//! let view = View::new(&scene, &camera);
//!
//! let object_order = rasterize::textbook::render(&view, &Options::default());
//! let image_order = raytrace::textbook::render(&view, &Options::default());
//! assert_eq!(object_order.ids(), image_order.ids());
//! # Ok::<(), bothways::common::SceneError>(())
//! ```
//!
//! # Where to find what
//!
//! - **Scenes**: [`scenes`] finds the built-in ones and loads files; [`formats`] reads OBJ, PLY and TOML and makes
//!   meshes from formulas.
//! - **Rendering**: [`orders`]; [`progress`] tells how far it is; [`verify`] computes samples of a picture by the
//!   textbook as well.
//! - **Ordinary renderers**: [`rules`], to compare with the exact ones; [`orders::Rules`] sets them.
//! - **Comparing**: [`diff`], for frames and for files of any origin ([`diff::foreign`]); [`report`] writes the
//!   result for programs.
//! - **Showing**: [`picture`] and [`figure`]; [`film`] shows both orders at work; [`wording`] writes numbers for people.
//! - **Single questions**: [`cover`] answers for one triangle on a raster, [`pixel`] for one pixel of a scene,
//!   [`opengl`] gives the matrices of a camera, and [`exchange`] writes it for other systems; [`export`] writes
//!   whole scenes.
//! - **Testing other renderers**: [`vectors`] is a conformance set, [`check`] holds a renderer to it, [`grade`] gives
//!   marks for one scene; [`fuzz`] draws random scenes by all four renderers, and
//!   shrinks what they disagree on.

pub use bothways_common as common;
pub use bothways_formats as formats;
pub use bothways_rasterize as rasterize;
pub use bothways_raytrace as raytrace;
pub use bothways_rules as rules;

#[doc(inline)]
pub use bothways_lab::{
    check, cover, diff, exchange, export, figure, film, fuzz, grade, opengl, orders, picture,
    pixel, progress, report, scenes, slides, sweep, vectors, verify, wording,
};
