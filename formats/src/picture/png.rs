//! Checks of the chunks of PNG files before decoding: the decoder panics on some palettes, and reports damage without
//! its place.

use super::problem::{Problem, ends_early};
use bothways_common::SizeError;
use std::io::{BufRead, Read, Seek, SeekFrom};

/// Bytes of the signature before the first chunk.
const SIGNATURE: u64 = 8;
/// The number of bytes in the chunk IHDR.
const HEADER: u32 = 13;
/// The most bytes of a palette: 256 colours.
const LARGEST_PALETTE: u32 = 3 * 256;

/// The most bytes that a byte of compressed pixels can stand for: 258 for two bits (RFC 1951, 3.2.5), and a little more at
/// the beginning.
const LONGEST_RUN: u64 = 1032;
/// The most pixels in a byte: those of one bit.
const PIXELS: u64 = 8;

/// Refuses a size that the file is far too short for, before memory is reserved for it.
pub(super) fn check_size([width, height]: [u32; 2], length: u64) -> Result<(), String> {
    if u64::from(width) * u64::from(height) > length.saturating_mul(LONGEST_RUN * PIXELS) {
        return Err(format!(
            "a PNG of {length} bytes cannot fill {width} x {height} pixels; copy it or save it again"
        ));
    }
    Ok(())
}

/// Walks through the chunks of a file of `file_length` bytes. The result says whether the pixels are colours of a
/// palette.
pub(super) fn check(input: &mut (impl BufRead + Seek), file_length: u64) -> Result<bool, Problem> {
    let mut at = input.seek(SeekFrom::Start(SIGNATURE))?;
    let mut found = Found::default();
    while at < file_length {
        let mut head = [0; 8];
        // Length, name and checksum.
        if file_length - at < 12 {
            return Err(Problem::Content(ends_early(file_length)));
        }
        input.read_exact(&mut head)?;
        let [a, b, c, d, name @ ..] = head;
        let (length, name) = (u32::from_be_bytes([a, b, c, d]), name);
        if !name.iter().all(u8::is_ascii_alphabetic) {
            return Err(Problem::Content(format!(
                "at byte {at} of the PNG no chunk begins, so the file is damaged; copy it or save it again"
            )));
        }
        if u64::from(length) > file_length - at - 12 {
            return Err(Problem::Content(ends_early(file_length)));
        }
        let (checksum, start) = checksum(input, name, length)?;
        let mut stated = [0; 4];
        input.read_exact(&mut stated)?;
        chunk(name, length, at, checksum == u32::from_be_bytes(stated))?;
        match &name {
            b"IHDR" if length == HEADER && at == SIGNATURE => found.header(start)?,
            b"PLTE" => found.palette = true,
            b"IDAT" => found.pixels()?,
            b"IEND" => {
                found.end()?;
                break;
            }
            _ => {}
        }
        at += 12 + u64::from(length);
    }
    Ok(found.needs_palette)
}

/// The checksum over a chunk's name and content, and the content's first bytes.
fn checksum(
    input: &mut (impl BufRead + Seek),
    name: [u8; 4],
    length: u32,
) -> Result<(u32, [u8; HEADER as usize]), Problem> {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&name);
    let mut content = input.by_ref().take(length.into());
    let (mut start, mut known) = ([0; HEADER as usize], 0);
    loop {
        let bytes = content.fill_buf()?;
        let count = bytes.len();
        if count == 0 {
            return Ok((hasher.finalize(), start));
        }
        hasher.update(bytes);
        let first = count.min(start.len() - known);
        start[known..known + first].copy_from_slice(&bytes[..first]);
        known += first;
        content.consume(count);
    }
}

/// The state of the check so far.
#[derive(Default)]
struct Found {
    /// Whether the header is read, and is of a kind that needs a palette.
    needs_palette: bool,
    palette: bool,
    any_pixels: bool,
}

impl Found {
    /// Checks size, bit depth and colour type in the encoding of PNG (ISO/IEC 15948, 11.2.1).
    fn header(&mut self, content: [u8; HEADER as usize]) -> Result<(), Problem> {
        let [a, b, c, d, e, f, g, h, depth, color, ..] = content;
        let (width, height) = (u32::from_be_bytes([a, b, c, d]), u32::from_be_bytes([e, f, g, h]));
        if width == 0 || height == 0 {
            return Err(SizeError::Empty { width, height }.into());
        }
        let depths: &[u8] = match color {
            0 => &[1, 2, 4, 8, 16],
            2 | 4 | 6 => &[8, 16],
            3 => &[1, 2, 4, 8],
            _ => {
                return Err(Problem::Content(format!(
                    "the header of the PNG has the colour type {color}, but only 0, 2, 3, 4 and 6 are known; \
                     save the picture again"
                )));
            }
        };
        if !depths.contains(&depth) {
            let known: Vec<String> = depths.iter().map(u8::to_string).collect();
            return Err(Problem::Content(format!(
                "the header of the PNG has the bit depth {depth}, but with colour type {color} only {} are \
                 known; save the picture again",
                known.join(", ")
            )));
        }
        self.needs_palette = color == 3;
        Ok(())
    }

    /// Checks that the pixels begin or continue here.
    fn pixels(&mut self) -> Result<(), Problem> {
        self.any_pixels = true;
        if self.needs_palette && !self.palette {
            return Err(Problem::Content(
                "the PNG has colour type 3, but no palette (no chunk PLTE) before its pixels; save the \
                 picture again"
                    .into(),
            ));
        }
        Ok(())
    }

    fn end(&self) -> Result<(), Problem> {
        if self.any_pixels {
            return Ok(());
        }
        Err(Problem::Content(
            "the PNG has no pixels (no chunk IDAT); copy the file or save it again".into(),
        ))
    }
}

/// Checks one chunk, and describes its error.
fn chunk(name: [u8; 4], length: u32, at: u64, is_intact: bool) -> Result<(), String> {
    let shown = String::from_utf8_lossy(&name);
    // If the first letter is small, the pixels do not need this chunk.
    if !is_intact && name[0].is_ascii_uppercase() {
        return Err(format!(
            "the chunk {shown} at byte {at} of the PNG has a wrong checksum, so the file is damaged; \
             copy it or save it again"
        ));
    }
    if &name == b"PLTE" && (length == 0 || !length.is_multiple_of(3) || length > LARGEST_PALETTE) {
        return Err(format!(
            "the palette (the chunk PLTE at byte {at} of the PNG) has {length} bytes; it must have 3 \
             for each of its 1 to 256 colours; save the picture again"
        ));
    }
    Ok(())
}
