//! Measured times.

use serde::Serialize;
use std::time::Instant;

/// The times of the parts of a rendering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// The work on the scene alone. A moving camera would not repeat this work.
    pub prepare: Spread,
    /// The work per frame from the cleared frame to all ids and distances.
    pub visibility: Spread,
    /// The work per frame on the look of the visible primitives: normals, textures, light and the picture.
    pub shading: Spread,
}

/// Repeated measurements of one thing, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// The median; of an even number, the mean of the two middle times.
    pub median: f64,
    /// The shortest time.
    pub min: f64,
    /// The longest time.
    pub max: f64,
}

impl Spread {
    /// The spread of some measurements in milliseconds, to a tenth of a microsecond.
    ///
    /// # Panics
    ///
    /// If there are no measurements.
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

/// Runs a function, and returns its time in milliseconds.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = Instant::now();
    let result = work();
    (result, begun.elapsed().as_secs_f64() * 1e3)
}
