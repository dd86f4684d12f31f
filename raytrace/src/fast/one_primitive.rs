//! One primitive at a time, for what is set up in `f64`: planes, spheres, and triangles that eight at a time are not
//! certain of. Ray by ray in `f64`, and by the judge if need be, for what the vector paths leave.

pub(super) mod flat;
pub(super) mod narrow;
#[cfg(test)]
mod tests;
pub(super) mod unbounded;

use super::answer::{Answer, Trust};
use super::bounds;
use super::camera_map::CameraMap;
use super::many_samples::{self, SetupArrays};
use super::search::tile_frustum::TileFrustum;
use super::sphere::blocks::SphereSetup;
use super::tile::{OpenFragment, TileBuffer, index};
use super::{plane, sphere, triangle};
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::engine::fault::Planted;
use bothways_common::engine::roundoff::Interval;
use bothways_common::observe::{Events, Question};
use bothways_common::raster::Sample;
use bothways_common::{Primitive, Ray, Sign};
use flat::FlatFunctions;
use narrow::narrow;
use std::cmp::Ordering;
use unbounded::Unbounded;

/// What rounded arithmetic says of a ray and a primitive; of a triangle, the signs of its edge functions, too.
pub(super) fn answer(
    ray: &Ray,
    primitive: &Primitive,
    trust: Trust,
) -> (Answer, [Option<Sign>; 3]) {
    match primitive {
        Primitive::Triangle(corners) => triangle::answer(ray, corners, trust),
        Primitive::Sphere { center, radius } => {
            (sphere::answer(ray, *center, *radius, trust), [None; 3])
        }
        Primitive::Plane { point, normal } => {
            (plane::answer(ray, *point, *normal, trust), [None; 3])
        }
    }
}

/// Where a ray meets a primitive that it is known to meet, as far as rounded arithmetic knows it.
pub(super) fn distance(ray: &Ray, primitive: &Primitive, trust: Trust) -> Option<Interval> {
    match primitive {
        // Its edges need not be asked.
        Primitive::Triangle(corners) => triangle::crossing(ray, corners, trust),
        Primitive::Sphere { .. } | Primitive::Plane { .. } => match answer(ray, primitive, trust).0
        {
            Answer::Hit(distance) | Answer::Open(distance) => Some(distance),
            Answer::Miss => None,
        },
    }
}

/// Tests what no box bounds at the samples of the tile.
#[inline(always)]
pub(super) fn draw_unbounded<C: Context>(
    context: &mut C,
    map: &CameraMap,
    frustum: &TileFrustum,
    unbounded: &Unbounded,
    tile: &mut TileBuffer,
) {
    if C::WATCHED || !tile.has_groups() {
        let all = unbounded.primitives.iter();
        all.for_each(|one| draw(&mut context.scalar(), map, frustum, (one.0, &one.1), tile));
        return tile.renew(context.simd());
    }
    let farthest = unbounded.farthest_key(context, frustum, tile.far);
    for group in 0..unbounded.groups() {
        let mut visible = unbounded.visible(context, frustum, group, farthest);
        while visible != 0 {
            let lane = (visible.trailing_zeros() & 7) as usize;
            visible &= visible - 1;
            let (index, functions) = &unbounded.planes[8 * group + lane];
            let (id, primitive) = &unbounded.primitives[*index];
            draw_flat(context, frustum, functions, (0, *id), tile);
            if tile.has_open() {
                settle(&mut context.scalar(), map, &[(*id, *primitive); 8], tile);
            }
            tile.renew(context.simd());
        }
    }
    for index in &unbounded.others {
        let (id, primitive) = &unbounded.primitives[*index];
        draw_round(context, map, frustum, (*id, primitive), tile);
    }
}

/// Tests a sphere at the samples of the tile, sixteen at a time where rays are not traced alone.
#[inline(always)]
pub(super) fn draw_round<C: Context>(
    context: &mut C,
    map: &CameraMap,
    frustum: &TileFrustum,
    (id, primitive): (u32, &Primitive),
    tile: &mut TileBuffer,
) {
    let setup = match primitive {
        Primitive::Sphere { center, radius } if !C::WATCHED && tile.has_groups() => {
            SphereSetup::new(map, frustum, (*center, *radius), Trust::new::<C::Fault>())
        }
        _ => None,
    };
    if let Some(setup) = setup {
        tile.executed.one_by_one += 1;
        setup.draw(context.simd(), frustum, id, tile);
        if tile.has_open() {
            settle(&mut context.scalar(), map, &[(id, *primitive); 8], tile);
        }
    } else {
        draw(&mut context.scalar(), map, frustum, (id, primitive), tile);
    }
    tile.renew(context.simd());
}

/// Tests a flat primitive at the samples of a tile, sixteen at a time. What is left open is left so in this `lane`.
#[inline(always)]
pub(super) fn draw_flat<C: Context>(
    context: &mut C,
    frustum: &TileFrustum,
    functions: &FlatFunctions,
    (lane, id): (usize, u32),
    tile: &mut TileBuffer,
) {
    tile.executed.one_by_one += 1;
    let trust = Trust::new::<C::Fault>();
    if let Some(setup) = narrow(functions, frustum, trust, tile.far) {
        let setup = SetupArrays::of_one(lane, &setup);
        many_samples::draw_one(context.simd(), frustum, &setup, (lane, id), tile);
    }
}

/// Tests a primitive at the samples of the tile that it may cover, one by one.
pub(super) fn draw<C: ScalarContext>(
    context: &mut C,
    map: &CameraMap,
    frustum: &TileFrustum,
    (id, primitive): (u32, &Primitive),
    tile: &mut TileBuffer,
) {
    let [rows, columns] = match primitive {
        Primitive::Sphere { center, radius } => bounds::of_sphere(frustum, *center, *radius),
        Primitive::Triangle(_) | Primitive::Plane { .. } => [[0, tile.side()]; 2],
    };
    let in_picture = |[start, end]: [usize; 2], count: usize| end.min(count).saturating_sub(start);
    let samples = in_picture(rows, tile.size[0]) * in_picture(columns, tile.size[1]);
    tile.executed.one_by_one += 1;
    tile.executed.single_samples += samples as u64;
    for row in rows[0]..rows[1] {
        for column in columns[0]..columns[1] {
            let at = index(row, column);
            if let Some(sample) = tile.sample(at) {
                context.sink().sample_tested(sample, tile.names.id(id));
                decide(context, map, at, (id, primitive), false, tile);
            }
        }
    }
}

/// Decides the fragments that eight triangles left open in the tile.
#[cold]
pub(super) fn settle<C: ScalarContext>(
    context: &mut C,
    map: &CameraMap,
    primitives: &[(u32, Primitive); 8],
    tile: &mut TileBuffer,
) {
    let open = tile.take_open();
    for &OpenFragment { index, lane, covered } in &open {
        let (id, primitive) = &primitives[usize::from(lane)];
        decide(context, map, usize::from(index), (*id, primitive), covered, tile);
    }
    tile.clear_open(open);
}

/// Tests one ray against one primitive, and keeps the nearer of it and the hit so far. `covered` says that the sample
/// is certainly covered, and that its edge signs were emitted already.
fn decide<C: ScalarContext>(
    context: &mut C,
    map: &CameraMap,
    at: usize,
    (id, primitive): (u32, &Primitive),
    covered: bool,
    tile: &mut TileBuffer,
) {
    let Some(sample) = tile.sample(at) else { return };
    let ray = map.grid.ray(sample.row, sample.column);
    let (answer, signs) = answer(&ray, primitive, Trust::new::<C::Fault>());
    let (Answer::Hit(distance) | Answer::Open(distance)) = answer else {
        context.sink().edge_signs(sample, tile.names.id(id), signs);
        return;
    };
    if covered {
        // Only the depth is open.
    } else if let Answer::Hit(_) = answer {
        context.sink().edge_signs(sample, tile.names.id(id), signs);
    } else {
        if tile.is_edge_on(id, primitive) {
            return;
        }
        context.sink().judged(sample, Question::Coverage);
        let coverage = map.view.judge().coverage(primitive, &ray);
        if let Some(edges) = coverage.edges {
            context.sink().edge_signs(sample, tile.names.id(id), edges.at_sample.map(Some));
        }
        if !coverage.covers || C::has(Planted::StrictComparison) {
            return;
        }
    }
    context.sink().fragment(sample, tile.names.id(id));
    let [low, high] = map.depth.keys(distance);
    let empty = tile.is_empty_at(at);
    let nearer = if empty || low > tile.high[at] {
        true
    } else if high < tile.low[at] {
        false
    } else {
        is_nearer(context, map, (sample, at), (id, primitive, distance), tile)
    };
    if !empty {
        let [id, stored] = [id, tile.ids[at]].map(|name| tile.names.id(name));
        context.sink().depth_test(sample, id, stored, nearer);
    }
    if nearer {
        tile.keep(at, id, [low, high]);
    }
}

/// Whether an incoming primitive is seen rather than the stored one: by `f64` if that is certain, or by the judge.
fn is_nearer<C: ScalarContext>(
    context: &mut C,
    map: &CameraMap,
    (sample, at): (Sample, usize),
    (id, incoming, distance): (u32, &Primitive, Interval),
    tile: &mut TileBuffer,
) -> bool {
    let stored_id = tile.ids[at];
    let stored = tile.names.primitive(&map.view, stored_id);
    let ray = map.grid.ray(sample.row, sample.column);
    let trust = Trust::new::<C::Fault>();
    if let (Answer::Hit(other) | Answer::Open(other), _) = answer(&ray, &stored, trust) {
        if distance.high < other.low {
            return true;
        }
        if distance.low > other.high {
            return false;
        }
    }
    if let (
        Primitive::Sphere { center, radius },
        Primitive::Sphere { center: other, radius: other_radius },
    ) = (*incoming, stored)
        && trust.is_sound()
        && let Some(order) = sphere::nearer([(center, radius), (other, other_radius)], &ray)
    {
        return order.is_lt();
    }
    context.sink().judged(sample, Question::Nearest);
    let (incoming, stored) = ((id, incoming), (stored_id, &stored));
    match tile.judge.compare(incoming, stored, &ray).decided {
        Ordering::Less => true,
        Ordering::Greater => false,
        Ordering::Equal if C::has(Planted::TiesToLast) => tile.names.precedes(stored_id, id),
        Ordering::Equal => tile.names.precedes(id, stored_id),
    }
}
