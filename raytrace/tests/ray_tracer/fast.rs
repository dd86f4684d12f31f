//! The fast ray tracer where it is most likely to go wrong: its tiles, its boxes, its hierarchy, its
//! bounds. The textbook says what is right.

use bothways_common::engine::simd::levels;
use bothways_common::glam::{Quat, Vec3};
use bothways_common::scene::{Instances, Placement};
use bothways_common::{
    Camera, CameraDescription, Frame, Mesh, Object, Options, Orientation, Plane, Projection, Shape,
    Sphere, Triangle, View, Work,
};
use bothways_raytrace::{
    fast::{self, WorldRay},
    textbook,
};
use bothways_test_support::{
    Dice, PROJECTIONS, assert_same_visibility, camera, grids_on_quarters, mesh, on_integers, scene,
    triangle, turned,
};

/// So many triangles of this size around the origin.
fn soup(count: u32, size: f32) -> Mesh {
    let mut dice = Dice(u64::from(count));
    let positions = (0..count).flat_map(|_| {
        let middle = dice.point();
        [(); 3].map(|()| middle + size * dice.point())
    });
    let triangles = (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Mesh::new(positions.collect(), triangles).expect("it is a mesh")
}

fn check_against_textbook(view: &View, samples: u32, what: &str) -> Frame {
    let options = Options { samples, ..Options::default() };
    let expected = textbook::render(view, &options);
    let frame = fast::render(&fast::prepare(view.scene), view, &options);
    assert_same_visibility(&expected, &frame, what);
    frame
}

#[test]
fn soups_of_all_sizes_from_everywhere() {
    for (count, size) in [(1, 1.0), (7, 0.8), (9, 0.5), (60, 0.3), (300, 0.05), (300, 1.5)] {
        let scene = scene(vec![mesh(soup(count, size))]);
        for projection in PROJECTIONS {
            for eye in [[2.0, 1.5, 3.0], [0.1, -0.2, 0.05], [-40.0, 3.0, 20.0], [0.0, 0.0, 1.0]] {
                let camera = turned(projection, eye, [0.02, 0.01, 0.03], [61, 45]);
                let what = format!("{count} triangles of {size}, {projection:?} from {eye:?}");
                check_against_textbook(&View::new(&scene, &camera), 1, &what);
            }
        }
    }
}

#[test]
fn simd_and_threads_change_no_bit_and_tiles_no_id() {
    let ball = Shape::Sphere(Sphere { center: Vec3::new(0.3, 0.2, 0.1), radius: 0.4 });
    let ground = Shape::Plane(Plane { point: Vec3::new(0.0, -0.9, 0.0), normal: Vec3::Y });
    let objects = vec![mesh(soup(400, 0.3)), ball.into(), ground.into()];
    let scene = scene(objects);
    let options = Options { samples: 2, ..Options::default() };
    for (projection, image) in PROJECTIONS.into_iter().zip([[130, 70], [77, 33]]) {
        let camera = turned(projection, [1.0, 1.2, 2.0], [0.0; 3], image);
        let view = View::new(&scene, &camera);
        let trace = |prepared: &fast::Prepared, work: &mut Work| {
            let mut frame = Frame::new(&camera, &options);
            fast::determine_visibility(prepared, &view, &options, &mut frame, work);
            let mut unwatched = Frame::new(&camera, &options);
            fast::determine_visibility(prepared, &view, &options, &mut unwatched, &mut ());
            assert_eq!(frame, unwatched, "watching changes nothing");
            frame
        };
        let prepared = fast::prepare(&scene);
        let mut expected_work = Work::default();
        let expected = trace(&prepared, &mut expected_work);
        for side in [16, 32] {
            let mut of_side: Option<Frame> = None;
            for level in levels() {
                for threads in [1, 3] {
                    let mut prepared = prepared.clone().drawn_with(level, side);
                    prepared.cut_for_threads(threads);
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                    let mut work = Work::default();
                    let frame = pool.expect("threads").install(|| trace(&prepared, &mut work));
                    let what = format!("{level:?}, tiles of {side}, {threads} threads");
                    assert_eq!(work, expected_work, "{what}");
                    assert_same_visibility(&expected, &frame, &what);
                    let first = of_side.get_or_insert_with(|| frame.clone());
                    assert_eq!(first.distances(), frame.distances(), "{what}");
                }
            }
        }
    }
}

#[test]
fn rays_that_graze_boxes_and_meet_vertices_and_edges() {
    // A grid whose vertices lie exactly on rays, in slabs whose boxes are flat and end on rays, too.
    let positions = (0..33 * 33).map(|k| {
        let (row, column) = (k / 33, k % 33);
        Vec3::new(column as f32 - 16.0, row as f32 - 16.0, -16.0 - ((row * 7 + column) % 3) as f32)
    });
    let cells = (0..32 * 32).map(|k| k / 32 * 33 + k % 32);
    let triangles = cells.flat_map(|k| [[k, k + 1, k + 34], [k, k + 34, k + 33]]);
    let grid = Mesh::new(positions.collect(), triangles.collect()).expect("it is a mesh");
    let slabs = (0..6_u8).map(|k| {
        let x = 4.0 * f32::from(k) - 12.0;
        triangle([[x, -16.0, -8.0], [x + 4.0, -16.0, -8.0], [x, 16.0, -8.0]])
    });
    let scene = scene(std::iter::once(mesh(grid)).chain(slabs).collect());
    for (projection, viewport) in PROJECTIONS.into_iter().zip([[2.0625; 2], [33.0; 2]]) {
        let camera = camera(projection, [0.0; 3], viewport, [33, 33]);
        check_against_textbook(&View::new(&scene, &camera), 1, "on the grid's lines");
        let fine = bothways_test_support::camera(projection, [1.0, 0.0, 0.0], viewport, [66, 33]);
        check_against_textbook(&View::new(&scene, &fine), 2, "and between them");
    }
}

#[test]
fn tiny_triangles_beside_large_ones() {
    // So many that a node has more leaves than wait at one time, and with large ones, a sphere and instances among them.
    let mut dice = Dice(8);
    let mut objects = vec![mesh(soup(9000, 0.01))];
    objects.extend((0..12).map(|_| {
        let middle = dice.point();
        triangle([(); 3].map(|()| (middle + 0.7 * dice.point()).to_array()))
    }));
    objects.push(Shape::Sphere(Sphere { center: Vec3::new(0.2, 0.1, 0.3), radius: 0.2 }).into());
    let places = [Vec3::new(0.4, -0.3, 0.2), Vec3::new(-0.5, 0.2, 0.1)].map(Placement::translation);
    let instances = Instances::new(soup(500, 0.01), places.to_vec()).expect("they are instances");
    objects.push(Shape::Instances(instances).into());
    let scene = scene(objects);
    for projection in PROJECTIONS {
        for eye in [[2.0, 1.5, 3.0], [0.3, -0.2, 1.4]] {
            let camera = turned(projection, eye, [0.02, 0.01, 0.03], [61, 45]);
            let view = View::new(&scene, &camera);
            let what = format!("{projection:?} from {eye:?}");
            let expected = check_against_textbook(&view, 1, &what);
            let prepared = fast::prepare(&scene);
            for side in [16, 32] {
                let prepared = prepared.clone().drawn_with(levels()[0], side);
                let (mut frame, mut work) = (expected.clone(), Work::default());
                frame.clear();
                fast::determine_visibility(
                    &prepared,
                    &view,
                    &Options::default(),
                    &mut frame,
                    &mut work,
                );
                assert_same_visibility(&expected, &frame, &what);
            }
        }
    }
}

#[test]
fn neighbours_whose_ids_are_far_apart_are_seen() {
    // Two triangles of a square, and between them so many others in one place behind it, of which the first is seen.
    let meshes = |between: usize| {
        let mut positions = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]]
            .map(|[x, y]: [f32; 2]| Vec3::new(x, y, -4.0))
            .to_vec();
        positions
            .extend([[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[x, y]| Vec3::new(x, y, -20.0)));
        let mut triangles = vec![[0, 1, 2]];
        triangles.extend(vec![[4, 5, 6]; between]);
        triangles.push([3, 2, 1]);
        let one = Mesh::new(positions, triangles).expect("it is a mesh");
        let places = [Vec3::ZERO, Vec3::new(0.5, 0.3, 1.0)].map(Placement::translation);
        let two = Instances::new(one.clone(), places.to_vec()).expect("they are instances");
        [Shape::Mesh(one), Shape::Instances(two)].map(|shape| scene(vec![shape.into()]))
    };
    let (few, many) = (3_u64, 600_000_u64);
    let sizes = [few, many].map(|between| usize::try_from(between).expect("it is small"));
    let [of_few, of_many] = sizes.map(meshes);
    // The id that a triangle of the smaller scene has in the larger one.
    let renamed = |id: u64| {
        let (instance, local) = (id / (few + 2), id % (few + 2));
        instance * (many + 2) + if local > few { local + many - few } else { local }
    };
    for (of_few, of_many) in of_few.iter().zip(&of_many) {
        let prepared = fast::prepare(of_many);
        for projection in PROJECTIONS {
            let camera = turned(projection, [0.3, 0.2, 3.0], [0.1, 0.0, -4.0], [64, 48]);
            let expected = check_against_textbook(&View::new(of_few, &camera), 1, "a few between");
            let (view, options) = (View::new(of_many, &camera), Options::default());
            let [mut unwatched, mut watched] = [(); 2].map(|()| Frame::new(&camera, &options));
            let mut work = Work::default();
            fast::determine_visibility(&prepared, &view, &options, &mut unwatched, &mut ());
            fast::determine_visibility(&prepared, &view, &options, &mut watched, &mut work);
            assert_eq!(unwatched, watched);
            let ids: Vec<Option<u64>> = expected.ids().iter().map(|id| id.map(renamed)).collect();
            assert!(unwatched.ids().iter().eq(ids.iter().copied()), "{projection:?}");
            assert!(ids.contains(&Some(many + 1)), "one of the far apart is seen");
            for level in levels() {
                let prepared = prepared.clone().drawn_with(level, 16);
                fast::determine_visibility(&prepared, &view, &options, &mut unwatched, &mut ());
                assert_eq!(unwatched.ids(), watched.ids(), "{level:?}");
            }
        }
    }
}

#[test]
fn edges_through_samples_need_no_judge_where_vertices_are_on_the_raster() {
    for (scene, camera, what) in grids_on_quarters() {
        let (view, options) = (View::new(&scene, &camera), Options::default());
        let mut frame = check_against_textbook(&view, 1, &what);
        let mut work = Work::default();
        let prepared = fast::prepare(&scene);
        fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut work);
        assert_eq!(work.judged_coverage, 0, "{what}: {work:?}");
    }
}

#[test]
fn every_triangle_on_quarters_of_samples() {
    // Any corners, at several depths, so that edges of any slope pass through samples.
    let mut dice = Dice(3);
    let triangles = (0..300).map(|_| {
        let z = (4.0 * dice.next()).floor() - 8.0;
        triangle([(); 3].map(|()| {
            let [x, y, _] = dice.point().to_array();
            [(6.0 * x).floor() * 0.75 * -z, (6.0 * y).floor() * 0.5 * -z, z]
        }))
    });
    let scene = scene(triangles.collect());
    for projection in PROJECTIONS {
        for samples in [1, 2, 4] {
            let camera = on_integers(projection, 6);
            let what = format!("{projection:?}, {samples} samples");
            check_against_textbook(&View::new(&scene, &camera), samples, &what);
        }
    }
}

#[test]
fn extreme_aspects_and_scales() {
    for power in [-120_i32, -60, -20, 0, 20, 60, 100] {
        let scale = (power as f32).exp2();
        let needles = (0..40_i16).map(|k| {
            let k = f32::from(k);
            let at = |x: f32, y: f32, z: f32| (scale * Vec3::new(x, y, z)).to_array();
            let thin = (-k).exp2();
            triangle([
                at(-1.0, 0.05 * k - 1.0, -2.0),
                at(1.0, 0.04 * k - 1.0 + thin, -2.0 - 0.1 * k),
                at(0.9, 0.04 * k - 1.0, -3.0),
            ])
        });
        let scene = scene(needles.collect());
        for projection in PROJECTIONS {
            let viewport = match projection {
                Projection::Perspective => [1.5, 1.5],
                Projection::Parallel => [2.0 * scale.clamp(1e-18, 1e18); 2],
            };
            let distance = if projection == Projection::Parallel { viewport[0] } else { 1.0 };
            for image in [[50, 50], [400, 3], [2, 300]] {
                let description = CameraDescription {
                    projection,
                    viewport,
                    distance,
                    image,
                    ..CameraDescription::default()
                };
                let camera = Camera::new(description).expect("it is a camera");
                let what = format!("2^{power}, {projection:?}, {image:?}");
                check_against_textbook(&View::new(&scene, &camera), 1, &what);
            }
        }
    }
}

#[test]
fn corners_a_rounding_beside_samples() {
    // Whether such a triangle covers the sample depends on bits that single precision, in which triangles are
    // sifted, does not have.
    let mut hits = 0;
    let cases = PROJECTIONS.into_iter().flat_map(|projection| [(projection, 3), (projection, 7)]);
    for (projection, corners) in cases {
        let camera = Camera::new(CameraDescription {
            projection,
            eye: Vec3::new(0.6, 0.48, 0.64),
            orientation: Orientation::LookAt { target: Vec3::ZERO, up: Vec3::Y },
            viewport: [1.0; 2],
            image: [64, 64],
            ..CameraDescription::default()
        })
        .expect("it is a camera");
        let mut dice = Dice(1);
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for k in 0..800_u32 {
            let ray = camera.viewing_ray(k * 37 % 64, k * 59 / 8 % 64);
            let seen = ray.origin + f64::from(2.0 + dice.next()) * ray.direction;
            let corner = (camera.eye().as_dvec3() + seen).as_vec3();
            vertices.push(corner);
            vertices.extend((1..corners).map(|_| corner + 0.4 / 64.0 * dice.point()));
            let first = k * corners;
            triangles.extend((2..corners).map(|other| [first, first + other - 1, first + other]));
        }
        let scene = scene(vec![mesh(Mesh::new(vertices, triangles).expect("it is a mesh"))]);
        let view = View::new(&scene, &camera);
        let frame = check_against_textbook(&view, 1, &format!("{projection:?}, {corners}"));
        hits += frame.ids().covered();
    }
    assert!(hits > 1000, "{hits}");
}

#[test]
fn a_million_coincident_triangles() {
    let one = [Vec3::new(-1.0, -1.0, -3.0), Vec3::new(1.5, -1.0, -2.0), Vec3::new(0.0, 1.5, -4.0)];
    let triangles = (0..1_000_000).map(|k| [k % 3, (k + 1) % 3, (k + 2) % 3]);
    let mesh = Mesh::new(one.to_vec(), triangles.collect()).expect("it is a mesh");
    let far = triangle([[-9.0, -9.0, -9.0], [9.0, -9.0, -9.0], [0.0, 9.0, -9.0]]);
    let scene = scene(vec![far, bothways_test_support::mesh(mesh)]);
    let few = bothways_test_support::scene(vec![
        triangle([[-9.0, -9.0, -9.0], [9.0, -9.0, -9.0], [0.0, 9.0, -9.0]]),
        Shape::Triangle(Triangle { a: one[0], b: one[1], c: one[2] }).into(),
    ]);
    for projection in PROJECTIONS {
        let camera = camera(projection, [0.0; 3], [4.0, 4.0], [200, 200]);
        let (view, options) = (View::new(&scene, &camera), Options::default());
        let frame = fast::render(&fast::prepare(&scene), &view, &options);
        let expected = check_against_textbook(&View::new(&few, &camera), 1, "two triangles");
        assert_eq!(frame.ids(), expected.ids());
    }
}

#[test]
fn spheres_only_planes_only_nothing_at_all() {
    let mut dice = Dice(5);
    let balls = (0..100).map(|_| {
        let center = 2.0 * dice.point();
        Shape::Sphere(Sphere { center, radius: 0.05 + 0.3 * dice.next().abs() }).into()
    });
    let balls: Vec<Object> = balls.collect();
    let planes = (0..5).map(|_| {
        let (point, normal) = (dice.point() - Vec3::Z, dice.point());
        Shape::Plane(Plane { point, normal }).into()
    });
    let planes: Vec<Object> = planes.collect();
    let mixed = [balls.clone(), planes.clone(), vec![mesh(soup(50, 0.4))]].concat();
    for objects in [balls, planes, mixed, vec![]] {
        let scene = scene(objects);
        for projection in PROJECTIONS {
            let camera = turned(projection, [1.0, 2.0, 4.0], [0.0; 3], [60, 41]);
            check_against_textbook(&View::new(&scene, &camera), 1, &format!("{projection:?}"));
        }
    }
}

#[test]
fn any_ray_meets_what_its_camera_sees() {
    let ball = Shape::Sphere(Sphere { center: Vec3::new(0.3, 0.2, 0.1), radius: 0.4 });
    let scene = scene(vec![mesh(soup(200, 0.5)), ball.into()]);
    let prepared = fast::prepare(&scene);
    let mut dice = Dice(17);
    let mut hits = 0;
    for k in 0..400 {
        // Some along the axes, and from few-bit origins.
        let round = |v: Vec3| if k % 4 == 0 { (2.0 * v).round() } else { v };
        let origin = 2.0 * round(dice.point());
        let direction = round(0.5 * dice.point()) - origin;
        if direction == Vec3::ZERO {
            continue;
        }
        let ray = WorldRay { origin, direction };
        let camera = ray.camera();
        let expected = textbook::render(&View::new(&scene, &camera), &Options::default());
        let hit = fast::first_hit(&prepared, &scene, ray);
        assert_eq!(hit.map(|hit| hit.id), expected.id(0, 0), "{ray:?}");
        if let (Some(hit), Some(t)) = (hit, expected.t(0, 0)) {
            assert!((hit.distance - t).abs() <= 1e-6 * t, "{ray:?}: {} and {t}", hit.distance);
            hits += 1;
        }
    }
    assert!(hits > 100, "{hits}");
}

#[test]
fn a_ray_on_an_edge_belongs_to_its_right() {
    // The edge from (0, −1) to (0, 1) at z = −1, shared by a triangle on either side.
    let left = triangle([[0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [-1.0, 0.0, -1.0]]);
    let right = triangle([[0.0, -1.0, -1.0], [0.0, 1.0, -1.0], [1.0, 0.0, -1.0]]);
    let scene = scene(vec![left, right]);
    let prepared = fast::prepare(&scene);
    let forward = WorldRay { origin: Vec3::ZERO, direction: Vec3::NEG_Z };
    assert_eq!(forward.camera().u().as_vec3(), Vec3::X);
    assert_eq!(fast::first_hit(&prepared, &scene, forward).map(|hit| hit.id), Some(1));
    let back = WorldRay { origin: Vec3::new(0.0, 0.0, -3.0), direction: Vec3::Z };
    assert_eq!(back.camera().u().as_vec3(), Vec3::NEG_X);
    assert_eq!(fast::first_hit(&prepared, &scene, back).map(|hit| hit.id), Some(0));
}

#[test]
fn turned_and_far_away() {
    // Small things far from the origin and from the eye, whose offsets cancel.
    let turn = Quat::from_rotation_y(0.7);
    let place = Vec3::new(1000.0, -500.0, 250.0);
    let far = soup(200, 0.2);
    let positions = far.positions().iter().map(|p| place + turn * *p).collect();
    let far = Mesh::new(positions, far.triangles().to_vec()).expect("it is a mesh");
    let scene = scene(vec![mesh(far)]);
    for projection in PROJECTIONS {
        for away in [3.0, 3000.0] {
            let description = CameraDescription {
                projection,
                eye: place + away * Vec3::new(0.6, 0.48, 0.64),
                orientation: Orientation::LookAt { target: place, up: Vec3::Y },
                distance: if projection == Projection::Perspective { away } else { 1.0 },
                viewport: [2.5, 2.5],
                image: [70, 70],
            };
            let camera = Camera::new(description).expect("it is a camera");
            check_against_textbook(&View::new(&scene, &camera), 1, "far away");
        }
    }
}
