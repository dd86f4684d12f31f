//! A mesh file to be streamed: its camera is the one that frames it in memory, too.

use super::{LoadError, LoadedScene, framed_positions, stem};
use crate::common::Scene;
use crate::common::mesh_file::Format;
use crate::common::scene_file::framed_mesh_toml;
use crate::common::stream::MeshStream;
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
}

/// Opens a mesh file for streaming, reads its vertices, and looks at all of its faces once.
///
/// # Errors
///
/// What is no mesh file; what is wrong with it; a mesh that no camera frames.
pub fn open_stream(source: &str) -> Result<StreamedScene, LoadError> {
    let path = Path::new(source);
    let Some(format) = Format::of(path) else {
        return Err(LoadError::NotStreamed { source_name: source.to_owned() });
    };
    let mut mesh = MeshStream::open(path, format)?;
    let (triangles, used) = mesh.used_positions()?;
    let framed = framed_positions(used);
    let camera = framed.map_err(|error| LoadError::Framing { path: source.to_owned(), error })?;
    let loaded = LoadedScene {
        name: stem(path),
        scene: Scene::new(Vec::new())?,
        camera,
        viewport_stated: false,
        toml: framed_mesh_toml(&camera, source),
        warnings: mesh.material_warning().iter().map(ToString::to_string).collect(),
    };
    Ok(StreamedScene { loaded, mesh, triangles })
}
