//! Tests of one frame that several renderings reuse.

use crate::cameras::{PROJECTIONS, turned};
use crate::scenes::scene;
use bothways_common::glam::Vec3;
use bothways_common::{
    Camera, Frame, Mesh, Object, Options, Plane, Projection, Scene, Shape, Sphere, View, Work,
};

/// Some triangles, a ball and a plane.
pub fn still_life() -> Scene {
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

/// Cameras of both projections, and images of several sizes.
pub fn cameras() -> Vec<Camera> {
    let eyes = [[3.0, 2.0, 4.0], [-2.0, 0.5, 3.0], [0.2, 0.1, -0.3]];
    let images = [[70, 50], [33, 81], [128, 9]];
    let all = PROJECTIONS.into_iter().flat_map(|projection: Projection| {
        eyes.into_iter()
            .zip(images)
            .map(move |(eye, image)| turned(projection, eye, [0.0; 3], image))
    });
    all.collect()
}

/// A function that determines visibility with a renderer.
pub type Determine<'a> = &'a dyn Fn(&View, &Options, &mut Frame, &mut Work);

/// Renders A, B, A, … into one frame and compares each result with a fresh frame: ids, distances and counts.
pub fn check_repeats(prepared: Determine, fresh: Determine) {
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
