//! Where a rule takes its samples, and the viewing ray through each, in `f64`.

use bothways_common::{Camera, Projection, Ray};
use glam::DVec3;

/// Where in its cell of the picture a sample lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SamplePoint {
    /// In the middle, as it should.
    Middle,
    /// At the upper left corner.
    Corner,
    /// Anywhere, by the seed.
    Jittered(u64),
}

/// The samples of a picture, and the rays through them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Samples<'a> {
    camera: &'a Camera,
    /// Rows and columns of samples in the whole image.
    size: [u32; 2],
    place: SamplePoint,
    /// Whether row 0 is the lowest.
    upside_down: bool,
    /// Whether all rays start at the eye.
    one_origin: bool,
}

impl<'a> Samples<'a> {
    pub(crate) fn new(camera: &'a Camera, samples: u32, place: SamplePoint) -> Samples<'a> {
        let size = camera.raster(samples).size();
        Samples { camera, size, place, upside_down: false, one_origin: false }
    }

    /// The same samples, with row 0 at the bottom.
    pub(crate) fn upside_down(self) -> Samples<'a> {
        Samples { upside_down: true, ..self }
    }

    /// The same samples, with the eye as the origin of all rays.
    pub(crate) fn with_one_origin(self) -> Samples<'a> {
        Samples { one_origin: true, ..self }
    }

    /// The camera.
    pub(crate) fn camera(&self) -> &'a Camera {
        self.camera
    }

    /// Rows and columns of samples in the whole image.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The viewing ray through a sample, relative to the eye.
    pub(crate) fn ray(&self, row: usize, column: usize) -> Ray {
        let [x, y] = self.on_viewport(row, column);
        let ray = self.camera.ray_through(x, y);
        match self.camera.projection() {
            Projection::Parallel if self.one_origin => Ray { origin: DVec3::ZERO, ..ray },
            _ => ray,
        }
    }

    /// `x` and `y` of a sample on the viewport.
    pub(crate) fn on_viewport(&self, row: usize, column: usize) -> [f64; 2] {
        let row = if self.upside_down { self.size[0] as usize - 1 - row } else { row };
        let [down, right] = self.place.offset(row, column);
        let [vw, vh] = self.camera.viewport();
        // In the middle, the formula of the contract to the last bit.
        let coordinate = |extent: f64, index: usize, offset: f64, count: u32| {
            let count = f64::from(count);
            extent * (2.0 * whole(index) + 2.0 * offset - count) / (2.0 * count)
        };
        let [height, width] = self.size;
        [coordinate(vw, column, right, width), -coordinate(vh, row, down, height)]
    }
}

impl SamplePoint {
    /// How far a sample lies below and to the right of the upper left corner of its cell, in cells.
    pub(crate) fn offset(self, row: usize, column: usize) -> [f64; 2] {
        match self {
            SamplePoint::Middle => [0.5; 2],
            SamplePoint::Corner => [0.0; 2],
            SamplePoint::Jittered(seed) => {
                let sample = (row as u64) << 32 | column as u64;
                let bits = mixed(mixed(seed) ^ sample);
                // 26 bits each: a sample on the viewport needs no more, and never reaches the next cell.
                let fraction = |bits: u64| f64::from((bits >> 38) as u32) / f64::from(1 << 26);
                [fraction(bits), fraction(bits << 26)]
            }
        }
    }
}

/// A row or column as a number; both are below 2¹⁶.
#[expect(clippy::cast_precision_loss, reason = "rows and columns are below 2^16")]
pub(crate) fn whole(index: usize) -> f64 {
    index as f64
}

/// Mixes the bits of a number so that each result bit depends on all of them, and different numbers have different
/// results: the finalizer of `SplitMix64` (Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators",
/// OOPSLA 2014).
fn mixed(number: u64) -> u64 {
    let mut bits = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_is_the_camera_s_own_sample() {
        let camera = Camera::canonical(5, 7);
        let (samples, grid) =
            (Samples::new(&camera, 2, SamplePoint::Middle), camera.sample_grid(2));
        for (row, column) in [(0, 0), (9, 13), (3, 8)] {
            assert_eq!(samples.ray(row, column), grid.ray(row, column));
            assert_eq!(samples.upside_down().ray(row, column), grid.ray(9 - row, column));
        }
    }

    #[test]
    fn a_corner_is_half_a_sample_up_and_left() {
        let camera = Camera::canonical(2, 4);
        let [x, y] = Samples::new(&camera, 1, SamplePoint::Corner).on_viewport(0, 0);
        assert_eq!([x, y], [-0.5, 0.5]);
    }

    #[test]
    fn jittered_samples_fill_their_cells_and_depend_on_the_seed() {
        let places =
            |seed| (0..4000).map(move |column| SamplePoint::Jittered(seed).offset(3, column));
        assert!(places(7).flatten().all(|offset| (0.0..1.0).contains(&offset)));
        let mean = |axis: usize| places(7).map(|offset| offset[axis]).sum::<f64>() / 4000.0;
        assert!((mean(0) - 0.5).abs() < 0.02 && (mean(1) - 0.5).abs() < 0.02);
        // Rows and columns of an offset are independent: their products have the product of the means.
        let product = places(7).map(|[down, right]| down * right).sum::<f64>() / 4000.0;
        assert!((product - 0.25).abs() < 0.02);
        assert!(places(7).eq(places(7)));
        assert!(places(7).zip(places(8)).all(|(one, other)| one != other));
    }
}
