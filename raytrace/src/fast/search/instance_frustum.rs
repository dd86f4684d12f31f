//! The rays of a tile in the coordinates of an instance's mesh: there the hierarchy of the mesh is walked, which is the
//! same for all instances.

use super::box_culling::{BoxCulling, BoxHits, Sides, longest_side};
use super::tile_frustum::{FrustumTemplate, TileFrustum};
use super::tile_place::TilePlace;
use super::tree::{Bounds, Node, WIDTH};
use crate::fast::local_projection::{LocalProjection, reciprocal};
use crate::fast::world_affine::{LARGEST, WorldAffine, narrowed, upward};
use bothways_common::Placement;
use bothways_common::engine::context::Context;
use bothways_common::engine::fault::Planted;
use bothways_common::engine::roundoff::{EPS24, EPS53};
use bothways_common::engine::simd::{Select, Simd, SimdBase, SimdFloat, f32x16, mask32x16, u32x16};
use bothways_common::look::lanes::each;
use glam::{DMat3, DVec3, Vec3};

/// One instance, as a tile's rays see it.
#[derive(Clone, Debug)]
pub(crate) struct InstanceFrustum<'a> {
    pub(crate) place: PlacedBy<'a>,
    /// How boxes of the mesh are culled.
    boxes: BoxCulling,
    /// Where they are seen in the tile.
    places: Places,
    /// Where vertices of the mesh are seen.
    vertices: PlacedVertices,
    /// Along any axis of the world, two vertices in a box are at most as far from each other as the box's longest side
    /// times `stretch`, and `slack`.
    stretch: f32,
    slack: f32,
    /// The rows and columns of the tile at which it may be seen, the first and the last of each.
    pub(crate) seen: [[usize; 2]; 2],
    /// As of a box: see [`BoxHits`].
    pub(crate) near: f32,
    pub(crate) size: f32,
}

/// Columns and rows, times `t` of a perspective camera, from the tile's middle, as functions like that of `t`.
#[derive(Clone, Copy, Debug)]
struct Places {
    across: WorldAffine,
    down: WorldAffine,
    /// Columns from the tile's middle to its first sample, and what rays may be off.
    half: f32,
    beside: f32,
    /// What keys may be off: as a fraction, or that of a parallel camera.
    key_error: f32,
    parallel: bool,
}

/// What projects vertices of the mesh: see [`InstanceFrustum::projection`].
#[derive(Clone, Copy, Debug)]
struct PlacedVertices {
    t: WorldAffine,
    /// A computed `near` and this is not greater than the computed `t` of what it is said of.
    from_near: f64,
    /// How far columns times `t` may be off, and columns besides.
    error: f32,
    rounding: f32,
}

impl PlacedVertices {
    /// From what `t` and sides may be off by.
    fn new(
        frustum: &TileFrustum,
        functions: &WorldFunctions,
        [t_error, sides_error]: [f32; 2],
    ) -> PlacedVertices {
        let FrustumTemplate { boxes: world, errors, half, local, .. } = frustum.template;
        let at_origin = world.t_at_origin - (-48f64).exp2() * world.t_at_origin.abs();
        PlacedVertices {
            t: WorldAffine::new(functions.along[0], functions.at[0]),
            from_near: at_origin - f64::from(world.t_error) - f64::from(t_error),
            error: (4.0 * t_error + sides_error).next_up(),
            rounding: local.rounding() + upward(errors.wide - half),
        }
    }
}

/// Where an instance is, and the name of its first triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedBy<'a> {
    pub(crate) placement: &'a Placement,
    pub(crate) first_name: u32,
}

impl<'a> InstanceFrustum<'a> {
    /// For an instance of a mesh in this box; `None` if all rays of the tile miss it.
    ///
    /// A function of the world `N·p + o` is, with `p = M·q + τ`, the function `(MᵀN)·q + (N·τ + o)` of the mesh. It is
    /// computed in `f64` about the middle `c` of the mesh's box, and rounded to `f32`. So boxes stay as they are, and as
    /// tight.
    ///
    /// # The errors, rounding by rounding
    ///
    /// `H` is half of the mesh's box. The sums of what a coordinate is made of are `P = |M|·max|q| + |τ|`, and no vertex
    /// is farther from the origin of the world, along an axis, than `V = |M·c + τ| + |M|·H`.
    ///
    /// *The vertex* is `M·q + τ`, rounded thrice in `f64`, which is less than `4·ε₅₃·P`, and once to `f32`: `ε₂₄·V`, or
    /// half the least denormal number. Both times `|N|`.
    ///
    /// *`f64`.* `MᵀN` carries 4 roundings, `M·c + τ − eye` 5, `N` times that 4, and what sides are made of 3: of all that
    /// sums up to `|N|·(P + |eye|)` and to the offset, so `32·ε₅₃` of both is more. What `N` and the rays carry is that of
    /// [`BoxCulling::new`].
    ///
    /// *`f32`.* As in [`BoxCulling::new`]: `6.5·ε₂₄` of `|MᵀN|·H` and of the offset at `c`; what underflows is less than
    /// the smallest normal number, times the extents.
    ///
    /// The middle and the half are rounded, too: `H` is made larger by more than that.
    pub(crate) fn new(
        frustum: &TileFrustum,
        placement: &'a Placement,
        bounds: &Bounds,
    ) -> Option<InstanceFrustum<'a>> {
        let template = frustum.template;
        let world = &template.boxes;
        let eye = DVec3::from_array(template.eye);
        let placed = PlacedBounds::new(placement, bounds, eye);
        let functions = WorldFunctions::new(frustum, &placed, eye);
        let WorldFunctions { along, at, .. } = &functions;

        let sides_error = functions.sides_error(frustum, &placed);
        if functions.miss_box(frustum, &placed, sides_error) {
            return None;
        }
        let t = at[0] - world.t_at_origin;
        let t_error = placed.error(functions.rows[0].abs(), t.abs() + at[0].abs(), world.t_exact);
        let lowered = t - f64::from(t_error);
        let least_t = upward(2.0 * f64::from(t_error) + world.t_at_origin);
        let seen = functions.seen(frustum, &placed, [t_error, sides_error].map(f64::from))?;
        let stretch = upward((placed.absolute * DVec3::ONE).max_element() * (1.0 + 1e-6));
        let slack = upward(2.0 * placed.rounding.max_element());
        let size = upward(2.0 * placed.half.max_element());
        Some(InstanceFrustum {
            // It has no name yet.
            place: PlacedBy { placement, first_name: 0 },
            boxes: BoxCulling {
                origin: placed.middle.to_array(),
                t: WorldAffine::new(along[0], lowered),
                least_t: -least_t.next_up(),
                sides_error,
                t_error,
                ..*world
            },
            places: Places {
                across: WorldAffine::new(along[1], at[1]),
                down: WorldAffine::new(along[2], at[2]),
                half: narrowed(template.half),
                beside: upward(template.errors.wide - template.half),
                key_error: upward(template.errors.t + 8.0 * EPS53),
                parallel: template.parallel,
            },
            vertices: PlacedVertices::new(frustum, &functions, [t_error, sides_error]),
            stretch,
            slack,
            seen,
            near: narrowed(lowered - along[0].abs().dot(placed.half)).next_down(),
            size: size * stretch + slack,
        })
    }

    /// Finds the boxes of a node of the mesh that a ray of the tile may meet before `farthest`, and where in the tile.
    #[inline(always)]
    pub(crate) fn test<C: Context>(
        &self,
        context: &C,
        node: &Node,
        farthest: f32,
    ) -> (BoxHits, BoxPlaces) {
        let (simd, culling) = (context.simd(), &self.boxes);
        let boxes = culling.boxes_of(simd, node);
        let (near, far) = (culling.t.extreme(&boxes, false), culling.t.extreme(&boxes, true));
        let beyond = far.simd_lt(f32x16::splat(simd, culling.least_t))
            | near.simd_gt(f32x16::splat(simd, farthest));
        let Seen { missed, place, key } = self.seen_at(context, &boxes, [near, far]);
        let size = longest_side(simd, node) * self.stretch + self.slack;
        (
            BoxHits::new(node, beyond | missed, near, size),
            BoxPlaces { place: place.to_array(), key: key.to_array() },
        )
    }

    /// The projection of the mesh's vertices onto the tile, for a leaf in which no `t` is less than `near`, as computed
    /// for its box in the mesh, or for that of the instance.
    ///
    /// It is good for all of the mesh where that is seen small, as meshes are that are there very often. Then vertices need
    /// not be placed in the world to know which triangles miss all samples.
    ///
    /// # The errors, rounding by rounding
    ///
    /// `x` is a column times `t`, and `e_x` and `e_t` are what the functions of the mesh may be off by at a vertex:
    /// [`InstanceFrustum::new`] derives the error of a side, which is at least `e_x` and `wide` times `e_t`. Columns up to
    /// `wide + 3` are off by `(e_x − (x/t)·e_t)/t̂`, that is by less than the error of a side and `3·e_t`, over a `t̂` that is
    /// not larger than any that is computed in the leaf. For `near` is less than the exact `t` of all, but for the error
    /// of `t` in the world, and the computed one is off by that in the mesh. The roundings that follow are those of
    /// [`LocalErrors::new`], and farther columns are taken for farther ones, as there. Rays are off by what
    /// [`MapErrors::wide`] is more than half of a tile.
    ///
    /// [`LocalErrors::new`]: crate::fast::local_errors::LocalErrors::new
    /// [`MapErrors::wide`]: crate::fast::camera_map::MapErrors::wide
    #[inline(always)]
    pub(super) fn projection(&self, near: f32) -> LocalProjection {
        let PlacedVertices { t, from_near, error, rounding } = self.vertices;
        let near = narrowed(f64::from(near) + from_near).next_down();
        let near = if self.places.parallel { 1.0 } else { near };
        LocalProjection {
            vertex: self.boxes.origin,
            map: [t, self.places.across, self.places.down],
            error: error * reciprocal(near) * (1.0 + 16.0 * EPS24) + rounding,
            key_error: f32::INFINITY,
            extent: 0.0,
        }
    }

    /// Where in the tile boxes are seen. A mesh that is there very often is mostly seen from far away, where most leaves are
    /// smaller than a sample and lie between the rows or the columns of samples.
    ///
    /// Columns times `t` are off by no more than a side, and `t` lies between its two ends, which are
    /// moved by their error already: see [`InstanceFrustum::new`]. So a column lies between the quotients
    /// of their ends. Sums, reciprocal and product are rounded by `5·ε₂₄` of the column, the last sum by `ε₂₄` of that
    /// and half a tile; `16·ε₂₄` is more. A point on a ray is off by what [`MapErrors::wide`] is more than half of a tile.
    ///
    /// Of a box that reaches behind the eye only `t` is known. The key of a nearest point is that of [`KeyScale::farthest`],
    /// the other way round: a sum, a quotient, a factor and its product are rounded, so that `8·ε₂₄` is more than all.
    ///
    /// [`KeyScale::farthest`]: crate::fast::depth::KeyScale::farthest
    ///
    /// [`MapErrors::wide`]: crate::fast::camera_map::MapErrors::wide
    #[inline(always)]
    fn seen_at<C: Context>(
        &self,
        context: &C,
        boxes: &Sides<C::Simd>,
        [near, far]: [f32x16<C::Simd>; 2],
    ) -> Seen<C::Simd> {
        let simd = context.simd();
        let splat = |value: f32| f32x16::splat(simd, value);
        let (one, zero) = (splat(1.0), splat(0.0));
        let (culling, places) = (&self.boxes, &self.places);
        let at_origin = narrowed(culling.t_at_origin);
        let nearest = near + at_origin.next_down();
        let [first_t, last_t] = if places.parallel {
            [one; 2]
        } else {
            let last = upward(2.0 * f64::from(culling.t_error)).next_up();
            [nearest, far + last + at_origin.next_up()]
        };
        let [by_first, by_last] = [one / first_t, one / last_t];
        let key = if places.parallel {
            let key = splat(places.key_error) - nearest;
            key + key.abs() * (8.0 * EPS24)
        } else {
            by_first * (1.0 + 8.0 * EPS24 + places.key_error)
        };
        let error = splat(if C::has(Planted::ShrunkBox) { 0.0 } else { culling.sides_error });
        let beside = places.beside + 16.0 * EPS24 * (places.half + 1.0);
        let [across, down] = each!(function in [&places.across, &places.down] => {
            let low = function.extreme(boxes, false) - error;
            let high = function.extreme(boxes, true) + error;
            let low = (low * by_first).min(low * by_last);
            let high = (high * by_first).max(high * by_last);
            let first = low - low.abs() * (16.0 * EPS24) + (places.half - beside);
            let last = high + high.abs() * (16.0 * EPS24) + (places.half + beside);
            [first.ceil().max(zero), last.floor().min(splat(2.0 * places.half))]
        });
        let nowhere = across[1].simd_lt(across[0]) | down[1].simd_lt(down[0]);
        let ends = |[first, last]: [f32x16<C::Simd>; 2]| first + last * TilePlace::LAST;
        let place = ends(down) + ends(across) * TilePlace::COLUMN;
        let is_in_front = first_t.simd_gt(zero);
        // NaN, from numbers that overflow, says nothing.
        let is_known = is_in_front & place.simd_ge(zero);
        Seen {
            missed: is_in_front & nowhere,
            key,
            place: is_known.select(place, splat(TilePlace::WHOLE_TILE)).to_int(),
        }
    }
}

/// Where the boxes of a node are seen in a tile.
struct Seen<S: Simd> {
    /// Those that no ray meets.
    missed: mask32x16<S>,
    /// The places of the others: see [`TilePlace::from_whole_number`].
    place: u32x16<S>,
    /// No point of theirs has a greater depth key.
    key: f32x16<S>,
}

/// Where the boxes of a node are seen in a tile, and the depth keys of their nearest points: see [`Seen`].
pub(crate) struct BoxPlaces {
    pub(super) place: [u32; WIDTH],
    pub(super) key: [f32; WIDTH],
}

impl BoxPlaces {
    /// Nothing is known.
    pub(super) const ANYWHERE: BoxPlaces =
        BoxPlaces { place: [TilePlace::WHOLE; WIDTH], key: [f32::INFINITY; WIDTH] };
}

/// The box of a mesh where an instance puts it, with what its vertices are off by: see [`InstanceFrustum::new`].
struct PlacedBounds {
    /// The columns of the map, and their magnitudes.
    columns: DMat3,
    absolute: DMat3,
    /// The middle of the mesh's box, which the map puts at `center`; half of the box, which it makes `extent`.
    middle: Vec3,
    half: DVec3,
    center: DVec3,
    extent: DVec3,
    /// What a vertex may be off by, and with it what a function's argument may be.
    rounding: DVec3,
    uncertain: DVec3,
}

impl PlacedBounds {
    fn new(placement: &Placement, bounds: &Bounds, eye: DVec3) -> Self {
        let (m, by) = parts(placement);
        let columns = DMat3 { x_axis: m[0], y_axis: m[1], z_axis: m[2] };
        let absolute = DMat3 { x_axis: m[0].abs(), y_axis: m[1].abs(), z_axis: m[2].abs() };
        let (Bounds { low, high }, middle) = (bounds, bounds.middle());
        let c = middle.as_dvec3();
        let half = (high.as_dvec3() - c).max(c - low.as_dvec3()) * (1.0 + 1e-6);
        let most = low.abs().max(high.abs()).as_dvec3();
        let center = columns * c + by;
        let extent = absolute * half;
        let sums = absolute * most + by.abs();
        let farthest = center.abs() + extent;
        let rounding = f64::from(EPS24) * 1.001 * farthest
            + 8.0 * (-53f64).exp2() * sums
            + DVec3::splat((-149f64).exp2());
        let uncertain = rounding + (-48f64).exp2() * (sums + eye.abs());
        PlacedBounds { columns, absolute, middle, half, center, extent, rounding, uncertain }
    }

    /// What a function may be off by, whose factors in the world have these magnitudes, with an offset that sums up to so
    /// much, of which `exact` is known.
    fn error(&self, row: DVec3, offset: f64, exact: f64) -> f32 {
        let PlacedBounds { absolute, half, extent, uncertain, .. } = self;
        let size = row.dot(*extent) + offset;
        let floor = f64::from(f32::MIN_POSITIVE) * (8.0 + half.element_sum() + row.element_sum());
        let largest = size.max(row.dot(*absolute * DVec3::ONE)).max(half.max_element());
        if largest < LARGEST {
            let in_f64 = (-48f64).exp2() * offset + exact;
            upward(6.5 * f64::from(EPS24) * size + row.dot(*uncertain) + in_f64 + floor)
        } else {
            f32::INFINITY
        }
    }
}

/// `t`, columns and rows as functions of a tile.
struct WorldFunctions {
    /// Their factors in the world.
    rows: [DVec3; 3],
    /// Their factors in the mesh, and their values at the middle of its box.
    along: [DVec3; 3],
    at: [f64; 3],
}

impl WorldFunctions {
    fn new(frustum: &TileFrustum, placed: &PlacedBounds, eye: DVec3) -> Self {
        let DMat3 { x_axis, y_axis, z_axis } = placed.columns;
        let from_eye = placed.center - eye;
        let rows = frustum.rows.map(DVec3::from_array);
        let along = rows.map(|row| DVec3::new(row.dot(x_axis), row.dot(y_axis), row.dot(z_axis)));
        let at = [0, 1, 2].map(|k| rows[k].dot(from_eye) + frustum.shift[k]);
        WorldFunctions { rows, along, at }
    }

    /// Half of a tile and what rays may be off, as a function: of `t` where the camera is perspective.
    fn beside(&self, frustum: &TileFrustum) -> (DVec3, f64) {
        let wide = frustum.template.errors.wide;
        if frustum.template.parallel {
            (DVec3::ZERO, wide)
        } else {
            (self.along[0] * wide, self.at[0] * wide)
        }
    }

    /// The sides of the frustum: positive inside.
    fn sides(&self, frustum: &TileFrustum) -> [(DVec3, f64); 4] {
        let WorldFunctions { along, at, .. } = self;
        let (beside, at_side) = self.beside(frustum);
        [
            (beside - along[1], at_side - at[1]),
            (beside + along[1], at_side + at[1]),
            (beside - along[2], at_side - at[2]),
            (beside + along[2], at_side + at[2]),
        ]
    }

    /// Whether the box is certainly beside the frustum.
    fn miss_box(&self, frustum: &TileFrustum, placed: &PlacedBounds, sides_error: f32) -> bool {
        let is_beyond = |(normal, at): &(DVec3, f64)| {
            normal.abs().dot(placed.half) + at < -f64::from(sides_error)
        };
        self.sides(frustum).iter().any(is_beyond)
    }

    /// What sides may be off by.
    fn sides_error(&self, frustum: &TileFrustum, placed: &PlacedBounds) -> f32 {
        let WorldFunctions { rows, at, .. } = self;
        let template = frustum.template;
        let wide = template.errors.wide;
        let (_, at_side) = self.beside(frustum);
        let of_side = if template.parallel { DVec3::ZERO } else { rows[0].abs() * wide };
        let size = of_side + rows[1].abs().max(rows[2].abs());
        let largest = at_side.abs() + wide + at[1].abs().max(at[2].abs());
        placed.error(size, largest, template.boxes.sides_exact)
    }

    /// The rows and columns of the tile at which the box may be seen, from the errors of `t` and of sides.
    ///
    /// As in [`InstanceFrustum::seen_at`], but in `f64`, whose roundings are far less than 2⁻⁴⁰ of the place.
    fn seen(
        &self,
        frustum: &TileFrustum,
        placed: &PlacedBounds,
        [t_error, sides_error]: [f64; 2],
    ) -> Option<[[usize; 2]; 2]> {
        let WorldFunctions { along, at, .. } = self;
        let (template, half) = (frustum.template, placed.half);
        let last = template.side - 1;
        let t_ends = [-1.0, 1.0].map(|end| at[0] + end * (along[0].abs().dot(half) + t_error));
        let beside = template.errors.wide - template.half;
        let room = |place: f64| beside + (-40f64).exp2() * (place.abs() + template.half);
        let between = |axis: usize| {
            let spread = along[1 + axis].abs().dot(half) + sides_error;
            let [low, high] = [at[1 + axis] - spread, at[1 + axis] + spread];
            let [low, high] = if template.parallel {
                [low, high]
            } else if t_ends[0] > 0.0 {
                let [near, far] = t_ends;
                [(low / near).min(low / far), (high / near).max(high / far)]
            } else {
                return Some([0, last]);
            };
            let first = low + template.half - room(low);
            samples_between(first, high + template.half + room(high), last)
        };
        between(1).zip(between(0)).map(|(rows, columns)| [rows, columns])
    }
}

/// The first and the last of the whole numbers from 0 to `last` that lie between two places; NaN lets pass.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the conversion saturates, and makes 0 of NaN"
)]
fn samples_between(low: f64, high: f64, last: usize) -> Option<[usize; 2]> {
    let (first, end) = (low.ceil(), high.floor());
    if end < first || end < 0.0 || first > last as f64 {
        return None;
    }
    let end = if end.is_nan() { last } else { (end as usize).min(last) };
    Some([first as usize, end])
}

/// The columns of a map, and what it adds.
#[inline(always)]
fn parts(placement: &Placement) -> ([DVec3; 3], DVec3) {
    let [x, y, z] = placement.rows();
    let column = |k: usize| Vec3::new(x[k], y[k], z[k]).as_dvec3();
    ([column(0), column(1), column(2)], column(3))
}
