//! What can be rendered by name: the built-in scenes, scene files, and mesh files, which get a
//! camera that frames them.

mod framing;
mod stream;
mod studio;

pub use framing::{FrameMeshError, Framing, framed};
pub use stream::{StreamedScene, open_stream};

use crate::common::{CameraDescription, Object, Scene, SceneError, Shape};
use crate::formats::mesh_file::{Format, ReadMeshError};
use crate::formats::mesh_stream::StreamError;
use crate::formats::scene_file::{self, ReadSceneError, nearest_name};
use crate::formats::smooth;
use std::path::Path;

/// A scene that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuiltIn {
    /// What the command line calls it.
    pub name: &'static str,
    /// Its point, in one sentence; the first line of its file says the same.
    pub about: &'static str,
    /// Its scene file.
    pub toml: &'static str,
}

/// The name of the scene that is rendered when nobody names one.
pub const DEFAULT: &str = "lecture";

/// All built-in scenes, the default first.
pub const BUILT_IN: &[BuiltIn] = &[
    BuiltIn {
        name: "lecture",
        about: "The first slide: Newell's teapot, a sphere and a plane, with materials and light.",
        toml: include_str!("../scenes/lecture.toml"),
    },
    BuiltIn {
        name: "canonical",
        about: "The lecture's first camera before one triangle, one sphere and one plane.",
        toml: include_str!("../scenes/canonical.toml"),
    },
    BuiltIn {
        name: "ties",
        about: "Edges and vertices exactly on sample points, at every size that is a power of two.",
        toml: include_str!("../scenes/ties.toml"),
    },
    BuiltIn {
        name: "behind",
        about: "Triangles, spheres and planes that reach behind the eye, and some that lie there.",
        toml: include_str!("../scenes/behind.toml"),
    },
    BuiltIn {
        name: "slivers",
        about: "Needles down to thousandths of a pixel, and a fan of them that leaves no gap.",
        toml: include_str!("../scenes/slivers.toml"),
    },
    BuiltIn {
        name: "overlap",
        about: "Coplanar and duplicated faces, of which the first in the scene is always seen.",
        toml: include_str!("../scenes/overlap.toml"),
    },
    BuiltIn {
        name: "inside",
        about: "A closed mesh seen from within: every pixel is covered, or the surface leaks.",
        toml: include_str!("../scenes/inside.toml"),
    },
    BuiltIn {
        name: "many",
        about: "A necklace of some 100,000 triangles, so that searching well pays.",
        toml: include_str!("../scenes/many.toml"),
    },
];

/// A scene, ready to be rendered.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedScene {
    /// The built-in's name, or the file's without its folder and extension.
    pub name: String,
    /// What there is to see.
    pub scene: Scene,
    /// From where.
    pub camera: CameraDescription,
    /// Whether somebody stated the viewport, so that another image size keeps both its sides.
    pub viewport_stated: bool,
    /// The scene as a scene file; for a mesh file, the one that shows it.
    pub toml: String,
    /// What is missing, but no error.
    pub warnings: Vec<String>,
}

impl LoadedScene {
    /// The scene in one line: what the first line of its file says, if it is a comment.
    ///
    /// ```
    /// let about = "The lecture's first camera before one triangle, one sphere and one plane.";
    /// assert_eq!(bothways::scenes::load("canonical")?.about(), Some(about));
    /// # Ok::<(), bothways::scenes::LoadError>(())
    /// ```
    pub fn about(&self) -> Option<&str> {
        let comment = self.toml.lines().next()?.strip_prefix('#')?;
        Some(comment.trim_start_matches('#').trim()).filter(|line| !line.is_empty())
    }
}

/// Why a scene could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// No built-in scene has this name.
    #[error(
        "there is no built-in scene {name:?}; {}the built-in scenes are {}; a scene file (.toml) \
         or a mesh file (.obj, .ply) can be named, too",
        .meant.map_or(String::new(), |meant| format!("did you mean {meant:?}? ")),
        names().join(", ")
    )]
    UnknownName {
        /// What was asked for.
        name: String,
        /// The name that may have been meant.
        meant: Option<&'static str>,
    },
    /// The file is of no kind that is read.
    #[error(
        "{path} is neither a scene file (.toml) nor a mesh file (.obj, .ply); no others are read"
    )]
    UnknownExtension {
        /// What was asked for.
        path: String,
    },
    /// The scene file is wrong.
    #[error(transparent)]
    SceneFile(#[from] ReadSceneError),
    /// The mesh file is wrong.
    #[error(transparent)]
    Mesh(#[from] ReadMeshError),
    /// The mesh file has more triangles than there are ids.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The mesh file cannot be streamed.
    #[error(transparent)]
    Stream(#[from] StreamError),
    /// What is to be streamed is no mesh file.
    #[error(
        "only a mesh file (.obj, .ply) can be streamed, and {source_name:?} is none; render it in \
         memory, without --stream, or name a mesh file"
    )]
    NotStreamed {
        /// What was asked for.
        source_name: String,
    },
    /// The mesh file is right, but no camera shows what is in it.
    #[error("{path}: {error}")]
    Framing {
        /// The mesh file.
        path: String,
        /// Why.
        error: FrameMeshError,
    },
}

/// Loads a built-in scene by its name, a scene file, or a mesh file before a camera that frames it.
///
/// # Errors
///
/// An unknown name, listing the known ones; an unknown kind of file; what is wrong with the file.
///
/// ```
/// let loaded = bothways::scenes::load("canonical")?;
/// assert_eq!(loaded.camera.image, [480, 480]);
/// # Ok::<(), bothways::scenes::LoadError>(())
/// ```
pub fn load(source: &str) -> Result<LoadedScene, LoadError> {
    load_for(source, None)
}

/// The same for an image of this width and height: a mesh file is framed for its form. The cameras of other scenes
/// stay as they are.
///
/// # Errors
///
/// As for [`load`].
pub fn load_for(source: &str, image: Option<[u32; 2]>) -> Result<LoadedScene, LoadError> {
    if let Some(built_in) = BUILT_IN.iter().find(|built_in| built_in.name == source) {
        return load_built_in(built_in);
    }
    let path = Path::new(source);
    if let Some(format) = Format::of(path) {
        return load_mesh(path, format, &framing_for(image));
    }
    match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("toml") => load_scene_file(path),
        None if !source.contains(['/', '\\']) => Err(LoadError::UnknownName {
            name: source.to_owned(),
            meant: nearest_name(source, BUILT_IN.iter().map(|built_in| built_in.name)),
        }),
        _ => Err(LoadError::UnknownExtension { path: source.to_owned() }),
    }
}

fn load_built_in(built_in: &BuiltIn) -> Result<LoadedScene, LoadError> {
    let toml = built_in.toml.to_owned();
    let file = scene_file::parse(&format!("{}.toml", built_in.name), &toml, Path::new(""))?;
    Ok(loaded(built_in.name.to_owned(), file, toml))
}

fn load_scene_file(path: &Path) -> Result<LoadedScene, LoadError> {
    let toml = scene_file::read_text(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let file = scene_file::parse(&path.display().to_string(), &toml, folder)?;
    Ok(loaded(stem(path), file, toml))
}

fn loaded(name: String, file: scene_file::SceneFile, toml: String) -> LoadedScene {
    let scene_file::SceneFile { scene, camera, viewport_stated, warnings } = file;
    LoadedScene { name, scene, camera, viewport_stated, toml, warnings }
}

/// The standard view in an image of this size.
fn framing_for(image: Option<[u32; 2]>) -> Framing {
    let standard = Framing::default();
    Framing { image: image.unwrap_or(standard.image), ..standard }
}

fn load_mesh(path: &Path, format: Format, framing: &Framing) -> Result<LoadedScene, LoadError> {
    let (mesh, missing) = format.read_with_materials(path)?;
    let warnings = missing.iter().map(ToString::to_string).collect();
    let shown = path.display().to_string();
    let camera =
        framing.camera(&mesh).map_err(|error| LoadError::Framing { path: shown.clone(), error })?;
    let material = studio::material_for(mesh.materials().is_some());
    let toml = studio::toml(&camera, &shown, material.is_some());
    let shape = Shape::Mesh(smooth::with_normals(mesh, smooth::CREASE));
    let object = Object { shape, material: material.unwrap_or_default() };
    let scene = studio::lit(Scene::new(vec![object])?);
    Ok(LoadedScene { name: stem(path), scene, camera, viewport_stated: false, toml, warnings })
}

/// The file's name without its folder and extension.
fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn names() -> Vec<&'static str> {
    BUILT_IN.iter().map(|built_in| built_in.name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::Camera;

    #[test]
    fn every_built_in_scene_loads_and_says_its_point() {
        for BuiltIn { name, about, toml } in BUILT_IN {
            let loaded = load(name).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!((loaded.name.as_str(), loaded.toml.as_str()), (*name, *toml));
            assert!(loaded.scene.primitive_count() > 0, "{name}");
            Camera::new(loaded.camera).unwrap();
            assert_eq!(toml.lines().next(), Some(format!("# {about}").as_str()));
            assert!(toml.lines().all(|line| line.len() <= 120), "{name}");
        }
        assert_eq!(BUILT_IN[0].name, DEFAULT);
    }

    #[test]
    fn no_built_in_scene_has_the_name_of_a_subcommand() {
        let commands =
            ["render", "diff", "pixel", "cover", "camera", "mesh", "scenes", "completions", "help"];
        assert!(names().iter().all(|name| !commands.contains(name)));
    }

    #[test]
    fn many_has_about_a_hundred_thousand_triangles() {
        let triangles = load("many").unwrap().scene.primitive_count();
        assert!((90_000..110_000).contains(&triangles), "{triangles}");
    }

    #[test]
    fn an_unknown_name_lists_the_known_ones() {
        let says = |name| load(name).unwrap_err().to_string();
        let list = "the built-in scenes are lecture, canonical, ties, behind, slivers, overlap, \
                    inside, many; a scene file (.toml) or a mesh file (.obj, .ply) can be named, too";
        let near =
            format!("there is no built-in scene \"lectuer\"; did you mean \"lecture\"? {list}");
        assert_eq!(says("lectuer"), near);
        assert_eq!(says("bunny"), format!("there is no built-in scene \"bunny\"; {list}"));
        assert_eq!(says(""), format!("there is no built-in scene \"\"; {list}"));
    }

    #[test]
    fn an_unknown_kind_of_file_is_refused_by_name() {
        for path in ["meshes/bunny.stl", "bunny.stl", "meshes/bunny"] {
            let says = load(path).unwrap_err().to_string();
            let reason =
                "is neither a scene file (.toml) nor a mesh file (.obj, .ply); no others are read";
            assert_eq!(says, format!("{path} {reason}"));
        }
    }

    #[test]
    fn a_missing_scene_file_is_named() {
        let says = load("no-such.toml").unwrap_err().to_string();
        assert_eq!(says, "no-such.toml: there is no such file");
    }

    #[test]
    fn a_mesh_file_is_framed_and_its_scene_file_reads_back() {
        let folder = std::env::temp_dir().join(format!("bothways-scenes-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("a \"triangle\".OBJ");
        std::fs::write(&path, "v 0.1 0 0\nv 1 0.3 0\nv 0 1 -0.7\nf 1 2 3\n").unwrap();

        let loaded = load(path.to_str().unwrap()).unwrap();
        assert_eq!(loaded.name, "a \"triangle\"");
        assert!(!loaded.viewport_stated);
        let again = scene_file::parse("again.toml", &loaded.toml, Path::new("")).unwrap();
        assert_eq!((again.scene, again.camera), (loaded.scene, loaded.camera));
        assert!(!again.viewport_stated);

        let saved = folder.join("saved.toml");
        std::fs::write(&saved, &loaded.toml).unwrap();
        let from_file = load(saved.to_str().unwrap()).unwrap();
        assert_eq!((from_file.name.as_str(), from_file.camera), ("saved", loaded.camera));
        assert_eq!(from_file.toml, loaded.toml);

        std::fs::write(&path, "v 1 1 1\nf 1 1 1\n").unwrap();
        let says = load(path.to_str().unwrap()).unwrap_err().to_string();
        assert!(says.ends_with("all triangles lie in one point, so no camera can frame them"));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
