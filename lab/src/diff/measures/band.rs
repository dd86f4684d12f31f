//! The colours of two buffers in some rows, without a copy, and where they are equal.

use crate::diff::buffer::{Buffer, Content, Pixels};
use crate::diff::buffer_pair::BufferPair;
use std::ops::Range;

/// The columns of which it is known whether they are equal as a whole: the left edges of so many windows.
pub(super) const PART: usize = 64;
/// The width and the height of a window in pixels.
pub(super) const WINDOW: usize = 11;

/// The colours of a buffer, row by row.
#[derive(Clone, Copy)]
pub(super) enum Colors<'a> {
    /// With alpha, which is not measured.
    Rgba(&'a [[u8; 4]]),
    Rgb(&'a [[u8; 3]]),
    Steps(&'a [[f32; 4]]),
}

impl<'a> Colors<'a> {
    /// `None` if the buffer has no colours.
    fn of(buffer: &'a Buffer) -> Option<Colors<'a>> {
        match buffer.content() {
            Content::Picture(picture) => Some(match &picture.pixels {
                Pixels::Opaque(_) => Colors::Rgb(picture.pixels.opaque()),
                Pixels::Bytes(colors) => Colors::Rgba(colors),
                Pixels::Steps(colors) => Colors::Steps(colors),
            }),
            Content::Frame(seen) => Some(Colors::Rgb(seen.picture.as_chunks().0)),
            _ => None,
        }
    }

    /// A part of them.
    fn part(self, pixels: Range<usize>) -> Colors<'a> {
        match self {
            Colors::Rgba(colors) => Colors::Rgba(&colors[pixels]),
            Colors::Rgb(colors) => Colors::Rgb(&colors[pixels]),
            Colors::Steps(colors) => Colors::Steps(&colors[pixels]),
        }
    }

    /// Red, green or blue of a pixel, in steps of 1/255.
    pub(super) fn value(self, pixel: usize, channel: usize) -> f32 {
        match self {
            Colors::Rgba(colors) => colors[pixel][channel].into(),
            Colors::Rgb(colors) => colors[pixel][channel].into(),
            Colors::Steps(colors) => colors[pixel][channel],
        }
    }

    /// Copies one channel of some pixels.
    pub(super) fn copy(self, pixels: Range<usize>, channel: usize, to: &mut [f32]) {
        match self.part(pixels) {
            Colors::Rgba(colors) => copy(to, colors.iter().map(|color| color[channel].into())),
            Colors::Rgb(colors) => copy(to, colors.iter().map(|color| color[channel].into())),
            Colors::Steps(colors) => copy(to, colors.iter().map(|color| color[channel])),
        }
    }

    /// The pixels from the first to the last of these that have other colours in another buffer, counted from the first of
    /// these; empty if they are equal. Where the two are stored in different ways, all of them.
    fn differing(self, other: Colors, pixels: Range<usize>) -> Range<usize> {
        match (self.part(pixels.clone()), other.part(pixels.clone())) {
            (Colors::Rgba(one), Colors::Rgba(other)) => differing(one, other),
            (Colors::Rgb(one), Colors::Rgb(other)) => differing(one, other),
            (Colors::Steps(one), Colors::Steps(other)) => differing(one, other),
            _ => 0..pixels.len(),
        }
    }
}

/// The places from the first to the last at which two slices differ.
fn differing<T: PartialEq>(one: &[T], other: &[T]) -> Range<usize> {
    if one == other {
        return 0..0;
    }
    let differ = |(one, other): (&T, &T)| one != other;
    let first = one.iter().zip(other).position(differ).unwrap_or(0);
    let last = one.iter().zip(other).rposition(differ).unwrap_or(0);
    first..last + 1
}

/// The sums of the absolute and of the squared differences of red, green and blue.
fn differences_of_bytes<const N: usize>(a: &[[u8; N]], b: &[[u8; N]]) -> [f64; 2] {
    let (mut absolute, mut squares) = (0_u32, 0_u32);
    // At most 64 pixels: the sums stay far below 2^32.
    for (a, b) in a.iter().zip(b) {
        for channel in 0..3 {
            let difference = u32::from(a[channel].abs_diff(b[channel]));
            absolute += difference;
            squares += difference * difference;
        }
    }
    [absolute.into(), squares.into()]
}

fn copy(to: &mut [f32], from: impl Iterator<Item = f32>) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = from;
    }
}

/// The colours of both buffers in some rows.
pub(super) struct Band<'a> {
    pub(super) width: usize,
    pub(super) colors: [Colors<'a>; 2],
    /// Which pixels are compared; `None` if all of them are.
    compared: Option<Vec<bool>>,
    /// For each row, and for each part of it together with the windows that begin there, the columns from the first to the
    /// last in which the colours differ, counted from the first of the part.
    differing: Vec<Range<usize>>,
}

impl<'a> Band<'a> {
    /// These rows; `None` if a buffer has no colours.
    pub(super) fn new(pair: &BufferPair<'a>, rows: Range<u32>) -> Option<Band<'a>> {
        let width = pair.a.size()[0] as usize;
        let pixels = rows.start as usize * width..rows.end as usize * width;
        let [a, b] = [Colors::of(pair.a)?, Colors::of(pair.b)?];
        let colors = [a.part(pixels.clone()), b.part(pixels)];
        let parts = || {
            let firsts = (0..width).step_by(PART);
            firsts.map(|first| first..(first + PART + WINDOW - 1).min(width))
        };
        let differing = |row: usize, columns: Range<usize>| {
            let first = row * width;
            colors[0].differing(colors[1], first + columns.start..first + columns.end)
        };
        let places = (0..rows.len()).flat_map(|row| parts().map(move |columns| (row, columns)));
        let differing = places.map(|(row, columns)| differing(row, columns)).collect();
        Some(Band { width, colors, compared: compared(pair, rows.clone()), differing })
    }

    /// The pixels of a row.
    pub(super) fn row(&self, row: usize) -> Range<usize> {
        row * self.width..(row + 1) * self.width
    }

    /// The parts of a row.
    pub(super) fn parts(&self) -> usize {
        self.width.div_ceil(PART)
    }

    /// The columns from the first to the last in which the colours differ in a part of a row, or in the windows that begin
    /// there, counted from the first of the part.
    pub(super) fn differing(&self, row: usize, part: usize) -> Range<usize> {
        self.differing[row * self.parts() + part].clone()
    }

    /// The sums of the absolute and of the squared differences of red, green and blue of some pixels.
    pub(super) fn differences(&self, pixels: Range<usize>) -> [f64; 2] {
        let [a, b] = self.colors.map(|colors| colors.part(pixels.clone()));
        // Sums of whole numbers, exact in any order, and found by vectors.
        match (a, b) {
            (Colors::Rgba(a), Colors::Rgba(b)) => differences_of_bytes(a, b),
            (Colors::Rgb(a), Colors::Rgb(b)) => differences_of_bytes(a, b),
            _ => {
                let mut sums = [0.0; 2];
                for (pixel, channel) in (0..pixels.len()).flat_map(|at| [0, 1, 2].map(|k| (at, k)))
                {
                    let [a, b] = [a, b].map(|colors| f64::from(colors.value(pixel, channel)));
                    let difference = a - b;
                    sums[0] += difference.abs();
                    sums[1] += difference.powi(2);
                }
                sums
            }
        }
    }

    /// Pixels of a row among which are all whose colours differ, part by part.
    pub(super) fn perhaps_differing(&self, row: usize) -> impl Iterator<Item = Range<usize>> {
        let of_part = move |part: usize| {
            let columns = self.differing(row, part);
            let first = row * self.width + part * PART;
            // What lies in the next part comes with that.
            first + columns.start.min(PART)..first + columns.end.min(PART)
        };
        (0..self.parts()).map(of_part)
    }

    /// Whether a pixel is compared.
    pub(super) fn is_compared(&self, pixel: usize) -> bool {
        self.compared.as_ref().is_none_or(|compared| compared[pixel])
    }

    /// Whether all pixels are compared.
    pub(super) fn is_compared_whole(&self) -> bool {
        self.compared.is_none()
    }

    /// The number of compared pixels of a row.
    pub(super) fn compared_in(&self, row: usize) -> f64 {
        let number = match &self.compared {
            Some(compared) => compared[self.row(row)].iter().filter(|&&compared| compared).count(),
            None => self.width,
        };
        f64_of(number)
    }
}

/// Which pixels of some rows are compared; `None` if all of them are.
fn compared(pair: &BufferPair, rows: Range<u32>) -> Option<Vec<bool>> {
    let [width, _] = pair.a.size();
    let is_something = |buffer: &Buffer, pixel| match buffer.content() {
        Content::Picture(picture) => picture.covered(buffer.pixel(pixel)) != Some(false),
        _ => true,
    };
    let tells =
        |buffer: &Buffer| matches!(buffer.content(), Content::Picture(_)) && buffer.has_coverage();
    if pair.ignored().is_empty() && !tells(pair.a) && !tells(pair.b) {
        return None;
    }
    let pixels = rows.flat_map(|i| (0..width).map(move |j| [i, j]));
    let is_compared =
        |pixel| is_something(pair.a, pixel) && is_something(pair.b, pixel) && !pair.ignores(pixel);
    Some(pixels.map(is_compared).collect())
}

#[expect(clippy::cast_precision_loss, reason = "at most 2^16 pixels of a row")]
pub(super) fn f64_of(pixels: usize) -> f64 {
    pixels as f64
}
