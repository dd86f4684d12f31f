//! Reads and writes scenes and meshes, and generates meshes.
//!
//! This crate turns files and formulas into the scenes of [`common`]. The two renderers do not depend on it: they take a
//! scene from anywhere.
//!
//! # From a text to a scene
//!
//! ```
//! use bothways_formats::common::glam::Vec3;
//! use bothways_formats::generate::Kind;
//! use bothways_formats::source::Files;
//! use bothways_formats::{obj, ply, scene_file, smooth};
//!
//! // Read an OBJ file. Polygons become triangles.
//! let square = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
//! let square = obj::parse("square.obj", square)?;
//! assert_eq!(square.triangles(), [[0, 1, 2], [0, 2, 3]]);
//!
//! // Write it as a PLY file, and read that back.
//! let mut file = Vec::new();
//! ply::write(&square, &mut file)?;
//! assert_eq!(ply::parse("square.ply", &file)?, square);
//!
//! // Give it normals.
//! let square = smooth::with_normals(square, smooth::CREASE);
//! assert_eq!(square.normals().of(0), Some([Vec3::Z; 3]));
//!
//! // Generate a torus of 64 × 32 cells, each of two triangles.
//! let torus = Kind::Torus.mesh([64, 32])?;
//! assert_eq!(torus.triangles().len(), 4096);
//!
//! // Read a scene file.
//! let text = r##"
//!     [camera]
//!     eye = [0, 1, 4]
//!     look_at = [0, 0, 0]
//!
//!     [[object]]
//!     generate = { kind = "torus", divisions = [64, 32] }
//! "##;
//! let file = scene_file::parse("torus.toml", text, &Files::none())?;
//! assert_eq!(file.scene.primitive_count(), 4096);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The modules
//!
//! | module | what it does |
//! |---|---|
//! | [`scene_file`] | reads and writes scene files: a scene and its camera, in TOML |
//! | [`obj`], [`ply`], [`stl`] | read and write meshes in these formats; [`obj`] reads material files, too |
//! | [`gltf`] | reads the scene of a glTF file as meshes and instances, with its materials and cameras |
//! | [`mesh_file`] | reads a mesh in the format that the content or the name of its file tells |
//! | [`shapes`] | changes the meshes of shapes that share them |
//! | [`mesh_stream`] | reads meshes that are larger than memory, in passes |
//! | [`generate`] | generates meshes from formulas |
//! | [`smooth`] | computes normals for meshes that have none |
//! | [`picture`] | opens picture files, to compare them or as textures |
//! | [`warning`] | says what of a mesh's materials is missing |
//! | [`source`] | opens files and finds those that they name, on the disk or in memory; prepares text from files for messages |
//!
//! Dependencies run downwards only: `scene_file` and `mesh_stream` know `mesh_file`, `mesh_file` knows the formats, and the
//! formats know `source` and `warning`, and what cuts their polygons into triangles. So a new mesh format is a module beside `obj` and `ply`, and a variant of
//! [`mesh_file::Format`].
//!
//! # Errors
//!
//! Each reader has an error of its own: [`obj::ReadObjError`], [`ply::ReadPlyError`], [`stl::ReadStlError`],
//! [`gltf::ReadGltfError`] and [`scene_file::ReadSceneError`]. Messages name the file, the line (or the byte of a binary file) and the reason:
//!
//! ```
//! use bothways_formats::obj;
//!
//! let error = obj::parse("bad.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 3\n").unwrap_err();
//! let message = "bad.obj:3: the face names vertex 3, but in the whole file only 2 are defined";
//! assert_eq!(error.to_string(), message);
//! ```
//!
//! No file makes a reader panic: tests and fuzzers look for such a file. Messages are safe to show on a terminal, whatever
//! they quote from a file: see [`source::quote`].

mod attributes;
pub mod generate;
pub mod gltf;
pub mod mesh_file;
pub mod mesh_stream;
pub mod obj;
pub mod picture;
pub mod ply;
mod polygon;
pub mod scene_file;
pub mod shapes;
pub mod smooth;
pub mod source;
pub mod stl;
pub mod warning;

pub use bothways_common as common;
