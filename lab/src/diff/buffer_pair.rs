//! The comparison of one pixel of A with one pixel of B: which of them is covered, and how far their values differ.

use super::alike::Known;
use super::aspect::{Aspect, Unit};
use super::buffer::Buffer;
use super::classes::Class;
use super::tolerance::{CompareOptions, Tolerances};
use crate::common::Crop;
use crate::common::glam::DVec3;
use std::ops::Range;
use std::sync::Arc;

/// The aspects that make two pixels different.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Decides {
    /// All aspects that both buffers contain.
    Everything,
    /// Coverage and ids alone: depth and colour are measured, and do not decide.
    Visibility,
}

/// Two buffers of one size.
pub(super) struct BufferPair<'a> {
    pub(super) a: &'a Buffer<'a>,
    pub(super) b: &'a Buffer<'a>,
    decides: Decides,
    tolerances: Tolerances,
    ignored: &'a [Crop],
    unit: Unit,
    /// Whether ids are compared; in the next two fields, distances and colours.
    ids: bool,
    t: bool,
    normals: bool,
    color: bool,
    /// The pixels of two pictures that tell colours alone.
    colors_alone: Option<[&'a [[u8; 3]]; 2]>,
}

/// The differences between two pixels.
pub(super) struct PixelDifference {
    decides: Decides,
    tolerances: Tolerances,
    is_ignored: bool,
    pub(super) only_a: u64,
    pub(super) only_b: u64,
    pub(super) both: u64,
    pub(super) other_ids: u64,
    /// The largest relative difference of `t`, and the two distances.
    pub(super) depth: f64,
    pub(super) t: [f64; 2],
    /// The angle between the normals, in degrees.
    pub(super) angle: f64,
    pub(super) color: f32,
}

impl PixelDifference {
    fn new(decides: Decides, tolerances: Tolerances) -> PixelDifference {
        let (only_a, only_b, both, other_ids) = (0, 0, 0, 0);
        PixelDifference {
            decides,
            tolerances,
            is_ignored: false,
            only_a,
            only_b,
            both,
            other_ids,
            depth: 0.0,
            t: [0.0; 2],
            angle: 0.0,
            color: 0.0,
        }
    }

    pub(super) fn class(&self) -> Class {
        let measured = self.decides == Decides::Everything
            && (self.has_other_depth() || self.has_other_normal() || self.has_other_color());
        match self {
            PixelDifference { is_ignored: true, .. } => Class::Ignored,
            PixelDifference { only_a: 1.., .. } => Class::OnlyObjectOrder,
            PixelDifference { only_b: 1.., .. } => Class::OnlyImageOrder,
            PixelDifference { other_ids: 1.., .. } => Class::OtherPrimitive,
            _ if measured => Class::OtherPrimitive,
            PixelDifference { both: 1.., .. } => Class::Alike,
            _ => Class::Neither,
        }
    }

    /// Whether a difference of distances is beyond the tolerance.
    pub(super) fn has_other_depth(&self) -> bool {
        self.depth > self.tolerances.t
    }

    /// Whether the angle between the normals is beyond the tolerance.
    pub(super) fn has_other_normal(&self) -> bool {
        self.angle > self.tolerances.normals
    }

    /// Whether the difference of the colours is beyond the tolerance.
    pub(super) fn has_other_color(&self) -> bool {
        self.color > self.tolerances.color
    }

    fn cover(&mut self, by_a: bool, by_b: bool) {
        self.both += u64::from(by_a && by_b);
        self.only_a += u64::from(by_a && !by_b);
        self.only_b += u64::from(!by_a && by_b);
    }
}

impl<'a> BufferPair<'a> {
    /// A pair to compare by the usual tolerances.
    pub(super) fn new(a: &'a Buffer<'a>, b: &'a Buffer<'a>, decides: Decides) -> BufferPair<'a> {
        let unit = if a.samples() == b.samples() { Unit::Samples } else { Unit::Pixels };
        let compares = |aspect| unit == Unit::Samples && a.tells(aspect) && b.tells(aspect);
        let [ids, t, normals, color] =
            [Aspect::Ids, Aspect::T, Aspect::Normals, Aspect::Color].map(compares);
        let (tolerances, ignored) = (Tolerances::default(), &[][..]);
        let colors_alone = a.colors_alone().zip(b.colors_alone()).map(<[_; 2]>::from);
        let colors_alone = colors_alone.filter(|_| a.samples() == 1 && b.samples() == 1);
        BufferPair {
            a,
            b,
            decides,
            tolerances,
            ignored,
            unit,
            ids,
            t,
            normals,
            color,
            colors_alone,
        }
    }

    /// The same pair with other tolerances, and without the ignored pixels.
    pub(super) fn with(self, options: &'a CompareOptions) -> BufferPair<'a> {
        BufferPair { tolerances: options.tolerances, ignored: &options.ignored, ..self }
    }

    pub(super) fn unit(&self) -> Unit {
        self.unit
    }

    pub(super) fn compares(&self, aspect: Aspect) -> bool {
        match aspect {
            Aspect::Coverage => self.a.has_coverage() && self.b.has_coverage(),
            Aspect::Ids => self.ids,
            Aspect::T => self.t,
            Aspect::Normals => self.normals,
            Aspect::Color => self.color,
        }
    }

    pub(super) fn not_compared(&self) -> Vec<String> {
        let reason = |aspect: Aspect| match (self.a.tells(aspect), self.b.tells(aspect)) {
            (true, false) => Some("only A tells".to_owned()),
            (false, true) => Some("only B tells".to_owned()),
            (true, true) if !self.compares(aspect) => {
                let [a, b] = [self.a, self.b].map(Buffer::samples);
                Some(format!("A has {a} x {a} samples a pixel, B {b} x {b}"))
            }
            _ => None,
        };
        let line = |aspect: Aspect| Some(format!("{}: {}", aspect.name(), reason(aspect)?));
        Aspect::ALL.into_iter().filter_map(line).collect()
    }

    pub(super) fn tolerances(&self) -> Tolerances {
        self.tolerances
    }

    /// The rectangles of pixels that are not compared.
    pub(super) fn ignored(&self) -> &'a [Crop] {
        self.ignored
    }

    /// Whether a pixel is not compared.
    pub(super) fn ignores(&self, [i, j]: [u32; 2]) -> bool {
        let holds =
            |first: u32, count: u32, at: u32| at.checked_sub(first).is_some_and(|n| n < count);
        self.ignored
            .iter()
            .any(|crop| holds(crop.row, crop.height, i) && holds(crop.column, crop.width, j))
    }

    /// Whether pixels may be compared several at a time: each is one sample, and none is ignored.
    fn compares_whole_runs(&self) -> bool {
        self.unit == Unit::Samples && self.a.samples() == 1 && self.ignored.is_empty()
    }

    /// The values of two masks that are equal everywhere, and how many of them are covered; `None` if they differ, or if
    /// these are no masks.
    pub(super) fn equal_mask(&self) -> Option<(&Arc<Vec<bool>>, u64)> {
        self.compares_whole_runs().then(|| self.a.equal_mask(self.b))?
    }

    /// A bit for each pixel of a row of two masks, and the number of pixels that both cover, that A alone and that B alone
    /// covers; `None` if these are no masks.
    pub(super) fn mask_row(&self, row: u32, words: &mut Vec<[u64; 2]>) -> Option<[u64; 3]> {
        self.compares_whole_runs().then(|| self.a.mask_row(self.b, row, words))?
    }

    /// The covered ones of up to 64 pixels of a row, if A and B are alike there and no value differs by more than is known
    /// of others, so that these pixels count and change nothing else. `None` if that may not be so: each pixel is to be
    /// compared. Pixels of colours alone count as covered.
    pub(super) fn alike_run(&self, row: u32, columns: Range<u32>, known: Known) -> Option<u64> {
        if !self.compares_whole_runs() {
            return None;
        }
        let known = Known {
            t: known.t.min(self.tolerances.t),
            color: known.color.min(self.tolerances.color),
        };
        self.a.alike_run(self.b, row, columns, known)
    }

    /// Compares a pixel of A with a pixel of B.
    pub(super) fn compare_pixels(&self, in_a: [u32; 2], in_b: [u32; 2]) -> PixelDifference {
        let mut found = PixelDifference::new(self.decides, self.tolerances);
        if self.ignores(in_a) || self.ignores(in_b) {
            found.is_ignored = true;
            return found;
        }
        if let Some([a, b]) = self.colors_alone {
            // A pixel with equal colours has the class for alike pixels.
            found.both = 1;
            let [a, b] = [a[self.a.pixel(in_a)], b[self.b.pixel(in_b)]];
            let channels = [0, 1, 2].map(|channel| a[channel].abs_diff(b[channel]));
            found.color = channels.into_iter().max().map_or(0.0, f32::from);
            return found;
        }
        if self.unit == Unit::Pixels {
            let any = |buffer: &Buffer, pixel| {
                buffer.samples_of(pixel).any(|sample| buffer.covered(sample) == Some(true))
            };
            found.cover(any(self.a, in_a), any(self.b, in_b));
            return found;
        }
        for (a, b) in self.a.samples_of(in_a).zip(self.b.samples_of(in_b)) {
            self.compare_samples(a, b, &mut found);
        }
        if self.color
            && let (Some(a), Some(b)) = (self.a.color(in_a), self.b.color(in_b))
        {
            found.color = color_difference(a, b);
        }
        found
    }

    /// Compares two samples.
    fn compare_samples(&self, a: usize, b: usize, found: &mut PixelDifference) {
        let (Some(covered_a), Some(covered_b)) = (self.a.covered(a), self.b.covered(b)) else {
            // The buffers contain colours alone.
            found.both += 1;
            return;
        };
        found.cover(covered_a, covered_b);
        if !covered_a || !covered_b {
            return;
        }
        if self.ids && self.a.id(a) != self.b.id(b) {
            // The distances of two different primitives may differ by any amount.
            found.other_ids += 1;
        } else if self.t {
            let t = [self.a.t(a), self.b.t(b)];
            let difference = relative_difference(t);
            if difference > found.depth {
                (found.depth, found.t) = (difference, t);
            }
        } else if self.normals {
            found.angle = degrees(self.a.normal(a), self.b.normal(b));
        }
    }
}

/// The difference of two finite distances as a part of the larger absolute value, from 0 to 2; 0 for two zeros.
///
/// The difference and the quotient are each rounded once. Where the smaller is at least half the larger, the
/// difference is exact.
fn relative_difference([a, b]: [f64; 2]) -> f64 {
    if a == b {
        return 0.0;
    }
    let larger = a.abs().max(b.abs());
    // Two large numbers of opposite signs have an infinite difference, so numbers from 1 on are halved first. To halve
    // is exact, except for denormals: beside a number from 1 on a denormal changes nothing, and two smaller numbers stay
    // whole. So the result has the bits of `(a - b).abs() / larger` where that is finite, as it is for all `f32`.
    let scale = if larger < 1.0 { 1.0 } else { 0.5 };
    (a * scale - b * scale).abs() / (larger * scale)
}

/// The angle between two vectors, whatever their lengths: the arc tangent is accurate for small angles, too.
fn degrees(a: [f32; 3], b: [f32; 3]) -> f64 {
    let [a, b] = [a, b].map(|vector| DVec3::from_array(vector.map(f64::from)));
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

/// The largest difference in red, green and blue, and in alpha if both colours have alpha.
fn color_difference((a, a_has_alpha): ([f32; 4], bool), (b, b_has_alpha): ([f32; 4], bool)) -> f32 {
    let channels = if a_has_alpha && b_has_alpha { 4 } else { 3 };
    let channels = a.into_iter().zip(b).take(channels);
    channels.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_relative_difference_of_extreme_distances_is_exact() {
        let (most, huge, least) = (f64::MAX, 2_f64.powi(1023), f64::from_bits(1));
        let cases = [
            ([0.0, -0.0], 0.0),
            ([3.0, 4.0], 0.25),
            ([-4.0, 3.0], 1.75),
            ([most, most], 0.0),
            ([most, -most], 2.0),
            ([most, 0.0], 1.0),
            ([most, least], 1.0),
            ([huge, huge.next_down()], f64::EPSILON / 2.0),
            ([least, 0.0], 1.0),
            ([least, -least], 2.0),
            ([least, 2.0 * least], 0.5),
            ([3.0 * least, 4.0 * least], 0.25),
            ([1.0, 1.0_f64.next_down()], f64::EPSILON / 2.0),
            ([1.0, least], 1.0),
        ];
        for ([a, b], expected) in cases {
            assert_eq!(relative_difference([a, b]), expected, "{a:e} and {b:e}");
            assert_eq!(relative_difference([b, a]), expected, "{b:e} and {a:e}");
        }
    }

    #[test]
    fn halving_changes_no_bit_for_distances_of_frames() {
        let numbers = [
            f32::from_bits(1),
            f32::MIN_POSITIVE,
            0.1,
            1.0_f32.next_down(),
            1.0,
            3.3,
            1e9,
            f32::MAX,
        ];
        let numbers = numbers.map(|number| [number, number.next_up().min(f32::MAX)]);
        for (a, b) in numbers
            .as_flattened()
            .iter()
            .flat_map(|a| numbers.as_flattened().iter().map(move |b| (a, b)))
        {
            let [a, b] = [*a, *b].map(f64::from);
            assert_eq!(
                relative_difference([a, b]).to_bits(),
                ((a - b).abs() / a.max(b)).to_bits(),
                "{a:e} and {b:e}"
            );
        }
    }
}
