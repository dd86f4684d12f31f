//! Any bytes, read as a glTF file, give a mesh and cameras, or a message.
#![no_main]

use bothways_formats::gltf;
use bothways_fuzz::{check_mesh, check_message};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| match gltf::parse("a.gltf", bytes) {
    Ok(model) => check_mesh(model.mesh),
    Err(error) => check_message(&error),
});
