//! Eight triangles against the rays of a tile: edge functions and keys as affine functions of column and
//! row, set up in `f64` about the tile's middle and rounded to `f32`, with bounds of the error.

use super::aligned::Aligned;
use super::rays::Lens;
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdCombine, SimdFloat, SimdMask, SimdNarrow, SimdSplit, SimdWiden,
    f32x8, f32x16, f64x8, mask32x8,
};
use bothways_common::{Primitive, View};
use glam::Vec3;

/// Half of 2⁻²³.
const U: f32 = f32::EPSILON / 2.0;

/// Eight triangles as they are stored in the world, or fewer and others with them: x, y, z of the first corners, of
/// the second, of the third.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eight {
    pub(super) corners: [[f32; 8]; 9],
    pub(super) ids: [u32; 8],
}

/// An affine function in eight lanes: `at_middle + δj·across + δi·down`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Affine<S: Simd> {
    pub(super) at_middle: f32x8<S>,
    pub(super) across: f32x8<S>,
    pub(super) down: f32x8<S>,
}

/// Eight triangles, ready to be tested.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setup<S: Simd> {
    /// Edge functions of `ab`, `bc`, `ca`, positive inside.
    pub(super) edges: [Affine<S>; 3],
    /// Beyond this an edge function's sign is certain.
    pub(super) error: f32x8<S>,
    /// Larger for what is nearer: `1/t`, or `−t` of a parallel camera.
    pub(super) key: Affine<S>,
    /// A key is off by at most this; infinite if it is not known.
    pub(super) key_error: f32x8<S>,
    /// The sign of the facing, ±1.
    pub(super) facing: f32x8<S>,
    /// Columns and rows of the tile that a triangle may cover: the first and the last, of columns, of
    /// rows.
    pub(super) columns: [f32x8<S>; 2],
    pub(super) rows: [f32x8<S>; 2],
    /// Triangles that may cover a sample of the tile and be seen there.
    pub(super) alive: mask32x8<S>,
    /// Triangles whose facing is not certain.
    pub(super) doubtful: mask32x8<S>,
}

impl Eight {
    /// One of its triangles relative to the eye.
    pub(super) fn primitive(&self, view: &View, lane: usize) -> Primitive {
        Primitive::Triangle(std::array::from_fn(|corner| {
            let axes = std::array::from_fn(|axis| self.corners[3 * corner + axis][lane]);
            view.offset(Vec3::from_array(axes))
        }))
    }
}

impl<S: Simd> Affine<S> {
    #[inline(always)]
    fn abs_slope(&self, half: f32x8<S>) -> f32x8<S> {
        half * (self.across.abs() + self.down.abs())
    }

    /// The other, in some lanes.
    #[inline(always)]
    fn or(&self, other: &Self, which: mask32x8<S>) -> Self {
        Affine {
            at_middle: which.select(other.at_middle, self.at_middle),
            across: which.select(other.across, self.across),
            down: which.select(other.down, self.down),
        }
    }

    #[inline(always)]
    pub(super) fn at(&self, across: f32x8<S>, down: f32x8<S>) -> f32x8<S> {
        (self.at_middle + self.down * down) + self.across * across
    }
}

impl<S: Simd> Setup<S> {
    /// Sets up the used ones of eight triangles. Nothing with a key below `far` can be seen.
    ///
    /// # The errors, rounding by rounding
    ///
    /// `e` bounds the error of a corner's coordinates after the map and `ε` that of a sample's, `h` is half
    /// the tile's side, but at least 1: see [`super::rays`]; errors of `t` are smaller by `h`. `m` bounds
    /// the corners' coordinates and `l` the edges', those of `t` times `h` (of a parallel camera: `m ≥ h`,
    /// edge functions taking 1 for `t`). `v = 2⁻⁵³` times `m` is less than `e/4`.
    ///
    /// *Edge functions.* `C = x_a·y_e − y_a·x_e`: a corner brings `e`, an edge `2e` and one rounding, products
    /// and the difference one each: at most `16·m·e`, and so for each slope times `h`; a sample's error adds
    /// `4m²·ε` for each of three. Together `48·m·e + 12·m²·ε`, times `1/F`, with which everything is
    /// multiplied; as its sign is certain, its rounding does no harm. In `f32`, conversion, product and the
    /// sums round the value at the middle by at most 4 and slopes by 5, and [`Setup::alive`] by 2 more.
    ///
    /// *Facing.* A coordinate of the normal `n` is off by `13·l·e` (`t`'s, and `1/h` of that the others'), and
    /// `F = n·a` of a perspective camera by `60·m·l·e/h`; of a parallel one, `F = n_t`.
    ///
    /// *Keys.* Perspective: `n·(1, δj, δi)/F`; the numerator is off by `39·l·e + 6·l²·ε`. Parallel: `(−n·a +
    /// n_x·δj + n_y·δi)/n_t`; `64·m·l·e + 26·h·l·e + 4·l²·ε·h`, and `t` itself by what [`super::rays::Errors`]
    /// says. Where `F` is off by at most a sixteenth, dividing by it brings 1.07 times the numerator's error
    /// over `F` and 1.07 times the key times the error of `F` over `F`. In `f32` as above, and one
    /// rounding for each end of the interval.
    ///
    /// Constants are larger by more than the bounds' own roundings; what underflows is less than the
    /// smallest normal number, which each bound adds; `e` is added to `m` and `l`, so that no product of
    /// bounds vanishes.
    #[inline(always)]
    pub(super) fn new<F: Fault>(
        simd: S,
        lens: &Lens,
        side: usize,
        eight: &Eight,
        used: u64,
        far: f32,
    ) -> Self {
        let blind = F::is(Planted::ZeroErrorBound);
        let offsets = offsets(simd, lens, eight);
        let mapped = [map(offsets[0], lens), map(offsets[1], lens), map(offsets[2], lens)];
        let [a, b, c] = mapped;
        let (ab, bc, ca) = (minus(b, a), minus(c, b), minus(a, c));

        let n = [
            ca[1] * ab[2] - ca[2] * ab[1],
            ca[2] * ab[0] - ca[0] * ab[2],
            ca[0] * ab[1] - ca[1] * ab[0],
        ];
        let along = n[0] * a[0] + n[1] * a[1] + n[2] * a[2];
        let (f, key_at_middle) = if lens.kind.parallel { (n[0], -along) } else { (along, n[0]) };
        let r = f64x8::splat(simd, 1.0) / f;
        let [e1, e2, e3] = if lens.kind.parallel {
            [flat_edge(a, ab), flat_edge(b, bc), flat_edge(c, ca)]
        } else {
            [edge(a, ab), edge(b, bc), edge(c, ca)]
        };
        let (c1, x1) = narrow(e1[0] * r, e1[1] * r);
        let (y1, c2) = narrow(e1[2] * r, e2[0] * r);
        let (x2, y2) = narrow(e2[1] * r, e2[2] * r);
        let (c3, x3) = narrow(e3[0] * r, e3[1] * r);
        let (y3, ck) = narrow(e3[2] * r, key_at_middle * r);
        let (xk, yk) = narrow(n[1] * r, n[2] * r);
        let affine = |at_middle, across, down| Affine { at_middle, across, down };
        let mut edges = [affine(c1, x1, y1), affine(c2, x2, y2), affine(c3, x3, y3)];
        let mut key = affine(ck, xk, yk);

        let aligned = if blind { None } else { Aligned::new::<F>(simd, lens, &offsets, &mapped) };
        if let Some(Aligned { which, edges: exact, .. }) = &aligned {
            edges = [
                edges[0].or(&exact[0], *which),
                edges[1].or(&exact[1], *which),
                edges[2].or(&exact[2], *which),
            ];
        }

        // The same corners in f32, for bounds and for the boxes of samples.
        let (ta, xa) = narrow(a[0], a[1]);
        let (ya, tb) = narrow(a[2], b[0]);
        let (xb, yb) = narrow(b[1], b[2]);
        let (tc, xc) = narrow(c[0], c[1]);
        let (yc, f) = narrow(c[2], f);
        let (ab_t, ab_x) = narrow(ab[0], ab[1]);
        let (ab_y, ca_t) = narrow(ab[2], ca[0]);
        let (ca_x, ca_y) = narrow(ca[1], ca[2]);

        let (e, eps) = if F::is(Planted::InfiniteErrorBound) {
            (bound(simd, f64::INFINITY), bound(simd, f64::INFINITY))
        } else {
            (bound(simd, lens.kind.errors.corner), bound(simd, lens.kind.errors.sample))
        };
        let (h, half) = (bound(simd, lens.kind.errors.far), bound(simd, lens.kind.half));
        let t_size = ta.abs().max(tb.abs()).max(tc.abs());
        let flat_size =
            xa.abs().max(xb.abs()).max(xc.abs()).max(ya.abs().max(yb.abs()).max(yc.abs()));
        let flat_length = ab_x.abs().max(ca_x.abs()).max(ab_y.abs().max(ca_y.abs()));
        let t_length = ab_t.abs().max(ca_t.abs());
        let (m, all, l) = if lens.kind.parallel {
            let m = flat_size.max(h) + e;
            (m, m.max(t_size), flat_length.max(t_length) + e)
        } else {
            let m = flat_size.max(h * t_size) + e;
            (m, m, flat_length.max(h * t_length) + e)
        };
        let le = l * e;
        let (f_error, top_error) = if lens.kind.parallel {
            (le * 13.5, all * le * 65.0 + h * (le * 27.0 + l * l * eps * 4.2))
        } else {
            (m * le / h * 62.0, le * 40.0 + l * l * eps * 6.2)
        };
        let floor = f32x8::splat(simd, f32::MIN_POSITIVE);
        let zero = f32x8::splat(simd, 0.0);
        let f_error = f_error + floor;
        let size = f.abs();
        let by_f = f32x8::splat(simd, 1.001) / size;
        let mut certain = size.simd_gt(f_error);
        let slopes = [edges[0].abs_slope(half), edges[1].abs_slope(half), edges[2].abs_slope(half)];
        let middle =
            edges[0].at_middle.abs().max(edges[1].at_middle.abs()).max(edges[2].at_middle.abs());
        let slope = slopes[0].max(slopes[1]).max(slopes[2]);
        let mut error =
            (middle * 6.2 + slope * 7.2) * U + m * (e * 49.0 + m * eps * 12.3) * by_f + floor;
        let key_slope = key.abs_slope(half);
        let largest = key.at_middle.abs() + key_slope;
        let mut key_error = (key.at_middle.abs() * 6.2 + key_slope * 7.2) * U
            + (top_error + largest * f_error) * by_f * 1.1
            + (floor + bound(simd, lens.kind.errors.depth));
        let known =
            (f_error * 16.0).simd_lt(size) & key_error.simd_lt(f32x8::splat(simd, f32::MAX));
        if blind {
            error = zero;
            key_error = zero;
        } else {
            key_error = known.select(key_error, f32x8::splat(simd, f32::INFINITY));
            key.at_middle = known.select(key.at_middle, zero);
            key.across = known.select(key.across, zero);
            key.down = known.select(key.down, zero);
        }

        let mut facing = f.simd_lt(zero).select(f32x8::splat(simd, -1.0), f32x8::splat(simd, 1.0));
        let mut flat = mask32x8::splat(simd, false);
        if let Some(aligned) = &aligned {
            certain |= aligned.which;
            error = aligned.which.select(zero, error);
            facing = aligned.which.select(aligned.facing, facing);
            flat = aligned.which & aligned.flat;
        }

        // All three edge functions may be positive somewhere, and so may the key be larger than `far`.
        // Comparisons with NaN are false, and let pass.
        let out = (edges[0].at_middle + slopes[0] + error).simd_lt(zero)
            | (edges[1].at_middle + slopes[1] + error).simd_lt(zero)
            | (edges[2].at_middle + slopes[2] + error).simd_lt(zero);
        let out = out & certain;
        let hidden = (key.at_middle + key_slope + key_error).simd_lt(f32x8::splat(simd, far));

        let corners = [[ta, xa, ya], [tb, xb, yb], [tc, xc, yc]];
        let (columns, rows) = boxes(simd, lens, side, e, &corners);
        let empty = columns[1].simd_lt(columns[0]) | rows[1].simd_lt(rows[0]);
        let used = mask32x8::from_bitmask(simd, used);
        Setup {
            edges,
            error,
            key,
            key_error,
            facing,
            columns,
            rows,
            alive: used & !(out | hidden | empty | flat),
            doubtful: !certain,
        }
    }
}

/// The corners' offsets from the eye.
#[inline(always)]
fn offsets<S: Simd>(simd: S, lens: &Lens, eight: &Eight) -> [[f64x8<S>; 3]; 3] {
    let rows = eight.corners.as_flattened();
    let (ax, ay) = f32x16::from_slice(simd, &rows[..16]).widen();
    let (az, bx) = f32x16::from_slice(simd, &rows[16..32]).widen();
    let (by, bz) = f32x16::from_slice(simd, &rows[32..48]).widen();
    let (cx, cy) = f32x16::from_slice(simd, &rows[48..64]).widen();
    let (low, high) = f32x8::from_slice(simd, &rows[64..72]).widen();
    let cz = low.combine(high);
    let [x, y, z] = lens.kind.eye;
    [[ax - x, ay - y, az - z], [bx - x, by - y, bz - z], [cx - x, cy - y, cz - z]]
}

/// The `(t, x, y)` of an offset by the map.
#[inline(always)]
fn map<S: Simd>([x, y, z]: [f64x8<S>; 3], lens: &Lens) -> [f64x8<S>; 3] {
    let [t, across, down] = &lens.rows;
    let t = x * t[0] + y * t[1] + z * t[2];
    let across = x * across[0] + y * across[1] + z * across[2];
    let down = x * down[0] + y * down[1] + z * down[2];
    if lens.kind.parallel {
        [t + lens.shift[0], across + lens.shift[1], down + lens.shift[2]]
    } else {
        [t, across, down]
    }
}

#[inline(always)]
fn minus<S: Simd>(p: [f64x8<S>; 3], q: [f64x8<S>; 3]) -> [f64x8<S>; 3] {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

/// A bound in every lane, not less for its rounding.
#[inline(always)]
fn bound<S: Simd>(simd: S, value: f64) -> f32x8<S> {
    #[expect(clippy::cast_possible_truncation, reason = "made larger than that")]
    let bound = (value * 1.001) as f32;
    f32x8::splat(simd, bound)
}

/// The edge function from corner `p` along `e`: `det(p, e, (1, δj, δi))`.
#[inline(always)]
fn edge<S: Simd>(p: [f64x8<S>; 3], e: [f64x8<S>; 3]) -> [f64x8<S>; 3] {
    [p[1] * e[2] - p[2] * e[1], p[2] * e[0] - p[0] * e[2], p[0] * e[1] - p[1] * e[0]]
}

/// The same for parallel rays: `det(p − (0, δj, δi), e, (1, 0, 0))`.
#[inline(always)]
fn flat_edge<S: Simd>(p: [f64x8<S>; 3], e: [f64x8<S>; 3]) -> [f64x8<S>; 3] {
    [p[1] * e[2] - p[2] * e[1], -e[2], e[1]]
}

#[inline(always)]
fn narrow<S: Simd>(first: f64x8<S>, second: f64x8<S>) -> (f32x8<S>, f32x8<S>) {
    first.narrow(second).split()
}

/// The columns and rows of the tile that triangles may cover.
#[inline(always)]
fn boxes<S: Simd>(
    simd: S,
    lens: &Lens,
    side: usize,
    e: f32x8<S>,
    [[ta, xa, ya], [tb, xb, yb], [tc, xc, yc]]: &[[f32x8<S>; 3]; 3],
) -> ([f32x8<S>; 2], [f32x8<S>; 2]) {
    let (x, y, safe) = if lens.kind.parallel {
        let safe = e.simd_lt(f32x8::splat(simd, 1.0 / 16384.0));
        ([*xa, *xb, *xc], [*ya, *yb, *yc], safe)
    } else {
        let one = f32x8::splat(simd, 1.0);
        let (ra, rb, rc) = (one / *ta, one / *tb, one / *tc);
        let safe = ta.min(*tb).min(*tc).simd_gt(e * 16384.0);
        ([*xa * ra, *xb * rb, *xc * rc], [*ya * ra, *yb * rb, *yc * rc], safe)
    };
    let safe = safe & mask32x8::splat(simd, lens.kind.errors.small);
    let (left, right) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
    let (upper, lower) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
    (columns(simd, left, right, safe, side), columns(simd, upper, lower, safe, side))
}

/// The first and the last column (or row) of the tile between two places, counted from its middle; all
/// columns where that is not `safe`.
///
/// Where `t ≥ 2¹⁴·e`, a corner's column is off by at most `2⁻¹⁴·(1 + |x|)`, and in `f32` by four roundings
/// more; so is that of a parallel camera where `e < 2⁻¹⁴`. Samples are off by less than 2⁻¹⁰, or the lens
/// would not be `small`. The margin is larger.
#[inline(always)]
fn columns<S: Simd>(
    simd: S,
    low: f32x8<S>,
    high: f32x8<S>,
    safe: mask32x8<S>,
    side: usize,
) -> [f32x8<S>; 2] {
    #[expect(clippy::cast_precision_loss, reason = "at most 31")]
    let end = (side - 1) as f32;
    let (half, zero, last) = (0.5 * end, f32x8::splat(simd, 0.0), f32x8::splat(simd, end));
    let first = (low - (low.abs() * (1.0 / 4096.0) + 1.0 / 512.0) + half).ceil().max(zero);
    let end = (high + (high.abs() * (1.0 / 4096.0) + 1.0 / 512.0) + half).floor().min(last);
    [safe.select(first, zero), safe.select(end, last)]
}
