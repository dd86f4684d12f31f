//! Shared edges leave no hole and no overlap, and ties go to the expected triangle.

use crate::four_renderers::{RENDERERS, all_agree, owners};
use bothways::common::exact::Sign;
use bothways::common::glam::Vec3;
use bothways::common::{Camera, Mesh, Options, Primitive, Projection, Ray, Scene, Shape, View};
use bothways_test_support::{PROJECTIONS, camera, mesh, scene, triangle, turned};

/// A square from (−4, −4) to (4, 4) at z = −4, cut into 8 × 8 cells of two triangles, inner vertices
/// moved by `shake`.
fn tiling(shake: impl Fn(u32, u32) -> [f32; 3]) -> Scene {
    let inner = |k: u32| (1..8).contains(&k);
    let vertex = |row: u32, column: u32| {
        let place = Vec3::new(column as f32 - 4.0, row as f32 - 4.0, -4.0);
        let shaken = inner(row) && inner(column);
        if shaken { place + Vec3::from_array(shake(row, column)) } else { place }
    };
    let positions = (0..81).map(|k| vertex(k / 9, k % 9)).collect();
    let cell = |k: u32| {
        let corner = k / 8 * 9 + k % 8;
        let [a, b, c, d] = [corner, corner + 1, corner + 10, corner + 9];
        if k.is_multiple_of(3) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [d, b, c]] }
    };
    let triangles = (0..64).flat_map(cell).collect();
    scene(vec![mesh(Mesh::new(positions, triangles).expect("it is a mesh"))])
}

/// Asserts that exactly one primitive covers each sample, in all four renderers.
fn assert_one_owner(scene: &Scene, camera: &Camera, samples: u32) {
    let options = Options { samples, ..Options::default() };
    let view = View::new(scene, camera);
    for (name, counts) in owners(&view, &options) {
        assert!(counts.iter().all(|&count| count == 1), "{name}, {:?}", camera.description());
    }
}

#[test]
fn a_tiling_owns_every_sample_once() {
    let flat = tiling(|_, _| [0.0; 3]);
    let few_bits = tiling(|i, j| [0.25 * ((i + j) % 3) as f32, -0.25 * ((i * j) % 3) as f32, 0.0]);
    let bumpy = tiling(|i, j| {
        let wave = (i * 31 + j * 17) as f32;
        [0.2 * wave.sin(), 0.2 * (1.7 * wave).sin(), 0.2 * (2.3 * wave).cos()]
    });
    for scene in [&flat, &few_bits, &bumpy] {
        for image in [[8, 8], [16, 16], [7, 5], [1, 1]] {
            for samples in [1, 2, 3] {
                // Samples lie on the grid's lines and vertices, in both projections.
                let near = camera(Projection::Perspective, [0.0; 3], [2.0, 2.0], image);
                let wide = camera(Projection::Parallel, [0.0; 3], [8.0, 8.0], image);
                assert_one_owner(scene, &near, samples);
                assert_one_owner(scene, &wide, samples);
            }
        }
    }
}

#[test]
fn samples_on_the_vertices_of_the_tiling_are_exact_ties() {
    let scene = tiling(|_, _| [0.0; 3]);
    let camera = camera(Projection::Perspective, [0.0; 3], [1.75, 1.75], [7, 7]);
    let view = View::new(&scene, &camera);
    let on_vertex = |i, j| {
        let ray = camera.viewing_ray(i, j);
        let signs = view.primitives().filter_map(|(_, primitive)| match primitive {
            Primitive::Triangle(corners) => Some(view.judge().edge_signs(&corners, &ray)),
            _ => None,
        });
        signs
            .filter(|signs| signs.at_sample.iter().filter(|&&s| s == Sign::Zero).count() == 2)
            .count()
    };
    assert!((0..7).all(|i| (0..7).all(|j| on_vertex(i, j) >= 2)));
    assert_one_owner(&scene, &camera, 1);
}

/// An octahedron with few-bit vertices around the origin.
fn octahedron(size: f32, center: Vec3) -> Mesh {
    let axes = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
    let positions = axes.iter().map(|axis| center + size * *axis).collect();
    let triangles = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    Mesh::new(positions, triangles).expect("it is a mesh")
}

#[test]
fn a_closed_mesh_from_inside_covers_every_sample() {
    let scene = scene(vec![Shape::Mesh(octahedron(8.0, Vec3::ZERO)).into()]);
    let cameras = [
        camera(Projection::Perspective, [0.0, 0.0, 1.0], [4.0, 4.0], [16, 16]),
        camera(Projection::Perspective, [0.5, 0.25, 0.0], [2.0, 2.0], [15, 9]),
        turned(Projection::Perspective, [1.0, -2.0, 0.5], [3.0, 3.0, 1.0], [16, 16]),
    ];
    for camera in &cameras {
        let view = View::new(&scene, camera);
        let options = Options { samples: 2, ..Options::default() };
        let frame = all_agree(&view, &options, "octahedron from inside");
        assert!(frame.ids().iter().all(|id| id.is_some_and(|id| id < 8)));
    }
}

/// Whether a ray meets the line through an edge of a triangle exactly; not for a triangle that is seen edge-on.
fn is_on_edge(view: &View, primitive: &Primitive, ray: &Ray) -> bool {
    let Primitive::Triangle(corners) = primitive else { return false };
    let signs = view.judge().edge_signs(corners, ray);
    signs.facing != Sign::Zero && signs.at_sample.contains(&Sign::Zero)
}

/// The signed count of faces over a sample: how often the mesh winds around the eye.
fn winding(view: &View, i: u32, j: u32) -> i32 {
    let ray = view.camera.viewing_ray(i, j);
    let judge = view.judge();
    view.primitives()
        .filter(|(_, primitive)| judge.covers(primitive, &ray))
        .map(|(_, primitive)| match primitive {
            Primitive::Triangle(corners) => match judge.facing(&corners, &ray) {
                Sign::Negative => -1,
                Sign::Zero => 0,
                Sign::Positive => 1,
            },
            _ => 0,
        })
        .sum()
}

#[test]
fn the_signed_count_of_faces_is_the_winding_number() {
    let outside = Shape::Mesh(octahedron(2.0, Vec3::new(0.0, 0.0, -4.0)));
    let around = Shape::Mesh(octahedron(4.0, Vec3::new(0.5, 0.0, 0.0)));
    let outside = scene(vec![outside.into()]);
    let around = scene(vec![around.into()]);
    let mut ties = 0;
    for projection in PROJECTIONS {
        let camera = camera(projection, [0.0; 3], [4.0, 4.0], [17, 17]);
        for (i, j) in (0..17 * 17).map(|k| (k / 17, k % 17)) {
            let view = View::new(&outside, &camera);
            assert_eq!(winding(&view, i, j), 0, "{projection:?} ({i}, {j})");
            if projection == Projection::Perspective {
                let view = View::new(&around, &camera);
                assert_eq!(winding(&view, i, j), 1, "({i}, {j})");
            }
            let view = View::new(&outside, &camera);
            let ray = camera.viewing_ray(i, j);
            ties += u32::from(view.primitives().any(|(_, one)| is_on_edge(&view, &one, &ray)));
        }
    }
    // The middle row and the middle column lie on the octahedron's planes of symmetry.
    assert!(ties >= 2 * 33, "{ties} samples lie on edges");
}

/// Whether the top-left rule, in integers with y down, gives a sample to a triangle: an independent rasterizer, written
/// from the description of Direct3D.
fn top_left_covers(corners: [[i64; 2]; 3], sample: [i64; 2]) -> bool {
    let [a, b, c] = corners;
    let twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if twice_area == 0 {
        return false;
    }
    let clockwise = if twice_area > 0 { [a, b, c] } else { [a, c, b] };
    (0..3).all(|k| {
        let (from, to) = (clockwise[k], clockwise[(k + 1) % 3]);
        let along = [to[0] - from[0], to[1] - from[1]];
        let side = along[0] * (sample[1] - from[1]) - along[1] * (sample[0] - from[0]);
        // Clockwise on the screen: a left edge goes up, a top edge goes exactly right.
        let left = along[1] < 0;
        let top = along[1] == 0 && along[0] > 0;
        side > 0 || (side == 0 && (left || top))
    })
}

#[test]
fn the_canonical_camera_s_ties_follow_the_top_left_rule() {
    // Raster coordinates in halves of a pixel: sample (i, j) lies at (2j + 1, 2i + 1).
    const SIZE: i64 = 8;
    let world = |[x, y]: [i64; 2]| {
        [(x - SIZE) as f32 / (2 * SIZE) as f32, (SIZE - y) as f32 / (2 * SIZE) as f32, -1.0]
    };
    let (mut ties, mut seed) = (0, 1_u64);
    let mut coordinate = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // Mostly odd numbers, which samples have.
        let number = i64::try_from(seed >> 33).unwrap() % (2 * SIZE);
        if seed >> 62 == 0 { number } else { number | 1 }
    };
    for _ in 0..300 {
        let corners: [[i64; 2]; 3] = std::array::from_fn(|_| [coordinate(), coordinate()]);
        let scene = scene(vec![triangle(corners.map(world))]);
        for projection in PROJECTIONS {
            let side = u32::try_from(SIZE).unwrap();
            let camera = camera(projection, [0.0; 3], [1.0, 1.0], [side, side]);
            let view = View::new(&scene, &camera);
            for (name, render) in RENDERERS {
                let frame = render(&view, &Options::default());
                for (k, id) in (0..).zip(frame.ids().iter()) {
                    let (i, j) = (k / SIZE, k % SIZE);
                    let expected = top_left_covers(corners, [2 * j + 1, 2 * i + 1]);
                    let seen = id.is_some();
                    assert_eq!(seen, expected, "{name}, {projection:?}: {corners:?} at ({i}, {j})");
                }
            }
            let on_edge = |k: u32| {
                is_on_edge(&view, &view.primitive(0), &camera.viewing_ray(k / side, k % side))
            };
            ties += (0..64).filter(|&k| on_edge(k)).count();
        }
    }
    assert!(ties > 3_000, "{ties} ties");
}

/// One edge at a time.
#[test]
fn left_and_top_edges_own_the_samples_on_them() {
    // A sample lies at (0, 0), on an edge of the triangle. The third corner says on which side of the edge the triangle
    // lies.
    let owns = |corners: [[f32; 2]; 3]| {
        let scene = scene(vec![triangle(corners.map(|[x, y]| [x, y, -1.0]))]);
        let mut seen: Vec<bool> = Vec::new();
        for projection in PROJECTIONS {
            let camera = camera(projection, [0.0; 3], [3.0, 3.0], [3, 3]);
            let view = View::new(&scene, &camera);
            seen.push(all_agree(&view, &Options::default(), "edge").id(1, 1).is_some());
        }
        assert_eq!(seen[0], seen[1]);
        seen[0]
    };
    let (up, down, left, right) = ([0.0, 4.0], [0.0, -4.0], [-4.0, 0.0], [4.0, 0.0]);
    assert!(owns([up, down, right]), "a left edge owns: the inside is to its right");
    assert!(!owns([up, down, left]), "a right edge does not");
    assert!(owns([left, right, down]), "a top edge owns: the inside is below");
    assert!(!owns([left, right, up]), "a bottom edge does not");
    let (rise, fall) = ([[-4.0, -4.0], [4.0, 4.0]], [[-4.0, 4.0], [4.0, -4.0]]);
    assert!(owns([rise[0], rise[1], [4.0, -4.0]]), "a slanted left edge owns");
    assert!(!owns([rise[0], rise[1], [-4.0, 4.0]]), "a slanted right edge does not");
    assert!(owns([fall[0], fall[1], [4.0, 4.0]]), "a slanted left edge owns");
    assert!(!owns([fall[0], fall[1], [-4.0, -4.0]]), "a slanted right edge does not");
}
