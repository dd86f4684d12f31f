//! Ctrl-C: whatever is half-written goes, and what was there before stays.

use std::fs;
use std::path::{Path, PathBuf};
use std::process;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The exit code by which shells know an interrupted program.
const INTERRUPTED: i32 = 130;

/// A folder that goes if the program is interrupted.
#[derive(Debug)]
struct Unfinished {
    hidden: PathBuf,
    /// Folders that were made for it, the innermost first; they go if they are empty.
    created: Vec<PathBuf>,
}

static UNFINISHED: Mutex<Vec<Unfinished>> = Mutex::new(Vec::new());

/// Keeps a folder known as unfinished while it lives.
#[derive(Debug)]
pub(super) struct Guard(PathBuf);

/// From here on, Ctrl-C removes unfinished folders before the program ends.
pub(super) fn clean_up() {
    // Without a handler an interrupted run leaves a hidden folder: not worth refusing to run.
    let _ = ctrlc::set_handler(|| {
        // Kept locked to the end: nothing more is begun, moved or finished.
        let unfinished = unfinished();
        for Unfinished { hidden, created } in unfinished.iter() {
            let _ = fs::remove_dir_all(hidden);
            for folder in created {
                let _ = fs::remove_dir(folder);
            }
        }
        if !unfinished.is_empty() {
            anstream::eprintln!("\ninterrupted: nothing was written");
        }
        process::exit(INTERRUPTED);
    });
}

/// Notes a folder as unfinished.
pub(super) fn guard(hidden: &Path, created: &[PathBuf]) -> Guard {
    let hidden = hidden.to_owned();
    unfinished().push(Unfinished { hidden: hidden.clone(), created: created.to_owned() });
    Guard(hidden)
}

/// Does what must not stop half-way; Ctrl-C waits.
pub(super) fn uninterrupted<T>(work: impl FnOnce() -> T) -> T {
    let _lock = unfinished();
    work()
}

impl Drop for Guard {
    fn drop(&mut self) {
        unfinished().retain(|one| one.hidden != self.0);
    }
}

fn unfinished() -> MutexGuard<'static, Vec<Unfinished>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}
