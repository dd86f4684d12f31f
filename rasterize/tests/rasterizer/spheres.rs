//! Spheres from everywhere: far, near, on and inside of them, as the textbook sees them, and the same bits at every
//! level of SIMD and in all tiles.

use super::fast::{check, draw, every_way_to_draw, scattered};
use bothways_common::glam::Vec3;
use bothways_common::{
    Camera, CameraDescription, Object, Options, Orientation, Projection, Scene, Shape, Sphere, View,
};
use bothways_rasterize::fast;
use bothways_test_support::{PROJECTIONS, scene, triangle, turned};

fn ball(center: [f32; 3], radius: f32) -> Object {
    Shape::Sphere(Sphere { center: Vec3::from_array(center), radius }).into()
}

/// Spheres of all sizes, from less than a sample to larger than the picture.
fn of_all_sizes(count: usize) -> Vec<Object> {
    let sized = |(k, place): (usize, [f32; 3])| {
        ball(place.map(|x| 4.0 * x - 2.0), 1.7 * 0.5f32.powi(i32::try_from(k % 10).expect("small")))
    };
    scattered(count).enumerate().map(sized).collect()
}

/// Compares with the textbook, and all ways to draw with each other. Gives the samples that are drawn one at a time.
fn check_all_ways(scene: &Scene, camera: &Camera, what: &str) -> u64 {
    let work = check(scene, camera, what);
    let (view, options) = (View::new(scene, camera), Options::default());
    let prepared = fast::prepare(scene);
    let (expected, _) = draw(&prepared, &view, &options);
    for (level, tile) in every_way_to_draw() {
        let what = format!("{what}, {level:?}, tiles {tile:?}");
        let (frame, other) = draw(&prepared.clone().drawn_with(level, tile), &view, &options);
        assert_eq!(frame.ids(), expected.ids(), "{what}");
        assert_eq!(frame.distances(), expected.distances(), "{what}");
        assert_eq!(other.tests, work.tests, "{what}");
        assert_eq!(other.judged_coverage, work.judged_coverage, "{what}");
    }
    let mut frame = expected;
    fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut ()).single_samples
}

#[test]
fn spheres_of_all_sizes_from_outside_and_from_inside() {
    let wall = triangle([[-9.0, -9.0, -1.0], [9.0, -9.0, 0.5], [0.0, 9.0, 0.2]]);
    let scene = scene([of_all_sizes(50), vec![wall]].concat());
    for projection in PROJECTIONS {
        for (eye, most) in [([1.5, 1.0, 6.0], 20), ([0.4, 0.3, 0.2], u64::MAX)] {
            let camera = turned(projection, eye, [0.0; 3], [83, 61]);
            let singles = check_all_ways(&scene, &camera, &format!("{projection:?} from {eye:?}"));
            // Sixteen at a time, where all of them are in front of the eye.
            assert!(singles <= most, "{projection:?} from {eye:?}: {singles}");
        }
    }
}

#[test]
fn from_an_eye_on_a_sphere_and_from_inside() {
    // 2² + 3² + 6² = 7²; the next is larger by a last place, the third smaller.
    let near = |radius: f32| ball([2.0, -3.0, 6.0], radius);
    let scenes = [near(7.0), near(7.0_f32.next_up()), near(7.0_f32.next_down()), near(70.0)];
    for (k, sphere) in scenes.into_iter().enumerate() {
        let scene = scene(vec![sphere, ball([0.0, 0.0, -3.0], 1.0), ball([0.0, 0.0, -3.0], 2.9)]);
        for (target, name) in [([2.0, -3.0, 6.0], "inwards"), ([-2.0, 3.0, -6.0], "outwards")] {
            for projection in PROJECTIONS {
                let camera = turned(projection, [0.0; 3], target, [40, 30]);
                check_all_ways(&scene, &camera, &format!("sphere {k}, {projection:?}, {name}"));
            }
        }
    }
}

#[test]
fn a_planet_beneath_the_eye_and_its_horizon() {
    let scene = scene(vec![
        ball([0.0, -1e6, 0.0], 1e6 - 1.0),
        ball([0.0, -1e6, 0.0], 1e6 - 1.5),
        ball([3.0, -1.0, -20.0], 2.0),
    ]);
    for target in [[0.0, -0.002, -1.0], [0.0, -1.0, -1.0]] {
        let camera = turned(Projection::Perspective, [0.0; 3], target, [60, 50]);
        check_all_ways(&scene, &camera, &format!("towards {target:?}"));
    }
}

/// A camera that looks along −z through a viewport of this width.
fn telescope(projection: Projection, viewport: f32) -> Camera {
    let image = [33, 17];
    let orientation =
        Orientation::Direction { direction: Vec3::NEG_Z, up: Vec3::new(0.3, 1.0, 0.0) };
    let viewport = [viewport; 2];
    let description = CameraDescription {
        projection,
        orientation,
        viewport,
        image,
        ..CameraDescription::default()
    };
    Camera::new(description).expect("it is a camera")
}

#[test]
fn silhouettes_magnified_until_rounding_shows() {
    // 3² + 4² = 5²: the middle ray touches the first sphere.
    let scene = scene(vec![ball([3.0, 4.0, -13.0], 5.0), ball([-3.0, 4.0, -23.0], 5.0)]);
    for projection in PROJECTIONS {
        for exponent in [-20, -40, -48, -50, -52, -60] {
            let camera = telescope(projection, f32::from(2_i8).powi(exponent));
            check_all_ways(&scene, &camera, &format!("{projection:?}, 2^{exponent}"));
        }
    }
}

#[test]
fn small_spheres_far_away_are_drawn_sixteen_samples_at_a_time() {
    let place = |k: usize| [0.3 * (k % 4) as f32 - 0.5, 0.2 * (k / 4) as f32 - 0.4, 0.1 * k as f32];
    let spheres =
        |z: f32| (0..16).map(place).map(|[x, y, depth]| ball([x, y, z - depth], 0.12)).collect();
    for (z, distance) in [(-1e3, 500.0), (-1e5, 5e4), (-1e6, 5e5)] {
        let scene = scene(spheres(z));
        for projection in PROJECTIONS {
            let distance = if projection == Projection::Perspective { distance } else { 1.0 };
            let description = CameraDescription {
                projection,
                distance,
                viewport: [1.0, 1.0],
                image: [64, 48],
                ..CameraDescription::default()
            };
            let camera = Camera::new(description).expect("it is a camera");
            let singles = check_all_ways(&scene, &camera, &format!("{projection:?} at {z}"));
            assert!(singles < 100, "{projection:?} at {z}: {singles}");
        }
    }
}
