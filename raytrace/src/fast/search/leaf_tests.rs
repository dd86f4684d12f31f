//! Tests the triangles of a leaf by where their corners are seen: which of them may cover samples of the tile, and, of tiny
//! ones, which certainly have a fragment, so that they need not be set up.

use super::tile_frustum::TileFrustum;
use crate::fast::store::NARROW;
use bothways_common::engine::roundoff::EPS24;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, f32x16, mask32x16,
};
use bothways_common::look::lanes::each;

/// How thoroughly triangles are tested before they are set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Test {
    /// By their bounds, which samples lie between their corners; and by their edges, where these leave out all of the tile.
    Bounds,
    /// By their edges, too, where one or two samples lie between their corners.
    Edges,
    /// By their edges, and there their fragments are found, too, where all of these are certain. Not for a parallel camera.
    Fragments,
}

impl Test {
    /// The same, but fragments are not found.
    #[inline(always)]
    pub(super) fn without_fragments(self) -> Test {
        if self == Test::Fragments { Test::Edges } else { self }
    }
}

/// Which triangles may cover samples of the tile, by the rows and the columns of their corners, each of which may be
/// off by `error`; `doubt` finds that of edge functions from the triangles' sizes in columns and rows.
///
/// Samples to the left of all corners are not covered, nor those to the right, above and below. If one is left, or two
/// beside each other, edge functions may show that neither is covered.
#[inline(always)]
pub(super) fn pass<S: Simd>(
    simd: S,
    frustum: &TileFrustum,
    [y, x]: &[[f32x16<S>; 3]; 2],
    (error, doubt): (f32, impl FnOnce(f32x16<S>) -> f32x16<S>),
    test: Test,
) -> mask32x16<S> {
    let rows = Between::new(simd, frustum, y, error);
    let columns = Between::new(simd, frustum, x, error);
    let missed = columns.none | rows.none;
    if test == Test::Bounds {
        return !(missed | is_between_edges(simd, frustum, [y, x], error));
    }
    let more = columns.last - columns.first + (rows.last - rows.first);
    let doubt = doubt(columns.size.max(rows.size));
    let [at_first, at_last] = EdgeValues::at_ends([y, x], [&rows, &columns]);
    let beside = at_first.differ(doubt) & at_last.differ(doubt);
    !(missed | more.simd_le(f32x16::splat(simd, 1.0)) & beside)
}

/// How far off places and keys of corners may be.
pub(super) struct CornerErrors {
    /// Rows and columns.
    pub(super) place: f32,
    /// Keys, as a part of the largest.
    pub(super) key: f32,
}

/// What the test of a leaf's triangles finds.
pub(super) struct TestedTriangles<S: Simd> {
    /// Which may cover samples of the tile, as [`pass`] finds it.
    pub(super) pass: mask32x16<S>,
    pub(super) found: FoundFragments<S>,
}

/// Fragments of triangles that certainly have one each, and no other.
pub(super) struct FoundFragments<S: Simd> {
    pub(super) which: mask32x16<S>,
    /// Their row and column in the tile.
    pub(super) place: [f32x16<S>; 2],
    /// Both ends of their keys.
    pub(super) keys: [f32x16<S>; 2],
}

impl<S: Simd> TestedTriangles<S> {
    /// Tests triangles by the rows and columns of their corners and by their keys, `1/t` of a perspective camera.
    ///
    /// A fragment is found where a triangle certainly covers one sample alone, and its key is known well enough to find `t` from it.
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        frustum: &TileFrustum,
        places: &[[f32x16<S>; 3]; 2],
        keys: &[f32x16<S>; 3],
        errors: &CornerErrors,
    ) -> Self {
        let (pass, only) = OnlySamples::new(simd, frustum, places, errors.place);
        let [key, error] = only.key(keys, errors);
        let which = pass & only.which & error.simd_le(key * NARROW_HALF);
        let keys = [key - error, key + error];
        TestedTriangles { pass, found: FoundFragments { which, place: only.place, keys } }
    }
}

/// Samples that triangles certainly cover, each the only one of its triangle.
struct OnlySamples<S: Simd> {
    which: mask32x16<S>,
    /// Their rows and columns in the tile.
    place: [f32x16<S>; 2],
    /// The edge functions there of `ab` and `ca`, one over the sum of all three, and the triangle's size in rows and columns.
    edges: [f32x16<S>; 2],
    by_area: f32x16<S>,
    size: f32x16<S>,
}

impl<S: Simd> OnlySamples<S> {
    /// Finds the one sample between a triangle's corners, or that one of two which is covered if the other is not. Returns which
    /// triangles [`pass`], too.
    #[inline(always)]
    fn new(
        simd: S,
        frustum: &TileFrustum,
        [y, x]: &[[f32x16<S>; 3]; 2],
        error: f32,
    ) -> (mask32x16<S>, Self) {
        let splat = |value: f32| f32x16::splat(simd, value);
        let rows = Between::new(simd, frustum, y, error);
        let columns = Between::new(simd, frustum, x, error);
        let doubt = splat(doubt_of_any_size(error));
        let [at_first, at_last] = EdgeValues::at_ends([y, x], [&rows, &columns]);
        let (first_differ, last_differ) = (at_first.differ(doubt), at_last.differ(doubt));
        let more = columns.last - columns.first + (rows.last - rows.first);
        let at_most_two = more.simd_le(splat(1.0));
        let pass = !(columns.none | rows.none | at_most_two & first_differ & last_differ);

        let is_last = at_last.agree(doubt) & first_differ;
        let is_first = at_first.agree(doubt) & (last_differ | more.simd_eq(splat(0.0)));
        // One of two may lie beside the tile.
        let within = rows.first.min(columns.first).simd_ge(splat(0.0))
            & rows.last.max(columns.last).simd_le(splat(last_of(frustum)));
        let [ab, bc, ca] =
            each!(k in [0, 1, 2] => is_last.select(at_last.edges[k], at_first.edges[k]));
        let only = OnlySamples {
            which: at_most_two & within & (is_first | is_last),
            place: [
                is_last.select(rows.last, rows.first),
                is_last.select(columns.last, columns.first),
            ],
            edges: [ab, ca],
            by_area: splat(1.0) / (ab + bc + ca),
            size: columns.size.max(rows.size),
        };
        (pass, only)
    }

    /// The keys there, and how far each may be off, with the roundings of the ends that are made of both.
    ///
    /// # The error, rounding by rounding
    ///
    /// `s` is a triangle's size in rows and columns, `D` its doubled area, the sum of the edge functions, and `d` the largest difference
    /// of its corners' keys. Keys are affine on the raster. With the weights `w` of the corners as computed, those at which the sample
    /// divides the triangle of the computed places, the exact key there is the sum of `w` times the exact keys at these places. As
    /// places are off by `e`, and by `ε₂₄` of their distance from the sample, less than `1.07·e` in all, and weights are positive
    /// and add up to 1, it is off by at most `1.07·e` times what a key changes by for one row and one column: `4·s·d/D` with
    /// exact places, `4·s·d/D` with computed ones; either does, as the sample lies in both triangles. That is `4.3·e·s·d/D`.
    ///
    /// An edge function is off by `4.1·ε₂₄·m²` for its roundings, with `m`, which is at most `s + e` and less than 2.2; two of them are
    /// multiplied with differences of keys, three are in the sum by which is divided: `20.5·ε₂₄·m²·d/D`. As `e` is at
    /// least `36·ε₂₄`, that is less than `1.3·e·(s + e)·d/D`. Differences, products, sums and quotients round by
    /// `7.2·ε₂₄·d`; as a triangle with at most two samples between its corners is less than 2.2 wide one way, `D ≤ 2.2·s`, and that is less
    /// than `0.5·e·s·d/D`. Together `6.1·e·(s + e)·d/D`. This holds with `D` as computed, too, which is less than a 30th off: no product is
    /// more than 2.4, so that the three are off by `29·ε₂₄`, and each is more than its doubt, `324·ε₂₄`. So `6.5·e·(s + e)·d/D` is more.
    ///
    /// Nothing underflows: edge functions are more than `324·ε₂₄`, and keys near 1 differ by nothing or by their last place at least.
    ///
    /// The corners' own keys are off by [`LocalErrors::of_key`], twice of which the largest difference may be larger than it is
    /// computed, too; this holds room for the rounding of the last sum and of each end. Comparisons with NaN are false.
    ///
    /// [`LocalErrors::of_key`]: crate::fast::local_errors::LocalErrors::of_key
    #[inline(always)]
    fn key(&self, [a, b, c]: &[f32x16<S>; 3], errors: &CornerErrors) -> [f32x16<S>; 2] {
        let [ab, ca] = self.edges;
        let key = *a + (ca * (*b - *a) + ab * (*c - *a)) * self.by_area;
        let (nearest, farthest) = (a.max(*b).max(*c), a.min(*b).min(*c));
        let difference = nearest - farthest + nearest * (2.0 * errors.key);
        let size = self.size + errors.place;
        let error = difference * self.by_area.abs() * size * (6.5 * errors.place);
        [key, nearest * errors.key + error]
    }
}

/// A key is known well enough if its error is at most this part of it: then the whole interval is narrow, with its roundings.
const NARROW_HALF: f32 = 0.68e-6;
const _: () = assert!(2.0 * (NARROW_HALF + EPS24) < NARROW, "`t` would be found again");

/// The last row and column of a tile.
#[inline(always)]
fn last_of(frustum: &TileFrustum) -> f32 {
    #[expect(clippy::cast_precision_loss, reason = "at most 31")]
    let last = (frustum.template.side - 1) as f32;
    last
}

/// Which rows lie between the corners of triangles, or which columns.
struct Between<S: Simd> {
    first: f32x16<S>,
    last: f32x16<S>,
    /// From the first corner to the last.
    size: f32x16<S>,
    /// None of them is in the tile.
    none: mask32x16<S>,
}

impl<S: Simd> Between<S> {
    #[inline(always)]
    fn new(simd: S, frustum: &TileFrustum, [a, b, c]: &[f32x16<S>; 3], error: f32) -> Self {
        let end = f32x16::splat(simd, last_of(frustum));
        let (low, high) = (a.min(*b).min(*c), a.max(*b).max(*c));
        let (first, last) = ((low - error).ceil(), (high + error).floor());
        let none = last.min(end).simd_lt(first.max(f32x16::splat(simd, 0.0)));
        Between { first, last, size: high - low, none }
    }
}

/// Whether triangles cover no sample of the tile, as two edge functions have different signs in all of it: slivers, of
/// which bounds say nothing.
///
/// # The error, rounding by rounding
///
/// Places are counted from the tile's middle, `h` from its first samples; `M` is the largest of any corner. A place may be off by
/// `e` up to `h + 3`, and beyond that by the same fraction ([`super::super::local_errors`]): by `e(1 + M/h)`. As `e` is at least
/// `36·ε₂₄`, half of that is more than the rounding of counting from the middle: by `δ = 2e(1 + M/h)` in all. An edge
/// function at the middle, `x_a·y_b − y_a·x_b`, is off by `4Mδ + 2δ²`, and by its roundings of `4·ε₂₄·M²`; as `δ` is at least
/// `4·ε₂₄·M` for `h` up to 18, that is less than `5Mδ + 2δ²`. To a sample it changes by `h(|x_b − x_a| + |y_b − y_a|)`, which is off
/// by `4hδ` and its roundings. Comparisons with NaN are false.
#[inline(always)]
fn is_between_edges<S: Simd>(
    simd: S,
    frustum: &TileFrustum,
    [y, x]: [&[f32x16<S>; 3]; 2],
    error: f32,
) -> mask32x16<S> {
    let half = -frustum.centered(0);
    let x = [x[0] - half, x[1] - half, x[2] - half];
    let y = [y[0] - half, y[1] - half, y[2] - half];
    let along_x = x[0].abs().max(x[1].abs()).max(x[2].abs());
    let most = along_x.max(y[0].abs()).max(y[1].abs()).max(y[2].abs());
    let off = (most * (1.0 / half) + 1.0) * (2.0 * error);
    let error = off * ((most + half) * 5.0 + off * 3.0);
    let mut positive = mask32x16::splat(simd, false);
    let mut negative = positive;
    for (p, q) in [(0, 1), (1, 2), (2, 0)] {
        let at_middle = x[p] * y[q] - y[p] * x[q];
        let change = ((x[q] - x[p]).abs() + (y[q] - y[p]).abs()) * half;
        let most = (change + error) * 1.000_001;
        positive |= at_middle.simd_gt(most);
        negative |= at_middle.simd_lt(-most);
    }
    positive & negative
}

/// The doubt of [`EdgeValues`] for triangles of a size `s` in columns and rows, as it is computed. There `m` is the size and `e`, and
/// `(5·s + 8·e)·e` is more than all.
#[inline(always)]
pub(super) fn doubt_of_size<S: Simd>(size: f32x16<S>, error: f32) -> f32x16<S> {
    (size * 5.0 + 8.0 * error) * error
}

/// The same for triangles of any size, for which nothing is computed lane by lane. There `m` is 2 and `e`, one to the other
/// sample and less than one beyond it, so that `(9 + 7·e)·e` is more than all. Where errors are small, that makes no difference.
#[inline(always)]
pub(super) fn doubt_of_any_size(error: f32) -> f32 {
    (9.0 + 7.0 * error) * error
}

/// The edge functions of triangles, each at a sample between its corners. There is at most one other sample, beside it.
///
/// The sample lies between the corners but for an error `e` of less than 1/16. So none is farther from it along an axis
/// than some `m`, and along one axis not farther than 1 and `e`. Two products are off
/// by at most `4·m·e + 2·e²`; their factors' roundings, their own and that of their difference bring less than `9·m·ε₂₄`,
/// which is less than `m·e/2`, as `e` is at least `36·ε₂₄`.
struct EdgeValues<S: Simd> {
    /// Those of `ab`, `bc` and `ca`, and the least and the largest of them.
    edges: [f32x16<S>; 3],
    least: f32x16<S>,
    most: f32x16<S>,
}

impl<S: Simd> EdgeValues<S> {
    #[inline(always)]
    fn new([y, x]: [&[f32x16<S>; 3]; 2], [row, column]: [f32x16<S>; 2]) -> Self {
        let x = [x[0] - column, x[1] - column, x[2] - column];
        let y = [y[0] - row, y[1] - row, y[2] - row];
        let ab = x[0] * y[1] - y[0] * x[1];
        let bc = x[1] * y[2] - y[1] * x[2];
        let ca = x[2] * y[0] - y[2] * x[0];
        EdgeValues { edges: [ab, bc, ca], least: ab.min(bc).min(ca), most: ab.max(bc).max(ca) }
    }

    /// Those at the first sample between the corners, and at the last.
    #[inline(always)]
    fn at_ends(
        places: [&[f32x16<S>; 3]; 2],
        [rows, columns]: [&Between<S>; 2],
    ) -> [EdgeValues<S>; 2] {
        [
            EdgeValues::new(places, [rows.first, columns.first]),
            EdgeValues::new(places, [rows.last, columns.last]),
        ]
    }

    /// Whether triangles certainly do not cover the sample, as two edge functions have different signs there, by more than is in
    /// `doubt`.
    #[inline(always)]
    fn differ(&self, doubt: f32x16<S>) -> mask32x16<S> {
        self.most.simd_gt(doubt) & self.least.simd_lt(-doubt)
    }

    /// Whether triangles certainly cover the sample, as all have the same sign, by more than is in `doubt`.
    #[inline(always)]
    fn agree(&self, doubt: f32x16<S>) -> mask32x16<S> {
        self.least.simd_gt(doubt) | self.most.simd_lt(-doubt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fast::camera_map::CameraMap;
    use crate::fast::search::tile_frustum::FrustumTemplate;
    use crate::fast::search::tree::{Bounds, LEAF};
    use bothways_common::engine::simd::{best_level, dispatch, levels};
    use bothways_common::glam::Vec3;
    use bothways_common::{Camera, CameraDescription, Scene, View};

    /// Corners of sixteen triangles, their `y` and their `x`.
    type Sixteen = [[[f32; LEAF]; 3]; 2];

    /// Which of them are beside a sample at the origin: by the doubt of their size, by that of any size, and by a third of that.
    fn beside(corners: &Sixteen, error: f32) -> [u64; 3] {
        dispatch!(best_level(), simd => {
            let [y, x] = corners.map(|rows| rows.map(|row| f32x16::load_array(simd, row)));
            let size = |[a, b, c]: [f32x16<_>; 3]| a.max(b).max(c) - a.min(b).min(c);
            let of_any_size = f32x16::splat(simd, doubt_of_any_size(error));
            let doubts = [doubt_of_size(size(x).max(size(y)), error), of_any_size, of_any_size * (1.0 / 3.0)];
            let zero = f32x16::splat(simd, 0.0);
            let values = EdgeValues::new([&y, &x], [zero, zero]);
            doubts.map(|doubt| (values.differ(doubt) | values.agree(doubt)).to_bitmask())
        })
    }

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "what is off is less for it")]
    fn triangles_are_not_beside_a_sample_on_their_edge_however_their_corners_are_off() {
        let mut random = fastrand::Rng::with_seed(21);
        let mut too_little = 0;
        for round in 0..30_000 {
            let error = 2_f64.powf(-4.0 - 16.0 * random.f64());
            // Another sample is beside this one, in the same row or column, or none is.
            let mut ends = [[-1.0, 1.0]; 2];
            if let Some(axis) = ends.get_mut(round % 3) {
                *axis = if random.bool() { [-1.0, 2.0] } else { [-2.0, 1.0] };
            }
            let ends = ends.map(|[low, high]| [low + 2.0 * error, high - 2.0 * error]);
            let mut inside = || ends.map(|[low, high]| low + (high - low) * random.f64());
            let (a, c) = (inside(), inside());
            // The line from the corner through the sample, up to where it ends.
            let most = [0, 1].map(|axis| {
                let [low, high] = ends[axis];
                (if a[axis] > 0.0 { -low } else { high }) / a[axis].abs()
            });
            let opposite = most[0].min(most[1]) * random.f64();
            let b = a.map(|value| -value * opposite);
            let mut corners: Sixteen = [[[0.0; LEAF]; 3]; 2];
            for (axis, rows) in corners.iter_mut().enumerate() {
                for (row, corner) in rows.iter_mut().zip([a, b, c]) {
                    *row = [(); LEAF].map(|()| {
                        let off = if random.bool() { error } else { -error };
                        // Not farther off for its rounding.
                        (corner[axis] + off * (1.0 - 1e-6)) as f32
                    });
                }
            }
            let [of_size, of_any_size, third] = beside(&corners, error as f32);
            assert_eq!([of_size, of_any_size], [0; 2], "{corners:?} {error}");
            too_little += third.count_ones();
        }
        assert!(too_little > 100, "a third of it is too little {too_little} times");
    }

    /// A triangle with a sample inside, and the exact key there, an affine function of row and column.
    struct KnownTriangle {
        corners: [[f64; 2]; 3],
        slopes: [f64; 2],
        sample: [f64; 2],
    }

    impl KnownTriangle {
        fn new(random: &mut fastrand::Rng, steep: f64) -> KnownTriangle {
            let (is_turned, longer) = (random.bool(), random.usize(0..3));
            let mut number = |from: f64, to: f64| from + (to - from) * random.f64();
            let sample = [0, 1].map(|_| number(-0.5, 31.5).round());
            // Along one axis there may be room for another sample.
            let mut around = [[0.95, 0.95]; 2];
            if let Some(axis) = around.get_mut(longer) {
                *axis = if is_turned { [1.95, 0.95] } else { [0.95, 1.95] };
            }
            // Some are thin.
            let thin = if number(0.0, 1.0) < 0.3 { 0.05 } else { 1.0 };
            let [[low_y, high_y], [low_x, high_x]] = [0, 1].map(|axis| {
                let (place, [below, above]) = (sample[axis], around[axis]);
                let factor = if axis == 0 { thin } else { 1.0 };
                [number(place - factor * below, place), number(place, place + factor * above)]
            });
            let mut corners =
                [[low_y, number(low_x, high_x)], [number(low_y, high_y), high_x], [high_y, low_x]];
            if is_turned {
                corners.swap(0, 1);
            }
            let slopes = [number(-steep, steep), number(-steep, steep)];
            KnownTriangle { corners, slopes, sample }
        }

        fn key(&self, at: [f64; 2]) -> f64 {
            1.0 + self.slopes[0] * (at[0] - self.sample[0])
                + self.slopes[1] * (at[1] - self.sample[1])
        }
    }

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "what is off is less for it")]
    fn keys_are_in_their_intervals_however_places_are_off() {
        let camera = Camera::new(CameraDescription::default()).unwrap();
        let scene = Scene::new(Vec::new()).unwrap();
        let (view, reach) =
            (View::new(&scene, &camera), Bounds { low: Vec3::ZERO, high: Vec3::ONE });
        let map = CameraMap::new(&view, 1, &reach);
        let template = FrustumTemplate::new(&map, 32);
        let frustum = template.frustum([0, 0]);
        let mut random = fastrand::Rng::with_seed(23);
        let (mut found, mut at_second, mut too_little) = (0, 0, 0);
        for _ in 0..20_000 {
            let error = 2_f64.powf(-6.0 - 12.0 * random.f64());
            let steep = 2_f64.powf(-12.0 * random.f64()) * 0.1;
            let known = KnownTriangle::new(&mut random, steep);
            let (mut places, mut keys) = ([[[0.0; LEAF]; 3]; 2], [[0.0; LEAF]; 3]);
            for lane in 0..LEAF {
                for (k, corner) in known.corners.into_iter().enumerate() {
                    keys[k][lane] = known.key(corner) as f32;
                    for axis in 0..2 {
                        let off = if random.bool() { error } else { -error };
                        places[axis][k][lane] = (corner[axis] + off * 0.999) as f32;
                    }
                }
            }
            // A key is rounded when it is made here; two sums follow.
            let errors = CornerErrors { place: error as f32 + 64.0 * EPS24, key: 4.0 * EPS24 };
            for level in levels() {
                let ([row, column], [key, off], which) = dispatch!(level, simd => {
                    let places = places.map(|rows| rows.map(|row| f32x16::load_array(simd, row)));
                    let keys = keys.map(|row| f32x16::load_array(simd, row));
                    let (_, only) = OnlySamples::new(simd, &frustum, &places, errors.place);
                    let of = |rows: [f32x16<_>; 2]| rows.map(|row| row.to_array());
                    (of(only.place), of(only.key(&keys, &errors)), only.which.to_bitmask())
                });
                for lane in (0..LEAF).filter(|lane| which >> lane & 1 == 1) {
                    let place = [row[lane], column[lane]].map(f64::from);
                    assert!(place.iter().all(|place| (0.0..=31.0).contains(place)), "{place:?}");
                    let (exact, key, off) =
                        (known.key(place), f64::from(key[lane]), f64::from(off[lane]));
                    assert!((key - exact).abs() <= off, "{key} is not {exact} within {off}");
                    too_little += u32::from((key - exact).abs() > 0.25 * off);
                    found += 1;
                    at_second += u32::from(place != known.sample);
                }
            }
        }
        assert!(found > 100_000 && at_second > 5_000, "{found} {at_second}");
        assert!(too_little > 100, "a quarter of it is too little {too_little} times");
    }
}
