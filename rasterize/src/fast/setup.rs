//! Sixteen triangles set up at a time: edge functions and depth as affine functions on the raster, in
//! `f32`, with the error of their rounding.

use super::aligned::TIE;
use super::depth::KEY_ERROR;
use super::lanes::{Lanes, in_all_lanes, lanes_of};
use super::size_class::{FEW_COLUMNS_IN_ALL, MOST_SAMPLES_ACROSS, THIN};
use super::vertices::{ALIGNED, FixedPointRaster};
use bothways_common::Sign;
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::names::Names;
use bothways_common::engine::roundoff::EPS24;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdInt, SimdMask, apart, f32x16, i32x16, mask32x16,
};
use bothways_common::observe::EventSink;
use bothways_common::raster::{Region, Sample};
use std::ops::Range;

/// Fixed-point units that a box of samples has room for around its vertices.
pub(super) const BOX_MARGIN: i32 = 2;

/// Sixteen triangles, ready to be drawn. Rows and columns within a triangle count from its box's first
/// sample.
#[derive(Clone, Debug)]
pub(super) struct Setup {
    pub(super) ids: [u32; 16],
    /// Edge functions opposite to `c`, `a`, `b`: `at_origin + column·across + row·down`, positive inside.
    pub(super) at_origin: [[f32; 16]; 3],
    pub(super) across: [[f32; 16]; 3],
    pub(super) down: [[f32; 16]; 3],
    /// Beyond this an edge function's sign is certain.
    pub(super) error: [f32; 16],
    /// The key in the same form, NaN if it cannot be trusted: at the origin, across, down.
    pub(super) key: [[f32; 16]; 3],
    /// The box of samples that the triangle may cover: first row and column, and how many.
    pub(super) first_row: [i32; 16],
    pub(super) first_column: [i32; 16],
    pub(super) rows: [i32; 16],
    pub(super) columns: [i32; 16],
    /// The sign of the triangle's facing, ±1.
    pub(super) facing: [f32; 16],
    /// Lanes that must be drawn another way, because the facing is not certain.
    pub(super) uncertain: u16,
    /// Lanes whose keys cannot be trusted.
    pub(super) keyless: u16,
    /// Lanes whose triangles are [thin](super::size_class::THIN), and have more than a few columns in all.
    pub(super) thin: u16,
}

impl Setup {
    /// Sets up the triangles of all lanes.
    ///
    /// # The errors, rounding by rounding
    ///
    /// All lengths are in samples; `w` and `h` are the sides of the box of the vertices,
    /// widened by two fixed-point units on each side; `P = w·h`. The box's first sample lies in it, so
    /// the fixed-point differences below are at most `w` and `h`; they are exact integers, rounded once
    /// when they become `f32`.
    ///
    /// *Edge functions.* `C = dy·px − dx·py`: two products of 3 roundings each, at most `P`, and a
    /// difference, which is the edge function at a point of the box and so at most `P`: `7ε₂₄P`. `B·row`: 2
    /// roundings; `C + B·row`, at most `P` again: one; `A·column`: 2; their sum: one (columns before rows
    /// bring as much). Together `13ε₂₄P`, to
    /// which [`FixedPointRaster::slack`] adds the error of the places, times `w + h`. The constants are larger by
    /// more than the roundings of the bound.
    ///
    /// *Facing.* The area is an edge function at a vertex, computed with at most `8ε₂₄P`, of which one more
    /// place is off: `1.5` times the error of an edge function covers it.
    ///
    /// *Key.* With `E` the error of an edge function and `ρ = E/area`, at most 2⁻⁴, the weights `λ_b =
    /// E_ca/area` and `λ_c` are off by `1.1·ρ` for the numerator and, times the weight, `1.1·1.5·ρ` for the
    /// area: `2.8·ρ·(|k_b − k_a| + |k_c − k_a|)` in all, the weights of a covered sample summing up to at most
    /// one. Edge functions are at most `P` in the box, and so are `A·column` and `B·row`. So with `κ = ε₂₄·P·(|k_b −
    /// k_a| + |k_c − k_a|)/area` the key at the origin brings `3κ` and twice `ε₂₄·k_a`, each slope times its column
    /// or row `2κ`, evaluation `κ` for each product and for each of two sums, and of `k_a` twice `ε₂₄`: `11κ` in
    /// all, also of aligned triangles. The vertices' keys bring `1.35ε₂₄` of the largest one (see
    /// [`FixedPointRaster::place`]), their differences and the quotients `2.2ε₂₄` of the differences: with what `k_a`
    /// brings, `7.6ε₂₄`.
    ///
    /// *Aligned triangles.* Places are multiples of a quarter of a sample without any error, so edge
    /// functions are multiples of 1/16, below 2¹⁷, and `f32` adds and multiplies them without rounding.
    /// [`TIE`] decides those that are zero; the key does without it.
    ///
    /// It is compiled once for all loops that call it.
    #[inline(never)]
    pub(super) fn new<S: Simd, F: Fault>(
        simd: S,
        raster: &FixedPointRaster,
        lanes: &Lanes,
    ) -> Setup {
        apart!(simd, {
            let places = [lanes.places(simd, 0), lanes.places(simd, 1)];
            let boxes = [
                AxisBounds::new::<F>(simd, raster, 0, &places[0]),
                AxisBounds::new::<F>(simd, raster, 1, &places[1]),
            ];
            let errors = Errors::new::<F>(simd, raster, lanes, &boxes);
            let edges = EdgeFunctions::new::<F>(simd, raster, &places, &boxes, errors.aligned);
            let keys = Keys::new::<F>(simd, lanes, &edges, &errors);

            let (used, zero) = (lanes.used(simd), i32x16::splat(simd, 0));
            let flat = edges.area.simd_eq(f32x16::splat(simd, 0.0));
            let certain =
                edges.area.simd_gt(f32x16::splat(simd, 1.5) * errors.edge) | errors.aligned;
            let drawn = used & certain & !(errors.aligned & flat);
            let [across, down] = [edges.across, edges.down];
            Setup {
                ids: lanes.ids(simd).to_array(),
                at_origin: arrays(edges.shifted()),
                across: arrays(across),
                down: arrays(down),
                error: errors.edge.to_array(),
                key: arrays(keys.functions(simd)),
                first_row: boxes[0].first.to_array(),
                first_column: boxes[1].first.to_array(),
                rows: boxes[0].count.to_array(),
                columns: drawn.select(boxes[1].count, zero).to_array(),
                facing: edges.facing.to_array(),
                uncertain: mask_of((used & !certain).to_bitmask()),
                keyless: mask_of((drawn & !keys.trusted).to_bitmask()),
                thin: mask_of((drawn & are_thin(simd, &boxes, edges.area)).to_bitmask()),
            }
        })
    }
}

/// Which of sixteen triangles are thin, given by their boxes and twice their areas.
#[inline(always)]
fn are_thin<S: Simd>(
    simd: S,
    [down, across]: &[AxisBounds<S>; 2],
    twice_area: f32x16<S>,
) -> mask32x16<S> {
    across.count.simd_gt(i32x16::splat(simd, FEW_COLUMNS_IN_ALL))
        & twice_area.simd_le(down.count.to_float::<f32x16<S>>() * THIN)
}

/// The errors of sixteen triangles; [`Setup::new`] derives them.
struct Errors<S: Simd> {
    /// Of an edge function.
    edge: f32x16<S>,
    /// What rounding alone contributes.
    rounding: f32x16<S>,
    /// The lanes that have no error: all corners are aligned.
    aligned: mask32x16<S>,
}

impl<S: Simd> Errors<S> {
    #[inline(always)]
    fn new<F: Fault>(
        simd: S,
        raster: &FixedPointRaster,
        lanes: &Lanes,
        [down_box, across_box]: &[AxisBounds<S>; 2],
    ) -> Self {
        let splat = |value: f32| f32x16::splat(simd, value);
        let height = down_box.widened_length(simd, raster);
        let width = across_box.widened_length(simd, raster);
        let rounding = splat(13.6 * EPS24) * (width * height);
        let error = splat(raster.slack) * (width + height) + rounding;
        let error = if F::is(Planted::InfiniteErrorBound) { splat(f32::INFINITY) } else { error };
        let aligned = lanes.flags(simd) & i32x16::splat(simd, ALIGNED);
        let aligned = aligned.simd_ne(i32x16::splat(simd, 0));
        let error = aligned.select(splat(0.0), error);
        let error = if F::is(Planted::ZeroErrorBound) { splat(0.0) } else { error };
        Errors { edge: error, rounding, aligned }
    }
}

/// The edge functions of sixteen triangles, opposite to `c`, `a`, `b`.
struct EdgeFunctions<S: Simd> {
    at_origin: [f32x16<S>; 3],
    across: [f32x16<S>; 3],
    down: [f32x16<S>; 3],
    /// What aligned triangles add, to decide ties.
    shift: [f32x16<S>; 3],
    /// Twice the area, and its sign.
    area: f32x16<S>,
    facing: f32x16<S>,
}

impl<S: Simd> EdgeFunctions<S> {
    #[inline(always)]
    fn new<F: Fault>(
        simd: S,
        raster: &FixedPointRaster,
        [y, x]: &[[i32x16<S>; 3]; 2],
        [down_box, across_box]: &[AxisBounds<S>; 2],
        aligned: mask32x16<S>,
    ) -> Self {
        let splat = |value: f32| f32x16::splat(simd, value);
        let (unit, bits) = (splat(raster.unit), raster.fraction_bits);
        let (dx, px) = differences(x, across_box.first << bits, unit);
        let (dy, py) = differences(y, down_box.first << bits, unit);
        let area = dy[0] * dx[2] - dx[0] * dy[2];
        let facing = area.simd_lt(splat(0.0)).select(splat(-1.0), splat(1.0));

        let mut at_origin = [splat(0.0); 3];
        let mut across = at_origin;
        let mut down = at_origin;
        let mut shift = at_origin;
        for k in 0..3 {
            across[k] = -dy[k] * facing;
            down[k] = dx[k] * facing;
            let to_right = across[k].simd_gt(splat(0.0));
            let level = across[k].simd_eq(splat(0.0));
            let owned = to_right | (level & down[k].simd_gt(splat(0.0)));
            let half = splat(TIE);
            let by =
                if F::is(Planted::StrictComparison) { -half } else { owned.select(half, -half) };
            shift[k] = aligned.select(by, splat(0.0));
            at_origin[k] = (dy[k] * px[k] - dx[k] * py[k]) * facing;
        }
        EdgeFunctions { at_origin, across, down, shift, area: area.abs(), facing }
    }

    /// The functions at the origin, with ties decided.
    #[inline(always)]
    fn shifted(&self) -> [f32x16<S>; 3] {
        let (at_origin, shift) = (&self.at_origin, &self.shift);
        [at_origin[0] + shift[0], at_origin[1] + shift[1], at_origin[2] + shift[2]]
    }
}

/// The depth keys of sixteen triangles.
struct Keys<S: Simd> {
    at_origin: f32x16<S>,
    across: f32x16<S>,
    down: f32x16<S>,
    /// The lanes whose keys are within [`KEY_ERROR`] of the true ones.
    trusted: mask32x16<S>,
}

impl<S: Simd> Keys<S> {
    #[inline(always)]
    fn new<F: Fault>(simd: S, lanes: &Lanes, edges: &EdgeFunctions<S>, errors: &Errors<S>) -> Self {
        let splat = |value: f32| f32x16::splat(simd, value);
        let (keys, area) = (lanes.keys(simd), edges.area);
        let (to_b, to_c) = (keys[1] - keys[0], keys[2] - keys[0]);
        let (by_b, by_c) = (to_b / area, to_c / area);
        let largest = keys[0].max(keys[1]).max(keys[2]);
        let least = keys[0].min(keys[1]).min(keys[2]);
        let error = (splat(2.8) * errors.edge + splat(0.9) * errors.rounding) / area
            * (to_b.abs() + to_c.abs())
            + splat(13.0 * EPS24) * largest;
        let mut trusted =
            error.simd_le(splat(KEY_ERROR) * least) & (splat(16.0) * errors.edge).simd_le(area);
        if F::is(Planted::ZeroErrorBound) {
            trusted = lanes.used(simd);
        }
        Keys {
            at_origin: keys[0] + by_b * edges.at_origin[2] + by_c * edges.at_origin[0],
            across: by_b * edges.across[2] + by_c * edges.across[0],
            down: by_b * edges.down[2] + by_c * edges.down[0],
            trusted,
        }
    }

    /// The key as a function, NaN if it cannot be trusted: at the origin, across, down.
    #[inline(always)]
    fn functions(&self, simd: S) -> [f32x16<S>; 3] {
        let nan = f32x16::splat(simd, f32::NAN);
        [self.trusted.select(self.at_origin, nan), self.across, self.down]
    }
}

/// A mask of sixteen lanes.
#[inline(always)]
fn mask_of(lanes: u64) -> u16 {
    u16::try_from(lanes).expect("a mask has 16 lanes")
}

#[inline(always)]
fn arrays<S: Simd>([a, b, c]: [f32x16<S>; 3]) -> [[f32; 16]; 3] {
    [a.to_array(), b.to_array(), c.to_array()]
}

/// Along one axis, the differences from corner to corner, and from the box's first sample to each corner.
#[inline(always)]
fn differences<S: Simd>(
    places: &[i32x16<S>; 3],
    origin: i32x16<S>,
    unit: f32x16<S>,
) -> ([f32x16<S>; 3], [f32x16<S>; 3]) {
    let [a, b, c] = *places;
    (
        [difference(b, a, unit), difference(c, b, unit), difference(a, c, unit)],
        [difference(a, origin, unit), difference(b, origin, unit), difference(c, origin, unit)],
    )
}

/// The difference of two fixed-point places, in samples.
#[inline(always)]
fn difference<S: Simd>(to: i32x16<S>, from: i32x16<S>, unit: f32x16<S>) -> f32x16<S> {
    (to - from).to_float::<f32x16<S>>() * unit
}

/// Along one axis, the boxes of sixteen triangles: the samples that they may cover, and the lengths
/// between their outermost vertices.
#[derive(Clone, Copy)]
pub(super) struct AxisBounds<S: Simd> {
    /// The first sample, and how many.
    pub(super) first: i32x16<S>,
    pub(super) count: i32x16<S>,
    /// In fixed point; negative where it is 2³¹ or more.
    length: i32x16<S>,
}

impl<S: Simd> AxisBounds<S> {
    /// A vertex is at most half a unit and the margin, which is at most one unit, from its place.
    #[inline(always)]
    pub(super) fn new<F: Fault>(
        simd: S,
        raster: &FixedPointRaster,
        axis: usize,
        places: &[i32x16<S>; 3],
    ) -> Self {
        let splat = |value: i32| i32x16::splat(simd, value);
        let bits = raster.fraction_bits;
        let margin = if F::is(Planted::ShrunkBox) { -1 } else { BOX_MARGIN };
        let low = places[0].min(places[1]).min(places[2]);
        let high = places[0].max(places[1]).max(places[2]);
        let first = ((low + splat((1 << bits) - 1 - margin)) >> bits).max(splat(0));
        let last = ((high + splat(margin)) >> bits).min(splat(raster.size[axis] - 1));
        AxisBounds { first, count: (last - first + splat(1)).max(splat(0)), length: high - low }
    }

    /// The length with two units on each side, in samples.
    #[inline(always)]
    fn widened_length(&self, simd: S, raster: &FixedPointRaster) -> f32x16<S> {
        let length = self.length + i32x16::splat(simd, 2 * BOX_MARGIN);
        length.to_float::<f32x16<S>>() * f32x16::splat(simd, raster.unit)
    }

    /// Whether it is no longer than `f32` takes.
    #[inline(always)]
    pub(super) fn is_short(&self, simd: S, raster: &FixedPointRaster) -> mask32x16<S> {
        let most = i32x16::splat(simd, MOST_SAMPLES_ACROSS << raster.fraction_bits);
        self.length.simd_lt(most) & self.length.simd_ge(i32x16::splat(simd, 0))
    }
}

/// One triangle with its affine functions, as [`Setup`] has sixteen; or one strip of a plane.
#[derive(Clone, Debug)]
pub(super) struct FlatSetup {
    pub(super) id: u32,
    /// Edge functions: at the origin, a column across, a row down.
    pub(super) edges: [[f32; 3]; 3],
    pub(super) error: f32,
    /// The key likewise.
    pub(super) key: [f32; 3],
    /// The sample from which rows and columns count.
    pub(super) origin: Sample,
    /// The samples that the triangle may cover: within 256 rows and columns of the origin.
    pub(super) region: Region,
    /// The sign of the triangle's facing, ±1; 0 for a plane, which has no edges.
    pub(super) facing: f32,
}

impl FlatSetup {
    /// Emits one test: the edge functions' signs as far as they are certain, in the orientation of
    /// the contract.
    pub(super) fn emit_test(
        &self,
        sink: &mut (impl EventSink + ?Sized),
        names: &Names,
        sample: Sample,
        edges: [f32; 3],
    ) {
        let (id, error) = (names.id(self.id), self.error);
        sink.sample_tested(sample, id);
        let out = edges.iter().any(|edge| *edge < -error);
        let inside = edges.iter().all(|edge| *edge > error);
        if self.facing != 0.0 && (out || inside) {
            let sign = |edge: f32| {
                let on_edge = error == 0.0 && edge.abs() == TIE;
                let sign = if on_edge { 0.0 } else { f64::from(self.facing * edge) };
                (edge.abs() > error).then(|| Sign::of(sign))
            };
            sink.edge_signs(sample, id, edges.map(sign));
        }
    }
}

impl Setup {
    /// The triangle of one lane.
    #[inline(always)]
    pub(super) fn triangle(&self, lane: usize) -> FlatSetup {
        let lane = lane & 15;
        let edge = |k: usize| [self.at_origin[k][lane], self.across[k][lane], self.down[k][lane]];
        let from = |first: &[i32; 16]| first[lane].cast_unsigned() as usize;
        let (row, column) = (from(&self.first_row), from(&self.first_column));
        let rows = row..row + from(&self.rows);
        FlatSetup {
            id: self.ids[lane],
            edges: [edge(0), edge(1), edge(2)],
            error: self.error[lane],
            key: [self.key[0][lane], self.key[1][lane], self.key[2][lane]],
            origin: Sample { row, column },
            region: Region { rows, columns: column..column + from(&self.columns) },
            facing: self.facing[lane],
        }
    }

    /// The lanes whose boxes have no more than `most` columns in a tile.
    #[inline(always)]
    pub(super) fn in_columns<S: Simd>(&self, simd: S, tile: &Range<usize>, most: usize) -> u16 {
        let first = i32x16::load_array(simd, self.first_column);
        let end = first + i32x16::load_array(simd, self.columns);
        let columns =
            end.min(in_all_lanes(simd, tile.end)) - first.max(in_all_lanes(simd, tile.start));
        mask_of(columns.simd_le(in_all_lanes(simd, most)).to_bitmask())
    }

    /// Adds the triangles of some lanes to others.
    #[inline(never)]
    pub(super) fn add_triangles(&self, lanes: u16, to: &mut Vec<FlatSetup>) {
        to.extend(lanes_of(lanes.into()).map(|lane| self.triangle(lane)));
    }

    /// The ids of some lanes.
    pub(super) fn ids_of(&self, lanes: u16) -> impl Iterator<Item = u32> {
        lanes_of(lanes.into()).map(|lane| self.ids[lane])
    }
}

#[cfg(test)]
impl FlatSetup {
    /// Edge functions of all slopes, some of them 0.
    pub(super) fn random(random: &mut fastrand::Rng) -> FlatSetup {
        let mut number = |most: f32| match random.u32(0..8) {
            0 => 0.0,
            1 => most * 1e-6 * (random.f32() - 0.5),
            _ => most * (random.f32() - 0.5),
        };
        let edges = std::array::from_fn(|_| [number(3e4), number(400.0), number(400.0)]);
        let error = number(10.0).abs();
        FlatSetup {
            id: 0,
            edges,
            error,
            key: [0.0; 3],
            origin: Sample { row: 0, column: 0 },
            region: Region { rows: 0..256, columns: 0..256 },
            facing: 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{dispatch, levels};

    /// Triangles in boxes of these first columns and numbers of columns.
    fn in_boxes(first_column: [i32; 16], columns: [i32; 16]) -> Setup {
        Setup {
            ids: [0; 16],
            at_origin: [[0.0; 16]; 3],
            across: [[0.0; 16]; 3],
            down: [[0.0; 16]; 3],
            error: [0.0; 16],
            key: [[0.0; 16]; 3],
            first_row: [0; 16],
            first_column,
            rows: [1; 16],
            columns,
            facing: [1.0; 16],
            uncertain: 0,
            keyless: 0,
            thin: 0,
        }
    }

    #[test]
    fn boxes_are_sorted_by_their_columns_in_the_tile() {
        let random = &mut fastrand::Rng::with_seed(7);
        let tile = Region { rows: 0..1, columns: 512..768 };
        let mut found = [0; 3];
        for _ in 0..300 {
            // Beside the tile on both sides, across its ends, and within.
            let first = [(); 16].map(|()| random.i32(480..800));
            let columns = [(); 16].map(|()| [0, 1, 7, 8, 9, 16, 17, 300][random.usize(0..8)]);
            let setup = in_boxes(first, columns);
            for (most, found) in [0, 8, 16].into_iter().zip(&mut found) {
                let is_in = |lane: &usize| {
                    setup.triangle(*lane).region.intersection(&tile).columns.len() <= most
                };
                let expected = (0..16).filter(is_in).fold(0, |mask, lane| mask | 1 << lane);
                for level in levels() {
                    dispatch!(level, simd => {
                        assert_eq!(setup.in_columns(simd, &tile.columns, most), expected);
                    });
                }
                *found += expected.count_ones();
            }
        }
        assert!(found[0] > 500 && found[0] < found[1] && found[1] < found[2], "{found:?}");
    }
}
