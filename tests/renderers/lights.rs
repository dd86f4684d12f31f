//! However many points of light there are, small triangles look as they do where each is found in `f64`.

use bothways::common::glam::Vec3;
use bothways::common::scene::material::Light;
use bothways::common::{Camera, Frame, Options, View};
use bothways::{rasterize, raytrace, scenes};

/// As many points of light as are kept of small triangles, fewer, and more.
const COUNTS: [usize; 5] = [0, 1, 2, 4, 5];

#[test]
fn small_triangles_are_lit_from_every_point_of_light() {
    let mut loaded = scenes::load("lecture").unwrap();
    let mut description = loaded.camera;
    description.image = [320, 180];
    let (camera, options) = (Camera::new(description).unwrap(), Options::default());
    let mut before: Option<Vec<[u8; 3]>> = None;
    for count in COUNTS {
        loaded.scene.lights = vec![Light::Ambient { intensity: 0.1 }];
        loaded.scene.lights.extend((0..count).map(|number| {
            let angle = 1.3 * number as f32;
            let position = Vec3::new(5.0 * angle.cos(), 1.5 + angle, 5.0 * angle.sin());
            Light::Point { position, intensity: 0.25 }
        }));
        let view = View::new(&loaded.scene, &camera);
        let (mut object, mut image) =
            (Frame::new(&camera, &options), Frame::new(&camera, &options));
        let prepared = rasterize::fast::prepare(&loaded.scene);
        rasterize::fast::determine_visibility(&prepared, &view, &options, &mut object, &mut ());
        let prepared = raytrace::fast::prepare(&loaded.scene);
        raytrace::fast::determine_visibility(&prepared, &view, &options, &mut image, &mut ());
        // What is wanted of textures is found in `f64`, and the ways to lights with it.
        let frames = [&object, &image].map(|frame| frame.clone().with_texture_coordinates());
        let [mut object_in_f64, mut image_in_f64] = frames;
        for frame in [&mut object, &mut object_in_f64] {
            rasterize::shade(&view, frame);
        }
        for frame in [&mut image, &mut image_in_f64] {
            raytrace::shade(&view, frame);
        }
        for (frame, in_f64) in [(&object, &object_in_f64), (&image, &image_in_f64)] {
            let (found, expected) = (frame.picture(), in_f64.picture());
            let pairs = found.as_flattened().iter().zip(expected.as_flattened());
            let apart = pairs.map(|(a, b)| a.abs_diff(*b)).max();
            assert!(apart <= Some(1), "{count} lights: {apart:?} of 255");
        }
        // Each light is seen.
        let picture = object.picture().to_vec();
        assert!(before.replace(picture.clone()) != Some(picture), "{count} lights");
    }
}
