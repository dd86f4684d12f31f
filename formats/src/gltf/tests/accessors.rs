//! What is read through accessors, and the rules for them, one by one.

use super::*;

#[test]
#[expect(clippy::too_many_lines, reason = "it is a table of cases")]
fn accessors_that_break_a_rule_are_refused() {
    let rules: &[(&[(&str, &str)], &str)] = &[
        (
            &[("\"POSITION\": 0", "\"POSITION\": 9")],
            "mesh 0, primitive 0: it names accessor 9, counted from 0, but there are only 4",
        ),
        (&[("\"POSITION\": 0, ", "")], "mesh 0, primitive 0: it has no POSITION"),
        (
            &[("\"bufferView\": 0", "\"bufferView\": 7")],
            "accessor 0: it names view 7, counted from 0, but there are only 4",
        ),
        (
            &[("\"bufferView\": 0, ", "")],
            "accessor 0: it has no view, so its 4 elements would all be 0",
        ),
        (
            &[("{ \"buffer\": 0", "{ \"buffer\": 3")],
            "accessor 0, view 0: it names buffer 3, counted from 0, but there is only 1",
        ),
        (&[("5126", "5125")], "accessor 0: its components must be floats, not UNSIGNED_INT"),
        (&[("5126", "5121")], "accessor 0: its components must be floats, not UNSIGNED_BYTE"),
        (&[("5126", "5130")], "accessor 0: its componentType is not known to the format"),
        (&[("VEC3", "VEC2")], "accessor 0: its type must be VEC3, not VEC2"),
        (&[("VEC3", "VEC5")], "accessor 0: its type is not known to the format"),
        (
            &[("5123", "5126")],
            "accessor 3: its components must be unsigned bytes, shorts or ints that are not normalized, not FLOAT",
        ),
        (
            &[("5123", "5123, \"normalized\": true")],
            "accessor 3: its components must be unsigned bytes, shorts or ints that are not normalized, not UNSIGNED_SHORT, normalized",
        ),
        (&[("\"count\": 4", "\"count\": 0")], "accessor 0: it has no elements"),
        (
            &[("\"count\": 4", "\"count\": 5")],
            "accessor 0: its 5 elements end at byte 60, but its view has 48 bytes",
        ),
        (
            &[("\"count\": 4", "\"count\": 18446744073709551615")],
            "accessor 0: its 18446744073709551615 elements end at byte 221360928884514619380, but its view has 48 bytes",
        ),
        (
            &[("\"count\": 4", "\"count\": 3")],
            "mesh 0, primitive 0: its attribute NORMAL has 4 elements for 3 vertices",
        ),
        (
            &[("\"bufferView\": 0", "\"bufferView\": 0, \"byteOffset\": 4")],
            "accessor 0: its 4 elements end at byte 52, but its view has 48 bytes",
        ),
        (
            &[("\"bufferView\": 0", "\"bufferView\": 0, \"byteOffset\": 2")],
            "accessor 0: it begins at byte 2 of its view, which is no multiple of 4",
        ),
        (
            &[("\"byteOffset\": 0, \"byteLength\": 48", "\"byteOffset\": 2, \"byteLength\": 48")],
            "accessor 0: it begins at byte 2 of its buffer, which is no multiple of 4",
        ),
        (
            &[(
                "\"byteOffset\": 128, \"byteLength\": 12",
                "\"byteOffset\": 127, \"byteLength\": 12",
            )],
            "accessor 3: it begins at byte 127 of its buffer, which is no multiple of 2",
        ),
        (
            &[(
                "\"byteOffset\": 128, \"byteLength\": 12",
                "\"byteOffset\": 128, \"byteLength\": 14",
            )],
            "accessor 3, view 3: it ends at byte 142 of its buffer, which has 140 bytes",
        ),
        (
            &[("\"byteOffset\": 128", "\"byteOffset\": 18446744073709551615")],
            "accessor 3, view 3: it ends at byte 18446744073709551627 of its buffer, which has 140 bytes",
        ),
        (
            &[("\"byteLength\": 48", "\"byteLength\": 48, \"byteStride\": 8")],
            "accessor 0: it has a stride of 8 bytes, but its elements have 12",
        ),
        (
            &[("\"byteLength\": 48", "\"byteLength\": 48, \"byteStride\": 16")],
            "accessor 0: its 4 elements end at byte 60, but its view has 48 bytes",
        ),
        (
            &[("\"byteLength\": 48", "\"byteLength\": 48, \"byteStride\": 14")],
            "accessor 0, view 0: it has a stride of 14 bytes; a stride is a multiple of 4 from 4 to 252",
        ),
        (
            &[("\"byteLength\": 48", "\"byteLength\": 48, \"byteStride\": 256")],
            "accessor 0, view 0: it has a stride of 256 bytes; a stride is a multiple of 4 from 4 to 252",
        ),
        (
            &[("\"byteLength\": 12", "\"byteLength\": 12, \"byteStride\": 4")],
            "accessor 3: its view has a stride, which is for attributes of vertices only",
        ),
        (
            &[("\"byteLength\": 140", "\"byteLength\": 141")],
            "buffer 0: it should have 141 bytes, but its data has 140",
        ),
    ];
    for (changes, says) in rules {
        let found = fault(changes);
        assert!(
            found == *says || found == format!("mesh 0, primitive 0, {says}"),
            "{changes:?}: {found}"
        );
    }
    // The same with an index, and with a number.
    let mut wrong = data();
    wrong[128 + 2] = 4;
    let says = "mesh 0, primitive 0: index 1, counted from 0, names vertex 4, but there are only 4";
    assert_eq!(fault_of(document(&wrong, &[])), says);
    let mut wrong = data();
    wrong[16..20].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(
        fault_of(document(&wrong, &[])),
        "mesh 0, primitive 0, accessor 0: number 4, counted from 0, is not finite"
    );
}

#[test]
fn elements_of_any_stride_and_integers_are_read() {
    let stride = ("\"byteLength\": 48 }", "\"byteLength\": 128, \"byteStride\": 16 }");
    let model = square(&[stride]);
    let mesh = mesh_of(&model);
    assert_eq!(mesh.positions()[1].to_array(), [0.0, 0.0, 1.0], "the floats from byte 16 on");
    // Texture coordinates as normalized shorts: the floats 0 and 1 are the shorts 0, 0 and 0, 0x3f80.
    let shorts = (
        "\"bufferView\": 2, \"componentType\": 5126",
        "\"bufferView\": 2, \"normalized\": true, \"componentType\": 5123",
    );
    let model = square(&[shorts]);
    let mesh = mesh_of(&model);
    assert_eq!(
        mesh.texture_coordinates().values[2],
        Vec2::new(0.0, 1.0 - f32::from(0x3f80_u16) / 65535.0)
    );
    // Positions as signed bytes, which the extension allows.
    let bytes = ("5126", "5120");
    let padded = ("\"byteLength\": 48", "\"byteLength\": 48, \"byteStride\": 4");
    let used = (
        "\"extensionsUsed\": []",
        "\"extensionsUsed\": [\"KHR_mesh_quantization\"], \"extensionsRequired\": [\"KHR_mesh_quantization\"]",
    );
    let model = square(&[bytes, padded, used]);
    let mesh = mesh_of(&model);
    assert_eq!(mesh.positions()[3].to_array(), [0.0, 0.0, -128.0], "the bytes of 1.0");
    let says = fault(&[bytes, used]);
    assert!(
        says.ends_with(
            "accessor 0: its elements follow one another every 3 bytes, which is no multiple of 4"
        ),
        "{says}"
    );
}

#[test]
fn sparse_accessors_replace_some_elements() {
    // Indices 0 and 2 (the second and third short), and two vectors: normals.
    let sparse = |count: u32, at: u32| {
        format!(
            "\"bufferView\": 0, \"sparse\": {{ \"count\": {count}, \"indices\": {{ \"bufferView\": 3, \"byteOffset\": {at}, \
                 \"componentType\": 5123 }}, \"values\": {{ \"bufferView\": 1 }} }}"
        )
    };
    let with = |count, at| fault(&[("\"bufferView\": 0", &sparse(count, at))]);
    let model = square(&[("\"bufferView\": 0", &sparse(2, 2))]);
    let expected = [CORNERS[0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0], CORNERS[3]];
    assert_eq!(mesh_of(&model).positions(), expected.map(Vec3::from_array));
    let without = sparse(2, 2).replace("\"bufferView\": 0, \"sparse\"", "\"sparse\"");
    let model = square(&[("\"bufferView\": 0", &without)]);
    assert_eq!(mesh_of(&model).positions()[3], Vec3::ZERO);
    let place = "mesh 0, primitive 0, accessor 0: ";
    assert_eq!(with(0, 0), format!("{place}it replaces 0 of 4 elements"));
    assert_eq!(with(5, 0), format!("{place}it replaces 5 of 4 elements"));
    assert_eq!(
        with(4, 0),
        format!("{place}it replaces element 0 behind element 2; they must rise, and there are 4")
    );
    assert_eq!(
        with(3, 8),
        format!("{place}its 3 elements end at byte 14, but its view has 12 bytes")
    );
    assert_eq!(
        with(1, 1),
        format!("{place}it begins at byte 129 of its buffer, which is no multiple of 2")
    );
    let huge = fault(&[("\"bufferView\": 0", &without), ("\"count\": 4", "\"count\": 4000000000")]);
    assert_eq!(huge, format!("{place}it has no view, so its 4000000000 elements would all be 0"));
}
