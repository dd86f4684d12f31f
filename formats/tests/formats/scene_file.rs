//! Scene files that are right, and the scenes and cameras that they describe.

use bothways_common::glam::Vec3;
use bothways_common::{
    Camera, CameraDescription, Light, Material, Orientation, Plane, Projection, Shape, Sphere,
    Triangle,
};
use bothways_formats::scene_file::{self, ReadSceneError, SceneFile};
use bothways_formats::source::Files;

fn read(text: &str) -> Result<SceneFile, ReadSceneError> {
    scene_file::parse("scene.toml", text, &Files::none())
}

const SPHERE: &str = "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\n";

/// Reads a file of these lines, followed by one sphere.
fn with_sphere(text: &str) -> SceneFile {
    read(&format!("{text}\n{SPHERE}")).expect("it is right")
}

/// Reads a file of one object with these lines, and returns its shape.
fn shape(lines: &str) -> Shape {
    let file = read(&format!("[[object]]\n{lines}")).expect("it is right");
    file.scene.objects()[0].shape.clone()
}

#[test]
fn every_key_is_read() {
    let file = read(
        r##"
        [camera]
        projection = "parallel"
        eye = [0, 1, 4]
        direction = [0.5, 0, -1e1]
        up = [0, 1, 0.25]
        distance = 1.5
        viewport = [1.6, 1.0]
        image = [640, 400]
        background = "#000000"

        [material.clay]
        color = "#FF0000"
        specular = 0.2
        shininess = 40

        [[light]]
        directional = [-1, -2, -1]
        intensity = 0.8

        [[light]]
        point = [1, 2, 3]

        [[light]]
        ambient = true
        intensity = 0.25

        [[object]]
        triangle = { a = [0, 0, 0], b = [1, 0, 0], c = [0, 1, 0] }
        material = "clay"

        [[object]]
        sphere = { center = [0, 0, 0], radius = 0x10 }

        [[object]]
        plane = { point = [0, -1, 0], normal = [0, 1, 0] }
        "##,
    )
    .unwrap();
    let view = Vec3::new(0.5, 0.0, -10.0);
    let expected = CameraDescription {
        projection: Projection::Parallel,
        eye: Vec3::new(0.0, 1.0, 4.0),
        orientation: Orientation::Direction { direction: view, up: Vec3::new(0.0, 1.0, 0.25) },
        distance: 1.5,
        viewport: [1.6, 1.0],
        image: [640, 400],
    };
    assert_eq!(file.camera, expected);
    assert!(file.viewport_stated);
    assert_eq!(file.scene.background, Vec3::ZERO);
    let lights = [
        Light::Directional { direction: Vec3::new(-1.0, -2.0, -1.0), intensity: 0.8 },
        Light::Point { position: Vec3::new(1.0, 2.0, 3.0), intensity: 1.0 },
        Light::Ambient { intensity: 0.25 },
    ];
    assert_eq!(file.scene.lights, lights);
    let [triangle, sphere, plane] = file.scene.objects() else { panic!("three objects") };
    let clay = Material { color: Vec3::X, specular: 0.2, shininess: 40.0, ..Material::default() };
    assert_eq!(triangle.material, clay);
    let corners = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };
    assert_eq!(triangle.shape, Shape::Triangle(corners));
    assert_eq!(sphere.material, Material::default());
    assert_eq!(sphere.shape, Shape::Sphere(Sphere { center: Vec3::ZERO, radius: 16.0 }));
    assert_eq!(plane.shape, Shape::Plane(Plane { point: Vec3::NEG_Y, normal: Vec3::Y }));
}

#[test]
fn what_is_not_stated_has_a_default() {
    let file = with_sphere("");
    assert_eq!(file.camera, CameraDescription::default());
    assert!(!file.viewport_stated);
    assert_eq!(file.scene.lights.len(), 2, "those of Scene::new");

    let wide = with_sphere("[camera]\nimage = [1000, 500]\n");
    assert_eq!(wide.camera.viewport, [2.0, 1.0]);
    let aimed = with_sphere("[camera]\neye = [0, 0, 2]\nlook_at = [0, 0, 0]\n");
    let orientation = Orientation::LookAt { target: Vec3::ZERO, up: Vec3::Y };
    assert_eq!(aimed.camera.orientation, orientation);
    let held = with_sphere("[camera]\nup = [1, 0, 0]\n");
    let orientation = Orientation::Direction { direction: Vec3::NEG_Z, up: Vec3::X };
    assert_eq!(held.camera.orientation, orientation);
}

#[test]
fn a_camera_may_state_its_frame() {
    let file = with_sphere("[camera]\nu = [0, 0, 1]\nv = [0, 1, 0]\nw = [-1, 0, 0]");
    let camera = Camera::new(file.camera).unwrap();
    assert_eq!(camera.u().as_vec3(), Vec3::Z);
    assert_eq!(camera.w().as_vec3(), Vec3::NEG_X);
}

#[test]
fn an_empty_list_of_objects_is_an_empty_scene() {
    assert_eq!(read("object = []").unwrap().scene.primitive_count(), 0);
}

#[test]
fn numbers_are_the_nearest_f32() {
    // Just above the middle between 1 and its successor. Rounded to `f64` first, it would be a tie and become 1.
    let text = "sphere = { center = [0, 0, 0], radius = 1.00000005960464477539062501 }";
    let Shape::Sphere(sphere) = shape(text) else { panic!("a sphere") };
    assert_eq!(sphere.radius, 1.0 + f32::EPSILON);
    let text = "sphere = { center = [-0.0, 1_000, +7], radius = 1e-45 }";
    let Shape::Sphere(sphere) = shape(text) else { panic!("a sphere") };
    assert_eq!(sphere.center.to_array().map(f32::to_bits), [-0.0, 1000.0, 7.0].map(f32::to_bits));
    assert_eq!(sphere.radius, f32::from_bits(1));
}

#[test]
fn objects_are_scaled_then_turned_then_moved() {
    let put = "scale = 2\nrotate = { axis = [0, 0, 3], degrees = 90 }\ntranslate = [5, 0, 0]";
    let triangle = "triangle = { a = [1, 0, 0], b = [0, 1, 0], c = [0, 0, 1] }";
    let expected = Triangle {
        a: Vec3::new(5.0, 2.0, 0.0),
        b: Vec3::new(3.0, 0.0, 0.0),
        c: Vec3::new(5.0, 0.0, 2.0),
    };
    assert_eq!(shape(&format!("{triangle}\n{put}")), Shape::Triangle(expected));
    let sphere = "sphere = { center = [1, 0, 0], radius = 0.5 }";
    let expected = Sphere { center: Vec3::new(5.0, 2.0, 0.0), radius: 1.0 };
    assert_eq!(shape(&format!("{sphere}\n{put}")), Shape::Sphere(expected));
    let plane = "plane = { point = [1, 0, 0], normal = [2, 0, 0] }";
    let expected = Plane { point: Vec3::new(5.0, 2.0, 0.0), normal: Vec3::new(0.0, 2.0, 0.0) };
    assert_eq!(shape(&format!("{plane}\n{put}")), Shape::Plane(expected));

    let torus = "generate = { kind = \"torus\", divisions = [8, 4] }";
    let (Shape::Mesh(own), Shape::Mesh(moved)) = (shape(torus), shape(&format!("{torus}\n{put}")))
    else {
        panic!("two meshes")
    };
    assert_eq!(own.triangles(), moved.triangles());
    for (p, q) in own.positions().iter().zip(moved.positions()) {
        // Scaling by 2 and a quarter turn are exact; 5 − 2y is rounded once.
        assert_eq!(*q, Vec3::new(5.0 - 2.0 * p.y, 2.0 * p.x, 2.0 * p.z));
    }
    for (p, q) in own.normals().values.iter().zip(&moved.normals().values) {
        assert_eq!(*q, Vec3::new(-p.y, p.x, p.z));
    }
}

/// The places in which a square with sides of 1 is there.
fn places(instances: &str) -> Vec<[[f32; 4]; 3]> {
    let square = "generate = { kind = \"grid\", divisions = [1, 1] }";
    let Shape::Instances(read) = shape(&format!("{square}\n{instances}")) else {
        panic!("instances")
    };
    let Shape::Mesh(own) = shape(square) else { panic!("a mesh") };
    assert_eq!(*read.mesh(), own, "the mesh stays as it is");
    read.placements().iter().map(|placement| *placement.rows()).collect()
}

#[test]
fn instances_are_listed_or_follow_a_rule() {
    let moved =
        |x: f32, y: f32, z: f32| [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]];
    assert_eq!(places("instances = []"), [[[0.0; 4]; 3]; 0]);
    let listed = places(
        "instances = [[1, 2, 3], [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], {}, \
         { scale = [1, -2, 1], rotate = { axis = [0, 0, 1], degrees = 90 }, translate = [5, 0, 0] }]",
    );
    let rows = [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0], [9.0, 10.0, 11.0, 12.0]];
    let turned = [[0.0, 2.0, 0.0, 5.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    assert_eq!(listed, [moved(1.0, 2.0, 3.0), rows, moved(0.0, 0.0, 0.0), turned]);

    let grid = places("instances = { grid = { count = [2, 1, 2], spacing = [3, 9, 0.5] } }");
    let corners = [[-1.5, -0.25], [1.5, -0.25], [-1.5, 0.25], [1.5, 0.25]];
    assert_eq!(grid, corners.map(|[x, z]| moved(x, 0.0, z)));
    let line = places("instances = { grid = { count = [3, 1, 1], spacing = 2 } }");
    assert_eq!(line, [-2.0, 0.0, 2.0].map(|x| moved(x, 0.0, 0.0)));
    // It does not look for them row by row.
    let none = "instances = { grid = { count = [0, 4294967295, 4294967295], spacing = 2 } }";
    assert!(places(none).is_empty());

    let scattered = |more: &str| {
        places(&format!("instances = {{ scatter = {{ count = 500, size = [4, 0, 8]{more} }} }}"))
    };
    let (first, other) = (scattered(""), scattered(", seed = 1"));
    assert_eq!((first.len(), &first), (500, &scattered(", seed = 0")));
    assert_ne!(first, other);
    let reach = |axis: usize| first.iter().map(|rows| rows[axis][3].abs()).fold(0.0, f32::max);
    assert!(reach(0) <= 2.0 && reach(0) > 1.9 && reach(1) == 0.0 && reach(2) <= 4.0);
    for [x, y, z] in scattered(", turn = [0, 2, 0], scale = [2, 3]") {
        let size = (x[0] * x[0] + z[0] * z[0]).sqrt();
        assert!((1.999..3.001).contains(&size) && (y[1] - size).abs() < 1e-4 && y[0] == 0.0);
    }
}

#[test]
fn an_object_of_instances_is_moved_before_they_are() {
    let text =
        "generate = { kind = \"grid\", divisions = [1, 1] }\nscale = 2\ninstances = [[5, 0, 0]]";
    let Shape::Instances(placed) = shape(text) else { panic!("instances") };
    let xs = placed.corners(0).map(|corner| corner.x);
    assert!(xs.iter().all(|x| [3.0, 7.0].contains(x)), "{xs:?}");
    assert_eq!(placed.primitive_count(), placed.mesh().triangles().len());
}
