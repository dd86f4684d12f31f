//! What one `Prepared` answers does not depend on what it answered before, nor on threads.

mod support;

use bothways::common::glam::Vec3;
use bothways::common::{
    Camera, Frame, Mesh, Object, Options, Plane, Projection, Scene, Shape, Sphere, View, Work,
};
use bothways::{rasterize, raytrace};
use support::{PROJECTIONS, scene, turned};

/// Some triangles, a ball and a plane.
fn still_life() -> Scene {
    let positions = (0..60_u16).map(|k| {
        let k = f32::from(k);
        Vec3::new((2.1 * k).sin(), (1.3 * k).cos(), (0.7 * k).sin()) * 1.5
    });
    let triangles = (0..58).map(|k| [k, k + 1, k + 2]).collect();
    let mesh = Shape::Mesh(Mesh::new(positions.collect(), triangles).expect("it is a mesh"));
    let ball = Shape::Sphere(Sphere { center: Vec3::new(1.0, 0.5, 0.0), radius: 0.75 });
    let ground = Shape::Plane(Plane { point: Vec3::new(0.0, -1.25, 0.0), normal: Vec3::Y });
    scene([mesh, ball, ground].map(Object::from).to_vec())
}

fn cameras() -> Vec<Camera> {
    let eyes = [[3.0, 2.0, 4.0], [-2.0, 0.5, 3.0], [0.2, 0.1, -0.3]];
    let images = [[70, 50], [33, 81], [128, 9]];
    let all = PROJECTIONS.into_iter().flat_map(|projection: Projection| {
        eyes.into_iter()
            .zip(images)
            .map(move |(eye, image)| turned(projection, eye, [0.0; 3], image))
    });
    all.collect()
}

type Determine<'a> = &'a dyn Fn(&View, &Options, &mut Frame, &mut Work);

/// Renders A, B, A, … into one frame and compares each with a fresh one, ids, distances and counts.
fn check_repeats(prepared: Determine, fresh: Determine) {
    let scene = still_life();
    let cameras = cameras();
    let options = Options { samples: 2, ..Options::default() };
    let mut frame = Frame::new(&cameras[0], &options);
    for step in 0..2 * cameras.len() {
        let view = View::new(&scene, &cameras[step % 3 + 3 * (step % 2)]);
        let mut work = Work::default();
        prepared(&view, &options, &mut frame, &mut work);
        let mut new = Frame::new(view.camera, &options);
        let mut new_work = Work::default();
        fresh(&view, &options, &mut new, &mut new_work);
        assert_eq!(frame.ids(), new.ids());
        assert_eq!(frame.distances(), new.distances());
        assert_eq!(work, new_work);
        assert!(work.tests > 0);
    }
}

#[test]
fn object_order_starts_every_frame_afresh() {
    let prepared = rasterize::fast::prepare(&still_life());
    check_repeats(
        &|view, options, frame, work| {
            rasterize::fast::determine_visibility(&prepared, view, options, frame, work);
        },
        &|view, options, frame, work| {
            let prepared = rasterize::fast::prepare(view.scene);
            rasterize::fast::determine_visibility(&prepared, view, options, frame, work);
        },
    );
}

#[test]
fn image_order_starts_every_frame_afresh() {
    let prepared = raytrace::fast::prepare(&still_life());
    check_repeats(
        &|view, options, frame, work| {
            raytrace::fast::determine_visibility(&prepared, view, options, frame, work);
        },
        &|view, options, frame, work| {
            let prepared = raytrace::fast::prepare(view.scene);
            raytrace::fast::determine_visibility(&prepared, view, options, frame, work);
        },
    );
}

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
