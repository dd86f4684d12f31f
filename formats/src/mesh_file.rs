//! Reads mesh files of any supported format, which the content of a file tells, or else its name.

use crate::gltf::{self, Model, ReadGltfError};
use crate::obj::{self, ReadObjError};
use crate::ply::{self, ReadPlyError};
use crate::source::{InputFile, without_mark};
use crate::stl::{self, ReadStlError};
use crate::warning::MaterialWarning;
use bothways_common::scene::{Mesh, Shape};
use std::ffi::OsStr;
use std::io;
use std::path::Path;

/// A format of mesh files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ: [`obj`].
    Obj,
    /// PLY, ASCII or binary: [`ply`].
    Ply,
    /// STL, ASCII or binary: [`stl`].
    Stl,
    /// glTF 2.0, text or binary: [`gltf`].
    Gltf,
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
    /// It is an STL file.
    #[error(transparent)]
    Stl(#[from] ReadStlError),
    /// It is a glTF file.
    #[error(transparent)]
    Gltf(#[from] ReadGltfError),
    /// It is to be streamed, but its format is read as a whole.
    #[error(
        "{file}: only {STREAMED} files are streamed; render this one in memory, without --stream"
    )]
    NotStreamed {
        /// The file.
        file: String,
    },
}

/// The extensions of all formats, as messages list them.
pub const EXTENSIONS: &str = ".obj, .ply, .stl, .gltf, .glb";
/// The extensions of the formats that [`MeshStream`](crate::mesh_stream::MeshStream) reads, as messages list them.
pub const STREAMED: &str = ".obj, .ply, .stl";

/// The most bytes of a file that tell its format.
const BEGINNING: usize = 4096;

impl Format {
    /// The format that a file's extension names, in lower or upper case; `None` for any other extension.
    pub fn of(path: &Path) -> Option<Format> {
        let extension = path.extension().and_then(OsStr::to_str)?;
        match extension.to_ascii_lowercase().as_str() {
            "obj" => Some(Format::Obj),
            "ply" => Some(Format::Ply),
            "stl" => Some(Format::Stl),
            "gltf" | "glb" => Some(Format::Gltf),
            _ => None,
        }
    }

    /// The format of a file: the one that its content tells, or else the one that its name tells.
    ///
    /// A file that cannot be read is of the format that its name tells.
    pub fn of_file(file: &InputFile) -> Option<Format> {
        let told = || -> io::Result<Option<Format>> {
            let size = file.length()?;
            Ok(Format::told_by(&file.beginning(BEGINNING as u64)?, size))
        };
        told().ok().flatten().or_else(|| Format::of(file.path()))
    }

    /// The format of a file that begins like this and has this size. Nothing in an OBJ file tells that it is one.
    fn told_by(beginning: &[u8], size: u64) -> Option<Format> {
        let text = without_mark(beginning);
        let is_json = || {
            let some = &text[..text.len().min(BEGINNING)];
            some.trim_ascii_start().starts_with(b"{")
                && memchr::memmem::find(some, b"\"asset\"").is_some()
        };
        if text.starts_with(b"ply\n") || text.starts_with(b"ply\r") {
            Some(Format::Ply)
        } else if gltf::is_binary(beginning) || is_json() {
            Some(Format::Gltf)
        } else if stl::is_binary(beginning, size) || stl::is_text(beginning) {
            Some(Format::Stl)
        } else {
            None
        }
    }

    /// Whether meshes of this format can be read in passes, without being in memory.
    pub fn can_be_streamed(self) -> bool {
        matches!(self, Format::Obj | Format::Ply | Format::Stl)
    }

    /// Reads a mesh from a file of this format. The materials of an OBJ file have names only.
    ///
    /// # Errors
    ///
    /// The file cannot be read, or is wrong; messages call it by its path.
    pub fn read(self, file: &InputFile) -> Result<Mesh, ReadMeshError> {
        match self {
            Format::Obj => Ok(obj::read_file(file)?),
            _ => Ok(self.read_with_materials(file)?.0),
        }
    }

    /// Reads a mesh from a file of this format, and its materials from the files that it names. All of a glTF file is one mesh.
    ///
    /// OBJ files have such material files, glTF files have materials of their own. Warnings name the materials that are missing,
    /// and say which colours are not read.
    ///
    /// # Errors
    ///
    /// As for [`Format::read`], for the mesh file and for each material file that exists.
    pub fn read_with_materials(
        self,
        file: &InputFile,
    ) -> Result<(Mesh, Vec<MaterialWarning>), ReadMeshError> {
        Ok(match self {
            Format::Obj => obj::read_with_materials(file)?,
            Format::Ply => ply::read_with_warnings(file)?,
            Format::Stl => (stl::read_file(file)?, Vec::new()),
            Format::Gltf => gltf::read_as_one(file)?,
        })
    }

    /// Reads what a file of this format shows, in the order of ids: one mesh, or for a glTF file instances of meshes, too; and
    /// materials, as [`Format::read_with_materials`] does.
    ///
    /// # Errors
    ///
    /// As for [`Format::read_with_materials`].
    pub fn read_shapes(
        self,
        file: &InputFile,
    ) -> Result<(Vec<Shape>, Vec<MaterialWarning>), ReadMeshError> {
        if self == Format::Gltf {
            let Model { shapes, warnings, .. } = gltf::read(file)?;
            return Ok((shapes, warnings));
        }
        let (mesh, warnings) = self.read_with_materials(file)?;
        Ok((vec![Shape::Mesh(mesh)], warnings))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{GivenFile, Reach};

    #[test]
    fn the_extension_names_the_format() {
        let of = |path: &str| Format::of(Path::new(path));
        assert_eq!([of("a/b.obj"), of("B.PLY")], [Some(Format::Obj), Some(Format::Ply)]);
        assert_eq!([of("a.Stl"), of("a.glb")], [Some(Format::Stl), Some(Format::Gltf)]);
        assert_eq!([of("ply"), of("a.off"), of("a.obj.gz"), of("")], [None; 4]);
    }

    #[test]
    fn the_content_tells_the_format_before_the_name_does() {
        let of_named = |name: &str, bytes: &[u8]| {
            Format::of_file(&InputFile::given(&[GivenFile::new(name, bytes)], 0))
        };
        let of = |bytes: &[u8]| of_named("a.obj", bytes);
        assert_eq!(of(b"ply\nformat"), Some(Format::Ply));
        assert_eq!(of(b"plywood\n"), Some(Format::Obj));
        assert_eq!(of(b"\xef\xbb\xbfply\r\n"), Some(Format::Ply));
        assert_eq!(of(b"\xef\xbb\xbf{\"asset\": {}}"), Some(Format::Gltf));
        assert_eq!(of(b"glTF\x02\0\0\0"), Some(Format::Gltf));
        assert_eq!(of(b" {\n \"asset\": {}}"), Some(Format::Gltf));
        assert_eq!(of(b"{}"), Some(Format::Obj));
        assert_eq!(of(b"solid cube\n"), Some(Format::Stl));
        assert_eq!(of(b"solidus"), Some(Format::Obj));
        let mut binary = vec![b' '; 84 + 50];
        binary[80..84].copy_from_slice(&[1, 0, 0, 0]);
        assert_eq!(of(&binary), Some(Format::Stl));
        assert_eq!(of(&binary[1..]), Some(Format::Obj));
        assert_eq!(of_named("a", b"v 0 0 0\n"), None);
        let missing = InputFile::on_disk(Path::new("no-such.ply"), Reach::Folder);
        assert_eq!(Format::of_file(&missing), Some(Format::Ply));
    }
}
