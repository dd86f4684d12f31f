//! How far off the rows and columns of a local projection may be, in all tiles.

use super::world_affine::{LARGEST, upward};
use bothways_common::engine::roundoff::EPS24;

/// Errors are derived for this many columns beyond the tile; none farther out is used.
const BESIDE: f64 = 3.0;

/// What the errors of local projections share in all tiles: those of a column times `t`, for each unit that a vertex
/// may be away from the projection's own vertex along an axis, and besides; those of a column; and those of `t` for each such unit.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalErrors {
    away: f32,
    at_vertex: f32,
    rounding: f32,
    t_away: f32,
}

/// What bounds the numbers of a map.
#[derive(Clone, Copy, Debug)]
pub(super) struct MapSizes {
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

impl LocalErrors {
    /// Nothing is known of places.
    pub(super) const UNKNOWN: LocalErrors = LocalErrors {
        away: f32::INFINITY,
        at_vertex: f32::INFINITY,
        rounding: f32::INFINITY,
        t_away: f32::INFINITY,
    };

    /// # The errors, rounding by rounding
    ///
    /// `P` is the size of the leaf's box, of which no vertex is farther from the projection's vertex along an axis;
    /// `S` and `T` are the sums of the coordinates of the normals of a column and of `t`, and `W` is the tile's half
    /// width and 3.
    ///
    /// *Columns times `t`.* A coordinate relative to the vertex carries one rounding, the normal's one, their product
    /// one, their sum two, the sum with the vertex's one: six of `P·S`; the vertex's own column `o` carries one and
    /// that of the sum. `6.5·ε₂₄·P·S + 2.1·ε₂₄·|o|` is more, with what is of second order. What underflows is less than the
    /// smallest normal number, for a normal's coordinate times the distance of two vertices.
    ///
    /// *`t`.* Likewise, and its value at the vertex is at most `t + P·T`: `8.7·ε₂₄·P·T + 2.1·ε₂₄·t`.
    ///
    /// *Columns* up to `W`. `x̂/t̂ − x/t = (e_x − (x/t)·e_t)/t̂`. If that is less than 1/16, `e_t` is less than `t/40`
    /// and `1/t̂` less than `1.026/t`; so `9·ε₂₄·P·(S + W·T)`, `2.5·ε₂₄·|o|` and 1.1 times the other errors, over a `t` that
    /// is not larger than any of the leaf, are more. `W` times `2.2·ε₂₄`, which is left of `e_t`, twice `2.1·ε₂₄` for the
    /// reciprocal and the product, `2·ε₂₄` for the first column's being counted from the tile's side, and `2·ε₂₄` for the
    /// sum with this error, which follows: less than `12·ε₂₄·W`.
    ///
    /// *Columns beyond `W`*: the same relative error, so these are taken for columns outside of the tile, by more than
    /// two.
    pub(super) fn new(sizes: &MapSizes) -> LocalErrors {
        let MapSizes { reach, place, t, wide, exact } = *sizes;
        let away = place + (wide + BESIDE) * t;
        let underflow = 4.0 * f64::from(f32::MIN_POSITIVE) * (1.0 + reach);
        let is_ordinary = 2.0 * reach * away.max(1.0) < LARGEST;
        let roundings = |count: f64, size: f64| upward(count * f64::from(EPS24) * size);
        LocalErrors {
            away: if is_ordinary { roundings(9.0, away) } else { f32::INFINITY },
            at_vertex: upward(1.1 * (exact + underflow)),
            rounding: roundings(12.0, wide + BESIDE),
            t_away: roundings(9.0, t),
        }
    }

    /// What roundings from columns times `t` to columns bring, to those of the tile.
    pub(super) fn rounding(&self) -> f32 {
        self.rounding
    }

    /// How far a key in such a leaf may be off, `1/t` of a perspective camera, as a part of it; and the roundings of two sums with it.
    ///
    /// Where a column is off by less than 1/16, `t` is by less than a fortieth of it, and its reciprocal by 1.026 times as much as `t`
    /// and by `ε₂₄`. So of `t` come `9·ε₂₄·P·T`, `2.2·ε₂₄·t` and 1.1 times what columns times `t` are off by in `f64`, which is more than
    /// the `t` of a vertex and that of a ray are; with the reciprocal and two sums `5.2·ε₂₄` in all, and 5.5 with what is of second
    /// order. No vertex has a `t` greater than 2 in the scale of the map, so that no key underflows.
    #[inline(always)]
    pub(super) fn of_key(&self, size: f32, by_near: f32) -> f32 {
        (self.t_away * size + self.at_vertex) * by_near + 5.5 * EPS24
    }

    /// An upper estimate of how many columns or rows apart places of a leaf of such a size are, in which no `t` is less than
    /// `1 / by_near`; see [`LocalErrors::of`].
    #[inline(always)]
    pub(super) fn extent(&self, size: f32, by_near: f32) -> f32 {
        // Nine roundings of it are in `away`.
        self.away * (1.0 / (9.0 * EPS24)) * size * by_near
    }

    /// How far a row or column may be off in a leaf of such a size, in which no `t` is less than `1 / by_near`, but for two
    /// roundings of that; `vertex` is the row and column of the projection's vertex, whose sum is no less than either. At least
    /// `36·ε₂₄`. Infinite or NaN if numbers might overflow, or vertices lie behind the eye.
    #[inline(always)]
    pub(super) fn of(&self, size: f32, vertex: [f32; 2], by_near: f32) -> f32 {
        const ROUNDINGS: f32 = 1.0 + 16.0 * EPS24;
        let vertex = (vertex[0].abs() + vertex[1].abs()) * (2.5 * EPS24);
        (self.away * size + self.at_vertex + vertex) * (by_near * ROUNDINGS) + self.rounding
    }
}
