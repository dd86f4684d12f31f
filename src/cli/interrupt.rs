//! Ctrl-C: the program removes half-written files, and keeps earlier files. A run that can end early is asked first.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{fs, mem, process};

/// The exit code of an interrupted program in shells.
const INTERRUPTED: i32 = 130;
/// The most attempts. Each attempt removes all files present at its beginning.
const MOST_TRIES: usize = 50;

/// A folder that the program removes if it is interrupted.
#[derive(Debug)]
struct Unfinished {
    hidden: PathBuf,
    /// Folders that were created for the hidden folder, the innermost first; the program removes them if they are
    /// empty.
    created: Vec<PathBuf>,
}

/// The state for the handling of Ctrl-C.
#[derive(Debug)]
struct State {
    unfinished: Vec<Unfinished>,
    /// Everything is written and in its place: nothing can be undone any more.
    placed: bool,
    /// Ctrl-C was pressed after that.
    asked: bool,
    /// The first Ctrl-C asks the run to end early.
    asks_first: bool,
    /// The run goes on when a file is in place, and this is then said of it.
    goes_on: Option<String>,
    /// What is said of the files that are in place while the run goes on.
    stays: Option<String>,
    /// The run writes to standard output, a device or a pipe, where nothing can be undone.
    streams: bool,
}

impl State {
    const BEGIN: State = State {
        unfinished: Vec::new(),
        placed: false,
        asked: false,
        asks_first: false,
        goes_on: None,
        stays: None,
        streams: false,
    };
}

static STATE: Mutex<State> = Mutex::new(State::BEGIN);

/// Whether the run is asked to end early.
static ENDS_EARLY: AtomicBool = AtomicBool::new(false);

/// From now on, the first Ctrl-C only sets this value, and the run ends by itself. A second one ends the program.
pub(super) fn first_asks() -> &'static AtomicBool {
    state().asks_first = true;
    &ENDS_EARLY
}

/// From now on, the run writes to standard output, a device or a pipe: what arrives there stays.
pub(super) fn streams() {
    state().streams = true;
}

/// From now on, the run goes on when a file is in place; if it is then interrupted, this is said.
pub(super) fn goes_on(stays: String) {
    state().goes_on = Some(stays);
}

/// The files that come now are the last ones.
pub(super) fn goes_on_no_longer() {
    state().goes_on = None;
}

/// Marks a folder as unfinished until this value is dropped.
#[derive(Debug)]
pub(super) struct Guard(PathBuf);

/// Sets up Ctrl-C: from now on, it removes unfinished folders before the program ends.
pub(super) fn clean_up() {
    // Without a handler, an interrupted run leaves a hidden folder: this is no reason to refuse the run.
    let _ = ctrlc::set_handler(|| {
        // The lock is held to the end: no other thread begins, moves or finishes a file.
        let mut state = state();
        if state.asks_first {
            if !ENDS_EARLY.swap(true, Ordering::Relaxed) {
                return;
            }
        } else if state.is_left_to_end() {
            return;
        }
        for Unfinished { hidden, created } in &state.unfinished {
            // Other threads continue to write: the loop also removes the files of these writes.
            for _ in 0..MOST_TRIES {
                if fs::remove_dir_all(hidden).is_ok() {
                    break;
                }
            }
            for folder in created {
                let _ = fs::remove_dir(folder);
            }
        }
        anstream::eprintln!("\n{}", state.said());
        process::exit(INTERRUPTED);
    });
}

impl State {
    /// What the program says at its end: what became of the files.
    fn said(&self) -> String {
        match (&self.stays, self.placed) {
            (_, true) => "interrupted: all files are written".into(),
            (Some(stays), false) => format!("interrupted: {stays}"),
            (None, false) if self.streams => "interrupted".into(),
            (None, false) => "interrupted: nothing was written".into(),
        }
    }

    /// The files of a guard are in their places. That is the end, unless the run goes on: this is known before, so that no
    /// Ctrl-C in between is taken for one at the end.
    fn is_in_place(&mut self) {
        match &self.goes_on {
            Some(stays) => self.stays = Some(stays.clone()),
            None => self.placed = true,
        }
    }

    /// Whether a run is so near its end that it may continue: all files are in place, and the exit code reports their
    /// content. A second Ctrl-C ends the run.
    fn is_left_to_end(&mut self) -> bool {
        self.placed && !mem::replace(&mut self.asked, true)
    }
}

/// A lock: Ctrl-C waits until this value is dropped.
#[derive(Debug)]
pub(super) struct Held(MutexGuard<'static, State>);

/// Delays Ctrl-C during a step that must not stop half-way.
pub(super) fn hold() -> Held {
    Held(state())
}

impl Held {
    /// Registers a folder as unfinished, together with the folders created for it.
    pub(super) fn guard(&mut self, hidden: &Path, created: &[PathBuf]) -> Guard {
        let hidden = hidden.to_owned();
        let created = created.to_owned();
        self.0.unfinished.push(Unfinished { hidden: hidden.clone(), created });
        Guard(hidden)
    }

    /// Registers that all files of a guard are in their places.
    pub(super) fn placed(&mut self, guard: &Guard) {
        self.0.unfinished.retain(|one| one.hidden != guard.0);
        self.0.is_in_place();
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
    fn an_interrupted_run_says_what_became_of_its_files() {
        let mut state = State::BEGIN;
        assert_eq!(state.said(), "interrupted: nothing was written");
        state.streams = true;
        assert_eq!(state.said(), "interrupted");
        state.stays = Some("a.csv stays".into());
        assert_eq!(state.said(), "interrupted: a.csv stays");
        state.placed = true;
        assert_eq!(state.said(), "interrupted: all files are written");
    }

    #[test]
    fn a_run_that_goes_on_ends_at_once_right_after_a_file() {
        let mut state = State { goes_on: Some("a.csv stays".into()), ..State::BEGIN };
        assert_eq!(state.said(), "interrupted: nothing was written");
        state.is_in_place();
        assert!(!state.is_left_to_end());
        assert_eq!(state.said(), "interrupted: a.csv stays");
        state.goes_on = None;
        state.is_in_place();
        assert!(state.is_left_to_end());
    }

    #[test]
    fn only_a_run_whose_files_are_in_place_goes_on_and_once() {
        let mut state = State::BEGIN;
        assert!(!state.is_left_to_end());
        state.placed = true;
        assert!(state.is_left_to_end());
        assert!(!state.is_left_to_end());
    }
}
