//! The input of a comparison: a mask, ids, distances or a picture of any origin, or a frame.

use super::aspect::Aspect;
use super::classes::pixels;
use crate::common::Frame;
use image::RgbImage;
use rayon::prelude::*;
use std::borrow::Cow;
use std::sync::Arc;

/// The values of each pixel of a frame, or of a file of any origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Buffer<'a> {
    size: [u32; 2],
    /// The row and the column of the first pixel in the whole image.
    origin: [u32; 2],
    samples: u32,
    content: Content<'a>,
}

/// The values of a buffer: pixels row by row, the samples of a pixel together.
#[derive(Clone, Debug, PartialEq)]
pub enum Content<'a> {
    /// Whether each sample is covered. A comparison of equal masks shares them.
    Mask(Arc<Vec<bool>>),
    /// The visible primitive, `None` for nothing.
    Ids(Vec<Option<u64>>),
    /// The distance. A sample at a finite distance is covered: neither ±∞ nor NaN.
    Distances(Vec<f64>),
    /// The surface's normal, of any length; always one sample per pixel. A pixel is covered if its normal has a
    /// direction: neither zero, ±∞ nor NaN.
    Normals(Vec<[f32; 3]>),
    /// The colours; always one sample per pixel.
    Picture(Picture),
    /// All values of a frame: ids, distances, and the picture of its pixels.
    Frame(Seen<'a>),
}

/// A frame, and its [`picture`](crate::picture::picture).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen<'a> {
    pub(super) frame: &'a Frame,
    pub(super) picture: &'a RgbImage,
}

/// Colours, and the way in which they determine coverage.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Red, green, blue and alpha in sRGB as stored; not premultiplied.
    pub pixels: Pixels,
    /// The way in which the pixels determine coverage.
    pub covered: Covered,
}

/// Red, green, blue and alpha of each pixel, in steps of 1/255.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// Red, green and blue of 8 bits each, and no alpha: opaque.
    Opaque(Arc<RgbImage>),
    /// Four values of 8 bits each.
    Bytes(Vec<[u8; 4]>),
    /// Four values with a finer resolution than 8 bits.
    Steps(Vec<[f32; 4]>),
}

impl Pixels {
    /// The number of pixels.
    pub fn len(&self) -> usize {
        match self {
            Pixels::Opaque(_) => self.opaque().len(),
            Pixels::Bytes(pixels) => pixels.len(),
            Pixels::Steps(pixels) => pixels.len(),
        }
    }

    /// The colours of opaque pixels of 8 bits; none of others.
    pub(super) fn opaque(&self) -> &[[u8; 3]] {
        match self {
            Pixels::Opaque(pixels) => pixels.as_raw().as_chunks().0,
            _ => &[],
        }
    }

    /// Whether there are no pixels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The colour of a pixel.
    ///
    /// # Panics
    ///
    /// If the pixel does not exist.
    pub fn get(&self, pixel: usize) -> [f32; 4] {
        match self {
            Pixels::Opaque(_) => {
                let [red, green, blue] = self.opaque()[pixel];
                [red, green, blue, u8::MAX].map(f32::from)
            }
            Pixels::Bytes(pixels) => pixels[pixel].map(f32::from),
            Pixels::Steps(pixels) => pixels[pixel],
        }
    }

    /// Red, green and blue of a pixel, rounded to 8 bits.
    pub(super) fn rounded(&self, pixel: usize) -> [u8; 3] {
        match self {
            Pixels::Opaque(_) => self.opaque()[pixel],
            Pixels::Bytes(pixels) => {
                let [red, green, blue, _] = pixels[pixel];
                [red, green, blue]
            }
            Pixels::Steps(pixels) => {
                let [red, green, blue, _] = pixels[pixel];
                bytes([red, green, blue])
            }
        }
    }

    /// All pixels, in their order.
    pub fn iter(&self) -> impl Iterator<Item = [f32; 4]> {
        (0..self.len()).map(|pixel| self.get(pixel))
    }
}

/// The way in which a picture determines coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Covered {
    /// The picture does not determine coverage: it has colours alone.
    Unknown,
    /// A pixel is covered if alpha is more than zero.
    ByAlpha,
    /// A pixel of a grey picture is covered if it is not black.
    ByLight,
    /// A pixel is covered if its colour, rounded to 8 bits, is not this colour.
    ByBackground([u8; 3]),
}

impl<'a> Buffer<'a> {
    /// A buffer of `size` = `[W, H]` pixels with `samples`² samples in each.
    ///
    /// # Panics
    ///
    /// If the content has another number of values, or a picture or normals have more than one sample per pixel.
    pub fn new(size: [u32; 2], samples: u32, content: Content<'a>) -> Buffer<'a> {
        let expected = size.iter().map(|&side| side as usize).product::<usize>();
        let length = match &content {
            Content::Mask(values) => values.len(),
            Content::Ids(values) => values.len(),
            Content::Distances(values) => values.len(),
            Content::Normals(values) => {
                assert_eq!(samples, 1, "normals have one sample a pixel");
                values.len()
            }
            Content::Picture(picture) => {
                assert_eq!(samples, 1, "a picture has one sample a pixel");
                picture.pixels.len()
            }
            Content::Frame(seen) => seen.frame.ids().len(),
        };
        assert_eq!(length, expected * (samples as usize).pow(2), "the values do not fill the size");
        Buffer { size, origin: [0; 2], samples, content }
    }

    /// A buffer with the values of a frame, without a copy of the frame.
    ///
    /// # Panics
    ///
    /// If the picture and the frame have different sizes.
    pub fn of_frame(frame: &'a Frame, picture: &'a RgbImage) -> Buffer<'a> {
        let size = frame.image();
        assert_eq!(size, [picture.width(), picture.height()], "the picture shows another frame");
        let origin = frame.crop().map_or([0; 2], |crop| [crop.row, crop.column]);
        let content = Content::Frame(Seen { frame, picture });
        Buffer { size, origin, samples: frame.samples(), content }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The row and the column of the first pixel in the whole image; not 0 for a frame of a crop.
    pub fn origin(&self) -> [u32; 2] {
        self.origin
    }

    /// Samples along one side of a pixel.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// The same buffer with each sample as a pixel of its own: what a camera of so many more pixels sees. `None` for a
    /// frame.
    #[must_use]
    pub fn samples_as_pixels(&self) -> Option<Buffer<'a>> {
        let [width, height] = self.size;
        let n = self.samples;
        // The samples of a pixel are stored together.
        let order = || {
            (0..height * n).flat_map(move |row| {
                (0..width * n).map(move |column| {
                    let pixel = (row / n) as usize * width as usize + (column / n) as usize;
                    (pixel * n as usize + (row % n) as usize) * n as usize + (column % n) as usize
                })
            })
        };
        let content = match &self.content {
            Content::Mask(mask) => {
                let mask: Vec<bool> = order().map(|sample| mask[sample]).collect();
                Content::Mask(mask.into())
            }
            Content::Ids(ids) => Content::Ids(order().map(|sample| ids[sample]).collect()),
            Content::Distances(t) => Content::Distances(order().map(|sample| t[sample]).collect()),
            // These have one sample a pixel.
            Content::Normals(_) | Content::Picture(_) => self.content.clone(),
            Content::Frame(_) => return None,
        };
        Some(Buffer::new([width * n, height * n], 1, content))
    }

    /// The values of the buffer.
    pub fn content(&self) -> &Content<'a> {
        &self.content
    }

    /// Whether the buffer determines coverage.
    pub fn has_coverage(&self) -> bool {
        !matches!(&self.content, Content::Picture(picture) if picture.covered == Covered::Unknown)
    }

    /// Whether the buffer contains this aspect of its pixels.
    pub fn tells(&self, aspect: Aspect) -> bool {
        match (&self.content, aspect) {
            (_, Aspect::Coverage) => self.has_coverage(),
            // A frame keeps normals only on demand.
            (Content::Frame(_), aspect) => aspect != Aspect::Normals,
            (Content::Ids(_), Aspect::Ids)
            | (Content::Distances(_), Aspect::T)
            | (Content::Normals(_), Aspect::Normals)
            | (Content::Picture(_), Aspect::Color) => true,
            _ => false,
        }
    }

    /// The kind of the buffer, in the words of a message.
    pub fn kind(&self) -> &'static str {
        match &self.content {
            Content::Mask(_) => "mask",
            Content::Ids(_) => "ids",
            Content::Distances(_) => "distances t",
            Content::Normals(_) => "normals",
            Content::Picture(picture) => match picture.covered {
                Covered::Unknown => "picture without coverage",
                Covered::ByAlpha => "picture with alpha",
                Covered::ByLight => "grey picture",
                Covered::ByBackground(_) => "picture with a background",
            },
            Content::Frame(_) => "frame",
        }
    }

    /// The values of pixel `(i, j)` in a few words: `id 3`, `nothing`, `t 2.5`, `#c8553d`.
    ///
    /// # Panics
    ///
    /// If the pixel does not exist.
    pub fn seen(&self, [i, j]: [u32; 2]) -> String {
        let said: Vec<String> =
            self.samples_of([i, j]).map(|sample| self.seen_at(sample)).collect();
        let mut parts: Vec<String> = Vec::new();
        // The values in order, with equal neighbours counted: a pixel may have thousands of samples.
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
            Content::Normals(normals) if self.covered(sample) == Some(true) => {
                let [x, y, z] = normals[sample].map(|part| format!("{part:.4}"));
                format!("normal ({x} {y} {z})")
            }
            Content::Picture(picture) if self.covered(sample) != Some(false) => {
                color_text(picture.pixels.get(sample), picture.covered == Covered::ByAlpha)
            }
            Content::Frame(_) => self.id(sample).map_or_else(nothing, |id| format!("id {id}")),
            Content::Mask(_)
            | Content::Distances(_)
            | Content::Normals(_)
            | Content::Picture(_) => nothing(),
        }
    }

    /// The pixels of a picture of 8 bits that tells colours alone.
    pub(super) fn colors_alone(&self) -> Option<&[[u8; 3]]> {
        match &self.content {
            Content::Picture(Picture {
                pixels: pixels @ Pixels::Opaque(_),
                covered: Covered::Unknown,
            }) => Some(pixels.opaque()),
            _ => None,
        }
    }

    /// The number of a pixel, row by row.
    pub(super) fn pixel(&self, [i, j]: [u32; 2]) -> usize {
        i as usize * self.size[0] as usize + j as usize
    }

    /// The indices of the samples of a pixel. The other functions take these indices.
    pub(super) fn samples_of(&self, pixel: [u32; 2]) -> impl Iterator<Item = usize> + use<> {
        let n = self.samples as usize;
        // A frame stores rows of samples; a file stores the samples of a pixel together.
        let (first, stride) = match &self.content {
            Content::Frame(_) => {
                let stride = n * self.size[0] as usize;
                (n * (pixel[0] as usize * stride + pixel[1] as usize), stride)
            }
            _ => (self.pixel(pixel) * n * n, n),
        };
        (0..n).flat_map(move |row| (first + row * stride..).take(n))
    }

    /// All samples, pixel by pixel.
    pub(super) fn all_samples(&self) -> impl Iterator<Item = usize> {
        pixels(self.size).flat_map(|pixel| self.samples_of(pixel))
    }

    /// Whether a sample is covered; `None` if this is unknown.
    pub(super) fn covered(&self, sample: usize) -> Option<bool> {
        match &self.content {
            Content::Mask(mask) => Some(mask[sample]),
            Content::Ids(ids) => Some(ids[sample].is_some()),
            Content::Distances(t) => Some(t[sample].is_finite()),
            Content::Normals(normals) => Some(has_direction(normals[sample])),
            Content::Picture(picture) => picture.covered(sample),
            Content::Frame(seen) => Some(seen.frame.ids().is_covered(sample)),
        }
    }

    /// Whether any sample of each pixel is covered, row by row.
    pub(super) fn covered_pixels(&self) -> Cow<'_, [bool]> {
        if let (Content::Mask(mask), 1) = (&self.content, self.samples) {
            return Cow::Borrowed(mask);
        }
        let covers =
            |pixel| self.samples_of(pixel).any(|sample| self.covered(sample) == Some(true));
        Cow::Owned(pixels(self.size).map(covers).collect())
    }

    /// The primitive at a sample; `None` for nothing, and for an unknown primitive.
    pub(super) fn id(&self, sample: usize) -> Option<u64> {
        match &self.content {
            Content::Ids(ids) => ids[sample],
            Content::Frame(seen) => seen.frame.ids().get(sample),
            _ => None,
        }
    }

    /// The normal of a pixel; zero if the normal is unknown.
    pub(super) fn normal(&self, sample: usize) -> [f32; 3] {
        match &self.content {
            Content::Normals(normals) => normals[sample],
            _ => [0.0; 3],
        }
    }

    /// The distance at a covered sample; NaN if the distance is unknown.
    pub(super) fn t(&self, sample: usize) -> f64 {
        match &self.content {
            Content::Distances(t) => t[sample],
            Content::Frame(seen) => seen.frame.distances()[sample].into(),
            _ => f64::NAN,
        }
    }

    /// The colour of a pixel, and whether the colour has alpha; `None` if the colour is unknown, or the pixel is
    /// uncovered.
    pub(super) fn color(&self, pixel: [u32; 2]) -> Option<([f32; 4], bool)> {
        match &self.content {
            Content::Picture(picture) => {
                let (index, has_alpha) = (self.pixel(pixel), picture.covered == Covered::ByAlpha);
                let is_something = picture.covered(index) != Some(false);
                is_something.then(|| (picture.pixels.get(index), has_alpha))
            }
            Content::Frame(seen) => {
                let [red, green, blue] = seen.picture[(pixel[1], pixel[0])].0.map(f32::from);
                Some(([red, green, blue, 255.0], false))
            }
            _ => None,
        }
    }

    /// What lights a difference image: the picture of the buffer, if there is one.
    pub(super) fn difference_light(&self) -> Option<Arc<RgbImage>> {
        match &self.content {
            Content::Picture(Picture { pixels: Pixels::Opaque(pixels), .. }) => {
                Some(pixels.clone())
            }
            _ => self.light().map(Arc::new),
        }
    }

    /// The picture of the buffer, if there is one.
    pub(super) fn light(&self) -> Option<RgbImage> {
        let picture = match &self.content {
            Content::Picture(picture) => picture,
            Content::Frame(seen) => return Some(seen.picture.clone()),
            _ => return None,
        };
        let mut light = RgbImage::new(self.size[0], self.size[1]);
        let width = self.size[0] as usize;
        light.par_chunks_exact_mut(3 * width).enumerate().for_each(|(i, row)| {
            for (j, pixel) in row.as_chunks_mut().0.iter_mut().enumerate() {
                *pixel = picture.pixels.rounded(i * width + j);
            }
        });
        Some(light)
    }
}

impl Picture {
    pub(super) fn covered(&self, pixel: usize) -> Option<bool> {
        match self.covered {
            Covered::Unknown => None,
            Covered::ByAlpha => Some(self.pixels.get(pixel)[3] > 0.0),
            Covered::ByLight => Some(self.pixels.get(pixel)[0] != 0.0),
            Covered::ByBackground(background) => Some(self.pixels.rounded(pixel) != background),
        }
    }
}

fn has_direction(normal: [f32; 3]) -> bool {
    normal != [0.0; 3] && normal.iter().all(|part| part.is_finite())
}

/// The nearest 8-bit values.
pub(super) fn bytes<const N: usize>(steps: [f32; N]) -> [u8; N] {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "rounded, and clamped to a byte"
    )]
    steps.map(|step| step.round().clamp(0.0, 255.0) as u8)
}

/// A distance with just enough digits to distinguish it from its neighbours, as an `f32` if it is an `f32` number.
pub fn distance_text(t: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "only used if it changes nothing")]
    let single = t as f32;
    if f64::from(single) == t { single.to_string() } else { t.to_string() }
}

/// `#rrggbb`, or decimals if eight bits are not exact.
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
