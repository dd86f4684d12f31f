//! The output folder: all files of a run appear together at its end, or none of them does.

use super::failure::Failure;
use super::interrupt::{self, Guard};
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Every file that `render` may write. Those that a run does not write are removed from the folder,
/// so that it never shows a picture of one run beside the report of another.
const NAMES: [&str; 11] = [
    "object-order.png",
    "image-order.png",
    "mask-object-order.png",
    "mask-image-order.png",
    "difference.png",
    "side-by-side.png",
    "report.json",
    "object-order.ids.npy",
    "object-order.t.npy",
    "image-order.ids.npy",
    "image-order.t.npy",
];

/// Files that are written, but not yet where the user looks for them.
#[derive(Debug)]
pub(super) struct Staging {
    target: PathBuf,
    /// Within the target, so that a file moves by being renamed. `None` once removed.
    folder: Option<TempDir>,
    /// Removes it and what was created if the program is interrupted.
    guard: Option<Guard>,
    /// Folders that did not exist before, the innermost first.
    created: Vec<PathBuf>,
    /// Every file that this kind of run may write; no other file is touched.
    names: Vec<String>,
    written: Vec<String>,
}

impl Staging {
    /// Makes the target folder of `render` if need be, and a hidden one within it.
    pub(super) fn begin(target: &Path) -> Result<Staging, Failure> {
        Staging::begin_with(target, NAMES.map(str::to_owned).to_vec())
    }

    /// The same for a run that may write other files.
    pub(super) fn begin_with(target: &Path, names: Vec<String>) -> Result<Staging, Failure> {
        let created: Vec<PathBuf> = target
            .ancestors()
            .take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists())
            .map(Path::to_owned)
            .collect();
        let mut staging = Staging {
            target: target.to_owned(),
            folder: None,
            guard: None,
            created,
            names,
            written: Vec::new(),
        };
        let folder = fs::create_dir_all(target)
            .and_then(|()| tempfile::Builder::new().prefix(".bothways-").tempdir_in(target));
        // Dropping the staging takes back what was made before the failure.
        staging.folder = Some(folder.map_err(|error| staging.failure(&error))?);
        staging.guard = Some(interrupt::guard(staging.hidden(), &staging.created));
        staging.check_names()?;
        Ok(staging)
    }

    /// Writes one of the files.
    pub(super) fn write(
        &mut self,
        name: &str,
        content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let known = self.names.iter().any(|known| known == name);
        debug_assert!(known, "{name} would never be replaced or removed");
        let path = self.hidden().join(name);
        let result = File::create(path).and_then(|file| {
            let mut out = BufWriter::new(file);
            content(&mut out)?;
            out.flush()
        });
        self.written.push(name.into());
        result.map_err(|error| {
            Failure::new(format!("cannot write {}: {error}", self.target.join(name).display()))
        })
    }

    /// Puts all files where they belong, in place of those of earlier runs.
    pub(super) fn commit(mut self) -> Result<(), Failure> {
        let moved = interrupt::uninterrupted(|| {
            let mut moves = Vec::new();
            self.replace(&mut moves).inspect_err(|_| {
                // The last move first: an old file returns after the new one has left.
                for (from, to) in moves.iter().rev() {
                    let _ = fs::rename(to, from);
                }
            })
        });
        moved.map_err(|error| self.failure(&error))?;
        self.created.clear();
        Ok(())
    }

    /// Moves the old files away and the new ones in, and notes each move.
    fn replace(&self, moves: &mut Vec<(PathBuf, PathBuf)>) -> io::Result<()> {
        let old = self.hidden().join("old");
        fs::create_dir(&old)?;
        let mut move_file = |from: PathBuf, to: PathBuf| {
            fs::rename(&from, &to)?;
            moves.push((from, to));
            io::Result::Ok(())
        };
        for name in &self.names {
            let place = self.target.join(name);
            if place.symlink_metadata().is_ok() {
                move_file(place.clone(), old.join(name))?;
            }
            if self.written.contains(name) {
                move_file(self.hidden().join(name), place)?;
            }
        }
        Ok(())
    }

    /// A folder of a file's name is somebody else's: it is not replaced.
    fn check_names(&self) -> Result<(), Failure> {
        let mut places = self.names.iter().map(|name| self.target.join(name));
        let taken = places.find(|place| place.is_dir());
        taken.map_or(Ok(()), |place| {
            let place = place.display();
            Err(Failure::new(format!(
                "{place} is a folder, where a file would be written; \
                 move it, or choose another output folder with -o"
            )))
        })
    }

    fn hidden(&self) -> &Path {
        self.folder.as_ref().expect("the folder exists until the end").path()
    }

    fn failure(&self, error: &io::Error) -> Failure {
        Failure::new(format!(
            "cannot write into the folder {}: {}; choose another one with -o",
            self.target.display(),
            reason(error)
        ))
    }
}

/// Writes one file: under a temporary name beside it, and renamed once it is complete.
pub(super) fn write_file(
    target: &Path,
    content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), Failure> {
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let write = || {
        let hidden = tempfile::Builder::new().prefix(".bothways-").tempdir_in(folder)?;
        let _guard = interrupt::guard(hidden.path(), &[]);
        let place = hidden.path().join("file");
        let mut out = BufWriter::new(File::create(&place)?);
        content(&mut out)?;
        out.flush()?;
        fs::rename(&place, target)
    };
    write().map_err(|error: io::Error| {
        // What tempfile says names the temporary file.
        let error = io::Error::from(error.kind());
        let (target, reason) = (target.display(), reason(&error));
        Failure::new(format!("cannot write {target}: {reason}; choose another file with -o"))
    })
}

/// Why nothing can be written, in words where the system has only a number.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "there is no such folder".into(),
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => {
            "a file is where a folder would be".into()
        }
        ErrorKind::IsADirectory => "a folder of this name is there".into(),
        ErrorKind::PermissionDenied => "there is no permission to".into(),
        _ => error.to_string(),
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        self.folder = None;
        for folder in &self.created {
            // Only what is still empty goes.
            let _ = fs::remove_dir(folder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(staging: &mut Staging, name: &str, text: &str) {
        staging.write(name, |out| out.write_all(text.as_bytes())).unwrap();
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn nothing_is_left_of_a_run_that_fails() {
        let home = tempfile::tempdir().unwrap();
        let mut staging = Staging::begin(&home.path().join("a/b")).unwrap();
        write(&mut staging, "report.json", "new");
        drop(staging);
        assert!(names(home.path()).is_empty());
    }

    #[test]
    fn earlier_files_stay_until_the_end() {
        let home = tempfile::tempdir().unwrap();
        fs::write(home.path().join("report.json"), "old").unwrap();
        let read = || fs::read_to_string(home.path().join("report.json")).unwrap();
        let mut staging = Staging::begin(home.path()).unwrap();
        write(&mut staging, "report.json", "new");
        assert_eq!(read(), "old");
        staging.commit().unwrap();
        assert_eq!(read(), "new");
        assert_eq!(names(home.path()), ["report.json"]);
    }

    #[test]
    fn files_of_an_earlier_run_go_and_foreign_files_stay() {
        let home = tempfile::tempdir().unwrap();
        fs::write(home.path().join("image-order.png"), "old").unwrap();
        fs::write(home.path().join("notes.txt"), "mine").unwrap();
        let mut staging = Staging::begin(home.path()).unwrap();
        write(&mut staging, "object-order.png", "new");
        staging.commit().unwrap();
        assert_eq!(names(home.path()), ["notes.txt", "object-order.png"]);
    }

    #[test]
    fn a_move_that_fails_is_taken_back() {
        let home = tempfile::tempdir().unwrap();
        for name in ["object-order.png", "report.json"] {
            fs::write(home.path().join(name), "old").unwrap();
        }
        let mut staging = Staging::begin(home.path()).unwrap();
        write(&mut staging, "object-order.png", "new");
        write(&mut staging, "report.json", "new");
        // Somebody takes the last file away: its move cannot succeed.
        fs::remove_file(staging.hidden().join("report.json")).unwrap();
        assert!(staging.commit().is_err());
        for name in ["object-order.png", "report.json"] {
            assert_eq!(fs::read_to_string(home.path().join(name)).unwrap(), "old");
        }
    }
}
