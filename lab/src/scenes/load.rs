//! From a name to a scene and its camera.

use super::built_in::{BUILT_IN, BuiltIn, names};
use super::framing::{FrameMeshError, Framing};
use super::studio;
use crate::common::{
    Camera, CameraDescription, CameraError, Mesh, Object, Scene, SceneError, Shape,
};
use crate::formats::gltf::{self, GltfCamera, Model};
use crate::formats::mesh_file::{EXTENSIONS, Format, ReadMeshError, STREAMED};
use crate::formats::mesh_stream::StreamError;
use crate::formats::scene_file::{self, ReadSceneError, nearest_name};
use crate::formats::source::quote::{listed, quoted, visible};
use crate::formats::source::{Files, InputFile, Reach};
use crate::formats::warning::MaterialWarning;
use crate::formats::{shapes, smooth};
use std::path::Path;

/// A scene, ready to be rendered.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedScene {
    /// The name of the built-in scene, or the file name without its folder and extension.
    pub name: String,
    /// The objects and lights.
    pub scene: Scene,
    /// The scene's camera.
    pub camera: CameraDescription,
    /// Whether the scene file states the viewport. Another image size then keeps both sides of the viewport.
    pub viewport_stated: bool,
    /// The scene file; for a mesh file, the scene file that shows the mesh.
    pub toml: String,
    /// Messages about missing parts that are no error.
    pub warnings: Vec<String>,
}

impl LoadedScene {
    /// The scene in one line: the first line of its file, if that line is a comment.
    ///
    /// ```
    /// let about = "The lecture's first camera before one triangle, one sphere and one plane.";
    /// assert_eq!(bothways_lab::scenes::load("canonical")?.about(), Some(about));
    /// # Ok::<(), bothways_lab::scenes::LoadError>(())
    /// ```
    pub fn about(&self) -> Option<&str> {
        let comment = self.toml.lines().next()?.strip_prefix('#')?;
        Some(comment.trim_start_matches('#').trim()).filter(|line| !line.is_empty())
    }
}

/// How a scene is loaded.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadOptions {
    /// The width and height of the image for which the camera of a mesh file is framed; without it, of the default size. The
    /// cameras of other scenes stay unchanged.
    pub image: Option<[u32; 2]>,
    /// Which files the scene may name.
    pub reach: Reach,
}

/// The reason why a scene could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// No built-in scene has this name.
    #[error(
        "there is no built-in scene {name:?}; {}the built-in scenes are {}; a scene file (.toml) \
         or a mesh file ({EXTENSIONS}) can be named, too",
        .meant.map_or(String::new(), |meant| format!("did you mean {meant:?}? ")),
        names().join(", ")
    )]
    UnknownName {
        /// The requested name.
        name: String,
        /// The name that was probably meant.
        meant: Option<&'static str>,
    },
    /// The name is that of a folder.
    #[error("{path} is a folder; name a scene file (.toml) or a mesh file ({EXTENSIONS})")]
    Folder {
        /// The requested name.
        path: String,
    },
    /// The file is of an unsupported kind.
    #[error(
        "{path} is neither a scene file (.toml) nor a mesh file ({EXTENSIONS}); no others are read"
    )]
    UnknownExtension {
        /// The requested file.
        path: String,
    },
    /// An error in the scene file.
    #[error(transparent)]
    SceneFile(#[from] ReadSceneError),
    /// An error in the mesh file.
    #[error(transparent)]
    Mesh(#[from] ReadMeshError),
    /// The mesh file has more triangles than there are ids.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The mesh file cannot be streamed.
    #[error(transparent)]
    Stream(#[from] StreamError),
    /// The file to stream is not a mesh file.
    #[error(
        "only a mesh file ({STREAMED}) can be streamed, and {source_name:?} is none; render it \
         in memory, without --stream, or name a mesh file"
    )]
    NotStreamed {
        /// The requested name.
        source_name: String,
    },
    /// The glTF file has a camera that is not accepted.
    #[error("{path}: {error}")]
    Camera {
        /// The glTF file.
        path: String,
        /// The reason.
        error: CameraError,
    },
    /// The glTF file has no camera of this name.
    #[error("{path} has no camera {}; {}", quoted(.name), cameras_of(.names))]
    NoCamera {
        /// The glTF file.
        path: String,
        /// The requested name.
        name: String,
        /// The names of its cameras.
        names: Vec<String>,
    },
    /// The mesh file is correct, but no camera frames its mesh.
    #[error("{path}: {error}")]
    Framing {
        /// The mesh file.
        path: String,
        /// The reason.
        error: FrameMeshError,
    },
}

/// The names of a file's cameras, in a message.
fn cameras_of(names: &[String]) -> String {
    match names {
        [] => "it has none; leave # and the name out, and the mesh is framed".to_owned(),
        names => format!("its cameras are {}", listed(names.iter().map(String::as_str))),
    }
}

/// Loads a built-in scene by its name, a scene file, or a mesh file with a camera that frames the mesh.
///
/// A glTF file may be followed by `#` and the name of one of its cameras, or by `#` alone for the first.
///
/// # Errors
///
/// An error for an unknown name, with a list of the known names; for an unknown kind of file; or for an error in the
/// file.
///
/// ```
/// let loaded = bothways_lab::scenes::load("canonical")?;
/// assert_eq!(loaded.camera.image, [480, 480]);
/// # Ok::<(), bothways_lab::scenes::LoadError>(())
/// ```
pub fn load(source: &str) -> Result<LoadedScene, LoadError> {
    load_with(source, LoadOptions::default())
}

/// Loads a scene as [`load`] does, with options.
///
/// # Errors
///
/// The errors of [`load`].
pub fn load_with(source: &str, options: LoadOptions) -> Result<LoadedScene, LoadError> {
    if let Some(built_in) = BUILT_IN.iter().find(|built_in| built_in.name == source) {
        return load_built_in(built_in);
    }
    if let Some((file, camera)) = of_camera(source, options.reach) {
        return load_with_camera(&file, camera, options.image);
    }
    if Path::new(source).is_dir() {
        return Err(LoadError::Folder { path: visible(source).into_owned() });
    }
    // What could be the name of a built-in scene is no file.
    if Path::new(source).extension().is_none() && !source.contains(['/', '\\']) {
        return Err(LoadError::UnknownName {
            name: source.to_owned(),
            meant: nearest_name(source, BUILT_IN.iter().map(|built_in| built_in.name)),
        });
    }
    load_file(&InputFile::on_disk(Path::new(source), options.reach), options.image)
}

/// Loads a scene file, or a mesh file with a camera that frames it for an image of this width and height; from the disk, or
/// from memory together with the files that it names.
///
/// # Errors
///
/// An error for an unknown kind of file, or for an error in the file or in one that it names.
///
/// ```
/// use bothways_lab::formats::source::{GivenFile, InputFile};
/// use bothways_lab::scenes;
///
/// let triangle = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
/// let scene = b"[[object]]\nmesh = \"small.obj\"\n";
/// let given = [GivenFile::new("scene.toml", scene), GivenFile::new("small.obj", triangle)];
/// let loaded = scenes::load_file(&InputFile::given(&given, 0), None)?;
/// assert_eq!((loaded.name.as_str(), loaded.scene.primitive_count()), ("scene", 1));
/// # Ok::<(), bothways_lab::scenes::LoadError>(())
/// ```
pub fn load_file(file: &InputFile, image: Option<[u32; 2]>) -> Result<LoadedScene, LoadError> {
    if is_scene_file(file.path()) {
        let toml = scene_file::read_text(file)?;
        let read = scene_file::parse(&file.name(), &toml, file.files())?;
        return Ok(loaded(stem(file.path()), read, toml));
    }
    let Some(format) = Format::of_file(file) else {
        return Err(LoadError::UnknownExtension { path: file.name() });
    };
    let (shapes, missing) = format.read_shapes(file)?;
    let camera = framing_for(image).camera_of_shapes(&shapes);
    let wrong = |error| LoadError::Framing { path: file.name(), error };
    of_shapes(file.path(), shapes, &missing, (camera.map_err(wrong)?, false))
}

/// Whether the name is that of a scene file.
fn is_scene_file(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
}

fn load_built_in(built_in: &BuiltIn) -> Result<LoadedScene, LoadError> {
    let toml = built_in.toml.to_owned();
    let file = scene_file::parse(&format!("{}.toml", built_in.name), &toml, &Files::none())?;
    Ok(loaded(built_in.name.to_owned(), file, toml))
}

fn loaded(name: String, file: scene_file::SceneFile, toml: String) -> LoadedScene {
    let scene_file::SceneFile { scene, camera, viewport_stated, warnings } = file;
    LoadedScene { name, scene, camera, viewport_stated, toml, warnings }
}

/// The standard view in an image of this size.
pub(super) fn framing_for(image: Option<[u32; 2]>) -> Framing {
    let standard = Framing::default();
    Framing { image: image.unwrap_or(standard.image), ..standard }
}

/// A glTF file and the name of a camera, if they are written as `FILE#CAMERA`.
fn of_camera(source: &str, reach: Reach) -> Option<(InputFile<'static>, &str)> {
    let (path, camera) = source.split_once('#')?;
    let file = InputFile::on_disk(Path::new(path), reach);
    let is_meant = !Path::new(source).exists() && Format::of_file(&file) == Some(Format::Gltf);
    is_meant.then_some((file, camera))
}

/// Loads a glTF file, seen by one of its cameras: of this name, or the first if the name is empty.
fn load_with_camera(
    file: &InputFile,
    name: &str,
    image: Option<[u32; 2]>,
) -> Result<LoadedScene, LoadError> {
    let Model { shapes, cameras, warnings } = gltf::read(file).map_err(ReadMeshError::from)?;
    let path = file.path();
    let found = cameras.iter().find(|camera| camera.name == name || name.is_empty());
    let Some(GltfCamera { camera, aspect_stated, .. }) = found else {
        let names = cameras.into_iter().map(|camera| camera.name).collect();
        let path = path.display().to_string();
        return Err(LoadError::NoCamera { path, name: name.to_owned(), names });
    };
    let mut camera = CameraDescription { image: image.unwrap_or(camera.image), ..*camera };
    if !aspect_stated {
        let [width, height] = camera.image.map(|side| side as f32);
        camera.viewport = [width / height, 1.0];
    }
    let shown = path.display().to_string();
    let camera_error = |error: CameraError| LoadError::Camera { path: shown.clone(), error };
    Camera::new(camera).map_err(camera_error)?;
    of_shapes(path, shapes, &warnings, (camera, *aspect_stated))
}

/// What a mesh file shows, in the studio, before a camera; and whether the camera's viewport is stated.
fn of_shapes(
    path: &Path,
    shapes: Vec<Shape>,
    missing: &[MaterialWarning],
    (camera, viewport_stated): (CameraDescription, bool),
) -> Result<LoadedScene, LoadError> {
    let warnings = missing.iter().map(ToString::to_string).collect();
    let shown = path.display().to_string();
    let has_look = shapes.iter().filter_map(Shape::mesh).any(Mesh::has_look);
    let material = studio::material_for(has_look);
    let toml = studio::toml(&camera, viewport_stated, &shown, material.is_some());
    let material = material.unwrap_or_else(|| shapes::own_material(&shapes));
    let shapes = smooth::shapes_with_normals(shapes, smooth::CREASE).into_iter();
    let objects = shapes.map(|shape| Object { shape, material: material.clone() }).collect();
    let scene = studio::lit(Scene::new(objects)?);
    Ok(LoadedScene { name: stem(path), scene, camera, viewport_stated, toml, warnings })
}

/// The file's name without its folder and extension.
pub(super) fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
