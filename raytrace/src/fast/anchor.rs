//! Where a leaf's vertices are seen, in `f32`: the place of one of them, the anchor, is computed in `f64`, and the
//! others lie so near it that they need no more.

use super::rays::Lens;
use super::rough::{LARGEST, Plane, U, narrowed, upward};
use super::tree::LEAF;
use bothways_common::engine::simd::{Simd, SimdBase, f32x16};

/// Columns beyond the tile for which errors are derived, and beyond any that is asked for.
const BESIDE: f64 = 3.0;

/// The map of [`super::rays`] about a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Anchor {
    vertex: [f32; 3],
    /// `t`, columns and rows times `t`, at points relative to the vertex.
    map: [Plane; 3],
    /// How far a column or row may be off.
    pub(super) error: f32,
}

/// What errors of places have in common in all tiles: those of a column times `t`, for each unit that a vertex
/// may be away from the anchor along an axis, and besides; and those of a column.
#[derive(Clone, Copy, Debug)]
pub(super) struct Errors {
    away: f32,
    at_anchor: f32,
    rounding: f32,
}

/// What bounds the numbers of a map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    /// Coordinates of points relative to the eye.
    pub(super) reach: f64,
    /// The sums of the coordinates of normals: those of columns and rows, and that of `t`, which is nothing if
    /// nothing is divided by it.
    pub(super) place: f64,
    pub(super) t: f64,
    /// Columns from the middle of the tile to a side.
    pub(super) wide: f64,
    /// By how much samples may be off, and all that is computed in `f64`: columns times `t`.
    pub(super) exact: f64,
}

impl Errors {
    /// Nothing is known of places.
    pub(super) const UNKNOWN: Errors =
        Errors { away: f32::INFINITY, at_anchor: f32::INFINITY, rounding: f32::INFINITY };

    /// # The errors, rounding by rounding
    ///
    /// `u = 2⁻²⁴`, `P` is the size of the leaf's box, of which no vertex is farther from the anchor along an axis;
    /// `S` and `T` are the sums of the coordinates of the normals of a column and of `t`, and `W` is the tile's half
    /// width and 3.
    ///
    /// *Columns times `t`.* A coordinate relative to the anchor carries one rounding, the normal's one, their product
    /// one, their sum two, the sum with the anchor's one: six of `P·S`; the anchor's own column `o` carries one and
    /// that of the sum. `6.5u·P·S + 2.1u·|o|` is more, with what is of second order. What underflows is less than the
    /// smallest normal number, for a normal's coordinate times the distance of two vertices.
    ///
    /// *`t`.* Likewise, and its value at the anchor is at most `t + P·T`: `8.7u·P·T + 2.1u·t`.
    ///
    /// *Columns* up to `W`. `x̂/t̂ − x/t = (e_x − (x/t)·e_t)/t̂`. If that is less than 1/16, `e_t` is less than `t/40`
    /// and `1/t̂` less than `1.026/t`; so `9u·P·(S + W·T)`, `2.5u·|o|` and 1.1 times the other errors, over a `t` that
    /// is not larger than any of the leaf, are more. `W` times `2.2u`, which is left of `e_t`, twice `2.1u` for the
    /// reciprocal and the product, `2u` for the first column's being counted from the tile's side, and `2u` for the
    /// sum with this error, which follows: less than `12u·W`.
    ///
    /// *Columns beyond `W`*: the same relative error, so these are taken for columns outside of the tile, by more than
    /// two.
    pub(super) fn new(sizes: &Sizes) -> Errors {
        let Sizes { reach, place, t, wide, exact } = *sizes;
        let away = place + (wide + BESIDE) * t;
        let underflow = 4.0 * f64::from(f32::MIN_POSITIVE) * (1.0 + reach);
        let is_ordinary = 2.0 * reach * away.max(1.0) < LARGEST;
        Errors {
            away: if is_ordinary { upward(9.0 * U * away) } else { f32::INFINITY },
            at_anchor: upward(1.1 * (exact + underflow)),
            rounding: upward(12.0 * U * (wide + BESIDE)),
        }
    }

    /// How far a column or row may be off in a leaf of such a size, in which no `t` is less than `near`. At least
    /// `36u`. Infinite or NaN if numbers might overflow, or vertices lie behind the eye.
    #[inline(always)]
    fn of(&self, size: f32, anchor: [f32; 2], near: f32) -> f32 {
        const ROUNDINGS: f32 = 1.0 + 8.0 * f32::EPSILON;
        let near = if near > 0.0 { near } else { f32::NAN };
        let anchor = anchor[0].abs().max(anchor[1].abs()) * (1.25 * f32::EPSILON);
        (self.away * size + anchor + self.at_anchor) / near * ROUNDINGS + self.rounding
    }
}

impl Anchor {
    /// For a leaf of which no vertex is farther from this one along any axis than `size`, nor has a `t` less than
    /// `near`, which was computed with [`super::rough`].
    #[inline(always)]
    pub(super) fn new(lens: &Lens, vertex: [f32; 3], size: f32, near: f32) -> Anchor {
        let kind = lens.kind;
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(vertex[axis]) - kind.eye[axis]);
        let at_vertex = |row: usize| {
            let [nx, ny, nz] = lens.rows[row];
            narrowed(x * nx + y * ny + z * nz + lens.shift[row])
        };
        let [t, column, row] = [at_vertex(0), at_vertex(1), at_vertex(2)];
        let near = if kind.parallel { 1.0 } else { kind.rough.nearest(near) };
        let [of_t, across, down] = lens.normals;
        Anchor {
            vertex,
            map: [
                Plane { normal: of_t, offset: t },
                Plane { normal: across, offset: column },
                Plane { normal: down, offset: row },
            ],
            error: kind.places.of(size, [column, row], near),
        }
    }

    /// Whether places are known to far less than a column; they are not near the eye.
    #[inline(always)]
    pub(super) fn is_useful(&self) -> bool {
        (0.0..1.0 / 16.0).contains(&self.error)
    }

    /// The columns and rows where vertices are seen, counted from the tile's first.
    #[inline(always)]
    pub(super) fn places<S: Simd>(
        &self,
        simd: S,
        lens: &Lens,
        [x, y, z]: [&[f32; LEAF]; 3],
    ) -> [f32x16<S>; 2] {
        let from_vertex = [
            f32x16::load_array_ref(simd, x) - self.vertex[0],
            f32x16::load_array_ref(simd, y) - self.vertex[1],
            f32x16::load_array_ref(simd, z) - self.vertex[2],
        ];
        let [t, across, down] = &self.map;
        let (across, down) = (across.at(from_vertex), down.at(from_vertex));
        let half = -lens.offset(0);
        if lens.kind.parallel {
            [across + half, down + half]
        } else {
            let by_t = f32x16::splat(simd, 1.0) / t.at(from_vertex);
            [across * by_t + half, down * by_t + half]
        }
    }
}
