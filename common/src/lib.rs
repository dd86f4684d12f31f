//! What both orders of rendering share: what a scene *is*, and what is *true* of one sample and one primitive.
//!
//! How to find what is visible is not here. The two renderers do that, `bothways-rasterize` (object order) and
//! `bothways-raytrace` (image order). Both know this crate, and neither knows the other.
//!
//! ```
//! use bothways_common::{Camera, Object, Scene, Sphere, View, glam::Vec3};
//!
//! let ball = Sphere { center: Vec3::new(0.0, 0.0, -3.0), radius: 1.0 };
//! let scene = Scene::new(vec![Object::from(ball)])?;
//! let camera = Camera::canonical(3, 3);
//! let view = View::new(&scene, &camera);
//!
//! // A renderer has to find out which primitives may cover a sample. Here there is only one.
//! let (ball, ray) = (view.primitive(0), camera.viewing_ray(1, 1));
//! assert!(view.judge().covers(&ball, &ray));
//! assert_eq!(view.judge().distance(&ball, &ray), 2.0);
//! # Ok::<(), bothways_common::SceneError>(())
//! ```
//!
//! # A tour
//!
//! - [`scene`] says what there is to see: objects in an order, each a [`Shape`] with a [`Material`], and lights. A
//!   [`Mesh`] shares its vertices. Every triangle, sphere and plane is one primitive with an id.
//! - [`camera`] is the lecture's camera. It makes the viewing ray of a pixel or a sample; [`raster`] says where samples
//!   lie, and cuts rectangles of them.
//! - [`view`] puts both together: a [`View`] gives each [`Primitive`] relative to the eye.
//! - [`exact`] decides. A [`Judge`] says whether a primitive covers a sample, and which of two is nearer, without error.
//! - [`frame`] is what a renderer answers: an id and a `t` for every sample, and its colour.
//! - [`look`] gives a visible point its colour, from a normal and a texture coordinate that each order finds for itself.
//! - [`observe`] is how one watches the loops at work: a renderer sends events, an [`Observer`] makes counts, films or
//!   lessons of them.
//!
//! # Conventions
//!
//! - A pixel is `(i, j)`: row from the top, column from the left, counted from 0. Rows come before columns, and heights
//!   before widths, wherever both are numbers of the raster. The size of an image is written as people write it, width
//!   first: 640x480.
//! - `(x, y)` are real coordinates on the viewport, `x` along `u` (right), `y` along `v` (up).
//! - A picture of `samples` × `samples` samples a pixel is a raster of `height·samples` rows and
//!   `width·samples` columns; sample `(row, column)` of it lies in pixel `(row / samples,
//!   column / samples)`. Its `(x, y)` follow from the formula for pixels, applied to the rows and columns of that raster.
//! - Positions are stored as `f32` in the world and judged by their offset from the eye, one `f64`
//!   subtraction a coordinate. From there on, the eye is the origin and the axes are the world's.
//! - `t` counts in lengths of the viewing ray's direction; larger is farther.
//! - Primitive ids count from 0 in scene order: one for a triangle, sphere or plane, and one for each triangle of a mesh;
//!   instances of a mesh come one after another.
//!
//! The whole contract, with its derivations, is in `docs/contract.md`.

pub mod camera;
#[doc(hidden)]
pub mod engine;
pub mod exact;
pub mod frame;
pub mod look;
pub mod observe;
pub mod raster;
pub mod scene;
pub mod view;

pub use glam;

pub use camera::{
    Camera, CameraDescription, CameraError, Orientation, Projection, Ray, SampleGrid,
};
pub use exact::{Judge, Sign};
pub use frame::{Frame, Options, OptionsError};
pub use observe::{Events, Executed, Observer, Work};
pub use raster::{Crop, CropError, Raster, Region, Sample, SizeError};
pub use scene::{
    Checker, Instances, Light, Material, Mesh, MeshError, Object, Placement, Plane, Primitive,
    Scene, SceneError, Shape, Sphere, Texture, Triangle,
};
pub use view::View;
