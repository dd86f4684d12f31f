//! Reads and writes meshes as STL files, which printers and CAD programs use.
//!
//! # What is read
//!
//! The reader takes both forms of the format (3D Systems, "Stereolithography Interface Specification", 1988):
//!
//! - **binary**: 80 bytes of any content, the number of facets, and 50 bytes a facet, all little-endian. A file is binary if
//!   its size is exactly that, `84 + 50·n`: many binary files begin with the word "solid", too. A byte 0 near the beginning tells
//!   that a file of another size is no text either.
//! - **ASCII**: `solid`, facets (`facet normal`, `outer loop`, three times `vertex x y z`, `endloop`, `endfacet`), and
//!   `endsolid`, in lower or upper case; any number of solids. Each number is rounded once, to the nearest `f32`.
//!
//! A facet is a triangle, in the order of the file. The format has no shared vertices: corners at the same place become one
//! vertex, numbered in the order in which they come first, so that the surface can be smoothed. The normals of facets are not
//! read, for they follow from the corners, and many files have zeros in their place. Two bytes a facet of the binary form,
//! which some programs use for colours in ways of their own, are skipped.
//!
//! A file is read facet by facet, also in [passes](crate::mesh_stream). A count in the file never makes the reader reserve memory.

mod ascii;
mod binary;
mod builder;
mod error;
mod file;
mod layout;
mod write;

pub use error::{ReadStlError, StlFault};
pub use write::write;

use crate::source::{InputFile, Reach};
use bothways_common::scene::Mesh;
use builder::Builder;
pub(crate) use file::StlFile;
pub(crate) use layout::is_binary;
use std::io::{BufRead, Cursor, Seek};
use std::path::Path;

/// Reads a mesh from an STL file.
///
/// # Errors
///
/// The file cannot be read, or one of the errors of [`parse`]; messages call the file by `path`.
pub fn read(path: &Path) -> Result<Mesh, ReadStlError> {
    read_file(&InputFile::on_disk(path, Reach::Folder))
}

/// Reads a mesh from an STL file, on the disk or in memory.
pub(crate) fn read_file(file: &InputFile) -> Result<Mesh, ReadStlError> {
    match file.open() {
        Ok(opened) => read_from(file.name(), opened),
        Err(error) => Err(ReadStlError::Unreadable { file: file.name(), error }),
    }
}

/// Reads a mesh from the bytes of an STL file, which messages call `name`.
///
/// # Errors
///
/// A file that is neither of the two forms, that has no facets, or too many; a word that does not belong where it stands; a
/// coordinate that is not finite.
///
/// ```
/// use bothways_formats::stl;
///
/// let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
/// let mesh = stl::parse("one.stl", format!("solid one\n{facet}endsolid one\n").as_bytes())?;
/// assert_eq!(mesh.triangles(), [[0, 1, 2]]);
///
/// let error = stl::parse("bad.stl", b"solid bad\nfacet normal 0 0 1\nvertex 0 0 0\n").unwrap_err();
/// assert_eq!(error.to_string(), r#"bad.stl:3: "vertex" stands here in place of "outer loop""#);
/// # Ok::<(), stl::ReadStlError>(())
/// ```
pub fn parse(name: &str, bytes: &[u8]) -> Result<Mesh, ReadStlError> {
    read_from(name.to_owned(), Cursor::new(bytes))
}

/// Tells whether a file that begins with these bytes is an ASCII one.
pub(crate) fn is_text(beginning: &[u8]) -> bool {
    ascii::begins(beginning)
}

fn read_from(file: String, input: impl BufRead + Seek) -> Result<Mesh, ReadStlError> {
    let mut opened = StlFile::new(file.clone(), input)?;
    let mut builder = Builder::default();
    opened.facets(|corners| builder.facet(corners))?;
    if builder.is_empty() { Err(ReadStlError::NoFacets { file }) } else { Ok(builder.finish()) }
}

#[cfg(test)]
mod tests;
