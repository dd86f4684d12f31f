//! The output folder: all files of a run appear together at its end, or no file appears.
//!
//! A new folder appears by one rename. In a folder that exists (a shell may use it, and other files stay), one run at
//! a time renames file by file. The last file, the report, is removed before any other file moves, and written when
//! all other files are in place: if a run stops at any point, the folder never shows a report together with the files
//! of another run.

mod file;
mod folders;
mod hidden;
mod png;
mod sink;

pub(super) use file::OutputFile;
pub(super) use sink::Out;

use super::exr;
use super::failure::Failure;
use super::interrupt;
use super::reason::reason;
use folders::missing_folders;
use hidden::Hidden;
use rayon::prelude::*;
use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Every file that `render` may write. A run removes the files of this list that it does not write, so that the
/// folder never shows a picture of one run together with the report of another. The report is the last file.
const NAMES: [&str; 14] = [
    "object-order.png",
    "image-order.png",
    "mask-object-order.png",
    "mask-image-order.png",
    "difference.png",
    "side-by-side.png",
    "object-order.ids.npy",
    "object-order.t.npy",
    "object-order.ids.png",
    "image-order.ids.npy",
    "image-order.t.npy",
    "image-order.ids.png",
    exr::NAME,
    "report.json",
];

/// The longest wait for another run to move its files into the same folder.
const PATIENCE: Duration = Duration::from_secs(30);

/// Files that are written, but not yet in their final place.
#[derive(Debug)]
pub(super) struct Staging {
    target: PathBuf,
    /// The option that names the folder.
    option: &'static str,
    /// A folder next to a new target folder, or within an existing target folder: in both cases, a rename moves the
    /// files. `None` after its removal.
    hidden: Option<Hidden>,
    /// Folders that the run created, the innermost first.
    created: Vec<PathBuf>,
    /// Every file that this kind of run may write; the run changes no other file.
    names: Vec<String>,
    written: Vec<String>,
}

/// One of the files of a run, and what writes its content.
pub(super) struct NewFile<'a> {
    name: String,
    fill: Box<dyn FnOnce(File) -> io::Result<()> + Send + 'a>,
}

impl<'a> NewFile<'a> {
    /// A file with this content.
    pub(super) fn new(
        name: impl Into<String>,
        content: impl FnOnce(&mut Out) -> io::Result<()> + Send + 'a,
    ) -> NewFile<'a> {
        NewFile { name: name.into(), fill: Box::new(|file| sink::fill(file, content)) }
    }

    /// A file whose writer also moves back within it.
    pub(super) fn seekable(
        name: impl Into<String>,
        content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()> + Send + 'a,
    ) -> NewFile<'a> {
        let fill = |file| {
            let mut out = BufWriter::new(file);
            content(&mut out).and_then(|()| out.flush())
        };
        NewFile { name: name.into(), fill: Box::new(fill) }
    }
}

impl Staging {
    /// Prepares to write the target folder of `render`.
    pub(super) fn begin(target: &Path) -> Result<Staging, Failure> {
        Staging::begin_with(target, NAMES.map(str::to_owned).to_vec())
    }

    /// Prepares to write these files into the target folder. The presence of the last file shows that all are complete.
    pub(super) fn begin_with(target: &Path, names: Vec<String>) -> Result<Staging, Failure> {
        Staging::begin_for("-o", target, names)
    }

    /// The same for the folder of another option.
    pub(super) fn begin_for(
        option: &'static str,
        target: &Path,
        names: Vec<String>,
    ) -> Result<Staging, Failure> {
        if target == Path::new("-") {
            return Err(Failure::new(format!(
                "{option} - is standard output, which takes one file, and here a folder of files is \
                 written; name a folder (one that is called - as ./-)"
            )));
        }
        let mut staging = Staging {
            target: target.to_owned(),
            option,
            hidden: None,
            created: Vec::new(),
            names,
            written: Vec::new(),
        };
        // Dropping the staging removes everything created before the failure.
        staging.make().map_err(|error| staging.failure(&error))?;
        staging.check_names()?;
        Ok(staging)
    }

    /// Creates the hidden folder, and the missing folders above it.
    fn make(&mut self) -> io::Result<()> {
        let mut held = interrupt::hold();
        let home = self.home()?;
        self.created = missing_folders(&home);
        fs::create_dir_all(&home)?;
        if home != self.target {
            // Other runs with this target folder began before the folder existed.
            hidden::remove_dead(&self.target);
        }
        let hidden = Hidden::within(&home, &self.created, &mut held)?;
        let made = fs::create_dir(hidden.path().join(NEW));
        self.hidden = Some(hidden);
        drop(held);
        made
    }

    /// The folder that holds the hidden one.
    fn home(&self) -> io::Result<PathBuf> {
        if self.target.as_os_str().is_empty() {
            return Err(io::Error::new(ErrorKind::InvalidInput, "the name is empty"));
        }
        if self.target.exists() {
            return Ok(self.target.clone());
        }
        if self.target.is_symlink() {
            return Err(io::Error::new(ErrorKind::InvalidInput, "it is a link that leads nowhere"));
        }
        let above = self.target.parent().filter(|above| !above.as_os_str().is_empty());
        Ok(above.unwrap_or(Path::new(".")).to_owned())
    }

    /// Writes one of the files.
    pub(super) fn write(
        &mut self,
        name: &str,
        content: impl FnOnce(&mut Out) -> io::Result<()>,
    ) -> Result<(), Failure> {
        self.write_with(name, |file| sink::fill(file, content))
    }

    fn write_with(
        &mut self,
        name: &str,
        fill: impl FnOnce(File) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let result = self.create(name, fill);
        self.written.push(name.into());
        result
    }

    /// Writes several of the files at once, on the current rayon pool. The first of those that cannot be written is the
    /// failure.
    pub(super) fn write_all(&mut self, files: Vec<NewFile>) -> Result<(), Failure> {
        self.written.extend(files.iter().map(|file| file.name.clone()));
        let create = |file: NewFile| self.create(&file.name, file.fill);
        let results: Vec<_> = files.into_par_iter().with_max_len(1).map(create).collect();
        results.into_iter().collect()
    }

    fn create(&self, name: &str, fill: impl FnOnce(File) -> io::Result<()>) -> Result<(), Failure> {
        let known = self.names.iter().any(|known| known == name);
        debug_assert!(known, "{name} would never be replaced or removed");
        let path = self.new_files().join(name);
        File::create(path).and_then(fill).map_err(|error| {
            let place = self.target.join(name);
            let reason = reason(&error, &format!("choose another folder with {}", self.option));
            Failure::new(format!("cannot write {}: {reason}", place.display()))
        })
    }

    /// Moves all files to their places, and replaces the files of earlier runs.
    pub(super) fn commit(mut self) -> Result<(), Failure> {
        let placed = self.place_folder().or_else(|_| self.place_files());
        placed.map_err(|error| self.failure(&error))?;
        self.created.clear();
        Ok(())
    }

    /// Makes the whole folder appear by one rename, if the folder does not exist. If the folder exists by now, the
    /// rename fails.
    fn place_folder(&self) -> io::Result<()> {
        if self.hidden_path().parent() == Some(&self.target) {
            return Err(ErrorKind::AlreadyExists.into());
        }
        let mut held = interrupt::hold();
        fs::rename(self.new_files(), &self.target)?;
        self.placed(&mut held);
        Ok(())
    }

    /// Moves file by file into an existing folder.
    fn place_files(&self) -> io::Result<()> {
        fs::create_dir_all(&self.target)?;
        let _one_at_a_time = locked(&self.target)?;
        let mut held = interrupt::hold();
        let mut moves = Vec::new();
        self.replace(&mut moves).inspect_err(|_| {
            // The last move is undone first: an old file returns after the new file is gone.
            for (from, to) in moves.iter().rev() {
                let _ = fs::rename(to, from);
            }
        })?;
        self.placed(&mut held);
        Ok(())
    }

    /// Moves the old files away and the new files in, and records each move: the last file is moved away first, and
    /// moved in last.
    fn replace(&self, moves: &mut Vec<(PathBuf, PathBuf)>) -> io::Result<()> {
        let (old, new) = (self.hidden_path().join("old"), self.new_files());
        fs::create_dir(&old)?;
        let mut move_file = |from: PathBuf, to: PathBuf| {
            fs::rename(&from, &to)?;
            moves.push((from, to));
            io::Result::Ok(())
        };
        let steps = self.names.iter().map(|name| (name, self.written.contains(name)));
        // The file that is moved in last is moved away first.
        for (name, is_new) in self.names.last().map(|last| (last, false)).into_iter().chain(steps) {
            let place = self.target.join(name);
            if place.symlink_metadata().is_ok() {
                move_file(place.clone(), old.join(name))?;
            }
            if is_new {
                move_file(new.join(name), place)?;
            }
        }
        Ok(())
    }

    fn placed(&self, held: &mut interrupt::Held) {
        held.placed(self.hidden.as_ref().expect(HIDDEN).guard());
    }

    /// Refuses a folder with the name of a file: this program did not create it, and does not replace it.
    fn check_names(&self) -> Result<(), Failure> {
        let mut places = self.names.iter().map(|name| self.target.join(name));
        let taken = places.find(|place| place.is_dir());
        taken.map_or(Ok(()), |place| {
            let place = place.display();
            Err(Failure::new(format!(
                "{place} is a folder, where a file would be written; \
                 move it, or choose another output folder with {}",
                self.option
            )))
        })
    }

    fn hidden_path(&self) -> &Path {
        self.hidden.as_ref().expect(HIDDEN).path()
    }

    /// The folder of the waiting files: it gets the usual permissions, while the hidden folder is private to the
    /// user.
    fn new_files(&self) -> PathBuf {
        self.hidden_path().join(NEW)
    }

    fn failure(&self, error: &io::Error) -> Failure {
        let remedy = format!("choose another one with {}", self.option);
        let (folder, reason) = (self.target.display(), reason(error, &remedy));
        Failure::new(format!("cannot write into the folder {folder}: {reason}"))
    }
}

const NEW: &str = "new";
const HIDDEN: &str = "the hidden folder is there until the end";

/// Waits until no other run moves files into a folder, and makes other runs wait. `None` if the system cannot lock
/// folders.
fn locked(folder: &Path) -> io::Result<Option<File>> {
    let Ok(folder) = File::open(folder) else { return Ok(None) };
    let begun = Instant::now();
    loop {
        match folder.try_lock() {
            Ok(()) => return Ok(Some(folder)),
            Err(TryLockError::Error(_)) => return Ok(None),
            Err(TryLockError::WouldBlock) if begun.elapsed() > PATIENCE => {
                return Err(ErrorKind::ResourceBusy.into());
            }
            Err(TryLockError::WouldBlock) => sleep(Duration::from_millis(10)),
        }
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        self.hidden = None;
        for folder in &self.created {
            // The call removes only empty folders.
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
        // The test removes the last file: the move of this file cannot succeed.
        fs::remove_file(staging.new_files().join("report.json")).unwrap();
        assert!(staging.commit().is_err());
        for name in ["object-order.png", "report.json"] {
            assert_eq!(fs::read_to_string(home.path().join(name)).unwrap(), "old");
        }
    }
}
