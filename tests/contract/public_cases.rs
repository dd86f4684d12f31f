//! Failures that users of other programs reported in public, rebuilt as scenes from their descriptions: all four
//! renderers must be right for each scene.

use crate::four_renderers::{all_agree, owners};
use bothways::common::glam::Vec3;
use bothways::common::{Camera, CameraDescription, Mesh, Options, Projection, Scene, View};
use bothways_test_support::{PROJECTIONS, camera, mesh, scene};

fn quad(positions: &[[f32; 3]], triangles: Vec<[u32; 3]>) -> Scene {
    let positions = positions.iter().map(|p| Vec3::from_array(*p)).collect();
    scene(vec![mesh(Mesh::new(positions, triangles).expect("it is a mesh"))])
}

/// facebookresearch/DRTK, issue 9, "Edge case": pixel centres at integers of an 8 × 8 image; six of
/// them lie exactly on the diagonal that two triangles share, and belonged to neither.
#[test]
fn drtk_issue_9_the_shared_diagonal_has_no_hole() {
    let (near, far) = (0.499_938_96, 6.500_061);
    let raster = [[0.5, near], [0.5, 6.5], [far, near], [far, 6.5]];
    let world = raster.map(|[x, y]: [f32; 2]| [x - 3.5, 3.5 - y, -1.0]);
    for triangles in [vec![[0, 1, 2], [3, 2, 1]], vec![[0, 1, 2], [3, 1, 2]]] {
        let scene = quad(&world, triangles);
        for projection in PROJECTIONS {
            let camera = camera(projection, [0.0; 3], [8.0, 8.0], [8, 8]);
            let view = View::new(&scene, &camera);
            let frame = all_agree(&view, &Options::default(), "DRTK 9");
            // The diagonal runs down to the left; its samples go to the triangle on its right.
            let expected = [
                "........", ".000001.", ".000011.", ".000111.", ".001111.", ".011111.", ".111111.",
                "........",
            ];
            let seen = |i, j| frame.id(i, j).map_or('.', |id| if id == 0 { '0' } else { '1' });
            let rows: Vec<String> = (0..8).map(|i| (0..8).map(|j| seen(i, j)).collect()).collect();
            assert_eq!(rows, expected, "{projection:?}");
            for (name, counts) in owners(&view, &Options::default()) {
                assert!(counts.iter().all(|&count| count <= 1), "{name}");
                assert_eq!(counts.iter().sum::<u32>(), 36, "{name}");
            }
        }
    }
}

/// zesterer/euc, issue 17, "Adjacent triangles sometimes write to the same pixel": two triangles of
/// lyon's fuzzer that share an edge.
#[test]
fn euc_issue_17_no_pixel_is_written_twice() {
    let points = [
        [0.073_184_55, 0.338_219_34],
        [0.227_762_1, 0.690_997_2],
        [0.658_247_05, 0.837_475_54],
        [0.023_455_322, 0.977_184_65],
    ];
    let scene = quad(&points.map(|[x, y]| [x, y, -1.0]), vec![[0, 1, 2], [1, 0, 3]]);
    for projection in PROJECTIONS {
        for size in [1, 7, 16, 33, 100] {
            let description = CameraDescription {
                projection,
                eye: Vec3::new(0.5, 0.5, 0.0),
                viewport: [1.0, 1.0],
                image: [size, size],
                ..CameraDescription::default()
            };
            let camera = Camera::new(description).unwrap();
            let view = View::new(&scene, &camera);
            all_agree(&view, &Options::default(), "euc 17");
            for (name, counts) in owners(&view, &Options::default()) {
                assert!(counts.iter().all(|&count| count <= 1), "{name} at {size}");
            }
        }
    }
}

/// Oblikovati, issue 2146, "Software BVH ray-triangle test has a hairline crack at shared triangle
/// edges": a ray from (0, 0, 10) meets a quad at (3.375, 3.375, 0), on its diagonal.
#[test]
fn oblikovati_issue_2146_a_ray_through_the_diagonal_hits() {
    let corners = [[-5.0, -5.0, 0.0], [5.0, -5.0, 0.0], [5.0, 5.0, 0.0], [-5.0, 5.0, 0.0]];
    let scene = quad(&corners, vec![[0, 1, 2], [0, 2, 3]]);
    let description = CameraDescription {
        eye: Vec3::new(0.0, 0.0, 10.0),
        distance: 10.0,
        viewport: [8.0, 8.0],
        image: [32, 32],
        ..CameraDescription::default()
    };
    for projection in PROJECTIONS {
        let camera = Camera::new(CameraDescription { projection, ..description }).unwrap();
        let view = View::new(&scene, &camera);
        let ray = camera.viewing_ray(2, 29);
        let through = match projection {
            Projection::Perspective => ray.direction,
            Projection::Parallel => ray.origin,
        };
        assert_eq!([through.x, through.y], [3.375, 3.375]);
        let frame = all_agree(&view, &Options::default(), "Oblikovati 2146");
        // Every pixel of the diagonal belongs to the half on its right, which is the lower one.
        for k in 0..32 {
            assert_eq!(frame.id(31 - k, k), Some(0), "{projection:?}, pixel ({}, {k})", 31 - k);
        }
        for (name, counts) in owners(&view, &Options::default()) {
            assert!(counts.iter().all(|&count| count == 1), "{name}");
        }
    }
}
