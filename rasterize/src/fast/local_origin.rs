//! Offsets from a point near the scene, for an eye that is far from it.

use super::high_precision::DoubleDouble;
use bothways_common::{Camera, Projection};
use glam::DVec3;

/// The local origin: the point `t·D` of a parallel camera's middle ray `0 + t·D`, exactly; or the eye itself.
///
/// From an eye that is a million times as far from the scene as the scene is large, an offset has twenty bits less
/// for where it is seen. But parallel rays may begin anywhere on their line: edge functions and places are the same
/// for offsets from the local origin, which are short, and depths are less by `t`.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalOrigin {
    pub(super) t: f64,
    /// The point is the sum of both; the second is at most a rounding of the first.
    high: DVec3,
    low: DVec3,
}

impl LocalOrigin {
    /// The eye itself.
    const EYE: LocalOrigin = LocalOrigin { t: 0.0, high: DVec3::ZERO, low: DVec3::ZERO };

    /// The middle of a scene's depth, if that lies far in front of a parallel camera; otherwise the eye. `bounds` are
    /// the corners of a box around the scene.
    pub(super) fn new(camera: &Camera, bounds: &[DVec3; 8]) -> LocalOrigin {
        /// An eye is far if its distance is more than this many times the depth of the scene.
        const FAR: f64 = 16.0;
        if camera.projection() == Projection::Perspective {
            return LocalOrigin::EYE;
        }
        let depth = |corner: &DVec3| -(*corner - camera.eye().as_dvec3()).dot(camera.w());
        let low = bounds.iter().map(depth).fold(f64::INFINITY, f64::min);
        let high = bounds.iter().map(depth).fold(f64::NEG_INFINITY, f64::max);
        let t = f64::midpoint(low, high);
        // Written so that NaN and infinity, of a scene of planes alone, fail.
        if low > 0.0 && t > FAR * (high - low) && t < f64::MAX {
            LocalOrigin::at(t, -camera.w())
        } else {
            LocalOrigin::EYE
        }
    }

    /// Neither over- nor underflows: lengths are at most 2¹³⁰, coordinates of a frame 0 or at least 2⁻¹⁰⁰.
    fn at(t: f64, direction: DVec3) -> LocalOrigin {
        let point = direction.to_array().map(|along| DoubleDouble::product(t, along));
        let [high, low] = [point.map(|x| x.high), point.map(|x| x.low)].map(DVec3::from_array);
        LocalOrigin { t, high, low }
    }

    /// The two parts of the point, which [`LocalOrigin::relative`] subtracts one after the other.
    pub(super) fn parts(&self) -> [DVec3; 2] {
        [self.high, self.low]
    }

    /// An offset from the eye as one from the local origin, each coordinate rounded twice.
    ///
    /// The second rounding is one of the result. The first is, too: either a coordinate and the point's are
    /// within a factor of two, and their difference is exact (Sterbenz, "Floating-Point Computation", 1974); or it is
    /// at least half of the point's, of which the second part is less than 2⁻⁵³.
    pub(super) fn relative(&self, offset: DVec3) -> DVec3 {
        (offset - self.high) - self.low
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_on_the_ray_is_at_the_local_origin() {
        let direction = DVec3::new(0.6, 0.0, -0.8);
        let local = LocalOrigin::at(1e6 + 1.0 / 3.0, direction);
        let [high, low] = local.parts();
        assert_eq!(local.relative(high), -low);
        assert!(low != DVec3::ZERO && low.length() < 1e-9);
        let beside = high + DVec3::new(0.0, 3.5, 0.0);
        assert_eq!(local.relative(beside).y, 3.5);
    }
}
