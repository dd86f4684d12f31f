//! Checks of JPEG files: the decoder fills what is missing with grey, and says nothing.

use super::problem::{Problem, ends_early};
use std::io::{BufRead, Seek};

/// The most pixels that a byte can stand for: 8 blocks of 8 × 8 pixels of one bit each, twice.
const LONGEST_RUN: u64 = 1024;

/// Refuses a file whose data does not end as it must.
pub(super) fn check(input: &mut (impl BufRead + Seek), length: u64) -> Result<(), Problem> {
    input.rewind()?;
    let (mut at, mut before) = (0_u64, 0_u8);
    let (mut scan, mut end) = (None, None);
    loop {
        let bytes = input.fill_buf()?;
        let count = bytes.len();
        if count == 0 {
            break;
        }
        for &byte in bytes {
            match [before, byte] {
                [0xff, 0xda] => scan = Some(at),
                [0xff, 0xd9] => end = Some(at),
                _ => {}
            }
            (at, before) = (at + 1, byte);
        }
        input.consume(count);
    }
    // A small picture within the header has an end of its own.
    if end.is_none() || end < scan {
        return Err(Problem::Content(ends_early(length)));
    }
    Ok(())
}

/// Refuses a size that the file is far too short for.
pub(super) fn check_size([width, height]: [u32; 2], length: u64) -> Result<(), String> {
    if u64::from(width) * u64::from(height) > length.saturating_mul(LONGEST_RUN) {
        return Err(format!(
            "a JPEG of {length} bytes cannot fill {width} x {height} pixels; if the file is complete, save \
             it as PNG"
        ));
    }
    Ok(())
}
