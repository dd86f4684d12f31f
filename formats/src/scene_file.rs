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
//! # Ok::<(), scene_file::SceneFileError>(())
//! ```
//!
//! Every key is described where it is read: the camera's in `camera.rs`, an object's in
//! `object.rs`, the others here. An unknown key is an error, so that a slip of the keyboard never
//! goes unnoticed; every error knows its place in the text. Numbers are read as the nearest `f32`.

mod camera;
mod error;
mod excerpt;
mod object;
mod reader;
mod transform;
mod write;

pub use error::{LocatedError, SceneFileError};
pub use excerpt::Excerpt;
pub use reader::nearest_name;
pub use write::framed_mesh_toml;

use crate::source::quote::quoted;
use crate::source::regular_file;
use bothways_common::Checker;
use bothways_common::camera::CameraDescription;
use bothways_common::look::color::linear_from_srgb;
use bothways_common::scene::{Light, Material, Object, Scene, SceneError};
use error::Problem;
use glam::Vec3;
use reader::{Item, Table};
use std::collections::BTreeMap;
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
pub fn read(path: &Path) -> Result<SceneFile, SceneFileError> {
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
pub fn read_text(path: &Path) -> Result<String, SceneFileError> {
    let name = path.display().to_string();
    let mut bytes = Vec::new();
    // A byte more than may be read tells that there is too much, whatever the system says of its length.
    let read =
        regular_file(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes));
    match read {
        Err(source) => return Err(SceneFileError::Unreadable { name, source }),
        Ok(_) if bytes.len() as u64 > MOST_BYTES => return Err(SceneFileError::TooLarge { name }),
        Ok(_) => {}
    }
    String::from_utf8(bytes).map_err(|error| {
        let byte = error.utf8_error().valid_up_to();
        let before = &error.as_bytes()[..byte];
        let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
        SceneFileError::NotText { name, line, byte }
    })
}

/// Reads a scene from a text that messages call `name`; paths in it are relative to `folder`.
///
/// # Errors
///
/// The first thing found that is wrong, with its place: see [`LocatedError`].
pub fn parse(name: &str, text: &str, folder: &Path) -> Result<SceneFile, SceneFileError> {
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

/// Materials by name; each has `color`, `specular`, `shininess` and `checker`, and may leave them out.
type Materials = BTreeMap<String, Material>;

fn materials(item: &Item) -> Result<Materials, Problem> {
    item.entries()?.map(|item| Ok((item.name.clone(), material(&item)?))).collect()
}

fn material(item: &Item) -> Result<Material, Problem> {
    let table = item.table(&["color", "specular", "shininess", "checker"])?;
    let mut material = Material::default();
    if let Some(item) = table.get("color") {
        material.color = color(&item)?;
    }
    if let Some(item) = table.get("specular") {
        material.specular = match item.not_negative()? {
            specular if specular <= 1.0 => specular,
            _ => {
                let what = format!("is {}; it must be at most 1", item.written());
                return Err(item.problem(what));
            }
        };
    }
    if let Some(item) = table.get("shininess") {
        material.shininess = item.positive()?;
    }
    material.checker = table.get("checker").map(|item| checker(&item)).transpose()?;
    Ok(material)
}

/// A pattern: its other `color`, and its `divisions`, the cells to a unit of the texture coordinate.
fn checker(item: &Item) -> Result<Checker, Problem> {
    const EXAMPLE: &str = "checker = { color = \"#202020\", divisions = [8, 8] }";
    let table = item.table(&["color", "divisions"])?;
    Ok(Checker {
        color: color(&table.need("color", EXAMPLE)?)?,
        divisions: table.need("divisions", EXAMPLE)?.positive_pair()?,
    })
}

/// Lights; each has one of `directional`, `point` and `ambient`, and an `intensity`, else 1.
fn lights(item: &Item) -> Result<Vec<Light>, Problem> {
    item.tables()?.map(|item| light(&item)).collect()
}

fn light(item: &Item) -> Result<Light, Problem> {
    const KINDS: [&str; 3] = ["directional", "point", "ambient"];
    let table = item.table(&["directional", "point", "ambient", "intensity"])?;
    let kind = exactly_one(&table, "a light", &KINDS, "directional = [-1, -2, -1]")?;
    let intensity = table.get("intensity").map_or(Ok(1.0), |item| item.not_negative())?;
    match kind.name.as_str() {
        "directional" => Ok(Light::Directional { direction: kind.direction()?, intensity }),
        "point" => Ok(Light::Point { position: kind.vector()?, intensity }),
        _ if kind.flag()? => Ok(Light::Ambient { intensity }),
        _ => Err(kind.problem("is false").help("write ambient = true, or remove this light")),
    }
}

/// The one of these keys that a table has.
fn exactly_one<'t>(
    table: &Table<'t>,
    name: &str,
    keys: &[&str],
    example: &str,
) -> Result<Item<'t>, Problem> {
    let present = table.present(keys);
    let one_of = format!("one of {}", keys.join(", "));
    match present[..] {
        [key] => table.need(key, example),
        [] => Err(Problem::new(table.span.clone(), format!("{name} needs {one_of}"))
            .help(format!("write for example {example}"))),
        [first, second, ..] => {
            let message = format!("{name} takes only {one_of}, and this one has {first} already");
            Err(Problem::new(table.place_of(second), message).help(format!("remove {second}")))
        }
    }
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

/// A colour as screens show it, `"#rrggbb"`; linear from here on.
fn color(item: &Item) -> Result<Vec3, Problem> {
    let text = item.text()?;
    let byte = |range| u8::from_str_radix(text.get(range)?, 16).ok();
    // The parser of numbers would take a sign for a digit.
    let digits = text.len() == 7 && text.chars().skip(1).all(|c| c.is_ascii_hexdigit());
    let bytes =
        (digits && text.starts_with('#')).then(|| Some([byte(1..3)?, byte(3..5)?, byte(5..7)?]));
    match bytes.flatten() {
        Some(bytes) => Ok(Vec3::from_array(bytes.map(linear_from_srgb))),
        None => Err(item
            .problem(format!("is {}; it must be a # and six hexadecimal digits", quoted(text)))
            .help("write for example \"#c8553d\"")),
    }
}
