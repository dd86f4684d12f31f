//! Printed cameras, read by the rules of the systems that they are for: points lie where our rays put them.

mod readers;

use super::*;
use crate::common::glam::{DVec3, Vec3};
use crate::common::{
    Camera, CameraDescription, Orientation, Primitive, Projection, Scene, Shape, Sphere,
};
use crate::scenes;
use readers::Reader;

fn scene() -> Scene {
    let ball = Shape::Sphere(Sphere { center: Vec3::new(0.5, 0.0, -9.0), radius: 1.0 });
    Scene::new(vec![ball.into()]).unwrap()
}

fn look_at(eye: [f32; 3], target: [f32; 3], up: [f32; 3]) -> CameraDescription {
    let [eye, target, up] = [eye, target, up].map(Vec3::from_array);
    let orientation = Orientation::LookAt { target, up };
    CameraDescription { eye, orientation, ..CameraDescription::default() }
}

/// Cameras of every sort, with words for messages.
fn cameras() -> Vec<(&'static str, CameraDescription)> {
    let square = |camera: CameraDescription| CameraDescription {
        viewport: [camera.width_of_square_pixels(), camera.viewport[1]],
        ..camera
    };
    let lecture = look_at([1.0, 2.1, 6.8], [0.1, 0.75, 0.0], [0.0, 1.0, 0.0]);
    let rolled = look_at([-3.0, 0.5, 2.0], [0.5, -1.0, -9.0], [1.0, 0.7, 0.3]);
    let skew = Orientation::Frame {
        u: Vec3::new(0.8, 0.0003, -0.6),
        v: Vec3::new(0.0, 1.0, 0.0004),
        w: Vec3::new(0.6, 0.0005, 0.8),
    };
    let parallel = |camera| CameraDescription { projection: Projection::Parallel, ..camera };
    let long = |camera| CameraDescription { viewport: [3.1, 0.9], image: [333, 411], ..camera };
    vec![
        (
            "canonical",
            CameraDescription { viewport: [1.0, 1.0], image: [48, 48], ..Default::default() },
        ),
        ("lecture", CameraDescription { distance: 2.0, ..lecture }),
        ("rolled", square(CameraDescription { image: [321, 200], distance: 0.7, ..rolled })),
        ("rolled, long pixels", long(CameraDescription { distance: 1.7, ..rolled })),
        (
            "skew, far away",
            CameraDescription {
                eye: Vec3::new(1000.5, -2000.25, 300.1),
                orientation: skew,
                ..CameraDescription::default()
            },
        ),
        ("wide", square(CameraDescription { viewport: [1.0, 45.0], ..lecture })),
        ("upside down", look_at([0.0, 3.0, 0.0], [0.0, 0.0, 0.01], [0.0, 0.0, 1.0])),
        (
            "parallel",
            parallel(CameraDescription { viewport: [6.4, 4.8], distance: 3.0, ..lecture }),
        ),
        ("parallel, rolled, long pixels", parallel(long(rolled))),
    ]
}

/// Whether a system can express a camera with these words.
fn expresses(system: System, words: &str) -> bool {
    let parallel = words.starts_with("parallel");
    match system {
        System::OpenCv | System::Colmap => !parallel,
        System::Mitsuba => parallel || !words.contains("long pixels"),
        _ => true,
    }
}

fn printed(view: &View, system: System) -> Result<Reader, ExchangeError> {
    let text = exchange(view, system, StatedDepths::default())?.text();
    Ok(Reader::new(system, &text))
}

/// The point at a parameter `t` on the ray through a place of the image: column and row, as real numbers, pixel middles at ½.
fn point(camera: &Camera, [column, row]: [f64; 2], t: f64) -> DVec3 {
    let ([vw, vh], [width, height]) = (camera.viewport(), camera.image().map(f64::from));
    let ray = camera.ray_through(vw * (column / width - 0.5), vh * (0.5 - row / height));
    camera.eye().as_dvec3() + ray.origin + t * ray.direction
}

#[test]
fn points_lie_where_our_rays_put_them() {
    let scene = scene();
    let mut read = [0; 8];
    for (words, description) in cameras() {
        let camera = Camera::new(description).unwrap();
        let view = View::new(&scene, &camera);
        let [width, height] = camera.image().map(f64::from);
        for (number, system) in System::ALL.into_iter().enumerate() {
            let reader = match printed(&view, system) {
                Ok(reader) if expresses(system, words) => reader,
                Err(_) if !expresses(system, words) => continue,
                other => panic!("{words}, {system:?}: {:?}", other.err()),
            };
            read[number] += 1;
            assert_eq!(reader.image(), camera.image(), "{words}, {system:?}");
            // Both take pixels for squares that are so up to the roundings of the viewport to `f32`.
            let rounded = [System::Mitsuba, System::Blender].contains(&system);
            let within = if rounded { 1e-4 } else { 1e-6 };
            for column in [0.0, 0.5, 0.31 * width, width - 0.5, 1.25 * width] {
                for row in [0.0, 0.5, 0.77 * height, height, -0.2 * height] {
                    for t in [0.6, 1.0, 37.0] {
                        let [x, y] = reader.pixel(point(&camera, [column, row], t).to_array());
                        let apart = (x - column).abs().max((y - row).abs());
                        assert!(
                            apart < within,
                            "{words}, {system:?}: ({x}, {y}) instead of ({column}, {row})"
                        );
                    }
                }
            }
        }
    }
    assert_eq!(read, [9, 9, 9, 9, 8, 9, 7, 7]);
}

/// The pixel whose viewing ray passes nearest to a point, in the plane of that point.
fn nearest_pixel(camera: &Camera, point: DVec3) -> [u32; 2] {
    let [width, height] = camera.image();
    let all = (0..height).flat_map(|i| (0..width).map(move |j| [i, j]));
    let distance = |&[i, j]: &[u32; 2]| {
        let ray = camera.viewing_ray(i, j);
        let t = (point - ray.origin).dot(camera.w()) / ray.direction.dot(camera.w());
        (ray.origin + t * ray.direction - point).length()
    };
    all.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap()
}

#[test]
fn vertices_of_a_built_in_scene_lie_on_the_same_pixels() {
    let loaded = scenes::load("canonical").unwrap();
    for projection in [Projection::Perspective, Projection::Parallel] {
        let large = if projection == Projection::Parallel { 6.0 } else { 1.0 };
        // Odd sizes: no vertex lies on the border of pixels.
        let mut description = CameraDescription { projection, image: [131, 97], ..loaded.camera };
        description.viewport[1] = large;
        description.viewport[0] = description.width_of_square_pixels();
        let camera = Camera::new(description).unwrap();
        let view = View::new(&loaded.scene, &camera);
        let corners = view.primitives().flat_map(|(_, primitive)| match primitive {
            Primitive::Triangle(corners) => corners.to_vec(),
            Primitive::Sphere { center, .. } => vec![center],
            Primitive::Plane { .. } => Vec::new(),
        });
        let corners: Vec<DVec3> = corners.collect();
        assert_eq!(corners.len(), 4);
        for system in System::ALL {
            let Ok(reader) = printed(&view, system) else {
                assert!(!expresses(system, "parallel") && projection == Projection::Parallel);
                continue;
            };
            for &corner in &corners {
                let [i, j] = nearest_pixel(&camera, corner).map(f64::from);
                let [x, y] = reader.pixel((camera.eye().as_dvec3() + corner).to_array());
                assert_eq!([y.floor(), x.floor()], [i, j], "{system:?} {projection:?} {corner}");
            }
        }
    }
}

#[test]
fn without_stated_depths_opengl_s_matrices_are_those_of_the_camera_command() {
    let scene = scene();
    for (words, description) in cameras() {
        let camera = Camera::new(description).unwrap();
        let view = View::new(&scene, &camera);
        let ours = crate::opengl::matrices(&view);
        let Ok(Exchanged::OpenGl(found)) = exchange(&view, System::OpenGl, StatedDepths::default())
        else {
            panic!("{words}");
        };
        assert_eq!((found.view, found.projection), (ours.view, ours.projection), "{words}");
        assert_eq!(found.projection_reversed_depth, ours.reversed, "{words}");
        assert_eq!((found.near, found.far), (ours.near, ours.far), "{words}");
    }
}

#[test]
fn stated_depths_are_those_of_the_planes() {
    let scene = scene();
    let stated = StatedDepths { near: Some(0.25), far: Some(80.0) };
    for (words, description) in cameras() {
        let camera = Camera::new(description).unwrap();
        let view = View::new(&scene, &camera);
        for (system, nearest) in
            [(System::OpenGl, -1.0), (System::Vulkan, 0.0), (System::DirectX, 0.0)]
        {
            let reader = Reader::new(system, &exchange(&view, system, stated).unwrap().text());
            let at = |depth: f64| {
                let on_axis = camera.eye().as_dvec3() - depth * camera.w();
                reader.depths(on_axis.to_array())
            };
            for (found, expected) in [(at(0.25), [nearest, 1.0]), (at(80.0), [1.0, 0.0])] {
                let apart = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
                assert!(apart < 1e-9, "{words}, {system:?}: {found:?} instead of {expected:?}");
            }
        }
        if let Ok(Exchanged::Mitsuba(sensor)) = exchange(&view, System::Mitsuba, stated) {
            assert_eq!([sensor.near_clip, sensor.far_clip], [0.25, 80.0]);
        }
        let Ok(Exchanged::Blender(camera)) = exchange(&view, System::Blender, stated) else {
            panic!("{words}");
        };
        assert_eq!([camera.clip_start, camera.clip_end], [0.25, 80.0]);
    }
}

#[test]
fn planes_move_the_far_plane_back_where_there_must_be_one() {
    let loaded = scenes::load("canonical").unwrap();
    let camera = Camera::new(loaded.camera).unwrap();
    let found = |scene: &Scene| {
        let view = View::new(scene, &camera);
        match exchange(&view, System::Blender, StatedDepths::default()) {
            Ok(Exchanged::Blender(camera)) => [camera.clip_start, camera.clip_end],
            other => panic!("{other:?}"),
        }
    };
    // The ball ends at a depth of 10, the corners at 5.
    assert_eq!(found(&scene()), [1.0 / 1024.0, 16.0]);
    assert_eq!(found(&loaded.scene), [1.0 / 1024.0, 8.0 * 1024.0]);
}

#[test]
fn what_cannot_be_expressed_is_refused_in_words() {
    let scene = scene();
    let says = |change: &dyn Fn(&mut CameraDescription), system, near, far| {
        let mut description = CameraDescription::default();
        change(&mut description);
        let camera = Camera::new(description).unwrap();
        let stated = StatedDepths { near, far };
        exchange(&View::new(&scene, &camera), system, stated).unwrap_err().to_string()
    };
    let nothing = |_: &mut CameraDescription| ();
    let parallel = |camera: &mut CameraDescription| camera.projection = Projection::Parallel;
    assert_eq!(
        says(&parallel, System::OpenCv, None, None),
        "OpenCV has no parallel camera: all its rays meet in one point; --projection perspective gives it one that \
         sees what is looked at in the same size"
    );
    assert_eq!(
        says(&|camera| camera.viewport = [2.0, 1.0], System::Mitsuba, None, None),
        "Mitsuba's perspective camera has square pixels, but a viewport of 2 x 1 makes those of an image of 640x480 1.5 \
         times as wide as high; --viewport 1.33333337,1 makes them square"
            .replace("1.33333337", "1.3333334")
    );
    assert_eq!(
        says(&|camera| camera.viewport = [1.0, 300.0], System::Blender, None, None),
        "Blender has pixels of up to 200 times as wide as high, or as high as wide, and these are 0.0025 times as \
         wide as high; make --viewport or --size more like the other"
    );
    assert_eq!(
        says(&|camera| camera.image = [3, 480], System::Blender, None, None),
        "Blender's images have at least 4x4 pixels, and this one has 3x480; give a larger --size"
    );
    for system in [System::Pbrt, System::OpenCv, System::Colmap] {
        let expected = "has no near and no far plane; leave --near and --far out";
        assert!(says(&nothing, system, Some(1.0), None).ends_with(expected));
        assert!(says(&nothing, system, None, Some(1.0)).ends_with(expected));
    }
    for system in
        [System::OpenGl, System::Vulkan, System::DirectX, System::Mitsuba, System::Blender]
    {
        let near = says(&nothing, system, Some(0.0), None);
        assert!(near.starts_with("the near plane is at 0, but "), "{near}");
        let far = says(&nothing, system, Some(2.0), Some(2.0));
        assert!(
            far.starts_with("the far plane at 2 does not lie behind the near plane at 2;"),
            "{far}"
        );
        let endless = says(&nothing, system, None, Some(f64::INFINITY));
        assert!(
            endless.starts_with("the far plane is at inf, which is no finite number;"),
            "{endless}"
        );
        let behind = says(&parallel, system, Some(-1.0), None);
        assert!(behind.starts_with("the near plane is at -1, but "), "{behind}");
    }
    let tiny = says(&nothing, System::Blender, Some(1e-7), None);
    assert!(tiny.contains("Blender's is at 0.000001 at least; give a larger --near"), "{tiny}");
}
