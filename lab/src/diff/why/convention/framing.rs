//! The size and the place of the whole picture in its image.

use std::ops::Range;

/// How a picture lies in its image: it is stretched about the middle of the image, and then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framing {
    /// How many times as wide and as high everything is.
    pub scale: [f64; 2],
    /// By how many pixels everything lies too far to the right and too far down.
    pub shift: [f64; 2],
    /// Whether nothing is seen around it, where the scene goes on.
    pub is_alone: bool,
    /// What tells it.
    pub evidence: Evidence,
}

/// What tells a framing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Evidence {
    /// The places of primitives.
    #[default]
    Primitives,
    /// The contour of a mask alone: a scene of another size or in another place may have the same.
    Contour,
    /// Distances, which from another eye would be others.
    Distances,
}

impl Default for Framing {
    fn default() -> Self {
        Framing { scale: [1.0; 2], shift: [0.0; 2], is_alone: false, evidence: Evidence::default() }
    }
}

impl Framing {
    /// This framing, and another one of the picture that it makes.
    pub(in crate::diff::why) fn then(self, next: Framing) -> Framing {
        let scale = [0, 1].map(|axis| self.scale[axis] * next.scale[axis]);
        let shift = [0, 1].map(|axis| self.shift[axis] * next.scale[axis] + next.shift[axis]);
        Framing { scale, shift, is_alone: self.is_alone || next.is_alone, ..self }
    }

    /// Whether the size alone or the place alone is another.
    pub(in crate::diff::why) fn is_of_one_kind(self) -> bool {
        (self.scale == [1.0; 2]) != (self.shift == [0.0; 2])
    }

    /// The same with a simple scale, where one is near: 1, or one for both sides.
    pub(in crate::diff::why) fn with_simple_scale(self) -> Framing {
        let is_near = |one: f64, other: f64| (one - other).abs() < 5e-3;
        let [x, y] = self.scale.map(|scale| if is_near(scale, 1.0) { 1.0 } else { scale });
        let both = f64::midpoint(x, y);
        let scale = if is_near(x, y) && x != 1.0 && y != 1.0 { [both; 2] } else { [x, y] };
        Framing { scale, ..self }
    }

    /// The same with whole and half pixels, where they are near.
    pub(in crate::diff::why) fn with_simple_shift(self) -> Framing {
        let shift = self.shift.map(|shift| {
            let halves = (2.0 * shift).round() / 2.0;
            if (shift - halves).abs() < 0.1 { halves } else { shift }
        });
        Framing { shift, ..self }
    }

    /// Where the point that our picture shows `at` pixels from the middle of its image lies in the scene's own picture.
    pub(in crate::diff::why) fn source(self, axis: usize, at: f64) -> f64 {
        (at - self.shift[axis]) / self.scale[axis]
    }

    /// Which of so many columns (axis 0) or rows (axis 1) show a part of the scene's own picture.
    pub(in crate::diff::why) fn own_lines(self, axis: usize, count: usize) -> Range<usize> {
        #[expect(clippy::cast_precision_loss, reason = "at most 2^16")]
        let shows = |index: &usize| {
            let half = count as f64 / 2.0;
            self.source(axis, *index as f64 + 0.5 - half).abs() < half
        };
        let first = (0..count).find(shows).unwrap_or(0);
        first..(first..count).rfind(shows).map_or(first, |last| last + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_framings_are_one() {
        let first =
            Framing { scale: [2.0, 1.0], shift: [3.0, -1.0], is_alone: true, ..Framing::default() };
        let second = Framing { scale: [0.5, 4.0], shift: [1.0, 2.0], ..Framing::default() };
        let both = first.then(second);
        assert_eq!(both, Framing { scale: [1.0, 4.0], shift: [2.5, -2.0], ..first });
        for axis in 0..2 {
            let in_two = first.source(axis, second.source(axis, 7.0));
            assert_eq!(both.source(axis, 7.0), in_two);
        }
    }

    #[test]
    fn numbers_near_simple_ones_are_simple() {
        let framing = |scale, shift| Framing { scale, shift, ..Framing::default() };
        let measured = framing([1.1502, 1.1499], [4.98, -2.51]);
        let [x, y] = measured.with_simple_scale().scale;
        assert!(x == y && (x - 1.15005).abs() < 1e-9);
        assert_eq!(measured.with_simple_shift().shift, [5.0, -2.5]);
        let moved = framing([1.0004, 0.9997], [0.3, 0.02]);
        let simple = moved.with_simple_scale().with_simple_shift();
        assert_eq!(simple, framing([1.0; 2], [0.3, 0.0]));
        assert!(simple.is_of_one_kind() && !measured.is_of_one_kind());
    }

    #[test]
    fn lines_beside_the_picture_are_not_its_own() {
        let framing = Framing { scale: [0.5, 1.0], shift: [-2.0, 3.0], ..Framing::default() };
        assert_eq!([framing.own_lines(0, 8), framing.own_lines(1, 8)], [0..4, 3..8]);
        let beside = Framing { shift: [0.0, 90.0], ..framing };
        assert!(beside.own_lines(1, 8).is_empty());
    }
}
