//! The pixels around one: what is seen at each, and the triangles that lie there.

use crate::common::{Crop, Frame, Options, Primitive, View};
use crate::figure::Projector;
use crate::rasterize;
use std::collections::HashSet;

/// The most triangles that are named.
const MOST_TRIANGLES: usize = 400;

/// The pixels around one, within the image.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighbourhood {
    /// The pixels.
    pub pixels: Crop,
    /// The primitive that is seen at each of them, row by row; `None` for nothing.
    pub seen: Vec<Option<u64>>,
    /// Triangles that lie among them, in scene order: those that are seen first of all, if there are too many.
    pub triangles: Vec<Outline>,
    /// The number of further triangles.
    pub omitted: usize,
}

/// A triangle as a camera sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The id of the triangle.
    pub id: u64,
    /// The corners, column and row in pixels from the top left of the image: three of them, or other ones where the part
    /// behind the eye is cut away. They are rounded: good for drawing, and never asked what covers what.
    pub corners: Vec<[f64; 2]>,
}

/// Finds what is within `radius` pixels of pixel `(i, j)`, in rows and columns; `prepared` is of the view's scene.
///
/// # Panics
///
/// If the image has no such pixel.
///
/// ```
/// use bothways_lab::common::{Camera, View};
///
/// let loaded = bothways_lab::scenes::load("ties")?;
/// let camera = Camera::new(loaded.camera)?;
/// let prepared = bothways_lab::rasterize::fast::prepare(&loaded.scene);
/// let view = View::new(&loaded.scene, &camera);
/// let near = bothways_lab::pixel::neighbourhood(&prepared, &view, 0, 5, 2);
/// assert_eq!(near.pixels.to_array(), [0, 3, 3, 5]);
/// assert_eq!(near.seen.len(), 15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn neighbourhood(
    prepared: &rasterize::fast::Prepared,
    view: &View,
    i: u32,
    j: u32,
    radius: u32,
) -> Neighbourhood {
    let [width, height] = view.camera.image();
    assert!(i < height && j < width, "there is no pixel ({i}, {j})");
    let (row, column) = (i.saturating_sub(radius), j.saturating_sub(radius));
    let last = |index: u32, side: u32| index.saturating_add(radius).min(side - 1) + 1;
    let pixels =
        Crop { row, column, height: last(i, height) - row, width: last(j, width) - column };
    let seen = seen(prepared, view, pixels);
    let (triangles, omitted) = triangles(view, pixels, &seen);
    Neighbourhood { pixels, seen, triangles, omitted }
}

/// What object order sees there.
fn seen(prepared: &rasterize::fast::Prepared, view: &View, pixels: Crop) -> Vec<Option<u64>> {
    let options = Options { crop: Some(pixels), ..Options::default() };
    let mut frame = Frame::new(view.camera, &options);
    rasterize::fast::determine_visibility(prepared, view, &options, &mut frame, &mut ());
    frame.ids().iter().collect()
}

/// The triangles whose bounding boxes meet the pixels.
fn triangles(view: &View, pixels: Crop, seen: &[Option<u64>]) -> (Vec<Outline>, usize) {
    let [row, column, height, width] = pixels.to_array().map(f64::from);
    let meets = |corners: &[[f64; 2]], axis: usize, from: f64, to: f64| {
        let least = corners.iter().map(|corner| corner[axis]).fold(f64::INFINITY, f64::min);
        let most = corners.iter().map(|corner| corner[axis]).fold(f64::NEG_INFINITY, f64::max);
        least <= to && most >= from
    };
    let projector = Projector { camera: view.camera };
    let mut found: Vec<Outline> = view
        .primitives()
        .filter_map(|(id, primitive)| match primitive {
            Primitive::Triangle(corners) => {
                Some(Outline { id, corners: projector.polygon(&corners) })
            }
            Primitive::Sphere { .. } | Primitive::Plane { .. } => None,
        })
        .filter(|Outline { corners, .. }| {
            meets(corners, 0, column, column + width) && meets(corners, 1, row, row + height)
        })
        .collect();
    let omitted = found.len().saturating_sub(MOST_TRIANGLES);
    if omitted > 0 {
        let seen: HashSet<u64> = seen.iter().flatten().copied().collect();
        found.sort_by_key(|one| !seen.contains(&one.id));
        found.truncate(MOST_TRIANGLES);
        found.sort_by_key(|one| one.id);
    }
    (found, omitted)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::Camera;
    use crate::scenes;

    #[test]
    fn a_seen_triangle_lies_around_its_pixel() {
        for name in ["lecture", "behind", "parallel"] {
            let loaded = scenes::load(name).unwrap();
            let camera = Camera::new(loaded.camera).unwrap();
            let view = View::new(&loaded.scene, &camera);
            let prepared = rasterize::fast::prepare(view.scene);
            let [width, height] = camera.image();
            for (i, j) in [(0, 0), (height / 2, width / 2), (height / 2, width / 3)] {
                let near = neighbourhood(&prepared, &view, i, j, 1);
                for id in near.seen.iter().flatten() {
                    let is_triangle = view.scene.triangle(*id).is_some();
                    let is_listed = near.triangles.iter().any(|triangle| triangle.id == *id);
                    assert_eq!(is_triangle, is_listed, "{name} ({i}, {j}) {id}");
                }
            }
        }
    }
}
