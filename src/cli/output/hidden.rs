//! The hidden folder of a run's files until all of them are complete, and the removal of hidden folders that
//! interrupted runs left behind.

use crate::cli::interrupt::{Guard, Held};
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::TempDir;

/// The beginning of the names of hidden folders.
const PREFIX: &str = ".bothways-";
/// The file in each hidden folder that its run keeps locked until the process ends, normally or not.
const LOCK: &str = "lock";
/// The name of the lock file before the lock.
const UNLOCKED: &str = "unlocked";
/// The content of the lock file. It distinguishes our folders from the folders of other programs.
const MARK: &str =
    "A run of bothways keeps this file locked. Once nobody does, the folder may go.\n";

/// The longest time for which a new folder of a live run is empty, even on a busy machine.
const MOMENT: Duration = Duration::from_secs(600);

/// A folder for writing; dropping this value removes the folder.
#[derive(Debug)]
pub(super) struct Hidden {
    /// The first field to drop: some systems remove no file that is open.
    _lock: Option<File>,
    folder: TempDir,
    /// Removes the folder, and the folders created for it, if the program is interrupted.
    guard: Guard,
}

impl Hidden {
    /// Creates a hidden folder within a folder, and removes the hidden folders that killed runs left there.
    pub(super) fn within(
        folder: &Path,
        created: &[PathBuf],
        held: &mut Held,
    ) -> io::Result<Hidden> {
        remove_dead(folder);
        let folder = tempfile::Builder::new().prefix(PREFIX).tempdir_in(folder)?;
        let guard = held.guard(folder.path(), created);
        let hidden = Hidden { _lock: locked(folder.path()), folder, guard };
        Ok(hidden)
    }

    pub(super) fn path(&self) -> &Path {
        self.folder.path()
    }

    pub(super) fn guard(&self) -> &Guard {
        &self.guard
    }
}

/// The lock file of a new folder. It gets its name after the lock: under that name the file is always locked while
/// the run lives. `None` if the system cannot lock files: then only the folder's own run removes the folder.
fn locked(folder: &Path) -> Option<File> {
    let unnamed = folder.join(UNLOCKED);
    let mut file = File::create(&unnamed).ok()?;
    file.write_all(MARK.as_bytes()).ok()?;
    file.try_lock().ok()?;
    fs::rename(unnamed, folder.join(LOCK)).ok()?;
    Some(file)
}

/// Removes the hidden folders of runs that no longer exist.
pub(super) fn remove_dead(folder: &Path) {
    // A folder that cannot be read or removed stays: it does no harm.
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let ours = entry.file_name().to_string_lossy().starts_with(PREFIX);
        if !ours {
            continue;
        }
        // The lock is held during the removal, so that two runs do not remove the folder at once.
        if let Some(_lock) = lock_of_dead(&entry.path()) {
            let _ = fs::remove_dir_all(entry.path());
        } else if is_old(&entry.path()) {
            // The folder of a run that was killed before its lock; this removes only an empty folder.
            let _ = fs::remove_file(entry.path().join(UNLOCKED));
            let _ = fs::remove_dir(entry.path());
        }
    }
}

fn is_old(folder: &Path) -> bool {
    let changed = fs::symlink_metadata(folder).and_then(|folder| folder.modified());
    !folder.join(LOCK).exists()
        && changed.is_ok_and(|changed| changed.elapsed().is_ok_and(|age| age > MOMENT))
}

/// The lock of a folder that is certainly ours and that no run locks any more.
fn lock_of_dead(folder: &Path) -> Option<File> {
    let place = folder.join(LOCK);
    let is_own = |path: &Path| fs::symlink_metadata(path).ok();
    if !is_own(folder)?.is_dir() || !is_own(&place)?.is_file() {
        return None;
    }
    let mut file = File::options().read(true).write(true).open(&place).ok()?;
    file.try_lock().ok()?;
    let mut content = String::new();
    let most = MARK.len() as u64 + 1;
    (&mut file).take(most).read_to_string(&mut content).ok()?;
    (content == MARK).then_some(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::interrupt;
    use std::time::SystemTime;

    fn hidden(folder: &Path) -> Hidden {
        Hidden::within(folder, &[], &mut interrupt::hold()).unwrap()
    }

    #[test]
    fn only_what_is_ours_and_dead_is_removed() {
        let home = tempfile::tempdir().unwrap();
        let make = |name: &str, lock: Option<&str>| {
            fs::create_dir(home.path().join(name)).unwrap();
            fs::write(home.path().join(name).join("report.json"), "half").unwrap();
            if let Some(text) = lock {
                fs::write(home.path().join(name).join(LOCK), text).unwrap();
            }
        };
        make(".bothways-dead", Some(MARK));
        make(".bothways-older", None);
        make(".bothways-foreign", Some("a lock of something else\n"));
        make("bothways-dead", Some(MARK));
        for name in [".bothways-new", ".bothways-old"] {
            fs::create_dir(home.path().join(name)).unwrap();
        }
        let old = SystemTime::now() - 2 * MOMENT;
        let folder = File::open(home.path().join(".bothways-old")).unwrap();
        folder.set_modified(old).unwrap();
        let living = hidden(home.path());
        fs::write(living.path().join("report.json"), "half").unwrap();

        remove_dead(home.path());
        let stays = |name: &str| home.path().join(name).exists();
        assert!(!stays(".bothways-dead") && !stays(".bothways-old") && stays(".bothways-new"));
        assert!(stays(".bothways-older") && stays(".bothways-foreign") && stays("bothways-dead"));
        assert!(living.path().join("report.json").exists());
        let path = living.path().to_owned();
        drop(living);
        assert!(!path.exists());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_a_dead_folder_is_not_followed() {
        let (home, elsewhere) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        fs::write(elsewhere.path().join(LOCK), MARK).unwrap();
        std::os::unix::fs::symlink(elsewhere.path(), home.path().join(".bothways-link")).unwrap();
        remove_dead(home.path());
        assert!(elsewhere.path().join(LOCK).exists());
    }
}
