use super::*;
use crate::common::Camera;
use crate::orders::{Method, RenderOptions, render};
use crate::scenes::load;

/// Both orders of a built-in scene, and the camera of its view.
fn drawn(
    name: &str,
    image: [u32; 2],
    samples: u32,
) -> (crate::scenes::LoadedScene, Camera, Vec<Rendered>) {
    let scene = load(name).unwrap();
    let camera = Camera::new(crate::common::CameraDescription { image, ..scene.camera }).unwrap();
    let frame = Options { samples, crop: None };
    let options = RenderOptions { frame, ..RenderOptions::default() };
    let view = View::new(&scene.scene, &camera);
    let both = [Order::Object, Order::Image]
        .map(|order| render(order, Method::Fast, &view, &options).unwrap());
    (scene, camera, both.into())
}

#[test]
fn close_calls_come_first_and_some_are_left_to_chance() {
    let (scene, camera, both) = drawn("ties", [64, 64], 1);
    let view = View::new(&scene.scene, &camera);
    let verified = verify(&view, &both, 400, &|| ());
    assert!(verified.matches);
    assert_eq!(verified.samples, 400);
    assert!(verified.ties >= 100 && verified.edges >= 60, "{verified:?}");
    assert!(verified.at_random >= 100, "{verified:?}");
    assert_eq!(
        verified.verdict(),
        "verified: 400 samples answered by the textbook as well, none differs"
    );
}

#[test]
fn whole_pixels_are_answered_and_no_more_than_there_are() {
    let (scene, camera, both) = drawn("canonical", [9, 7], 2);
    let view = View::new(&scene.scene, &camera);
    assert_eq!(verify(&view, &both, 5, &|| ()).samples, 8);
    let all = verify(&view, &both[1..], 1_000_000, &|| ());
    assert_eq!((all.samples, all.matches), (9 * 7 * 4, true));
    assert_eq!(all.object_order, None);
}

#[test]
fn one_wrong_sample_is_found_where_the_orders_differ() {
    let (scene, camera, mut both) = drawn("many", [160, 90], 1);
    let view = View::new(&scene.scene, &camera);
    let seen = both[1].frame.id(40, 71);
    both[1].frame.set(40, 71, seen.map_or(0, |id| id + 1), 1.0);
    let verified = verify(&view, &both, 3, &|| ());
    assert_eq!(verified.differing, 1);
    let wrong = Against { differing_samples: 1, first_differing: vec![[40, 71]] };
    assert_eq!(verified.image_order, Some(wrong));
    assert_eq!(verified.object_order, Some(Against::default()));
    let says = "not verified: 3 samples answered by the textbook as well, which sees otherwise than image order \
                in 1 of them, first at (40, 71)";
    assert_eq!(verified.verdict(), says);
}

#[test]
fn the_choice_does_not_depend_on_threads() {
    let (scene, camera, both) = drawn("overlap", [64, 48], 1);
    let view = View::new(&scene.scene, &camera);
    let chosen = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| choose(&view, &[&both[0].frame], 200))
    };
    assert_eq!(chosen(1), chosen(3));
}
