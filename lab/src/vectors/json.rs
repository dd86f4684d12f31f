//! The JSON of the set: one file for each scene, and the index of all scenes.
//!
//! Every number of a scene is an exact `f64`: a program that reads the number as a double gets exactly the same
//! number. The visible `t` are rounded to `f32`, and written with the fewest digits that read back as the same `f32`.

use super::raster;
use super::vector::{ENDINGS, Vector};
use crate::common::{Camera, Frame, Projection, View};
use crate::opengl;
use serde::Serialize;

/// A scene as the index lists it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// The scene's name. The names of the scene's files begin with this name.
    pub name: &'static str,
    /// The kind of difficulty.
    pub group: &'static str,
    /// The point of the scene, in one sentence.
    pub point: &'static str,
    /// Width and height in pixels.
    pub image: [u32; 2],
    /// The number of triangles.
    pub triangles: u64,
    /// Whether the scene's corners have exact raster coordinates.
    pub raster: bool,
    /// The number of covered samples.
    pub covered: u64,
    /// The files of the scene.
    pub files: Vec<String>,
}

impl Entry {
    /// The index entry of a scene with this expected frame.
    pub fn new(vector: &Vector, frame: &Frame) -> Entry {
        let (scene, camera) = (vector.scene(), vector.camera());
        let seen = frame.ids().covered();
        Entry {
            name: vector.name,
            group: vector.group.name(),
            point: vector.point,
            image: frame.image(),
            triangles: scene.primitive_count(),
            raster: raster::triangles(&View::new(&scene, &camera)).is_some(),
            covered: seen as u64,
            files: ENDINGS.map(|ending| format!("{}{ending}", vector.name)).to_vec(),
        }
    }
}

/// `index.json`: all scenes in order.
///
/// # Errors
///
/// The errors of `serde_json`. These types cause none.
pub fn index(entries: &[Entry]) -> serde_json::Result<String> {
    Ok(Fields::default()
        .one("set", "bothways")?
        .one("version", env!("CARGO_PKG_VERSION"))?
        .lines("scenes", entries)?
        .finish())
}

/// `NAME.json`: the scene, its raster coordinates, its matrices, and the visible surface at each sample.
///
/// # Errors
///
/// The errors of [`index`].
pub fn json(vector: &Vector, frame: &Frame) -> serde_json::Result<String> {
    let (scene, camera) = (vector.scene(), vector.camera());
    let raster = raster::triangles(&View::new(&scene, &camera));
    let positions: Vec<[f64; 3]> =
        vector.mesh.positions().iter().map(|position| position.as_dvec3().to_array()).collect();
    let [near, far] = depth_range(&camera, frame);
    let matrices = opengl::between(&camera, near, far);
    let (view, projection) = (matrices.view.map(plain), matrices.projection.map(plain));
    let (perspective, interpolate) = match camera.projection() {
        Projection::Perspective => ("perspective", "1/t"),
        Projection::Parallel => ("parallel", "t"),
    };
    let fields = Fields::default()
        .one("name", vector.name)?
        .one("group", vector.group.name())?
        .one("point", vector.point)?
        .one("image", &camera.image())?
        .one("projection", perspective)?
        .one("eye", &camera.eye().as_dvec3().to_array())?
        .one("u", &camera.u().to_array())?
        .one("v", &camera.v().to_array())?
        .one("w", &camera.w().to_array())?
        .one("distance", &camera.distance())?
        .one("viewport", &camera.viewport())?
        .lines("vertices", &positions)?
        .lines("triangles", vector.mesh.triangles())?
        .one("interpolate", interpolate)?;
    let fields = match raster {
        Some(corners) => fields.lines("raster", &corners)?,
        None => fields.one("raster", &None::<()>)?,
    };
    Ok(fields
        .one("opengl_layout", opengl::LAYOUT)?
        .lines("opengl_view", &view)?
        .lines("opengl_projection", &projection)?
        .lines("ids", &rows(frame, |row, column| frame.id(row, column)))?
        .lines("t", &rows(frame, |row, column| frame.t(row, column)))?
        .finish())
}

fn rows<T>(frame: &Frame, value: impl Fn(usize, usize) -> T) -> Vec<Vec<T>> {
    let row = |row| (0..frame.width()).map(|column| value(row, column)).collect();
    (0..frame.height()).map(row).collect()
}

/// Half of the least and twice the largest visible depth, so that the near and far planes cut nothing visible.
fn depth_range(camera: &Camera, frame: &Frame) -> [f64; 2] {
    let unit = match camera.projection() {
        Projection::Perspective => camera.distance(),
        Projection::Parallel => 1.0,
    };
    let seen = frame.distances().iter().filter(|t| t.is_finite()).map(|&t| unit * f64::from(t));
    let [least, most] =
        seen.fold([f64::INFINITY, 0.0], |[least, most], depth| [least.min(depth), most.max(depth)]);
    if most > 0.0 { [least / 2.0, most * 2.0] } else { [camera.distance(); 2] }
}

/// A row of a matrix, with 0 for −0.
fn plain(row: [f64; 4]) -> [f64; 4] {
    row.map(|number| number + 0.0)
}

/// A JSON object with one field per line; long lists have one element per line.
#[derive(Default)]
struct Fields(Vec<String>);

impl Fields {
    fn one(self, key: &str, value: &(impl Serialize + ?Sized)) -> serde_json::Result<Fields> {
        let value = serde_json::to_string(value)?;
        Ok(self.field(key, &value))
    }

    fn lines(self, key: &str, values: &[impl Serialize]) -> serde_json::Result<Fields> {
        let values = values.iter().map(serde_json::to_string).collect::<Result<Vec<_>, _>>()?;
        Ok(self.field(key, &format!("[\n    {}\n  ]", values.join(",\n    "))))
    }

    fn field(mut self, key: &str, value: &str) -> Fields {
        self.0.push(format!("  \"{key}\": {value}"));
        self
    }

    fn finish(self) -> String {
        format!("{{\n{}\n}}\n", self.0.join(",\n"))
    }
}
