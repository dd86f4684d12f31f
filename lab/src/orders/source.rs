//! The input of rendering.

use super::order::{Method, Order};
use crate::common::{Camera, Options, View};
use crate::formats::mesh_stream::MeshStream;
use crate::rasterize::stream::{CHUNK, Look};
use std::time::Duration;

/// The input of rendering.
#[derive(Debug)]
pub enum Source<'a> {
    /// A scene in memory.
    View(View<'a>),
    /// A mesh file with only its vertices in memory, for object order with the fast method.
    Stream {
        /// The mesh file.
        mesh: &'a mut MeshStream,
        /// The camera.
        camera: &'a Camera,
        /// The material and the light of the mesh.
        look: &'a Look,
        /// The time for opening the file and reading its vertices: this time is part of the preparation.
        opening: Duration,
    },
}

impl<'a> From<&View<'a>> for Source<'a> {
    fn from(view: &View<'a>) -> Self {
        Source::View(*view)
    }
}

impl Source<'_> {
    pub(super) fn camera(&self) -> &Camera {
        match self {
            Source::View(view) => view.camera,
            Source::Stream { camera, .. } => camera,
        }
    }

    /// The steps of one frame for the progress, if there are any: the steps of a textbook's outer loop, or the
    /// triangle chunks of a stream.
    pub(super) fn steps_of_a_frame(
        &self,
        order: Order,
        method: Method,
        options: &Options,
    ) -> Option<u64> {
        match (self, method, order) {
            // The number of triangles is unknown until all triangles have been read once.
            (Source::Stream { mesh, .. }, ..) => {
                mesh.triangles().map(|count| u64::from(count).div_ceil(CHUNK as u64).max(1))
            }
            (Source::View(_), Method::Fast, _) => None,
            (Source::View(view), Method::Textbook, Order::Object) => {
                Some(view.scene.primitive_count())
            }
            (Source::View(view), Method::Textbook, Order::Image) => {
                let rows = options.pixels(view.camera.image()).height;
                Some(u64::from(rows) * u64::from(options.samples))
            }
        }
    }
}
