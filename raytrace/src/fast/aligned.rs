//! Triangles whose corners lie exactly at samples, or at quarters of the way between them: edges through samples
//! are decided without the judge.

use super::rays::Lens;
use super::setup::Affine;
use bothways_common::exact_grid::{ExactGrid, TIE};
use bothways_common::fault::{Fault, Planted};
use bothways_common::simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, SimdNarrow, SimdSplit, f32x8, f64x8, mask32x8,
    mask64x8,
};

/// Edge functions are at most so large, so that `f32` has 24 bits for them and for [`TIE`].
const LARGEST: f64 = (1 << 17) as f64;
/// [`ExactGrid::holds`] is asked no farther out.
const FARTHEST: f64 = (1 << 16) as f64;

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
    /// map. `None` if the camera's grid is not exact.
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
        let grid = lens.kind.grid.as_ref()?;
        let (a, on_a) = place(simd, lens, grid, &offsets[0], &mapped[0]);
        let (b, on_b) = place(simd, lens, grid, &offsets[1], &mapped[1]);
        let (c, on_c) = place(simd, lens, grid, &offsets[2], &mapped[2]);
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
    grid: &ExactGrid,
    [x, y, z]: &[f64x8<S>; 3],
    [t, across, down]: &[f64x8<S>; 3],
) -> ([f64x8<S>; 2], mask64x8<S>) {
    let [u, v, w] = lens.kind.frame;
    let right = *x * u.x + *y * u.y + *z * u.z;
    let up = *x * v.x + *y * v.y + *z * v.z;
    let depth = -(*x * w.x + *y * w.y + *z * w.z);
    let zero = f64x8::splat(simd, 0.0);
    let near = if lens.kind.parallel { f64x8::splat(simd, 1.0) } else { *t };
    let [column, row] = [*across / near + lens.middle[0], *down / near + lens.middle[1]];
    let most = f64x8::splat(simd, FARTHEST);
    let on = grid.holds(simd, 0, [column, right, depth])
        & grid.holds(simd, 1, [row, -up, depth])
        & column.abs().simd_lt(most)
        & row.abs().simd_lt(most)
        & near.simd_gt(zero);
    let quarter = [(column * 4.0).round_ties_even() * 0.25, (row * 4.0).round_ties_even() * 0.25];
    ([quarter[0] - lens.middle[0], quarter[1] - lens.middle[1]], on)
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
