//! Smaller pictures, and simpler cameras.

use super::shrinker::Shrinker;
use crate::common::camera::Orientation;
use crate::common::glam::{DVec3, Vec3};
use crate::common::{Camera, Crop, Mesh, Plane, Projection, Shape, Sphere, Triangle};
use crate::fuzz::case::Case;

/// Draws the differing pixel alone, if that shows the disagreement, too: what follows is tried on few samples.
pub(super) fn crop(shrinker: &mut Shrinker) {
    let Some([row, column]) = shrinker.disagreement.pixel() else { return };
    let crop = Crop { row, column, height: 1, width: 1 };
    shrinker.try_change(|case| Some(Case { crop: Some(crop), ..case.clone() }));
}

/// One sample a pixel, a simple frame, and a picture of as few pixels as possible; without a crop, if possible.
pub(super) fn shrink(shrinker: &mut Shrinker) {
    shrinker.try_change(one_sample);
    shrinker.try_change(without_frame);
    if let Some([row, column]) = shrinker.disagreement.pixel() {
        let pixel = Crop { row, column, height: 1, width: 1 };
        shrinker.try_change(|case| window(case, pixel));
    }
    cut(shrinker);
    // A small picture that is not cropped is simpler than a part of one.
    shrinker.try_change(|case| Some(Case { crop: None, ..case.clone() }));
    cut(shrinker);
}

/// Cuts rows and columns off: as many as possible at once.
fn cut(shrinker: &mut Shrinker) {
    for side in 0..4 {
        let length = |shrinker: &Shrinker| {
            let [width, height] = shrinker.case.camera.image;
            if side < 2 { height } else { width }
        };
        let mut count = length(shrinker) - 1;
        while count > 0 {
            let fits = count < length(shrinker);
            if !(fits && shrinker.try_change(|case| window(case, without(case, side, count)))) {
                count /= 2;
            }
        }
    }
    // Both borders at once: what is left keeps its place on the viewport, and so every bit.
    let mut count = shrinker.case.camera.image.map(|side| side / 2);
    while count != [0, 0] {
        let helped = (0..2).any(|axis| {
            let [width, height] = shrinker.case.camera.image;
            let [mut column, mut row] = [0, 0];
            *[&mut column, &mut row][axis] = count[axis];
            let fits = 2 * column < width && 2 * row < height && count[axis] > 0;
            let middle =
                || Crop { row, column, height: height - 2 * row, width: width - 2 * column };
            fits && shrinker.try_change(|case| window(case, middle()))
        });
        if !helped {
            count = count.map(|count| count / 2);
        }
    }
}

/// The image without some rows or columns: at the top, the bottom, the left or the right.
fn without(case: &Case, side: usize, count: u32) -> Crop {
    let [width, height] = case.camera.image;
    match side {
        0 => Crop { row: count, column: 0, height: height - count, width },
        1 => Crop { row: 0, column: 0, height: height - count, width },
        2 => Crop { row: 0, column: count, height, width: width - count },
        _ => Crop { row: 0, column: 0, height, width: width - count },
    }
}

/// The case with a pixel for every sample: the samples stay where they are.
fn one_sample(case: &Case) -> Option<Case> {
    let by = case.samples;
    let crop = case.crop.map(|crop| Crop {
        row: crop.row * by,
        column: crop.column * by,
        height: crop.height * by,
        width: crop.width * by,
    });
    let mut finer = Case { samples: 1, crop, ..case.clone() };
    finer.camera.image = finer.camera.image.map(|side| side * by);
    Some(finer)
}

/// The case with a window of its image as the whole image. The samples see what they saw, up to rounding: the eye of a parallel
/// camera moves, and before a perspective camera the scene is sheared.
fn window(case: &Case, window: Crop) -> Option<Case> {
    let (_, camera) = case.accepted()?;
    let [width, height] = case.camera.image;
    let whole = Crop::whole(case.camera.image);
    if window == whole || case.crop.is_some_and(|crop| !holds(&window, &crop)) {
        return None;
    }
    let [vw, vh] = camera.viewport();
    // The middle of the window on the viewport.
    let middle = |first: u32, count: u32, of: u32, extent: f64| {
        extent * (f64::from(2 * first + count) - f64::from(of)) / (2.0 * f64::from(of))
    };
    let x = middle(window.column, window.width, width, vw);
    let y = -middle(window.row, window.height, height, vh);
    let across = x * camera.u() + y * camera.v();
    let (eye, w) = (camera.eye().as_dvec3(), camera.w());
    let mut smaller = Case { crop: None, ..case.clone() };
    smaller.camera.image = [window.width, window.height];
    let part =
        |extent: f64, count: u32, of: u32| stored_number(extent * f64::from(count) / f64::from(of));
    smaller.camera.viewport = [part(vw, window.width, width), part(vh, window.height, height)];
    if across != DVec3::ZERO {
        match camera.projection() {
            Projection::Parallel => smaller.camera.eye = stored(eye + across),
            Projection::Perspective => {
                let shear = across / camera.distance();
                let depth = |p: DVec3| (eye - p).dot(w);
                // The shear's inverse, transposed, takes normals.
                let turned = |n: DVec3| n - w * shear.dot(n);
                smaller = moved(&smaller, |p| p - depth(p) * shear, turned)?;
            }
        }
    }
    if let Some(crop) = case.crop {
        let (row, column) = (crop.row - window.row, crop.column - window.column);
        let crop = Crop { row, column, ..crop };
        let is_whole = crop == Crop::whole(smaller.camera.image);
        smaller.crop = (!is_whole).then_some(crop);
    }
    Some(smaller)
}

fn holds(outer: &Crop, inner: &Crop) -> bool {
    let within = |first: u32, count: u32, outer_first: u32, outer_count: u32| {
        first >= outer_first && first + count <= outer_first + outer_count
    };
    within(inner.row, inner.height, outer.row, outer.height)
        && within(inner.column, inner.width, outer.column, outer.width)
}

/// The case seen from the origin along −z: the scene turns in the place of the camera.
fn without_frame(case: &Case) -> Option<Case> {
    let camera = Camera::new(case.camera).ok()?;
    let (eye, axes) = (camera.eye().as_dvec3(), [camera.u(), camera.v(), camera.w()]);
    let turned = |v: DVec3| DVec3::from_array(axes.map(|axis| axis.dot(v)));
    let mut straight = moved(case, |p| turned(p - eye), turned)?;
    straight.camera.eye = Vec3::ZERO;
    straight.camera.orientation = Orientation::Frame { u: Vec3::X, v: Vec3::Y, w: Vec3::Z };
    Some(straight)
}

/// The case with its points and normals mapped; spheres keep their radius.
fn moved(
    case: &Case,
    point: impl Fn(DVec3) -> DVec3,
    normal: impl Fn(DVec3) -> DVec3,
) -> Option<Case> {
    let point = |p: Vec3| stored(point(p.as_dvec3()));
    let normal = |n: Vec3| stored(normal(n.as_dvec3()));
    let shapes = case.shapes.iter().map(|shape| {
        Some(match shape {
            Shape::Triangle(Triangle { a, b, c }) => {
                Shape::Triangle(Triangle { a: point(*a), b: point(*b), c: point(*c) })
            }
            Shape::Sphere(Sphere { center, radius }) => {
                Shape::Sphere(Sphere { center: point(*center), radius: *radius })
            }
            Shape::Plane(plane) => {
                Shape::Plane(Plane { point: point(plane.point), normal: normal(plane.normal) })
            }
            Shape::Mesh(mesh) => {
                let positions = mesh.positions().iter().map(|p| point(*p)).collect();
                Shape::Mesh(Mesh::new(positions, mesh.triangles().to_vec()).ok()?)
            }
            // Vertices that are moved afterwards would not be those of moved instances.
            Shape::Instances(_) => return None,
        })
    });
    Some(Case { shapes: shapes.collect::<Option<Vec<Shape>>>()?, ..case.clone() })
}

#[expect(clippy::cast_possible_truncation, reason = "scenes are stored as f32")]
fn stored_number(number: f64) -> f32 {
    number as f32
}

fn stored(point: DVec3) -> Vec3 {
    Vec3::from_array(point.to_array().map(stored_number))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{CameraDescription, Options, View};
    use crate::rasterize::textbook;

    #[test]
    fn a_window_shows_what_the_image_showed_there() {
        let (a, b, c) =
            ([-3.0, -2.0, -4.0].into(), [2.5, -1.0, -2.0].into(), [0.5, 3.0, -4.0].into());
        let shapes = vec![Shape::Triangle(Triangle { a, b, c })];
        for projection in [Projection::Perspective, Projection::Parallel] {
            let camera = CameraDescription {
                projection,
                viewport: [4.0, 4.0],
                image: [16, 16],
                ..CameraDescription::default()
            };
            let case = Case { shapes: shapes.clone(), camera, samples: 1, crop: None };
            let part = Crop { row: 3, column: 6, height: 4, width: 9 };
            let seen = |case: &Case, crop| {
                let (scene, camera) = case.accepted().unwrap();
                let options = Options { samples: 1, crop };
                let frame = textbook::render(&View::new(&scene, &camera), &options);
                frame.ids().iter().collect::<Vec<_>>()
            };
            let small = window(&case, part).unwrap();
            assert_eq!(small.camera.image, [9, 4]);
            assert_eq!(seen(&small, None), seen(&case, Some(part)), "{projection:?}");
            assert!(seen(&small, None).contains(&Some(0)) && seen(&small, None).contains(&None));
        }
    }
}
