//! Eight triangles against the samples of a tile.
//!
//! Over few samples: eight triangles at a time, each at one of its samples. Over more: one triangle at a
//! time, first at sixteen blocks at once, then at the sixteen samples of each block that is left. Triangles whose facing
//! is doubtful, because they are nearly edge-on or huge, are set up alone for that.

use super::aligned::TIE;
use super::answer::Trust;
use super::camera_map::CameraMap;
use super::few_samples;
use super::fragments::Fragments;
use super::many_samples::{self, FlatSetup, SetupArrays};
use super::one_primitive::flat::FlatFunctions;
use super::one_primitive::{self, narrow::narrow};
use super::search::tile_frustum::TileFrustum;
use super::setup::{Setup, TrianglePacket};
use super::size_class::{FEW, SizeClass, VERY_FEW};
use super::tile::TileBuffer;
use bothways_common::Sign;
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::engine::fault::Fault;
use bothways_common::engine::simd::{Simd, SimdBase, SimdMask, f32x8};
use bothways_common::observe::Events;

/// Tests those of eight triangles that are `used` at the samples of the tile. Returns the size class of the largest
/// that was drawn.
#[inline(always)]
pub(super) fn draw<C: Context>(
    context: &mut C,
    map: &CameraMap,
    frustum: &TileFrustum,
    (eight, used): (&TrianglePacket, u64),
    (fragments, tile): (&mut Fragments, &mut TileBuffer),
) -> SizeClass {
    let simd = context.simd();
    let setup = Setup::new(context, frustum, eight, used, tile.far);
    if C::WATCHED {
        emit_edge_signs(context, &setup, eight, used, tile);
    }
    let alive = setup.alive.to_bitmask();
    if alive == 0 {
        return SizeClass::Few;
    }
    let doubtful = alive & setup.doubtful.to_bitmask();
    let width = setup.columns[1] - setup.columns[0] + 1.0;
    let height = setup.rows[1] - setup.rows[0] + 1.0;
    let samples = width * height;
    let few = samples.simd_le(f32x8::splat(simd, FEW)).to_bitmask() & alive & !doubtful;
    let mut arrays = SetupArrays::new(&setup);
    if few != 0 {
        few_samples::draw(context, frustum, &setup, (eight, few), samples, (fragments, tile));
    }
    let mut many = alive & !few;
    let very_few = samples.simd_le(f32x8::splat(simd, VERY_FEW)).to_bitmask();
    let class = match (many & !doubtful, few & !very_few) {
        (0, 0) => SizeClass::VeryFew,
        (0, _) => SizeClass::Few,
        _ => SizeClass::Many,
    };
    if many & doubtful != 0 {
        many &=
            !set_up_alone::<C::Fault>(map, frustum, (eight, many & doubtful), &mut arrays, tile);
    }
    // The tile of a ray alone, which observers watch, has no groups of blocks.
    while !C::WATCHED && many != 0 {
        let lane = (many.trailing_zeros() & 7) as usize;
        many &= many - 1;
        many_samples::draw(simd, frustum, &arrays, (lane, eight.ids[lane]), tile);
    }
    if tile.has_open() {
        settle_open(context, map, eight, tile);
    }
    tile.renew(simd);
    class
}

/// Sets up those triangles, each alone, of which eight at a time are not certain. Returns those that are not to be drawn:
/// they cannot be seen in the tile, or are left open at all of its samples.
#[cold]
#[inline(never)]
fn set_up_alone<F: Fault>(
    map: &CameraMap,
    frustum: &TileFrustum,
    (eight, mut doubtful): (&TrianglePacket, u64),
    arrays: &mut SetupArrays,
    tile: &mut TileBuffer,
) -> u64 {
    let mut done = 0;
    while doubtful != 0 {
        let lane = (doubtful.trailing_zeros() & 7) as usize;
        doubtful &= doubtful - 1;
        match one_alone::<F>(map, frustum, (eight, lane), tile) {
            Some(setup) => arrays.replace(lane, &setup),
            None => done |= 1 << lane,
        }
    }
    done
}

fn one_alone<F: Fault>(
    map: &CameraMap,
    frustum: &TileFrustum,
    (eight, lane): (&TrianglePacket, usize),
    tile: &mut TileBuffer,
) -> Option<FlatSetup> {
    let id = eight.ids[lane];
    let primitive = || eight.primitive(&map.view, lane);
    if tile.has_groups() {
        tile.executed.one_by_one += 1;
        let functions = tile.flats.get(id, || FlatFunctions::new(map, &primitive()));
        if let Some(functions) = functions {
            return narrow(functions, frustum, Trust::new::<F>(), tile.far);
        }
    }
    if !tile.is_edge_on(id, &primitive()) {
        (0..tile.blocks() * 16).for_each(|sample| tile.leave_open(sample, lane, false));
    }
    None
}

/// Decides in `f64`, or by the judge, what the vector paths left open.
#[inline(always)]
fn settle_open<C: Context>(
    context: &mut C,
    map: &CameraMap,
    eight: &TrianglePacket,
    tile: &mut TileBuffer,
) {
    let primitives =
        std::array::from_fn(|lane| (eight.ids[lane], eight.primitive(&map.view, lane)));
    one_primitive::settle(&mut context.scalar(), map, &primitives, tile);
}

/// Emits the signs of edge functions at the only sample of a tile, as far as they are certain.
#[cold]
fn emit_edge_signs<S: Simd>(
    context: &mut impl ScalarContext,
    setup: &Setup<S>,
    eight: &TrianglePacket,
    used: u64,
    tile: &TileBuffer,
) {
    let sink = context.sink();
    if sink.counts().is_some() {
        return;
    }
    let Some(sample) = tile.sample(0) else { return };
    let values = setup.edges.map(|edge| edge.at_middle.to_array());
    let (error, facing) = (setup.error.to_array(), setup.facing.to_array());
    let doubtful = setup.doubtful.to_bitmask();
    for lane in (0..8).filter(|lane| used >> lane & 1 == 1) {
        let edges = values.map(|values| values[lane]);
        let out = edges.iter().any(|edge| *edge < -error[lane]);
        let inside = edges.iter().all(|edge| *edge > error[lane]);
        if doubtful >> lane & 1 == 0 && (out || inside) {
            let sign = |edge: f32| {
                let on_edge = error[lane] == 0.0 && edge.abs() == TIE;
                let sign = if on_edge { 0.0 } else { f64::from(facing[lane] * edge) };
                (edge.abs() > error[lane]).then(|| Sign::of(sign))
            };
            let id = tile.names.id(eight.ids[lane]);
            sink.edge_signs(sample, id, edges.map(sign));
        }
    }
}
