//! Any bytes, read as an MTL file, give materials that can be drawn, or a message.
#![no_main]

use bothways_formats::obj;
use bothways_fuzz::check_message;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| match obj::parse_materials("a.mtl", bytes) {
    Ok(materials) => {
        for (name, material) in materials {
            assert!(!name.is_empty());
            assert!(material.color.is_finite() && (0.0..=1.0).contains(&material.specular));
            assert!(material.shininess.is_finite() && material.shininess > 0.0);
        }
    }
    Err(error) => check_message(&error),
});
