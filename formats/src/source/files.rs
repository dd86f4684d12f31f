//! Files to read, on the disk or in memory, and the files that they name.
//!
//! A scene names meshes and pictures, a mesh its materials, and these their pictures. Each name is a path from the folder of
//! the file that names it. On the disk, only the folder of the file that was opened first is read, and what is below it,
//! unless [`Reach::Anywhere`] allows more. In memory, names lead to the files that were given together.
//!
//! ```
//! use bothways_formats::mesh_file::Format;
//! use bothways_formats::source::{GivenFile, InputFile};
//!
//! let given = [
//!     GivenFile::new("a.obj", b"mtllib a.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
//!     GivenFile::new("A.MTL", b"newmtl red\nKd 1 0 0\n"),
//! ];
//! let file = InputFile::given(&given, 0);
//! let (_, warnings) = Format::Obj.read_with_materials(&file)?;
//! assert!(warnings.is_empty() && given[1].is_used());
//! # Ok::<(), bothways_formats::mesh_file::ReadMeshError>(())
//! ```

use super::quote::quoted;
use super::{READ_AT_ONCE, Unreadable, regular_file};
use crate::warning::Missing;
use std::borrow::Cow;
use std::cell::Cell;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek};
use std::path::{Path, PathBuf};

/// Which files on the disk a file may name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reach {
    /// Those in the folder of the file that was opened first, and below it, also behind links.
    #[default]
    Folder,
    /// Any.
    Anywhere,
}

/// A file in memory, which is given together with others.
#[derive(Debug)]
pub struct GivenFile<'f> {
    path: &'f str,
    bytes: &'f [u8],
    is_used: Cell<bool>,
}

impl<'f> GivenFile<'f> {
    /// A file with this name, perhaps behind the names of folders, and these bytes.
    pub fn new(path: &'f str, bytes: &'f [u8]) -> GivenFile<'f> {
        GivenFile { path, bytes, is_used: Cell::new(false) }
    }

    /// The name, behind those of folders if it has any.
    pub fn path(&self) -> &'f str {
        self.path
    }

    /// Whether the file was opened, or named by another one that was read.
    pub fn is_used(&self) -> bool {
        self.is_used.get()
    }
}

/// The files that a file may name.
#[derive(Clone, Debug)]
pub struct Files<'f> {
    /// Names are paths from here.
    folder: PathBuf,
    place: Origin<'f>,
}

#[derive(Clone, Debug)]
enum Origin<'f> {
    /// The disk; the root is the folder of the file that was opened first.
    Disk { root: PathBuf, reach: Reach },
    /// Memory.
    Given(&'f [GivenFile<'f>]),
}

/// A file to read, on the disk or in memory.
#[derive(Clone, Debug)]
pub struct InputFile<'f> {
    path: PathBuf,
    /// The same path for all names of the file.
    identity: PathBuf,
    bytes: Option<&'f [u8]>,
    files: Files<'f>,
}

/// Why a file that a file names is not read.
#[derive(Debug, thiserror::Error)]
pub enum FindFileError {
    /// It is somewhere else on the disk.
    #[error(
        "{} is not in the folder of the file that was opened, or below it; move it there, or allow it with \
         --allow-outside",
        quoted(.name)
    )]
    Outside {
        /// The file, as it is named.
        name: String,
    },
    /// It is not on the disk.
    #[error(
        "{} is a URL, and nothing is fetched; download the file, and name it by a relative path",
        quoted(.name)
    )]
    Url {
        /// The file, as it is named.
        name: String,
    },
    /// It does not exist, or the system reports another error.
    #[error("{file}: {}", Unreadable::new(.error, "a file"))]
    Unreadable {
        /// The file.
        file: String,
        /// The system's error. The message contains it, so it is not a [source](std::error::Error::source) as well.
        error: io::Error,
    },
    /// It is not among the given files.
    #[error(
        "{} is not among the opened files; open it together with the file that names it, or drop both together",
        quoted(.name)
    )]
    NotGiven {
        /// The file, as it is named.
        name: String,
    },
    /// Several of the given files have this name.
    #[error(
        "{} may be {} or {} of the opened files; open only one of them, or rename one",
        quoted(.name), quoted(&.paths[0]), quoted(&.paths[1])
    )]
    Ambiguous {
        /// The file, as it is named.
        name: String,
        /// Two of the given files.
        paths: [String; 2],
    },
}

impl FindFileError {
    /// The reason, for a file without which the others are read.
    pub(crate) fn missing(&self) -> Option<Missing> {
        match self {
            FindFileError::Outside { .. } => Some(Missing::Outside),
            FindFileError::Url { .. } => Some(Missing::Url),
            FindFileError::NotGiven { .. } => Some(Missing::NotGiven),
            FindFileError::Ambiguous { .. } => Some(Missing::Ambiguous),
            FindFileError::Unreadable { error, .. } => {
                (error.kind() == io::ErrorKind::NotFound).then_some(Missing::Absent)
            }
        }
    }
}

impl Files<'static> {
    /// Files on the disk, by paths from a folder.
    pub fn in_folder(folder: &Path, reach: Reach) -> Files<'static> {
        let root = folder.to_owned();
        Files { folder: root.clone(), place: Origin::Disk { root, reach } }
    }

    /// No files.
    pub fn none() -> Files<'static> {
        Files { folder: PathBuf::new(), place: Origin::Given(&[]) }
    }
}

impl<'f> Files<'f> {
    /// The file of a name. On the disk, it exists.
    ///
    /// Of the given files, it is the one at this path, or else the one of this name in any folder; capital and small letters
    /// count only where several files would be meant.
    ///
    /// # Errors
    ///
    /// There is no such file, it may not be read, or there are several.
    pub fn find(&self, name: &str) -> Result<InputFile<'f>, FindFileError> {
        match &self.place {
            Origin::Disk { root, reach } => self.find_on_disk(root, *reach, name),
            Origin::Given(given) => self.find_given(given, name),
        }
    }

    fn find_on_disk(
        &self,
        root: &Path,
        reach: Reach,
        name: &str,
    ) -> Result<InputFile<'f>, FindFileError> {
        if is_url(name) {
            return Err(FindFileError::Url { name: name.to_owned() });
        }
        let path = self.folder.join(name);
        let unreadable =
            |error| FindFileError::Unreadable { file: path.display().to_string(), error };
        let outside = || Err(FindFileError::Outside { name: name.to_owned() });
        let root = canonical(root).map_err(unreadable)?;
        let is_within =
            || -> io::Result<bool> { Ok(within(&root, &canonical(&self.folder)?, name)) };
        // A path that leads out is refused whether the file exists or not.
        if reach == Reach::Folder && !is_within().map_err(unreadable)? {
            return outside();
        }
        let identity = path.canonicalize().map_err(unreadable)?;
        if reach == Reach::Folder && !identity.starts_with(&root) {
            return outside();
        }
        let files = Files { folder: folder_of(&path), place: self.place.clone() };
        Ok(InputFile { path, identity, bytes: None, files })
    }

    fn find_given(
        &self,
        given: &'f [GivenFile<'f>],
        name: &str,
    ) -> Result<InputFile<'f>, FindFileError> {
        let not_given = || FindFileError::NotGiven { name: name.to_owned() };
        let wanted = parts(&format!("{}/{name}", self.folder.display()));
        let Some(base) = wanted.last() else { return Err(not_given()) };
        let alike = |index: &usize| is_alike(base_of(given[*index].path), base);
        let candidates: Vec<usize> = (0..given.len()).filter(alike).collect();
        let by_path = |path: &str| parts(path) == wanted;
        let by_any_path = |path: &str| is_alike(&parts(path).join("/"), &wanted.join("/"));
        let by_name = |path: &str| base_of(path) == base;
        let by_any_name = |_: &str| true;
        let ways: [&dyn Fn(&str) -> bool; 4] = [&by_path, &by_any_path, &by_name, &by_any_name];
        for is_meant in ways {
            let mut meant = candidates.iter().filter(|&&index| is_meant(given[index].path));
            match (meant.next(), meant.next()) {
                (Some(&index), None) => return Ok(InputFile::given(given, index)),
                (Some(&first), Some(&second)) => {
                    let paths = [first, second].map(|index| given[index].path.to_owned());
                    return Err(FindFileError::Ambiguous { name: name.to_owned(), paths });
                }
                _ => {}
            }
        }
        Err(not_given())
    }
}

impl InputFile<'static> {
    /// A file on the disk. It need not exist: reading it says so.
    pub fn on_disk(path: &Path, reach: Reach) -> InputFile<'static> {
        let files = Files::in_folder(&folder_of(path), reach);
        InputFile { path: path.to_owned(), identity: path.to_owned(), bytes: None, files }
    }
}

impl<'f> InputFile<'f> {
    /// One of the files that are given together, by its index. It is used from now on.
    ///
    /// # Panics
    ///
    /// There is no such index.
    pub fn given(files: &'f [GivenFile<'f>], index: usize) -> InputFile<'f> {
        let GivenFile { path, bytes, ref is_used } = files[index];
        is_used.set(true);
        let path = PathBuf::from(path);
        let files = Files { folder: folder_of(&path), place: Origin::Given(files) };
        InputFile { identity: path.clone(), path, bytes: Some(bytes), files }
    }

    /// Its path; for a given file, its name.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What messages call it.
    pub fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// The files that it may name.
    pub fn files(&self) -> &Files<'f> {
        &self.files
    }

    /// A path that is the same for all names by which the file was found.
    pub(crate) fn identity(&self) -> &Path {
        &self.identity
    }

    /// The bytes, if they are in memory.
    pub(crate) fn in_memory(&self) -> Option<&'f [u8]> {
        self.bytes
    }

    /// Whether it exists, and is no folder.
    pub(crate) fn is_file(&self) -> bool {
        self.bytes.is_some() || self.path.is_file()
    }

    /// The first bytes, at most so many.
    pub(crate) fn beginning(&self, most: u64) -> io::Result<Cow<'f, [u8]>> {
        if let Some(bytes) = self.bytes {
            let most = usize::try_from(most).unwrap_or(usize::MAX);
            return Ok(bytes[..bytes.len().min(most)].into());
        }
        let mut bytes = Vec::new();
        regular_file(&self.path)?.take(most).read_to_end(&mut bytes)?;
        Ok(bytes.into())
    }

    /// The number of its bytes.
    pub(crate) fn length(&self) -> io::Result<u64> {
        match self.bytes {
            Some(bytes) => Ok(bytes.len() as u64),
            None => Ok(regular_file(&self.path)?.metadata()?.len()),
        }
    }

    /// Its bytes, from any position on.
    pub(crate) fn open(&self) -> io::Result<Box<dyn Input + 'f>> {
        Ok(match self.bytes {
            Some(bytes) => Box::new(Cursor::new(bytes)),
            None => Box::new(BufReader::with_capacity(READ_AT_ONCE, regular_file(&self.path)?)),
        })
    }
}

/// Bytes that are read from any position on.
pub(crate) trait Input: BufRead + Seek {}

impl<T: BufRead + Seek> Input for T {}

fn folder_of(path: &Path) -> PathBuf {
    path.parent().unwrap_or(Path::new("")).to_owned()
}

/// The one path of a folder.
fn canonical(folder: &Path) -> io::Result<PathBuf> {
    if folder == Path::new("") { Path::new(".") } else { folder }.canonicalize()
}

/// Whether a name begins with a scheme, which is longer than the letter of a drive.
fn is_url(name: &str) -> bool {
    let scheme = name.split_once("://").map_or("", |(scheme, _)| scheme);
    let is_part = |byte: u8| byte.is_ascii_alphanumeric() || b"+-.".contains(&byte);
    scheme.len() > 1 && scheme.bytes().all(is_part)
}

/// Whether a name leads to a place in the root or below it, by its words alone. Both folders are canonical, and `folder` is
/// in the root or below.
fn within(root: &Path, folder: &Path, name: &str) -> bool {
    let below =
        |path: &Path| path.strip_prefix(root).ok().map(|rest| rest.to_string_lossy().into_owned());
    let from_root = match below(Path::new(name)) {
        Some(rest) => Some(rest),
        // A path from the root of the disk, or behind a drive or a scheme.
        None if name.starts_with(['/', '\\']) => None,
        None if name.split(['/', '\\']).next().is_some_and(|first| first.contains(':')) => None,
        None => below(folder).map(|folder| format!("{folder}/{name}")),
    };
    let Some(from_root) = from_root else { return false };
    let mut depth = 0_i64;
    for part in from_root.split(['/', '\\']) {
        depth += match part {
            ".." => -1,
            "" | "." => 0,
            _ => 1,
        };
        if depth < 0 {
            return false;
        }
    }
    true
}

/// The names of a path, one after another, without those that `..` goes back from.
fn parts(path: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    for part in path.split(['/', '\\']) {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()),
            part => parts.push(part.to_owned()),
        }
    }
    parts
}

/// The last name of a path.
fn base_of(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// Whether two texts differ in capital and small letters at most.
fn is_alike(one: &str, other: &str) -> bool {
    let [one, other] = [one, other].map(|text| text.chars().flat_map(char::to_lowercase));
    one.eq(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The path of the given file that a name leads to from the file `from`, or the message.
    fn found(paths: &[&'static str], from: usize, name: &str) -> String {
        let given: Vec<GivenFile> = paths.iter().map(|path| GivenFile::new(path, b"")).collect();
        let file = InputFile::given(&given, from);
        file.files().find(name).map_or_else(|error| error.to_string(), |found| found.name())
    }

    #[test]
    fn a_given_file_is_found_by_its_path_before_its_name() {
        let paths = ["in/a.toml", "in/x/b.obj", "y/B.obj", "in/b.png", "B.PNG"];
        assert_eq!(found(&paths, 0, "x/b.obj"), "in/x/b.obj");
        assert_eq!(found(&paths, 0, "x\\B.obj"), "in/x/b.obj");
        assert_eq!(found(&paths, 0, "z/B.obj"), "y/B.obj");
        assert_eq!(found(&paths, 0, "C:\\z\\B.obj"), "y/B.obj");
        assert_eq!(found(&paths, 1, "../b.png"), "in/b.png");
        assert_eq!(found(&paths, 0, "./B.PNG"), "in/b.png", "a path before a name");
        assert_eq!(found(&paths, 2, "B.PNG"), "B.PNG", "its own letters before others");
    }

    #[test]
    fn two_files_of_one_name_are_told_apart_or_refused() {
        let paths = ["a.toml", "x/b.png", "y/B.png"];
        assert_eq!(found(&paths, 0, "b.png"), "x/b.png");
        let says = "\"B.PNG\" may be \"x/b.png\" or \"y/B.png\" of the opened files; open only one of them, or rename one";
        assert_eq!(found(&paths, 0, "B.PNG"), says);
    }

    #[test]
    fn what_is_not_given_is_named() {
        let says = "is not among the opened files; open it together with the file that names it, or drop both together";
        assert_eq!(found(&["a.toml", "b.obj"], 0, "c.obj"), format!("\"c.obj\" {says}"));
        for name in ["", "..", "/", "b.obj/.."] {
            assert_eq!(found(&["a.toml", "b.obj"], 0, name), format!("{name:?} {says}"));
        }
        let none = Files::none().find("c.obj").unwrap_err().to_string();
        assert_eq!(none, format!("\"c.obj\" {says}"));
    }

    #[test]
    fn nothing_is_fetched() {
        for reach in [Reach::Folder, Reach::Anywhere] {
            let files = Files::in_folder(Path::new("."), reach);
            for name in ["http://a.org/b.png", "HTTPS://a", "file:///etc/passwd"] {
                let says = files.find(name).unwrap_err().to_string();
                let expected = "is a URL, and nothing is fetched; download the file, and name it by a relative path";
                assert_eq!(says, format!("{name:?} {expected}"));
            }
        }
        for name in ["C://a", "a/b://c", "://a", "http:/a", "a"] {
            assert!(!is_url(name), "{name}");
        }
    }

    #[test]
    fn words_alone_tell_what_leads_out_of_a_folder() {
        let (root, folder) = (Path::new("/r"), Path::new("/r/below"));
        for name in ["a", "../a", "x/../../a", "/r/a", "/r/x/../a", "..\\a", ""] {
            assert!(within(root, folder, name), "{name}");
        }
        for name in ["../../a", "x/../../../a", "/a", "/r/../a", "\\a", "C:a", "http://a/b"] {
            assert!(!within(root, folder, name), "{name}");
        }
    }
}
