//! Finds the primitives that the rays of a tile may hit: the hierarchy, how it is built, and the walk through it.

pub(crate) mod box_culling;
pub(crate) mod build;
mod candidates;
pub(crate) mod instance_frustum;
mod leaf;
mod leaf_fragments;
mod leaf_tests;
mod packed_ids;
pub(crate) mod ray_square;
pub(crate) mod tile_frustum;
mod tile_place;
pub(crate) mod tree;
pub(crate) mod walk;
