//! The fast ray tracer through a telescope, compared with the other order: the textbook would take minutes.

use bothways::common::glam::Vec3;
use bothways::common::{Camera, CameraDescription, Mesh, Options, Orientation, View};
use bothways::raytrace::fast;
use bothways_test_support::{Dice, PROJECTIONS, assert_same_visibility, mesh, scene};

#[test]
fn triangles_between_samples_seen_through_a_telescope() {
    // Samples lie so close together that the culling of triangles in single precision is right only with its error
    // bound. Object order has no such culling.
    let mut hits = 0;
    for projection in PROJECTIONS {
        for (seed, size) in [3e-2_f32, 3e-3, 3e-4, 3e-5, 3e-6].into_iter().enumerate() {
            // At the smallest size, parallel distances differ so little that the judge would decide nearly all of them.
            let clutters: &[fn(&mut Dice, f32) -> Mesh] =
                if size > 1e-5 { &[dust, flakes] } else { &[dust] };
            for clutter in clutters {
                let mesh_seen = clutter(&mut Dice(seed as u64), size);
                let scene = scene(vec![mesh(mesh_seen)]);
                let description = CameraDescription {
                    projection,
                    eye: Vec3::new(0.6, 0.48, 0.64),
                    orientation: Orientation::LookAt { target: Vec3::ZERO, up: Vec3::Y },
                    viewport: [size; 2],
                    image: [128, 128],
                    ..CameraDescription::default()
                };
                let camera = Camera::new(description).expect("it is a camera");
                let (view, options) = (View::new(&scene, &camera), Options::default());
                let frame = fast::render(&fast::prepare(&scene), &view, &options);
                let prepared = bothways::rasterize::fast::prepare(&scene);
                let expected = bothways::rasterize::fast::render(&prepared, &view, &options);
                assert_same_visibility(&expected, &frame, &format!("{projection:?}, {size}"));
                hits += frame.ids().covered();
            }
        }
    }
    assert!(hits > 4000, "{hits}");
}

/// Separate triangles, smaller than the distance between two of 128 samples in a row of length `size`.
fn dust(dice: &mut Dice, size: f32) -> Mesh {
    let sample = size / 128.0;
    let corners = (0..8000).flat_map(|_| {
        let middle = 0.5 * size * dice.point();
        [(); 3].map(|()| middle + 0.4 * sample * dice.point())
    });
    let triangles = (0..8000).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
    Mesh::new(corners.collect(), triangles.collect()).expect("it is a mesh")
}

/// Crumpled sheets of sixteen such triangles, which share their vertices.
fn flakes(dice: &mut Dice, size: f32) -> Mesh {
    let sample = size / 128.0;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for first in (0..1000).map(|k| 15 * k) {
        let (middle, [along, beside]) = (0.5 * size * dice.point(), [dice.point(), dice.point()]);
        vertices.extend((0..15).map(|k| {
            let (row, column) = ((k / 5) as f32, (k % 5) as f32);
            let crumpled = row * along + column * beside + 0.5 * dice.point();
            middle + 0.3 * sample * crumpled
        }));
        for corner in (0..2).flat_map(|row| (0..4).map(move |column| first + 5 * row + column)) {
            triangles.push([corner, corner + 1, corner + 6]);
            triangles.push([corner, corner + 6, corner + 5]);
        }
    }
    Mesh::new(vertices, triangles).expect("it is a mesh")
}
