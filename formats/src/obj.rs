//! Wavefront OBJ files: the reader and the writer of meshes.
//!
//! Of the format (Wavefront, "Advanced Visualizer" manual, appendix B1, "Object Files") the reader
//! takes what describes triangles, and takes it strictly:
//!
//! - `v x y z`, `vt u [v]`, `vn x y z`: numbers round once, to the nearest `f32`. What follows (a
//!   weight `w`, a colour) must be numbers and is ignored; `w` only weighs free-form curves.
//! - `f` with corners `v`, `v/vt`, `v//vn`, `v/vt/vn`: a polygon of any size, cut into the fan
//!   `(0, k, k + 1)` in file order. Indices count from 1, or back from what is defined above the
//!   face. A positive index may name what only follows below, anywhere in the file: some programs
//!   write faces first, and `tobj`, which the tests compare with, accepts it too.
//! - `#` before a word begins a comment; a backslash before the end of a line joins the next line.
//! - `usemtl` names the material of the faces below, `mtllib` a file that defines some: see
//!   [`read_with_materials`].
//! - Names, groups, points, lines, free-form geometry and display settings are skipped. Anything else
//!   is an error, `call` and `csh` too: they would run or include what is not here.
//!
//! [`mesh_stream`](crate::mesh_stream) reads only vertices and triangles of a file.

mod builder;
mod error;
mod file;
mod materials;
mod parser;
mod statements;
mod visitor;
mod warning;
mod words;
mod write;

pub use error::{IndexKind, ReadObjError, StatementFault};
pub(crate) use file::ObjFile;
pub use materials::parse_materials;
pub use warning::MaterialWarning;
pub use write::write;

use bothways_common::scene::Mesh;
use builder::MeshBuilder;
use parser::Parser;
use statements::Statements;
use std::path::Path;

/// Reads a mesh from an OBJ file.
///
/// # Errors
///
/// As for [`parse`], and a file that cannot be read; messages call the file by `path`.
pub fn read(path: &Path) -> Result<Mesh, ReadObjError> {
    let mut file = ObjFile::open(path)?;
    let name = path.display().to_string();
    // A statement at a time: a file that is none ends the reader early, and never fills the memory.
    if file.length()? > MOST_BYTES {
        return Err(ReadObjError::TooLarge { file: name });
    }
    let mut parser = Parser::new(MeshBuilder::default(), None);
    match file.statements(|line, words| parser.statement(line, words))? {
        0 => Err(ReadObjError::Empty { file: name }),
        _ => finish(name, parser),
    }
}

/// Reads a mesh from an OBJ file, and its colours from the material files beside it.
///
/// A material file that is not there, or that lacks a material, is no error: many meshes come without
/// theirs. What is missing is told, and drawn in the material of the object.
///
/// # Errors
///
/// As for [`read`], and for each material file that is there.
pub fn read_with_materials(path: &Path) -> Result<(Mesh, Vec<MaterialWarning>), ReadObjError> {
    let mut mesh = read(path)?;
    let warnings = materials::resolve(&mut mesh, path)?;
    Ok((mesh, warnings))
}

/// Reads a mesh from the bytes of an OBJ file, which messages call `name`.
///
/// Normals and texture coordinates are there if any corner of a face names one. Materials have names,
/// but are not known: they stand in other files.
///
/// # Errors
///
/// A statement that is wrong or means nothing, an index of something that is not defined, a file
/// without faces.
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

/// Checks what faces name, once everything is defined.
fn finish(file: String, parser: Parser<MeshBuilder>) -> Result<Mesh, ReadObjError> {
    if let Err((line, fault)) = parser.check_forward() {
        return Err(ReadObjError::Statement { file, line, fault });
    }
    if !parser.visitor.has_triangles() {
        return Err(ReadObjError::NoFaces { file });
    }
    Ok(parser.visitor.finish())
}

/// The shortest definition, `vt 0` and a line end, has five bytes: so many bytes define fewer than
/// 2³² − 1 things of any kind, and every index that is valid fits into a `u32` other than `NONE`.
const MOST_BYTES: u64 = 1 << 34;

#[cfg(test)]
mod tests;
