//! What a timed frame executes: counts that are known by hand, that neither threads nor SIMD change, and that stand
//! apart from the work of the algorithm.

use bothways::common::engine::simd::{Level, best_level, levels};
use bothways::common::glam::{DVec2, Vec3};
use bothways::common::{
    Camera, CameraDescription, Executed, Frame, Mesh, Object, Options, Plane, Projection, Scene,
    Shape, Sphere, View, Work,
};
use bothways::orders::{self, Method, Order, RenderOptions};
use bothways::report::Report;
use bothways::{rasterize, raytrace};
use bothways_test_support::repeats::{cameras, still_life};
use bothways_test_support::{mesh, scene, triangle};
use serde_json::Value;

const ORDERS: [Order; 2] = [Order::Object, Order::Image];

/// What a frame of one order executes that nothing observes, at a level of SIMD and in tiles of the usual size.
fn executed_at(level: Level, order: Order, view: &View, options: &Options) -> Executed {
    let mut frame = Frame::new(view.camera, options);
    match order {
        Order::Object => {
            let prepared = rasterize::fast::prepare(view.scene).drawn_with(level, [8, 9]);
            rasterize::fast::determine_visibility(&prepared, view, options, &mut frame, &mut ())
        }
        Order::Image => {
            let prepared = raytrace::fast::prepare(view.scene).drawn_with(level, 32);
            raytrace::fast::determine_visibility(&prepared, view, options, &mut frame, &mut ())
        }
    }
}

fn executed(order: Order, objects: Vec<Object>, image: [u32; 2]) -> Executed {
    let (scene, camera) = (scene(objects), Camera::canonical(image[1], image[0]));
    executed_at(best_level(), order, &View::new(&scene, &camera), &Options::default())
}

/// A triangle at depth 1 with corners at these rows and columns of a picture of 32 × 32 samples.
fn seen_at(corners: [[f32; 2]; 3]) -> [Vec3; 3] {
    corners.map(|[row, column]| Vec3::new((column - 15.5) / 32.0, (15.5 - row) / 32.0, -1.0))
}

fn one_triangle(corners: [[f32; 2]; 3]) -> Vec<Object> {
    vec![triangle(seen_at(corners).map(|corner| corner.to_array()))]
}

/// It reaches over all 32 × 32 samples, and over no more than 256.
const OVER_ALL: [[f32; 2]; 3] = [[-10.0, -10.0], [-10.0, 90.0], [90.0, -10.0]];

#[test]
fn nothing_is_executed_for_an_empty_scene_but_its_tiles_are_skipped() {
    for (order, tiles) in [(Order::Object, 1), (Order::Image, 6)] {
        let expected = Executed { tiles, tiles_skipped: tiles, ..Executed::default() };
        assert_eq!(executed(order, vec![], [96, 64]), expected, "{}", order.name());
    }
    let expected = Executed { tiles: 4, tiles_skipped: 4, ..Executed::default() };
    assert_eq!(executed(Order::Object, vec![], [513, 257]), expected);
}

#[test]
fn one_triangle_over_one_tile_is_set_up_once_and_tested_in_64_blocks() {
    let all = Executed { tiles: 1, triangles: 1, set_ups: 1, blocks: 64, ..Executed::default() };
    let by_object = executed(Order::Object, one_triangle(OVER_ALL), [32, 32]);
    assert_eq!(by_object, Executed { binned: 1, ..all });
    let by_image = executed(Order::Image, one_triangle(OVER_ALL), [32, 32]);
    assert_eq!(by_image, Executed { nodes_opened: 1, boxes_tested: 1, leaves_opened: 1, ..all });
}

#[test]
fn a_triangle_drawn_twice_is_found_out_at_its_first_block() {
    let twice = || [one_triangle(OVER_ALL), one_triangle(OVER_ALL)].concat();
    let by_object = executed(Order::Object, twice(), [32, 32]);
    assert_eq!((by_object.triangles, by_object.set_ups, by_object.blocks), (2, 2, 65));
    // A leaf knows its duplicates from the start.
    let by_image = executed(Order::Image, twice(), [32, 32]);
    assert_eq!((by_image.triangles, by_image.set_ups, by_image.blocks), (1, 1, 64));
}

#[test]
fn a_small_triangle_takes_a_step_for_each_sample_between_its_corners() {
    // Between its corners are samples 11 and 12 of either axis.
    let corners = [[10.6, 10.6], [10.6, 12.4], [12.4, 10.6]];
    for order in ORDERS {
        let found = executed(order, one_triangle(corners), [32, 32]);
        assert_eq!((found.set_ups, found.lane_steps, found.blocks), (1, 4, 0), "{found:?}");
    }
    // In another picture it comes to one of four tiles of rays, and to the only tile of the raster.
    let four = [Order::Object, Order::Image].map(|order| {
        let found = executed(order, one_triangle(corners), [64, 64]);
        assert_eq!((found.triangles, found.set_ups), (1, 1), "{found:?}");
        [found.tiles, found.tiles_skipped, found.nodes_opened]
    });
    assert_eq!(four, [[1, 0, 0], [4, 3, 4]]);
}

/// Slivers that cross the picture in all directions, each a third of a sample wide. Those that lie along rows or columns cover few
/// samples of a tile, so that triangles after them count as small; this must not keep others from being culled by their edges.
#[test]
fn image_order_sets_slivers_up_in_the_tiles_that_they_cross() {
    let part = |k: u32, step: f64| (f64::from(k + 1) * step).fract();
    let slivers: Vec<[DVec2; 3]> = (0..600)
        .map(|k| {
            let turn = std::f64::consts::TAU * part(k, 0.618_034);
            let along = DVec2::from_angle(turn);
            let middle = 512.0 * DVec2::new(part(k, 0.754_878), part(k, 0.569_840));
            [middle - along * 1500.0, middle + along * 1500.0, middle + along.perp() * 0.33]
        })
        .collect();
    let corner = |at: DVec2| {
        let [x, y] = (at / 512.0).as_vec2().to_array();
        Vec3::new(x - 0.5, 0.5 - y, -1.0)
    };
    let positions = slivers.iter().flatten().map(|at| corner(*at)).collect();
    let triangles = (0..600).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let scene = scene(vec![mesh(Mesh::new(positions, triangles).expect("it is a mesh"))]);

    let tiles =
        || (0..16).flat_map(|i| (0..16).map(move |j| DVec2::new(f64::from(j), f64::from(i))));
    let crosses = |[start, end, _]: &[DVec2; 3], tile: DVec2| {
        let normal = (end - start).normalize().perp();
        let away = normal.dot(32.0 * tile + 16.0 - *start).abs();
        away < 16.0 * (normal.x.abs() + normal.y.abs())
    };
    let crossed = slivers.iter().map(|one| tiles().filter(|tile| crosses(one, *tile)).count());
    let crossed = crossed.sum::<usize>() as u64;
    assert!(crossed > 10_000, "{crossed}");
    // All three see the same picture: one from near, one with parallel rays, and one from far away.
    let near = CameraDescription {
        eye: Vec3::ZERO,
        distance: 1.0,
        viewport: [1.0; 2],
        image: [512; 2],
        ..CameraDescription::default()
    };
    let parallel = CameraDescription { projection: Projection::Parallel, ..near };
    let far = CameraDescription { eye: Vec3::new(0.0, 0.0, 999.0), distance: 1000.0, ..near };
    for description in [near, parallel, far] {
        let camera = Camera::new(description).expect("it is a camera");
        let view = View::new(&scene, &camera);
        let found = executed_at(best_level(), Order::Image, &view, &Options::default());
        let set_ups = found.set_ups;
        assert!(set_ups < 2 * crossed, "{set_ups} for {crossed} crossings by {description:?}");
    }
}

#[test]
fn spheres_and_planes_are_drawn_one_by_one() {
    let ball = Shape::Sphere(Sphere { center: Vec3::new(0.0, 0.0, -3.0), radius: 1.0 });
    let wall = Shape::Plane(Plane { point: Vec3::new(0.0, 0.0, -9.0), normal: Vec3::Z });
    for order in ORDERS {
        let of = |shape: &Shape| executed(order, vec![shape.clone().into()], [20, 10]);
        let (ball, wall) = (of(&ball), of(&wall));
        for one in [ball, wall] {
            assert_eq!((one.one_by_one, one.tiles_skipped, one.set_ups), (1, 0, 0), "{one:?}");
        }
        // Object order tests a sphere in rows of sixteen samples, image order in blocks of 4 × 4 samples.
        let most = if order == Order::Object { 20 } else { 15 };
        assert!((1..=most).contains(&ball.blocks) && ball.single_samples == 0, "{ball:?}");
        // Both draw a plane in blocks: 10 rows of 20 samples are 20 times 16 samples in a row, or 3 × 5 squares.
        let blocks = if order == Order::Object { 20 } else { 15 };
        assert_eq!((wall.blocks, wall.single_samples), (blocks, 0), "{wall:?}");
    }
}

/// A grid of squares far behind the triangle over all, seen at nearly 29 × 29 of 32 × 32 samples.
fn far_grid(side: u32) -> Mesh {
    let place = |k: u32| 9.0 * (k as f32 / side as f32 - 0.5);
    let vertices = (0..=side).flat_map(|i| (0..=side).map(move |j| (i, j)));
    let positions = vertices.map(|(i, j)| Vec3::new(place(j), place(i), -10.0)).collect();
    let square = |i: u32, j: u32| {
        let (a, below) = (i * (side + 1) + j, side + 1);
        [[a, a + 1, a + below], [a + 1, a + below + 1, a + below]]
    };
    let squares = (0..side).flat_map(|i| (0..side).map(move |j| (i, j)));
    Mesh::new(positions, squares.flat_map(|(i, j)| square(i, j)).collect()).expect("it is a mesh")
}

#[test]
fn what_a_near_triangle_hides_is_skipped() {
    let grid = mesh(far_grid(16));
    let near = Mesh::new(seen_at(OVER_ALL).to_vec(), vec![[0, 1, 2]]).expect("it is a mesh");
    let hidden = |order| executed(order, vec![grid.clone(), mesh(near.clone())], [32, 32]);
    let seen = |order| executed(order, vec![grid.clone()], [32, 32]);

    // 512 triangles in 16 clusters, rows of the grid; the near triangle is a cluster of its own, and is drawn first.
    let by_object = hidden(Order::Object);
    assert_eq!((by_object.boxes_tested, by_object.clusters), (17, 17));
    assert_eq!((by_object.clusters_skipped, by_object.triangles, by_object.set_ups), (16, 1, 1));
    let by_object = seen(Order::Object);
    assert_eq!((by_object.clusters, by_object.clusters_skipped), (16, 0));
    assert_eq!((by_object.triangles, by_object.set_ups), (512, 512));
    // The leaf of the near triangle comes first, and hides all others.
    let [hidden, seen] = [hidden(Order::Image), seen(Order::Image)];
    assert_eq!((seen.triangles, hidden.leaves_opened), (512, 1));
    assert!(seen.leaves_opened >= 32, "{seen:?}");

    // For an observer hidden clusters are drawn as well; the tiles of rays are the same.
    let (scene, camera) =
        (scene(vec![grid.clone(), mesh(near.clone())]), Camera::canonical(32, 32));
    let (view, options) = (View::new(&scene, &camera), Options::default());
    let mut frame = Frame::new(&camera, &options);
    let prepared = rasterize::fast::prepare(&scene);
    let mut work = Work::default();
    let watched =
        rasterize::fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut work);
    assert_eq!((watched.clusters, watched.clusters_skipped, work.primitives), (17, 0, 513));
    let prepared = raytrace::fast::prepare(&scene);
    let watched =
        raytrace::fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut work);
    assert_eq!(watched, hidden);
}

#[test]
fn neither_threads_nor_simd_change_what_is_executed() {
    let options = Options::default();
    let scenes = [still_life(), a_bit_of_everything()];
    for (camera, scene) in
        cameras().iter().flat_map(|camera| scenes.iter().map(move |scene| (camera, scene)))
    {
        let view = View::new(scene, camera);
        for order in ORDERS {
            let with = |threads: usize, level: Level| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| executed_at(level, order, &view, &options))
            };
            let one = with(1, best_level());
            for threads in [2, 5] {
                assert_eq!(with(threads, best_level()), one, "{threads} threads");
            }
            for level in levels() {
                assert_eq!(with(2, level), one, "{level:?}");
            }
            check_sums(order, &one);
        }
    }
}

/// What must hold between the counts of any frame.
fn check_sums(order: Order, executed: &Executed) {
    assert!(executed.tiles_skipped <= executed.tiles, "{executed:?}");
    assert!(executed.set_ups <= executed.triangles, "{executed:?}");
    assert!(executed.clusters_skipped <= executed.clusters, "{executed:?}");
    assert!(executed.nodes_opened <= executed.boxes_tested, "{executed:?}");
    assert!(executed.boxes_tested <= 16 * executed.nodes_opened || order == Order::Object);
    assert!(executed.triangles <= 16 * executed.leaves_opened || order == Order::Object);
    let others = match order {
        Order::Object => executed.nodes_opened + executed.leaves_opened,
        Order::Image => executed.binned + executed.clusters,
    };
    assert_eq!(others, 0, "{executed:?}");
}

/// A scene in which every counter of its order is above zero, but for what is skipped.
fn a_bit_of_everything() -> Scene {
    let ball = Shape::Sphere(Sphere { center: Vec3::new(1.0, 0.0, -4.0), radius: 1.0 });
    let near =
        triangle(seen_at([[9.0, 0.0], [9.0, 30.0], [29.0, 4.0]]).map(|corner| corner.to_array()));
    // It reaches behind the eye, and so near to the horizon that some depths need `f64`.
    let floor = triangle([[-1e6, -0.3, 2.0], [1e6, -0.3, 2.0], [0.0, -0.3, -1e9]]);
    scene(vec![mesh(far_grid(16)), ball.into(), near, floor])
}

#[test]
fn every_timed_frame_has_its_counts_and_no_other() {
    let (scene, camera) = (a_bit_of_everything(), Camera::canonical(32, 48));
    let view = View::new(&scene, &camera);
    for order in ORDERS {
        let render = |method, repeat, no_times, no_counts| {
            let options = RenderOptions { repeat, no_times, no_counts, ..RenderOptions::default() };
            orders::render(order, method, &view, &options).unwrap()
        };
        let expected = executed_at(best_level(), order, &view, &Options::default());
        for (repeat, no_times) in [(None, false), (Some(2), false), (None, true)] {
            for no_counts in [false, true] {
                let rendered = render(Method::Fast, repeat, no_times, no_counts);
                assert_eq!(rendered.executed, Some(expected));
                assert_eq!(rendered.work().is_none(), no_counts);
            }
            assert_eq!(render(Method::Textbook, repeat, no_times, false).executed, None);
        }
    }
}

#[test]
fn the_report_has_both_sorts_of_counts_each_under_its_name() {
    let (scene, camera) = (a_bit_of_everything(), Camera::canonical(32, 48));
    let view = View::new(&scene, &camera);
    let options = RenderOptions { no_times: true, ..RenderOptions::default() };
    let rendered =
        ORDERS.map(|order| orders::render(order, Method::Fast, &view, &options).unwrap());
    let report = Report::new("a", 1, 1, &rendered, None).to_json().unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    let both = [
        "blocks",
        "boxes_tested",
        "lane_steps",
        "one_by_one",
        "set_ups",
        "single_samples",
        "tiles",
        "tiles_skipped",
        "triangles",
    ];
    let own = [&["binned", "clusters", "clusters_skipped"][..], &["leaves_opened", "nodes_opened"]];
    for (name, own) in ["object_order", "image_order"].into_iter().zip(own) {
        let executed = report[name]["executed"].as_object().unwrap();
        let mut names: Vec<&str> = executed.keys().map(String::as_str).collect();
        names.sort_unstable();
        let mut expected = [&both[..], own].concat();
        expected.sort_unstable();
        assert_eq!(names, expected);
        // Hardly any sample is tested alone, here perhaps none.
        let is_certain = |name: &str| !name.ends_with("skipped") && name != "single_samples";
        for (name, count) in executed.iter().filter(|(name, _)| is_certain(name)) {
            assert!(count.as_u64().unwrap() > 0, "{name}: {executed:?}");
        }
        // The algorithm's work for each primitive or ray alone is far more.
        let tests = report[name]["work"]["tests"].as_u64().unwrap();
        assert!(tests > executed["blocks"].as_u64().unwrap(), "{report}");
    }
}
