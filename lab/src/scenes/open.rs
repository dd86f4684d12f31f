//! A scene opened for rendering: in memory, or as a stream. The camera of a stream is the camera that frames the same
//! mesh in memory.

use super::load::{LoadError, LoadOptions, LoadedScene, framing_for, load_with, stem};
use super::studio;
use crate::common::{Camera, Scene, View};
use crate::formats::mesh_file::Format;
use crate::formats::mesh_stream::MeshStream;
use crate::formats::source::{InputFile, Reach};
use crate::orders::Source;
use crate::rasterize::stream::Look;
use std::path::Path;
use std::time::{Duration, Instant};

/// A streamed mesh with a camera that frames it.
#[derive(Debug)]
pub struct StreamedScene {
    /// The loaded scene without the mesh: its scene holds no object.
    pub loaded: LoadedScene,
    /// The mesh.
    pub mesh: MeshStream,
    /// The number of triangles in the mesh.
    pub triangles: u32,
    /// The material and the light of the mesh.
    pub look: Box<Look>,
    /// The time for opening the file, reading it once, and framing the mesh.
    pub opening: Duration,
}

/// A scene opened for rendering.
#[derive(Debug)]
pub enum OpenedScene {
    /// The whole scene is in memory.
    InMemory(LoadedScene),
    /// The mesh is read again for every frame.
    Streamed(StreamedScene),
}

impl OpenedScene {
    /// The loaded scene; the mesh of a stream is missing.
    pub fn loaded(&self) -> &LoadedScene {
        match self {
            OpenedScene::InMemory(loaded) => loaded,
            OpenedScene::Streamed(streamed) => &streamed.loaded,
        }
    }

    /// The number of primitives in the scene.
    pub fn primitive_count(&self) -> u64 {
        match self {
            OpenedScene::InMemory(loaded) => loaded.scene.primitive_count(),
            OpenedScene::Streamed(streamed) => streamed.triangles.into(),
        }
    }

    /// The scene and a camera, as a source for rendering.
    pub fn source<'a>(&'a mut self, camera: &'a Camera) -> Source<'a> {
        match self {
            OpenedScene::InMemory(loaded) => Source::View(View::new(&loaded.scene, camera)),
            OpenedScene::Streamed(streamed) => {
                let StreamedScene { mesh, look, opening, .. } = streamed;
                Source::Stream { mesh, camera, look, opening: *opening }
            }
        }
    }
}

/// Opens a scene: a mesh file as a stream, which names no other file, or any scene in memory.
///
/// # Errors
///
/// The errors of [`load`](super::load) and [`open_stream`].
pub fn open(source: &str, options: LoadOptions, stream: bool) -> Result<OpenedScene, LoadError> {
    if stream {
        open_stream(source, options.image).map(OpenedScene::Streamed)
    } else {
        load_with(source, options).map(OpenedScene::InMemory)
    }
}

/// Opens a mesh file for streaming, reads its vertices, and reads all of its faces once. The camera is framed for an
/// image of this size, or of the default size.
///
/// # Errors
///
/// An error for a file that is not a mesh file, for an error in the mesh file, or for a mesh that no camera frames.
pub fn open_stream(source: &str, image: Option<[u32; 2]>) -> Result<StreamedScene, LoadError> {
    let begun = Instant::now();
    let path = Path::new(source);
    let format = Format::of_file(&InputFile::on_disk(path, Reach::Folder));
    let Some(format) = format.filter(|format| format.can_be_streamed()) else {
        return Err(LoadError::NotStreamed { source_name: source.to_owned() });
    };
    let mut mesh = MeshStream::open(path, format)?;
    let (triangles, used) = mesh.used_positions()?;
    let framed = framing_for(image).camera_of(used);
    let camera = framed.map_err(|error| LoadError::Framing { path: source.to_owned(), error })?;
    let loaded = LoadedScene {
        name: stem(path),
        scene: studio::lit(Scene::new(Vec::new())?),
        camera,
        viewport_stated: false,
        toml: studio::toml(&camera, false, source, true),
        warnings: mesh.material_warning().iter().map(ToString::to_string).collect(),
    };
    let look = Box::new(Look {
        material: studio::material_for(false).unwrap_or_default(),
        lights: loaded.scene.lights.clone(),
        background: loaded.scene.background,
    });
    Ok(StreamedScene { loaded, mesh, triangles, look, opening: begun.elapsed() })
}
