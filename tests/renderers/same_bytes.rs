//! The promise of the README: what is seen is the same, to the last bit, for any number of threads and at every level of
//! SIMD; also what both orders count. In every scene that comes with the program, by each order and each method.

use bothways::common::engine::simd::{Level, best_level, levels};
use bothways::common::{Camera, CameraDescription, Frame, Options, View, Work};
use bothways::orders::Order;
use bothways::scenes::{self, BUILT_IN};
use bothways::{rasterize, raytrace};

/// A scene with textures and smaller levels of them.
const TEXTURED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/horizon/horizon.toml");
/// What is drawn of each scene: some tiles, the last of which are cut.
const IMAGE: [u32; 2] = [150, 70];
/// The textbooks ask for each pair of primitive and sample.
const SMALL: [u32; 2] = [31, 17];

const ORDERS: [Order; 2] = [Order::Object, Order::Image];

/// All that a renderer leaves, and counts.
type Drawn = (Frame, Work);

fn empty(view: &View, options: &Options) -> Drawn {
    let frame = Frame::new(view.camera, options).with_colors().with_normals();
    (frame.with_texture_coordinates().with_levels(), Work::default())
}

fn fast(order: Order, level: Level, view: &View, options: &Options) -> Drawn {
    let (mut frame, mut work) = empty(view, options);
    match order {
        Order::Object => {
            let prepared = rasterize::fast::prepare(view.scene).drawn_with(level, [8, 9]);
            rasterize::fast::determine_visibility(&prepared, view, options, &mut frame, &mut work);
            rasterize::shade_with(view, &mut frame, level);
        }
        Order::Image => {
            let prepared = raytrace::fast::prepare(view.scene).drawn_with(level, 16);
            raytrace::fast::determine_visibility(&prepared, view, options, &mut frame, &mut work);
            raytrace::shade_with(view, &mut frame, level);
        }
    }
    (frame, work)
}

fn textbook(order: Order, level: Level, view: &View, options: &Options) -> Drawn {
    let (mut frame, mut work) = empty(view, options);
    match order {
        Order::Object => {
            rasterize::textbook::determine_visibility(view, options, &mut frame, &mut work);
            rasterize::shade_with(view, &mut frame, level);
        }
        Order::Image => {
            raytrace::textbook::determine_visibility(view, options, &mut frame, &mut work);
            raytrace::shade_with(view, &mut frame, level);
        }
    }
    (frame, work)
}

/// Asserts that a way to draw leaves the same with any number of threads and at every level.
fn check(what: &str, levels: &[Level], draw: impl Fn(Level) -> Drawn + Send + Sync) -> Drawn {
    let with = |threads: usize, level: Level| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be started").install(|| draw(level))
    };
    let one = with(1, best_level());
    for threads in [2, 3, 5] {
        assert!(with(threads, best_level()) == one, "{what}: {threads} threads");
    }
    for &level in levels {
        assert!(with(2, level) == one, "{what}: {level:?}");
    }
    one
}

#[test]
fn every_built_in_scene_has_the_same_bytes_with_any_threads_at_every_level() {
    for name in BUILT_IN.iter().map(|scene| scene.name).chain([TEXTURED]) {
        let loaded = scenes::load(name).unwrap();
        let camera_of = |image| Camera::new(CameraDescription { image, ..loaded.camera }).unwrap();
        let options = Options::default();
        for order in ORDERS {
            let camera = camera_of(IMAGE);
            let view = View::new(&loaded.scene, &camera);
            let what = format!("{name}, fast, {order:?}");
            let (frame, work) =
                check(&what, &levels(), |level| fast(order, level, &view, &options));
            assert!(frame.picture().iter().any(|color| *color != frame.picture()[0]), "{what}");
            assert!(work != Work::default(), "{what}");
            // Of `many` and `crowd`, the textbooks would draw for minutes: the contract compares their ids.
            if loaded.scene.primitive_count() > 1000 {
                continue;
            }
            let camera = camera_of(SMALL);
            let view = View::new(&loaded.scene, &camera);
            let what = format!("{name}, textbook, {order:?}");
            let draw = |level| textbook(order, level, &view, &options);
            let (small, _) = check(&what, &levels(), draw);
            let (fast, _) = fast(order, best_level(), &view, &options);
            assert_eq!(small.ids(), fast.ids(), "{what}");
            assert_eq!(small.picture(), fast.picture(), "{what}");
        }
    }
}
