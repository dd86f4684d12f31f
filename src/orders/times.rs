//! Measured times.

use serde::Serialize;
use std::time::Instant;

/// How long the parts of a rendering took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// Work on the scene alone, which a moving camera would not repeat.
    pub prepare: Spread,
    /// Per frame: from the cleared frame to all ids and distances.
    pub visibility: Spread,
    /// Per frame: normals and colours of what is visible.
    pub shading: Spread,
}

/// Repeated measurements of one thing, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// The middle one; of an even number, the mean of the middle two.
    pub median: f64,
    /// The shortest.
    pub min: f64,
    /// The longest.
    pub max: f64,
}

impl Spread {
    /// The spread of some measurements in milliseconds, to a tenth of a microsecond.
    ///
    /// # Panics
    ///
    /// If there are none.
    pub fn of(mut times: Vec<f64>) -> Spread {
        times.sort_by(f64::total_cmp);
        let rounded = |time: f64| (time * 1e4).round() / 1e4;
        let last = times.len() - 1;
        Spread {
            median: rounded(f64::midpoint(times[last / 2], times[last.div_ceil(2)])),
            min: rounded(times[0]),
            max: rounded(times[last]),
        }
    }
}

/// Does some work, and tells how many milliseconds it took.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = Instant::now();
    let result = work();
    (result, begun.elapsed().as_secs_f64() * 1e3)
}
