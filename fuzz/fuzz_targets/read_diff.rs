//! Any bytes, read as a file to compare (PNG, BMP, PNM, JPEG, EXR, NPY), give a buffer that equals itself, or a message.
#![no_main]

use bothways::diff::foreign::{Content, ReadOptions, compare, read_from};
use bothways_fuzz::{check_message, with_checksums};
use libfuzzer_sys::fuzz_target;
use std::io::Cursor;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let background = (bytes.len() % 2 == 1).then_some([16, 20, 24]);
    let options = ReadOptions { background, normals: bytes.len() % 3 == 1, ..ReadOptions::default() };
    // With wrong checksums, the reader would never reach the content of the chunks.
    let bytes = with_checksums(bytes);
    match read_from(Path::new("a"), Cursor::new(&bytes), &options) {
        Ok(read) => {
            let buffer = read.buffer;
            // A comparison of many pixels takes too long.
            let [width, height] = buffer.size();
            let not_numbers =
                matches!(buffer.content(), Content::Distances(t) if t.iter().any(|t| t.is_nan()));
            if u64::from(width) * u64::from(height) <= 1 << 12 && !not_numbers {
                if let Ok(comparison) = compare(&buffer, &buffer) {
                    assert!(comparison.equal);
                }
            }
        }
        Err(error) => check_message(&error),
    }
});
