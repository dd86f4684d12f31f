//! Reads and writes meshes as Wavefront OBJ files, and reads their material files.
//!
//! # What is read
//!
//! The reader takes the part of the format that describes triangles (Wavefront, "Advanced Visualizer" manual,
//! appendix B1, "Object Files"), and is strict about it:
//!
//! - `v x y z`, `vt u [v]`, `vn x y z`: each number is rounded once, to the nearest `f32`. `v x y z r g b` gives a vertex a
//!   colour, from 0 to 1, which is read as sRGB: programs that write it show it unchanged. What else follows must be numbers and
//!   is ignored; a weight `w` is for free-form curves only.
//! - `f` with corners `v`, `v/vt`, `v//vn`, `v/vt/vn`: a polygon of any size, cut into triangles in file order: into the fan
//!   `(0, k, k + 1)` if that covers it, as it does if it is convex, and else ear by ear, up to 16,384 corners. A positive index counts from 1, a negative one counts back from the last definition above the face. A
//!   positive index may name a definition further down in the file: some programs write faces first, and `tobj`,
//!   which the tests compare with, accepts it too.
//! - `#` at the beginning of a word begins a comment. A backslash at the end of a line joins the next line.
//! - `usemtl` names the material of the faces below it, `mtllib` names a file that defines materials: see
//!   [`read_with_materials`].
//! - Names, groups, points, lines, free-form geometry and display settings are skipped. Any other statement is an
//!   error, also `call` and `csh`: they would include another file or run a command.
//!
//! [`mesh_stream`](crate::mesh_stream) reads vertices and triangles alone, in passes.

mod builder;
mod error;
mod file;
mod in_parallel;
mod materials;
mod parser;
mod pieces;
mod quick;
mod statements;
mod visitor;
mod words;
mod write;

pub use error::{IndexKind, ReadObjError, StatementFault};
pub(crate) use file::ObjFile;
pub use materials::parse_materials;
pub use write::write;

use crate::source::InputFile;
use crate::warning::MaterialWarning;
use bothways_common::scene::Mesh;
use builder::MeshBuilder;
use in_parallel::{Sizes, Stopped};
use parser::Parser;
use statements::Statements;
use std::path::Path;

/// Reads a mesh from an OBJ file, on all threads of the current rayon pool if the file is large.
///
/// # Errors
///
/// The file cannot be read, or one of the errors of [`parse`]; messages call the file by `path`.
pub fn read(path: &Path) -> Result<Mesh, ReadObjError> {
    let mut file = ObjFile::open(path)?;
    let name = path.display().to_string();
    // A part at a time: a file of another format ends the reader early, and does not fill the memory.
    let length = file.length()?;
    if length > MOST_BYTES {
        return Err(ReadObjError::TooLarge { file: name });
    }
    if length >= LARGE {
        let read = in_parallel::read(file.unread()?, MOST_BYTES, Sizes::for_threads());
        return read.map_err(|error| stopped(name.clone(), error)).and_then(|p| finish(name, p));
    }
    let mut parser = Parser::new(MeshBuilder::default(), None);
    match file.statements(|line, words| parser.statement(line, words))? {
        0 => Err(ReadObjError::Empty { file: name }),
        _ => finish(name, parser),
    }
}

/// Reads a mesh as [`read`] does, from the disk or from memory.
pub(crate) fn read_file(file: &InputFile) -> Result<Mesh, ReadObjError> {
    match file.in_memory() {
        Some(bytes) => parse(&file.name(), bytes),
        None => read(file.path()),
    }
}

/// Reads a mesh from an OBJ file, and its materials from the material files that it names.
///
/// A missing material file or a missing material is a warning and no error: many meshes come without their material
/// files. Triangles without a known material are drawn in the material of their object.
///
/// # Errors
///
/// As for [`read`], for the OBJ file and for each material file that exists.
pub fn read_with_materials(file: &InputFile) -> Result<(Mesh, Vec<MaterialWarning>), ReadObjError> {
    let mut mesh = read_file(file)?;
    let warnings = materials::resolve(&mut mesh, file)?;
    Ok((mesh, warnings))
}

/// Reads a mesh from the bytes of an OBJ file, which messages call `name`.
///
/// The mesh has normals or texture coordinates if any corner of a face names one. Its materials have names only: other
/// files define them.
///
/// # Errors
///
/// A statement that is wrong or unknown, an index that is not defined, a file that is empty or has no faces.
///
/// ```
/// use bothways_formats::obj;
///
/// let square = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// assert_eq!(obj::parse("square.obj", square)?.triangles(), [[0, 1, 2], [0, 2, 3]]);
///
/// let error = obj::parse("bad.obj", b"v 0 0 0\nv 1 0 O\n").unwrap_err();
/// assert_eq!(error.to_string(), r#"bad.obj:2: "O" is not a number"#);
/// # Ok::<(), obj::ReadObjError>(())
/// ```
pub fn parse(name: &str, bytes: &[u8]) -> Result<Mesh, ReadObjError> {
    if bytes.is_empty() {
        return Err(ReadObjError::Empty { file: name.to_owned() });
    }
    if bytes.len() as u64 > MOST_BYTES {
        return Err(ReadObjError::TooLarge { file: name.to_owned() });
    }
    let located = |line, fault| ReadObjError::Statement { file: name.to_owned(), line, fault };
    let mut parser = Parser::new(MeshBuilder::default(), None);
    for (line, words) in Statements::new(bytes) {
        parser.statement(line, words).map_err(|fault| located(line, fault))?;
    }
    finish(name.to_owned(), parser)
}

/// The error that stopped the reader of a large file.
fn stopped(file: String, stopped: Stopped) -> ReadObjError {
    match stopped {
        Stopped::Io(error) => ReadObjError::Unreadable { file, error },
        Stopped::Statement(line, fault) => ReadObjError::Statement { file, line, fault },
        Stopped::TooLarge => ReadObjError::TooLarge { file },
    }
}

/// Checks the references to definitions further down, at the end of the file, and builds the mesh.
fn finish(file: String, parser: Parser<MeshBuilder>) -> Result<Mesh, ReadObjError> {
    if let Err((line, fault)) = parser.check_forward() {
        return Err(ReadObjError::Statement { file, line, fault });
    }
    if !parser.visitor.has_triangles() {
        return Err(ReadObjError::NoFaces { file });
    }
    Ok(parser.visitor.finish())
}

/// The most bytes of a file. The shortest definition, `vt 0` and a line end, has five bytes: a file of this size has
/// fewer than 2³² − 1 definitions of any kind, and every valid index fits into a `u32` other than `NONE`.
const MOST_BYTES: u64 = 1 << 34;

/// From this number of bytes on, a file is read on several threads.
const LARGE: u64 = 1 << 20;

#[cfg(test)]
mod tests;
