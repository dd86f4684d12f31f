//! Values as bytes for the page's script: deflated, and written in Base64.

use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::{self, Write};

/// Numbers of one type in a row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Array {
    pub(super) kind: Kind,
    /// All numbers, little-endian.
    bytes: Vec<u8>,
}

/// The type of the elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    U8,
    U32,
    U64,
    F32,
    F64,
    /// Three `f32` an element.
    F32x3,
    /// Four bytes an element.
    U8x4,
    /// Four `f32` an element.
    F32x4,
}

impl Kind {
    /// The name that the script knows.
    pub(super) fn name(self) -> &'static str {
        match self {
            Kind::U8 => "u8",
            Kind::U32 => "u32",
            Kind::U64 => "u64",
            Kind::F32 => "f32",
            Kind::F64 => "f64",
            Kind::F32x3 => "f32x3",
            Kind::U8x4 => "u8x4",
            Kind::F32x4 => "f32x4",
        }
    }

    /// The bytes of an element.
    fn width(self) -> usize {
        match self {
            Kind::U8 => 1,
            Kind::U32 | Kind::F32 | Kind::U8x4 => 4,
            Kind::U64 | Kind::F64 => 8,
            Kind::F32x3 => 12,
            Kind::F32x4 => 16,
        }
    }
}

impl Array {
    /// An array of the little-endian bytes of its elements.
    pub(super) fn new<const N: usize>(
        kind: Kind,
        elements: impl Iterator<Item = [u8; N]>,
    ) -> Array {
        assert_eq!(kind.width(), N, "the elements have another type");
        Array { kind, bytes: elements.flatten().collect() }
    }

    /// Whether the page can tell this array by its difference from another one.
    pub(super) fn is_like(&self, other: &Array) -> bool {
        (self.kind, self.bytes.len()) == (other.kind, other.bytes.len())
    }

    /// Writes the array in Base64.
    ///
    /// Before deflating, the bytes are rearranged and made small, as in PNG: first come the lowest bytes of all
    /// elements, then the next ones, each less the byte at the same place in `base`, or less the one before it if
    /// there is no base. Renderings that mostly agree are mostly zeros in this way.
    pub(super) fn write(&self, base: Option<&Array>, out: &mut impl Write) -> io::Result<()> {
        let mut text = EncoderWriter::new(out, &STANDARD);
        let mut deflated = ZlibEncoder::new(&mut text, Compression::default());
        let width = self.kind.width();
        let mut plane = Vec::with_capacity(self.bytes.len() / width);
        for place in 0..width {
            let of = |bytes: &[u8], element: usize| bytes[element * width + place];
            plane.clear();
            plane.extend((0..self.bytes.len() / width).map(|element| {
                let expected = match base {
                    Some(base) => of(&base.bytes, element),
                    None if element == 0 => 0,
                    None => of(&self.bytes, element - 1),
                };
                of(&self.bytes, element).wrapping_sub(expected)
            }));
            deflated.write_all(&plane)?;
        }
        deflated.finish()?;
        text.finish()?;
        Ok(())
    }
}

/// Writes bytes in Base64.
pub(super) fn write_base64(bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
    let mut text = EncoderWriter::new(out, &STANDARD);
    text.write_all(bytes)?;
    text.finish()?;
    Ok(())
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use base64::Engine;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    /// The bytes of an array's elements, as the page's script finds them.
    pub(in crate::diff::page) fn read(text: &str, width: usize, base: Option<&[u8]>) -> Vec<u8> {
        let deflated = STANDARD.decode(text).unwrap();
        let mut planes = Vec::new();
        ZlibDecoder::new(&deflated[..]).read_to_end(&mut planes).unwrap();
        let elements = planes.len() / width;
        let mut bytes = vec![0_u8; planes.len()];
        for place in 0..width {
            let mut before = 0_u8;
            for element in 0..elements {
                let at = element * width + place;
                let expected = base.map_or(before, |base| base[at]);
                bytes[at] = planes[place * elements + element].wrapping_add(expected);
                before = bytes[at];
            }
        }
        bytes
    }

    #[test]
    fn an_array_can_be_read_back() {
        let numbers = [7_u32, 8, 300, 299, u32::MAX, 0];
        let others = numbers.map(|number| number.wrapping_add(number % 3));
        let [array, other] = [numbers, others]
            .map(|numbers| Array::new(Kind::U32, numbers.into_iter().map(u32::to_le_bytes)));
        let written = |array: &Array, base| {
            let mut text = Vec::new();
            array.write(base, &mut text).unwrap();
            String::from_utf8(text).unwrap()
        };
        assert!(array.is_like(&other));
        assert_eq!(read(&written(&array, None), 4, None), array.bytes);
        assert_eq!(read(&written(&other, Some(&array)), 4, Some(&array.bytes)), other.bytes);
    }

    #[test]
    fn equal_arrays_take_no_room() {
        let mixed = |number: u32| {
            let mixed = number.wrapping_mul(0x9e37_79b9);
            (mixed ^ (mixed >> 15)).wrapping_mul(0x2c1b_3c6d)
        };
        let noise = (0..10_000).map(|number| mixed(number).to_le_bytes());
        let array = Array::new(Kind::U32, noise);
        let length = |base| {
            let mut text = Vec::new();
            array.write(base, &mut text).unwrap();
            text.len()
        };
        assert!(length(None) > 20_000);
        assert!(length(Some(&array)) < 200);
    }
}
