//! `open`: a built-in scene, or a file that was given to the page. `camera`: what follows from a camera.

use crate::answer::Answer;
use crate::camera::{CameraJson, FrameJson, ProjectionJson};
use crate::engine::{Engine, File};
use crate::stage::Stage;
use bothways_lab::common::Camera;
use bothways_lab::scenes::{self, LoadedScene, with_projection};
use serde::{Deserialize, Serialize};

/// What to open: a built-in scene, or the file that comes with the message, by its name.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Open {
    name: String,
    /// The width and height of the image for which the camera of a mesh file is framed.
    #[serde(default)]
    image: Option<[u32; 2]>,
}

#[derive(Serialize)]
struct Opened<'a> {
    name: &'a str,
    /// The scene in a sentence, if it has one.
    sentence: Option<&'a str>,
    camera: CameraJson,
    objects: usize,
    primitives: u32,
    triangles: usize,
    /// The file that was opened, in bytes; for a built-in scene, its scene file.
    bytes: usize,
    viewport_stated: bool,
    warnings: &'a [String],
    /// The scene file; for a mesh file, one that shows it.
    toml: &'a str,
}

/// A camera, which may get another projection.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Change {
    camera: CameraJson,
    /// Another projection: what is looked at keeps its size in the picture.
    #[serde(default)]
    projection: Option<ProjectionJson>,
}

#[derive(Serialize)]
struct Changed {
    camera: CameraJson,
    frame: FrameJson,
}

pub(crate) fn answer(
    engine: &mut Engine,
    open: &Open,
    file: Option<File>,
) -> Result<Answer, String> {
    let (loaded, bytes) = match file {
        Some(File { bytes }) => {
            (scenes::load_bytes(&open.name, bytes, open.image), Some(bytes.len()))
        }
        None => (built_in(&open.name), None),
    };
    let loaded = loaded.map_err(|error| full(&error))?;
    // The old scene goes first: two at once take twice the memory.
    engine.stage = None;
    let stage = Stage::new(loaded)?;
    let LoadedScene { name, scene, camera, viewport_stated, toml, warnings } = &stage.loaded;
    let triangles = |id: &u32| scene.triangle(*id).is_some();
    let answer = Answer::new(Opened {
        name,
        sentence: stage.loaded.about(),
        camera: CameraJson::new(camera),
        objects: scene.objects().len(),
        primitives: scene.primitive_count(),
        triangles: (0..scene.primitive_count()).filter(triangles).count(),
        bytes: bytes.unwrap_or(toml.len()),
        viewport_stated: *viewport_stated,
        warnings,
        toml,
    });
    engine.stage = Some(stage);
    Ok(answer)
}

/// A page has no files beside it: only names of built-in scenes are known.
fn built_in(name: &str) -> Result<LoadedScene, scenes::LoadError> {
    scenes::load(name)
}

/// The message as on the command line: with the lines of a scene file that it is about.
fn full(error: &scenes::LoadError) -> String {
    let scenes::LoadError::SceneFile(error) = error else { return error.to_string() };
    error.to_string()
}

pub(crate) fn camera(engine: &mut Engine, change: &Change) -> Result<Answer, String> {
    let mut description = change.camera.description();
    if let Some(projection) = change.projection {
        let scene = &engine.stage()?.loaded.scene;
        description = with_projection(&description, projection.into(), scene)
            .map_err(|error| error.to_string())?;
    }
    let camera = Camera::new(description).map_err(|error| error.to_string())?;
    Ok(Answer::new(Changed {
        camera: CameraJson::new(&description),
        frame: FrameJson::new(&camera),
    }))
}
