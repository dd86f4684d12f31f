//! Mesh files of any format that is read: which one a file is, its name says.

use crate::mesh::Mesh;
use crate::obj::{self, MaterialWarning, ReadObjError};
use crate::ply::{self, ReadPlyError};
use std::ffi::OsStr;
use std::fs::{self, File, Metadata};
use std::path::Path;
use std::{fmt, io};

/// A format of mesh files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ: [`obj`].
    Obj,
    /// PLY, in words or in bytes: [`ply`].
    Ply,
}

/// Why a mesh file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadMeshError {
    /// An OBJ file could not.
    #[error(transparent)]
    Obj(#[from] ReadObjError),
    /// A PLY file could not.
    #[error(transparent)]
    Ply(#[from] ReadPlyError),
}

impl Format {
    /// The format that a file's extension names, in small or capital letters.
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
    /// What is wrong with the file, named by `path`.
    pub fn read(self, path: &Path) -> Result<Mesh, ReadMeshError> {
        Ok(match self {
            Format::Obj => obj::read(path)?,
            Format::Ply => ply::read(path)?,
        })
    }

    /// Reads a mesh from a file of this format, with its materials if they have a place beside it:
    /// those of an OBJ file do, and what is missing of them is told.
    ///
    /// # Errors
    ///
    /// As for [`Format::read`], and for each material file that is there.
    pub fn read_with_materials(
        self,
        path: &Path,
    ) -> Result<(Mesh, Vec<MaterialWarning>), ReadMeshError> {
        Ok(match self {
            Format::Obj => obj::read_with_materials(path)?,
            Format::Ply => (ply::read(path)?, Vec::new()),
        })
    }
}

/// What the system knows of a file, unless it is a folder: some systems call it a lack of permission
/// when one is opened.
pub(crate) fn metadata(path: &Path) -> io::Result<Metadata> {
    let metadata = fs::metadata(path)?;
    if metadata.is_dir() { Err(io::ErrorKind::IsADirectory.into()) } else { Ok(metadata) }
}

/// Bytes that are read at a time.
pub const READ_AT_ONCE: usize = 1 << 18;

/// Opens a file that can be read from any place, and more than once: no folder, and no pipe, which
/// would wait for a writer.
///
/// # Errors
///
/// `IsADirectory` for a folder, `NotSeekable` for what else is no file, and what the system says.
pub fn regular_file(path: &Path) -> io::Result<File> {
    if !metadata(path)?.is_file() {
        return Err(io::ErrorKind::NotSeekable.into());
    }
    File::open(path)
}

/// The common failures in our words, the others in the system's.
#[derive(Debug)]
pub struct Unreadable<'a> {
    error: &'a io::Error,
    format: &'static str,
}

impl<'a> Unreadable<'a> {
    /// Why a file was not read that should be of a format, such as "an OBJ file".
    pub fn new(error: &'a io::Error, format: &'static str) -> Self {
        Unreadable { error, format }
    }
}

impl fmt::Display for Unreadable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.error.kind() {
            io::ErrorKind::NotFound => f.write_str("there is no such file"),
            io::ErrorKind::IsADirectory => write!(f, "this is a folder, not {}", self.format),
            io::ErrorKind::PermissionDenied => f.write_str("there is no permission to read it"),
            io::ErrorKind::NotSeekable => f.write_str(
                "this is a pipe or a device, which can be read only once; save it as a file first",
            ),
            _ => write!(f, "it cannot be read: {}", self.error),
        }
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
