//! The built-in scenes agree with their descriptions.

use bothways::common::glam::{DVec3, Vec3};
use bothways::common::{
    Camera, CameraDescription, Options, Orientation, Primitive, Projection, Ray, View,
};
use bothways::rasterize::fast;
use bothways::raytrace::textbook;
use bothways::scenes::{LoadOptions, LoadedScene, load, load_with};
use std::collections::HashSet;

/// The scene's camera with another image, and the parallel camera that shows the target at the same size.
fn cameras(loaded: &LoadedScene, image: [u32; 2]) -> [Camera; 2] {
    let perspective = CameraDescription { image, ..loaded.camera };
    let Orientation::LookAt { target, .. } = loaded.camera.orientation else {
        panic!("{} has no target", loaded.name)
    };
    let enlarged = (loaded.camera.eye - target).length() / loaded.camera.distance;
    let parallel = CameraDescription {
        projection: Projection::Parallel,
        viewport: perspective.viewport.map(|side| side * enlarged),
        ..perspective
    };
    [perspective, parallel].map(|description| Camera::new(description).expect("it is usable"))
}

/// Whether a ray meets the triangle's border exactly. This test is right where the numbers have so few bits that
/// nothing is rounded.
fn meets_border(primitive: &Primitive, ray: &Ray) -> bool {
    let Primitive::Triangle([a, b, c]) = *primitive else { return false };
    let edge = |p: DVec3, q: DVec3| (p - ray.origin).cross(q - ray.origin).dot(ray.direction);
    let edges = [edge(a, b), edge(b, c), edge(c, a)];
    let one_sided = edges.iter().all(|&e| e >= 0.0) || edges.iter().all(|&e| e <= 0.0);
    one_sided && edges.contains(&0.0) && edges.iter().any(|&e| e != 0.0)
}

#[test]
fn a_third_of_the_samples_of_ties_lie_on_edges_whatever_the_power_of_two() {
    let loaded = load("ties").unwrap();
    assert_eq!(loaded.camera.image, [64, 64]);
    for side in [64, 32, 16, 8, 4, 2, 1] {
        for camera in cameras(&loaded, [side, side]) {
            let view = View::new(&loaded.scene, &camera);
            let on_border = |i, j| {
                let ray = camera.viewing_ray(i, j);
                view.primitives().any(|(_, primitive)| meets_border(&primitive, &ray))
            };
            let pixels = (0..side).flat_map(|i| (0..side).map(move |j| (i, j)));
            let ties = pixels.filter(|&(i, j)| on_border(i, j)).count();
            let samples = (side * side) as usize;
            assert!(3 * ties >= samples, "{ties} of {samples}, {:?}", camera.projection());
        }
    }
}

#[test]
fn no_projection_hides_what_a_scene_is_about() {
    // Of `behind`: the floor, the road, the banner, a wall and both balls.
    for (name, least) in [("canonical", 3), ("behind", 6), ("overlap", 8), ("inside", 4)] {
        let loaded = load(name).unwrap();
        let image = [40, 30];
        let cameras = match loaded.camera.orientation {
            Orientation::LookAt { .. } => cameras(&loaded, image),
            // As the command line does: objects in the middle of the scene keep their size.
            _ => [(Projection::Perspective, 1.0), (Projection::Parallel, 4.0)].map(
                |(projection, side)| {
                    let viewport = [side; 2];
                    Camera::new(CameraDescription { projection, viewport, image, ..loaded.camera })
                        .unwrap()
                },
            ),
        };
        for camera in cameras {
            let frame = textbook::render(&View::new(&loaded.scene, &camera), &Options::default());
            let pixels = (0..30).flat_map(|row| (0..40).map(move |column| (row, column)));
            let ids = pixels.filter_map(|(row, column)| frame.id(row, column));
            let seen: HashSet<usize> = ids.map(|id| loaded.scene.locate(id).0).collect();
            assert!(seen.len() >= least, "{name}, {:?}: {seen:?}", camera.projection());
        }
    }
}

#[test]
fn inside_covers_every_pixel() {
    let loaded = load("inside").unwrap();
    for camera in cameras(&loaded, [24, 18]) {
        let view = View::new(&loaded.scene, &camera);
        let frame = textbook::render(&view, &Options::default());
        assert!((0..18).all(|row| (0..24).all(|column| frame.id(row, column).is_some())));
    }
}

#[test]
fn the_fan_of_slivers_leaves_no_gap() {
    let loaded = load("slivers").unwrap();
    let [perspective, _] = cameras(&loaded, [64, 48]);
    let view = View::new(&loaded.scene, &perspective);
    let frame = textbook::render(&view, &Options::default());
    // The cone's rim is 10.5 pixels from the middle.
    let from_middle = |row: f64, column: f64| (row - 23.5).hypot(column - 31.5);
    let (mut in_fan, mut thinnest) = (0, f64::INFINITY);
    for (row, column) in (0_u8..48).flat_map(|row| (0_u8..64).map(move |column| (row, column))) {
        if from_middle(row.into(), column.into()) < 10.0 {
            let id = frame.id(row.into(), column.into());
            let object = id.map(|id| loaded.scene.locate(id).0);
            assert_eq!(object, Some(0), "a gap at {row}, {column}");
            in_fan += 1;
        }
    }
    assert_eq!(in_fan, 316);
    for (_, primitive) in view.primitives().filter(|&(id, _)| loaded.scene.locate(id).0 > 0) {
        let Primitive::Triangle([_, b, c]) = primitive else { continue };
        // The picture of full size has 480 rows; a pixel is 5.6 / 480 high at the needle's distance.
        thinnest = thinnest.min((b - c).length() / (5.6 / 480.0));
    }
    assert!(thinnest < 0.005, "{thinnest} pixels");
}

#[test]
fn the_magenta_objects_are_hidden() {
    // In these scenes, the objects that no renderer may show are magenta.
    let is_hidden = |color: Vec3| color == Vec3::new(1.0, 0.0, 1.0);
    for name in ["behind", "overlap"] {
        let loaded = load(name).unwrap();
        assert!(loaded.scene.objects().iter().any(|object| is_hidden(object.material.color)));
        for camera in cameras(&loaded, [40, 30]) {
            let view = View::new(&loaded.scene, &camera);
            let frame = textbook::render(&view, &Options::default());
            for (row, column) in (0..30).flat_map(|row| (0..40).map(move |column| (row, column))) {
                let Some(id) = frame.id(row, column) else { continue };
                let (object, _) = loaded.scene.locate(id);
                let color = loaded.scene.objects()[object].material.color;
                assert!(!is_hidden(color), "{name}: object {object} at {row}, {column}");
            }
        }
    }
}

#[test]
fn the_shared_meshes_are_framed() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/meshes");
    let Ok(files) = std::fs::read_dir(folder) else {
        println!("skipped: there is no folder {folder}");
        return;
    };
    let paths = files.map(|file| file.expect("the folder can be listed").path());
    for path in paths.filter(|path| path.extension().is_some_and(|extension| extension == "obj")) {
        for image in [[64, 48], [30, 70], [90, 30]] {
            let loaded = load_with(
                path.to_str().unwrap(),
                LoadOptions { image: Some(image), ..LoadOptions::default() },
            );
            let loaded = loaded.unwrap_or_else(|error| panic!("{error}"));
            for camera in cameras(&loaded, image) {
                let view = View::new(&loaded.scene, &camera);
                let prepared = fast::prepare(&loaded.scene);
                let frame = fast::render(&prepared, &view, &Options::default());
                let [width, height] = image.map(|side| side as usize);
                let row_is_seen = |row| (0..width).any(|column| frame.id(row, column).is_some());
                let column_is_seen =
                    |column| (0..height).any(|row| frame.id(row, column).is_some());
                let rows = (0..height).filter(|&row| row_is_seen(row)).count();
                let columns = (0..width).filter(|&column| column_is_seen(column)).count();
                let what = format!("{}, {image:?}, {:?}", path.display(), camera.projection());
                let border_is_seen = [0, width - 1].into_iter().any(column_is_seen)
                    || [0, height - 1].into_iter().any(row_is_seen);
                // The margin of a parallel picture may be less than half a pixel.
                assert!(camera.projection() == Projection::Parallel || !border_is_seen, "{what}");
                assert!(10 * rows >= 7 * height || 10 * columns >= 7 * width, "{what}");
            }
        }
    }
}
