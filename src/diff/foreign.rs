//! Two files of any origin: where does my renderer differ from yours, and how?
//!
//! A [`Buffer`] is a mask, ids, distances or a picture, read from a PNG, PNM, BMP or NPY file by
//! [`read`]. [`compare`] compares what both have: coverage and ids without tolerance, distances and
//! colours within the tolerances of [`diff`](super).
//!
//! ```
//! use bothways::diff::foreign::{Buffer, Content, compare};
//!
//! let mine = Buffer::new([3, 1], 1, Content::Mask(vec![true, true, false]));
//! let yours = Buffer::new([3, 1], 1, Content::Ids(vec![Some(0), None, Some(4)]));
//! let comparison = compare(&mine, &yours)?;
//! assert_eq!(comparison.first_differing, [[0, 1], [0, 2]]);
//! # Ok::<(), bothways::diff::foreign::Incomparable>(())
//! ```

mod compare;
mod hints;
mod look;
mod npy;
mod picture;
mod png;
mod read;

pub use compare::{
    Aspect, BufferColor, BufferComparison, BufferCoverage, BufferDepth, BufferIds, Incomparable,
    Unit, compare,
};
pub use read::{ReadBufferError, read, read_from};

use image::{Rgb, RgbImage};

/// What a file of any origin says of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Buffer {
    size: [u32; 2],
    samples: u32,
    content: Content,
}

/// The values of a buffer: pixels row by row, the samples of a pixel together.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// What is covered.
    Mask(Vec<bool>),
    /// Which primitive is seen, `None` for nothing.
    Ids(Vec<Option<u64>>),
    /// How far it is. Covered is what is at a finite distance: neither ±∞ nor NaN.
    Distances(Vec<f64>),
    /// What it looks like; always one sample a pixel.
    Picture(Picture),
}

/// Colours, and what they say of coverage.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Red, green, blue and alpha in sRGB as stored; not premultiplied.
    pub pixels: Pixels,
    /// How coverage is read from them.
    pub covered: Covered,
}

/// Red, green, blue and alpha of each pixel, in steps of 1/255.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// Of 8 bits each.
    Bytes(Vec<[u8; 4]>),
    /// Finer.
    Steps(Vec<[f32; 4]>),
}

impl Pixels {
    /// How many pixels there are.
    pub fn len(&self) -> usize {
        match self {
            Pixels::Bytes(pixels) => pixels.len(),
            Pixels::Steps(pixels) => pixels.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A pixel.
    ///
    /// # Panics
    ///
    /// If there is no such pixel.
    pub fn get(&self, pixel: usize) -> [f32; 4] {
        match self {
            Pixels::Bytes(pixels) => pixels[pixel].map(f32::from),
            Pixels::Steps(pixels) => pixels[pixel],
        }
    }

    /// All of them, in their order.
    pub fn iter(&self) -> impl Iterator<Item = [f32; 4]> {
        (0..self.len()).map(|pixel| self.get(pixel))
    }
}

/// How a picture tells what is covered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Covered {
    /// It does not: colours alone.
    Unknown,
    /// Where alpha is more than zero.
    ByAlpha,
    /// A grey picture: where it is not black.
    ByLight,
    /// Where the colour, rounded to 8 bits, is not this one.
    ByBackground([u8; 3]),
}

impl Buffer {
    /// A buffer of `size` = `[W, H]` pixels with `samples`² samples in each.
    ///
    /// # Panics
    ///
    /// If the content has another number of values, or a picture more than one sample a pixel.
    pub fn new(size: [u32; 2], samples: u32, content: Content) -> Buffer {
        let expected = size.iter().map(|&side| side as usize).product::<usize>();
        let length = match &content {
            Content::Mask(values) => values.len(),
            Content::Ids(values) => values.len(),
            Content::Distances(values) => values.len(),
            Content::Picture(picture) => {
                assert_eq!(samples, 1, "a picture has one sample a pixel");
                picture.pixels.len()
            }
        };
        assert_eq!(length, expected * (samples as usize).pow(2), "the values do not fill the size");
        Buffer { size, samples, content }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Samples along one side of a pixel.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Its values.
    pub fn content(&self) -> &Content {
        &self.content
    }

    /// Whether it tells what is covered.
    pub fn has_coverage(&self) -> bool {
        !matches!(&self.content, Content::Picture(picture) if picture.covered == Covered::Unknown)
    }

    /// What it is, as a message calls it.
    pub fn kind(&self) -> &'static str {
        match &self.content {
            Content::Mask(_) => "mask",
            Content::Ids(_) => "ids",
            Content::Distances(_) => "distances t",
            Content::Picture(picture) => match picture.covered {
                Covered::Unknown => "picture without coverage",
                Covered::ByAlpha => "picture with alpha",
                Covered::ByLight => "grey picture",
                Covered::ByBackground(_) => "picture with a background",
            },
        }
    }

    /// What it says of pixel `(i, j)`, in a few words: `id 3`, `nothing`, `t 2.5`, `#c8553d`.
    ///
    /// # Panics
    ///
    /// If there is no such pixel.
    pub fn seen(&self, [i, j]: [u32; 2]) -> String {
        let pixel = i as usize * self.size[0] as usize + j as usize;
        let per_pixel = (self.samples as usize).pow(2);
        let said: Vec<String> =
            (pixel * per_pixel..).take(per_pixel).map(|sample| self.seen_at(sample)).collect();
        let mut parts: Vec<String> = Vec::new();
        // One after another, runs counted: a pixel may have thousands of samples.
        for run in said.chunk_by(PartialEq::eq) {
            parts.push(match run.len() {
                1 => run[0].clone(),
                length => format!("{} (x{length})", run[0]),
            });
        }
        if parts.len() > 4 {
            parts.truncate(4);
            parts.push("...".into());
        }
        parts.join(", ")
    }

    fn seen_at(&self, sample: usize) -> String {
        let nothing = || "nothing".to_owned();
        match &self.content {
            Content::Mask(mask) if mask[sample] => "covered".into(),
            Content::Ids(ids) => ids[sample].map_or_else(nothing, |id| format!("id {id}")),
            Content::Distances(t) if t[sample].is_finite() => {
                format!("t {}", distance_text(t[sample]))
            }
            Content::Picture(picture) if self.covered(sample) != Some(false) => {
                color_text(picture.pixels.get(sample), picture.covered == Covered::ByAlpha)
            }
            Content::Mask(_) | Content::Distances(_) | Content::Picture(_) => nothing(),
        }
    }

    /// Whether a sample is covered; `None` if nobody knows.
    fn covered(&self, sample: usize) -> Option<bool> {
        match &self.content {
            Content::Mask(mask) => Some(mask[sample]),
            Content::Ids(ids) => Some(ids[sample].is_some()),
            Content::Distances(t) => Some(t[sample].is_finite()),
            Content::Picture(picture) => picture.covered(sample),
        }
    }

    /// The picture that lights a difference image; a mild grey if this is none.
    fn light(&self) -> RgbImage {
        let [width, height] = self.size;
        let Content::Picture(picture) = &self.content else {
            return RgbImage::from_pixel(width, height, Rgb([117; 3]));
        };
        let mut light = RgbImage::new(width, height);
        for (pixel, [red, green, blue, _]) in light.pixels_mut().zip(picture.pixels.iter()) {
            *pixel = Rgb(bytes([red, green, blue]));
        }
        light
    }
}

impl Picture {
    fn covered(&self, pixel: usize) -> Option<bool> {
        let [red, green, blue, alpha] = self.pixels.get(pixel);
        match self.covered {
            Covered::Unknown => None,
            Covered::ByAlpha => Some(alpha > 0.0),
            Covered::ByLight => Some(red != 0.0),
            Covered::ByBackground(background) => Some(bytes([red, green, blue]) != background),
        }
    }
}

/// The nearest 8-bit values.
fn bytes<const N: usize>(steps: [f32; N]) -> [u8; N] {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "rounded, and clamped to a byte"
    )]
    steps.map(|step| step.round().clamp(0.0, 255.0) as u8)
}

/// A distance with no more digits than tell it from its neighbours, in `f32` if it is one.
pub fn distance_text(t: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "only used if it changes nothing")]
    let single = t as f32;
    if f64::from(single) == t { single.to_string() } else { t.to_string() }
}

/// `#rrggbb`, or decimals where eight bits do not tell it all.
fn color_text(color: [f32; 4], with_alpha: bool) -> String {
    let channels = if with_alpha { &color[..] } else { &color[..3] };
    if bytes(color).map(f32::from) == color {
        return channels
            .iter()
            .fold("#".into(), |text, &c| text + &format!("{:02x}", bytes([c])[0]));
    }
    let decimals: Vec<String> = channels.iter().map(|channel| format!("{channel:.2}")).collect();
    format!("({})", decimals.join(" "))
}

#[cfg(test)]
mod tests;
