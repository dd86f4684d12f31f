//! What the numbers of a file stand for: ids from 1, depths along the axis, 0 for nothing, ….

use crate::diff::tolerance::DEPTH_TOLERANCE;

/// What the numbers of a file stand for. The default is ours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Encoding {
    /// The number of a primitive.
    pub ids: IdEncoding,
    /// The number of a distance.
    pub distances: DistanceEncoding,
    /// The number of nothing.
    pub nothing: NothingEncoding,
}

impl Encoding {
    /// Whether the numbers of a file stand for what ours stand for.
    pub fn is_ours(&self) -> bool {
        self.parts() == 0
    }

    /// Whether it has numbers that only the file suggests: they fit a part of any file.
    pub(super) fn has_own_numbers(&self) -> bool {
        use DistanceEncoding::{Linear, ReversedWindow, Window};
        matches!(self.distances, Linear { .. } | Window { .. } | ReversedWindow { .. })
            || matches!(self.ids, IdEncoding::CountedFrom(first) if first > 1)
    }

    /// Whether its numbering of primitives may fit a part of any file: other orders, and numbers of objects.
    pub(super) fn is_another_numbering(&self) -> bool {
        use IdEncoding::{FromTheEnd, OfObjects, OneToOne};
        matches!(self.ids, FromTheEnd | OfObjects | OneToOne)
    }

    /// How many of them do not.
    pub(super) fn parts(&self) -> usize {
        let ours = Encoding::default();
        usize::from(self.ids != ours.ids)
            + usize::from(self.distances != ours.distances)
            + usize::from(self.nothing != ours.nothing)
    }
}

/// The number of a primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IdEncoding {
    /// Counted from 0 in the order of the scene.
    #[default]
    FromZero,
    /// Counted from this number, which is not 0.
    CountedFrom(u64),
    /// Counted from the end of the scene.
    FromTheEnd,
    /// The number of the object, for all its primitives.
    OfObjects,
    /// Some number of its own for each primitive.
    OneToOne,
}

/// The number of a distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DistanceEncoding {
    /// `t`, in lengths of the ray's direction.
    #[default]
    T,
    /// The depth along the axis of the camera, `t·d`.
    AlongAxis,
    /// The distance along the ray, `t·|(x, y, −d)|`.
    AlongRay,
    /// `−t`.
    NegativeT,
    /// `−t·d`: the z of the camera's axes.
    NegativeAlongAxis,
    /// `−t·|(x, y, −d)|`.
    NegativeAlongRay,
    /// `factor·t + offset`.
    Linear {
        /// What `t` is multiplied by.
        factor: f64,
        /// What is added.
        offset: f64,
    },
    /// The window depth of OpenGL, from 0 at the near plane to 1 at the far plane.
    Window {
        /// Depth of the near plane along the axis.
        near: f64,
        /// Depth of the far plane along the axis.
        far: f64,
    },
    /// The same from 1 at the near plane to 0 at the far plane.
    ReversedWindow {
        /// Depth of the near plane along the axis.
        near: f64,
        /// Depth of the far plane along the axis.
        far: f64,
    },
}

impl DistanceEncoding {
    /// Whether a number of a file is the one that is expected, but for roundings.
    pub(super) fn holds(self, number: f64, expected: f64) -> bool {
        let tolerance = match self {
            // A window depth is stored as `f32`, with 24 bits or fewer.
            DistanceEncoding::Window { .. } | DistanceEncoding::ReversedWindow { .. } => 1e-5,
            _ => DEPTH_TOLERANCE * number.abs().max(expected.abs()),
        };
        (number - expected).abs() <= tolerance
    }
}

/// The number of nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum NothingEncoding {
    /// All ones in ids, an infinity or NaN in distances, false in masks.
    #[default]
    Ours,
    /// This number.
    Number(f64),
    /// The opposite: a mask of what is not covered.
    Inverted,
}

impl NothingEncoding {
    /// Whether a mask with this value covers a pixel.
    pub(super) fn covers(self, value: bool) -> bool {
        value != (self == NothingEncoding::Inverted)
    }

    /// Whether an id, which is not ours of nothing, stands for nothing.
    pub(super) fn matches_id(self, id: u64) -> bool {
        #[expect(clippy::cast_precision_loss, reason = "an id that is large is not 0")]
        let is_number = |number: f64| id as f64 == number;
        matches!(self, NothingEncoding::Number(number) if is_number(number))
    }

    /// Whether a distance stands for nothing.
    pub(super) fn matches_distance(self, t: f64) -> bool {
        !t.is_finite() || self == NothingEncoding::Number(t)
    }
}

/// What stands for a far plane at infinity.
pub(super) const INFINITELY_FAR: f64 = 1e30;

/// A far plane that is farther than the near one by this factor cannot be told from none by depths in `f32`.
const MOST_FAR: f64 = 1e6;

/// The window depth that takes two depths to two numbers, if it has planes in front of the eye.
pub(super) fn window([z0, w0]: [f64; 2], [z1, w1]: [f64; 2]) -> Option<DistanceEncoding> {
    let possible = 0.0..=1.0;
    if !possible.contains(&w0) || !possible.contains(&w1) {
        return None;
    }
    let slope = (w0 - w1) / (1.0 / z0 - 1.0 / z1);
    let limit = w0 - slope / z0;
    let depth_of = |number: f64| slope / (number - limit);
    let [zero, one] = [0.0, 1.0].map(depth_of);
    let in_front = |near: f64, far: f64| near > 0.0 && far > near && near.is_finite();
    // A far plane that is infinitely far away: 1/far rounds to 0 or to less, or to a few units of the last of 24 bits.
    let far_plane = |near: f64, far: f64| {
        let is_near = far > 0.0 && far < MOST_FAR * near;
        if is_near { far } else { INFINITELY_FAR }
    };
    if slope < 0.0 && in_front(zero, far_plane(zero, one)) {
        Some(DistanceEncoding::Window { near: zero, far: far_plane(zero, one) })
    } else if slope > 0.0 && in_front(one, far_plane(one, zero)) {
        Some(DistanceEncoding::ReversedWindow { near: one, far: far_plane(one, zero) })
    } else {
        None
    }
}

/// The linear function that takes the first and the last of three distances to their numbers, if it also takes the one in the
/// middle to its own: two distances alone are on a line in any file.
pub(super) fn linear(points: [[f64; 2]; 3]) -> Option<DistanceEncoding> {
    let [[t0, n0], [t1, n1], [t2, n2]] = points;
    let close = |one: f64, other: f64| {
        (one - other).abs() <= 4.0 * DEPTH_TOLERANCE * one.abs().max(other.abs())
    };
    let is_apart = |one: f64, other: f64| (one - other).abs() > 0.01 * one.abs().max(other.abs());
    if !is_apart(t0, t1) || !is_apart(t1, t2) {
        return None;
    }
    let slope = (n2 - n0) / (t2 - t0);
    let factor = if close(slope, 1.0) { 1.0 } else { slope };
    let rest = n0 - factor * t0;
    // What rounding leaves of no offset.
    let offset = if rest.abs() <= 1e-5 * n0.abs().max(n2.abs()) { 0.0 } else { rest };
    let holds = [[t0, n0], [t1, n1], [t2, n2]]
        .into_iter()
        .all(|[t, number]| close(factor * t + offset, number));
    let is_ours = factor == 1.0 && offset == 0.0;
    (holds && factor != 0.0 && factor.is_finite() && !is_ours)
        .then_some(DistanceEncoding::Linear { factor, offset })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_depth_is_found_by_two_depths() {
        let at = |z: f64| [z, 100.0 / 99.5 * (1.0 - 0.5 / z)];
        let Some(DistanceEncoding::Window { near, far }) = window(at(0.7), at(20.0)) else {
            panic!("no window depth");
        };
        assert!((near - 0.5).abs() < 1e-12 && (far - 100.0).abs() < 1e-9, "{near} {far}");
        let reversed = |z: f64| [z, 0.5 / z];
        let found = window(reversed(0.7), reversed(20.0));
        assert!(
            matches!(found, Some(DistanceEncoding::ReversedWindow { near, .. }) if (near - 0.5).abs() < 1e-12)
        );
        assert_eq!(window([1.0, 1.0], [2.0, 2.0]), None);
    }

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "a depth that is stored as `f32`")]
    fn a_far_plane_at_infinity_is_found_by_rounded_depths() {
        let rounded = |depth: f64| f64::from(depth as f32);
        for k in 1..400_u32 {
            let (a, b) = (1.1 + 0.01 * f64::from(k), 7.3 + 0.03 * f64::from(k));
            for (name, number) in
                [("window", (|z| 1.0 - 0.1 / z) as fn(f64) -> f64), ("reversed", |z| 1.0 / z)]
            {
                let found = window([a, rounded(number(a))], [b, rounded(number(b))]);
                let (DistanceEncoding::Window { far, .. }
                | DistanceEncoding::ReversedWindow { far, .. }) = found.unwrap()
                else {
                    panic!("{name}: {found:?}");
                };
                assert_eq!(far, INFINITELY_FAR, "{name}: {found:?}");
            }
        }
    }
}
