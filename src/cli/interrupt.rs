//! Ctrl-C: half-written files are removed, and earlier files stay.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{fs, mem, process};

/// The exit code by which shells know an interrupted program.
const INTERRUPTED: i32 = 130;
/// Each try removes all that was there when it began.
const MOST_TRIES: usize = 50;

/// A folder that goes if the program is interrupted.
#[derive(Debug)]
struct Unfinished {
    hidden: PathBuf,
    /// Folders that were made for it, the innermost first; they go if they are empty.
    created: Vec<PathBuf>,
}

/// What is to be done about Ctrl-C.
#[derive(Debug)]
struct State {
    unfinished: Vec<Unfinished>,
    /// Everything is written, and where it belongs: nothing can be taken back any more.
    placed: bool,
    /// Ctrl-C was pressed since.
    asked: bool,
}

static STATE: Mutex<State> =
    Mutex::new(State { unfinished: Vec::new(), placed: false, asked: false });

/// Keeps a folder known as unfinished while it lives.
#[derive(Debug)]
pub(super) struct Guard(PathBuf);

/// From here on, Ctrl-C removes unfinished folders before the program ends.
pub(super) fn clean_up() {
    // Without a handler an interrupted run leaves a hidden folder: not worth refusing to run.
    let _ = ctrlc::set_handler(|| {
        // Kept locked to the end: nothing more is begun, moved or finished.
        let mut state = state();
        if state.is_left_to_end() {
            return;
        }
        for Unfinished { hidden, created } in &state.unfinished {
            // Other threads go on writing: what they write meanwhile goes, too.
            for _ in 0..MOST_TRIES {
                if fs::remove_dir_all(hidden).is_ok() {
                    break;
                }
            }
            for folder in created {
                let _ = fs::remove_dir(folder);
            }
        }
        if state.placed {
            anstream::eprintln!("\ninterrupted: all files are written");
        } else if !state.unfinished.is_empty() {
            anstream::eprintln!("\ninterrupted: nothing was written");
        }
        process::exit(INTERRUPTED);
    });
}

impl State {
    /// Whether a run is so near its end that it is let go on: all files are in place, and the exit code
    /// tells what they hold. A second Ctrl-C ends it.
    fn is_left_to_end(&mut self) -> bool {
        self.placed && !mem::replace(&mut self.asked, true)
    }
}

/// While this lives, Ctrl-C waits.
#[derive(Debug)]
pub(super) struct Held(MutexGuard<'static, State>);

/// Lets Ctrl-C wait for what must not stop half-way.
pub(super) fn hold() -> Held {
    Held(state())
}

impl Held {
    /// Notes a folder as unfinished, and what was made for it.
    pub(super) fn guard(&mut self, hidden: &Path, created: &[PathBuf]) -> Guard {
        let hidden = hidden.to_owned();
        let created = created.to_owned();
        self.0.unfinished.push(Unfinished { hidden: hidden.clone(), created });
        Guard(hidden)
    }

    /// Notes that all that a guard stands for is where it belongs.
    pub(super) fn placed(&mut self, guard: &Guard) {
        self.0.unfinished.retain(|one| one.hidden != guard.0);
        self.0.placed = true;
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        state().unfinished.retain(|one| one.hidden != self.0);
    }
}

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::State;

    #[test]
    fn only_a_run_whose_files_are_in_place_goes_on_and_once() {
        let mut state = State { unfinished: Vec::new(), placed: false, asked: false };
        assert!(!state.is_left_to_end());
        state.placed = true;
        assert!(state.is_left_to_end());
        assert!(!state.is_left_to_end());
    }
}
