//! `outside`: the camera in the world, and the endless planes, for a view from outside. `rays`: viewing rays and what they hit.

use crate::answer::{Answer, short};
use crate::camera::{Pixel, Viewpoint};
use crate::stage::Stage;
use bothways_lab::common::glam::{DVec3, Vec3};
use bothways_lab::common::look::color::srgb_from_linear;
use bothways_lab::common::{Camera, Frame, Options, Plane, Projection, Scene, Shape, View};
use bothways_lab::raytrace;
use bothways_lab::wording::plain;
use serde::Deserialize;
use serde_json::{Value, json};

#[derive(Debug, Deserialize)]
pub(crate) struct Outside {
    #[serde(flatten)]
    pub(crate) from: Viewpoint,
}

/// Which rays: of one pixel, of a row, of a column, or of at most so many rows and columns of the whole image.
#[derive(Debug, Deserialize)]
pub(crate) struct Rays {
    #[serde(flatten)]
    pub(crate) from: Viewpoint,
    #[serde(default)]
    row: Option<u32>,
    #[serde(default)]
    column: Option<u32>,
    /// The most rays of a row or a column.
    #[serde(default)]
    most: Option<u32>,
    #[serde(default)]
    all: Option<u32>,
}

/// The most rays of a row or a column, and the most rows and columns of a whole image.
const MOST_RAYS: u32 = 1024;
const MOST_ROWS: u32 = 64;

pub(crate) fn answer(stage: &Stage, outside: &Outside) -> Result<Answer, String> {
    let camera = outside.from.camera(&stage.loaded.camera)?;
    Ok(of_scene(&stage.loaded.scene, &camera))
}

/// A camera and the planes of a scene, from outside.
pub(crate) fn of_scene(scene: &Scene, camera: &Camera) -> Answer {
    let planes = scene.objects().iter().filter_map(|object| match &object.shape {
        Shape::Plane(Plane { point, normal }) => Some(json!({
            "point": shortened(*point), "normal": shortened(*normal), "colour": color(object.material.color),
        })),
        _ => None,
    });
    let [u, v, w] = [camera.u(), camera.v(), camera.w()].map(plain);
    Answer::new(json!({
        "eye": shortened(camera.eye() + Vec3::ZERO),
        "u": u, "v": v, "w": w,
        "d": short(camera.description().distance),
        "vw": short(camera.description().viewport[0]),
        "vh": short(camera.description().viewport[1]),
        "projection": match camera.projection() {
            Projection::Perspective => "perspective",
            Projection::Parallel => "parallel",
        },
        "corners": corners(camera).map(plain),
        "planes": planes.collect::<Vec<Value>>(),
    }))
}

/// The corners of the viewport in the world: top left, top right, bottom right, bottom left. That of a parallel camera is
/// drawn at the distance, too, though no ray depends on it.
fn corners(camera: &Camera) -> [DVec3; 4] {
    let [vw, vh] = camera.viewport();
    [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[x, y]| {
        let across = 0.5 * x * vw * camera.u() + 0.5 * y * vh * camera.v();
        camera.eye().as_dvec3() + across - camera.distance() * camera.w()
    })
}

/// The coordinates with few digits.
fn shortened(vector: Vec3) -> [f64; 3] {
    vector.to_array().map(short)
}

/// sRGB bytes.
fn color(linear: Vec3) -> [u8; 3] {
    linear.to_array().map(srgb_from_linear)
}

pub(crate) fn rays(stage: &Stage, rays: &Rays) -> Result<Answer, String> {
    let camera = rays.from.camera(&stage.loaded.camera)?;
    let view = View::new(&stage.loaded.scene, &camera);
    of_rays(&view, &rays.pixels(&camera)?, || {
        let (options, mut frame) = (Options::default(), Frame::new(&camera, &Options::default()));
        raytrace::fast::determine_visibility(
            &stage.ray_tracer,
            &view,
            &options,
            &mut frame,
            &mut (),
        );
        frame
    })
}

/// The rays of pixels of a view, and what image order sees there.
pub(crate) fn of_rays(
    view: &View,
    pixels: &[[u32; 2]],
    draw: impl FnOnce() -> Frame,
) -> Result<Answer, String> {
    let (frame, judge, eye) = (draw(), view.judge(), view.camera.eye().as_dvec3());
    let each = pixels.iter().map(|&[row, column]| {
        let ray = view.camera.viewing_ray(row, column);
        let id = frame.id(row as usize, column as usize);
        let t = id.map(|id| judge.distance(&view.primitive(id), &ray));
        let point = t.map(|t| plain(eye + ray.origin + t * ray.direction));
        let kind = id.map(|id| view.primitive(id).kind());
        json!({
            "row": row, "column": column,
            "origin": plain(eye + ray.origin), "direction": plain(ray.direction),
            "id": id, "kind": kind, "t": t, "point": point,
        })
    });
    Ok(Answer::new(json!({ "rays": each.collect::<Vec<Value>>() })))
}

impl Rays {
    /// The pixels whose rays are asked for.
    pub(crate) fn pixels(&self, camera: &Camera) -> Result<Vec<[u32; 2]>, String> {
        let [width, height] = camera.image();
        let check = |row, column| Pixel { row, column }.check(camera);
        let most = self.most.unwrap_or(MOST_RAYS).clamp(1, MOST_RAYS);
        let pixels = match (self.row, self.column, self.all) {
            (Some(row), Some(column), _) => {
                check(row, column)?;
                vec![[row, column]]
            }
            (Some(row), None, _) => {
                check(row, 0)?;
                spread(width, most).into_iter().map(|column| [row, column]).collect()
            }
            (None, Some(column), _) => {
                check(0, column)?;
                spread(height, most).into_iter().map(|row| [row, column]).collect()
            }
            (None, None, Some(all)) => {
                let most = all.clamp(1, MOST_ROWS);
                let columns = spread(width, most);
                let rows = spread(height, most).into_iter();
                rows.flat_map(|row| columns.iter().map(move |&column| [row, column])).collect()
            }
            (None, None, None) => {
                return Err("no ray is asked for: give a row, a column or both, or all".into());
            }
        };
        Ok(pixels)
    }
}

/// At most so many of the indices of a side, evenly spread.
fn spread(side: u32, most: u32) -> Vec<u32> {
    let count = side.min(most);
    // The middles of equal parts of the side.
    let at = |part: u32| (2 * u64::from(part) + 1) * u64::from(side) / (2 * u64::from(count));
    (0..count).filter_map(|part| u32::try_from(at(part)).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::spread;

    #[test]
    fn rays_are_spread_evenly() {
        assert_eq!(spread(4, 10), [0, 1, 2, 3]);
        assert_eq!(spread(100, 4), [12, 37, 62, 87]);
        assert_eq!(spread(u32::MAX, 1), [u32::MAX / 2]);
    }
}
