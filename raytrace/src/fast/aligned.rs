//! Triangles whose corners lie exactly on rays through samples, or through quarters of the way between them: edges
//! through samples are decided without the judge.

use super::rays::Lens;
use super::setup::Affine;
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, SimdNarrow, SimdSplit, f32x8, f64x8, mask32x8,
    mask64x8,
};
use bothways_common::{Camera, Projection, SampleGrid};
use glam::DVec3;

/// What decides a ray through an edge: half of the least edge function but 0, added where the edge owns the ray, taken
/// away where it does not.
///
/// The contract moves the ray a little to the right, and far less down. An edge function grows with that, and so
/// the edge owns the ray, if it grows to the right; or neither grows nor falls to the right, and grows downward.
pub(super) const TIE: f32 = 1.0 / 32.0;

/// Edge functions are at most so large, so that `f32` has 24 bits for them and for [`TIE`].
const LARGEST: f64 = (1 << 17) as f64;
/// Columns and rows farther out are not asked for.
const FARTHEST: f64 = (1 << 16) as f64;

/// Rays that run straight along the world's axes, or from their middle outward by steps that `f64` holds: what they
/// are made of is not rounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Straight {
    projection: Projection,
    distance: f64,
    /// Of `u`, `−v` and `−w`.
    right: Along,
    down: Along,
    forward: Along,
    /// A quarter of the way from one column to the next on the viewport, and from one row to the next.
    quarter: [f64; 2],
    /// The column and row of the viewport's middle, in quarters.
    middle: [f64; 2],
}

/// A coordinate of the world, along its axis or against it.
#[derive(Clone, Copy, Debug)]
struct Along {
    axis: usize,
    sign: f64,
}

impl Along {
    /// The coordinate along a unit vector that has no other component, not the least.
    fn new(vector: DVec3) -> Option<Along> {
        let components = vector.to_array();
        let axis = components.iter().position(|component| *component != 0.0)?;
        let alone = components[axis + 1..].iter().all(|component| *component == 0.0);
        let sign = components[axis];
        (alone && (sign == 1.0 || sign == -1.0)).then_some(Along { axis, sign })
    }

    #[inline(always)]
    fn of<S: Simd>(self, point: &[f64x8<S>; 3]) -> f64x8<S> {
        point[self.axis] * self.sign
    }
}

impl Straight {
    /// The rays of a camera's samples, if they are straight.
    ///
    /// With a frame along the world's axes each coordinate of a ray's origin and direction is one of `x`, `y`, `d` or
    /// 1, or against it, without a rounding. Those `x` and `y` themselves are looked at one by one: multiples of half
    /// the way `g` between neighbours, of which `g` has at most 10 bits and the other factor at most 17, so that the
    /// product with which each is compared is exact.
    pub(super) fn new(camera: &Camera, samples: &SampleGrid) -> Option<Straight> {
        let along = [camera.u(), -camera.v(), -camera.w()].map(Along::new);
        let [Some(right), Some(down), Some(forward)] = along else { return None };
        let [across, upward] = [step(samples.x())?, step(samples.y())?];
        #[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
        let middle = [samples.width(), samples.height()].map(|count| 2.0 * (count as f64 - 1.0));
        Some(Straight {
            projection: camera.projection(),
            distance: camera.distance(),
            right,
            down,
            forward,
            quarter: [0.25 * across, -0.25 * upward],
            middle,
        })
    }

    /// The quarters of a column and row that are nearest to computed ones, and whether the ray through there meets
    /// a point in front of the eye, given by its offset from the eye.
    ///
    /// The ray passes `x = m·g/4` to the right of the middle, `m` an integer of at most 19 bits, and `x` has 29. A
    /// point at the depth `ζ` and the distance `r` to the right lies on it, as far as that goes, if `r = t·x` with `t
    /// = ζ/d`, that is `r·d = ζ·x`; of parallel rays if `r = x`. With `r` and `ζ` of 24 bits, which is looked at,
    /// and `d` of 24, both products are exact. Downward likewise.
    #[inline(always)]
    fn meets<S: Simd>(
        &self,
        simd: S,
        [column, row]: [f64x8<S>; 2],
        offset: &[f64x8<S>; 3],
    ) -> ([f64x8<S>; 2], mask64x8<S>) {
        let quarters = [(column * 4.0).round_ties_even(), (row * 4.0).round_ties_even()];
        let ahead = self.forward.of(offset);
        let meets = |axis: usize, beside: f64x8<S>| {
            let passes = (quarters[axis] - self.middle[axis]) * self.quarter[axis];
            match self.projection {
                Projection::Perspective => {
                    let same = (beside * self.distance).simd_eq(ahead * passes);
                    same & is_short(simd, beside)
                }
                Projection::Parallel => beside.simd_eq(passes),
            }
        };
        let met = meets(0, self.right.of(offset)) & meets(1, self.down.of(offset));
        let met = match self.projection {
            Projection::Perspective => {
                met & is_short(simd, ahead) & ahead.simd_gt(f64x8::splat(simd, 0.0))
            }
            Projection::Parallel => met,
        };
        ([quarters[0] * 0.25, quarters[1] * 0.25], met)
    }
}

/// From each of some places to the next, if it has few bits and all are half of it times an odd or even number.
fn step(places: &[f64]) -> Option<f64> {
    let (count, first) = (f64::from(u32::try_from(places.len()).ok()?), *places.first()?);
    // The first lies (count − 1)/2 steps before the middle; of one alone there is no telling.
    let step = if count > 1.0 { -2.0 * first / (count - 1.0) } else { return None };
    let has_few_bits = step.to_bits().trailing_zeros() >= f64::MANTISSA_DIGITS - 10;
    let from_middle = (0..).map(|place| 2.0 * f64::from(place) + 1.0 - count);
    let even = places.iter().zip(from_middle).all(|(place, halves)| *place == 0.5 * step * halves);
    (has_few_bits && even).then_some(step)
}

/// Which numbers `f32` holds, too.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "the question is what survives it")]
fn is_short<S: Simd>(simd: S, value: f64x8<S>) -> mask64x8<S> {
    let back = value.to_array().map(|value| f64::from(value as f32));
    value.simd_eq(f64x8::load_array(simd, back))
}

/// Eight triangles of which some are aligned.
pub(super) struct Aligned<S: Simd> {
    /// Which.
    pub(super) which: mask32x8<S>,
    /// Their edge functions of `ab`, `bc`, `ca` on the raster, positive inside, never 0 at a sample.
    pub(super) edges: [Affine<S>; 3],
    /// Negative when the corners are seen counter-clockwise.
    pub(super) facing: f32x8<S>,
    /// Those that are seen edge-on.
    pub(super) flat: mask32x8<S>,
}

impl<S: Simd> Aligned<S> {
    /// Finds the aligned ones among triangles, whose corners are given by their offsets from the eye and by the
    /// map. `None` if the camera's rays are not straight.
    ///
    /// Places are multiples of a quarter without any error, so edge functions are multiples of a sixteenth. In
    /// front of the eye, an edge function on the raster has the sign of the one in space: it is that
    /// divided by the `t` of both corners. [`TIE`] decides those that are zero.
    #[inline(always)]
    pub(super) fn new<F: Fault>(
        simd: S,
        lens: &Lens,
        offsets: &Corners<S>,
        mapped: &Corners<S>,
    ) -> Option<Self> {
        let straight = lens.kind.straight.as_ref()?;
        let (a, on_a) = place(simd, lens, straight, &offsets[0], &mapped[0]);
        let (b, on_b) = place(simd, lens, straight, &offsets[1], &mapped[1]);
        let (c, on_c) = place(simd, lens, straight, &offsets[2], &mapped[2]);
        let (ab, bc, ca) =
            ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]], [a[0] - c[0], a[1] - c[1]]);
        let area = ab[1] * ca[0] - ab[0] * ca[1];
        let one = f64x8::splat(simd, 1.0);
        let facing = area.simd_lt(f64x8::splat(simd, 0.0)).select(-one, one);
        let (e1, small1) = edge::<S, F>(simd, lens, a, ab, facing);
        let (e2, small2) = edge::<S, F>(simd, lens, b, bc, facing);
        let (e3, small3) = edge::<S, F>(simd, lens, c, ca, facing);
        let which = on_a & on_b & on_c & small1 & small2 & small3;
        let flat = area.simd_eq(f64x8::splat(simd, 0.0));
        Some(Aligned {
            which: mask32x8::from_bitmask(simd, which.to_bitmask()),
            edges: [e1, e2, e3],
            facing: facing.narrow(facing).split().0,
            flat: mask32x8::from_bitmask(simd, flat.to_bitmask()),
        })
    }
}

/// Three coordinates of the three corners.
type Corners<S> = [[f64x8<S>; 3]; 3];

/// Where a corner of each triangle lies, in columns and rows from the tile's middle, and which are aligned.
#[inline(always)]
fn place<S: Simd>(
    simd: S,
    lens: &Lens,
    straight: &Straight,
    offset: &[f64x8<S>; 3],
    [t, across, down]: &[f64x8<S>; 3],
) -> ([f64x8<S>; 2], mask64x8<S>) {
    let near = if lens.kind.parallel { f64x8::splat(simd, 1.0) } else { *t };
    let [column, row] = [*across / near + lens.middle[0], *down / near + lens.middle[1]];
    let ([across, down], met) = straight.meets(simd, [column, row], offset);
    let most = f64x8::splat(simd, FARTHEST);
    let close = column.abs().simd_lt(most) & row.abs().simd_lt(most);
    ([across - lens.middle[0], down - lens.middle[1]], met & close)
}

/// The edge function of the edge from `p` along `(dx, dy)`, and whether it is small enough.
#[inline(always)]
fn edge<S: Simd, F: Fault>(
    simd: S,
    lens: &Lens,
    p: [f64x8<S>; 2],
    [dx, dy]: [f64x8<S>; 2],
    facing: f64x8<S>,
) -> (Affine<S>, mask64x8<S>) {
    let (across, down) = (-dy * facing, dx * facing);
    let at_middle = (dy * p[0] - dx * p[1]) * facing;
    let size = at_middle.abs() + (across.abs() + down.abs()) * (lens.kind.half + 1.0);
    let zero = f64x8::splat(simd, 0.0);
    let owned = across.simd_gt(zero) | (across.simd_eq(zero) & down.simd_gt(zero));
    let tie = f64x8::splat(simd, TIE.into());
    let by = if F::is(Planted::StrictComparison) { -tie } else { owned.select(tie, -tie) };
    let (at_middle, across) = (at_middle + by).narrow(across).split();
    let down = down.narrow(down).split().0;
    (Affine { at_middle, across, down }, size.simd_lt(f64x8::splat(simd, LARGEST)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_has_no_other_component() {
        assert!(
            Along::new(DVec3::NEG_Y).is_some_and(|along| (along.axis, along.sign) == (1, -1.0))
        );
        assert!(Along::new(DVec3::new(0.0, -0.0, 1.0)).is_some_and(|along| along.axis == 2));
        for exponent in -1074..=-20 {
            let little = f64::from(exponent).exp2();
            for tilted in [[1.0, little, 0.0], [little, 1.0, 0.0], [0.0, -little, -1.0]] {
                assert!(Along::new(DVec3::from_array(tilted)).is_none(), "{tilted:?}");
            }
        }
        assert!(Along::new(DVec3::new(1.0_f64.next_up(), 0.0, 0.0)).is_none());
        assert!(Along::new(DVec3::ZERO).is_none());
    }

    #[test]
    fn steps_are_those_of_places_that_are_not_rounded() {
        assert_eq!(step(&[-1.5, -0.5, 0.5, 1.5]), Some(1.0));
        assert_eq!(step(&[0.75, 0.0, -0.75]), Some(-0.75));
        assert_eq!(step(&[-1.0 / 3.0, 0.0, 1.0 / 3.0]), None);
        assert_eq!(step(&[-1.0, 0.1, 1.0]), None);
        assert_eq!(step(&[-1.0, 0.0_f64.next_up(), 1.0]), None);
    }
}
