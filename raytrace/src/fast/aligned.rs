//! Triangles whose corners lie exactly on rays through samples, or through quarters of the way between them: edges
//! through samples are decided without the judge.

use super::lane_affine::LaneAffine;
use super::search::tile_frustum::TileFrustum;
use super::straight_rays::StraightRays;
use bothways_common::engine::context::Context;
use bothways_common::engine::fault::Planted;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdMask, SimdNarrow, SimdSplit, f32x8, f64x8, mask32x8, mask64x8,
};

/// What decides a ray through an edge: half of the least edge function other than 0. It is added where the edge owns
/// the ray, and subtracted where it does not.
///
/// The contract moves the ray a little to the right, and far less down. So an edge owns the ray if its edge function
/// grows to the right, or if it is the same to the right and grows downward.
pub(super) const TIE: f32 = 1.0 / 32.0;

/// Edge functions have at most this size, so that `f32` has 24 bits for them and for [`TIE`].
const LARGEST: f64 = (1 << 17) as f64;
/// The corners of aligned triangles lie within this many rows and columns.
const FARTHEST: f64 = (1 << 16) as f64;

/// Eight triangles, of which some are aligned, as exact edge functions.
pub(super) struct AlignedTriangles<S: Simd> {
    /// The triangles that are aligned; the other lanes have no meaning.
    pub(super) which: mask32x8<S>,
    /// The edge functions of `ab`, `bc`, `ca` on the raster, positive inside, never 0 at a sample.
    pub(super) edges: [LaneAffine<S>; 3],
    /// The sign of the facing, ±1: negative when the corners are seen counter-clockwise.
    pub(super) facing: f32x8<S>,
    /// The triangles that are seen edge-on.
    pub(super) edge_on: mask32x8<S>,
}

impl<S: Simd> AlignedTriangles<S> {
    /// Finds the aligned triangles among eight. Their corners are given twice: as offsets from the eye, and as the map
    /// gives them. `None` if the camera's rays are not straight.
    ///
    /// Places are multiples of a quarter without any error, so edge functions are multiples of a sixteenth. In
    /// front of the eye, an edge function on the raster has the sign of the one in space: it is that
    /// divided by the `t` of both corners. [`TIE`] decides those that are zero.
    #[inline(always)]
    pub(super) fn new<C: Context<Simd = S>>(
        context: &C,
        frustum: &TileFrustum,
        offsets: &LaneCorners<S>,
        mapped: &LaneCorners<S>,
    ) -> Option<Self> {
        let simd = context.simd();
        let straight = frustum.template.straight.as_ref()?;
        let (a, on_a) = place(simd, frustum, straight, &offsets[0], &mapped[0]);
        let (b, on_b) = place(simd, frustum, straight, &offsets[1], &mapped[1]);
        let (c, on_c) = place(simd, frustum, straight, &offsets[2], &mapped[2]);
        let (ab, bc, ca) =
            ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]], [a[0] - c[0], a[1] - c[1]]);
        let area = ab[0] * ca[1] - ab[1] * ca[0];
        let one = f64x8::splat(simd, 1.0);
        let facing = area.simd_lt(f64x8::splat(simd, 0.0)).select(-one, one);
        let (e1, small1) = edge(context, frustum, a, ab, facing);
        let (e2, small2) = edge(context, frustum, b, bc, facing);
        let (e3, small3) = edge(context, frustum, c, ca, facing);
        let which = on_a & on_b & on_c & small1 & small2 & small3;
        let edge_on = area.simd_eq(f64x8::splat(simd, 0.0));
        Some(AlignedTriangles {
            which: mask32x8::from_bitmask(simd, which.to_bitmask()),
            edges: [e1, e2, e3],
            facing: facing.narrow(facing).split().0,
            edge_on: mask32x8::from_bitmask(simd, edge_on.to_bitmask()),
        })
    }
}

/// Three coordinates of the three corners.
type LaneCorners<S> = [[f64x8<S>; 3]; 3];

/// Where a corner of each triangle lies, in rows and columns from the tile's middle, and which are aligned.
#[inline(always)]
fn place<S: Simd>(
    simd: S,
    frustum: &TileFrustum,
    straight: &StraightRays,
    offset: &[f64x8<S>; 3],
    [t, across, down]: &[f64x8<S>; 3],
) -> ([f64x8<S>; 2], mask64x8<S>) {
    let near = if frustum.template.parallel { f64x8::splat(simd, 1.0) } else { *t };
    let [row, column] = [*down / near + frustum.middle[0], *across / near + frustum.middle[1]];
    let ([down, across], met) = straight.meets(simd, [row, column], offset);
    let most = f64x8::splat(simd, FARTHEST);
    let close = column.abs().simd_lt(most) & row.abs().simd_lt(most);
    ([down - frustum.middle[0], across - frustum.middle[1]], met & close)
}

/// The edge function of the edge from the row and column `p` along `(dy, dx)`, and whether it is small enough.
#[inline(always)]
fn edge<C: Context>(
    context: &C,
    frustum: &TileFrustum,
    p: [f64x8<C::Simd>; 2],
    [dy, dx]: [f64x8<C::Simd>; 2],
    facing: f64x8<C::Simd>,
) -> (LaneAffine<C::Simd>, mask64x8<C::Simd>) {
    let simd = context.simd();
    let (across, down) = (-dy * facing, dx * facing);
    let at_middle = (dy * p[1] - dx * p[0]) * facing;
    let size = at_middle.abs() + (across.abs() + down.abs()) * (frustum.template.half + 1.0);
    let zero = f64x8::splat(simd, 0.0);
    let owned = across.simd_gt(zero) | (across.simd_eq(zero) & down.simd_gt(zero));
    let tie = f64x8::splat(simd, TIE.into());
    let by = if C::has(Planted::StrictComparison) { -tie } else { owned.select(tie, -tie) };
    let (at_middle, across) = (at_middle + by).narrow(across).split();
    let down = down.narrow(down).split().0;
    (LaneAffine { at_middle, across, down }, size.simd_lt(f64x8::splat(simd, LARGEST)))
}
