//! What the vector paths say of one primitive, held against the exact judge: they may leave samples open, but only few.

use super::draw_flat;
use super::flat::FlatFunctions;
use crate::fast::answer::Trust;
use crate::fast::camera_map::CameraMap;
use crate::fast::prepare;
use crate::fast::search::tile_frustum::FrustumTemplate;
use crate::fast::sphere::blocks::SphereSetup;
use crate::fast::tile::TileBuffer;
use bothways_common::engine::context::{Context, LoopContext};
use bothways_common::engine::fault::Sound;
use bothways_common::engine::simd::{best_level, dispatch};
use bothways_common::glam::Vec3;
use bothways_common::{
    Camera, Plane, Primitive, Projection, Ray, Scene, Shape, Sphere, Triangle, View,
};
use bothways_test_support::{Dice, PROJECTIONS, turned};

const SIDE: usize = 32;

/// How many samples of a picture were tested, and how many of them were left open.
#[derive(Clone, Copy, Debug, Default)]
struct Tested {
    samples: usize,
    open: usize,
}

/// Tests a primitive at all samples of a picture. What is not left open must be as the judge says, with the true key
/// in its interval.
fn check(shape: Shape, camera: &Camera) -> Tested {
    let scene = Scene::new(vec![shape.into()]).expect("it is a scene");
    let view = View::new(&scene, camera);
    let map = CameraMap::new(&view, 1, &prepare(&scene).bounds);
    let template = FrustumTemplate::new(&map, SIDE);
    let mut tested = Tested::default();
    for row in (0..map.grid.height()).step_by(SIDE) {
        for column in (0..map.grid.width()).step_by(SIDE) {
            let mut tile = TileBuffer::new(&view);
            let size = [map.grid.height() - row, map.grid.width() - column];
            tile.begin([row, column], size.map(|count| count.min(SIDE)), SIDE);
            dispatch!(best_level(), simd => {
                draw(&mut LoopContext::new(simd, &mut (), Sound), &map, &template, &mut tile);
            });
            check_tile(&map, &mut tile, &mut tested);
        }
    }
    tested
}

/// Draws the only primitive of a scene, and decides nothing that is left open.
#[inline(always)]
fn draw<C: Context>(
    context: &mut C,
    map: &CameraMap,
    template: &FrustumTemplate,
    tile: &mut TileBuffer,
) {
    let frustum = template.frustum(tile.start);
    let primitive = map.view.primitive(0);
    if let Primitive::Sphere { center, radius } = primitive {
        let setup = SphereSetup::new(map, &frustum, (center, radius), Trust::Sound);
        let setup = setup.expect("the eye is certainly outside, or inside");
        setup.draw(context.simd(), &frustum, 0, tile);
    } else {
        let functions = FlatFunctions::new(map, &primitive).expect("it is not edge-on");
        draw_flat(context, &frustum, &functions, (0, 0), tile);
    }
}

fn check_tile(map: &CameraMap, tile: &mut TileBuffer, tested: &mut Tested) {
    let (primitive, judge) = (map.view.primitive(0), map.view.judge());
    let open: Vec<u16> = tile.take_open().iter().map(|fragment| fragment.index).collect();
    for index in 0..SIDE * SIDE {
        let Some(sample) = tile.sample(index) else { continue };
        tested.samples += 1;
        if open.iter().any(|open| usize::from(*open) == index) {
            tested.open += 1;
            continue;
        }
        let ray: Ray = map.grid.ray(sample.row, sample.column);
        let covers = judge.covers(&primitive, &ray);
        assert_eq!(covers, !tile.is_empty_at(index), "{primitive:?} at {sample:?}");
        if covers {
            let t = judge.distance(&primitive, &ray) * map.depth.scale;
            let key = if map.depth.projection == Projection::Parallel { -t } else { 1.0 / t };
            let [low, high] = [tile.low[index], tile.high[index]].map(f64::from);
            let close = 1e-9 * key.abs();
            let holds = low - close <= key && key <= high + close;
            assert!(holds, "{primitive:?} at {sample:?}: {key} and {low} to {high}");
        }
    }
}

/// The cameras that look at what is near the origin, and from within it.
fn cameras() -> impl Iterator<Item = Camera> {
    let eyes = [[1.0, 2.0, 4.0], [0.1, 0.2, 0.3], [300.0, 200.0, -100.0]];
    PROJECTIONS.into_iter().flat_map(move |projection| {
        eyes.into_iter().map(move |eye| turned(projection, eye, [0.0; 3], [70, 45]))
    })
}

/// Checks many shapes; one of 500 samples may stay open.
fn check_all(seed: u64, shape: impl Fn(&mut Dice) -> Shape) {
    let mut dice = Dice(seed);
    for camera in cameras() {
        let mut all = Tested::default();
        for _ in 0..40 {
            let of_one = check(shape(&mut dice), &camera);
            all.samples += of_one.samples;
            all.open += of_one.open;
        }
        assert!(all.open * 500 < all.samples, "{all:?} from {}", camera.eye());
    }
}

#[test]
fn spheres_are_decided_at_nearly_all_samples() {
    check_all(1, |dice| {
        let radius = 0.02 + dice.next().powi(2);
        Shape::Sphere(Sphere { center: 1.5 * dice.point(), radius })
    });
}

#[test]
fn planes_are_decided_at_nearly_all_samples() {
    check_all(2, |dice| Shape::Plane(Plane { point: dice.point(), normal: dice.point() }));
}

#[test]
fn triangles_are_decided_at_nearly_all_samples_however_they_lie() {
    check_all(3, |dice| {
        let size = 30f32.powf(2.0 * dice.next());
        let [a, b, c] = [(); 3].map(|()| size * dice.point());
        Shape::Triangle(Triangle { a, b, c })
    });
    // Nearly through the eye of one of the cameras.
    check_all(4, |dice| {
        let little = (-20.0 - 10.0 * dice.next()).exp2();
        let eye = Vec3::new(0.1, 0.2, 0.3);
        let (one, other) = (dice.point(), dice.point());
        Shape::Triangle(Triangle {
            a: eye + one,
            b: eye - 3.0 * one + little * dice.point(),
            c: eye + other,
        })
    });
}
