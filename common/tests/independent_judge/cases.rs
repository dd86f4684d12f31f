//! What is judged: cameras, numbers and shapes to be combined into hostile pictures.

use bothways_common::glam::{DVec3, Vec3};
use bothways_common::{
    Camera, CameraDescription, Mesh, Orientation, Plane, Projection, Ray, Scene, Shape, Sphere,
    Triangle,
};
use proptest::collection::vec;
use proptest::prelude::*;

/// One small picture: every primitive is judged at every sample, and every two that cover it.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    /// The camera.
    pub(crate) camera: CameraDescription,
    /// What the camera sees.
    pub(crate) shapes: Vec<Shape>,
    /// Points `(x, y)` of the viewport, beside the middles of the pixels.
    pub(crate) points: Vec<[f64; 2]>,
}

impl Case {
    /// The camera; strategies make accepted ones only.
    pub(crate) fn camera(&self) -> Camera {
        Camera::new(self.camera).expect("the camera is accepted")
    }

    /// What there is to see; strategies make accepted shapes only.
    pub(crate) fn scene(&self) -> Scene {
        let objects = self.shapes.iter().cloned().map(Into::into).collect();
        Scene::new(objects).expect("the shapes are accepted")
    }

    /// The rays of all pixels and of the additional points.
    pub(crate) fn rays(&self) -> Vec<Ray> {
        let camera = self.camera();
        let grid = camera.sample_grid(1);
        let pixels = (0..grid.height()).flat_map(|i| (0..grid.width()).map(move |j| (i, j)));
        let points = self.points.iter().map(|&[x, y]| camera.ray_through(x, y));
        pixels.map(|(i, j)| grid.ray(i, j)).chain(points).collect()
    }
}

/// How the numbers of a shape become positions of the world.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Placement {
    /// They are positions already.
    World,
    /// Along `u`, `v` and `w` from the eye.
    Frame,
    /// Fractions of the viewport's width and height, and how many times as far as the viewport;
    /// behind the eye where that is negative.
    Viewport,
}

impl Placement {
    fn of_point(self, camera: &Camera, point: Vec3) -> Vec3 {
        let p = point.as_dvec3();
        let in_frame = match self {
            Placement::World => return point,
            Placement::Frame => p,
            Placement::Viewport => {
                let [width, height] = camera.viewport();
                let spread = match camera.projection() {
                    Projection::Perspective => p.z,
                    Projection::Parallel => 1.0,
                };
                let (x, y) = (p.x * width * spread, p.y * height * spread);
                DVec3::new(x, y, -p.z * camera.distance())
            }
        };
        let limit = DVec3::splat(f64::from(f32::MAX));
        (camera.eye().as_dvec3() + turned(camera, in_frame)).clamp(-limit, limit).as_vec3()
    }

    fn of_shape(self, camera: &Camera, shape: &Shape) -> Shape {
        let place = |point| self.of_point(camera, point);
        match shape {
            Shape::Triangle(Triangle { a, b, c }) => triangle([*a, *b, *c].map(place)),
            Shape::Mesh(mesh) => {
                let mesh = mesh.clone().map(place, |normal| normal);
                Shape::Mesh(mesh.expect("places are finite"))
            }
            Shape::Instances(_) => unreachable!("no instances are made"),
            Shape::Sphere(Sphere { center, radius }) => {
                let rim = place(*center + Vec3::X * *radius);
                let center = place(*center);
                let radius = match self {
                    Placement::World | Placement::Frame => *radius,
                    Placement::Viewport => rim.distance(center).clamp(1e-45, f32::MAX),
                };
                Shape::Sphere(Sphere { center, radius })
            }
            Shape::Plane(Plane { point, normal }) => {
                let turned = match self {
                    Placement::Frame => turned(camera, normal.as_dvec3()).as_vec3(),
                    Placement::World | Placement::Viewport => *normal,
                };
                Shape::Plane(Plane { point: place(*point), normal: turned })
            }
        }
    }
}

/// The vector with these coordinates in the camera's frame, in the world's axes.
fn turned(camera: &Camera, in_frame: DVec3) -> DVec3 {
    in_frame.x * camera.u() + in_frame.y * camera.v() + in_frame.z * camera.w()
}

/// Pictures of these shapes by these cameras.
pub(crate) fn pictures(
    camera: impl Strategy<Value = CameraDescription>,
    shapes: impl Strategy<Value = Vec<Shape>>,
    placement: Placement,
) -> impl Strategy<Value = Case> {
    (camera, shapes).prop_filter_map("an accepted camera", move |(description, shapes)| {
        let camera = Camera::new(description).ok()?;
        let shapes = accepted(shapes).iter().map(|s| placement.of_shape(&camera, s)).collect();
        Some(Case { camera: description, shapes, points: vec![[0.0, 0.0]] })
    })
}

/// Perspective or parallel.
pub(crate) fn projection() -> impl Strategy<Value = Projection> {
    prop_oneof![Just(Projection::Perspective), Just(Projection::Parallel)]
}

/// Cameras along an axis whose samples have few bits: pixels with sides of 1/2, 1 or 2.
pub(crate) fn few_bit_camera() -> impl Strategy<Value = CameraDescription> {
    let axes = (0..3_usize, any::<bool>(), any::<bool>());
    let lens = ([1..=6_u8, 1..=6_u8], 0..3_usize, 0..2_usize);
    (projection(), few_bits(), axes, lens).prop_map(
        |(projection, eye, (axis, back, right), (image, cell, distance))| {
            let sign = |positive: bool| if positive { 1.0 } else { -1.0 };
            let w = Vec3::AXES[axis] * sign(back);
            let u = Vec3::AXES[(axis + 1) % 3] * sign(right);
            let cell = [0.5, 1.0, 2.0][cell];
            CameraDescription {
                projection,
                eye,
                orientation: Orientation::Frame { u, v: w.cross(u), w },
                distance: [1.0, 2.0][distance],
                viewport: image.map(|side| f32::from(side) * cell),
                image: image.map(u32::from),
            }
        },
    )
}

/// Cameras that look about the origin from a few units away, with frames of 53 bits and an eye of
/// few.
pub(crate) fn turned_camera() -> impl Strategy<Value = CameraDescription> {
    let up = [-1.0..1.0_f32, -1.0..1.0_f32, -1.0..1.0_f32].prop_map(Vec3::from_array);
    let eye = prop_oneof![few_bits(), few_bits().prop_map(|p| 2.0 * p + Vec3::new(0.0, 0.5, 8.0))];
    (projection(), eye, few_bits(), up, [1..=6_u32, 1..=6_u32], 0.25..3.0_f32).prop_map(
        |(projection, eye, target, up, image, scale)| CameraDescription {
            projection,
            eye,
            orientation: Orientation::LookAt { target: 0.25 * target, up },
            distance: 1.0,
            viewport: match projection {
                Projection::Perspective => [scale, scale],
                Projection::Parallel => [8.0 * scale, 8.0 * scale],
            },
            image,
        },
    )
}

/// Cameras at the limits of what is accepted.
pub(crate) fn extreme_camera() -> impl Strategy<Value = CameraDescription> {
    let exponent = || prop_oneof![Just(-64_i8), Just(64), -64..=64_i8, -2..=2_i8];
    let wide = prop_oneof![Just(20_i8), Just(-20), -128..=20_i8, -4..=4_i8];
    let lens = (exponent(), wide.clone(), wide, 0..3_usize);
    (turned_camera(), lens, finite_vector()).prop_map(|(camera, lens, far_away)| {
        let (distance, width, height, eye) = lens;
        let power = |exponent: i8| f32::from(exponent.clamp(-64, 64)).exp2();
        CameraDescription {
            eye: [camera.eye, Vec3::ZERO, far_away][eye],
            orientation: match camera.orientation {
                Orientation::LookAt { target, up } => {
                    Orientation::Direction { direction: target - camera.eye, up }
                }
                other => other,
            },
            distance: power(distance),
            viewport: [width, height].map(|side| power(distance.saturating_add(side))),
            ..camera
        }
    })
}

/// Coordinates that are halves of small integers.
pub(crate) fn few_bits() -> impl Strategy<Value = Vec3> + Clone {
    let half = (-6..=6_i8).prop_map(|k| 0.5 * f32::from(k));
    [half.clone(), half.clone(), half].prop_map(Vec3::from_array)
}

/// Small integers, mostly before the eye and only few planes deep; for [`Placement::Frame`].
pub(crate) fn few_bits_ahead() -> impl Strategy<Value = Vec3> + Clone {
    let integer = (-4..=4_i8).prop_map(f32::from);
    let depth = proptest::sample::select(&[-1.0_f32, -2.0, -2.0, -2.0, -4.0, -4.0, -4.0, 0.0][..]);
    [integer.clone().boxed(), integer.boxed(), depth.boxed()].prop_map(Vec3::from_array)
}

/// Coordinates between −4 and 4.
pub(crate) fn ordinary() -> impl Strategy<Value = Vec3> + Clone {
    let real = -4.0..4.0_f32;
    [real.clone(), real.clone(), real].prop_map(Vec3::from_array)
}

/// Somewhere in or near the viewing pyramid, on its continuation behind the eye, or on the eye's own
/// plane; for [`Placement::Viewport`].
pub(crate) fn about_the_view() -> impl Strategy<Value = Vec3> + Clone {
    let depth = prop_oneof![6 => 0.5..8.0_f32, 2 => -8.0..8.0_f32, 1 => Just(0.0), 1 => Just(1.0)];
    [(-1.0..1.0_f32).boxed(), (-1.0..1.0_f32).boxed(), depth.boxed()].prop_map(Vec3::from_array)
}

/// Any finite coordinates, denormal and huge ones mixed.
pub(crate) fn finite_vector() -> impl Strategy<Value = Vec3> + Clone {
    let number = prop_oneof![
        2 => -4.0..4.0_f32,
        1 => proptest::sample::select(&[0.0, 1e-45, f32::MIN_POSITIVE, 1.0, 3e38, f32::MAX][..]),
        2 => (-149..=127_i16).prop_map(|exponent| f32::from(exponent).exp2()),
        1 => proptest::num::f32::NORMAL | proptest::num::f32::SUBNORMAL,
    ];
    let signed = (number, any::<bool>()).prop_map(|(x, minus)| if minus { -x } else { x });
    [signed.clone(), signed.clone(), signed].prop_map(Vec3::from_array)
}

/// Unrelated triangles, spheres and planes.
pub(crate) fn soup(
    point: impl Strategy<Value = Vec3> + Clone + 'static,
) -> BoxedStrategy<Vec<Shape>> {
    let corners = [point.clone(), point.clone(), point.clone()];
    let sphere = [point.clone(), point.clone()].prop_map(|[center, rim]| {
        let radius = (rim - center).abs().max_element().clamp(1e-45, f32::MAX);
        Shape::Sphere(Sphere { center, radius })
    });
    let plane = [point.clone(), point].prop_filter_map("a normal", |[point, normal]| {
        (normal != Vec3::ZERO).then_some(Shape::Plane(Plane { point, normal }))
    });
    vec(prop_oneof![4 => corners.prop_map(triangle), 1 => sphere, 1 => plane], 2..=5).boxed()
}

/// Triangles about a common corner: shared edges, and silhouettes where two faces meet.
pub(crate) fn fans(
    point: impl Strategy<Value = Vec3> + Clone + 'static,
) -> BoxedStrategy<Vec<Shape>> {
    let fan = vec(point, 5).prop_map(|positions| {
        let triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
        let mesh = Mesh::new(positions, triangles);
        vec![Shape::Mesh(mesh.expect("the corners are finite"))]
    });
    fan.boxed()
}

/// Triangles that lie in one plane or are the same, turned or seen from behind, and sometimes the
/// plane itself.
pub(crate) fn coplanar(
    point: impl Strategy<Value = Vec3> + Clone + 'static,
) -> BoxedStrategy<Vec<Shape>> {
    let steps = vec([0..3_u8, 0..3_u8, 0..3_u8, 0..3_u8], 2..=4);
    ([point.clone(), point.clone(), point], steps, any::<bool>())
        .prop_map(|([a, b, c], steps, with_plane)| {
            let (ab, ac) = (b - a, c - a);
            let at = |i: u8, j: u8| a + (f32::from(i) - 1.0) * ab + (f32::from(j) - 1.0) * ac;
            let triangles = steps.iter().map(|&[i, j, k, turn]| match turn {
                0 => triangle([b, c, a]),
                1 => triangle([a, c, b]),
                _ => triangle([at(i, j), at(j, k), at(k, i)]),
            });
            let normal = ab.cross(ac);
            let accepted = with_plane && normal.is_finite() && normal != Vec3::ZERO;
            let plane = accepted.then_some(Shape::Plane(Plane { point: c, normal }));
            triangles.chain(plane).collect()
        })
        .boxed()
}

/// Triangles whose corners lie nearly or exactly on one line, or are the same. The line passes the
/// middle of the picture; for [`Placement::Frame`] and [`Placement::Viewport`].
pub(crate) fn slivers(
    point: impl Strategy<Value = Vec3> + Clone + 'static,
) -> BoxedStrategy<Vec<Shape>> {
    let between = proptest::sample::select(&[-1.0, 0.0, 0.25, 0.3, 0.5, 0.9, 1.0, 2.0][..]);
    let thickness = proptest::sample::select(&[0_i8, -2, -4, -10, -16, -20, -22, -24][..])
        .prop_map(|exponent| if exponent == 0 { 0.0 } else { f32::from(exponent).exp2() });
    let sliver = ([point.clone(), point.clone()], 1..=2_i8, between, thickness, point).prop_map(
        |([a, other], k, between, thickness, aside)| {
            let b = Vec3::new(-f32::from(k) * a.x, -f32::from(k) * a.y, other.z);
            triangle([a, b, a + between * (b - a) + thickness * aside])
        },
    );
    vec(sliver, 2..=4).boxed()
}

/// Triangles whose planes hold the eye, or the viewing direction, exactly or nearly; for
/// [`Placement::Frame`].
pub(crate) fn edge_on(
    point: impl Strategy<Value = Vec3> + Clone + 'static,
) -> BoxedStrategy<Vec<Shape>> {
    let factor = || (-2..=2_i8).prop_map(f32::from);
    let (parallel, steps) = (any::<bool>(), -1..=1_i8);
    let one = ([point.clone(), point], factor(), factor(), parallel, steps).prop_map(
        |([a, b], i, j, parallel, steps)| {
            let c = if parallel { a + i * (b - a) + j * Vec3::Z } else { i * a + j * b };
            triangle([a, b, Vec3::new(step(c.x, steps), c.y, c.z)])
        },
    );
    vec(one, 2..=4).boxed()
}

/// Those of the shapes that are accepted.
fn accepted(mut shapes: Vec<Shape>) -> Vec<Shape> {
    shapes.retain(|shape| Scene::new(vec![shape.clone().into()]).is_ok());
    shapes
}

/// A triangle.
pub(crate) fn triangle([a, b, c]: [Vec3; 3]) -> Shape {
    Shape::Triangle(Triangle { a, b, c })
}

/// The next number above, below, or the number itself.
fn step(x: f32, direction: i8) -> f32 {
    match direction {
        1 => x.next_up(),
        -1 => x.next_down(),
        _ => x,
    }
}
