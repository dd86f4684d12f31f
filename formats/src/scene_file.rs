//! The scene file: a scene and its camera, written in TOML.
//!
//! ```
//! use bothways_formats::scene_file;
//! use std::path::Path;
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
//! let file = scene_file::parse("example.toml", text, Path::new(""))?;
//! assert_eq!(file.scene.objects().len(), 2);
//! # Ok::<(), scene_file::ReadSceneError>(())
//! ```
//!
//! Every key is described where it is read: the camera's in `camera.rs`, an object's in
//! `object.rs`, the others here. An unknown key is an error, so that a slip of the keyboard never
//! goes unnoticed; every error knows its place in the text. Numbers are read as the nearest `f32`.

mod camera;
mod color;
mod document;
mod error;
mod excerpt;
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

use crate::source::regular_file;
use bothways_common::camera::CameraDescription;
use bothways_common::scene::{Object, Scene, SceneError};
use document::{Item, Table};
use error::Problem;
use light::lights;
use material::{Materials, materials};
use std::io::Read;
use std::path::Path;
use toml::de::DeTable;

/// What a scene file says.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFile {
    /// What there is to see.
    pub scene: Scene,
    /// From where; [`Camera::new`](crate::Camera::new) accepts it.
    pub camera: CameraDescription,
    /// Whether the file states the viewport, so that another image size keeps both its sides.
    pub viewport_stated: bool,
    /// What is missing, but no error: see [`crate::obj::MaterialWarning`].
    pub warnings: Vec<String>,
}

/// Reads a scene file. Paths in it are relative to its folder.
///
/// # Errors
///
/// Those of [`read_text`] and of [`parse`].
pub fn read(path: &Path) -> Result<SceneFile, ReadSceneError> {
    let text = read_text(path)?;
    parse(&path.display().to_string(), &text, path.parent().unwrap_or(Path::new("")))
}

/// The largest scene file: some 140,000 objects. While it is read, its tables take 70 times as much memory as
/// their text, and up to 240 times where they are as short as can be: less than 2 GiB in any case.
const MOST_BYTES: u64 = 8 << 20;

/// Reads the text of a scene file, for whoever needs it besides what it says.
///
/// # Errors
///
/// A file that is not there, cannot be read, is a pipe or a device, is too large or is no text.
pub fn read_text(path: &Path) -> Result<String, ReadSceneError> {
    let file = path.display().to_string();
    let mut bytes = Vec::new();
    // A byte more than may be read tells that there is too much, whatever the system says of its length.
    let read =
        regular_file(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes));
    match read {
        Err(error) => return Err(ReadSceneError::Unreadable { file, error }),
        Ok(_) if bytes.len() as u64 > MOST_BYTES => return Err(ReadSceneError::TooLarge { file }),
        Ok(_) => {}
    }
    String::from_utf8(bytes).map_err(|error| {
        let byte = error.utf8_error().valid_up_to();
        let before = &error.as_bytes()[..byte];
        let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
        ReadSceneError::NotText { file, line, byte }
    })
}

/// Reads a scene from a text that messages call `name`; paths in it are relative to `folder`.
///
/// # Errors
///
/// The first thing found that is wrong, with its place: see [`LocatedError`].
pub fn parse(name: &str, text: &str, folder: &Path) -> Result<SceneFile, ReadSceneError> {
    let read = document(text, folder);
    read.map_err(|problem| problem.in_text(name, text).into())
}

/// Reads `camera`, `material`, `light` and `object`.
fn document(text: &str, folder: &Path) -> Result<SceneFile, Problem> {
    let document = DeTable::parse(text)?;
    let known = ["camera", "material", "light", "object"];
    let table = Table::new(document.get_ref(), "a scene file".to_owned(), 0..0, &known)?;

    let camera = table.get("camera").map(|item| camera::read(&item)).transpose()?;
    let camera = camera.unwrap_or_default();
    let materials = table.get("material").map(|item| materials(&item)).transpose()?;
    let lights = table.get("light").map(|item| lights(&item)).transpose()?;
    let list = table.get("object").ok_or_else(|| {
        let help = format!("begin one with [[object]] and, for example, {}", object::EXAMPLE);
        Problem::new(0..0, "the scene has no object").help(help)
    })?;
    let mut warnings = Vec::new();
    let mut scene = scene(&list, &materials.unwrap_or_default(), folder, &mut warnings)?;

    if let Some(lights) = lights {
        scene.lights = lights;
    }
    if let Some(background) = camera.background {
        scene.background = background;
    }
    let camera::CameraTable { description, viewport_stated, .. } = camera;
    Ok(SceneFile { scene, camera: description, viewport_stated, warnings })
}

fn scene(
    list: &Item,
    materials: &Materials,
    folder: &Path,
    warnings: &mut Vec<String>,
) -> Result<Scene, Problem> {
    let items: Vec<Item> = list.tables()?.collect();
    let objects: Result<Vec<Object>, Problem> =
        items.iter().map(|item| object::read(item, materials, folder, warnings)).collect();
    Scene::new(objects?).map_err(|error| {
        let index = match error {
            SceneError::NotFinite { object, .. }
            | SceneError::Radius { object, .. }
            | SceneError::NoNormal { object } => object,
            // Nobody can say which object is one too many; the last one is certainly there.
            SceneError::TooManyPrimitives { .. } => items.len() - 1,
        };
        let span = items.get(index).map_or(list.span.clone(), |item| item.span.clone());
        Problem::new(span, error.to_string())
    })
}

#[cfg(test)]
mod tests;
