//! The threads of a run.

use super::failure::Failure;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// So many threads; as many as the machine has for 0.
///
/// # Errors
///
/// Threads that do not start: their stacks count to the memory of the run.
pub(super) fn thread_pool(threads: usize) -> Result<ThreadPool, Failure> {
    ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| {
        let number = if threads == 0 { "the".to_owned() } else { threads.to_string() };
        Failure::new(format!(
            "cannot start {number} threads ({error}): give fewer with --threads, or allow more memory or more processes"
        ))
    })
}
