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
        format!("{place}it begins at byte 1 of its view, which is no multiple of 2")
    );
    let huge = fault(&[("\"bufferView\": 0", &without), ("\"count\": 4", "\"count\": 4000000000")]);
    assert_eq!(huge, format!("{place}it has no view, so its 4000000000 elements would all be 0"));
}

/// The bounds of the square's positions.
const BOUNDS: &str = "\"min\": [0, 0, 0], \"max\": [1, 1, 0]";

#[test]
fn stated_bounds_are_numbers_for_each_component_or_refused() {
    let says = |bound, components| {
        format!(
            "its {bound} must be a list of numbers, as many as its elements have components, which is {components}"
        )
    };
    for (bounds, bound) in [
        ("\"min\": [0, 0], \"max\": [1, 1, 0]", "min"),
        ("\"min\": [0, 0, 0, 0], \"max\": [1, 1, 0]", "min"),
        ("\"min\": [0, 0, 0], \"max\": []", "max"),
        ("\"min\": [0, 0, 0], \"max\": [1, \"1\", 0]", "max"),
        ("\"min\": [0, null, 0], \"max\": [1, 1, 0]", "min"),
        ("\"min\": [[0, 0, 0]], \"max\": [1, 1, 0]", "min"),
        ("\"min\": 0, \"max\": [1, 1, 0]", "min"),
        ("\"max\": {}", "max"),
    ] {
        let found = fault(&[(BOUNDS, bounds)]);
        assert_eq!(found, format!("mesh 0, primitive 0, accessor 0: {}", says(bound, 3)));
    }
    // Of every accessor that is read, not of positions alone.
    let texture = fault(&[("\"VEC2\"", "\"VEC2\", \"max\": [1, 1, 1]")]);
    assert_eq!(texture, format!("mesh 0, primitive 0, accessor 2: {}", says("max", 2)));
    let indices = fault(&[("\"SCALAR\"", "\"SCALAR\", \"min\": [0, 3]")]);
    assert_eq!(indices, format!("mesh 0, primitive 0, accessor 3: {}", says("min", 1)));
    let infinite = fault(&[(BOUNDS, "\"min\": [0, 0, 0], \"max\": [1e999, 1, 0]")]);
    assert!(infinite.starts_with("its JSON is not that of a glTF file: "), "{infinite}");
}

#[test]
fn bounds_that_are_missing_or_wrong_change_nothing() {
    let expected = square(&[]);
    for bounds in [
        "\"name\": \"without\"",
        "\"min\": [0, 0, 0]",
        "\"max\": [1, 1, 0]",
        "\"min\": [0.25, 0.25, 0], \"max\": [0.75, 0.75, 0]",
        "\"min\": [5, 5, 5], \"max\": [-5, -5, -5]",
        "\"min\": [-1e300, -1e300, -1e300], \"max\": [1e300, 1e300, 1e300]",
        "\"min\": [0, 0, 0], \"max\": [18446744073709551615, -9223372036854775808, 1.5]",
    ] {
        assert_eq!(square(&[(BOUNDS, bounds)]), expected, "{bounds}");
    }
    let indices = square(&[("\"SCALAR\"", "\"SCALAR\", \"min\": [7], \"max\": [9]")]);
    assert_eq!(indices, expected);
    let sparse = "\"sparse\": { \"count\": 1, \"indices\": { \"bufferView\": 3, \"componentType\": 5123 }, \
                  \"values\": { \"bufferView\": 1 } }, \"bufferView\": 0";
    // The element that replaces another is outside of the bounds.
    let model = square(&[("\"bufferView\": 0", sparse)]);
    assert_eq!(mesh_of(&model).positions()[0], Vec3::Z);
}

#[test]
fn floats_and_indices_are_never_normalized() {
    let normalized = "\"componentType\": 5126, \"normalized\": true";
    let quantized = ("\"extensionsUsed\": []", "\"extensionsUsed\": [\"KHR_mesh_quantization\"]");
    let of_view = |view: u32| format!("\"bufferView\": {view}, \"componentType\": 5126");
    let changed = |view: u32| format!("\"bufferView\": {view}, {normalized}");
    let integers = "floats, or normalized unsigned bytes or shorts";
    for (view, allowed, allowed_quantized) in [
        (0, "floats", "floats, bytes or shorts"),
        (1, "floats", "floats, or normalized bytes or shorts"),
        (2, integers, "floats, bytes or shorts"),
    ] {
        let (from, to) = (of_view(view), changed(view));
        let place = format!("mesh 0, primitive 0, accessor {view}: its components must be");
        let says = fault(&[(&from, &to)]);
        assert_eq!(says, format!("{place} {allowed}, not FLOAT, normalized"));
        let says = fault(&[(&from, &to), quantized]);
        assert_eq!(says, format!("{place} {allowed_quantized}, not FLOAT, normalized"));
    }
    let color = ("\"TEXCOORD_0\": 2", "\"COLOR_0\": 1");
    let says = fault(&[(&of_view(1), &changed(1)), color, ("\"NORMAL\": 1, ", "")]);
    assert!(says.ends_with(&format!("must be {integers}, not FLOAT, normalized")), "{says}");
    // Integers that are not normalized are no texture coordinates without the extension.
    let says = fault(&[(&of_view(2), "\"bufferView\": 2, \"componentType\": 5123")]);
    assert!(says.ends_with(&format!("must be {integers}, not UNSIGNED_SHORT")), "{says}");
}

#[test]
fn the_largest_index_of_each_type_is_refused() {
    let restarts = |component: u32, largest: &[u8]| {
        // As many positions as a byte can name, and one triangle behind them.
        let mut data = [[0.0_f32; 3]; 256].as_flattened().iter().fold(Vec::new(), |mut all, x| {
            all.extend(x.to_le_bytes());
            all
        });
        let zero = vec![0; largest.len()];
        data.extend([&zero, &zero, largest].concat());
        let size = 3 * largest.len();
        let text = document(
            &data,
            &[
                (", \"NORMAL\": 1, \"TEXCOORD_0\": 2", ""),
                ("\"count\": 4", "\"count\": 256"),
                ("\"byteLength\": 48", "\"byteLength\": 3072"),
                (
                    "\"byteOffset\": 128, \"byteLength\": 12",
                    &format!("\"byteOffset\": 3072, \"byteLength\": {size}"),
                ),
                ("5123, \"count\": 6", &format!("{component}, \"count\": 3")),
                ("\"byteLength\": 140", &format!("\"byteLength\": {}", data.len())),
            ],
        );
        parse("a", text.as_bytes()).map(|model| mesh_of(&model).triangles()[0])
    };
    for (component, largest) in [(5121, &[0xff][..]), (5123, &[0xff; 2]), (5125, &[0xff; 4])] {
        let says = restarts(component, largest).unwrap_err().to_string();
        let index = u32::MAX >> (32 - 8 * largest.len());
        let expected = format!(
            "a: mesh 0, primitive 0: index 2, counted from 0, is {index}: the largest number of its type begins a new \
             primitive, and names no vertex"
        );
        assert_eq!(says, expected);
    }
    assert_eq!(restarts(5121, &[0xfe]).unwrap(), [0, 0, 254]);
    assert_eq!(restarts(5123, &[0xff, 0]).unwrap(), [0, 0, 255]);
    assert_eq!(restarts(5125, &[0xff, 0, 0, 0]).unwrap(), [0, 0, 255]);
}

#[test]
fn the_last_element_needs_no_room_behind_it() {
    let with = |stride: u32, length: u32| {
        let view = format!("\"byteLength\": {length}, \"byteStride\": {stride}");
        parse("a", document(&data(), &[("\"byteLength\": 48", &view)]).as_bytes())
    };
    // 16 · 3 + 12 bytes.
    assert!(with(16, 60).is_ok());
    let says = with(16, 59).unwrap_err().to_string();
    assert!(says.ends_with("its 4 elements end at byte 60, but its view has 59 bytes"), "{says}");
    // The least and the largest stride, and those beside them.
    let one = ("\"count\": 4", "\"count\": 1");
    for (stride, says) in [
        (0, "stride of 0 bytes; a stride is"),
        (2, "stride of 2 bytes; a stride is"),
        (4, "stride of 4 bytes, but its elements have 12"),
        (12, "NORMAL has 4 elements for 1 vertices"),
        (252, "NORMAL has 4 elements for 1 vertices"),
        (254, "stride of 254 bytes; a stride is"),
    ] {
        let view = format!("\"byteLength\": 48, \"byteStride\": {stride}");
        let found = fault(&[("\"byteLength\": 48", &view), one]);
        assert!(found.contains(says), "{stride}: {found}");
    }
    let negative = fault(&[("\"bufferView\": 0", "\"bufferView\": 0, \"byteOffset\": -4")]);
    assert!(negative.starts_with("its JSON is not that of a glTF file: "), "{negative}");
}

#[test]
fn offsets_of_sparse_lists_are_multiples_of_their_components() {
    // Index 1 is the second short of a view that holds the indices, and what replaces it is the second normal.
    let sparse = |indices: &str, values: &str| {
        let text = format!(
            "\"bufferView\": 0, \"sparse\": {{ \"count\": 1, \"indices\": {{ {indices} }}, \"values\": {{ {values} }} }}"
        );
        let changes = [
            ("\"bufferView\": 0", text.as_str()),
            (
                "\"byteLength\": 12 }",
                "\"byteLength\": 12 }, { \"buffer\": 0, \"byteOffset\": 129, \"byteLength\": 11 }, \
              { \"buffer\": 0, \"byteOffset\": 50, \"byteLength\": 46 }, \
              { \"buffer\": 0, \"byteOffset\": 128, \"byteLength\": 12, \"byteStride\": 4 }",
            ),
        ];
        parse("a", document(&data(), &changes).as_bytes())
            .map(|model| mesh_of(&model).positions().to_vec())
            .map_err(|error| error.to_string().replace("a: mesh 0, primitive 0, accessor 0: ", ""))
    };
    let (indices, values) =
        ("\"bufferView\": 3, \"byteOffset\": 2, \"componentType\": 5123", "\"bufferView\": 1");
    assert_eq!(sparse(indices, values).unwrap()[1], Vec3::Z);
    let says =
        |of| move |at| Err(format!("it begins at byte {at} of its {of}, which is no multiple of"));
    let (view, buffer) = (says("view"), says("buffer"));
    let stride =
        || Err("its view has a stride, which is for attributes of vertices only".to_owned());
    let unknown = |what| Err(format!("it names view {what}, counted from 0, but there are only 7"));
    let short = "\"componentType\": 5123";
    for (indices, values, expected) in [
        // The sum is aligned, the offset in the view is not.
        (format!("\"bufferView\": 4, \"byteOffset\": 1, {short}"), values, view(1)),
        (format!("\"bufferView\": 4, {short}"), values, buffer(129)),
        (indices.to_owned(), "\"bufferView\": 5, \"byteOffset\": 2", view(2)),
        (indices.to_owned(), "\"bufferView\": 5", buffer(50)),
        (format!("\"bufferView\": 6, {short}"), values, stride()),
        (indices.to_owned(), "\"bufferView\": 6", stride()),
        (format!("\"bufferView\": 7, {short}"), values, unknown(7)),
        (indices.to_owned(), "\"bufferView\": 9", unknown(9)),
        (
            indices.replace("5123", "5122"),
            values,
            Err("the componentType of its sparse indices is not known to the format".to_owned()),
        ),
        (
            indices.to_owned(),
            "\"bufferView\": 1, \"byteOffset\": 40",
            Err("its 1 elements end at byte 52, but its view has 48 bytes".to_owned()),
        ),
        (
            format!("\"bufferView\": 3, \"byteOffset\": 12, {short}"),
            values,
            Err("its 1 elements end at byte 14, but its view has 12 bytes".to_owned()),
        ),
    ] {
        let (found, expected) = (sparse(&indices, values), expected.map(|()| Vec::<Vec3>::new()));
        let (found, expected) = (found.unwrap_err(), expected.unwrap_err());
        assert!(found.starts_with(&expected), "{indices}, {values}: {found}");
    }
}

#[test]
fn sparse_indices_name_elements_and_rise_strictly() {
    let replaced = |count: u32, component: u32| {
        let sparse = format!(
            "\"bufferView\": 0, \"sparse\": {{ \"count\": {count}, \"indices\": {{ \"bufferView\": 3, \
             \"componentType\": {component} }}, \"values\": {{ \"bufferView\": 1 }} }}"
        );
        fault(&[("\"bufferView\": 0", &sparse)])
    };
    // The shorts 0 and 1 as one number, and the short 0 as two.
    for (count, component, says) in [
        (1, 5125, "it replaces element 65536; they must rise, and there are 4"),
        (2, 5121, "it replaces element 0 behind element 0; they must rise, and there are 4"),
    ] {
        let found = replaced(count, component);
        assert_eq!(found, format!("mesh 0, primitive 0, accessor 0: {says}"));
    }
}

#[test]
fn what_nothing_is_drawn_by_is_not_asked_for() {
    let expected = square(&[]);
    // Attributes in a view that states the target of indices.
    let target = square(&[("\"byteLength\": 48 }", "\"byteLength\": 48, \"target\": 34963 }")]);
    assert_eq!(target, expected);
    // Two accessors in one view without a stride.
    let shared = square(&[
        ("\"byteLength\": 48 }", "\"byteLength\": 96 }"),
        ("\"bufferView\": 1,", "\"bufferView\": 0, \"byteOffset\": 48,"),
    ]);
    assert_eq!(shared, expected);
}
