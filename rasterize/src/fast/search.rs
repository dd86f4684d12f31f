//! Which tiles a primitive may affect: what object order does so that no tile looks at every primitive.
//!
//! The scene is cut into [`batches`], which threads share; a mesh into [`clusters`] of neighbouring triangles; the
//! picture into tiles ([`tiling`]). [`bins`] lists for each tile the clusters and primitives that may affect it, and
//! [`finder`] looks up what is listed. Of meshes that are there many times, [`instances`] are listed instead.

pub(super) mod batches;
pub(super) mod bins;
pub(super) mod clusters;
pub(super) mod extent;
pub(super) mod finder;
pub(super) mod instances;
pub(super) mod tiling;
