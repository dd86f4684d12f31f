//! What PNG files are made of, checked before they are decoded: the decoder panics on some palettes, and
//! names damages without their place.

use super::problem::{Problem, ends_early};
use std::io::{BufRead, Read, Seek, SeekFrom};

/// Bytes of the signature before the first chunk.
const SIGNATURE: u64 = 8;
/// The most bytes of a palette: 256 colours.
const LARGEST_PALETTE: u32 = 3 * 256;

/// Walks through the chunks of a file of so many bytes.
pub(super) fn check(input: &mut (impl BufRead + Seek), file_length: u64) -> Result<(), Problem> {
    let mut at = input.seek(SeekFrom::Start(SIGNATURE))?;
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
        let checksum = checksum(input, name, length)?;
        let mut stated = [0; 4];
        input.read_exact(&mut stated)?;
        chunk(name, length, at, checksum == u32::from_be_bytes(stated))?;
        if &name == b"IEND" {
            return Ok(());
        }
        at += 12 + u64::from(length);
    }
    Ok(())
}

/// The checksum over a chunk's name and content.
fn checksum(input: &mut (impl BufRead + Seek), name: [u8; 4], length: u32) -> Result<u32, Problem> {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&name);
    let mut content = input.by_ref().take(length.into());
    loop {
        let bytes = content.fill_buf()?;
        let count = bytes.len();
        if count == 0 {
            return Ok(hasher.finalize());
        }
        hasher.update(bytes);
        content.consume(count);
    }
}

/// Says what is wrong with a chunk.
fn chunk(name: [u8; 4], length: u32, at: u64, is_intact: bool) -> Result<(), String> {
    let shown = String::from_utf8_lossy(&name);
    // A small first letter: nobody needs this chunk for the pixels.
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
