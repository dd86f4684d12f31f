//! The pairs of files in two folders.
//!
//! Next to a conformance set (see [`vectors`](crate::vectors)), the name of a file begins with the name of its scene,
//! as in `NAME.png` or `NAME.anything.npy`. The file is compared with the set's file of the same content. In other
//! folders, files with the same name form a pair.

use super::aspect::Side;
use super::buffer::Content;
use super::foreign::read;
use crate::formats::source::regular_file;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{
    fs,
    io::{self, Read},
};

/// The files of two folders, side by side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pairs {
    /// The folder that is a conformance set, if one of the two is.
    pub set: Option<Side>,
    /// The pairs, in the order of the set, or by name.
    pub pairs: Vec<Pair>,
    /// The scenes or files that only B contains.
    pub missing_in_a: Vec<String>,
    /// The scenes or files that only A contains.
    pub missing_in_b: Vec<String>,
    /// The files next to a set that belong to none of its scenes.
    pub ignored: Vec<String>,
}

/// Two files that belong together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    /// The common name: the name of the file without its last ending; in a set, the name of the scene and the
    /// compared aspect.
    pub name: String,
    /// The file in A.
    pub a: String,
    /// The file in B.
    pub b: String,
    /// The point of the scene, for a scene of a set.
    pub point: Option<String>,
}

/// The reason why two folders cannot be compared.
#[derive(Debug, thiserror::Error)]
pub enum PairsError {
    /// A folder cannot be listed.
    #[error("cannot list the folder {}: {}", .folder.display(), reason(.error))]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// The error of the system.
        error: io::Error,
    },
    /// The index of a conformance set is damaged.
    #[error(
        "{} is not the index of a conformance set, or it is damaged: {error}; write the set again with bothways vectors",
        .path.display()
    )]
    Index {
        /// The file.
        path: PathBuf,
        /// The error in the file.
        error: serde_json::Error,
    },
    /// The folders have no pair of files.
    #[error(
        "no file of {} (PNG, PNM, BMP, JPEG, EXR or NPY) belongs to one of {}: {}",
        .a.display(), .b.display(),
        if *.set {
            "call them NAME.png (a mask) or NAME.npy (ids), NAME being a scene's name"
        } else {
            "files of the same name are compared"
        }
    )]
    NoPairs {
        /// The first folder.
        a: PathBuf,
        /// The second folder.
        b: PathBuf,
        /// Whether one of them is a conformance set.
        set: bool,
    },
    /// A folder has no file of any scene of the set.
    #[error(
        "no file of {} (PNG, PNM, BMP, JPEG, EXR or NPY) has the name of a scene of the set; call them NAME.png (a mask) \
         or NAME.npy (ids or distances), NAME being a scene's name, as bothways vectors writes them",
        .folder.display()
    )]
    NoFiles {
        /// The folder.
        folder: PathBuf,
    },
}

/// The reason for which a folder cannot be listed, in words.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such folder".into(),
        io::ErrorKind::NotADirectory => "it is a file, not a folder".into(),
        _ => error.to_string(),
    }
}

/// The endings of the names of files that may be buffers.
const ENDINGS: [&str; 10] = ["png", "npy", "exr", "bmp", "pgm", "ppm", "pbm", "pnm", "jpg", "jpeg"];
/// The set's file for each kind of content.
const KINDS: [&str; 3] = [".ids.npy", ".t.npy", ".mask.png"];
const INDEX: &str = "index.json";
/// The most bytes of an index. A larger file of this name belongs to another program.
const LARGEST_INDEX: u64 = 1 << 24;

/// The part of a set's index that is read.
#[derive(Deserialize)]
struct Index {
    scenes: Vec<SetScene>,
}

/// A scene of a conformance set, as the index of the set names it.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct SetScene {
    /// The name of the scene.
    pub name: String,
    /// The point of the scene, in one sentence.
    pub point: String,
}

impl Pairs {
    /// Finds the pairs of files in two folders.
    ///
    /// # Errors
    ///
    /// An error for a folder that cannot be listed, a damaged index, or folders without a pair.
    pub fn find(a: &Path, b: &Path) -> Result<Pairs, PairsError> {
        let (in_a, in_b) = (buffers(a)?, buffers(b)?);
        let pairs = match (index(a)?, index(b)?) {
            // Two sets are two folders with the same names; the index of one set gives the points of the scenes.
            (Some(index), None) => of_a_set(b, &in_b, &index.scenes).swapped(),
            (None, Some(index)) => of_a_set(a, &in_a, &index.scenes),
            _ => by_name(&in_a, &in_b),
        };
        if pairs.pairs.is_empty() {
            let set = pairs.set.is_some();
            return Err(PairsError::NoPairs { a: a.to_owned(), b: b.to_owned(), set });
        }
        Ok(pairs)
    }

    /// Whether every file has a partner.
    pub fn is_complete(&self) -> bool {
        self.missing_in_a.is_empty() && self.missing_in_b.is_empty()
    }

    /// The word for the missing things, in the plural.
    pub fn things(&self) -> &'static str {
        if self.set.is_some() { "scenes" } else { "files" }
    }

    /// The same pairs with the folders in the other order.
    fn swapped(self) -> Pairs {
        let swap = |Pair { name, a, b, point }| Pair { name, a: b, b: a, point };
        Pairs {
            set: self.set.map(|side| if side == Side::B { Side::A } else { Side::B }),
            pairs: self.pairs.into_iter().map(swap).collect(),
            missing_in_a: self.missing_in_b,
            missing_in_b: self.missing_in_a,
            ignored: self.ignored,
        }
    }
}

/// The scenes of the conformance set in a folder; `None` if the folder is no set: it has no index, or one of another program.
///
/// # Errors
///
/// An error for a damaged index. A file of that name that is no JSON is one.
pub fn scenes_of_set(folder: &Path) -> Result<Option<Vec<SetScene>>, PairsError> {
    if let Some(Err(error)) = json_of_index(folder) {
        return Err(PairsError::Index { path: folder.join(INDEX), error });
    }
    Ok(index(folder)?.map(|index| index.scenes))
}

/// The files of a folder, A, that show scenes of a set, B.
///
/// # Errors
///
/// An error for a folder that cannot be listed, or that has no file of any scene.
pub fn files_of_set(folder: &Path, scenes: &[SetScene]) -> Result<Pairs, PairsError> {
    let pairs = of_a_set(folder, &buffers(folder)?, scenes);
    if pairs.pairs.is_empty() {
        return Err(PairsError::NoFiles { folder: folder.to_owned() });
    }
    Ok(pairs)
}

/// Which of two files is part of a conformance set, if exactly one is: its folder has the index of the set, and the
/// index has the scene at the beginning of the file's name.
pub fn reference(a: &Path, b: &Path) -> Option<Side> {
    let is_of_set = |path: &Path| {
        let scene = path.file_name()?.to_str()?.split('.').next()?.to_owned();
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let index = index(folder.unwrap_or(Path::new("."))).ok()??;
        index.scenes.iter().any(|one| one.name == scene).then_some(())
    };
    match [a, b].map(|path| is_of_set(path).is_some()) {
        [true, false] => Some(Side::A),
        [false, true] => Some(Side::B),
        _ => None,
    }
}

/// The names of all files of a folder that may be buffers.
fn buffers(folder: &Path) -> Result<BTreeSet<String>, PairsError> {
    let failed = |error| PairsError::Folder { folder: folder.to_owned(), error };
    let mut names = BTreeSet::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        let path = entry.path();
        let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_lowercase);
        let may_be = ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()));
        // A name that is not valid text has no partner in a set, and no message could print the name of its partner.
        if let (true, true, Ok(name)) = (may_be, path.is_file(), entry.file_name().into_string()) {
            names.insert(name);
        }
    }
    Ok(names)
}

/// The index of a conformance set, if the folder is one.
fn index(folder: &Path) -> Result<Option<Index>, PairsError> {
    // Other programs also have files with this name, and not all of them are JSON.
    let Some(Ok(value)) = json_of_index(folder) else { return Ok(None) };
    if value["set"] != "bothways" {
        return Ok(None);
    }
    let path = folder.join(INDEX);
    serde_json::from_value(value).map(Some).map_err(|error| PairsError::Index { path, error })
}

/// The content of the file with the name of an index; `None` if there is none that can be read.
fn json_of_index(folder: &Path) -> Option<serde_json::Result<serde_json::Value>> {
    let (mut text, file) = (Vec::new(), regular_file(&folder.join(INDEX)).ok()?);
    file.take(LARGEST_INDEX).read_to_end(&mut text).ok()?;
    Some(serde_json::from_slice(&text))
}

/// The pairs of a folder next to the set, which is B.
fn of_a_set(folder: &Path, files: &BTreeSet<String>, scenes: &[SetScene]) -> Pairs {
    let mut left: BTreeSet<&String> = files.iter().collect();
    let (mut pairs, mut missing) = (Vec::new(), Vec::new());
    for SetScene { name, point } in scenes {
        let of_scene = |file: &&String| file.split('.').next() == Some(name.as_str());
        let own: Vec<&String> = files.iter().filter(of_scene).collect();
        if own.is_empty() {
            missing.push(name.clone());
        }
        for file in own {
            left.remove(file);
            let kind = kind(folder, file);
            pairs.push(Pair {
                name: format!("{name}{}", kind.rsplit_once('.').map_or(kind, |(kind, _)| kind)),
                a: file.clone(),
                b: format!("{name}{kind}"),
                point: Some(point.clone()),
            });
        }
    }
    Pairs {
        set: Some(Side::B),
        pairs,
        missing_in_a: missing,
        missing_in_b: Vec::new(),
        ignored: left.into_iter().cloned().collect(),
    }
}

/// The set's file to compare with: chosen by the file's name, otherwise by its content.
fn kind(folder: &Path, file: &str) -> &'static str {
    let named = KINDS.into_iter().find(|kind| file.ends_with(kind));
    named.unwrap_or_else(|| match read(&folder.join(file), None) {
        Ok(buffer) => match buffer.content() {
            Content::Ids(_) | Content::Frame(_) => ".ids.npy",
            Content::Distances(_) => ".t.npy",
            Content::Mask(_) | Content::Normals(_) | Content::Picture(_) => ".mask.png",
        },
        // The comparison itself reports the error in this file.
        Err(_) => ".mask.png",
    })
}

fn by_name(a: &BTreeSet<String>, b: &BTreeSet<String>) -> Pairs {
    let pair = |file: &String| {
        let name = file.rsplit_once('.').map_or(file.as_str(), |(name, _)| name);
        Pair { name: name.to_owned(), a: file.clone(), b: file.clone(), point: None }
    };
    Pairs {
        set: None,
        pairs: a.intersection(b).map(pair).collect(),
        missing_in_a: b.difference(a).cloned().collect(),
        missing_in_b: a.difference(b).cloned().collect(),
        ignored: Vec::new(),
    }
}
