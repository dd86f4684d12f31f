//! Sets up eight triangles for the rays of a tile: edge functions and keys as affine functions of the raster, computed
//! in `f64` about the tile's middle and rounded to `f32`, with bounds of the error.

use super::aligned::AlignedTriangles;
use super::bounds;
use super::lane_affine::LaneAffine;
use super::search::tile_frustum::TileFrustum;
use bothways_common::engine::context::Context;
use bothways_common::engine::fault::Planted;
use bothways_common::engine::roundoff::EPS24;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdCombine, SimdMask, SimdNarrow, SimdSplit, SimdWiden, f32x8, f32x16,
    f64x8, mask32x8,
};
use bothways_common::{Primitive, View};
use glam::Vec3;

/// Eight triangles as they are stored in the world; the unused lanes hold any others. Of the corners: x, y, z of the
/// first, of the second, of the third.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrianglePacket {
    pub(super) corners: [[f32; 8]; 9],
    pub(super) ids: [u32; 8],
}

/// Eight triangles, ready to be tested.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setup<S: Simd> {
    /// Edge functions of `ab`, `bc`, `ca`, positive inside.
    pub(super) edges: [LaneAffine<S>; 3],
    /// Beyond this the sign of an edge function is certain.
    pub(super) error: f32x8<S>,
    /// Larger for what is nearer: `1/t`, or `−t` of a parallel camera.
    pub(super) key: LaneAffine<S>,
    /// A key is off by at most this; infinite if it is not known.
    pub(super) key_error: f32x8<S>,
    /// The sign of the facing, ±1.
    pub(super) facing: f32x8<S>,
    /// The first and the last row of the tile that a triangle may cover, and the first and the last column.
    pub(super) rows: [f32x8<S>; 2],
    pub(super) columns: [f32x8<S>; 2],
    /// Triangles that may cover a sample of the tile and be seen there.
    pub(super) alive: mask32x8<S>,
    /// Triangles whose facing is not certain.
    pub(super) doubtful: mask32x8<S>,
}

impl TrianglePacket {
    /// One of the triangles, relative to the eye.
    pub(super) fn primitive(&self, view: &View, lane: usize) -> Primitive {
        Primitive::Triangle(std::array::from_fn(|corner| {
            let axes = std::array::from_fn(|axis| self.corners[3 * corner + axis][lane]);
            view.offset(Vec3::from_array(axes))
        }))
    }
}

impl<S: Simd> Setup<S> {
    /// Sets up the used ones of eight triangles. Nothing with a key below `far` can be seen.
    ///
    /// # The errors, rounding by rounding
    ///
    /// `e` bounds the error of a corner's coordinates after the map and `ε` that of a sample's, `h` is half
    /// the tile's side, but at least 1: see [`super::camera_map`]; errors of `t` are smaller by `h`. `m` bounds
    /// the corners' coordinates and `l` the edges', those of `t` times `h` (of a parallel camera: `m ≥ h`,
    /// edge functions taking 1 for `t`). `ε₅₃` times `m` is less than `e/4`.
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
    /// n_x·δj + n_y·δi)/n_t`; `64·m·l·e + 26·h·l·e + 4·l²·ε·h`, and `t` itself by what [`super::camera_map::MapErrors`]
    /// says. Where `F` is off by at most a sixteenth, dividing by it brings 1.07 times the numerator's error
    /// over `F` and 1.07 times the key times the error of `F` over `F`. In `f32` as above, and one
    /// rounding for each end of the interval.
    ///
    /// Constants are larger by more than the bounds' own roundings; what underflows is less than the
    /// smallest normal number, which each bound adds; `e` is added to `m` and `l`, so that no product of
    /// bounds vanishes.
    #[inline(always)]
    pub(super) fn new<C: Context<Simd = S>>(
        context: &C,
        frustum: &TileFrustum,
        eight: &TrianglePacket,
        used: u64,
        far: f32,
    ) -> Self {
        let simd = context.simd();
        // Project.
        let offsets = offsets(simd, frustum, eight);
        let mapped = [map(offsets[0], frustum), map(offsets[1], frustum), map(offsets[2], frustum)];

        // Edges.
        let mut functions = Functions::new(simd, frustum, &mapped);
        let blind = C::has(Planted::ZeroErrorBound);
        let aligned =
            if blind { None } else { AlignedTriangles::new(context, frustum, &offsets, &mapped) };
        if let Some(AlignedTriangles { which, edges: exact, .. }) = &aligned {
            let [ab, bc, ca] = &functions.edges;
            functions.edges =
                [ab.or(&exact[0], *which), bc.or(&exact[1], *which), ca.or(&exact[2], *which)];
        }

        // Bounds.
        let ErrorBounds { mut edge, mut key, key_spread, mut certain } =
            ErrorBounds::new(context, frustum, &mut functions);
        let Functions { edges, key: key_function, f, .. } = functions;
        let zero = f32x8::splat(simd, 0.0);
        if blind {
            edge = zero;
            key = zero;
        }
        let mut facing = f.simd_lt(zero).select(f32x8::splat(simd, -1.0), f32x8::splat(simd, 1.0));
        let mut edge_on = mask32x8::splat(simd, false);
        if let Some(aligned) = &aligned {
            certain |= aligned.which;
            edge = aligned.which.select(zero, edge);
            facing = aligned.which.select(aligned.facing, facing);
            edge_on = aligned.which & aligned.edge_on;
        }

        // Cull.
        let e = corner_error(context, frustum);
        let [rows, columns] = bounds::of_triangles(simd, frustum, e, &functions.corners);
        let mut setup = Setup {
            edges,
            error: edge,
            key: key_function,
            key_error: key,
            facing,
            rows,
            columns,
            alive: mask32x8::from_bitmask(simd, used) & !edge_on,
            doubtful: !certain,
        };
        setup.cull(simd, frustum, key_spread, far);
        setup
    }

    /// Drops triangles that cover no sample of the tile, or that are farther there than `far`.
    #[inline(always)]
    fn cull(&mut self, simd: S, frustum: &TileFrustum, key_spread: f32x8<S>, far: f32) {
        let (zero, half) = (f32x8::splat(simd, 0.0), bound(simd, frustum.template.half));
        // All three edge functions may be positive somewhere, and so may the key be larger than `far`.
        // Comparisons with NaN are false, and let pass.
        let [ab, bc, ca] = &self.edges;
        let out = (ab.at_middle + ab.spread(half) + self.error).simd_lt(zero)
            | (bc.at_middle + bc.spread(half) + self.error).simd_lt(zero)
            | (ca.at_middle + ca.spread(half) + self.error).simd_lt(zero);
        let mut out = out & !self.doubtful;
        // For a single ray, an observer gets all signs.
        if frustum.template.side > 1 && self.doubtful.any_true() {
            out |= self.doubtful & self.between_edges(simd, half);
        }
        let nearest = self.key.at_middle + key_spread + self.key_error;
        let hidden = nearest.simd_lt(f32x8::splat(simd, far));
        let empty = self.columns[1].simd_lt(self.columns[0]) | self.rows[1].simd_lt(self.rows[0]);
        self.alive &= !(out | hidden | empty);
    }
}

impl<S: Simd> Setup<S> {
    /// Triangles of which, whatever their facing is, two edge functions certainly have different signs in all of the tile.
    ///
    /// They were divided by the facing as computed, and so were their errors. Its sign may be wrong, but it is the same
    /// for all three. Comparisons with NaN are false.
    #[inline(always)]
    fn between_edges(&self, simd: S, half: f32x8<S>) -> mask32x8<S> {
        let mut positive = mask32x8::splat(simd, false);
        let mut negative = positive;
        for edge in &self.edges {
            let room = edge.spread(half) + self.error;
            positive |= edge.at_middle.simd_gt(room);
            negative |= edge.at_middle.simd_lt(-room);
        }
        positive & negative
    }
}

/// Three coordinates of the three corners.
type Corners<S> = [[f64x8<S>; 3]; 3];

/// Edge functions and keys, and in `f32` what their bounds are made of.
struct Functions<S: Simd> {
    edges: [LaneAffine<S>; 3],
    key: LaneAffine<S>,
    /// The facing, by which all functions are divided.
    f: f32x8<S>,
    corners: [[f32x8<S>; 3]; 3],
    ab: [f32x8<S>; 3],
    ca: [f32x8<S>; 3],
}

impl<S: Simd> Functions<S> {
    /// Of triangles with these corners, by the map.
    #[inline(always)]
    fn new(simd: S, frustum: &TileFrustum, &[a, b, c]: &Corners<S>) -> Self {
        let (ab, bc, ca) = (minus(b, a), minus(c, b), minus(a, c));
        let n = [
            ca[1] * ab[2] - ca[2] * ab[1],
            ca[2] * ab[0] - ca[0] * ab[2],
            ca[0] * ab[1] - ca[1] * ab[0],
        ];
        let along = n[0] * a[0] + n[1] * a[1] + n[2] * a[2];
        let parallel = frustum.template.parallel;
        let (f, key_at_middle) = if parallel { (n[0], -along) } else { (along, n[0]) };
        let r = f64x8::splat(simd, 1.0) / f;
        let [e1, e2, e3] = if parallel {
            [parallel_edge(a, ab), parallel_edge(b, bc), parallel_edge(c, ca)]
        } else {
            [edge(a, ab), edge(b, bc), edge(c, ca)]
        };
        // Two by two, as they are converted.
        let (c1, x1) = narrow(e1[0] * r, e1[1] * r);
        let (y1, c2) = narrow(e1[2] * r, e2[0] * r);
        let (x2, y2) = narrow(e2[1] * r, e2[2] * r);
        let (c3, x3) = narrow(e3[0] * r, e3[1] * r);
        let (y3, ck) = narrow(e3[2] * r, key_at_middle * r);
        let (xk, yk) = narrow(n[1] * r, n[2] * r);
        let (ta, xa) = narrow(a[0], a[1]);
        let (ya, tb) = narrow(a[2], b[0]);
        let (xb, yb) = narrow(b[1], b[2]);
        let (tc, xc) = narrow(c[0], c[1]);
        let (yc, f) = narrow(c[2], f);
        let (ab_t, ab_x) = narrow(ab[0], ab[1]);
        let (ab_y, ca_t) = narrow(ab[2], ca[0]);
        let (ca_x, ca_y) = narrow(ca[1], ca[2]);
        let affine = |at_middle, across, down| LaneAffine { at_middle, across, down };
        Functions {
            edges: [affine(c1, x1, y1), affine(c2, x2, y2), affine(c3, x3, y3)],
            key: affine(ck, xk, yk),
            f,
            corners: [[ta, xa, ya], [tb, xb, yb], [tc, xc, yc]],
            ab: [ab_t, ab_x, ab_y],
            ca: [ca_t, ca_x, ca_y],
        }
    }
}

/// What the functions may be off by, as [`Setup::new`] derives.
struct ErrorBounds<S: Simd> {
    edge: f32x8<S>,
    key: f32x8<S>,
    /// [`LaneAffine::spread`] of the keys over the tile.
    key_spread: f32x8<S>,
    /// Whether the sign of the facing is certain.
    certain: mask32x8<S>,
}

impl<S: Simd> ErrorBounds<S> {
    /// Those of some functions. Keys that are not known become 0, with an infinite error.
    #[inline(always)]
    fn new<C: Context<Simd = S>>(
        context: &C,
        frustum: &TileFrustum,
        functions: &mut Functions<S>,
    ) -> Self {
        let simd = context.simd();
        let errors = &frustum.template.errors;
        let (e, eps) = (corner_error(context, frustum), sample_error(context, frustum));
        let (h, half) = (bound(simd, errors.far), bound(simd, frustum.template.half));
        let Sizes { m, all, l } = Sizes::new(frustum, functions, e, h);
        let le = l * e;
        let (f_error, top_error) = if frustum.template.parallel {
            (le * 13.5, all * le * 65.0 + h * (le * 27.0 + l * l * eps * 4.2))
        } else {
            (m * le / h * 62.0, le * 40.0 + l * l * eps * 6.2)
        };
        let floor = f32x8::splat(simd, f32::MIN_POSITIVE);
        let f_error = f_error + floor;
        let size = functions.f.abs();
        let by_f = f32x8::splat(simd, 1.001) / size;

        let [ab, bc, ca] = &functions.edges;
        let middle = ab.at_middle.abs().max(bc.at_middle.abs()).max(ca.at_middle.abs());
        let slope = ab.spread(half).max(bc.spread(half)).max(ca.spread(half));
        let mut edge =
            (middle * 6.2 + slope * 7.2) * EPS24 + m * (e * 49.0 + m * eps * 12.3) * by_f + floor;
        let certain = size.simd_gt(f_error);
        if !certain.all_true() {
            // A facing that is no normal number in `f32` is not known well enough to divide by.
            edge = size.simd_lt(floor).select(f32x8::splat(simd, f32::INFINITY), edge);
        }

        let key = &mut functions.key;
        let key_spread = key.spread(half);
        let largest = key.at_middle.abs() + key_spread;
        let key_error = (key.at_middle.abs() * 6.2 + key_spread * 7.2) * EPS24
            + (top_error + largest * f_error) * by_f * 1.1
            + (floor + bound(simd, errors.depth));
        let known =
            (f_error * 16.0).simd_lt(size) & key_error.simd_lt(f32x8::splat(simd, f32::MAX));
        if !C::has(Planted::ZeroErrorBound) {
            let zero = f32x8::splat(simd, 0.0);
            key.at_middle = known.select(key.at_middle, zero);
            key.across = known.select(key.across, zero);
            key.down = known.select(key.down, zero);
        }
        ErrorBounds {
            edge,
            key: known.select(key_error, f32x8::splat(simd, f32::INFINITY)),
            key_spread,
            certain,
        }
    }
}

/// `m`, the same with `t`, and `l` of [`Setup::new`]: the sizes of corners and edges.
struct Sizes<S: Simd> {
    m: f32x8<S>,
    all: f32x8<S>,
    l: f32x8<S>,
}

impl<S: Simd> Sizes<S> {
    #[inline(always)]
    fn new(frustum: &TileFrustum, functions: &Functions<S>, e: f32x8<S>, h: f32x8<S>) -> Self {
        let Functions { corners: [a, b, c], ab, ca, .. } = functions;
        let t_size = a[0].abs().max(b[0].abs()).max(c[0].abs());
        let flat_size = a[1]
            .abs()
            .max(b[1].abs())
            .max(c[1].abs())
            .max(a[2].abs().max(b[2].abs()).max(c[2].abs()));
        let flat_length = ab[1].abs().max(ca[1].abs()).max(ab[2].abs().max(ca[2].abs()));
        let t_length = ab[0].abs().max(ca[0].abs());
        if frustum.template.parallel {
            let m = flat_size.max(h) + e;
            Sizes { m, all: m.max(t_size), l: flat_length.max(t_length) + e }
        } else {
            let m = flat_size.max(h * t_size) + e;
            Sizes { m, all: m, l: flat_length.max(h * t_length) + e }
        }
    }
}

/// `e` of [`Setup::new`].
#[inline(always)]
fn corner_error<C: Context>(context: &C, frustum: &TileFrustum) -> f32x8<C::Simd> {
    let infinite = C::has(Planted::InfiniteErrorBound);
    bound(context.simd(), if infinite { f64::INFINITY } else { frustum.template.errors.corner })
}

/// `ε` of [`Setup::new`].
#[inline(always)]
fn sample_error<C: Context>(context: &C, frustum: &TileFrustum) -> f32x8<C::Simd> {
    let infinite = C::has(Planted::InfiniteErrorBound);
    bound(context.simd(), if infinite { f64::INFINITY } else { frustum.template.errors.sample })
}

/// The corners' offsets from the eye.
#[inline(always)]
fn offsets<S: Simd>(simd: S, frustum: &TileFrustum, eight: &TrianglePacket) -> Corners<S> {
    let rows = eight.corners.as_flattened();
    let (ax, ay) = f32x16::from_slice(simd, &rows[..16]).widen();
    let (az, bx) = f32x16::from_slice(simd, &rows[16..32]).widen();
    let (by, bz) = f32x16::from_slice(simd, &rows[32..48]).widen();
    let (cx, cy) = f32x16::from_slice(simd, &rows[48..64]).widen();
    let (low, high) = f32x8::from_slice(simd, &rows[64..72]).widen();
    let cz = low.combine(high);
    let [x, y, z] = frustum.template.eye;
    [[ax - x, ay - y, az - z], [bx - x, by - y, bz - z], [cx - x, cy - y, cz - z]]
}

/// The `(t, x, y)` of an offset by the map.
#[inline(always)]
fn map<S: Simd>([x, y, z]: [f64x8<S>; 3], frustum: &TileFrustum) -> [f64x8<S>; 3] {
    let [t, across, down] = &frustum.rows;
    let t = x * t[0] + y * t[1] + z * t[2];
    let across = x * across[0] + y * across[1] + z * across[2];
    let down = x * down[0] + y * down[1] + z * down[2];
    if frustum.template.parallel {
        [t + frustum.shift[0], across + frustum.shift[1], down + frustum.shift[2]]
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
fn parallel_edge<S: Simd>(p: [f64x8<S>; 3], e: [f64x8<S>; 3]) -> [f64x8<S>; 3] {
    [p[1] * e[2] - p[2] * e[1], -e[2], e[1]]
}

#[inline(always)]
fn narrow<S: Simd>(first: f64x8<S>, second: f64x8<S>) -> (f32x8<S>, f32x8<S>) {
    first.narrow(second).split()
}
