//! Neither the number of threads nor the level of SIMD changes a bit of the pictures of either order, or a count.

use bothways::common::engine::simd::levels;
use bothways::common::glam::Vec3;
use bothways::common::look::color::srgb_from_linear;
use bothways::common::{Camera, Frame, Options, View, Work};
use bothways::{rasterize, raytrace, scenes};
use bothways_test_support::PROJECTIONS;
use bothways_test_support::repeats::{cameras, still_life};

#[test]
fn threads_never_change_a_bit() {
    let (scene, options) = (still_life(), Options { samples: 3, ..Options::default() });
    for camera in cameras() {
        let view = View::new(&scene, &camera);
        let with_threads = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut frames = [(); 2].map(|()| (Frame::new(&camera, &options), Work::default()));
                let [(object, object_work), (image, image_work)] = &mut frames;
                let prepared = rasterize::fast::prepare(&scene);
                rasterize::fast::determine_visibility(
                    &prepared,
                    &view,
                    &options,
                    object,
                    object_work,
                );
                rasterize::shade(&view, object);
                let prepared = raytrace::fast::prepare(&scene);
                raytrace::fast::determine_visibility(&prepared, &view, &options, image, image_work);
                raytrace::shade(&view, image);
                frames
            })
        };
        let one = with_threads(1);
        for threads in [2, 3, 7] {
            assert_eq!(with_threads(threads), one, "{threads} threads");
        }
    }
}

/// Pictures are wider than what is shaded at once. The scenes have triangles, smooth and flat ones, spheres, planes,
/// patterns, a texture with mipmaps and all sorts of light.
#[test]
fn no_level_of_simd_changes_a_bit_of_what_is_shaded() {
    let textured = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/horizon/horizon.toml");
    for (name, samples) in [("lecture", 1), ("overlap", 1), ("inside", 2), (textured, 1)] {
        let loaded = scenes::load(name).unwrap();
        for projection in PROJECTIONS {
            let mut description = loaded.camera;
            (description.image, description.projection) =
                ([520 / samples, 210 / samples], projection);
            let camera = Camera::new(description).unwrap();
            let view = View::new(&loaded.scene, &camera);
            let options = Options { samples, ..Options::default() };
            let empty = Frame::new(&camera, &options).with_colors().with_normals();
            let (mut object, mut image) = (empty.clone(), empty);
            let prepared = rasterize::fast::prepare(&loaded.scene);
            rasterize::fast::determine_visibility(&prepared, &view, &options, &mut object, &mut ());
            let prepared = raytrace::fast::prepare(&loaded.scene);
            raytrace::fast::determine_visibility(&prepared, &view, &options, &mut image, &mut ());
            // Small triangles are set up otherwise where nothing is kept of textures.
            for keeps_textures in [false, true] {
                let kept = |frame: &Frame| match keeps_textures {
                    true => frame.clone().with_texture_coordinates().with_levels(),
                    false => frame.clone(),
                };
                let shaded = |level| {
                    let [mut object, mut image] = [&object, &image].map(kept);
                    rasterize::shade_with(&view, &mut object, level);
                    raytrace::shade_with(&view, &mut image, level);
                    [object, image]
                };
                let all: Vec<_> = levels().into_iter().map(shaded).collect();
                let colors = all[0][0].picture().iter().collect::<std::collections::HashSet<_>>();
                assert!(colors.len() > 100, "{name}, {projection:?}: {} colours", colors.len());
                for other in &all[1..] {
                    assert!(*other == all[0], "{name}, {projection:?}, {keeps_textures}");
                }
                if samples == 1 {
                    for frame in &all[0] {
                        let bytes = |color: &Vec3| color.to_array().map(srgb_from_linear);
                        assert!(
                            frame.picture().iter().copied().eq(frame.colors().iter().map(bytes))
                        );
                    }
                }
            }
        }
    }
}
