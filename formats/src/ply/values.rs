//! Reads the values after the header of a PLY file, one after another, in any encoding.

use super::error::{ElementFault, Location};
use super::header::{Encoding, Header, ScalarType};
use crate::source::decimal;
use crate::source::quote::{quote, shown};
use std::io::{self, BufRead, ErrorKind, Seek};

/// Why a value could not be read.
pub(super) enum ValueError {
    Io(io::Error),
    /// The input has ended.
    End,
    Fault(ElementFault),
}

impl From<ElementFault> for ValueError {
    fn from(fault: ElementFault) -> ValueError {
        ValueError::Fault(fault)
    }
}

impl From<io::Error> for ValueError {
    fn from(error: io::Error) -> ValueError {
        if error.kind() == ErrorKind::UnexpectedEof {
            ValueError::End
        } else {
            ValueError::Io(error)
        }
    }
}

/// Reads values from an input whose header has been read.
pub(super) struct ValueReader<'a, R> {
    input: &'a mut R,
    encoding: Encoding,
    /// The number of bytes before the next value.
    position: u64,
    /// The line of the next value, counted from 1.
    line: u64,
    /// The number of bytes of the whole input.
    length: u64,
    /// The last word of an ASCII file.
    word: Vec<u8>,
    /// The last indices that were read, of an element that has a list of them.
    pub(super) indices: Vec<u32>,
}

/// The most bytes of a word. No number needs more: longer words are not numbers.
const MOST_BYTES_A_WORD: usize = 1024;

impl<'a, R: BufRead + Seek> ValueReader<'a, R> {
    pub(super) fn new(input: &'a mut R, header: &Header, length: u64) -> Self {
        let (encoding, position, line) = (header.encoding, header.bytes, header.lines + 1);
        let (word, indices) = (Vec::new(), Vec::new());
        ValueReader { input, encoding, position, line, length, word, indices }
    }

    /// The location of the next value.
    pub(super) fn location(&self) -> Location {
        match self.encoding {
            Encoding::Ascii => Location::Line(self.line),
            Encoding::LittleEndian | Encoding::BigEndian => Location::Byte(self.position),
        }
    }

    /// Skips `count` binary elements of `stride` bytes each, without reading them. Returns the number of skipped elements,
    /// which is less than `count` if the input ends before the last one.
    pub(super) fn skip(&mut self, count: u64, stride: usize) -> io::Result<u64> {
        let stride = stride as u64;
        let whole = (self.length.saturating_sub(self.position) / stride).min(count);
        let bytes = whole * stride;
        let offset = i64::try_from(bytes).map_err(io::Error::other)?;
        self.input.seek_relative(offset)?;
        self.position += bytes;
        Ok(whole)
    }

    /// The next bytes, as many as are in memory; at least one, unless the input has ended.
    pub(super) fn in_memory(&mut self) -> io::Result<&[u8]> {
        self.input.fill_buf()
    }

    /// Moves behind some of the bytes that are [in memory](Self::in_memory).
    pub(super) fn consume(&mut self, bytes: usize) {
        self.input.consume(bytes);
        self.position += bytes as u64;
    }

    /// Tells whether elements of equal size can be skipped.
    pub(super) fn is_binary(&self) -> bool {
        self.encoding != Encoding::Ascii
    }

    /// Moves to the line of the next element, over blank lines.
    pub(super) fn begin_element(&mut self) -> Result<(), ValueError> {
        while self.encoding == Encoding::Ascii && self.at_line_end()? == Some(true) {
            self.line += 1;
        }
        Ok(())
    }

    /// Makes sure that the line ends after an element.
    pub(super) fn end_element(&mut self) -> Result<(), ValueError> {
        if self.encoding != Encoding::Ascii {
            return Ok(());
        }
        match self.at_line_end()? {
            Some(false) => {
                self.next_word()?;
                Err(ElementFault::LineTooLong { text: quote(&self.word) }.into())
            }
            Some(true) => {
                self.line += 1;
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// Tells whether nothing follows but blank lines.
    pub(super) fn at_end(&mut self) -> Result<bool, ValueError> {
        self.begin_element()?;
        Ok(self.input.fill_buf()?.is_empty())
    }

    /// Reads a value as the nearest `f32`, which must be finite. Messages call the coordinate `name`.
    pub(super) fn coordinate(&mut self, name: &str, scalar: ScalarType) -> Result<f32, ValueError> {
        let (rounded, value) = self.number(scalar)?;
        if rounded.is_finite() {
            return Ok(rounded);
        }
        let (is_ascii, name) = (self.encoding == Encoding::Ascii, shown(name));
        let text = if is_ascii { quote(&self.word) } else { value.to_string() };
        // A word may be out of the range of `f64`, too.
        let has_digits = is_ascii && self.word.iter().any(u8::is_ascii_digit);
        Err(if value.is_finite() || has_digits {
            ElementFault::OutOfRange { name, text }
        } else {
            ElementFault::NotFinite { name, text }
        }
        .into())
    }

    /// Reads a value. Returns it rounded once to `f32`, and as an `f64` for messages.
    fn number(&mut self, scalar: ScalarType) -> Result<(f32, f64), ValueError> {
        #[expect(clippy::cast_possible_truncation, reason = "to the nearest, once")]
        #[expect(clippy::cast_precision_loss, reason = "to the nearest, once")]
        Ok(match (self.encoding, scalar) {
            (Encoding::Ascii, _) => {
                self.next_word()?;
                let rounded = decimal::nearest(&self.word)
                    .ok_or_else(|| ElementFault::NotANumber { text: quote(&self.word) })?;
                (rounded, rounded.into())
            }
            (_, ScalarType::F32) => {
                let value = f32::from_bits(u32::from_le_bytes(self.bytes()?));
                (value, value.into())
            }
            (_, ScalarType::F64) => {
                let value = f64::from_bits(u64::from_le_bytes(self.bytes()?));
                (value as f32, value)
            }
            (_, integer) => {
                let value = self.integer(integer)?;
                (value as f32, value as f64)
            }
        })
    }

    /// Reads a value of an integer type.
    pub(super) fn integer(&mut self, scalar: ScalarType) -> Result<i64, ValueError> {
        if self.encoding == Encoding::Ascii {
            return self.ascii_integer(scalar);
        }
        Ok(match scalar {
            ScalarType::I8 => i8::from_le_bytes(self.bytes()?).into(),
            ScalarType::U8 => u8::from_le_bytes(self.bytes()?).into(),
            ScalarType::I16 => i16::from_le_bytes(self.bytes()?).into(),
            ScalarType::U16 => u16::from_le_bytes(self.bytes()?).into(),
            ScalarType::I32 => i32::from_le_bytes(self.bytes()?).into(),
            ScalarType::U32 => u32::from_le_bytes(self.bytes()?).into(),
            ScalarType::F32 | ScalarType::F64 => unreachable!("the header was checked"),
        })
    }

    /// Reads a value that need not be finite as the nearest `f32`.
    pub(super) fn component(&mut self, scalar: ScalarType) -> Result<f32, ValueError> {
        // A value that is not needed must be a number, too: otherwise the header does not fit the file.
        self.number(scalar).map(|(rounded, _)| rounded)
    }

    /// Reads a whole number in an ASCII file.
    fn ascii_integer(&mut self, scalar: ScalarType) -> Result<i64, ValueError> {
        self.next_word()?;
        let range = match scalar {
            ScalarType::I8 => i8::MIN.into()..=i8::MAX.into(),
            ScalarType::U8 => 0..=u8::MAX.into(),
            ScalarType::I16 => i16::MIN.into()..=i16::MAX.into(),
            ScalarType::U16 => 0..=u16::MAX.into(),
            ScalarType::I32 => i32::MIN.into()..=i32::MAX.into(),
            ScalarType::U32 => 0..=u32::MAX.into(),
            ScalarType::F32 | ScalarType::F64 => unreachable!("the header was checked"),
        };
        let parsed: Option<i64> =
            str::from_utf8(&self.word).ok().and_then(|word| word.parse().ok());
        // A negative number passes for every type: the message about a negative index is the better one.
        let fits = |value: &i64| *value < 0 || range.contains(value);
        let value = parsed.filter(fits);
        Ok(value.ok_or_else(|| ElementFault::NotAnInteger { text: quote(&self.word) })?)
    }

    /// Reads the bytes of a value, and returns them with the least significant byte first.
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], ValueError> {
        let mut bytes = [0; N];
        self.input.read_exact(&mut bytes)?;
        self.position += N as u64;
        if self.encoding == Encoding::BigEndian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// Reads the next word of the line into `self.word`.
    fn next_word(&mut self) -> Result<(), ValueError> {
        match self.at_line_end()? {
            Some(true) => return Err(ElementFault::LineTooShort.into()),
            Some(false) => {}
            None => return Err(ValueError::End),
        }
        self.word.clear();
        loop {
            let bytes = self.input.fill_buf()?;
            let end = bytes.iter().position(u8::is_ascii_whitespace);
            let part = &bytes[..end.unwrap_or(bytes.len())];
            let room = MOST_BYTES_A_WORD + 1 - self.word.len();
            self.word.extend_from_slice(&part[..part.len().min(room)]);
            let taken = part.len();
            let ended = end.is_some() || bytes.is_empty();
            self.input.consume(taken);
            if self.word.len() > MOST_BYTES_A_WORD {
                return Err(ElementFault::NotANumber { text: quote(&self.word) }.into());
            }
            if ended {
                return Ok(());
            }
        }
    }

    /// Skips blanks, and the end of the line if it follows. Tells whether the line has ended; `None` at the end of the
    /// input.
    fn at_line_end(&mut self) -> Result<Option<bool>, ValueError> {
        loop {
            let bytes = self.input.fill_buf()?;
            let Some(&first) = bytes.first() else { return Ok(None) };
            match first {
                b'\n' => {
                    self.input.consume(1);
                    return Ok(Some(true));
                }
                b' ' | b'\t' | b'\r' => self.input.consume(1),
                _ => return Ok(Some(false)),
            }
        }
    }
}
