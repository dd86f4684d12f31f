//! The common parts of two buffers, and their differences.

use super::alike::Known;
use super::aspect::{Aspect, Unit};
use super::buffer_pair::{BufferPair, PixelDifference};
use super::classes::{Class, Classes, WORD, Word};
use super::measures::Measures;
use super::tolerance::Tolerances;
use crate::common::{Crop, CropError};
use image::RgbImage;
use serde::Serialize;
use std::ops::Range;
use std::sync::Arc;

/// The light of the difference image of buffers without a picture.
const MILD_GREY: [u8; 3] = [117; 3];
/// The number of differing pixels that a comparison names.
const NAMED_PIXELS: usize = 10;

/// The reason why two buffers cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Incomparable {
    /// The buffers have different sizes.
    #[error(
        "A is {} x {} pixels and B is {} x {}; compare files of one size{}",
        .a[0], .a[1], .b[0], .b[1],
        if .a[0] == .b[1] && .a[1] == .b[0] { " (are rows and columns swapped?)" } else { "" }
    )]
    Size {
        /// Width and height of A.
        a: [u32; 2],
        /// Width and height of B.
        b: [u32; 2],
    },
    /// A rectangle to ignore has no pixels, or some outside of the image.
    #[error("--ignore: {}", .0.to_string().replace("the crop", "the rectangle"))]
    Ignored(CropError),
    /// The rectangles to ignore leave no pixel to compare.
    #[error("every pixel is ignored, so that nothing is left to compare; ignore less")]
    NothingLeft,
    /// The buffers contain different aspects.
    #[error(
        "A ({a}) and B ({b}) have nothing in common to compare; \
         a picture without alpha tells what is covered with --background COLOR, --channels chooses what of an \
         EXR is read, and --normals says that colours are normals"
    )]
    NothingInCommon {
        /// The kind of A.
        a: &'static str,
        /// The kind of B.
        b: &'static str,
    },
}

/// The result of comparing two buffers; a part that was not compared is `None`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BufferComparison {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Whether the buffers are equal in all compared aspects, within the tolerances.
    pub equal: bool,
    /// Whether no more pixels differ than are allowed to.
    pub passes: bool,
    /// The number of differing pixels that are allowed.
    pub allowed_pixels: u64,
    /// The tolerances for measured values.
    pub tolerances: Tolerances,
    /// The rectangles that were not compared: row, column, height, width.
    pub ignored: Vec<[u32; 4]>,
    /// The number of pixels that were not compared.
    pub ignored_pixels: u64,
    /// The aspects that both buffers contain and that were compared.
    pub compared: Vec<Aspect>,
    /// The aspects that were not compared, and the reasons.
    pub not_compared: Vec<String>,
    /// The number of pixels that differ in any compared aspect.
    pub differing_pixels: u64,
    /// The first differing pixels, at most 10, as `[i, j]`, row by row.
    pub first_differing: Vec<[u32; 2]>,
    /// The smallest rectangle around all differing pixels: row, column, height, width.
    pub region: Option<[u32; 4]>,
    /// The comparison of coverage.
    pub coverage: Option<BufferCoverage>,
    /// The comparison of visible primitives, where both buffers cover.
    pub ids: Option<BufferIds>,
    /// The comparison of distances, where both buffers cover.
    pub depth: Option<BufferDepth>,
    /// The comparison of normals, where both buffers cover.
    pub normals: Option<BufferNormals>,
    /// The comparison of colours, where neither buffer marks the pixel as uncovered.
    #[serde(rename = "colour")]
    pub color: Option<BufferColor>,
    /// How far the buffers are apart as a whole; no measure decides anything.
    pub measures: Measures,
    /// The possible causes of the difference as a whole: one sentence for each cause.
    pub hints: Vec<String>,
    #[serde(skip)]
    classes: Classes,
    /// The picture that lights the difference image.
    #[serde(skip)]
    pub(super) light: Option<Arc<RgbImage>>,
}

/// The coverage of both buffers, counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct BufferCoverage {
    /// The unit of the counts.
    pub unit: Unit,
    /// Covered in A.
    pub a: u64,
    /// Covered in B.
    pub b: u64,
    /// Covered in both.
    pub both: u64,
    /// Covered in A alone.
    pub only_a: u64,
    /// Covered in B alone.
    pub only_b: u64,
    /// Whether both buffers cover the same samples or pixels.
    #[serde(rename = "match")]
    pub matches: bool,
}

/// Ids where both cover.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct BufferIds {
    /// The number of samples in which both buffers show a primitive, but different primitives.
    pub differing_samples: u64,
    /// The number of pixels with such a sample.
    pub differing_pixels: u64,
}

/// Distances where both cover.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BufferDepth {
    /// The largest relative difference of a sample, as a part of the larger distance.
    pub max_relative_difference: f64,
    /// The first pixel `[i, j]` with this difference, if there is any difference.
    pub at: Option<[u32; 2]>,
    /// The two distances there.
    pub t: Option<[f64; 2]>,
    /// The number of pixels with a sample beyond the tolerance.
    pub differing_pixels: u64,
}

/// Normals where both cover.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BufferNormals {
    /// The largest angle between two normals of a pixel, in degrees.
    pub max_degrees: f64,
    /// The first pixel `[i, j]` with this angle, if any angle is more than 0.
    pub at: Option<[u32; 2]>,
    /// The number of pixels beyond the tolerance.
    pub differing_pixels: u64,
}

/// The colours where neither buffer marks the pixel as uncovered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BufferColor {
    /// The largest difference in red, green, blue (or alpha, if both have it), in steps of 1/255.
    pub max_difference: f32,
    /// The first pixel `[i, j]` with this difference, if there is any difference.
    pub at: Option<[u32; 2]>,
    /// The number of pixels beyond the tolerance.
    pub differing_pixels: u64,
}

/// Compares all aspects that both buffers contain. This function measures nothing, searches for no cause, and nothing lights the
/// difference image.
///
/// # Errors
///
/// If the buffers differ in size, have no aspect in common, or no such pixels as are to be ignored.
pub(super) fn compare(pair: &BufferPair) -> Result<BufferComparison, Incomparable> {
    let &BufferPair { a, b, .. } = pair;
    if a.size() != b.size() {
        return Err(Incomparable::Size { a: a.size(), b: b.size() });
    }
    let compared: Vec<Aspect> =
        Aspect::ALL.into_iter().filter(|&aspect| pair.compares(aspect)).collect();
    if compared.is_empty() {
        return Err(Incomparable::NothingInCommon { a: a.kind(), b: b.kind() });
    }
    for ignored in pair.ignored() {
        ignored.check(a.size()).map_err(Incomparable::Ignored)?;
    }
    let (sums, classes) = all_pixels(pair);
    if sums.ignored_pixels == a.size().map(u64::from).iter().product::<u64>() {
        return Err(Incomparable::NothingLeft);
    }
    let has = |aspect| compared.contains(&aspect);
    let coverage = has(Aspect::Coverage).then(|| sums.coverage(pair.unit()));
    Ok(BufferComparison {
        size: a.size(),
        equal: sums.differing_pixels == 0,
        passes: sums.differing_pixels == 0,
        allowed_pixels: 0,
        tolerances: pair.tolerances(),
        ignored: pair.ignored().iter().map(Crop::to_array).collect(),
        ignored_pixels: sums.ignored_pixels,
        not_compared: pair.not_compared(),
        differing_pixels: sums.differing_pixels,
        first_differing: sums.first_differing,
        region: sums
            .corners
            .map(|[[top, left], [bottom, right]]| [top, left, bottom - top + 1, right - left + 1]),
        coverage,
        ids: has(Aspect::Ids).then_some(sums.ids),
        depth: has(Aspect::T).then_some(sums.depth),
        normals: has(Aspect::Normals).then_some(sums.normals),
        color: has(Aspect::Color).then_some(sums.color),
        measures: Measures::default(),
        hints: Vec::new(),
        compared,
        classes,
        light: None,
    })
}

/// Compares each pixel of A with the same pixel of B, several rows at once.
fn all_pixels(pair: &BufferPair) -> (Sums, Classes) {
    /// Few enough that all processors have work, and enough that handing it out costs nothing.
    const ROWS: u32 = 16;
    let (size @ [width, _], [top, left]) = (pair.a.size(), pair.a.origin());
    if let Some((mask, both)) = pair.equal_mask() {
        return (Sums { both, ..Sums::default() }, Classes::of_equal(size, mask));
    }
    // The number of each word of a row, and its first column.
    let places = || (0..).zip((0..width).step_by(WORD as usize));
    let (classes, sums) = Classes::written(size, ROWS, |rows| {
        let mut sums = Sums::default();
        let mut words = Vec::new();
        for row in 0..rows.count {
            let i = rows.first + row;
            if let Some(counts) = pair.mask_row(i, &mut words) {
                sums.add_masks(counts);
                for ((word, first), &masks) in places().zip(&words) {
                    sums.add_differing([top + i, left + first], masks[0] ^ masks[1]);
                    rows.write(row, word, Word::of_masks(masks));
                }
                continue;
            }
            for (word, first) in places() {
                let columns = first..width.min(first + WORD);
                let known = Known {
                    t: sums.depth.max_relative_difference,
                    color: sums.color.max_difference,
                };
                let classes = if let Some(covered) = pair.alike_run(i, columns.clone(), known) {
                    sums.both += u64::from(covered.count_ones());
                    Word::alike(covered)
                } else {
                    few_pixels(pair, i, columns, [top, left], &mut sums, known)
                };
                rows.write(row, word, classes);
            }
        }
        sums
    });
    (sums.into_iter().fold(Sums::default(), Sums::followed_by), classes)
}

/// Compares up to 64 pixels of a row of which some differ: eight at a time, and those one after the other that are not alike.
#[inline(never)]
fn few_pixels(
    pair: &BufferPair,
    i: u32,
    columns: Range<u32>,
    [top, left]: [u32; 2],
    sums: &mut Sums,
    known: Known,
) -> Word {
    const FEW: u32 = 8;
    let mut classes = Word::default();
    for first in columns.clone().step_by(FEW as usize) {
        let (few, at) = (first..columns.end.min(first + FEW), first - columns.start);
        if let Some(covered) = pair.alike_run(i, few.clone(), known) {
            sums.both += u64::from(covered.count_ones());
            classes.put_alike(covered << at);
            continue;
        }
        for (pixel, j) in (at..).zip(few) {
            let found = pair.compare_pixels([i, j], [i, j]);
            classes.put(pixel, sums.add([top + i, left + j], &found));
        }
    }
    classes
}

impl BufferComparison {
    /// The same comparison, which passes if at most this number of pixels differ.
    pub(super) fn allowing(mut self, pixels: u64) -> BufferComparison {
        self.allowed_pixels = pixels;
        self.passes = self.differing_pixels <= pixels;
        self
    }

    /// The difference image: orange and blue where only A or only B covers, pink where both cover
    /// and differ, grey where they agree, near black where neither covers, dark green where nothing is compared.
    pub fn picture(&self) -> RgbImage {
        match &self.light {
            Some(light) => self.classes.picture(light),
            None => self.classes.lit(|_| MILD_GREY),
        }
    }

    /// The class of each pixel.
    pub fn classes(&self) -> &Classes {
        &self.classes
    }
}

/// The state of the comparison so far.
#[derive(Default)]
struct Sums {
    only_a: u64,
    only_b: u64,
    both: u64,
    ids: BufferIds,
    depth: BufferDepth,
    normals: BufferNormals,
    color: BufferColor,
    ignored_pixels: u64,
    differing_pixels: u64,
    first_differing: Vec<[u32; 2]>,
    /// The corners of the rectangle around all differing pixels, both inside.
    corners: Option<[[u32; 2]; 2]>,
}

impl Sums {
    fn add(&mut self, pixel: [u32; 2], found: &PixelDifference) -> Class {
        self.only_a += found.only_a;
        self.only_b += found.only_b;
        self.both += found.both;
        self.ids.differing_samples += found.other_ids;
        self.ids.differing_pixels += u64::from(found.other_ids > 0);
        self.depth.differing_pixels += u64::from(found.has_other_depth());
        if found.depth > self.depth.max_relative_difference {
            self.depth.max_relative_difference = found.depth;
            (self.depth.at, self.depth.t) = (Some(pixel), Some(found.t));
        }
        self.normals.differing_pixels += u64::from(found.has_other_normal());
        if found.angle > self.normals.max_degrees {
            (self.normals.max_degrees, self.normals.at) = (found.angle, Some(pixel));
        }
        self.color.differing_pixels += u64::from(found.has_other_color());
        if found.color > self.color.max_difference {
            (self.color.max_difference, self.color.at) = (found.color, Some(pixel));
        }
        let class = found.class();
        self.ignored_pixels += u64::from(class == Class::Ignored);
        self.differing_pixels += u64::from(class.differs());
        self.add_differing(pixel, class.differs().into());
        class
    }

    /// Adds the pixels of two masks that both cover, that A alone and that B alone covers.
    fn add_masks(&mut self, [both, only_a, only_b]: [u64; 3]) {
        self.both += both;
        self.only_a += only_a;
        self.only_b += only_b;
        self.differing_pixels += only_a + only_b;
    }

    /// Adds the places of pixels of a row that differ, where a bit is 1; the lowest is that of `first`.
    fn add_differing(&mut self, [row, first]: [u32; 2], mut differing: u64) {
        if differing == 0 {
            return;
        }
        self.include([row, first + differing.trailing_zeros()]);
        self.include([row, first + differing.ilog2()]);
        while differing != 0 && self.first_differing.len() < NAMED_PIXELS {
            self.first_differing.push([row, first + differing.trailing_zeros()]);
            differing &= differing - 1;
        }
    }

    /// The sums over these rows, and over others below.
    fn followed_by(mut self, below: Sums) -> Sums {
        self.only_a += below.only_a;
        self.only_b += below.only_b;
        self.both += below.both;
        self.ids.differing_samples += below.ids.differing_samples;
        self.ids.differing_pixels += below.ids.differing_pixels;
        self.ignored_pixels += below.ignored_pixels;
        self.differing_pixels += below.differing_pixels;
        // Of equal maxima, the first is named.
        let pixels = self.depth.differing_pixels + below.depth.differing_pixels;
        if below.depth.max_relative_difference > self.depth.max_relative_difference {
            self.depth = below.depth;
        }
        self.depth.differing_pixels = pixels;
        let pixels = self.normals.differing_pixels + below.normals.differing_pixels;
        if below.normals.max_degrees > self.normals.max_degrees {
            self.normals = below.normals;
        }
        self.normals.differing_pixels = pixels;
        let pixels = self.color.differing_pixels + below.color.differing_pixels;
        if below.color.max_difference > self.color.max_difference {
            self.color = below.color;
        }
        self.color.differing_pixels = pixels;
        let named = NAMED_PIXELS - self.first_differing.len();
        self.first_differing.extend(below.first_differing.into_iter().take(named));
        for corner in below.corners.into_iter().flatten() {
            self.include(corner);
        }
        self
    }

    /// Extends the rectangle to a pixel.
    fn include(&mut self, pixel: [u32; 2]) {
        let [low, high] = self.corners.unwrap_or([pixel; 2]);
        let both = |a: [u32; 2], b: [u32; 2], pick: fn(u32, u32) -> u32| {
            [pick(a[0], b[0]), pick(a[1], b[1])]
        };
        self.corners = Some([both(low, pixel, u32::min), both(high, pixel, u32::max)]);
    }

    fn coverage(&self, unit: Unit) -> BufferCoverage {
        BufferCoverage {
            unit,
            a: self.both + self.only_a,
            b: self.both + self.only_b,
            both: self.both,
            only_a: self.only_a,
            only_b: self.only_b,
            matches: self.only_a + self.only_b == 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diff::buffer::{Buffer, Content, Covered, Picture, Pixels};
    use crate::diff::buffer_pair::Decides;
    use crate::diff::classes::pixels;

    /// Two buffers of each kind; the second one differs in about one value of twenty.
    fn pairs(size: [u32; 2]) -> Vec<[Buffer<'static>; 2]> {
        let mut dice = fastrand::Rng::with_seed(7);
        let count = (size[0] * size[1]) as usize;
        let mut two = |kind: u32| {
            let first: Vec<u8> = (0..count).map(|_| dice.u8(0..8)).collect();
            let other = |&value: &u8| if dice.u8(0..20) == 0 { dice.u8(0..8) } else { value };
            let second: Vec<u8> = first.iter().map(other).collect();
            [first, second].map(|values| Buffer::new(size, 1, content(kind, size, &values)))
        };
        (0..8).map(&mut two).collect()
    }

    fn content(kind: u32, [width, height]: [u32; 2], values: &[u8]) -> Content<'static> {
        let picture = |covered| {
            let colors = values.iter().map(|&value| [value, 0, 7, value % 2]);
            Content::Picture(Picture { pixels: Pixels::Bytes(colors.collect()), covered })
        };
        let opaque = |covered| {
            let colors = values.iter().flat_map(|&value| [value, 0, 7]).collect();
            let pixels = RgbImage::from_raw(width, height, colors).unwrap();
            Content::Picture(Picture { pixels: Pixels::Opaque(pixels.into()), covered })
        };
        let numbers = [1.0, 1.0 + 1e-7, 1.5, f64::NAN, -0.0, 0.0, 4e-320, 5e-320];
        match kind {
            0 => {
                let mask: Vec<bool> = values.iter().map(|&value| value > 1).collect();
                Content::Mask(mask.into())
            }
            1 => Content::Ids(values.iter().map(|id| id.checked_sub(1).map(u64::from)).collect()),
            2 => Content::Distances(values.iter().map(|&at| numbers[at as usize]).collect()),
            3 => picture(Covered::Unknown),
            4 => picture(Covered::ByAlpha),
            5 => picture(Covered::ByBackground([2, 0, 7])),
            6 => opaque(Covered::Unknown),
            _ => opaque(Covered::ByBackground([2, 0, 7])),
        }
    }

    #[test]
    fn equal_masks_of_any_size_are_counted_and_one_other_pixel_is_found() {
        for size in [[1, 1], [63, 3], [640, 480], [257, 130]] {
            let count = (size[0] * size[1]) as usize;
            for every in [1, 2, 7] {
                let mask: Vec<bool> = (0..count).map(|at| at % every == 0).collect();
                let buffer =
                    |mask: &[bool]| Buffer::new(size, 1, Content::Mask(mask.to_vec().into()));
                let a = buffer(&mask);
                let pair = BufferPair::new(&a, &a, Decides::Everything);
                assert_eq!(pair.equal_mask().unwrap().1, count.div_ceil(every) as u64);
                for at in [0, count / 2, count - 1] {
                    let mut other = mask.clone();
                    other[at] ^= true;
                    let b = buffer(&other);
                    let pair = BufferPair::new(&a, &b, Decides::Everything);
                    assert!(pair.equal_mask().is_none(), "{size:?}, {at}");
                    assert_eq!(all_pixels(&pair).0.differing_pixels, 1);
                }
            }
        }
    }

    #[test]
    fn opaque_pictures_compare_as_those_with_an_alpha_that_tells_nothing() {
        let size = [70, 9];
        let mut dice = fastrand::Rng::with_seed(3);
        let values = [(); 2].map(|()| (0..70 * 9).map(|_| dice.u8(0..8)).collect::<Vec<u8>>());
        let [opaque, with_alpha] = [6, 3].map(|kind| {
            let [a, b] =
                values.each_ref().map(|values| Buffer::new(size, 1, content(kind, size, values)));
            compare(&BufferPair::new(&a, &b, Decides::Everything)).unwrap()
        });
        assert!(opaque.differing_pixels > 100);
        assert_eq!(opaque, with_alpha);
    }

    #[test]
    fn runs_of_equal_pixels_are_compared_as_single_ones() {
        for size in [[1, 40], [63, 5], [64, 33], [130, 20]] {
            for [a, b] in &pairs(size) {
                for [a, b] in [[a, a], [a, b]] {
                    let pair = BufferPair::new(a, b, Decides::Everything);
                    let (found, classes) = all_pixels(&pair);
                    let mut sums = Sums::default();
                    for pixel in pixels(size) {
                        let class = sums.add(pixel, &pair.compare_pixels(pixel, pixel));
                        assert_eq!(classes.at(pixel[0], pixel[1]), class, "{}", a.kind());
                    }
                    let numbers = |sums: &Sums| {
                        let Sums { both, only_a, only_b, differing_pixels, .. } = *sums;
                        (both, only_a, only_b, differing_pixels, sums.corners)
                    };
                    assert_eq!(numbers(&found), numbers(&sums), "{}", a.kind());
                    assert_eq!(found.first_differing, sums.first_differing, "{}", a.kind());
                    assert_eq!((found.ids, found.depth), (sums.ids, sums.depth), "{}", a.kind());
                    assert_eq!(found.color, sums.color, "{}", a.kind());
                }
            }
        }
    }
}
