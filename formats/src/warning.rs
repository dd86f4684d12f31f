//! Warnings about mesh files that are read, but not drawn in all of their colours.

use crate::source::quote::quoted;
use std::fmt;

/// What is missing of a mesh's materials. Triangles without one are drawn in the material of their object, which is light
/// grey unless it states another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MaterialWarning {
    /// A material file does not exist.
    MissingLibrary {
        /// The mesh's file.
        file: String,
        /// The material file, as the mesh's file names it.
        library: String,
    },
    /// Many more material files do not exist.
    MissingLibraries {
        /// The mesh's file.
        file: String,
        /// How many there are beside those that other warnings name.
        more: usize,
    },
    /// No material file defines these materials.
    Undefined {
        /// The mesh's file.
        file: String,
        /// Their names.
        names: Vec<String>,
    },
    /// The file gives colours to faces, which are not read.
    FaceColors {
        /// The mesh's file.
        file: String,
    },
    /// Pictures do not exist in the file's folder.
    MissingPictures {
        /// The mesh's file, or its material file.
        file: String,
        /// Their names.
        names: Vec<String>,
    },
    /// The file's materials have textures of a kind that is not read.
    Textures {
        /// The mesh's file.
        file: String,
    },
    /// The mesh is streamed, and streams do not read materials and colours.
    Streamed {
        /// The mesh's file.
        file: String,
    },
}

impl fmt::Display for MaterialWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MaterialWarning::MissingLibrary { file, library } => write!(
                f,
                "{file}: there is no material file {} beside it; what needs it is drawn in light grey",
                quoted(library)
            ),
            MaterialWarning::MissingLibraries { file, more } => {
                write!(f, "{file}: {more} more material files are missing beside it")
            }
            MaterialWarning::Undefined { file, names } => {
                let some = some_of(names);
                write!(
                    f,
                    "{file}: no material file defines {some}; what is made of it is drawn in \
                     light grey"
                )
            }
            MaterialWarning::FaceColors { file } => write!(
                f,
                "{file}: the colours of its faces are not read; all of it is drawn in the material of its \
                 object"
            ),
            MaterialWarning::MissingPictures { file, names } => {
                let some = some_of(names);
                write!(
                    f,
                    "{file}: there is no picture {some} in its folder; what has it as its texture is drawn \
                     without"
                )
            }
            MaterialWarning::Textures { file } => write!(
                f,
                "{file}: some of its textures are of a kind that is not read; what has one is drawn in its base colour"
            ),
            MaterialWarning::Streamed { file } => write!(
                f,
                "{file}: the materials and colours of a mesh that is streamed are not read; all of it is drawn \
                 in light grey"
            ),
        }
    }
}

/// The first names of a list, and how many more there are.
fn some_of(names: &[String]) -> String {
    /// The most names that a message lists.
    const MOST: usize = 3;
    let some: Vec<String> = names.iter().take(MOST).map(|name| quoted(name)).collect();
    let more = match names.len().saturating_sub(MOST) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    some.join(", ") + &more
}
