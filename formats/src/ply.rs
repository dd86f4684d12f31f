//! Reads and writes meshes as PLY files, which scanners and sculpting programs use.
//!
//! # What is read
//!
//! The reader takes all three encodings of the format (Turk, "The PLY Polygon File Format", 1994). It takes the part of
//! a file that describes triangles, and is strict about it:
//!
//! - `x`, `y`, `z` of the element `vertex`, of any type: each number is rounded once, to the nearest `f32`.
//! - `nx`, `ny`, `nz` of the element `vertex`, if all three are there: its normal. One without direction (zero, or not
//!   finite) is left out; if all are, the mesh has no normals.
//! - The list `vertex_indices` or `vertex_index` of the element `face`, of any integer types: a polygon of any size, cut
//!   into triangles in file order: into the fan `(0, k, k + 1)` if that covers it, as it does if it is convex, and else ear by
//!   ear, up to 16,384 corners. Indices count from 0.
//! - `red`, `green`, `blue` of the element `vertex`, if all three are there: its colour, from 0 to 1, or to 255 or 65,535 in
//!   integers. It is read as sRGB: programs that write it show it unchanged. The colours of faces are not read, and
//!   neither are textures and their coordinates; [`read_with_warnings`] says so.
//! - Other properties and other elements are skipped, but must be complete. Nothing may follow the last element: the
//!   header of such a file does not fit its content. A byte order mark before the header is skipped.
//!
//! A binary file is decoded as fast as it comes into memory, and value by value where that is not possible. A count in the file never makes the reader reserve memory before the values
//! themselves have been read.

mod error;
mod file;
mod header;
mod quick;
mod values;
mod vertex;
mod write;

pub use error::{ElementFault, HeaderFault, Location, ReadPlyError};
pub(crate) use file::PlyFile;
pub use write::write;

use crate::source::InputFile;
use crate::warning::MaterialWarning;
use bothways_common::scene::Mesh;
use std::io::Cursor;
use std::path::Path;

/// Reads a mesh from a PLY file.
///
/// # Errors
///
/// The file cannot be read, or one of the errors of [`parse`]; messages call the file by `path`.
pub fn read(path: &Path) -> Result<Mesh, ReadPlyError> {
    PlyFile::open(path)?.mesh()
}

/// Reads a mesh as [`read`] does, from the disk or from memory, with warnings if the file has colours or textures that are not read.
///
/// # Errors
///
/// As for [`read`].
pub fn read_with_warnings(file: &InputFile) -> Result<(Mesh, Vec<MaterialWarning>), ReadPlyError> {
    match file.in_memory() {
        Some(bytes) => PlyFile::new(file.name(), Cursor::new(bytes))?.mesh_with_warnings(),
        None => PlyFile::open(file.path())?.mesh_with_warnings(),
    }
}

/// Reads a mesh from the bytes of a PLY file, which messages call `name`.
///
/// # Errors
///
/// A header or an element that is wrong or missing, an index without a vertex, or more content than the header
/// announces.
///
/// ```
/// use bothways_formats::ply;
///
/// let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
///               property float z\nelement face 1\nproperty list uchar int vertex_indices\n\
///               end_header\n";
/// let square = format!("{header}0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
/// let mesh = ply::parse("square.ply", square.as_bytes())?;
/// assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
///
/// let error = ply::parse("bad.ply", square.replace("1 2 3", "1 2 4").as_bytes()).unwrap_err();
/// let says = "bad.ply: face 0 (line 14): it names vertex 4, but vertices are counted from 0 and \
///             there are 4";
/// assert_eq!(error.to_string(), says);
/// # Ok::<(), ply::ReadPlyError>(())
/// ```
pub fn parse(name: &str, bytes: &[u8]) -> Result<Mesh, ReadPlyError> {
    PlyFile::new(name.to_owned(), Cursor::new(bytes))?.mesh()
}

#[cfg(test)]
mod tests;
