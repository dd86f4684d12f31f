//! What is rendered.

use super::order::{Method, Order};
use crate::common::{Camera, Options, View};
use crate::formats::mesh_stream::MeshStream;
use crate::rasterize::stream::{CHUNK, Look};
use std::time::Duration;

/// What is rendered.
#[derive(Debug)]
pub enum Source<'a> {
    /// A scene in memory.
    View(View<'a>),
    /// A mesh file of which only the vertices are in memory: for object order by the fast method.
    Stream {
        /// The file.
        mesh: &'a mut MeshStream,
        /// From where it is seen.
        camera: &'a Camera,
        /// Its material and its light.
        look: &'a Look,
        /// How long it took to open the file and to read its vertices: it counts as preparing.
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

    /// The steps of one frame that can be told of, if there are any: of a textbook those of its outer loop, of a
    /// stream its chunks of triangles.
    pub(super) fn steps_of_a_frame(
        &self,
        order: Order,
        method: Method,
        options: &Options,
    ) -> Option<u64> {
        match (self, method, order) {
            // Until all triangles were read once, their number is not known.
            (Source::Stream { mesh, .. }, ..) => {
                mesh.triangles().map(|count| u64::from(count).div_ceil(CHUNK as u64).max(1))
            }
            (Source::View(_), Method::Fast, _) => None,
            (Source::View(view), Method::Textbook, Order::Object) => {
                Some(view.scene.primitive_count().into())
            }
            (Source::View(view), Method::Textbook, Order::Image) => {
                let rows = options.pixels(view.camera.image()).height;
                Some(u64::from(rows) * u64::from(options.samples))
            }
        }
    }
}
