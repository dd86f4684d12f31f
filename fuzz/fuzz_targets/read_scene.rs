//! Any text, read as a scene file, gives a scene and a camera, or a message with its place.
#![no_main]

use bothways_common::Camera;
use bothways_formats::scene_file;
use bothways_formats::source::Files;
use bothways_fuzz::check_message;
use libfuzzer_sys::{Corpus, fuzz_target};

fuzz_target!(|text: &str| -> Corpus {
    // A short text may rightly ask for a hundred million triangles, which takes too long here.
    if text.contains("divisions") && text.contains("generate") {
        return Corpus::Reject;
    }
    match scene_file::parse("a.toml", text, &Files::none()) {
        Ok(file) => {
            if let Err(error) = Camera::new(file.camera) {
                panic!("the reader accepts what the camera refuses: {error}");
            }
        }
        Err(error) => check_message(&error),
    }
    Corpus::Keep
});
