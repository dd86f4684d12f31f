//! A scene from very far away looks the same as from near: in both orders, for every kind of object.

use crate::four_renderers::RENDERERS;
use bothways::common::glam::{DVec3, Vec3};
use bothways::common::scene::Checker;
use bothways::common::{
    Camera, CameraDescription, Frame, Light, Material, Object, Options, Orientation, Plane,
    Primitive, Projection, Ray, Scene, Shape, Sphere, Triangle, View,
};
use bothways::diff::compare;
use bothways::formats::generate::Kind;
use bothways::picture::picture;
use bothways::{rasterize, raytrace};
use bothways_test_support::PROJECTIONS;
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};

/// One object of every kind, about as large as 1, in several lights, all with patterns.
fn scene() -> Scene {
    let material = Material {
        color: Vec3::new(0.8, 0.3, 0.2),
        specular: 0.4,
        shininess: 30.0,
        checker: Some(Checker { color: Vec3::new(0.1, 0.5, 0.7), divisions: [9.0, 7.0] }),
        ..Material::default()
    };
    let torus = Kind::Torus.mesh([96, 64]).expect("it is a torus");
    let torus = torus.map(|p| 0.5 * p + Vec3::new(-0.75, 0.5, 0.0), |n| n).expect("it is a mesh");
    let shapes = [
        Shape::Sphere(Sphere { center: Vec3::new(0.75, 0.4, 0.125), radius: 0.6 }),
        Shape::Mesh(torus),
        Shape::Triangle(Triangle {
            a: Vec3::new(-1.5, -0.9, 0.25),
            b: Vec3::new(0.25, -0.75, -0.5),
            c: Vec3::new(-0.5, 0.25, 0.75),
        }),
        Shape::Plane(Plane {
            point: Vec3::new(0.0, -1.0, 0.0),
            normal: Vec3::new(0.125, 1.0, 0.75),
        }),
    ];
    let objects = shapes.map(|shape| Object { shape, material: material.clone() });
    let mut scene = Scene::new(objects.into()).expect("it is a scene");
    scene.lights = vec![
        Light::Point { position: Vec3::new(0.25, 0.5, 1.5), intensity: 0.5 },
        Light::Directional { direction: Vec3::new(-1.0, -2.0, -1.0), intensity: 0.3 },
        Light::AtCamera { intensity: 0.3 },
    ];
    scene
}

fn description(projection: Projection, away: f32) -> CameraDescription {
    let scale = match projection {
        Projection::Perspective => 1.0 / away,
        Projection::Parallel => 1.0,
    };
    CameraDescription {
        projection,
        eye: Vec3::new(0.0, 0.0, away),
        orientation: Orientation::Frame { u: Vec3::X, v: Vec3::Y, w: Vec3::Z },
        distance: 1.0,
        viewport: [3.2 * scale, 2.4 * scale],
        image: [100, 75],
    }
}

fn frames(scene: &Scene, description: CameraDescription) -> [Frame; 2] {
    let camera = Camera::new(description).expect("it is a camera");
    let view = View::new(scene, &camera);
    let [_, _, (_, object_order), (_, image_order)] = RENDERERS;
    [object_order, image_order].map(|render| render(&view, &Options::default()))
}

/// The largest difference of two pictures in the pixels where both show the same primitive, in steps of 1/255.
fn largest_difference(one: &Frame, other: &Frame) -> u8 {
    let pictures = [one, other].map(picture);
    let mut largest = 0;
    for (index, (a, b)) in pictures[0].pixels().zip(pictures[1].pixels()).enumerate() {
        if one.ids().get(index) != other.ids().get(index) {
            continue;
        }
        let channels = a.0.iter().zip(b.0).map(|(a, b)| a.abs_diff(b));
        largest = largest.max(channels.max().unwrap_or(0));
    }
    largest
}

#[test]
fn a_parallel_picture_does_not_change_with_the_eye_s_distance() {
    let scene = scene();
    let near = frames(&scene, description(Projection::Parallel, 16.0));
    for away in [1e4, 1e5, 1e6, 1e7] {
        let far = frames(&scene, description(Projection::Parallel, away));
        for (near, far) in near.iter().zip(&far) {
            assert_eq!(near.ids(), far.ids(), "{away}");
            let off = largest_difference(near, far);
            assert!(off <= 1, "{away}: {off} of 255");
        }
        let color = compare(&far[0], &far[1]).color;
        assert!(color.max_difference <= 1, "{away}: {color:?}");
    }
}

#[test]
fn a_point_of_light_that_is_far_away_is_a_directional_one() {
    let mut scene = scene();
    let towards = Vec3::new(0.25, 0.5, 1.0);
    for projection in PROJECTIONS {
        scene.lights = vec![Light::Directional { direction: -towards, intensity: 0.9 }];
        let directional = frames(&scene, description(projection, 16.0));
        for away in [1e5, 1e8, 1e17, 1e20, 1e30] {
            scene.lights = vec![Light::Point { position: away * towards, intensity: 0.9 }];
            let point = frames(&scene, description(projection, 16.0));
            for (directional, point) in directional.iter().zip(&point) {
                let off = largest_difference(directional, point);
                assert!(off <= 1, "{projection:?}, {away:e}: {off} of 255");
            }
        }
    }
}

#[test]
fn a_plane_through_a_point_that_is_far_away_is_lit_alike_in_both_orders() {
    let far = 2_f32.powi(60);
    let normal = Vec3::new(1.0, 0.5, 1.0);
    let shape = Shape::Plane(Plane { point: Vec3::new(far, -4.0, -far), normal });
    let mut scene = Scene::new(vec![shape.into()]).expect("it is a scene");
    let light = Vec3::new(0.0, 1.0, 15.0);
    scene.lights = vec![Light::Point { position: light, intensity: 1.0 }];
    for projection in PROJECTIONS {
        let [object_order, image_order] = frames(&scene, description(projection, 16.0));
        let covered = object_order.ids().iter().flatten().count();
        assert!(covered > 7000, "{projection:?}: {covered}");
        let off = largest_difference(&object_order, &image_order);
        assert!(off <= 2, "{projection:?}: {off} of 255");
    }
}

#[test]
fn a_perspective_picture_from_afar_is_the_parallel_one() {
    let scene = scene();
    let parallel = frames(&scene, description(Projection::Parallel, 16.0));
    // A nearer object is larger by a small part: some border pixels show more of a pattern.
    for (away, room) in [(1e4, 8), (1e5, 2), (1e6, 1), (1e7, 1)] {
        let far = frames(&scene, description(Projection::Perspective, away));
        for (parallel, far) in parallel.iter().zip(&far) {
            let other = parallel.ids().iter().zip(far.ids().iter()).filter(|(a, b)| a != b).count();
            assert!(other < 40, "{away}: {other} samples show something else");
            let off = largest_difference(parallel, far);
            assert!(off <= room, "{away}: {off} of 255");
        }
        let color = compare(&far[0], &far[1]).color;
        assert!(color.max_difference <= 1, "{away}: {color:?}");
    }
}

/// A vector of exact numbers.
type Exact = [BigRational; 3];

fn exact(v: DVec3) -> Exact {
    v.to_array().map(|x| BigRational::from_float(x).expect("it is finite"))
}

fn difference(p: &Exact, q: &Exact) -> Exact {
    std::array::from_fn(|k| &p[k] - &q[k])
}

fn dot(p: &Exact, q: &Exact) -> BigRational {
    p.iter().zip(q).fold(BigRational::zero(), |sum, (a, b)| sum + a * b)
}

fn cross(p: &Exact, q: &Exact) -> Exact {
    let minor = |k: usize, l: usize| &p[k] * &q[l] - &p[l] * &q[k];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn along(origin: &Exact, t: &BigRational, direction: &Exact) -> Exact {
    std::array::from_fn(|k| &origin[k] + t * &direction[k])
}

fn rounded(v: &Exact) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|k| v[k].to_f64().expect("it has a size")))
}

/// The unit normal of a sphere where a ray meets it first, from exact numbers but for one root.
fn normal_of_sphere(center: DVec3, radius: f64, ray: &Ray) -> DVec3 {
    let (m, d) = (difference(&exact(ray.origin), &exact(center)), exact(ray.direction));
    let length = dot(&d, &d);
    let beside = along(&m, &-(dot(&m, &d) / &length), &d);
    let radius = BigRational::from_float(radius).expect("it is finite");
    let half = ((&radius * &radius - dot(&beside, &beside)) / length).to_f64().expect("a size");
    (rounded(&beside) - half.max(0.0).sqrt() * ray.direction).normalize()
}

/// The weights of a triangle's corners where a ray meets its plane, exact until they are rounded.
fn weights(corners: [DVec3; 3], ray: &Ray) -> [f64; 3] {
    let [a, b, c] = corners.map(exact);
    let (origin, d) = (exact(ray.origin), exact(ray.direction));
    let normal = cross(&difference(&b, &a), &difference(&c, &a));
    let t = dot(&normal, &difference(&a, &origin)) / dot(&normal, &d);
    let hit = along(&origin, &t, &d);
    let area = |p: &Exact, q: &Exact| {
        let side = cross(&difference(p, &hit), &difference(q, &hit));
        (dot(&side, &normal) / dot(&normal, &normal)).to_f64().expect("it has a size")
    };
    [area(&b, &c), area(&c, &a), area(&a, &b)]
}

/// Compares normals, and texture coordinates of triangles, with exact numbers at some samples.
fn check_exactly(scene: &Scene, camera: &Camera, frame: &Frame, what: &str) {
    let view = View::new(scene, camera);
    let mut checked = [0; 2];
    for index in (0..frame.ids().len()).step_by(149) {
        let (Some(id), width) = (frame.ids().get(index), frame.width()) else { continue };
        let ray = camera.sample_grid(1).ray(index / width, index % width);
        let normal = frame.normals()[index].as_dvec3();
        match view.primitive(id) {
            Primitive::Sphere { center, radius } => {
                let off = normal.distance(normal_of_sphere(center, radius, &ray));
                // Along the outline a normal turns fast.
                let slack = 1.0 / normal.dot(ray.direction.normalize()).abs();
                assert!(off < 1e-6 + 1e-8 * slack, "{what}: sphere's normal off by {off}");
                checked[0] += 1;
            }
            Primitive::Triangle(corners) => {
                let weights = weights(corners, &ray);
                let (object, local) = scene.locate(id);
                let Shape::Mesh(mesh) = &scene.objects()[object].shape else { continue };
                let corners = mesh.normals().of(local).expect("it is smooth");
                let parts = corners.iter().zip(weights).map(|(n, w)| n.as_dvec3().normalize() * w);
                let expected = parts.sum::<DVec3>().normalize();
                let off = normal.distance(expected).min(normal.distance(-expected));
                assert!(off < 1e-4, "{what}: mesh's normal off by {off}");
                let values = mesh.texture_coordinates().of(local).expect("it has them");
                let parts = values.iter().zip(weights).map(|(v, w)| v.as_dvec2() * w);
                let expected: bothways::common::glam::DVec2 = parts.sum();
                let off = frame.texture_coordinates()[index].as_dvec2().distance(expected);
                assert!(off < 1e-4, "{what}: texture coordinate off by {off}");
                checked[1] += 1;
            }
            Primitive::Plane { .. } => {}
        }
    }
    assert!(checked[0] > 2 && checked[1] > 2, "{what}: {checked:?}");
}

#[test]
fn normals_and_texture_coordinates_from_afar_agree_with_exact_numbers() {
    let scene = scene();
    let back = Vec3::new(0.48, 0.36, 0.8);
    for away in [1e4, 1e7] {
        for projection in PROJECTIONS {
            let eye = away * back;
            let look = Orientation::Direction { direction: -back, up: Vec3::Y };
            let description =
                CameraDescription { eye, orientation: look, ..description(projection, away) };
            let camera = Camera::new(description).expect("it is a camera");
            let view = View::new(&scene, &camera);
            let frame = Frame::new(&camera, &Options::default());
            let mut frame = frame.with_normals().with_texture_coordinates();
            for order in ["object order", "image order"] {
                let what = format!("{order}, {projection:?} from {away:e}");
                if order == "object order" {
                    let prepared = rasterize::fast::prepare(&scene);
                    rasterize::fast::determine_visibility(
                        &prepared,
                        &view,
                        &Options::default(),
                        &mut frame,
                        &mut (),
                    );
                    rasterize::shade(&view, &mut frame);
                } else {
                    let prepared = raytrace::fast::prepare(&scene);
                    raytrace::fast::determine_visibility(
                        &prepared,
                        &view,
                        &Options::default(),
                        &mut frame,
                        &mut (),
                    );
                    raytrace::shade(&view, &mut frame);
                }
                check_exactly(&scene, &camera, &frame, &what);
            }
        }
    }
}
