//! Which scenes are being drawn, and since when.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The threads of a run, as a further thread watches them.
#[derive(Debug)]
pub(super) struct Watch {
    state: Mutex<State>,
    ended: Condvar,
}

#[derive(Debug)]
struct State {
    /// The threads that have not ended.
    threads: usize,
    scenes: Vec<Drawing>,
}

/// A scene that is being drawn.
#[derive(Debug)]
struct Drawing {
    number: u64,
    begun: Instant,
    is_told: bool,
}

/// How often the watching thread looks, as a part of its patience.
const LOOKS: u32 = 10;

impl Watch {
    pub(super) fn new(threads: usize) -> Watch {
        let state = State { threads, scenes: Vec::new() };
        Watch { state: Mutex::new(state), ended: Condvar::new() }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts a thread as ended once it is dropped.
    pub(super) fn guard(&self) -> impl Drop + '_ {
        OnDrop(move || {
            self.state().threads -= 1;
            self.ended.notify_all();
        })
    }

    /// A scene is being drawn until this is dropped.
    pub(super) fn scene(&self, number: u64) -> impl Drop + '_ {
        let drawing = Drawing { number, begun: Instant::now(), is_told: false };
        self.state().scenes.push(drawing);
        OnDrop(move || self.state().scenes.retain(|drawing| drawing.number != number))
    }

    /// Waits for a part of the patience; whether some thread has not ended by then.
    pub(super) fn goes_on(&self, patience: Duration) -> bool {
        let waited = self
            .ended
            .wait_timeout_while(self.state(), patience / LOOKS, |state| state.threads > 0);
        waited.unwrap_or_else(PoisonError::into_inner).0.threads > 0
    }

    /// The scenes that take longer than this, each once.
    pub(super) fn slow(&self, patience: Duration) -> Vec<u64> {
        let mut state = self.state();
        let slow = state
            .scenes
            .iter_mut()
            .filter(|drawing| !drawing.is_told && drawing.begun.elapsed() >= patience);
        slow.map(|drawing| {
            drawing.is_told = true;
            drawing.number
        })
        .collect()
    }

    /// The scenes that are being drawn, by number.
    pub(super) fn scenes(&self) -> Vec<u64> {
        let mut scenes: Vec<u64> =
            self.state().scenes.iter().map(|drawing| drawing.number).collect();
        scenes.sort_unstable();
        scenes
    }
}

/// Calls a function once it is dropped.
struct OnDrop<F: FnMut()>(F);

impl<F: FnMut()> Drop for OnDrop<F> {
    fn drop(&mut self) {
        (self.0)();
    }
}
