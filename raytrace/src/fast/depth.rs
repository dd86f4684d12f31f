//! Depth keys: `f32` numbers that are larger for what is nearer, as intervals that hold the true ones.

use bothways_common::Projection;
use bothways_common::engine::roundoff::{EPS53, Interval};

/// How `t` becomes a key: `1/(s·t)` (perspective) or `−s·t` (parallel), with the scale `s`.
#[derive(Clone, Copy, Debug)]
pub(super) struct KeyScale {
    pub(super) projection: Projection,
    /// A power of two, or one over the spacing of samples: the first coordinate of the map is `t` times this.
    pub(super) scale: f64,
}

impl KeyScale {
    /// The key interval of an interval of `t`, widened to `f32`s: its low end, for what is far, and its high end.
    ///
    /// Four roundings in `f64` are far less than the last place of an `f32`, and one is the conversion's.
    pub(super) fn keys(&self, t: Interval) -> [f32; 2] {
        let [low, high] = [t.low * self.scale, t.high * self.scale];
        let [far, near] = match self.projection {
            Projection::Perspective if low > 0.0 => [1.0 / high, 1.0 / low],
            Projection::Perspective => [1.0 / high.max(0.0), f64::INFINITY],
            Projection::Parallel => [-high, -low],
        };
        #[expect(clippy::cast_possible_truncation, reason = "widened by more than that")]
        let [far, near] = [far as f32, near as f32];
        let (far, near) = (far.next_down().next_down(), near.next_up().next_up());
        // NaN must not look like an order.
        if far <= near { [far, near] } else { [f32::NEG_INFINITY, f32::INFINITY] }
    }

    /// The computed `t`, in the map's scale, beyond which everything is certainly farther than a key; `t_error` is
    /// [`MapErrors::t`](super::camera_map::MapErrors::t).
    pub(super) fn farthest(&self, key: f32, t_error: f64) -> f64 {
        let key = f64::from(key);
        match self.projection {
            Projection::Perspective if key > 0.0 => (1.0 / key) * (1.0 + t_error + 8.0 * EPS53),
            Projection::Perspective => f64::INFINITY,
            Projection::Parallel => -key + t_error,
        }
    }
}
