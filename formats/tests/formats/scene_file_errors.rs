//! Scene files that are wrong: the messages, and the places that they name.

mod objects;

use bothways_formats::scene_file::{self, LocatedError, ReadSceneError, SceneFile};
use bothways_formats::source::{Files, InputFile, Reach};
use proptest::prelude::*;
use std::path::Path;

fn read(text: &str) -> Result<SceneFile, LocatedError> {
    match scene_file::parse(
        "scene.toml",
        text,
        &Files::in_folder(Path::new("no-such-folder"), Reach::Folder),
    ) {
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
        (
            "[[object]]\ntriangle = [[0, 0, 0]]",
            "[[0, 0, 0]]",
            "2:12: triangle is an array; it must be a table; write for example triangle = { a = [0, 0, 0], \
             b = [1, 0, 0], c = [0, 1, 0] }",
        ),
        (
            "[[object]]\nsphere = 1",
            "1",
            "2:10: sphere is a whole number; it must be a table; write for example sphere = { center = [0, 0, 0], \
             radius = 1 }",
        ),
    ]);
}

#[test]
fn numbers_without_a_comma_are_no_text() {
    check_errors(&[(
        "[camera]\neye = [0, 0 5]",
        "0 5",
        "2:11: string values must be quoted, expected literal string; put a text in quotes, and a comma between two \
         values",
    )]);
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
#[expect(clippy::too_many_lines, reason = "it is a table of cases")]
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
#[expect(clippy::too_many_lines, reason = "it is a table of cases")]
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
fn a_scene_file_that_cannot_be_read_is_named() {
    let folder = std::env::temp_dir().join(format!("bothways-scene-file-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let says = |path: &Path| {
        scene_file::read(&InputFile::on_disk(path, Reach::Folder)).unwrap_err().to_string()
    };

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
    let read = scene_file::read(&InputFile::on_disk(&scene, Reach::Folder)).unwrap();
    assert_eq!(read.scene.primitive_count(), 1);
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
