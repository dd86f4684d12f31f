//! What both orders of rendering share: what a scene *is*, and what is *true* of one sample and
//! one primitive. How to find what is visible is the business of the two renderers.
//!
//! # Conventions
//!
//! - A pixel is `(i, j)`: row from the top, column from the left, counted from 0.
//! - `(x, y)` are real coordinates on the viewport, `x` along `u` (right), `y` along `v` (up).
//! - A picture of `samples` × `samples` samples a pixel is a raster of `height·samples` rows and
//!   `width·samples` columns; sample `(row, column)` of it lies in pixel `(row / samples,
//!   column / samples)`. The sample's formula on that raster is the pixel's own.
//! - Positions are stored as `f32` in the world and judged by their offset from the eye, one `f64`
//!   subtraction a coordinate. From there on, the eye is the origin and the axes are the world's.
//! - `t` counts in lengths of the viewing ray's direction; larger is farther.
//! - Primitive ids count from 0 in scene order, one for a triangle, sphere or plane, one a triangle
//!   for a mesh.

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
pub use frame::{Frame, Options};
pub use observe::{Events, Observer, Work};
pub use raster::{Crop, CropError, Raster, Region, Sample, SizeError};
pub use scene::{
    Checker, Light, Material, Mesh, MeshError, Object, Plane, Primitive, Scene, SceneError, Shape,
    Sphere, Triangle,
};
pub use view::View;
