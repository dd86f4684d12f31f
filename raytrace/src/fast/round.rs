//! Spheres and planes, tested one ray at a time.

use super::rays::{Lens, Rays};
use super::tile::{Tile, index};
use bothways_common::Primitive;
use bothways_common::engine::fault::Fault;
use bothways_common::observe::EventSink;
use glam::DVec3;

/// Tests a primitive at the samples of the tile that it may cover.
pub(super) fn draw<O: EventSink + ?Sized, F: Fault>(
    rays: &Rays,
    lens: &Lens,
    id: u32,
    primitive: &Primitive,
    tile: &mut Tile,
    observer: &mut O,
) {
    let [rows, columns] = match primitive {
        Primitive::Sphere { center, radius } => region(lens, tile.side(), *center, *radius),
        _ => [[0, tile.side()]; 2],
    };
    for row in rows[0]..rows[1] {
        for column in columns[0]..columns[1] {
            let at = index(tile.side(), row, column);
            if let Some(sample) = tile.sample(at) {
                observer.sample_tested(sample, id);
                tile.decide::<O, F>(rays, at, (id, primitive), false, observer);
            }
        }
    }
}

/// The rows and columns of the tile that a sphere's box may cover; all, where a corner of it is not in
/// front of the eye.
///
/// A corner is trusted where `t ≥ 2¹⁴·e`: its column is then off by at most `2⁻¹⁴·(1 + |x|)`. The margin
/// of a hundredth, and as much of `x`, is larger than that, than the samples' errors and than those of the
/// sphere's box.
fn region(lens: &Lens, side: usize, center: DVec3, radius: f64) -> [[usize; 2]; 2] {
    let all = [[0, side]; 2];
    if !lens.kind.errors.small {
        return all;
    }
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for k in 0..8 {
        let sign = |axis: usize| if k >> axis & 1 == 1 { radius } else { -radius };
        let corner = center + DVec3::new(sign(0), sign(1), sign(2));
        // The bounds are made for what boxes hold; a sphere without one may be larger.
        if corner.abs().max_element() > 2.0 * lens.kind.errors.reach {
            return all;
        }
        let [t, x, y] = std::array::from_fn(|row| {
            DVec3::from_array(lens.rows[row]).dot(corner) + lens.shift[row]
        });
        let place = if lens.kind.parallel {
            [y, x]
        } else if t > 16384.0 * lens.kind.errors.corner {
            [y / t, x / t]
        } else {
            return all;
        };
        for axis in 0..2 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    if lens.kind.parallel && lens.kind.errors.corner * 16384.0 > 1.0 {
        return all;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before")]
    std::array::from_fn(|axis| {
        let margin = |x: f64| 0.01 + 0.01 * x.abs();
        #[expect(clippy::cast_precision_loss, reason = "at most 32")]
        let end = side as f64;
        let first = (low[axis] - margin(low[axis]) + lens.kind.half).ceil().clamp(0.0, end);
        let behind =
            (high[axis] + margin(high[axis]) + lens.kind.half + 1.0).floor().clamp(0.0, end);
        [first as usize, behind as usize]
    })
}
