//! Reads mesh files of any supported format. The extension of a file names its format.

use crate::obj::{self, ReadObjError};
use crate::ply::{self, ReadPlyError};
use crate::warning::MaterialWarning;
use bothways_common::scene::Mesh;
use std::ffi::OsStr;
use std::path::Path;

/// A format of mesh files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ: [`obj`].
    Obj,
    /// PLY, ASCII or binary: [`ply`].
    Ply,
}

/// Why a mesh file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadMeshError {
    /// It is an OBJ file.
    #[error(transparent)]
    Obj(#[from] ReadObjError),
    /// It is a PLY file.
    #[error(transparent)]
    Ply(#[from] ReadPlyError),
}

/// The extensions of all formats, as messages list them.
pub const EXTENSIONS: &str = ".obj, .ply";

impl Format {
    /// The format that a file's extension names, in lower or upper case; `None` for any other extension.
    pub fn of(path: &Path) -> Option<Format> {
        let extension = path.extension().and_then(OsStr::to_str)?;
        match extension.to_ascii_lowercase().as_str() {
            "obj" => Some(Format::Obj),
            "ply" => Some(Format::Ply),
            _ => None,
        }
    }

    /// Reads a mesh from a file of this format.
    ///
    /// # Errors
    ///
    /// The file cannot be read, or is wrong; messages call it by `path`.
    pub fn read(self, path: &Path) -> Result<Mesh, ReadMeshError> {
        Ok(match self {
            Format::Obj => obj::read(path)?,
            Format::Ply => ply::read(path)?,
        })
    }

    /// Reads a mesh from a file of this format, and its materials from the files beside it.
    ///
    /// OBJ files have such material files. Warnings name the materials that are missing, and say if the colours of a PLY file
    /// are.
    ///
    /// # Errors
    ///
    /// As for [`Format::read`], for the mesh file and for each material file that exists.
    pub fn read_with_materials(
        self,
        path: &Path,
    ) -> Result<(Mesh, Vec<MaterialWarning>), ReadMeshError> {
        Ok(match self {
            Format::Obj => obj::read_with_materials(path)?,
            Format::Ply => ply::read_with_warnings(path)?,
        })
    }

    /// Reads a mesh from the bytes of a file of this format, which messages call `name`. The materials of an OBJ file are in
    /// other files, which are not read: warnings name them as missing.
    ///
    /// # Errors
    ///
    /// The bytes are wrong.
    pub fn parse(
        self,
        name: &str,
        bytes: &[u8],
    ) -> Result<(Mesh, Vec<MaterialWarning>), ReadMeshError> {
        Ok(match self {
            Format::Obj => obj::parse_alone(name, bytes)?,
            Format::Ply => ply::parse_with_warnings(name, bytes)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_names_the_format() {
        let of = |path: &str| Format::of(Path::new(path));
        assert_eq!([of("a/b.obj"), of("B.PLY")], [Some(Format::Obj), Some(Format::Ply)]);
        assert_eq!([of("ply"), of("a.stl"), of("a.obj.gz"), of("")], [None; 4]);
    }
}
