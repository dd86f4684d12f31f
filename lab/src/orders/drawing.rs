//! A source that can be drawn frame after frame: a scene in memory, or a mesh file that is read again for each frame.

use super::options::RenderOptions;
use super::renderer::Renderer;
use crate::common::{Camera, Executed, Frame, Observer, Options, View};
use crate::formats::mesh_stream::{MeshStream, StreamError};
use crate::progress::Steps;
use crate::rasterize::stream::{CHUNK, Canvas, Look};
use std::convert::Infallible;

/// A renderer with its source and its frame.
pub(super) trait Drawing {
    /// The reason why a frame cannot be finished.
    type Error;
    /// Finds the visible primitives, and reports the steps. A fast renderer returns what it executed.
    fn draw<O: Observer>(
        &mut self,
        observer: &mut O,
        steps: &Steps,
    ) -> Result<Option<Executed>, Self::Error>;
    /// Cuts the frames to come for the threads there are. Whether that makes a difference.
    fn cut_for_threads(&mut self) -> bool;
    /// Computes the look of the visible primitives.
    fn shade(&mut self);
    /// The last frame.
    fn into_frame(self) -> Frame;
}

/// A scene in memory.
pub(super) struct InMemory<'a, R: Renderer> {
    renderer: R,
    view: &'a View<'a>,
    options: &'a Options,
    prepared: R::Prepared,
    frame: Frame,
}

impl<'a, R: Renderer> InMemory<'a, R> {
    pub(super) fn new(
        renderer: R,
        view: &'a View<'a>,
        options: &'a RenderOptions,
        prepared: R::Prepared,
    ) -> InMemory<'a, R> {
        let RenderOptions { frame: ref options, colors_and_normals, .. } = *options;
        let frame = Frame::new(view.camera, options);
        let frame = if colors_and_normals { frame.with_colors().with_normals() } else { frame };
        InMemory { renderer, view, options, prepared, frame }
    }
}

impl<R: Renderer> Drawing for InMemory<'_, R> {
    type Error = Infallible;

    fn draw<O: Observer>(
        &mut self,
        observer: &mut O,
        steps: &Steps,
    ) -> Result<Option<Executed>, Infallible> {
        let InMemory { renderer, view, options, prepared, frame } = self;
        let executed = match steps.watch() {
            None => renderer.determine_visibility(prepared, view, options, frame, observer),
            Some(watch) => {
                let mut both = (observer.fork(), watch);
                let executed =
                    renderer.determine_visibility(prepared, view, options, frame, &mut both);
                observer.join(both.0);
                executed
            }
        };
        Ok(executed)
    }

    fn cut_for_threads(&mut self) -> bool {
        self.renderer.cut_for_threads(&mut self.prepared, rayon::current_num_threads())
    }

    fn shade(&mut self) {
        self.renderer.shade(self.view, &mut self.frame);
    }

    fn into_frame(self) -> Frame {
        self.frame
    }
}

/// A mesh file in object order. Only its vertices are in memory.
pub(super) struct Streamed<'a> {
    mesh: &'a mut MeshStream,
    camera: &'a Camera,
    look: &'a Look,
    canvas: Canvas,
}

impl<'a> Streamed<'a> {
    pub(super) fn new(
        mesh: &'a mut MeshStream,
        camera: &'a Camera,
        look: &'a Look,
        options: &RenderOptions,
    ) -> Streamed<'a> {
        let canvas = Canvas::new(camera, &options.frame);
        let canvas =
            if options.colors_and_normals { canvas.with_colors_and_normals() } else { canvas };
        Streamed { mesh, camera, look, canvas }
    }
}

impl Drawing for Streamed<'_> {
    type Error = StreamError;

    /// Runs one pass over the file: for each triangle, for each sample that the triangle may affect.
    fn draw<O: Observer>(
        &mut self,
        observer: &mut O,
        steps: &Steps,
    ) -> Result<Option<Executed>, StreamError> {
        let mut pass = self.canvas.begin(self.camera, CHUNK, observer);
        let (chunked, mut count) = (self.mesh.triangles().is_some(), 0_usize);
        self.mesh.for_each_triangle(|positions, triangle| {
            if chunked && count.is_multiple_of(CHUNK) {
                steps.begin();
            }
            count += 1;
            pass.draw(positions, triangle);
        })?;
        Ok(Some(pass.finish(self.mesh.positions())))
    }

    fn cut_for_threads(&mut self) -> bool {
        false
    }

    fn shade(&mut self) {
        self.canvas.shade(self.mesh.positions(), self.camera, self.look);
    }

    fn into_frame(self) -> Frame {
        self.canvas.into_frame()
    }
}
