//! `open`: a built-in scene, or files that were given to the page. `camera`: what follows from a camera.

use crate::answer::Answer;
use crate::camera::{CameraJson, FrameJson, ProjectionJson};
use crate::stage::Stage;
use bothways_lab::common::Camera;
use bothways_lab::formats::source::quote::quoted;
use bothways_lab::formats::source::{GivenFile, InputFile};
use bothways_lab::scenes::{self, BUILT_IN, LoadedScene, with_projection};
use serde::{Deserialize, Serialize};

/// What to open: a built-in scene, or one of the files that come with the message, by its name.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Open {
    name: String,
    /// The files whose bytes come with the message, one after another.
    #[serde(default)]
    files: Vec<Given>,
    /// Whether they are all the files of a folder: it may have some that nobody needs.
    #[serde(default)]
    folder: bool,
    /// The width and height of the image for which the camera of a mesh file is framed.
    #[serde(default)]
    image: Option<[u32; 2]>,
}

/// A file that was given to the page.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Given {
    name: String,
    /// How many bytes it has.
    bytes: usize,
}

#[derive(Serialize)]
struct Opened<'a> {
    name: &'a str,
    /// The scene in a sentence, if it has one.
    sentence: Option<&'a str>,
    camera: CameraJson,
    objects: usize,
    primitives: u64,
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
    kept: &mut Option<Stage>,
    open: &Open,
    bytes: Option<&[u8]>,
) -> Result<Answer, String> {
    let (loaded, bytes) = match bytes {
        Some(bytes) => given(open, bytes).map(|(loaded, bytes)| (loaded, Some(bytes)))?,
        None => (built_in(&open.name)?, None),
    };
    // The old scene goes first: two at once take twice the memory.
    *kept = None;
    let stage = Stage::new(loaded)?;
    let LoadedScene { name, scene, camera, viewport_stated, toml, warnings } = &stage.loaded;
    let triangles = |id: &u64| scene.triangle(*id).is_some();
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
    *kept = Some(stage);
    Ok(answer)
}

/// A page has no files but those that it is given: a name is that of a built-in scene.
fn built_in(name: &str) -> Result<LoadedScene, String> {
    if BUILT_IN.iter().any(|scene| scene.name == name) || !name.contains(['.', '/', '\\']) {
        return scenes::load(name).map_err(|error| error.to_string());
    }
    Err(format!("{name} is no built-in scene; open the file itself, or drop it on the page"))
}

/// Opens one of the files that were given to the page, in the words of the command line, and says how many bytes it has. It
/// may name the others; a warning names those that are not used.
fn given(open: &Open, bytes: &[u8]) -> Result<(LoadedScene, usize), String> {
    let (mut files, mut rest) = (Vec::new(), bytes);
    for Given { name, bytes } in &open.files {
        let (own, after) = rest
            .split_at_checked(*bytes)
            .ok_or_else(|| format!("the page sent too few bytes for the file {}", quoted(name)))?;
        files.push(GivenFile::new(name, own));
        rest = after;
    }
    let index = files.iter().position(|file| file.path() == open.name);
    let index = index.ok_or_else(|| format!("the page sent no file {}", quoted(&open.name)))?;
    let file = InputFile::given(&files, index);
    let mut loaded = scenes::load_file(&file, open.image).map_err(|error| error.to_string())?;
    if !open.folder {
        loaded.warnings.extend(unused(&files));
    }
    Ok((loaded, open.files[index].bytes))
}

/// A warning about files that were given and that no file names.
fn unused(files: &[GivenFile]) -> Option<String> {
    /// The most names that the warning lists.
    const MOST: usize = 3;
    let names = files.iter().filter(|file| !file.is_used()).map(|file| quoted(file.path()));
    let names: Vec<String> = names.collect();
    let more = match names.len().saturating_sub(MOST) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let some = names[..names.len().min(MOST)].join(", ");
    (!names.is_empty()).then(|| format!("not used, because no opened file names it: {some}{more}"))
}

pub(crate) fn camera(stage: &Stage, change: &Change) -> Result<Answer, String> {
    let mut description = change.camera.description();
    if let Some(projection) = change.projection {
        let scene = &stage.loaded.scene;
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
    use crate::engine::Engine;
    use serde_json::json;

    /// Opens the first of some files.
    fn open(engine: &mut Engine, files: &[(&str, &str)]) -> Result<Answer, String> {
        let listed: Vec<_> =
            files.iter().map(|(name, text)| json!({ "name": name, "bytes": text.len() })).collect();
        let bytes: String = files.iter().map(|(_, text)| *text).collect();
        let arguments = json!({ "name": files[0].0, "files": listed }).to_string();
        engine.call("open", &arguments, Some(bytes.as_bytes()))
    }

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

    #[test]
    fn only_given_files_are_read() {
        let mut engine = Engine::default();
        let says = engine.call("open", r#"{"name": "../a.obj"}"#, None).unwrap_err();
        assert!(says.starts_with("../a.obj is no built-in scene; open the file itself"), "{says}");
        let opened = open(&mut engine, &[("a.obj", TRIANGLE)]).unwrap();
        assert_eq!(opened.json()["triangles"], 1);
        // What is wrong leaves the scene that is open.
        open(&mut engine, &[("b.obj", "f 1 2 3\n")]).unwrap_err();
        let rendered = engine.call("render", "{}", None).unwrap();
        assert_eq!(rendered.json()["verdict"]["equal"], true);
    }

    #[test]
    fn files_that_a_file_names_are_given_with_it() {
        let mut engine = Engine::default();
        let scene = ("scene.toml", "[[object]]\nmesh = 'in/A.obj'\n");
        let says = open(&mut engine, &[scene]).unwrap_err();
        let together = "\"in/A.obj\" is not among the opened files; open it together with the file that names it, or drop \
                        both together";
        assert_eq!(says, format!("scene.toml:2:8: {together}"));

        let mesh = format!("mtllib a.mtl\nusemtl red\n{TRIANGLE}");
        let opened = open(&mut engine, &[scene, ("a.obj", &mesh), ("b.txt", "?")]).unwrap();
        let said = opened.json()["warnings"].clone();
        let missing = "a.obj: the material file \"a.mtl\" was not opened with it (open or drop both together); what needs it is \
                       drawn in light grey";
        assert_eq!(said, json!([missing, "not used, because no opened file names it: \"b.txt\""]));

        let library = ("A.MTL", "newmtl red\nKd 1 0 0\n");
        let opened = open(&mut engine, &[scene, ("a.obj", &mesh), library]).unwrap();
        assert_eq!(opened.json()["warnings"], json!([]));
        assert_eq!(
            (opened.json()["name"].clone(), opened.json()["triangles"].clone()),
            (json!("scene"), json!(1))
        );
    }

    #[test]
    fn a_folder_may_have_files_that_nobody_names() {
        let mut engine = Engine::default();
        let files = [
            ("scene.toml", "[[object]]\nmesh = 'parts/a.obj'\n"),
            ("parts/a.obj", &format!("mtllib ../paint/a.mtl\nusemtl red\n{TRIANGLE}")),
            ("paint/a.mtl", "newmtl red\nKd 1 0 0\n"),
            // Not this one, though it has the same name.
            ("old/a.obj", "f 1 2 3\n"),
            ("old/a.mtl", "?\n"),
        ];
        let listed: Vec<_> =
            files.iter().map(|(name, text)| json!({ "name": name, "bytes": text.len() })).collect();
        let bytes: String = files.iter().map(|(_, text)| *text).collect();
        let arguments =
            json!({ "name": "scene.toml", "files": listed, "folder": true }).to_string();
        let opened = engine.call("open", &arguments, Some(bytes.as_bytes())).unwrap();
        assert_eq!(
            (&opened.json()["triangles"], &opened.json()["warnings"]),
            (&json!(1), &json!([]))
        );
    }

    #[test]
    fn lists_of_files_that_do_not_fit_their_bytes_are_refused() {
        let mut engine = Engine::default();
        let mut says = |arguments: &str| engine.call("open", arguments, Some(b"v")).unwrap_err();
        let long = r#"{"name": "a.obj", "files": [{"name": "a.obj", "bytes": 2}]}"#;
        assert_eq!(says(long), "the page sent too few bytes for the file \"a.obj\"");
        let other = r#"{"name": "a.obj", "files": [{"name": "b.obj", "bytes": 1}]}"#;
        assert_eq!(says(other), "the page sent no file \"a.obj\"");
    }
}
