//! NumPy arrays of any origin: every shape, order and number type of pixels.

use super::normals::are_normals;
use super::read_buffer::{ReadBuffer, ReadOptions};
use super::{Buffer, Content, Covered, Picture, Pixels};
use crate::common::raster::{MAX_SAMPLES, check_samples};
use crate::formats::picture::{Problem, ends_early};
use crate::formats::source::quote::shown;
use half::f16;
use npyz::{DType, Endianness, NpyHeader, Order, TypeChar};
use std::borrow::Cow;
use std::io::Read;

/// The first bytes of every NPY file.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";
/// The most brackets in a header, and the deepest nesting, far more than the dtype of a picture needs. The reader of
/// the header takes time that is exponential in the depth.
const MAX_BRACKETS: usize = 64;
const MAX_DEPTH: usize = 8;
/// The most bytes of a header: NumPy itself refuses longer headers by default.
const MAX_HEADER: usize = 10_000;

const NOT_NORMALS: &str = "normals are arrays of floats of the shape H x W x 3; save them like that, or leave --normals out";

/// Reads an array: a mask, ids, distances or colours, by shape and number type.
pub(super) fn read(
    mut input: impl Read,
    length: u64,
    options: &ReadOptions,
) -> Result<ReadBuffer, Problem> {
    let start = header_bytes(&mut input, length)?;
    let header = header(&start)?;
    let number = Number::of(&header.dtype())?;
    let layout = Layout::of(&header)?;
    check_samples(layout.size, layout.samples)?;
    let needed = header.shape().iter().product::<u64>() * number.bytes as u64;
    let there = length.saturating_sub(start.len() as u64);
    if there < needed {
        return Err(Problem::Content(format!(
            "the file ends early: it has {there} of the {needed} bytes of its array; write it again"
        )));
    }
    let mut bytes = reserved(needed)?;
    if input.take(needed).read_to_end(&mut bytes)? as u64 != needed {
        return Err(Problem::Content(ends_early(length)));
    }
    let values = Values::new(&bytes, number, &header, layout.size);
    let content = match layout.channels {
        3 if options.normals || are_normals(values.vectors()) => {
            Content::Normals(values.normals()?)
        }
        _ if options.normals => return Err(Problem::Content(NOT_NORMALS.into())),
        1 => values.content()?,
        channels => Content::Picture(values.picture(channels, options.background)?),
    };
    Ok(Buffer::new(layout.size, layout.samples, content).into())
}

/// Room for `bytes` bytes of a file, if the memory suffices.
fn reserved(bytes: u64) -> Result<Vec<u8>, String> {
    let mut room = Vec::new();
    match usize::try_from(bytes).is_ok_and(|bytes| room.try_reserve_exact(bytes).is_ok()) {
        true => Ok(room),
        false => Err(format!("there is no memory for its {bytes} bytes; compare parts of it")),
    }
}

/// The header at the beginning of a file: the magic, two bytes of version, the length of the text, and the text of
/// that length.
fn header_bytes(input: &mut impl Read, length: u64) -> Result<Vec<u8>, Problem> {
    let mut start = Vec::new();
    let mut take = |bytes: usize, start: &mut Vec<u8>| -> Result<(), Problem> {
        let read = input.by_ref().take(bytes as u64).read_to_end(start)?;
        if read == bytes { Ok(()) } else { Err(Problem::Content(ends_early(length))) }
    };
    take(10, &mut start)?;
    let bytes = match start[6] {
        1 => usize::from(u16::from_le_bytes([start[8], start[9]])),
        2 | 3 => {
            take(2, &mut start)?;
            let bytes = u32::from_le_bytes([start[8], start[9], start[10], start[11]]);
            usize::try_from(bytes).unwrap_or(usize::MAX)
        }
        version => {
            return Err(Problem::Content(format!(
                "arrays of version {version} are not read; save it with numpy.save"
            )));
        }
    };
    if bytes > MAX_HEADER {
        return Err(Problem::Content(format!(
            "the header of its array has {bytes} bytes, more than the {MAX_HEADER} that any array of \
             numbers needs; save it with numpy.save"
        )));
    }
    take(bytes, &mut start)?;
    Ok(start)
}

/// Reads a header, and refuses headers that the library fails on: deeply nested brackets, and shapes with more
/// numbers than memory.
fn header(bytes: &[u8]) -> Result<NpyHeader, String> {
    let begin = if bytes[6] == 1 { 10 } else { 12 };
    let text = String::from_utf8_lossy(&bytes[begin..]).into_owned();
    // An array of numbers has one pair of brackets for its dictionary and one for its shape.
    if text.matches(['(', '[', '{']).count() > MAX_BRACKETS || depth(&text) > MAX_DEPTH {
        return Err("the array's dtype has too many parts; save an array of plain numbers".into());
    }
    let text = match shape(&text) {
        Some((before, shape, after)) => format!("{before}{}{after}", checked(shape)?),
        None => text,
    };
    let length = u32::try_from(text.len()).map_err(|error| error.to_string())?;
    // Version 2 is version 1 with more room; version 3 allows all letters.
    let version = if bytes[6] == 3 { 3 } else { 2 };
    let again = [MAGIC, &[version, 0], &length.to_le_bytes(), text.as_bytes()].concat();
    NpyHeader::from_reader(&again[..]).map_err(|_| {
        format!(
            "the header of its array, from byte {begin} on, is none that NumPy writes ({}); save it \
             with numpy.save",
            shown(text.trim())
        )
    })
}

/// The depth of nested brackets.
fn depth(text: &str) -> usize {
    let mut depths = text.chars().scan(0_usize, |depth, letter| {
        match letter {
            '(' | '[' | '{' => *depth += 1,
            ')' | ']' | '}' => *depth = depth.saturating_sub(1),
            _ => {}
        }
        Some(*depth)
    });
    depths.by_ref().max().unwrap_or(0)
}

/// The text before the sides of a shape, the sides, and the text after the sides.
fn shape(header: &str) -> Option<(&str, &str, &str)> {
    let key = header.find("'shape'").or_else(|| header.find("\"shape\""))?;
    let begin = key + header[key..].find('(')? + 1;
    let end = begin + header[begin..].find(')')?;
    Some((&header[..begin], &header[begin..end], &header[end..]))
}

/// The sides of a shape without the `L` that Python 2 put after long numbers.
fn checked(shape: &str) -> Result<Cow<'_, str>, String> {
    let sides: Vec<&str> = shape.split(',').map(str::trim).collect();
    let plain: Vec<&str> =
        sides.iter().map(|side| side.strip_suffix('L').unwrap_or(side)).collect();
    let mut count = 1_u64;
    for side in plain.iter().filter(|side| !side.is_empty()) {
        let digits = side.bytes().all(|byte| byte.is_ascii_digit());
        if !digits {
            return Err(format!(
                "the array has the shape ({}), where {} is no number of rows, columns or samples; \
                 save it with numpy.save",
                shown(shape),
                shown(side)
            ));
        }
        // The check of the size handles a side of 0.
        count = count.saturating_mul(side.parse::<u64>().unwrap_or(u64::MAX).max(1));
    }
    if count > 4 * MAX_SAMPLES {
        return Err(format!(
            "the array has the shape ({}), more than {MAX_SAMPLES} samples (2^30); compare smaller \
             pictures, or parts",
            shown(shape)
        ));
    }
    Ok(if plain == sides { Cow::Borrowed(shape) } else { Cow::Owned(plain.join(", ")) })
}

/// The mapping from the axes of an array to pixels, samples and channels.
struct Layout {
    size: [u32; 2],
    samples: u32,
    channels: usize,
}

impl Layout {
    fn of(header: &NpyHeader) -> Result<Layout, String> {
        // A side that does not fit is too large, and the size check refuses it.
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
                shown(&dtype.descr())
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

    /// Whether an integer of this type is negative.
    fn is_negative(self, bits: u64) -> bool {
        self.kind == TypeChar::Int && bits >> (8 * self.bytes - 1) == 1
    }

    fn all_ones(self) -> u64 {
        u64::MAX >> (64 - 8 * self.bytes)
    }

    fn float(self, bits: u64) -> f64 {
        const READ: &str = "no more bytes were read";
        match self.bytes {
            2 => f16::from_bits(bits.try_into().expect(READ)).to_f64(),
            4 => f64::from(f32::from_bits(bits.try_into().expect(READ))),
            _ => f64::from_bits(bits),
        }
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
    ) -> Values<'a> {
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
        Values { bytes, number, shape, strides, width: width as usize }
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

    /// The content of an array with one value per sample.
    fn content(&self) -> Result<Content<'static>, String> {
        let number = self.number;
        Ok(match number.kind {
            TypeChar::Bool => {
                Content::Mask(self.bits().map(|bits| bits != 0).collect::<Vec<_>>().into())
            }
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
        Ok(Picture { pixels: Pixels::Steps(pixels), covered })
    }

    /// The vectors of an array of floats; nothing for other numbers.
    fn vectors(&self) -> impl Iterator<Item = [f32; 3]> {
        let is_float = self.number.kind == TypeChar::Float;
        #[expect(clippy::cast_possible_truncation, reason = "far finer than the tolerance")]
        let mut values =
            self.bits().take_while(move |_| is_float).map(|bits| self.number.float(bits) as f32);
        std::iter::from_fn(move || Some([values.next()?, values.next()?, values.next()?]))
    }

    fn normals(&self) -> Result<Vec<[f32; 3]>, String> {
        match self.number.kind {
            TypeChar::Float => Ok(self.vectors().collect()),
            _ => Err(NOT_NORMALS.into()),
        }
    }

    /// The pixel of a value, for a message.
    fn pixel(&self, index: usize) -> String {
        let per_pixel: usize = self.shape[2..].iter().product();
        let pixel = index / per_pixel;
        format!("({}, {})", pixel / self.width, pixel % self.width)
    }
}
