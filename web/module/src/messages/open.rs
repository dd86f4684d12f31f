//! `open`: a built-in scene, or a file that was given to the page. `camera`: what follows from a camera.

use crate::answer::Answer;
use crate::camera::{CameraJson, FrameJson, ProjectionJson};
use crate::engine::Engine;
use crate::stage::Stage;
use bothways_lab::common::Camera;
use bothways_lab::scenes::{self, BUILT_IN, LoadedScene, with_projection};
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
    file: Option<&[u8]>,
) -> Result<Answer, String> {
    let (loaded, bytes) = match file {
        Some(bytes) => (given(open, bytes)?, Some(bytes.len())),
        None => (built_in(&open.name)?, None),
    };
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

/// A page has no files but those that it is given: a name is that of a built-in scene.
fn built_in(name: &str) -> Result<LoadedScene, String> {
    if BUILT_IN.iter().any(|scene| scene.name == name) || !name.contains(['.', '/', '\\']) {
        return scenes::load(name).map_err(|error| error.to_string());
    }
    Err(format!("{name} is no built-in scene; open the file itself, or drop it on the page"))
}

/// Opens a file that was given to the page, in the words of the command line.
fn given(open: &Open, bytes: &[u8]) -> Result<LoadedScene, String> {
    scenes::load_bytes(&open.name, bytes, open.image).map_err(|error| {
        let mut text = error.to_string();
        // What WebAssembly says of every file.
        if text.ends_with("operation not supported on this platform") {
            text += "; a page reads no file beside the one that it is given: open the mesh alone, or generate one";
        }
        text
    })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_given_files_are_read() {
        let mut engine = Engine::default();
        let says = engine.call("open", r#"{"name": "../a.obj"}"#, None).unwrap_err();
        assert!(says.starts_with("../a.obj is no built-in scene; open the file itself"), "{says}");
        let triangle = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let opened = engine.call("open", r#"{"name": "a.obj"}"#, Some(triangle)).unwrap();
        assert_eq!(opened.json()["triangles"], 1);
        // What is wrong leaves the scene that is open.
        engine.call("open", r#"{"name": "b.obj"}"#, Some(b"f 1 2 3\n")).unwrap_err();
        let rendered = engine.call("render", "{}", None).unwrap();
        assert_eq!(rendered.json()["verdict"]["equal"], true);
    }
}
