//! Any bytes, read as a glTF file, give a mesh and cameras, or a message.
#![no_main]

use bothways_formats::common::scene::Shape;
use bothways_formats::gltf;
use bothways_fuzz::{check_mesh, check_message};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| match gltf::parse("a.gltf", bytes) {
    Ok(model) => {
        for shape in model.shapes {
            match shape {
                Shape::Mesh(mesh) => check_mesh(mesh),
                Shape::Instances(instances) => check_mesh(instances.copied(0)),
                other => panic!("a file has no {other:?}"),
            }
        }
    }
    Err(error) => check_message(&error),
});
