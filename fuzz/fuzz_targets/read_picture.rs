//! Any bytes, read as a picture on a surface (PNG, JPEG, BMP, PNM), give texels in linear light, or a message.
#![no_main]

use bothways_formats::gltf;
use bothways_fuzz::{check_message, textured, with_checksums};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    // With wrong checksums, the reader would never reach the content of the chunks.
    match gltf::parse("a.glb", &textured(&with_checksums(bytes))) {
        Ok(model) => {
            let mesh = model.shapes[0].mesh().expect("it has one triangle");
            let materials = mesh.materials().expect("it names one");
            let texture = materials.of(0).and_then(|material| material.texture.as_ref());
            for level in texture.expect("it is of the picture").pyramid.levels() {
                let [width, height] = level.size();
                assert_eq!(level.texels().len(), width * height);
                let is_light = |value: &f32| (0.0..=1.0).contains(value);
                assert!(level.texels().iter().all(|texel| texel.to_array().iter().all(is_light)));
            }
        }
        Err(error) => check_message(&error),
    }
});
