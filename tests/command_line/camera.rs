//! `bothways camera`: the camera in numbers.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use serde_json::{Value, json};

fn camera(args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.arg("camera").args(args);
    command
}

fn report(args: &[&str]) -> Value {
    let output = camera(args).arg("--json").assert().code(0).stderr("").get_output().stdout.clone();
    serde_json::from_slice(&output).unwrap()
}

#[test]
fn the_canonical_camera_is_printed() {
    let output = camera(&["canonical"]).assert().code(0).stderr("").get_output().stdout.clone();
    insta::assert_snapshot!(String::from_utf8(output).unwrap(), @r"
    canonical: perspective camera

    eye            (0, 0, 0)
    u (right)      (1, 0, 0)
    v (up)         (0, 1, 0)
    w (back)       (0, 0, 1)
    d              1
    viewport       vw = 1, vh = 1
    image          W = 480, H = 480
    field of view  53.130 degrees across, 53.130 down

    OpenGL, with glViewport(0, 0, 480, 480); row i of the picture is its row 479 - i.
    Matrices are row by row, as 32-bit floats; glUniformMatrix4fv wants column by column: pass
    GL_TRUE as its transpose argument, or transpose them.

    view (camera_from_world)
      1.0  0.0  0.0  0.0
      0.0  1.0  0.0  0.0
      0.0  0.0  1.0  0.0
      0.0  0.0  0.0  1.0

    projection: near plane at 0.0009765625, far plane at infinity, depths -1 to 1
               2.0           0.0           0.0           0.0
               0.0           2.0           0.0           0.0
               0.0           0.0          -1.0  -0.001953125
               0.0           0.0          -1.0           0.0

    the same with reversed depth, 1 to 0: glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE),
    glDepthFunc(GL_GREATER), glClearDepth(0)
               2.0           0.0           0.0           0.0
               0.0           2.0           0.0           0.0
               0.0           0.0           0.0  0.0009765625
               0.0           0.0          -1.0           0.0

    This program's rays have no near and no far plane; OpenGL cuts off what is beyond. It also
    rounds vertices to a grid, so that pixels on an edge may differ.
    ");
}

#[test]
fn json_has_frame_viewport_and_matrices() {
    let report = report(&["canonical"]);
    assert_eq!(report["scene"], "canonical");
    assert_eq!(report["projection"], "perspective");
    assert_eq!((&report["w"], &report["distance"]), (&json!([0.0, 0.0, 1.0]), &json!(1.0)));
    assert_eq!((&report["viewport"], &report["image"]), (&json!([1.0, 1.0]), &json!([480, 480])));
    let opengl = &report["opengl"];
    assert_eq!((&opengl["layout"], &opengl["far"]), (&json!("row-major"), &Value::Null));
    assert_eq!(opengl["view"][3], json!([0.0, 0.0, 0.0, 1.0]));
    assert_eq!(opengl["projection"][0], json!([2.0, 0.0, 0.0, 0.0]));
    assert_eq!(opengl["projection"][3], json!([0.0, 0.0, -1.0, 0.0]));
}

#[test]
fn the_camera_can_be_changed() {
    let report =
        report(&["canonical", "--eye", "1,2,3", "--projection=parallel", "--viewport=4,2"]);
    assert_eq!(report["eye"], json!([1.0, 2.0, 3.0]));
    assert_eq!(
        (&report["projection"], &report["field_of_view_degrees"]),
        (&json!("parallel"), &Value::Null)
    );
    let opengl = &report["opengl"];
    assert_eq!(opengl["view"][2], json!([0.0, 0.0, 1.0, -3.0]));
    assert_eq!(opengl["projection"][1], json!([0.0, 1.0, 0.0, 0.0]));
    assert!(opengl["far"].as_f64().unwrap() > 0.0);
}

#[test]
fn numbers_are_as_short_as_they_read_back() {
    let args = ["lecture", "--eye=1,2.1,6.8", "--distance=0.7", "--size=640x480"];
    let output = camera(&args).assert().code(0).get_output().stdout.clone();
    let text = String::from_utf8(output).unwrap();
    assert!(text.contains("eye            (1, 2.1, 6.8)\n"), "{text}");
    assert!(text.contains("d              0.7\n"), "{text}");
    assert!(text.contains("vw = 1.3333334, vh = 1\n"), "{text}");
    assert!(text.contains("near plane at 0.00068359374, far"), "{text}");
    let report = report(&args);
    let stored: Vec<String> =
        report["eye"].as_array().unwrap().iter().map(Value::to_string).collect();
    assert_eq!(stored, ["1.0", "2.1", "6.8"]);
    let viewport: f32 = report["viewport"][0].to_string().parse().unwrap();
    assert_eq!(viewport, 640.0 / 480.0);
}

#[test]
fn a_field_of_view_and_its_viewport_are_both_printed() {
    let args = ["canonical", "--fov", "40", "--distance", "2", "--size", "320x160"];
    let output = camera(&args).assert().code(0).get_output().stdout.clone();
    let text = String::from_utf8(output).unwrap();
    // 2 · 2 · tan 20° = 1.4558809…, and twice that.
    assert!(text.contains("vw = 2.9117618, vh = 1.4558809\n"), "{text}");
    assert!(text.contains(" across, 40.000 down\n"), "{text}");
    let report = report(&args);
    assert!((report["field_of_view_degrees"][1].as_f64().unwrap() - 40.0).abs() < 1e-5);
}

#[test]
fn a_camera_for_blender_is_a_script() {
    let args = ["canonical", "--as", "blender", "--near", "0.5", "--far", "64"];
    let output = camera(&args).assert().code(0).stderr("").get_output().stdout.clone();
    insta::assert_snapshot!(String::from_utf8(output).unwrap(), @r#"
    # Blender, for its Python console. Coordinates are those of the scene: import meshes without turning
    # them (forward Y, up Z). What is beyond clip_start and clip_end is cut off.
    import bpy
    from mathutils import Matrix

    data = bpy.data.cameras.new("bothways")
    data.type = 'PERSP'
    data.sensor_fit = 'HORIZONTAL'
    data.sensor_width = 36.0
    data.lens = 36.0
    data.shift_x = 0.0
    data.shift_y = 0.0
    data.clip_start = 0.5
    data.clip_end = 64.0

    camera = bpy.data.objects.new("bothways", data)
    camera.matrix_world = Matrix((
        (1.0, 0.0, 0.0, 0.0),
        (0.0, 1.0, 0.0, 0.0),
        (0.0, 0.0, 1.0, 0.0),
        (0.0, 0.0, 0.0, 1.0),
    ))

    scene = bpy.context.scene
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x = 480
    scene.render.resolution_y = 480
    scene.render.resolution_percentage = 100
    scene.render.pixel_aspect_x = 1.0
    scene.render.pixel_aspect_y = 1.0
    "#);
}

#[test]
fn every_system_has_text_and_json_of_the_same_numbers() {
    let systems = [
        ("opengl", "OpenGL", "projection"),
        ("vulkan", "Vulkan", "projection"),
        ("directx", "DirectX", "projection"),
        ("pbrt", "pbrt", "screen_window"),
        ("mitsuba", "Mitsuba", "to_world"),
        ("blender", "Blender", "matrix_world"),
        ("opencv", "OpenCV", "r"),
        ("colmap", "COLMAP", "quaternion"),
    ];
    for (word, name, what) in systems {
        let args = ["lecture", "--as", word, "--eye=1,2.1,6.8"];
        let output = camera(&args).assert().code(0).stderr("").get_output().stdout.clone();
        let text = String::from_utf8(output).unwrap();
        let report = report(&args);
        assert_eq!((&report["scene"], &report["system"]), (&json!("lecture"), &json!(name)));
        let rows = report["camera"][what].as_array().unwrap();
        let cells: Vec<&Value> = rows
            .iter()
            .flat_map(|row| row.as_array().map_or(vec![row], |row| row.iter().collect()))
            .collect();
        assert!(cells.len() >= 4, "{word}: {report}");
        for cell in cells {
            assert!(text.contains(&cell.to_string()), "{word}: no {cell} in\n{text}");
        }
    }
}
