//! The rules of ordinary renderers, each on purpose: what they do at edges, with rounding and by convention.
//!
//! `bothways` renders exactly, in both orders. Other renderers do not: a GPU rounds vertices to a fraction of a pixel, a ray
//! tracer tests triangles in `f32`, a student samples pixel corners. Each rule here is a small implementation of one such
//! system, to be held against the exact answer, so that a difference can be shown and explained.
//!
//! ```
//! use bothways_rules::common::glam::Vec3;
//! use bothways_rules::common::{Camera, Options, Scene, Triangle, View};
//! use bothways_rules::{image_order, object_order};
//!
//! // Two triangles that share a diagonal, which runs exactly through the samples of a 4 x 4 picture.
//! let [a, b, c, d] = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]]
//!     .map(|[x, y]| Vec3::new(x, y, -2.0));
//! let half = |a, b, c| Triangle { a, b, c }.into();
//! let scene = Scene::new(vec![half(a, b, c), half(a, c, d)])?;
//! let camera = Camera::canonical(4, 4);
//! let (view, options) = (View::new(&scene, &camera), Options::default());
//!
//! // Where both sides own an edge, the first triangle is seen; where none does, nothing is.
//! let rule: object_order::Rule = "inclusive".parse()?;
//! let frame = object_order::render(&view, &options, rule);
//! assert_eq!(frame.id(1, 1), Some(0));
//! let frame = object_order::render(&view, &options, object_order::Rule::Exclusive);
//! assert_eq!(frame.id(1, 1), None);
//!
//! // A GPU gives it to one of them, as an exact renderer does.
//! let frame = object_order::render(&view, &options, "snapped:8".parse()?);
//! assert_eq!(frame.id(1, 1), Some(0));
//!
//! // The same for rays, which end in whichever triangle comes first.
//! let frame = image_order::render(&view, &options, image_order::Rule::Watertight);
//! assert_eq!(frame.id(1, 1), Some(0));
//!
//! // What each rule does, and which sort of bug it reproduces.
//! for about in image_order::ALL {
//!     println!("{:16} {}", about.form, about.reproduces);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The rules
//!
//! - [`object_order`]: `float32`, `inclusive`, `exclusive`, `snapped:B`, `corner`, `near-clip:Z`, `depth24`.
//! - [`image_order`]: `moller-trumbore`, `watertight`, `float32`, `corner`, `one-origin`, `flip-rows`, `jittered:SEED`.
//!
//! A rule has one fault, or one system's arithmetic. What it does not name is done as well as `f64` allows: `corner`
//! samples the wrong point, but fills by the right rule.
//!
//! # What it promises
//!
//! - Nothing here asks the exact judge, and nothing is shared with the exact renderers but the scene, the camera and the
//!   frame.
//! - The same picture on any number of threads, and on every machine.
//! - Bounding boxes and a hierarchy of boxes: a million triangles in 1920 x 1080 take seconds.
//! - Every accepted scene ends in a frame. What overflows the rule's arithmetic is not drawn.

pub mod image_order;
pub mod object_order;
mod quadric;
mod real;
mod rule;
mod samples;
mod shade;

pub use bothways_common as common;
pub use bothways_common::{Frame, Options, View};
pub use rule::{About, ParseRuleError};
