//! NumPy arrays of any origin: every shape, order and number type that pixels come in.

use super::read::Problem;
use super::{Buffer, Content, Covered, Picture};
use crate::common::camera::{MAX_SAMPLES, check_samples};
use npyz::{DType, Endianness, NpyHeader, Order, TypeChar};

/// The first bytes of every such file.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";
/// Brackets in a header, far more than a structured dtype of a picture would need.
const MAX_BRACKETS: usize = 64;

/// Reads an array: a mask, ids, distances or colours, by shape and number type.
pub(super) fn read(bytes: &[u8], background: Option<[u8; 3]>) -> Result<Buffer, Problem> {
    check_header(bytes)?;
    let mut rest = bytes;
    let header = NpyHeader::from_reader(&mut rest)
        .map_err(|error| format!("the header of the array cannot be read: {error}"))?;
    let number = Number::of(&header.dtype())?;
    let layout = Layout::of(&header)?;
    check_samples(layout.size, layout.samples)?;
    let values = Values::new(rest, number, &header, layout.size)?;
    let content = match layout.channels {
        1 => values.content()?,
        channels => Content::Picture(values.picture(channels, background)?),
    };
    Ok(Buffer::new(layout.size, layout.samples, content))
}

/// Refuses what the header's reader would stumble over: shapes with more numbers than memory, and
/// brackets within brackets.
fn check_header(bytes: &[u8]) -> Result<(), String> {
    let header = header_text(bytes).ok_or("the file ends within the header of its array")?;
    // An array of numbers has a pair for its dictionary and one for its shape.
    if header.matches(['(', '[', '{']).count() > MAX_BRACKETS {
        return Err("the array's dtype has too many parts; save an array of plain numbers".into());
    }
    let shape = header.split_once("shape").and_then(|(_, rest)| rest.split_once('('));
    let Some((shape, _)) = shape.and_then(|(_, rest)| rest.split_once(')')) else {
        return Ok(());
    };
    let sides = shape.split(',').map(str::trim).filter(|side| !side.is_empty());
    // A side of 0 is left to the check of the size.
    let count = sides.map(|side| side.parse::<u64>().unwrap_or(u64::MAX).max(1));
    match count.fold(1, u64::saturating_mul) {
        count if count > 4 * MAX_SAMPLES => Err(format!(
            "the array has the shape ({shape}), more than {MAX_SAMPLES} samples (2^30); \
             compare smaller pictures, or parts"
        )),
        _ => Ok(()),
    }
}

/// The header as text: after the magic and two bytes of version come its length, then itself.
fn header_text(bytes: &[u8]) -> Option<String> {
    let (start, length) = match *bytes.get(6..12)? {
        [1, _, low, high, ..] => (10, usize::from(u16::from_le_bytes([low, high]))),
        [_, _, a, b, c, d] => (12, usize::try_from(u32::from_le_bytes([a, b, c, d])).ok()?),
        _ => return None,
    };
    let header = bytes.get(start..)?.get(..length)?;
    Some(String::from_utf8_lossy(header).into_owned())
}

/// How the axes of an array become pixels, samples and channels.
struct Layout {
    size: [u32; 2],
    samples: u32,
    channels: usize,
}

impl Layout {
    fn of(header: &NpyHeader) -> Result<Layout, String> {
        // What does not fit is too large, and refused as such.
        let side = |length: u64| u32::try_from(length).unwrap_or(u32::MAX);
        let (height, width, samples, channels) = match *header.shape() {
            [height, width] => (height, width, 1, 1),
            [height, width, 1] => (height, width, 1, 1),
            [height, width, 3] => (height, width, 1, 3),
            [height, width, 4] => (height, width, 1, 4),
            [height, width, n, m] if n == m => (height, width, n, 1),
            _ => {
                return Err(format!(
                    "the array has the shape {:?}; pixels are H x W, samples H x W x N x N, \
                     colours H x W x 3 or H x W x 4, rows first",
                    header.shape()
                ));
            }
        };
        Ok(Layout { size: [side(width), side(height)], samples: side(samples), channels })
    }
}

/// A number type.
#[derive(Clone, Copy, Debug)]
struct Number {
    kind: TypeChar,
    bytes: usize,
    big_endian: bool,
}

impl Number {
    fn of(dtype: &DType) -> Result<Number, String> {
        let refused = || {
            Err(format!(
                "the array's dtype is {}; save it as bool, as integers of up to 64 bits, or as \
                 float16, float32 or float64, with array.astype",
                dtype.descr()
            ))
        };
        let DType::Plain(plain) = dtype else { return refused() };
        let (kind, bytes) = (plain.type_char(), plain.num_bytes().unwrap_or(0));
        match (kind, bytes) {
            (TypeChar::Bool, 1)
            | (TypeChar::Int | TypeChar::Uint, 1 | 2 | 4 | 8)
            | (TypeChar::Float, 2 | 4 | 8) => {
                Ok(Number { kind, bytes, big_endian: plain.endianness() == Endianness::Big })
            }
            _ => refused(),
        }
    }

    fn name(self) -> String {
        let bits = 8 * self.bytes;
        match self.kind {
            TypeChar::Bool => "bool".into(),
            TypeChar::Int => format!("int{bits}"),
            TypeChar::Uint => format!("uint{bits}"),
            _ => format!("float{bits}"),
        }
    }

    /// The bits of a value, the highest first.
    fn bits(self, bytes: &[u8]) -> u64 {
        let push = |bits: u64, byte: &u8| bits << 8 | u64::from(*byte);
        if self.big_endian { bytes.iter().fold(0, push) } else { bytes.iter().rev().fold(0, push) }
    }

    /// An integer of this type, and whether it is negative.
    fn is_negative(self, bits: u64) -> bool {
        self.kind == TypeChar::Int && bits >> (8 * self.bytes - 1) == 1
    }

    fn all_ones(self) -> u64 {
        u64::MAX >> (64 - 8 * self.bytes)
    }

    fn float(self, bits: u64) -> f64 {
        let low = |bits: u64| u32::try_from(bits).expect("no more bytes were read");
        match self.bytes {
            2 => half(low(bits)),
            4 => f64::from(f32::from_bits(low(bits))),
            _ => f64::from_bits(bits),
        }
    }
}

/// A number of 16 bits: one for the sign, five for the exponent, ten for the fraction (IEEE 754).
fn half(bits: u32) -> f64 {
    let (exponent, fraction) = (bits >> 10 & 31, f64::from(bits & 1023));
    let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
    // Every product here is exact.
    sign * match exponent {
        0 => fraction * 2.0_f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1024.0 + fraction) * 2.0_f64.powi(i32::try_from(exponent).expect("5 bits") - 25),
    }
}

/// The numbers of an array in the order of pixels: rows, columns, samples or channels.
struct Values<'a> {
    bytes: &'a [u8],
    number: Number,
    shape: Vec<usize>,
    strides: Vec<usize>,
    width: usize,
}

impl<'a> Values<'a> {
    fn new(
        bytes: &'a [u8],
        number: Number,
        header: &NpyHeader,
        [width, _]: [u32; 2],
    ) -> Result<Values<'a>, String> {
        let index = |length: &u64| usize::try_from(*length).expect("checked to be at most 2^32");
        let shape: Vec<usize> = header.shape().iter().map(index).collect();
        let mut strides = vec![1; shape.len()];
        match header.order() {
            Order::C => (0..shape.len() - 1)
                .rev()
                .for_each(|axis| strides[axis] = strides[axis + 1] * shape[axis + 1]),
            Order::Fortran => (1..shape.len())
                .for_each(|axis| strides[axis] = strides[axis - 1] * shape[axis - 1]),
        }
        let needed = shape.iter().product::<usize>() * number.bytes;
        if bytes.len() < needed {
            return Err(format!(
                "the file ends early: it has {} of the {needed} bytes of its array; \
                 write it again",
                bytes.len()
            ));
        }
        Ok(Values { bytes, number, shape, strides, width: width as usize })
    }

    fn bits(&self) -> impl Iterator<Item = u64> {
        let count: usize = self.shape.iter().product();
        (0..count).map(|mut index| {
            // The last axis is the fastest in the order of pixels.
            let mut place = 0;
            for (length, stride) in self.shape.iter().zip(&self.strides).rev() {
                place += index % length * stride;
                index /= length;
            }
            let start = place * self.number.bytes;
            self.number.bits(&self.bytes[start..start + self.number.bytes])
        })
    }

    /// One value a sample.
    fn content(&self) -> Result<Content, String> {
        let number = self.number;
        Ok(match number.kind {
            TypeChar::Bool => Content::Mask(self.bits().map(|bits| bits != 0).collect()),
            TypeChar::Float => {
                Content::Distances(self.bits().map(|bits| number.float(bits)).collect())
            }
            _ => Content::Ids(self.ids()?),
        })
    }

    fn ids(&self) -> Result<Vec<Option<u64>>, String> {
        let id = |(index, bits): (usize, u64)| match bits {
            bits if bits == self.number.all_ones() => Ok(None),
            bits if self.number.is_negative(bits) => Err(format!(
                "the id at {} is negative; ids count from 0, and -1 is nothing",
                self.pixel(index)
            )),
            bits => Ok(Some(bits)),
        };
        self.bits().enumerate().map(id).collect()
    }

    fn picture(&self, channels: usize, background: Option<[u8; 3]>) -> Result<Picture, String> {
        let number = self.number;
        let white = match (number.kind, number.bytes) {
            (TypeChar::Uint, 1) => 255.0,
            (TypeChar::Uint, 2) => 65_535.0,
            (TypeChar::Float, _) => 1.0,
            _ => {
                return Err(format!(
                    "the array holds colours as {}; save them as uint8, uint16, or floats \
                     from 0 to 1",
                    number.name()
                ));
            }
        };
        let mut pixels = vec![[0.0, 0.0, 0.0, 255.0]; self.shape[0] * self.shape[1]];
        for (index, bits) in self.bits().enumerate() {
            #[expect(clippy::cast_precision_loss, reason = "at most 16 bits of an integer")]
            let value =
                if number.kind == TypeChar::Float { number.float(bits) } else { bits as f64 };
            #[expect(clippy::cast_possible_truncation, reason = "far finer than the tolerance")]
            let steps = (value * 255.0 / white) as f32;
            if !steps.is_finite() {
                return Err(format!(
                    "the colour at {} is {value}; colours are finite, from 0 (black) to 1",
                    self.pixel(index)
                ));
            }
            pixels[index / channels][index % channels] = steps;
        }
        let covered = match (channels, background) {
            (4, _) => Covered::ByAlpha,
            (_, Some(background)) => Covered::ByBackground(background),
            (_, None) => Covered::Unknown,
        };
        Ok(Picture { pixels, covered })
    }

    /// The pixel of a value, for a message.
    fn pixel(&self, index: usize) -> String {
        let per_pixel: usize = self.shape[2..].iter().product();
        let pixel = index / per_pixel;
        format!("({}, {})", pixel / self.width, pixel % self.width)
    }
}
