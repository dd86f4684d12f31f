//! Writes the ids and distances of a tile into a frame.

use super::depth::{NOTHING, distances};
use super::picture::Picture;
use super::prepared::Prepared;
use super::tile::TileBuffer;
use super::vertices::Vertex;
use bothways_common::engine::cache::largest_cache;
use bothways_common::engine::names::Names;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdMask, Sixteen, f32x16, finish_streaming, prefetch_at, stream,
    u32x16,
};
use bothways_common::frame::{IdRows, NO_PRIMITIVE, NO_WIDE_PRIMITIVE, Tile, stored_t};
use bothways_common::raster::Sample;
use glam::Vec3;

/// Writes ids and distances into the frame, and leaves the buffer ready for another tile.
#[inline(always)]
pub(super) fn store<S: Simd>(simd: S, picture: &Picture, buffer: &mut TileBuffer, tile: Tile) {
    let Tile { region, ids, t } = tile;
    let mut names = Vec::new();
    let (names_of_rows, wide) = match ids {
        IdRows::Narrow(rows) => (rows, Vec::new()),
        IdRows::Wide(rows) => {
            names = vec![NO_PRIMITIVE; region.area()];
            (names.chunks_mut(region.columns.len()).collect(), rows)
        }
    };
    // Compiled once for each way of writing: chosen within the loop, it sometimes costs a sixth of a small frame.
    if picture.past_caches {
        store_rows::<true, _>(simd, picture, buffer, names_of_rows, t);
    } else {
        store_rows::<false, _>(simd, picture, buffer, names_of_rows, t);
    }
    for (names, ids) in names.chunks(region.columns.len()).zip(wide) {
        for (id, &name) in ids.iter_mut().zip(names) {
            *id = if name == NO_PRIMITIVE { NO_WIDE_PRIMITIVE } else { buffer.names.id(name) };
        }
    }
}

/// Writes names and distances, row by row.
#[inline(always)]
fn store_rows<const PAST_CACHES: bool, S: Simd>(
    simd: S,
    picture: &Picture,
    buffer: &mut TileBuffer,
    ids: Vec<&mut [u32]>,
    t: Vec<&mut [f32]>,
) {
    let mut rows = ids.into_iter().zip(t).enumerate().peekable();
    while let Some((row, (ids, t))) = rows.next() {
        let next = NextRow::new(picture, rows.peek().map(|(_, next)| next));
        let start = row * buffer.stride();
        let (whole_ids, rest_ids) = ids.as_chunks_mut::<16>();
        let (whole_t, rest_t) = t.as_chunks_mut::<16>();
        let whole = 16 * whole_ids.len();
        for (at, (ids, t)) in (0..).step_by(16).zip(whole_ids.iter_mut().zip(whole_t)) {
            next.prefetch(at);
            store_sixteen::<PAST_CACHES, _>(simd, picture, buffer, start + at, (ids, t));
        }
        if !rest_ids.is_empty() {
            let (mut ids, mut t) = ([NO_PRIMITIVE; 16], [f32::INFINITY; 16]);
            let last = (&mut ids, &mut t);
            // These numbers are read at once, so they do not go past the caches.
            store_sixteen::<false, _>(simd, picture, buffer, start + whole, last);
            rest_ids.copy_from_slice(&ids[..rest_ids.len()]);
            rest_t.copy_from_slice(&t[..rest_t.len()]);
        }
    }
    finish_streaming();
}

/// Writes a tile in which nothing is seen.
pub(super) fn store_nothing(picture: &Picture, tile: Tile) {
    let Tile { mut ids, t, .. } = tile;
    let ids = match ids {
        IdRows::Narrow(rows) => rows,
        IdRows::Wide(_) => {
            ids.clear();
            t.into_iter().for_each(|t| t.fill(f32::INFINITY));
            return;
        }
    };
    if picture.past_caches {
        store_rows_of_nothing::<true>(picture, ids, t);
    } else {
        store_rows_of_nothing::<false>(picture, ids, t);
    }
}

fn store_rows_of_nothing<const PAST_CACHES: bool>(
    picture: &Picture,
    ids: Vec<&mut [u32]>,
    t: Vec<&mut [f32]>,
) {
    let mut rows = ids.into_iter().zip(t).peekable();
    while let Some((ids, t)) = rows.next() {
        let next = NextRow::new(picture, rows.peek());
        let (whole_ids, rest_ids) = ids.as_chunks_mut::<16>();
        let (whole_t, rest_t) = t.as_chunks_mut::<16>();
        for (at, (ids, t)) in (0..).step_by(16).zip(whole_ids.iter_mut().zip(whole_t)) {
            next.prefetch(at);
            write::<PAST_CACHES, _>([NO_PRIMITIVE; 16], ids);
            write::<PAST_CACHES, _>([f32::INFINITY; 16], t);
        }
        rest_ids.fill(NO_PRIMITIVE);
        rest_t.fill(f32::INFINITY);
    }
    finish_streaming();
}

/// The row of a tile that is written next, where that goes through the caches. While one row is written, the machine is asked
/// for the next one, as it does not guess where in memory that lies.
struct NextRow<'a> {
    ids: &'a [u32],
    t: &'a [f32],
}

impl<'a> NextRow<'a> {
    #[inline(always)]
    fn new(picture: &Picture, row: Option<&'a (&mut [u32], &mut [f32])>) -> Self {
        match row {
            Some((ids, t)) if !picture.past_caches => NextRow { ids, t },
            _ => NextRow { ids: &[], t: &[] },
        }
    }

    /// Asks for the samples from an index on.
    #[inline(always)]
    fn prefetch(&self, at: usize) {
        prefetch_at(self.ids, at);
        prefetch_at(self.t, at);
    }
}

/// Writes sixteen samples of a row, from an index of the buffer on.
#[inline(always)]
fn store_sixteen<const PAST_CACHES: bool, S: Simd>(
    simd: S,
    picture: &Picture,
    buffer: &mut TileBuffer,
    from: usize,
    (ids, t): (&mut [u32; 16], &mut [f32; 16]),
) {
    let (stored_ids, stored_keys) = buffer.from(from);
    let (stored_ids, stored_keys) = (&stored_ids[..16], &mut stored_keys[..16]);
    let keys = f32x16::from_slice(simd, stored_keys);
    let nothing = keys.simd_eq(f32x16::splat(simd, NOTHING));
    if nothing.all_true() {
        write::<PAST_CACHES, _>([NO_PRIMITIVE; 16], ids);
        write::<PAST_CACHES, _>([f32::INFINITY; 16], t);
        return;
    }
    f32x16::splat(simd, NOTHING).store_slice(stored_keys);
    let seen = u32x16::from_slice(simd, stored_ids);
    let seen = nothing.select(u32x16::splat(simd, NO_PRIMITIVE), seen).to_array();
    let (distances, unsure) = distances(simd, &picture.keys, keys);
    let unsure = unsure & !nothing;
    let mut distances = nothing.select(f32x16::splat(simd, f32::INFINITY), distances).to_array();
    if unsure.any_true() {
        let first = buffer.sample(from);
        judge_distances(picture, &buffer.names, first, &seen, unsure.to_bitmask(), &mut distances);
    }
    write::<PAST_CACHES, _>(seen, ids);
    write::<PAST_CACHES, _>(distances, t);
}

/// Whether a frame of so many samples, and what is drawn into it, leave a quarter of the largest cache free. Then it stays there from
/// one frame to the next, or until it is shaded; otherwise it would only drive out what is drawn, and is better written past
/// the caches.
pub(super) fn stays_in_caches(prepared: &Prepared, samples: usize) -> bool {
    let vertices = prepared.first_vertices.last().copied().unwrap_or(0);
    let triangles = usize::try_from(prepared.primitives).unwrap_or(usize::MAX);
    let sizes = [
        (samples, size_of::<[u32; 2]>()),
        (vertices, size_of::<Vec3>() + size_of::<Vertex>()),
        (triangles, size_of::<[u32; 3]>()),
    ];
    let bytes = sizes
        .into_iter()
        .fold(0_usize, |bytes, (count, size)| bytes.saturating_add(count.saturating_mul(size)));
    bytes <= largest_cache() / 4 * 3
}

/// Writes sixteen numbers of a frame.
#[inline(always)]
fn write<const PAST_CACHES: bool, T: Copy + Sixteen>(numbers: [T; 16], to: &mut [T; 16]) {
    if PAST_CACHES {
        stream(numbers, to);
    } else {
        *to = numbers;
    }
}

/// Asks the judge for the distances of some lanes: samples of one row, from `first` on.
#[cold]
fn judge_distances(
    picture: &Picture,
    names: &Names,
    first: Sample,
    ids: &[u32; 16],
    lanes: u64,
    t: &mut [f32; 16],
) {
    let judge = picture.view.judge();
    for (lane, t) in t.iter_mut().enumerate().filter(|(lane, _)| lanes >> lane & 1 == 1) {
        let ray = picture.map.grid.ray(first.row, first.column + lane);
        let primitive = names.primitive(picture.view, ids[lane]);
        *t = stored_t(judge.distance(&primitive, &ray));
    }
}
