//! What is wrong with objects: their shapes, where they are, and their instances.

use super::{check_errors, read};

#[test]
#[expect(clippy::too_many_lines, reason = "it is a table of cases")]
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
            "[[object]]\nmesh = 'a.glb#cam A'",
            "'a.glb#cam A'",
            "2:8: mesh is \"a.glb#cam A\", and a camera (#NAME) cannot be named here; name \"a.glb\" alone, and state the camera \
             in [camera], as `bothways scenes FILE#NAME` prints it",
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
#[expect(clippy::too_many_lines, reason = "it is a table of cases")]
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
fn instances_may_make_more_triangles_than_have_ids_of_32_bits() {
    let text = "[[object]]\ngenerate = { kind = 'grid', divisions = [100, 100] }\n\
                instances = { grid = { count = [1000, 300, 1], spacing = 1 } }";
    let scene = read(text).expect("memory holds one mesh").scene;
    assert_eq!((scene.primitive_count(), scene.has_wide_ids()), (6_000_000_000, true));
}
