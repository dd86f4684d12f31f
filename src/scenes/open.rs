//! A scene that is opened to be rendered: in memory, or as a stream, whose camera is the one that frames the same
//! mesh in memory.

use super::load::{LoadError, LoadedScene, framing_for, load_for, stem};
use super::studio;
use crate::common::{Camera, Scene, View};
use crate::formats::mesh_file::Format;
use crate::formats::mesh_stream::MeshStream;
use crate::orders::Source;
use crate::rasterize::stream::Look;
use std::path::Path;
use std::time::{Duration, Instant};

/// A mesh that is streamed, before a camera that frames it.
#[derive(Debug)]
pub struct StreamedScene {
    /// All but the mesh: its scene holds no object.
    pub loaded: LoadedScene,
    /// The mesh.
    pub mesh: MeshStream,
    /// How many triangles it has.
    pub triangles: u32,
    /// Its material and its light.
    pub look: Look,
    /// How long all of that took.
    pub opening: Duration,
}

/// A scene that is opened to be rendered.
#[derive(Debug)]
pub enum OpenedScene {
    /// All of it is in memory.
    InMemory(LoadedScene),
    /// Its mesh is read again for every frame.
    Streamed(StreamedScene),
}

impl OpenedScene {
    /// All but the mesh that is streamed, if one is.
    pub fn loaded(&self) -> &LoadedScene {
        match self {
            OpenedScene::InMemory(loaded) => loaded,
            OpenedScene::Streamed(streamed) => &streamed.loaded,
        }
    }

    /// How many primitives it has.
    pub fn primitive_count(&self) -> u32 {
        match self {
            OpenedScene::InMemory(loaded) => loaded.scene.primitive_count(),
            OpenedScene::Streamed(streamed) => streamed.triangles,
        }
    }

    /// The scene as a camera sees it, to be rendered.
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

/// Opens a scene: a mesh file as a stream, or anything in memory. A mesh is framed for an image of this size, or of
/// the usual one.
///
/// # Errors
///
/// As for [`load`](super::load) and [`open_stream`].
pub fn open(source: &str, image: Option<[u32; 2]>, stream: bool) -> Result<OpenedScene, LoadError> {
    if stream {
        open_stream(source, image).map(OpenedScene::Streamed)
    } else {
        load_for(source, image).map(OpenedScene::InMemory)
    }
}

/// Opens a mesh file for streaming, reads its vertices, and looks at all of its faces once. It is framed for an
/// image of this size, or of the usual one.
///
/// # Errors
///
/// What is no mesh file; what is wrong with it; a mesh that no camera frames.
pub fn open_stream(source: &str, image: Option<[u32; 2]>) -> Result<StreamedScene, LoadError> {
    let begun = Instant::now();
    let path = Path::new(source);
    let Some(format) = Format::of(path) else {
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
        toml: studio::toml(&camera, source, true),
        warnings: mesh.material_warning().iter().map(ToString::to_string).collect(),
    };
    let look = Look {
        material: studio::material_for(false).unwrap_or_default(),
        lights: loaded.scene.lights.clone(),
        background: loaded.scene.background,
    };
    Ok(StreamedScene { loaded, mesh, triangles, look, opening: begun.elapsed() })
}
