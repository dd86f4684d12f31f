//! Warnings about mesh files that are read, but not drawn in all of their colours, or not in their pose.

use crate::source::quote::quoted;
use std::fmt;

/// Why a file that a file names is not there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Missing {
    /// It does not exist.
    Absent,
    /// It is outside of the folder that is read.
    Outside,
    /// It is not among the files that were given.
    NotGiven,
    /// Several of the files that were given have its name.
    Ambiguous,
    /// It is a URL.
    Url,
    /// It is there, but in a format that is not read.
    Unread,
}

/// What is missing of a mesh's materials, and what else a mesh's file has and is not drawn. Triangles without a material are drawn
/// in that of their object, which is light grey unless it states another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MaterialWarning {
    /// A material file is not there.
    MissingLibrary {
        /// The mesh's file.
        file: String,
        /// The material file, as the mesh's file names it.
        library: String,
        /// Why.
        why: Missing,
    },
    /// Many more material files are not there.
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
    /// The PLY file has textures or texture coordinates, which are not read.
    PlyTextures {
        /// The mesh's file.
        file: String,
    },
    /// Pictures are not there.
    MissingPictures {
        /// The mesh's file, or its material file.
        file: String,
        /// The first line of a material file that names one of them, counted from 1.
        line: Option<usize>,
        /// Their names.
        names: Vec<String>,
        /// Why.
        why: Missing,
    },
    /// Colours of materials are stated in a way that is not read.
    UnreadColors {
        /// The material file.
        file: String,
        /// The line of the first, counted from 1.
        line: usize,
        /// The names of the materials.
        names: Vec<String>,
    },
    /// The file's materials have textures of a kind that is not read.
    Textures {
        /// The mesh's file.
        file: String,
    },
    /// Skins are not read.
    Skins {
        /// The mesh's file.
        file: String,
    },
    /// Morph targets are not read, and some have a weight.
    MorphTargets {
        /// The mesh's file.
        file: String,
    },
    /// Some materials are not to be shaded, but all are.
    Unlit {
        /// The mesh's file.
        file: String,
    },
    /// Textures are read at coordinates that what has them lacks.
    MissingCoordinates {
        /// The mesh's file.
        file: String,
        /// The names of the attributes that would be these coordinates.
        names: Vec<String>,
    },
    /// The mesh is streamed, and streams do not read materials and colours.
    Streamed {
        /// The mesh's file.
        file: String,
    },
}

impl fmt::Display for MaterialWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place(), self.words())
    }
}

impl MaterialWarning {
    /// The file, and the line if it is known.
    fn place(&self) -> String {
        match self {
            MaterialWarning::MissingPictures { file, line: Some(line), .. }
            | MaterialWarning::UnreadColors { file, line, .. } => format!("{file}:{line}"),
            MaterialWarning::MissingLibrary { file, .. }
            | MaterialWarning::MissingLibraries { file, .. }
            | MaterialWarning::Undefined { file, .. }
            | MaterialWarning::FaceColors { file }
            | MaterialWarning::PlyTextures { file }
            | MaterialWarning::MissingPictures { file, .. }
            | MaterialWarning::Textures { file }
            | MaterialWarning::Skins { file }
            | MaterialWarning::MorphTargets { file }
            | MaterialWarning::Unlit { file }
            | MaterialWarning::MissingCoordinates { file, .. }
            | MaterialWarning::Streamed { file } => file.clone(),
        }
    }

    /// What is missing, and what is drawn.
    fn words(&self) -> String {
        match self {
            MaterialWarning::MissingLibrary { library, why, .. } => {
                let missing = why.of("material file", &quoted(library));
                format!("{missing}; what needs it is drawn in light grey")
            }
            MaterialWarning::MissingLibraries { more, .. } => {
                format!("{more} more material files are missing beside it")
            }
            MaterialWarning::Undefined { names, .. } => format!(
                "no material file defines {}; what is made of it is drawn in light grey",
                some_of(names)
            ),
            MaterialWarning::MissingPictures { names, why, .. } => format!(
                "{}; what has it as its texture is drawn without",
                why.of("picture", &some_of(names))
            ),
            MaterialWarning::UnreadColors { names, .. } => format!(
                "Kd of {} is stated as xyz or spectral, which is not read; what is made of it is drawn in light grey; \
                 state three numbers",
                some_of(names)
            ),
            MaterialWarning::MissingCoordinates { names, .. } => format!(
                "some of its primitives lack {}, where their texture is read; they are drawn in their base colour",
                some_of(names)
            ),
            MaterialWarning::FaceColors { .. } => {
                "the colours of its faces are not read; all of it is drawn in the material of its object".into()
            }
            MaterialWarning::PlyTextures { .. } => {
                "textures and texture coordinates of PLY files are not read; it is drawn without; export it as OBJ or \
                 glTF to keep them"
                    .into()
            }
            MaterialWarning::Textures { .. } => {
                "some of its textures are of a kind that is not read; what has one is drawn in its base colour".into()
            }
            MaterialWarning::Skins { .. } => {
                "its skins are not read; a mesh that has one is drawn as it lies in the file, where its node is".into()
            }
            MaterialWarning::MorphTargets { .. } => {
                "its morph targets are not read; a mesh that gives them a weight is drawn without them".into()
            }
            MaterialWarning::Unlit { .. } => {
                "some of its materials are unlit (KHR_materials_unlit); what has one is shaded like everything else"
                    .into()
            }
            MaterialWarning::Streamed { .. } => {
                "the materials and colours of a mesh that is streamed are not read; all of it is drawn in light grey"
                    .into()
            }
        }
    }
}

impl Missing {
    /// The reason in words, for a file of a kind.
    fn of(self, kind: &str, names: &str) -> String {
        match self {
            Missing::Absent => format!("there is no {kind} {names} beside it"),
            Missing::Outside => {
                format!("the {kind} {names} is outside of its folder, which takes --allow-outside")
            }
            Missing::NotGiven => {
                format!("the {kind} {names} was not opened with it (open or drop both together)")
            }
            Missing::Ambiguous => format!("several opened files could be the {kind} {names}"),
            Missing::Url => format!(
                "the {kind} {names} is a URL, and nothing is fetched (download it, and name it by a relative path)"
            ),
            Missing::Unread => format!(
                "the {kind} {names} is in a format that is not read (save it as PNG, JPEG, BMP or PNM)"
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
