//! Eyes far from the scene, up to a billion times its size: the visible primitives stay right, and work skipped from
//! near is also skipped from afar.

#![expect(clippy::cast_possible_truncation, reason = "small numbers")]

use crate::four_renderers::all_agree;
use bothways::common::glam::Vec3;
use bothways::common::{
    Camera, CameraDescription, Crop, Frame, Mesh, Object, Options, Orientation, Plane, Projection,
    Scene, Shape, Sphere, View, Work,
};
use bothways::{rasterize, raytrace};
use bothways_test_support::{Dice, PROJECTIONS, assert_same_visibility, mesh, scene};

/// The directions of the eyes from the scene: along an axis, along no axis, and almost along one.
const WAYS: [Vec3; 3] =
    [Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.55, 0.4, 0.73), Vec3::new(1.0, 1e-4, 1e-9)];

/// Triangles of this size, with coordinates from about −2 to 2.
fn soup(count: usize, size: f32) -> Mesh {
    let mut dice = Dice(1);
    let mut positions = Vec::new();
    for _ in 0..count {
        let middle = 2.0 * dice.point();
        positions.extend([(); 3].map(|()| middle + 0.5 * size * dice.point()));
    }
    let triangles = (0..count as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Mesh::new(positions, triangles).expect("it is a mesh")
}

/// Triangles of several sizes, two of them twice, some in one plane, balls and perhaps a ground.
fn mixture(with_ground: bool) -> Scene {
    let mut dice = Dice(1);
    let mut objects = vec![mesh(soup(60, 0.2)), mesh(soup(12, 3.0)), mesh(soup(2, 3.0))];
    let flat = |corner: Vec3| Vec3::new(corner.x, corner.y, 0.25);
    let mut in_one_plane = soup(8, 2.0).positions().to_vec();
    in_one_plane.iter_mut().for_each(|corner| *corner = flat(*corner));
    let triangles = (0..8).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    objects.push(mesh(Mesh::new(in_one_plane, triangles).expect("it is a mesh")));
    for radius in [0.05, 0.4, 0.9] {
        objects.push(Shape::Sphere(Sphere { center: 2.0 * dice.point(), radius }).into());
    }
    if with_ground {
        objects.push(Object::from(Shape::Plane(Plane {
            point: Vec3::new(0.0, -1.0, 0.0),
            normal: Vec3::new(0.1, 1.0, 0.05),
        })));
    }
    scene(objects)
}

/// A camera at a multiple of an offset. Its picture is 5 wide at the target, which is the origin.
fn from_afar(projection: Projection, way: Vec3, distance: f32, image: [u32; 2]) -> Camera {
    let eye = distance * way;
    let wide = match projection {
        Projection::Perspective => 5.0 / eye.length(),
        Projection::Parallel => 5.0,
    };
    let height = wide * image[1] as f32 / image[0] as f32;
    Camera::new(CameraDescription {
        projection,
        eye,
        orientation: Orientation::LookAt { target: Vec3::ZERO, up: Vec3::Y },
        distance: 1.0,
        viewport: [wide, height],
        image,
    })
    .expect("it is a camera")
}

#[test]
fn the_fast_renderers_see_from_afar_what_the_textbooks_see() {
    for with_ground in [false, true] {
        let scene = mixture(with_ground);
        for projection in PROJECTIONS {
            for way in WAYS {
                for exponent in 1..=9 {
                    let camera = from_afar(projection, way, 10f32.powi(exponent), [37, 28]);
                    let view = View::new(&scene, &camera);
                    let what = format!("{projection:?} from {way} at 10^{exponent}");
                    let frame = all_agree(&view, &Options::default(), &what);
                    assert!(
                        frame.ids().iter().any(|id| id.is_some_and(|id| id < 200)),
                        "{what}: something is seen"
                    );
                }
            }
        }
    }
}

/// The counts of both orders. Asserts that both orders see the same primitives.
fn counted(scene: &Scene, camera: &Camera, what: &str) -> [Work; 2] {
    let (view, options) = (View::new(scene, camera), Options::default());
    let mut frames = [(); 2].map(|()| Frame::new(camera, &options));
    let mut works = [Work::default(); 2];
    let ([object, image], [object_work, image_work]) = (&mut frames, &mut works);
    let prepared = rasterize::fast::prepare(scene);
    rasterize::fast::determine_visibility(&prepared, &view, &options, object, object_work);
    let prepared = raytrace::fast::prepare(scene);
    raytrace::fast::determine_visibility(&prepared, &view, &options, image, image_work);
    assert_same_visibility(&frames[0], &frames[1], what);
    works
}

#[test]
fn a_parallel_eye_tests_from_afar_what_it_tests_from_near() {
    // Parallel rays show the same from anywhere along them, but for the rounding of offsets.
    let scene = scene(vec![mesh(soup(3000, 0.1))]);
    for way in WAYS {
        let at = |distance: f32| {
            let camera = from_afar(Projection::Parallel, way, distance, [160, 120]);
            counted(&scene, &camera, &format!("from {way} at {distance:e}"))
        };
        let near = at(20.0);
        for distance in [1e4, 1e5, 1e6, 1e7] {
            let far = at(distance);
            for (order, (near, far)) in
                ["object order", "image order"].into_iter().zip(near.into_iter().zip(far))
            {
                let what = format!("{order}, from {way} at {distance:e}: {far:?}, near {near:?}");
                assert!(far.tests <= near.tests + near.tests / 4, "{what}");
                assert!(far.nodes <= near.nodes + near.nodes / 4, "{what}");
                let judged = |work: Work| work.judged_coverage + work.judged_nearest;
                assert!(judged(far) <= judged(near) + near.fragments / 100, "{what}");
            }
        }
    }
}

#[test]
fn a_perspective_eye_tests_from_afar_little_more_than_from_near() {
    let scene = scene(vec![mesh(soup(3000, 0.1))]);
    for way in WAYS {
        let at = |distance: f32| {
            let camera = from_afar(Projection::Perspective, way, distance, [160, 120]);
            counted(&scene, &camera, &format!("from {way} at {distance:e}"))
        };
        let near = at(100.0);
        for distance in [1e4, 1e5, 1e6] {
            let far = at(distance);
            for (order, (near, far)) in
                ["object order", "image order"].into_iter().zip(near.into_iter().zip(far))
            {
                let what = format!("{order}, from {way} at {distance:e}: {far:?}, near {near:?}");
                println!("{what}");
                assert!(far.tests <= 2 * near.tests, "{what}");
                assert!(far.nodes <= 2 * near.nodes, "{what}");
            }
        }
    }
}

#[test]
fn far_spheres_that_a_ray_nearly_touches() {
    // The distance from such a sphere's centre to a viewing ray is its radius, as nearly as `f32` can store them.
    let description = CameraDescription {
        projection: Projection::Parallel,
        orientation: Orientation::Direction {
            direction: Vec3::new(0.6, 0.1, -0.7),
            up: Vec3::new(0.13, 1.0, 0.3),
        },
        viewport: [256.0, 256.0],
        image: [256, 256],
        ..CameraDescription::default()
    };
    let camera = Camera::new(description).expect("it is a camera");
    let found = [
        ([552.452_15, 258.042_27, -774.729_6], 1.555_325_2e-6, [3, 3]),
        ([12_440.907, 2_243.451_2, -14_647.731], 7.946_62e-4, [0, 0]),
    ];
    let found = found.map(|(center, radius, pixel)| (Vec3::from_array(center), radius, pixel));
    let made = (0..4000_u32).map(|k| {
        let [row, column] = [k * 7919 % 256, k * 104_729 % 256];
        let ray = camera.viewing_ray(row, column);
        let far = 2f64.powf(f64::from(k % 89) / 8.0 + 5.0);
        let center = (ray.origin + far * ray.direction).as_vec3();
        let beside = ray.origin - center.as_dvec3();
        let nearest = beside - beside.dot(ray.direction) * ray.direction;
        (center, nearest.length() as f32, [row, column])
    });
    for (center, radius, [row, column]) in found.into_iter().chain(made) {
        if radius == 0.0 {
            continue;
        }
        let scene = scene(vec![Shape::Sphere(Sphere { center, radius }).into()]);
        let crop = Some(Crop { row, column, height: 1, width: 1 });
        let options = Options { crop, ..Options::default() };
        let what = format!("{center:?}, {radius:e}, pixel ({row}, {column})");
        all_agree(&View::new(&scene, &camera), &options, &what);
    }
}
