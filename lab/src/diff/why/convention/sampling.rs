//! The part of a pixel that is sampled.

/// The coordinate on the viewport of the `j`-th of `n` columns or rows: `((j + offset)/(n − fewer) − ½)` of the side, where `fewer`
/// is 1, 0 or −1.
///
/// A pinhole camera with a principal point `c` and pixel centres at `j + s` has `(j + s − c)/n`. With `s = 0`, which is the
/// integer grid, the middle is `c = (n − 1)/2`, and `c = n/2` is [`Corner`](Sampling::Corner); with `s = ½` it is
/// `c = n/2`, and `c = (n − 1)/2` is [`FarCorner`](Sampling::FarCorner). No picture tells these from each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sampling {
    /// `(j + ½)/n`: the middle of the pixel.
    #[default]
    Middle,
    /// `j/n`: the left or top edge of the pixel.
    Corner,
    /// `(j + 1)/n`: the right or bottom edge of the pixel.
    FarCorner,
    /// `j/(n − 1)`: the first and the last sample lie on the border of the viewport.
    BorderToBorder,
    /// `(j + ½)/(n − 1)`.
    OneFewer,
    /// `(j + ½)/(n + 1)`.
    OneMore,
    /// `(j − ½)/n`: the middle of the pixel before.
    PixelBefore,
    /// `(j + 3/2)/n`: the middle of the next pixel.
    PixelAfter,
}

impl Sampling {
    /// All ways of sampling, ours first.
    pub const ALL: [Sampling; 8] = [
        Sampling::Middle,
        Sampling::Corner,
        Sampling::FarCorner,
        Sampling::BorderToBorder,
        Sampling::OneFewer,
        Sampling::OneMore,
        Sampling::PixelBefore,
        Sampling::PixelAfter,
    ];

    /// Twice the offset, and the number by which the divisor is smaller than `n`.
    fn numbers(self) -> (i64, i64) {
        match self {
            Sampling::Middle => (1, 0),
            Sampling::Corner => (0, 0),
            Sampling::FarCorner => (2, 0),
            Sampling::BorderToBorder => (0, 1),
            Sampling::OneFewer => (1, 1),
            Sampling::OneMore => (1, -1),
            Sampling::PixelBefore => (-1, 0),
            Sampling::PixelAfter => (3, 0),
        }
    }

    /// Where the first sample lies, in halves of a pixel from the left or upper edge of the picture.
    #[expect(clippy::cast_precision_loss, reason = "small whole numbers")]
    pub fn twice_offset(self) -> f64 {
        self.numbers().0 as f64
    }

    /// Whether `n` columns or rows can be sampled in this way.
    pub fn is_possible(self, n: u32) -> bool {
        i64::from(n) > self.numbers().1
    }

    /// The coordinate of column or row `index` of `n` on a side of length 1, from −½ to ½. For [`Sampling::Middle`]
    /// it has the bits of the contract: `(2j + 1 − n)/(2n)`.
    #[expect(clippy::cast_precision_loss, reason = "whole numbers below 2^18")]
    pub fn coordinate(self, side: f64, index: u32, n: u32) -> f64 {
        let (twice_offset, fewer) = self.numbers();
        let divisor = i64::from(n) - fewer;
        let numerator = 2 * i64::from(index) + twice_offset - divisor;
        side * numerator as f64 / (2 * divisor) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::Camera;

    #[test]
    fn our_sampling_has_the_bits_of_the_camera() {
        let camera = Camera::canonical(3, 37);
        let x: Vec<f64> =
            (0..37).map(|j| Sampling::Middle.coordinate(camera.viewport()[0], j, 37)).collect();
        assert_eq!(x, camera.sample_grid(1).x());
    }

    #[test]
    fn the_ways_of_sampling_are_the_formulas_of_their_names() {
        let at = |sampling: Sampling| [0, 4].map(|j| sampling.coordinate(10.0, j, 5) + 5.0);
        let expected = [[1.0, 9.0], [0.0, 8.0], [2.0, 10.0], [0.0, 10.0], [1.25, 11.25]];
        for (sampling, expected) in Sampling::ALL.into_iter().zip(expected) {
            assert_eq!(at(sampling), expected, "{sampling:?}");
        }
        assert_eq!(at(Sampling::PixelBefore), [-1.0, 7.0]);
        assert_eq!(at(Sampling::PixelAfter), [3.0, 11.0]);
        assert!(!Sampling::BorderToBorder.is_possible(1));
    }

    #[test]
    fn a_principal_point_off_by_half_a_pixel_samples_corners() {
        for n in [1_u32, 4, 7, 640] {
            let (n_real, side) = (f64::from(n), 3.0);
            let [of_grid, of_centres] = [(n_real - 1.0) / 2.0, n_real / 2.0];
            for (sampling, centre, point) in [
                (Sampling::Middle, 0.0, of_grid),
                (Sampling::Corner, 0.0, of_centres),
                (Sampling::Middle, 0.5, of_centres),
                (Sampling::FarCorner, 0.5, of_grid),
            ] {
                for index in 0..n {
                    // All but the quotient is exact.
                    let expected =
                        side * (2.0 * (f64::from(index) + centre - point)) / (2.0 * n_real);
                    assert_eq!(sampling.coordinate(side, index, n), expected, "{sampling:?}");
                }
            }
        }
    }
}
