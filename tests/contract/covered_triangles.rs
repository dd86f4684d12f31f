//! All four renderers agree with `cover` about a triangle on the raster.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::four_renderers::all_agree;
use bothways::common::glam::{Vec2, Vec3};
use bothways::common::{
    Camera, CameraDescription, Options, Orientation, Projection, Shape, Triangle, View,
};
use bothways::cover::{Cover, cover};
use bothways_test_support::{cases, scene};
use proptest::prelude::*;

/// A parallel camera in the middle of the image, with the axes of the raster.
fn raster_camera([width, height]: [u32; 2]) -> Camera {
    let half = |side: u32| f32::from(u16::try_from(side).unwrap()) / 2.0;
    Camera::new(CameraDescription {
        projection: Projection::Parallel,
        eye: Vec3::new(half(width), half(height), -1.0),
        orientation: Orientation::Frame { u: Vec3::X, v: Vec3::NEG_Y, w: Vec3::NEG_Z },
        viewport: [2.0 * half(width), 2.0 * half(height)],
        image: [width, height],
        ..CameraDescription::default()
    })
    .unwrap()
}

/// Asserts that all four renderers cover exactly the pixels of `claimed`.
fn check_renderers(claimed: &Cover) {
    let [a, b, c] = claimed.triangle.map(|corner| corner.extend(0.0));
    let scene = scene(vec![Shape::Triangle(Triangle { a, b, c }).into()]);
    let camera = raster_camera(claimed.image);
    let view = View::new(&scene, &camera);
    let frame = all_agree(&view, &Options::default(), "a triangle on a raster");
    for (i, row) in (0..).zip(frame.ids().chunks(frame.width())) {
        for (j, id) in (0..).zip(row.iter()) {
            assert_eq!(claimed.covers(i, j), id == Some(0), "pixel ({i}, {j}) of {claimed:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(200)))]

    /// Coordinates in halves put corners and edges on centres.
    #[test]
    fn the_renderers_agree_with_cover_on_exact_ties(
        corners in prop::array::uniform6(-8i16..40),
        image in prop::array::uniform2(1u32..17),
    ) {
        let [a, b, c, d, e, f] = corners.map(|number| f32::from(number) / 2.0);
        let triangle = [Vec2::new(a, b), Vec2::new(c, d), Vec2::new(e, f)];
        check_renderers(&cover(triangle, image).unwrap());
    }

    #[test]
    fn the_renderers_agree_with_cover_on_any_numbers(
        corners in prop::array::uniform6(-10f32..30.0),
        image in prop::array::uniform2(1u32..17),
    ) {
        let [a, b, c, d, e, f] = corners;
        let triangle = [Vec2::new(a, b), Vec2::new(c, d), Vec2::new(e, f)];
        check_renderers(&cover(triangle, image).unwrap());
    }
}
