//! Image order, or ray tracing: for each pixel in the image, for each object that its ray may hit.
//!
//! This crate renders a scene from a camera. It answers two questions of every sample: which primitive is seen there,
//! and how far it is. The answers are exact: rounded arithmetic decides only where a proved bound says that it is
//! right, and the exact judge of [`common::exact`] decides the rest. The twin of this crate, `bothways-rasterize`, gives
//! the same answers in object order. It has the same names with the loops swapped.
//!
//! ```
//! use bothways_raytrace::common::glam::Vec3;
//! use bothways_raytrace::common::{Camera, Options, Scene, Sphere, View, Work};
//! use bothways_raytrace::fast::{self, WorldRay};
//! use bothways_raytrace::{shade, textbook};
//!
//! // A scene, a camera, and both together.
//! let sphere = Sphere { center: Vec3::new(0.0, 0.0, -4.0), radius: 1.0 };
//! let scene = Scene::new(vec![sphere.into()])?;
//! let camera = Camera::canonical(5, 5);
//! let (view, options) = (View::new(&scene, &camera), Options::default());
//!
//! // The lecture's double loop: every sample × every primitive.
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
//! assert!(quick.tests <= slow.tests && quick.fragments <= slow.fragments);
//!
//! // Any other ray.
//! let ray = WorldRay { origin: Vec3::new(0.0, 0.0, -9.0), direction: Vec3::Z };
//! let hit = fast::first_hit(&prepared, &scene, ray).expect("the sphere is in its way");
//! assert_eq!((hit.id, hit.distance), (0, 4.0));
//! # Ok::<(), bothways_raytrace::common::SceneError>(())
//! ```
//!
//! # The loop
//!
//! ```text
//! for sample in image
//!     for primitive its ray may hit
//!         if it covers the sample
//!             keep the nearest
//! ```
//!
//! The outer loop finishes one ray before the next begins. So one variable is enough for the nearest primitive: there
//! is no z-buffer. But any ray may need any object, so the whole scene must be at hand, in an order in which a ray
//! finds its way: a hierarchy of boxes.
//!
//! # Textbook and fast
//!
//! [`textbook`] is the loop above on one page, with the exact predicate in its middle. It is the oracle for [`fast`].
//! Visibility in `fast` has two steps:
//!
//! - [`fast::prepare`] does what a moving camera would not repeat: it builds the hierarchy.
//! - [`fast::determine_visibility`] walks tiles of rays through the hierarchy, near boxes first, and tests eight
//!   triangles or sixteen samples at a time. It drops only what all rays of the tile certainly miss, or what is
//!   certainly farther than their hits.
//!
//! Both modules say what is seen. [`shade`](fn@shade) gives it its look, in ordinary floating point, from the point
//! that each ray hits. `render` is both steps in one call.
//!
//! [`fast::first_hit`] traces any ray through the same hierarchy, as exactly: a [`fast::WorldRay`] is the middle ray of
//! a camera of its own.
//!
//! # Watching the loop
//!
//! Every loop tells an [`Observer`](common::observe::Observer) what happens: a ray begins, a box is opened, a sample is
//! tested, a fragment meets its depth test, a ray has its hit. (`textbook` takes any
//! [`Events`](common::observe::Events), as `&mut dyn Events`.) Counts ([`Work`](common::Work)), heat maps and films are
//! observers. `()` is the observer that watches nothing and costs nothing. For an observer, `fast` walks each ray alone:
//! the events of a ray do not depend on its tile. What it executes for the tiles of a frame is another sort of count,
//! which it returns: [`Executed`](common::observe::Executed).
//!
//! # What it promises
//!
//! - The ids are those of `textbook`, and those of the twin, at every sample. There is no tolerance.
//! - The number of threads and the width of SIMD change no bit of a frame, and no event.
//! - A crop has the bits of the whole picture.

pub mod fast;
mod shade;
pub mod textbook;

pub use bothways_common as common;
pub use bothways_common::{Frame, Options, View};
pub use shade::{shade, shade_with};
