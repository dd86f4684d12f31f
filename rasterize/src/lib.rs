//! Object order, or rasterization: for each object in the scene, for each pixel that it may affect.
//!
//! This crate renders a scene from a camera. It answers two questions of every sample: which primitive is seen there,
//! and how far it is. The answers are exact: rounded arithmetic decides only where a proved bound says that it is
//! right, and the exact judge of [`common::exact`] decides the rest. The twin of this crate, `bothways-raytrace`, gives
//! the same answers in image order. It has the same names with the loops swapped.
//!
//! ```
//! use bothways_rasterize::common::glam::Vec3;
//! use bothways_rasterize::common::{Camera, Options, Scene, Sphere, View, Work};
//! use bothways_rasterize::{fast, shade, textbook};
//!
//! // A scene, a camera, and both together.
//! let sphere = Sphere { center: Vec3::new(0.0, 0.0, -4.0), radius: 1.0 };
//! let scene = Scene::new(vec![sphere.into()])?;
//! let camera = Camera::canonical(5, 5);
//! let (view, options) = (View::new(&scene, &camera), Options::default());
//!
//! // The lecture's double loop: every primitive × every sample.
//! let mut expected = textbook::render(&view, &options);
//! assert_eq!(expected.id(2, 2), Some(0));
//! assert_eq!(expected.t(2, 2), Some(3.0));
//! assert_eq!(expected.id(0, 0), None);
//!
//! // The same picture without the work that cannot matter.
//! let prepared = fast::prepare(&scene);
//! let frame = fast::render(&prepared, &view, &options);
//! assert_eq!(frame.ids(), expected.ids());
//!
//! // The same loops, counted.
//! let (mut slow, mut quick) = (Work::default(), Work::default());
//! textbook::determine_visibility(&view, &options, &mut expected, &mut slow);
//! let mut frame = frame;
//! fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut quick);
//! shade(&view, &mut frame);
//! assert_eq!(slow.tests, 25);
//! assert!(quick.tests < slow.tests && quick.fragments == slow.fragments);
//! # Ok::<(), bothways_rasterize::common::SceneError>(())
//! ```
//!
//! # The loop
//!
//! ```text
//! for primitive in scene
//!     for sample it may affect
//!         if it covers the sample
//!             keep the nearest
//! ```
//!
//! The outer loop takes up every object once, and never asks for it again. What must be remembered is the nearest
//! primitive of every sample: the [`Frame`] is the z-buffer. So object order can draw a mesh that is larger than
//! memory, triangle after triangle: [`stream`] does. Image order cannot, because any ray may need any triangle.
//!
//! # Textbook and fast
//!
//! [`textbook`] is the loop above on one page, with the exact predicate in its middle. It is the oracle for [`fast`].
//! Visibility in `fast` has two steps:
//!
//! - [`fast::prepare`] does what a moving camera would not repeat: it cuts meshes into clusters of neighbouring
//!   triangles, and the scene into batches for the threads.
//! - [`fast::determine_visibility`] maps every vertex to the raster, finds the tiles that each primitive may affect,
//!   and draws the tiles one by one, sixteen triangles or sixteen samples at a time.
//!
//! Both modules say what is seen. [`shade`](fn@shade) gives it its look, in ordinary floating point, by interpolation
//! over the triangle that is seen. `render` is both steps in one call.
//!
//! # Watching the loop
//!
//! Every loop tells an [`Observer`](common::observe::Observer) what happens: a primitive begins, a sample is tested, a
//! fragment meets its depth test. (`textbook` takes any [`Events`](common::observe::Events), as `&mut dyn Events`.)
//! Counts ([`Work`](common::Work)), heat maps and films are observers. `()` is the observer that watches nothing and
//! costs nothing. What `fast` executes for a frame is another sort of count, which it returns:
//! [`Executed`](common::observe::Executed).
//!
//! # What it promises
//!
//! - The ids are those of `textbook`, and those of the twin, at every sample. There is no tolerance.
//! - A stored `t` is within 8·10⁻⁶ of the true one, relatively.
//! - The number of threads, the width of SIMD and the size of tiles change no bit of a frame. Threads and SIMD change
//!   no event either.
//! - A crop, or a mesh in chunks, has the bits of the whole picture.

pub mod fast;
mod shade;
pub mod stream;
pub mod textbook;

pub use bothways_common as common;
pub use bothways_common::{Frame, Options, View};
pub use shade::{shade, shade_with};
