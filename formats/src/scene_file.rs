//! Reads and writes scene files: a scene and its camera, in TOML.
//!
//! ```
//! use bothways_formats::scene_file;
//! use bothways_formats::source::Files;
//!
//! let text = r##"
//! [camera]
//! eye = [0, 1, 4]
//! look_at = [0, 0, 0]
//! background = "#101418"
//!
//! [material.clay]
//! color = "#c8553d"
//!
//! [[light]]
//! directional = [-1, -2, -1]
//!
//! [[object]]
//! sphere = { center = [0, 0, 0], radius = 1 }
//! material = "clay"
//!
//! [[object]]
//! generate = { kind = "torus", divisions = [64, 32] }
//! scale = 2
//! rotate = { axis = [0, 0, 1], degrees = 90 }
//! "##;
//! let file = scene_file::parse("example.toml", text, &Files::none())?;
//! assert_eq!(file.scene.objects().len(), 2);
//! # Ok::<(), scene_file::ReadSceneError>(())
//! ```
//!
//! # Tables
//!
//! The tables are `[camera]`, `[material.NAME]`, `[[light]]` and `[[object]]`. Only an object is needed. An unknown key is
//! an error, so that no typing error stays unnoticed. Numbers are read as the nearest `f32`, and must be finite. Paths of
//! files are relative to the scene file, and lead to its folder or below, unless [`Reach`](crate::source::Reach) allows more.
//!
//! ## `[camera]`
//!
//! | key | what it says | without it |
//! |---|---|---|
//! | `projection` | `"perspective"` or `"parallel"` | perspective |
//! | `eye` | the position of the eye | the origin |
//! | `look_at` or `direction` | the point or the direction in which it looks | −z |
//! | `up` | the direction that is up in the image | +y |
//! | `u`, `v`, `w` | instead of these: the axes of the camera frame, to the right, up and back | |
//! | `distance` | `d`, the distance from the eye to the viewport | 1 |
//! | `viewport` | `vw`, `vh`, the width and the height of the viewport | `[W/H, 1]` |
//! | `fov` | instead of `viewport`: the vertical field of view in degrees, which gives `vh` at `d` | |
//! | `image` | `W`, `H`, the width and the height of the image in pixels | 640 × 480 |
//! | `background` | the colour where there is no object | nearly black |
//!
//! ## `[material.NAME]`
//!
//! | key | what it says | without it |
//! |---|---|---|
//! | `color` | the diffuse colour, `"#rrggbb"` | light grey |
//! | `specular` | the strength of the highlight, from 0 to 1 | 0 |
//! | `shininess` | the exponent of the highlight | 32 |
//! | `checker = { color, divisions }` | a pattern: its second colour, and its cells to a unit of the texture coordinates | one colour |
//! | `texture = "tiles.png"` | a picture over the texture coordinates, in place of a `checker` | one colour |
//!
//! A texture is multiplied by `color`, which is then white without it. In place of the path, a table says more:
//!
//! | key of `texture` | what it says | without it |
//! |---|---|---|
//! | `file` | the path of a PNG, JPEG, BMP or PNM file | |
//! | `filter` | `"nearest"` texel, `"bilinear"` between four, or `"mipmaps"`: bilinear, and between smaller pictures where texels are smaller than samples | bilinear |
//! | `wrap` | beyond the picture: `"repeat"`, `"clamp"` to its border, or `"mirror"`; one for both directions, or `[across, up]` | repeat |
//! | `tiles` | pictures to one unit of the texture coordinates, across and up | `[1, 1]` |
//!
//! ## `[[light]]`
//!
//! Each has exactly one of `directional`, `point` and `ambient`. A file without lights is lit from the camera.
//!
//! | key | what it says |
//! |---|---|
//! | `directional` | light from infinitely far away: the direction in which it shines |
//! | `point` | light from a point: its position |
//! | `ambient = true` | light from everywhere |
//! | `intensity` | how strong it is; 1 without it |
//!
//! ## `[[object]]`
//!
//! Each has exactly one shape, and may have a material and a transformation.
//!
//! | key | what it says |
//! |---|---|
//! | `triangle = { a, b, c }` | a triangle: its corners |
//! | `sphere = { center, radius }` | a sphere |
//! | `plane = { point, normal }` | an infinite plane |
//! | `mesh = "bunny.obj"` | a mesh from an OBJ, glTF, PLY or STL file, with its own materials and colours |
//! | `generate = { kind, divisions }` | a generated mesh: see [`Kind`](crate::generate::Kind) |
//! | `material` | the name of a material, in place of the materials and colours of a mesh file; light grey without it |
//! | `scale`, `rotate = { axis, degrees }`, `translate` | the transformation, in this order |
//! | `instances` | of a mesh, read or generated: the places in which it is there, see below; one without it |
//!
//! A `scale` is one factor, or `[x, y, z]`, one for each axis; negative factors mirror.
//!
//! ## `instances`
//!
//! A mesh may be there many times, and takes memory once and 48 bytes for each time. The object's own transformation
//! comes first, then that of each instance. Ids count through the instances, in their order. A glTF file whose nodes share a
//! large mesh is several objects, some of them instances; with `instances` of its own it is copied into one mesh.
//!
//! | form | what it says |
//! |---|---|
//! | `instances = [[x, y, z], …]` | a list: where each is moved, |
//! | `[[m, m, m, x, m, m, m, y, m, m, m, z], …]` | or the rows of its 3 × 4 matrix, each number rounded to `f32`, |
//! | `[{ scale, rotate, translate }, …]` | or a transformation like that of an object |
//! | `instances = { grid = { count = [10, 1, 10], spacing = 2 } }` | on a grid about the origin, along x first, then y, then z; `spacing` may be `[x, y, z]` |
//! | `instances = { scatter = { count, size, seed, turn, scale } }` | anywhere in a box about the origin with sides `size = [x, y, z]`; turned by any angle about the axis `turn`; scaled by `scale = [least, most]`; other places for another `seed` |
//!
//! # Errors
//!
//! Every error in the text knows its line and its column, and often suggests a correction:
//!
//! ```
//! use bothways_formats::scene_file;
//! use bothways_formats::source::Files;
//!
//! let text = "[[object]]\nspere = { center = [0, 0, 0], radius = 1 }\n";
//! let error = scene_file::parse("example.toml", text, &Files::none()).unwrap_err();
//! let message = r#"example.toml:2:1: object has no key "spere"; did you mean "sphere"?"#;
//! assert_eq!(error.to_string(), message);
//! ```

mod camera;
mod color;
mod document;
mod error;
mod excerpt;
mod instances;
mod light;
mod material;
mod object;
mod suggestion;
mod transform;
mod write;

pub use error::{LocatedError, ReadSceneError};
pub use excerpt::Excerpt;
pub use suggestion::nearest_name;
pub use write::framed_mesh_toml;

use crate::source::{Files, InputFile};
use bothways_common::camera::CameraDescription;
use bothways_common::scene::{Scene, SceneError};
use document::{Item, Table};
use error::Problem;
use light::lights;
use material::{Materials, materials};
use toml::de::DeTable;

/// The content of a scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// The objects, lights and background.
    pub scene: Scene,
    /// The camera, which [`Camera::new`](bothways_common::Camera::new) accepts.
    pub camera: CameraDescription,
    /// Whether the file states the viewport. If so, another image size keeps both its sides.
    pub viewport_stated: bool,
    /// Messages about missing materials: see [`MaterialWarning`](crate::warning::MaterialWarning).
    pub warnings: Vec<String>,
}

/// Reads a scene file, and the files that it names.
///
/// # Errors
///
/// Those of [`read_text`] and of [`parse`].
pub fn read(file: &InputFile) -> Result<SceneFile, ReadSceneError> {
    parse(&file.name(), &read_text(file)?, file.files())
}

/// The most bytes of a scene file: some 140,000 objects. While a file is read, its tables take about 70 times as much
/// memory as their text, and up to 240 times if they are very short: less than 2 GiB in any case. The message of
/// [`ReadSceneError::TooLarge`] names this limit.
const MOST_BYTES: u64 = 8 << 20;

/// Reads the text of a scene file, without parsing it.
///
/// # Errors
///
/// The file does not exist, cannot be read, is a pipe or a device, is too large or is not UTF-8 text.
pub fn read_text(file: &InputFile) -> Result<String, ReadSceneError> {
    // One byte more than the limit shows that the file is too large, whatever length the system reports.
    let read = file.beginning(MOST_BYTES + 1);
    let file = file.name();
    let bytes = match read {
        Err(error) => return Err(ReadSceneError::Unreadable { file, error }),
        Ok(bytes) if bytes.len() as u64 > MOST_BYTES => {
            return Err(ReadSceneError::TooLarge { file });
        }
        Ok(bytes) => bytes.into_owned(),
    };
    String::from_utf8(bytes).map_err(|error| {
        let byte = error.utf8_error().valid_up_to();
        let before = &error.as_bytes()[..byte];
        let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
        ReadSceneError::NotText { file, line, byte }
    })
}

/// Reads a scene from a text that messages call `name`, and the files that it names.
///
/// # Errors
///
/// The first fault that is found, with its place in the text: see [`LocatedError`].
pub fn parse(name: &str, text: &str, files: &Files) -> Result<SceneFile, ReadSceneError> {
    let read = document(text, files);
    read.map_err(|problem| problem.in_text(name, text).into())
}

/// Reads `camera`, `material`, `light` and `object`.
fn document(text: &str, files: &Files) -> Result<SceneFile, Problem> {
    let document = DeTable::parse(text)?;
    let known = ["camera", "material", "light", "object"];
    let table = Table::new(document.get_ref(), "a scene file".to_owned(), 0..0, &known)?;

    let camera = table.get("camera").map(|item| camera::read(&item)).transpose()?;
    let camera = camera.unwrap_or_default();
    let materials = table.get("material").map(|item| materials(&item, files)).transpose()?;
    let lights = table.get("light").map(|item| lights(&item)).transpose()?;
    let list = table.get("object").ok_or_else(|| {
        let help = format!("begin one with [[object]] and, for example, {}", object::EXAMPLE);
        Problem::new(0..0, "the scene has no object").help(help)
    })?;
    let mut warnings = Vec::new();
    let mut scene = scene(&list, &materials.unwrap_or_default(), files, &mut warnings)?;

    if let Some(lights) = lights {
        scene.lights = lights;
    }
    if let Some(background) = camera.background {
        scene.background = background;
    }
    let camera::CameraTable { description, viewport_stated, .. } = camera;
    Ok(SceneFile { scene, camera: description, viewport_stated, warnings })
}

/// Builds the scene from its `[[object]]` tables.
fn scene(
    list: &Item,
    materials: &Materials,
    files: &Files,
    warnings: &mut Vec<String>,
) -> Result<Scene, Problem> {
    let items: Vec<Item> = list.tables()?.collect();
    let (mut objects, mut items_of) = (Vec::new(), Vec::new());
    for (index, item) in items.iter().enumerate() {
        objects.extend(object::read(item, materials, files, warnings)?);
        items_of.resize(objects.len(), index);
    }
    Scene::new(objects).map_err(|error| {
        let index = match error {
            SceneError::NotFinite { object, .. }
            | SceneError::Radius { object, .. }
            | SceneError::NoNormal { object } => items_of[object],
            // No single object is one too many. The last one is a place that exists.
            SceneError::TooManyPrimitives { .. }
            | SceneError::TooManyInstances { .. }
            | SceneError::TooManyHere { .. } => items.len() - 1,
        };
        let span = items.get(index).map_or(list.span.clone(), |item| item.span.clone());
        Problem::new(span, error.to_string())
    })
}

#[cfg(test)]
mod tests;
