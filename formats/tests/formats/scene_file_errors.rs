//! Scene files that are wrong: the messages, and the places that they name.

use bothways_formats::scene_file::{self, LocatedError, ReadSceneError, SceneFile};
use proptest::prelude::*;
use std::path::Path;

fn read(text: &str) -> Result<SceneFile, LocatedError> {
    match scene_file::parse("scene.toml", text, Path::new("no-such-folder")) {
        Ok(file) => Ok(file),
        Err(ReadSceneError::Located(error)) => Err(error),
        Err(error) => panic!("a text has a place: {error}"),
    }
}

/// Checks for each text which part is underlined, and the message.
fn check_errors(cases: &[(&str, &str, &str)]) {
    for (text, underlined, message) in cases {
        let error = read(text).expect_err("it is wrong");
        assert_eq!(error.to_string(), format!("scene.toml:{message}"), "in {text:?}");
        assert_eq!(&error.text[error.span.clone()], *underlined, "in {text:?}");
    }
}

#[test]
fn what_is_wrong_with_the_document() {
    check_errors(&[
        (
            "",
            "",
            "1:1: the scene has no object; begin one with [[object]] and, for example, sphere = \
             { center = [0, 0, 0], radius = 1 }",
        ),
        ("a = \n", "", "1:5: string values must be quoted, expected literal string"),
        ("a = 'b\nc = 4", "", "1:7: invalid literal string, expected `'`"),
        (
            "\u{feff}camra = 1",
            "camra",
            "1:1: a scene file has no key \"camra\"; did you mean \"camera\"?",
        ),
        (
            "[fog]",
            "fog",
            "1:2: a scene file has no key \"fog\"; the keys are camera, material, light, object",
        ),
        (
            "[object]",
            "[object]",
            "1:1: object is a table; it must be a list of tables; begin each with the header \
             [[object]]",
        ),
        ("object = [1]", "1", "1:11: object is a whole number; it must be a table"),
        ("[[camera]]", "[[camera]]", "1:1: camera is an array; it must be a table"),
    ]);
}

#[test]
fn an_error_at_the_end_of_a_file_points_at_the_last_line() {
    for (text, place, underlined) in [
        ("a = \"\"\"b\nc\n", "2:2", "c"),
        ("a = \"\"\"b\nc\n \n\n", "2:2", "c"),
        ("[[object]]\nsphere = {\n", "2:11", "{"),
        ("[camera]\neye = [0, 0,\n\n", "2:13", ","),
        ("a = ", "1:5", "="),
    ] {
        let error = read(text).unwrap_err();
        assert!(error.to_string().starts_with(&format!("scene.toml:{place}: ")), "{error}");
        let excerpt = error.excerpt();
        assert_eq!(&excerpt.text[excerpt.span.clone()], underlined, "{text:?}");
    }
}

#[test]
fn what_is_wrong_with_a_field_of_view() {
    check_errors(&[
        (
            "[camera]\nfov = 180",
            "180",
            "2:7: fov is 180; it must be greater than 0 and less than 180; it is the vertical angle \
             in degrees",
        ),
        (
            "[camera]\nfov = 179.9999999",
            "179.9999999",
            "2:7: fov is 179.9999999, which single precision rounds to 180; it must be greater than 0 and \
             less than 180; it is the vertical angle in degrees",
        ),
        (
            "[camera]\nfov = 1e-60",
            "1e-60",
            "2:7: fov is 1e-60, which single precision rounds to 0; it must be greater than 0 and less than \
             180; it is the vertical angle in degrees",
        ),
        (
            "[camera]\nfov = -1e-60",
            "-1e-60",
            "2:7: fov is -1e-60; it must be greater than 0 and less than 180; it is the vertical angle in \
             degrees",
        ),
        (
            "[camera]\nfov = 1e-30",
            "1e-30",
            "2:7: fov is 1e-30, so the viewport's width is 2.3271056e-32; it must be between 2^-64 and 2^64 \
             (5.4e-20 to 1.8e19)",
        ),
        (
            "[camera]\nfov = 179.9999",
            "179.9999",
            "2:7: fov is 179.9999, so the viewport is 2.8609038e6 x 2.1456778e6 at distance 1; its sides may \
             be at most 2^20 (about 1e6) times the distance",
        ),
        ("[camera]\nfov = \"wide\"", "\"wide\"", "2:7: fov is a string; it must be a number"),
        (
            "[camera]\nfov = 40\nviewport = [1, 1]",
            "viewport",
            "3:1: the viewport's size is stated by fov already, so not by viewport; give fov, the \
             vertical angle in degrees, or viewport = [vw, vh]",
        ),
        (
            "[camera]\nprojection = \"parallel\"\nfov = 40",
            "40",
            "3:7: fov belongs to a perspective camera; parallel rays never part; give viewport = \
             [vw, vh] instead",
        ),
    ]);
}

#[test]
fn what_is_wrong_with_a_scale() {
    let object = |line: &str| format!("[[object]]\ngenerate = {{ kind = \"box\" }}\n{line}");
    for (line, message) in [
        ("scale = [1, 0, 1]", "scale[1] is 0; it must not be 0, which flattens; scale by a small"),
        ("scale = [1, 2]", "scale has 2 elements; it must be three numbers"),
        ("scale = -1", "scale is -1; it must be greater than 0; to mirror, give three factors"),
        ("scale = \"x\"", "scale is a string; it must be a number, or three"),
        ("scale = 1e39", "scale is 1e39; it must be between -3.4e38 and 3.4e38"),
    ] {
        let error = read(&object(line)).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
    for word in ["nan", "inf", "-inf"] {
        let error = read(&object(&format!("scale = {word}"))).unwrap_err().to_string();
        assert_eq!(error, format!("scene.toml:3:9: scale is {word}; it must be a finite number"));
    }
    let ball = "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\nscale = [1, 2, 1]";
    let error = read(ball).unwrap_err().to_string();
    assert!(error.contains("3:9: a sphere stays a sphere"), "{error}");
}

#[test]
fn what_is_wrong_with_a_value() {
    check_errors(&[
        ("[camera]\neye = [0, 0]", "[0, 0]", "2:7: eye has 2 elements; it must be three numbers"),
        ("[camera]\neye = [0]", "[0]", "2:7: eye has 1 element; it must be three numbers"),
        ("[camera]\neye = 3", "3", "2:7: eye is a whole number; it must be three numbers"),
        (
            "[camera]\n# é\neye = [0, 0, 'é']",
            "'é'",
            "3:14: eye[2] is a string; it must be a number",
        ),
        (
            "[camera]\neye = [0, 1e39, 0]",
            "1e39",
            "2:11: eye[1] is 1e39; it must be between -3.4e38 and 3.4e38",
        ),
        ("[camera]\neye = [0, 0, nan]", "nan", "2:14: eye[2] is nan; it must be a finite number"),
        ("[camera]\ndistance = -inf", "-inf", "2:12: distance is -inf; it must be a finite number"),
        ("[camera]\ndistance = 0.0", "0.0", "2:12: distance is 0.0; it must be greater than 0"),
        (
            "[camera]\ndistance = 2020-01-01",
            "2020-01-01",
            "2:12: distance is a date; it must be a number",
        ),
        (
            "[camera]\nimage = [640.0, 480]",
            "640.0",
            "2:10: image[0] is a decimal number; it must be a whole number",
        ),
        (
            "[camera]\nimage = [640, -1]",
            "-1",
            "2:15: image[1] is -1; it must be a whole number from 0 to 4294967295",
        ),
        (
            "[camera]\nviewport = [1, 1, 1]",
            "[1, 1, 1]",
            "2:12: viewport has 3 elements; it must be two numbers",
        ),
        (
            "[camera]\nprojection = 'paralel'",
            "'paralel'",
            "2:14: projection is \"paralel\"; did you mean \"parallel\"?",
        ),
        (
            "[camera]\nbackground = '#12345g'",
            "'#12345g'",
            "2:14: background is \"#12345g\"; it must be a # and six hexadecimal digits; write \
             for example \"#c8553d\"",
        ),
        (
            "[camera]\nbackground = '#+1+2+3'",
            "'#+1+2+3'",
            "2:14: background is \"#+1+2+3\"; it must be a # and six hexadecimal digits; write \
             for example \"#c8553d\"",
        ),
        (
            "[camera]\nbackground = '#ééé'",
            "'#ééé'",
            "2:14: background is \"#ééé\"; it must be a # and six hexadecimal digits; write for \
             example \"#c8553d\"",
        ),
    ]);
}

#[test]
fn what_is_wrong_with_a_camera() {
    check_errors(&[
        (
            "[camera]\nimage = [0, 4]",
            "[0, 4]",
            "2:9: the image is 0x4; both sides need at least 1 pixel",
        ),
        (
            "[camera]\nlook_at = [0, 0, 0]",
            "[0, 0, 0]",
            "2:11: the eye [0, 0, 0] is the point it looks at; move one of them",
        ),
        (
            "[camera]\nlook_at = [0, 1, 0]",
            "[0, 1, 0]",
            "2:11: up [0, 1, 0] runs along the direction of view; choose another up",
        ),
        (
            "[camera]\nup = [0, 0, 2]",
            "[0, 0, 2]",
            "2:6: up [0, 0, 2] runs along the direction of view; choose another up",
        ),
        (
            "[camera]\nup = [0, 0, 0]",
            "[0, 0, 0]",
            "2:6: up is zero and so has no direction; give a vector with a length",
        ),
        (
            "[camera]\ndistance = 1e-9",
            "1e-9",
            "2:12: the viewport is 1.3333334 x 1 at distance 1e-9; its sides may be at \
             most 2^20 (about 1e6) times the distance",
        ),
        (
            "[camera]\nviewport = [0, 1]",
            "[0, 1]",
            "2:12: the viewport's width is 0; it must be between 2^-64 and 2^64 \
             (5.4e-20 to 1.8e19)",
        ),
        (
            "[camera]\nu = [1, 0, 0]",
            "[camera]",
            "1:1: camera lacks v; write for example v = [0, 1, 0]",
        ),
        (
            "[camera]\nu = [1, 0, 0]\nv = [0, 1, 0]\nw = [0, 0, -1]",
            "[1, 0, 0]",
            "2:5: u, v, w are not a right-handed perpendicular frame: they are left-handed (v \
             is not w x u); give look_at (or direction) and up instead, and the frame is \
             computed",
        ),
        (
            "[camera]\nlook_at = [0, 0, 1]\ndirection = [1, 0, 0]",
            "direction",
            "3:1: the camera's frame is stated by look_at already, so not by direction; give \
             look_at and up, or direction and up, or u, v and w",
        ),
        (
            "[camera]\nup = [0, 1, 0]\nu = [1, 0, 0]",
            "up",
            "2:1: the camera's frame is stated by u already, so not by up; give look_at and up, \
             or direction and up, or u, v and w",
        ),
    ]);
}

#[test]
fn what_is_wrong_with_light_and_material() {
    check_errors(&[
        (
            "[[light]]\nintensity = 1",
            "[[light]]",
            "1:1: a light needs one of directional, point, ambient; write for example \
             directional = [-1, -2, -1]",
        ),
        (
            "[[light]]\npoint = [0, 0, 0]\nambient = true",
            "ambient",
            "3:1: a light takes only one of directional, point, ambient, and this one has point \
             already; remove ambient",
        ),
        (
            "[[light]]\nambient = false",
            "false",
            "2:11: ambient is false; write ambient = true, or remove this light",
        ),
        (
            "[[light]]\nambient = 1",
            "1",
            "2:11: ambient is a whole number; it must be true or false",
        ),
        (
            "[[light]]\nambient = true\nintensity = -1",
            "-1",
            "3:13: intensity is -1; it must be at least 0",
        ),
        (
            "[[light]]\ndirectional = [0, 0, 0]",
            "[0, 0, 0]",
            "2:15: directional is zero and so has no direction; give a vector with a length",
        ),
        ("[material]\nclay = 3", "3", "2:8: clay is a whole number; it must be a table"),
        (
            "[material.clay]\ncolour = '#123456'",
            "colour",
            "2:1: clay has no key \"colour\"; did you mean \"color\"?",
        ),
        ("[material.clay]\nspecular = 1.5", "1.5", "2:12: specular is 1.5; it must be at most 1"),
        ("[material.clay]\nshininess = 0", "0", "2:13: shininess is 0; it must be greater than 0"),
    ]);
}

#[test]
fn what_is_wrong_with_a_checker() {
    let example = "write for example checker = { color = \"#202020\", divisions = [8, 8] }";
    check_errors(&[
        (
            "[material.clay]\nchecker = { color = '#123456' }",
            "{ color = '#123456' }",
            &format!("2:11: checker lacks divisions; {example}"),
        ),
        (
            "[material.clay]\nchecker = { divisions = [8, 8] }",
            "{ divisions = [8, 8] }",
            &format!("2:11: checker lacks color; {example}"),
        ),
        (
            "[material.clay]\nchecker = { color = '#123456', divisions = [8, 0] }",
            "0",
            "2:48: divisions[1] is 0; it must be greater than 0",
        ),
        (
            "[material.clay]\nchecker = { color = '#123456', divisions = [8] }",
            "[8]",
            "2:44: divisions has 1 element; it must be two numbers",
        ),
        (
            "[material.clay]\nchecker = { colour = '#123456', divisions = [8, 8] }",
            "colour",
            "2:13: checker has no key \"colour\"; did you mean \"color\"?",
        ),
    ]);
}

#[test]
fn what_is_wrong_with_an_object() {
    check_errors(&[
        (
            "[[object]]",
            "[[object]]",
            "1:1: an object needs one of triangle, sphere, plane, mesh, generate; write for \
             example sphere = { center = [0, 0, 0], radius = 1 }",
        ),
        (
            "[[object]]\nsphere = 1\nplane = 1",
            "plane",
            "3:1: an object takes only one of triangle, sphere, plane, mesh, generate, and this \
             one has sphere already; remove plane",
        ),
        (
            "[[object]]\nspere = 1",
            "spere",
            "2:1: object has no key \"spere\"; did you mean \"sphere\"?",
        ),
        (
            "[[object]]\nsphere = { centre = [0, 0, 0] }",
            "centre",
            "2:12: sphere has no key \"centre\"; did you mean \"center\"?",
        ),
        (
            "[[object]]\nsphere = { center = [0, 0, 0] }",
            "{ center = [0, 0, 0] }",
            "2:10: sphere lacks radius; write for example sphere = { center = [0, 0, 0], radius \
             = 1 }",
        ),
        (
            "[[object]]\nsphere = { center = [0, 0, 0], radius = -1 }",
            "-1",
            "2:41: radius is -1; it must be greater than 0",
        ),
        (
            "[[object]]\nplane = { point = [0, 0, 0], normal = [0, 0, 0] }",
            "[0, 0, 0]",
            "2:39: normal is zero and so has no direction; give a vector with a length",
        ),
        (
            "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\nmaterial = 'clay'",
            "'clay'",
            "3:12: there is no material \"clay\"; define it in a table [material.clay]",
        ),
        (
            "[material.clay]\n[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\nmaterial \
             = 'caly'",
            "'caly'",
            "4:12: there is no material \"caly\"; did you mean \"clay\"?",
        ),
        (
            "[material.clay]\n[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\nmaterial \
             = 'gold'",
            "'gold'",
            "4:12: there is no material \"gold\"; the materials are clay",
        ),
        (
            "[[object]]\nmesh = 'bunny.off'",
            "'bunny.off'",
            "2:8: mesh is \"bunny.off\", which is no mesh file (.obj, .ply, .stl, .gltf, .glb); convert it to one of these; \
             no others are read",
        ),
        (
            "[[object]]\ngenerate = { kind = 'tors' }",
            "'tors'",
            "2:21: kind is \"tors\"; did you mean \"torus\"?",
        ),
        (
            "[[object]]\ngenerate = { kind = 'cube' }",
            "'cube'",
            "2:21: kind is \"cube\"; the kinds are sphere, cylinder, cone, torus, box, grid, teapot",
        ),
    ]);
}

#[test]
fn what_is_wrong_with_a_transform() {
    check_errors(&[
        (
            "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\nscale = 0",
            "0",
            "3:9: scale is 0; it must be greater than 0; to mirror, give three factors, such as scale = \
             [-1, 1, 1]",
        ),
        (
            "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\nscale = [1, 2, 3]",
            "[1, 2, 3]",
            "3:9: a sphere stays a sphere: its three factors must be equal, but for their signs; scale \
             it by one number, or generate a mesh of the kind \"sphere\"",
        ),
        (
            "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\nrotate = { axis = [0, 1, \
             0] }",
            "{ axis = [0, 1, 0] }",
            "3:10: rotate lacks degrees; write for example rotate = { axis = [0, 1, 0], degrees \
             = 30 }",
        ),
        (
            "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\nrotate = { axis = [0, 0, \
             0], degrees = 1 }",
            "[0, 0, 0]",
            "3:19: axis is zero and so has no direction; give a vector with a length",
        ),
        (
            "[[object]]\nsphere = { center = [3e38, 0, 0], radius = 1 }\nscale = 2",
            "scale",
            "3:1: this puts [3e38, 0.0, 0.0] where no f32 number reaches; stay between -3.4e38 \
             and 3.4e38",
        ),
        (
            "[[object]]\nsphere = { center = [0, 0, 0], radius = 1e-30 }\nscale = 1e-30",
            "scale",
            "3:1: this makes the radius 0; choose another scale",
        ),
        (
            "[[object]]\ngenerate = { kind = 'grid' }\ntranslate = [3e38, 0, 0]\nscale = 1e38",
            "translate",
            "3:1: this puts a vertex where no f32 number reaches; stay between -3.4e38 and \
             3.4e38",
        ),
    ]);
}

#[test]
fn a_mesh_that_cannot_be_made_is_underlined() {
    // The OBJ reader and the generators word the messages.
    let missing = read("[[object]]\nmesh = 'bunny.obj'").unwrap_err();
    assert_eq!(&missing.text[missing.span.clone()], "'bunny.obj'");
    assert!(missing.message.contains("bunny.obj"), "{missing}");
    let coarse = read("[[object]]\ngenerate = { kind = 'torus', divisions = [2, 2] }").unwrap_err();
    assert_eq!(&coarse.text[coarse.span.clone()], "[2, 2]");
}

#[test]
fn a_scene_file_that_cannot_be_read_is_named() {
    let folder = std::env::temp_dir().join(format!("bothways-scene-file-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let says = |path: &Path| scene_file::read(path).unwrap_err().to_string();

    let missing = folder.join("missing.toml");
    assert_eq!(says(&missing), format!("{}: there is no such file", missing.display()));
    let is_a_folder = format!("{}: this is a folder, not a scene file", folder.display());
    assert_eq!(says(&folder), is_a_folder);
    let latin = folder.join("latin.toml");
    std::fs::write(&latin, b"[camera]\n# caf\xe9\n").unwrap();
    let byte = "is not UTF-8 text: byte 14 on line 2 begins no character";
    assert_eq!(says(&latin), format!("{} {byte}", latin.display()));

    // Paths are relative to the scene file, not to where the program runs.
    let scene = folder.join("scene.toml");
    std::fs::write(folder.join("one.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    std::fs::write(&scene, "[[object]]\nmesh = 'one.obj'\n").unwrap();
    assert_eq!(scene_file::read(&scene).unwrap().scene.primitive_count(), 1);
    std::fs::remove_dir_all(&folder).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn no_text_makes_the_reader_panic(text in any::<String>()) {
        check_any(&text);
    }

    #[test]
    fn no_heap_of_words_makes_the_reader_panic(words in proptest::collection::vec(word(), 0..60)) {
        check_any(&words.concat());
    }

    #[test]
    fn no_broken_scene_makes_the_reader_panic(cut in 0..EXAMPLE.len(), words in word()) {
        check_any(&[&EXAMPLE[..cut], &words, &EXAMPLE[cut..]].concat());
    }
}

#[test]
fn what_is_wrong_with_instances() {
    let mesh = |instances: &str| {
        format!(
            "[[object]]\ngenerate = {{ kind = 'grid', divisions = [1, 1] }}\ninstances = {instances}"
        )
    };
    let what = "3 numbers that move it, 12 (the rows of a 3 x 4 matrix), or a table of scale, rotate and translate";
    for (instances, underlined, message) in [
        (
            "5",
            "5",
            "3:13: instances is a whole number; it must be a list or a table; write for example \
             instances = [[0, 0, 0], [2, 0, 0]]"
                .to_owned(),
        ),
        ("[[1, 2]]", "[1, 2]", format!("3:14: instances[0] has 2 numbers; it must be {what}")),
        ("[1, 2, 3]", "1", format!("3:14: instances[0] is a whole number; it must be {what}")),
        (
            "[[0, 0, 0], [0, 'x', 0]]",
            "'x'",
            "3:29: instances[1][1] is a string; it must be a number".to_owned(),
        ),
        (
            "[[1e38, 0, 0, 3e38,  0, 1, 0, 0,  0, 0, 1, 0]]",
            "instances",
            "3:1: instance 0, counted from 0, reaches where no f32 number does; stay between \
             -3.4e38 and 3.4e38"
                .to_owned(),
        ),
        (
            "[{ scael = 2 }]",
            "scael",
            "3:16: instances[0] has no key \"scael\"; did you mean \"scale\"?".to_owned(),
        ),
        (
            "{}",
            "{}",
            "3:13: instances needs one of grid, scatter; write for example instances = { grid = \
             { count = [10, 1, 10], spacing = 2 } }"
                .to_owned(),
        ),
        (
            "{ grid = { count = [5000, 5000, 1], spacing = 1 } }",
            "[5000, 5000, 1]",
            "3:32: count asks for more than 16777216 instances; divide them between several objects"
                .to_owned(),
        ),
        (
            "{ grid = { count = [4294967295, 4294967295, 4294967295], spacing = 1 } }",
            "[4294967295, 4294967295, 4294967295]",
            "3:32: count asks for more than 16777216 instances; divide them between several objects"
                .to_owned(),
        ),
        (
            "{ grid = { count = [2, 2], spacing = 1 } }",
            "[2, 2]",
            "3:32: count has 2 elements; it must be three whole numbers".to_owned(),
        ),
        (
            "{ scatter = { count = 9 } }",
            "{ count = 9 }",
            "3:25: scatter lacks size; write for example scatter = { count = 1000, size = [40, 0, \
             40], seed = 1 }"
                .to_owned(),
        ),
    ] {
        let text = mesh(instances);
        let error = read(&text).expect_err("it is wrong");
        assert_eq!(error.to_string(), format!("scene.toml:{message}"), "in {text:?}");
        assert_eq!(&error.text[error.span.clone()], underlined, "in {text:?}");
    }
    check_errors(&[(
        "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\ninstances = [[0, 0, 0]]",
        "instances",
        "3:1: a sphere has no instances, only a mesh has; state each as an object, or use mesh or \
         generate",
    )]);
}

#[test]
fn more_triangles_than_ids_are_refused_before_anything_is_drawn() {
    let text = "[[object]]\ngenerate = { kind = 'grid', divisions = [100, 100] }\n\
                instances = { grid = { count = [1000, 300, 1], spacing = 1 } }";
    let error = read(text).expect_err("there are too many").to_string();
    let says = "the scene has 6000000000 primitives; at most 4294967294 can be told apart";
    assert!(error.ends_with(says), "{error}");
}

const EXAMPLE: &str = "[camera]\neye = [0, 1, 4]\nlook_at = [0, 0, 0]\nimage = [64, 48]\n
[material.clay]\ncolor = '#c8553d'\n[[light]]\npoint = [1, 2, 3]\n[[object]]\n
sphere = { center = [0, 0, 0], radius = 1 }\nmaterial = 'clay'\n[[object]]\n
generate = { kind = 'grid', divisions = [2, 2] }\nscale = 2\n
rotate = { axis = [0, 1, 0], degrees = 30 }\n";

/// Checks that a text is read, or refused at a place that lies in the text.
fn check_any(text: &str) {
    if let Err(error) = read(text) {
        assert!(!error.to_string().is_empty());
        assert!(error.text.get(error.span.clone()).is_some(), "{:?} of {text:?}", error.span);
    }
}

/// Pieces of scene files. Random sequences of them sometimes get past the TOML parser.
fn word() -> impl Strategy<Value = String> {
    let pieces = [
        "[camera]\n",
        "[[object]]\n",
        "[[light]]\n",
        "[material.a]\n",
        "[material]\n",
        "eye = ",
        "look_at = ",
        "up = ",
        "u = ",
        "image = ",
        "viewport = ",
        "distance = ",
        "sphere = ",
        "triangle = ",
        "plane = ",
        "generate = ",
        "scale = ",
        "rotate = ",
        "translate = ",
        "instances = ",
        "[[1, 2, 3]]",
        "{ grid = { count = [2, 1, 2], spacing = 2 } }",
        "{ scatter = { count = 3, size = [1, 2, 3], scale = [1, 2] } }",
        "{ center = [0, 0, 0], radius = 1 }",
        "{ kind = 'grid', divisions = [1, 1] }",
        "{ axis = [1, 2, 3], degrees = ",
        "[1, 2, 3]",
        "[0, 0, 0]",
        "[640, 480]",
        "1",
        "-1",
        "1e38",
        "nan",
        "'a'",
        "true",
        "\n",
        "\n",
        "\n",
        " }",
        "]",
        "\u{feff}",
        "é",
        "\"",
        "#000000",
        "\0",
        "\r\n",
        "material = 'a'\n",
        "color = ",
    ];
    proptest::sample::select(pieces.to_vec()).prop_map(str::to_owned)
}
