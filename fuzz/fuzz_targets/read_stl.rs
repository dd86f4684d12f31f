//! Any bytes, read as an STL file, give a mesh, or a message.
#![no_main]

use bothways_formats::stl;
use bothways_fuzz::{check_mesh, check_message};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| match stl::parse("a.stl", bytes) {
    Ok(mesh) => check_mesh(mesh),
    Err(error) => check_message(&error),
});
