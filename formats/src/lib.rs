//! What comes from files and formulas: scene files, meshes in OBJ and PLY, generated and smoothed meshes, and meshes
//! that are read in passes because they are larger than memory.
//!
//! Neither renderer knows this crate: both know only what a scene *is*, which is in [`common`].

pub mod generate;
pub mod mesh_file;
pub mod mesh_stream;
pub mod obj;
pub mod ply;
pub mod scene_file;
pub mod smooth;
pub mod source;

pub use bothways_common as common;
