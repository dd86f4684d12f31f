//! Measurement does not change the measured results.

use super::measure::repeated;
use super::*;
use crate::common::glam::Vec3;
use crate::common::{Camera, Options, Scene, Shape, Sphere, View};
use crate::progress::{Progress, Stage, Steps};
use std::sync::Mutex;
use std::sync::atomic::AtomicU64;

#[test]
fn the_median_lies_in_the_middle() {
    let odd = Spread { median: 2.0, min: 1.0, max: 9.0 };
    assert_eq!(Spread::of(vec![9.0, 1.0, 2.0]), odd);
    let even = Spread { median: 2.5, min: 1.0, max: 9.0 };
    assert_eq!(Spread::of(vec![9.0, 3.0, 1.0, 2.0]), even);
}

fn two_balls() -> Scene {
    let ball = |x| Shape::Sphere(Sphere { center: Vec3::new(x, 0.0, -3.0), radius: 1.0 });
    Scene::new(vec![ball(0.0).into(), ball(0.5).into()]).unwrap()
}

#[test]
fn repeating_changes_neither_picture_nor_counts() {
    let scene = two_balls();
    let camera = Camera::canonical(7, 9);
    let view = View::new(&scene, &camera);
    for order in [Order::Object, Order::Image] {
        for method in [Method::Fast, Method::Textbook] {
            let once = render(order, method, &view, &RenderOptions::default()).unwrap();
            let repeating = RenderOptions { repeat: Some(3), ..RenderOptions::default() };
            let of = |rendered: Rendered| (rendered.frame, rendered.work, rendered.executed);
            let once = of(once);
            for threads in [1, 16] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let thrice = pool.install(|| render(order, method, &view, &repeating));
                assert_eq!(once, of(thrice.unwrap()), "{order:?} {method:?} {threads}");
            }
        }
    }
}

#[test]
fn the_largest_number_of_repetitions_does_not_overflow() {
    let done = AtomicU64::new(0);
    let steps = Steps::new(Order::Object, None, None, 1, &done);
    let mut runs = 0;
    let spreads = repeated(Some(u32::MAX), &steps, |_| {
        runs += 1;
        if runs < 5 { Ok(()) } else { Err("enough") }
    });
    assert_eq!((spreads, runs), (Err("enough"), 5));
}

#[test]
fn progress_is_reported_to_the_end_and_changes_nothing() {
    let (scene, camera) = (two_balls(), Camera::canonical(7, 9));
    let view = View::new(&scene, &camera);
    let frame = Options { samples: 2, ..Options::default() };
    // The steps within a frame: frames, primitives, or rows of samples.
    for (order, method, steps) in [
        (Order::Object, Method::Fast, 1),
        (Order::Object, Method::Textbook, 2),
        (Order::Image, Method::Fast, 1),
        (Order::Image, Method::Textbook, 14),
    ] {
        for (repeat, frames) in [(None, 2), (Some(1), 3), (Some(3), 5)] {
            let reported = Mutex::new(Vec::new());
            let listener = |progress| reported.lock().unwrap().push(progress);
            let options = RenderOptions {
                frame,
                repeat,
                progress: Some(&listener),
                ..RenderOptions::default()
            };
            let observed = render(order, method, &view, &options).unwrap();
            let options = RenderOptions { progress: None, ..options };
            let alone = render(order, method, &view, &options).unwrap();
            assert_eq!((observed.frame, observed.work), (alone.frame, alone.work));

            let total = steps * frames;
            let step = |stage, done| Progress { order, stage, done, total };
            let rendering = (0..=total).map(|done| step(Stage::Rendering, done));
            let mut expected = vec![step(Stage::Preparing, 0)];
            expected.extend(rendering);
            assert_eq!(reported.into_inner().unwrap(), expected, "{order:?} {method:?}");
        }
    }
}
