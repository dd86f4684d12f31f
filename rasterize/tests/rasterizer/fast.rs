//! What the fast rasterizer must not depend on, and the triangles that its own paths are made for.

#![expect(clippy::cast_possible_truncation, reason = "small numbers")]

use bothways_common::engine::simd::{Level, best_level, levels};
use bothways_common::glam::{Vec2, Vec3};
use bothways_common::{
    Camera, CameraDescription, Frame, Mesh, Options, Orientation, Plane, Projection, Scene, Shape,
    View, Work,
};
use bothways_formats::generate::Kind;
use bothways_formats::scene_file;
use bothways_formats::source::Files;
use bothways_rasterize::fast::{self, Prepared};
use bothways_rasterize::textbook;
use bothways_test_support::{
    PROJECTIONS, assert_same_visibility, grids_on_quarters, mesh, on_integers, scene, triangle,
    turned,
};

/// Scenes that come with the program, as files.
const BUILT_IN: [&str; 5] = [
    include_str!("../../../scenes/overlap.toml"),
    include_str!("../../../scenes/ties.toml"),
    include_str!("../../../scenes/slivers.toml"),
    include_str!("../../../scenes/inside.toml"),
    include_str!("../../../scenes/behind.toml"),
];

/// Draws with a prepared scene; also tells the work.
pub(super) fn draw(prepared: &Prepared, view: &View, options: &Options) -> (Frame, Work) {
    let mut frame = Frame::new(view.camera, options);
    let mut work = Work::default();
    fast::determine_visibility(prepared, view, options, &mut frame, &mut work);
    let mut unwatched = Frame::new(view.camera, options);
    fast::determine_visibility(prepared, view, options, &mut unwatched, &mut ());
    assert_eq!(frame.ids(), unwatched.ids(), "watching changes nothing");
    assert_eq!(frame.distances(), unwatched.distances(), "watching changes nothing");
    (frame, work)
}

/// Numbers in 0 … 1 that look random: the golden ratio's multiples, as a low-discrepancy sequence.
pub(super) fn scattered(count: usize) -> impl Iterator<Item = [f32; 3]> {
    let part = |k: usize, step: f64| (k as f64 * step).fract() as f32;
    (1..=count)
        .map(move |k| [part(k, 0.618_033_988), part(k, 0.754_877_666), part(k, 0.569_840_291)])
}

/// Triangles of all sizes, from less than a sample to larger than the picture, many of them slivers.
fn all_sizes(count: usize) -> Scene {
    let mut numbers = scattered(4 * count);
    let mut next = || Vec3::from_array(numbers.next().expect("there are enough")) - 0.5;
    let mut positions = Vec::new();
    for k in 0..count {
        let size = 4.0 * 0.5f32.powf((k % 12) as f32);
        let thin = if k % 5 == 0 { 0.01 } else { 1.0 };
        let (middle, across) = (3.0 * next(), size * next());
        positions.extend([middle, middle + across, middle + across * 0.5 + thin * size * next()]);
    }
    let triangles = (0..count as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    scene(vec![mesh(Mesh::new(positions, triangles).expect("it is a mesh"))])
}

pub(super) fn every_way_to_draw() -> impl Iterator<Item = (Level, [u32; 2])> {
    let tiles = [[8, 9], [6, 10], [3, 3], [0, 4], [5, 0], [16, 16]];
    let of_levels = levels().into_iter().map(move |level| (level, tiles[0]));
    of_levels.chain(tiles.map(|tile| (best_level(), tile)))
}

#[test]
fn no_width_of_simd_and_no_tile_changes_a_bit() {
    let built_in = BUILT_IN.map(|toml| {
        scene_file::parse("built-in.toml", toml, &Files::none()).expect("it is a scene").scene
    });
    for (k, scene) in built_in.into_iter().chain([all_sizes(600)]).enumerate() {
        for projection in PROJECTIONS {
            let camera = turned(projection, [1.5, 1.0, 4.0], [0.0; 3], [101, 67]);
            let view = View::new(&scene, &camera);
            let options = Options { samples: 1 + k as u32 % 2, ..Options::default() };
            let prepared = fast::prepare(&scene);
            let (expected, expected_work) = draw(&prepared, &view, &options);
            for (level, tile) in every_way_to_draw() {
                let prepared = prepared.clone().drawn_with(level, tile);
                let (frame, work) = draw(&prepared, &view, &options);
                assert_eq!(frame.ids(), expected.ids(), "scene {k}, {level:?}, tiles {tile:?}");
                assert_eq!(frame.distances(), expected.distances(), "{level:?}, {tile:?}");
                let counts = |work: Work| [work.tests, work.fragments, work.depth_tests];
                assert_eq!(counts(work), counts(expected_work), "{level:?}, {tile:?}");
                if tile == [8, 9] {
                    assert_eq!(work, expected_work, "{level:?}");
                }
            }
        }
    }
}

#[test]
fn no_number_of_threads_changes_a_bit() {
    let scene = all_sizes(40_000);
    let camera = turned(Projection::Perspective, [1.5, 1.0, 4.0], [0.0; 3], [640, 480]);
    let view = View::new(&scene, &camera);
    let prepared = fast::prepare(&scene);
    let drawn = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("there are threads").install(|| draw(&prepared, &view, &Options::default()))
    };
    let expected = drawn(1);
    assert!(expected.1.fragments > 100_000);
    for threads in [2, 3, 8] {
        assert_eq!(drawn(threads), expected, "{threads} threads");
    }
}

#[test]
fn tiles_for_many_threads_are_more_and_change_no_bit() {
    let scene = all_sizes(4_000);
    let camera = turned(Projection::Perspective, [1.5, 1.0, 4.0], [0.0; 3], [1030, 300]);
    let (view, options) = (View::new(&scene, &camera), Options::default());
    let mut prepared = fast::prepare(&scene);
    let drawn = |prepared: &fast::Prepared| {
        let mut frame = Frame::new(&camera, &options);
        let executed = fast::determine_visibility(prepared, &view, &options, &mut frame, &mut ());
        (frame, executed.tiles)
    };
    let (expected, tiles) = drawn(&prepared);
    assert_eq!(tiles, 6);
    for (threads, tiles) in [(1, 6), (2, 10), (3, 15), (1000, 15), (0, 6)] {
        prepared.cut_for_threads(threads);
        assert_eq!(drawn(&prepared), (expected.clone(), tiles), "{threads} threads");
    }
}

/// A view against the textbook; gives the work of the fast one.
pub(super) fn check(scene: &Scene, camera: &Camera, what: &str) -> Work {
    let (view, options) = (View::new(scene, camera), Options::default());
    let expected = textbook::render(&view, &options);
    let (frame, work) = draw(&fast::prepare(scene), &view, &options);
    assert_same_visibility(&expected, &frame, what);
    work
}

/// The same triangles in an order in which no neighbours follow each other.
fn shuffled(mesh: &Mesh) -> Mesh {
    let triangles = mesh.triangles();
    // 7919 is prime, and divides none of the counts below.
    let order = (0..triangles.len()).map(|k| k * 7919 % triangles.len());
    Mesh::new(mesh.positions().to_vec(), order.map(|k| triangles[k]).collect()).expect("a mesh")
}

/// A square of 2 × 16 × 16 triangles.
fn sheet(z: f32) -> Mesh {
    let places = (0..17 * 17).map(|k| Vec2::new((k % 17) as f32, (k / 17) as f32) / 8.0 - 1.0);
    let positions = places.map(|place| place.extend(z)).collect();
    let corners = (0..16 * 16).map(|k| k / 16 * 17 + k % 16);
    let pair = |k: u32| [[k, k + 1, k + 17], [k + 1, k + 18, k + 17]];
    Mesh::new(positions, corners.flat_map(pair).collect()).expect("it is a mesh")
}

#[test]
fn leaving_out_hidden_clusters_changes_nothing() {
    let generated = |kind: Kind, divisions| kind.mesh(divisions).expect("it can be divided so");
    let ball = generated(Kind::Sphere, [24, 16]);
    let coarse = generated(Kind::Sphere, [10, 7]);
    let ring = generated(Kind::Torus, [24, 14]);
    let moved = |mesh: &Mesh, by: Vec3, size: f32| {
        let positions = mesh.positions().iter().map(|position| *position * size + by).collect();
        Mesh::new(positions, mesh.triangles().to_vec()).expect("it is a mesh")
    };
    let doubled = |mesh: &Mesh| {
        let triangles = [mesh.triangles(), mesh.triangles()].concat();
        Mesh::new(mesh.positions().to_vec(), triangles).expect("it is a mesh")
    };
    // Twice the same in another order: everything ties. Sheets of which each is nearer by a thousandth than
    // the one before; a far one keeps depth keys from spreading.
    for (name, meshes) in [
        ("a ball", vec![ball.clone()]),
        ("a shuffled ball", vec![shuffled(&ball)]),
        ("a ring", vec![ring.clone(), moved(&ring, Vec3::new(0.3, 0.1, -0.2), 0.8)]),
        ("a ring twice", vec![shuffled(&ring), ring.clone()]),
        ("every triangle twice in a mesh", vec![shuffled(&doubled(&coarse))]),
        ("a ball in a ball", vec![moved(&ball, Vec3::ZERO, 0.999), shuffled(&ball)]),
        ("sheets", [-9.0, 0.0, 0.001, 0.002, 0.003].map(sheet).to_vec()),
        ("behind a ball", vec![moved(&ring, Vec3::new(-1.0, -0.7, -2.0), 0.5), ball.clone()]),
    ] {
        let scene = scene(meshes.into_iter().map(mesh).collect());
        for projection in PROJECTIONS {
            for (eye, size) in [([0.3, 0.2, 3.0], [44, 33]), ([0.2, 0.1, 0.9], [21, 30])] {
                let camera = turned(projection, eye, [0.0; 3], size);
                let (view, options) = (View::new(&scene, &camera), Options::default());
                let expected = textbook::render(&view, &options);
                // In small tiles clusters are cut, and taken apart.
                for tile in [[8, 8], [5, 4]] {
                    let prepared = fast::prepare(&scene).drawn_with(best_level(), tile);
                    let what = format!("{name}, {projection:?} from {eye:?} in tiles of {tile:?}");
                    assert_same_visibility(&expected, &draw(&prepared, &view, &options).0, &what);
                }
            }
        }
    }
}

#[test]
fn triangles_of_all_sizes_as_the_textbook_sees_them() {
    let scene = all_sizes(400);
    for projection in PROJECTIONS {
        for eye in [[1.5, 1.0, 4.0], [0.1, 0.0, 0.2], [20.0, 30.0, -10.0]] {
            let camera = turned(projection, eye, [0.0; 3], [96, 80]);
            let work = check(&scene, &camera, &format!("{projection:?} from {eye:?}"));
            assert!(work.fragments > 50, "{projection:?} from {eye:?}: {work:?}");
        }
    }
}

#[test]
fn triangles_wider_than_the_picture_whatever_the_tiles() {
    // Some reach behind the eye, some lie almost edge-on; floors and planes reach to the horizon.
    let mut numbers = scattered(3 * 60);
    let mut next = || Vec3::from_array(numbers.next().expect("there are enough")) - 0.5;
    let triangles = (0..60).map(|k| {
        let flat = Vec3::new(1.0, if k % 3 == 0 { 1e-4 } else { 1.0 }, 1.0);
        triangle([next(), next(), next()].map(|corner| (12.0 * corner * flat).to_array()))
    });
    let floor = |y: f32| triangle([[-900.0, y, 2.0], [900.0, y, 2.0], [0.0, y, -900.0]]);
    let plane = |y: f32, normal: [f32; 3]| {
        let (point, normal) = (Vec3::new(0.0, y, 0.0), Vec3::from_array(normal));
        Shape::Plane(Plane { point, normal }).into()
    };
    let planes = [plane(-3.0, [0.0, 1.0, 0.0]), plane(-2.0, [0.3, 1.0, -0.2])];
    let floors = [floor(-0.5), floor(-0.51), floor(1e-3)];
    let scene = scene(triangles.chain(floors).chain(planes).collect());
    for projection in PROJECTIONS {
        for (eye, target) in [([0.3, 0.4, 1.5], [0.0; 3]), ([1.0, 0.0, 9.0], [0.0, 0.2, 0.0])] {
            let camera = turned(projection, eye, target, [700, 90]);
            let work = check(&scene, &camera, &format!("{projection:?} from {eye:?}"));
            assert!(work.fragments > 100_000, "{work:?}");
            assert!(work.judged_coverage * 10_000 < work.tests, "{work:?}");

            let (view, options) = (View::new(&scene, &camera), Options::default());
            let prepared = fast::prepare(&scene);
            let (expected, _) = draw(&prepared, &view, &options);
            for (level, tile) in every_way_to_draw() {
                let (frame, other) =
                    draw(&prepared.clone().drawn_with(level, tile), &view, &options);
                assert_eq!(frame.ids(), expected.ids(), "{level:?}, tiles {tile:?}");
                assert_eq!(frame.distances(), expected.distances(), "{level:?}, tiles {tile:?}");
                assert_eq!(other.tests, work.tests, "{level:?}, tiles {tile:?}");
                assert_eq!(other.judged_coverage, work.judged_coverage, "tiles {tile:?}");
            }
        }
    }
}

/// Triangles of at most a few columns in a row that cross much of the picture in all directions, some of them twice, some from
/// quarter of a sample to quarter.
fn thin_triangles(count: usize, length: f32) -> Scene {
    let triangles = scattered(count).enumerate().flat_map(|(k, [x, y, turn])| {
        let along = Vec2::from_angle(std::f32::consts::TAU * turn) * length;
        let width = [0.3, 1.0, 2.5, 5.0][k % 4];
        let middle = Vec2::new(x - 0.5, y - 0.5) * 300.0;
        let places = [middle - along, middle + along, middle + along.perp().normalize() * width];
        let (tilt, is_aligned) = (if k % 7 == 3 { [1.0, 1.3, 1.1] } else { [1.0; 3] }, k % 5 == 0);
        let corners = std::array::from_fn(|corner| {
            let place = places[corner];
            let place = if is_aligned { (4.0 * place).round() / 4.0 } else { place };
            let depth = if is_aligned { 1.0 } else { 1.0 + x * y * tilt[corner] };
            (place.extend(-200.0) * depth).to_array()
        });
        let again = (k % 6 == 0).then(|| triangle(corners));
        std::iter::once(triangle(corners)).chain(again)
    });
    scene(triangles.collect())
}

#[test]
fn thin_triangles_are_seen_as_the_textbook_sees_them_however_they_are_drawn() {
    // Shorter ones are set up in `f32`, longer ones in `f64`, strip by strip.
    for length in [60.0, 400.0] {
        let scene = thin_triangles(160, length);
        for (projection, samples) in PROJECTIONS.into_iter().zip([1, 2]) {
            let viewport = match projection {
                Projection::Perspective => [320.0, 300.0],
                Projection::Parallel => [640.0, 600.0],
            };
            let camera = Camera::new(CameraDescription {
                projection,
                viewport,
                distance: 200.0,
                image: [320, 300],
                ..CameraDescription::default()
            });
            let camera = camera.expect("it is a camera");
            let what = format!("{projection:?}, {length}");
            let work = check(&scene, &camera, &what);
            assert!(work.fragments > 5_000, "{what}: {work:?}");

            let view = View::new(&scene, &camera);
            let options = Options { samples, ..Options::default() };
            let prepared = fast::prepare(&scene);
            let mut frame = Frame::new(&camera, &options);
            let executed =
                fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut ());
            assert!(executed.lane_steps > 1_000, "{what}: {executed:?}");
            let (expected, _) = draw(&prepared, &view, &options);
            for (level, tile) in every_way_to_draw() {
                let other = draw(&prepared.clone().drawn_with(level, tile), &view, &options).0;
                assert_eq!(other.ids(), expected.ids(), "{what}, {level:?}, tiles {tile:?}");
                assert_eq!(other.distances(), expected.distances(), "{what}, {level:?}, {tile:?}");
            }
        }
    }
}

#[test]
fn triangles_that_are_thin_in_the_middle_row_alone() {
    // Two corners are so far above the picture that nothing bounds the triangle; the third one ends it at rows around the
    // middle of the first tall strip, where its sides are hardly apart. Above, they are up to 200 columns apart.
    let mut steps = 0;
    for tip in 50..80_u8 {
        let tip = Vec2::new(7.3, 64.4 - f32::from(tip));
        let far = |x: f32| tip + Vec2::new(x, 1.0) * 1e9;
        let places = [tip, far(1.5), far(-1.5)];
        let scene = scene(vec![triangle(places.map(|place| place.extend(-5.0).to_array()))]);
        let camera = Camera::new(CameraDescription {
            projection: Projection::Parallel,
            viewport: [300.0, 128.0],
            image: [300, 128],
            ..CameraDescription::default()
        });
        let camera = camera.expect("it is a camera");
        let work = check(&scene, &camera, &format!("{tip}"));
        assert!(work.fragments > 1_000, "{tip}: {work:?}");
        let (view, options) = (View::new(&scene, &camera), Options::default());
        let mut frame = Frame::new(&camera, &options);
        let prepared = fast::prepare(&scene);
        steps +=
            fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut ()).lane_steps;
    }
    assert!(steps > 300, "{steps}");
}

#[test]
fn edges_through_samples_need_no_judge_where_vertices_are_on_the_raster() {
    for (scene, camera, what) in grids_on_quarters() {
        let work = check(&scene, &camera, &what);
        assert_eq!(work.judged_coverage, 0, "{what}: {work:?}");
    }
}

#[test]
fn every_triangle_on_quarters_of_samples() {
    // Any corners, so that edges of any slope pass through samples.
    let corner = |[x, y, _]: [f32; 3]| {
        [(12.0 * x).floor() * 0.75 - 4.0, (12.0 * y).floor() * 0.5 - 3.0, -1.0]
    };
    let corners: Vec<[f32; 3]> = scattered(900).map(corner).collect();
    let triangles = corners.chunks_exact(3).map(|c| triangle([c[0], c[1], c[2]])).collect();
    let scene = scene(triangles);
    for projection in PROJECTIONS {
        let work = check(&scene, &on_integers(projection, 6), &format!("{projection:?}"));
        assert_eq!(work.judged_coverage, 0, "{projection:?}");
    }
}

#[test]
fn a_distant_eye_loses_no_depth() {
    // Two walls a ten-thousandth of their distance apart, seen through a telescope.
    let wall = |z: f32| {
        let corners = [[-3.0, -3.0, z], [3.0, -3.0, z], [3.0, 3.0, z], [-3.0, 3.0, z]];
        let [a, b, c, d] = corners;
        [triangle([a, b, c]), triangle([a, c, d])]
    };
    let scene = scene([wall(0.0), wall(0.1)].concat());
    let description = CameraDescription {
        eye: Vec3::new(10.0, 5.0, 1000.0),
        orientation: Orientation::LookAt { target: Vec3::ZERO, up: Vec3::Y },
        distance: 500.0,
        viewport: [2.0, 2.0],
        image: [64, 64],
        ..CameraDescription::default()
    };
    let camera = Camera::new(description).expect("it is a camera");
    let work = check(&scene, &camera, "telescope");
    assert!(work.depth_tests > 1000 && work.judged_nearest == 0, "{work:?}");
}

#[test]
fn nothing_at_all() {
    for objects in [Vec::new(), vec![triangle([[0.0; 3]; 3])]] {
        let scene = scene(objects);
        let work = check(&scene, &on_integers(Projection::Perspective, 3), "nothing");
        assert_eq!(work.fragments, 0);
    }
}
