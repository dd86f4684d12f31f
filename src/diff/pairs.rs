//! Which file of one folder belongs to which of another.
//!
//! Beside a conformance set (see [`vectors`](crate::vectors)), a file belongs to the scene whose name it
//! begins with, `NAME.png` or `NAME.anything.npy`, and is held against the set's file of the same
//! content. In other folders, files of the same name belong together.

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
    /// Which of the folders is a conformance set, if one is.
    pub set: Option<Side>,
    /// In the order of the set, or by name.
    pub pairs: Vec<Pair>,
    /// Scenes, or else files, that only B has.
    pub missing_in_a: Vec<String>,
    /// Scenes, or else files, that only A has.
    pub missing_in_b: Vec<String>,
    /// Files beside a set that belong to none of its scenes.
    pub ignored: Vec<String>,
}

/// Two files that belong together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    /// What both are called: the file's name without its last ending, in a set the scene's and what is
    /// compared.
    pub name: String,
    /// The file in A.
    pub a: String,
    /// The file in B.
    pub b: String,
    /// Of a scene of a set, its point.
    pub point: Option<String>,
}

/// Why two folders cannot be compared.
#[derive(Debug, thiserror::Error)]
pub enum PairsError {
    /// A folder cannot be listed.
    #[error("cannot list the folder {}: {error}", .folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// A conformance set's index is damaged.
    #[error(
        "{} is not the index of a conformance set: {error}; write the set again with bothways vectors",
        .path.display()
    )]
    Index {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        error: serde_json::Error,
    },
    /// Nothing belongs together.
    #[error(
        "no file of {} (PNG, PNM, BMP or NPY) belongs to one of {}: {}",
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
}

/// The names of files that may be buffers end so.
const ENDINGS: [&str; 7] = ["png", "npy", "bmp", "pgm", "ppm", "pbm", "pnm"];
/// A set's file for each kind of content.
const KINDS: [&str; 3] = [".ids.npy", ".t.npy", ".mask.png"];
const INDEX: &str = "index.json";
/// No index is larger, whatever other programs call so.
const LARGEST_INDEX: u64 = 1 << 24;

/// What is read of a set's index.
#[derive(Deserialize)]
struct Index {
    scenes: Vec<Scene>,
}

#[derive(Deserialize)]
struct Scene {
    name: String,
    point: String,
}

impl Pairs {
    /// Finds what belongs together in two folders.
    ///
    /// # Errors
    ///
    /// A folder that cannot be listed, a damaged index, or nothing that belongs together.
    pub fn find(a: &Path, b: &Path) -> Result<Pairs, PairsError> {
        let (in_a, in_b) = (buffers(a)?, buffers(b)?);
        let pairs = match (index(a)?, index(b)?) {
            // Two sets are two folders with the same names; one says what they are about.
            (Some(index), None) => of_a_set(b, &in_b, &index).swapped(),
            (None, Some(index)) => of_a_set(a, &in_a, &index),
            _ => by_name(&in_a, &in_b),
        };
        if pairs.pairs.is_empty() {
            let set = pairs.set.is_some();
            return Err(PairsError::NoPairs { a: a.to_owned(), b: b.to_owned(), set });
        }
        Ok(pairs)
    }

    /// Whether everything has its partner.
    pub fn is_complete(&self) -> bool {
        self.missing_in_a.is_empty() && self.missing_in_b.is_empty()
    }

    /// What is missing, if something is, in the plural.
    pub fn things(&self) -> &'static str {
        if self.set.is_some() { "scenes" } else { "files" }
    }

    /// The same with the folders in the other order.
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

/// Which of two files is of a written conformance set, if one alone is: its folder has the set's index, and the
/// index the scene that its name begins with.
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
        // A name that is no text has no partner in a set, and none that could be told.
        if let (true, true, Ok(name)) = (may_be, path.is_file(), entry.file_name().into_string()) {
            names.insert(name);
        }
    }
    Ok(names)
}

/// The index of a conformance set, if the folder is one.
fn index(folder: &Path) -> Result<Option<Index>, PairsError> {
    let path = folder.join(INDEX);
    let (mut text, file) = (String::new(), regular_file(&path));
    let read = file.and_then(|file| file.take(LARGEST_INDEX).read_to_string(&mut text));
    if read.is_err() {
        return Ok(None);
    }
    let Ok(value) = serde_json::from_str::<serde_json::Value>(&text) else { return Ok(None) };
    // Other programs have indexes, too.
    if value["set"] != "bothways" {
        return Ok(None);
    }
    serde_json::from_value(value).map(Some).map_err(|error| PairsError::Index { path, error })
}

/// Files of a folder beside the set, which is B.
fn of_a_set(folder: &Path, files: &BTreeSet<String>, index: &Index) -> Pairs {
    let mut left: BTreeSet<&String> = files.iter().collect();
    let (mut pairs, mut missing) = (Vec::new(), Vec::new());
    for Scene { name, point } in &index.scenes {
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

/// The set's file that a file is held against: by its name, else by what is in it.
fn kind(folder: &Path, file: &str) -> &'static str {
    let named = KINDS.into_iter().find(|kind| file.ends_with(kind));
    named.unwrap_or_else(|| match read(&folder.join(file), None) {
        Ok(buffer) => match buffer.content() {
            Content::Ids(_) | Content::Frame(_) => ".ids.npy",
            Content::Distances(_) => ".t.npy",
            Content::Mask(_) | Content::Picture(_) => ".mask.png",
        },
        // What is wrong with it is said when it is compared.
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
