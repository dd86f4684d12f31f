//! How long the tasks of a frame take: what a bench needs to say how many threads a renderer could keep busy.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The times of a frame's tasks, stage by stage. A stage begins when all tasks of the one before it are done.
#[derive(Debug, Default)]
pub struct TaskTimes {
    stages: Mutex<Vec<Vec<Duration>>>,
}

impl TaskTimes {
    /// Begins a stage.
    pub fn begin_stage(times: Option<&TaskTimes>) {
        if let Some(times) = times {
            times.with(|stages| stages.push(Vec::new()));
        }
    }

    /// Carries out a task of the present stage, and notes how long it takes, if anyone wants to know.
    pub fn time<T>(times: Option<&TaskTimes>, task: impl FnOnce() -> T) -> T {
        let Some(times) = times else { return task() };
        let begun = Instant::now();
        let result = task();
        let taken = begun.elapsed();
        times.with(|stages| stages.last_mut().expect("a stage has begun").push(taken));
        result
    }

    /// The times of all stages since they were last taken; on one thread, those of a stage in the order of its tasks.
    pub fn take(&self) -> Vec<Vec<Duration>> {
        self.with(std::mem::take)
    }

    fn with<T>(&self, change: impl FnOnce(&mut Vec<Vec<Duration>>) -> T) -> T {
        change(&mut self.stages.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// The time that a stage takes on some threads, each of which takes the next task of the queue when it is done with one.
///
/// # Panics
///
/// If there are no threads.
pub fn makespan(tasks: &[Duration], threads: usize) -> Duration {
    let mut ends = vec![Duration::ZERO; threads];
    for task in tasks {
        *ends.iter_mut().min().expect("there are threads") += *task;
    }
    ends.into_iter().max().expect("there are threads")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tasks_are_noted_stage_by_stage_if_anyone_wants_to_know() {
        let times = TaskTimes::default();
        for tasks in [2, 0, 3] {
            TaskTimes::begin_stage(Some(&times));
            for task in 0..tasks {
                assert_eq!(TaskTimes::time(Some(&times), || task), task);
            }
        }
        let counts: Vec<usize> = times.take().iter().map(Vec::len).collect();
        assert_eq!(counts, [2, 0, 3]);
        assert!(times.take().is_empty());
        TaskTimes::begin_stage(None);
        assert_eq!(TaskTimes::time(None, || 5), 5);
    }

    #[test]
    fn a_stage_ends_with_its_last_thread() {
        let tasks = [5, 4, 3, 3, 1].map(Duration::from_millis);
        let ends = [1, 2, 3, 5, 9].map(|threads| makespan(&tasks, threads).as_millis());
        assert_eq!(ends, [16, 8, 6, 5, 5]);
        assert_eq!(makespan(&[], 2), Duration::ZERO);
    }
}
