//! The distances of hits whose keys say too little: again in `f64`, eight triangles at a time, and by the judge.

use super::answer::{NARROW, Trust, narrow_middle};
use super::camera_map::CameraMap;
use super::one_primitive;
use super::tile::TileBuffer;
use bothways_common::engine::roundoff::EPS53;
use bothways_common::engine::simd::{
    Simd, SimdBase, SimdMask, best_level, dispatch, f64x8, mask64x8,
};
use bothways_common::frame::stored_t;
use bothways_common::look::lanes::{DVec3x8, Lanes};
use bothways_common::raster::Sample;
use bothways_common::{Primitive, Ray};
use glam::DVec3;

/// Finds the distances of some lanes of the block of samples that begins at an index. It is a function of its own, with vectors
/// of its own: within the loops that write tiles, it would take their registers.
#[cold]
#[inline(never)]
pub(super) fn find_distances(
    map: &CameraMap,
    tile: &TileBuffer,
    from: usize,
    lanes: u64,
    ids: &[u32; 16],
    t: &mut [f32; 16],
) {
    /// Fewer are found one by one, as is what begins with another primitive: to gather them would take longer.
    const FEW: u32 = 4;
    let first = (lanes.trailing_zeros() & 15) as usize;
    // Beyond the picture there is nothing to look up.
    let is_triangle = tile.sample(from + first).is_some()
        && matches!(tile.names.primitive(&map.view, ids[first]), Primitive::Triangle(_));
    if lanes.count_ones() >= FEW && is_triangle {
        return dispatch!(best_level(), simd => find_in_lanes(simd, map, tile, from, (lanes, ids), t));
    }
    for lane in (0..16).filter(|lane| lanes >> lane & 1 == 1) {
        if let Some(Sample { row, column }) = tile.sample(from + lane) {
            let primitive = tile.names.primitive(&map.view, ids[lane]);
            t[lane] = distance(map, &map.grid.ray(row, column), &primitive);
        }
    }
}

#[inline(always)]
fn find_in_lanes<S: Simd>(
    simd: S,
    map: &CameraMap,
    tile: &TileBuffer,
    from: usize,
    (mut lanes, ids): (u64, &[u32; 16]),
    t: &mut [f32; 16],
) {
    let mut pairs = Pairs::default();
    while lanes != 0 {
        let lane = (lanes.trailing_zeros() & 15) as usize;
        lanes &= lanes - 1;
        let Some(Sample { row, column }) = tile.sample(from + lane) else { continue };
        let ray = map.grid.ray(row, column);
        match tile.names.primitive(&map.view, ids[lane]) {
            Primitive::Triangle(corners) => {
                pairs.add(lane, &ray, &corners);
                if pairs.count == 8 {
                    pairs.find(simd, map, t);
                }
            }
            primitive => t[lane] = distance(map, &ray, &primitive),
        }
    }
    if pairs.count > 0 {
        pairs.find(simd, map, t);
    }
}

/// The distance of one hit, as it is stored.
fn distance(map: &CameraMap, ray: &Ray, primitive: &Primitive) -> f32 {
    let rounded = one_primitive::distance(ray, primitive, Trust::Sound).and_then(narrow_middle);
    stored_t(rounded.unwrap_or_else(|| map.view.judge().distance(primitive, ray)))
}

/// Up to eight rays, each with the triangle that it hits.
#[derive(Default)]
struct Pairs {
    count: usize,
    lanes: [usize; 8],
    /// The rays' origins and directions, and the corners of the triangles, a row for each coordinate.
    vectors: [[[f64; 8]; 3]; 5],
}

impl Pairs {
    #[inline(always)]
    fn add(&mut self, lane: usize, ray: &Ray, [a, b, c]: &[DVec3; 3]) {
        let at = self.count & 7;
        self.lanes[at] = lane;
        for (rows, vector) in self.vectors.iter_mut().zip([&ray.origin, &ray.direction, a, b, c]) {
            [rows[0][at], rows[1][at], rows[2][at]] = vector.to_array();
        }
        self.count += 1;
    }

    #[inline(always)]
    fn vector<S: Simd>(&self, simd: S, which: usize) -> DVec3x8<S> {
        let [x, y, z] = &self.vectors[which];
        Lanes {
            x: f64x8::load_array_ref(simd, x),
            y: f64x8::load_array_ref(simd, y),
            z: f64x8::load_array_ref(simd, z),
        }
    }

    /// Finds their distances, and forgets them.
    #[inline(always)]
    fn find<S: Simd>(&mut self, simd: S, map: &CameraMap, t: &mut [f32; 16]) {
        let (distances, known) = self.distances(simd);
        let (distances, known) = (distances.to_array(), known.to_bitmask());
        for (at, &lane) in self.lanes.iter().enumerate().take(self.count) {
            t[lane] = if known >> at & 1 == 1 {
                stored_t(distances[at])
            } else {
                let [origin, direction, a, b, c] =
                    self.vectors.map(|[x, y, z]| DVec3::new(x[at], y[at], z[at]));
                let ray = Ray { origin, direction };
                distance(map, &ray, &Primitive::Triangle([a, b, c]))
            };
        }
        self.count = 0;
    }

    /// What [`narrow_middle`] makes of [`super::triangle::crossing`], bit for bit; and where that is something.
    #[inline(always)]
    fn distances<S: Simd>(&self, simd: S) -> (f64x8<S>, mask64x8<S>) {
        let splat = |value: f64| f64x8::splat(simd, value);
        let [origin, direction] = [self.vector(simd, 0), self.vector(simd, 1)];
        let [a, b, c] = [self.vector(simd, 2), self.vector(simd, 3), self.vector(simd, 4)];
        let (along_b, along_c, point) = (b - a, c - a, a - origin);
        let normal = along_b.cross(along_c);
        let permanent = permanent(along_b, along_c);
        let (p, q) = (normal.dot(point), normal.dot(direction));
        let least = splat(f64::MIN_POSITIVE);
        let p_error = splat(9.0 * EPS53) * permanent.dot(magnitudes(point)) + least;
        let q_error = splat(8.0 * EPS53) * permanent.dot(magnitudes(direction)) + least;
        let room = q.abs() - q_error;
        let t = p / q;
        let error = (p_error + t.abs() * q_error) / room + splat(2.0 * EPS53) * t.abs();
        // Once by the crossing, once by `distance_around`.
        let error = error * splat(1.0 + 8.0 * EPS53) * splat(1.0 + 8.0 * EPS53);
        let (low, high) = (t - error, t + error);
        let middle = splat(0.5) * (low + high);
        let known = room.simd_gt(splat(0.0))
            & low.simd_le(high)
            & middle.abs().simd_lt(splat(f64::INFINITY))
            & (high - low).simd_le(splat(NARROW) * middle);
        (middle, known)
    }
}

#[inline(always)]
fn magnitudes<S: Simd>(vector: DVec3x8<S>) -> DVec3x8<S> {
    Lanes { x: vector.x.abs(), y: vector.y.abs(), z: vector.z.abs() }
}

/// [`bothways_common::engine::roundoff::cross_permanent`] of eight pairs.
#[inline(always)]
fn permanent<S: Simd>(p: DVec3x8<S>, q: DVec3x8<S>) -> DVec3x8<S> {
    let (p, q) = (magnitudes(p), magnitudes(q));
    Lanes { x: p.y * q.z + p.z * q.y, y: p.z * q.x + p.x * q.z, z: p.x * q.y + p.y * q.x }
}

#[cfg(test)]
mod tests {
    use super::super::triangle;
    use super::*;
    use bothways_common::engine::simd::levels;

    #[test]
    fn eight_at_a_time_are_as_one_by_one() {
        let random = &mut fastrand::Rng::with_seed(5);
        let mut known_in_all = 0;
        for _ in 0..2000 {
            let scale = 10f64.powi(random.i32(-6..6));
            let mut vector =
                |size: f64| DVec3::from_array([0; 3].map(|_| size * (random.f64() - 0.5)));
            let mut pairs = Pairs::default();
            let mut all = Vec::new();
            for lane in 0..8 {
                let ray = Ray { origin: vector(1e-3), direction: vector(2.0) };
                let a = vector(100.0);
                // Some are thin, and some have no area at all.
                let (b, c) = (a + vector(scale), a + vector(if lane % 3 == 0 { 0.0 } else { 1.0 }));
                pairs.add(lane, &ray, &[a, b, c]);
                all.push((ray, [a, b, c]));
            }
            for level in levels() {
                let (distances, known) = dispatch!(level, simd => {
                    let (distances, known) = pairs.distances(simd);
                    (distances.to_array(), known.to_bitmask())
                });
                for (at, (ray, corners)) in all.iter().enumerate() {
                    let expected =
                        triangle::crossing(ray, corners, Trust::Sound).and_then(narrow_middle);
                    let found = (known >> at & 1 == 1).then_some(distances[at]);
                    assert_eq!(
                        found.map(f64::to_bits),
                        expected.map(f64::to_bits),
                        "{ray:?} {corners:?}"
                    );
                    known_in_all += usize::from(found.is_some());
                }
            }
        }
        assert!(known_in_all > 1000, "{known_in_all}");
    }
}
