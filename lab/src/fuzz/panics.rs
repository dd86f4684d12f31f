//! Panics of renderers: caught, and told from those of the program.

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static WATCHED: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread runs a renderer whose panics are caught. A panic hook that asks need not print anything then.
pub fn is_watched() -> bool {
    WATCHED.get()
}

/// Runs something, and gives its result or the message of its panic.
pub(super) fn caught<T>(run: impl FnOnce() -> T) -> Result<T, String> {
    WATCHED.set(true);
    // What a panic leaves behind is dropped.
    let result = catch_unwind(AssertUnwindSafe(run));
    WATCHED.set(false);
    result.map_err(|payload| message(&*payload))
}

fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| payload.downcast_ref::<&str>().copied());
    text.unwrap_or("no message").to_owned()
}
