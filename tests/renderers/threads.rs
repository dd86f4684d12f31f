//! The number of threads changes no bit of the pictures of either order, and no count.

use bothways::common::{Frame, Options, View, Work};
use bothways::{rasterize, raytrace};
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
