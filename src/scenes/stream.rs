//! A mesh file to be streamed: its camera is the one that frames it in memory, too.

use super::{LoadError, LoadedScene, framing_for, stem, studio};
use crate::common::Scene;
use crate::formats::mesh_file::Format;
use crate::formats::mesh_stream::MeshStream;
use crate::rasterize::stream::Look;
use std::path::Path;

/// A mesh that is streamed, before a camera that frames it.
#[derive(Debug)]
pub struct StreamedScene {
    /// All but the mesh: its scene holds no object.
    pub loaded: LoadedScene,
    /// The mesh.
    pub mesh: MeshStream,
    /// How many triangles it has.
    pub triangles: u32,
    /// What it is made of, and its light.
    pub look: Look,
}

/// Opens a mesh file for streaming, reads its vertices, and looks at all of its faces once. It is framed for an
/// image of this size, or of the usual one.
///
/// # Errors
///
/// What is no mesh file; what is wrong with it; a mesh that no camera frames.
pub fn open_stream(source: &str, image: Option<[u32; 2]>) -> Result<StreamedScene, LoadError> {
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
    Ok(StreamedScene { loaded, mesh, triangles, look })
}
