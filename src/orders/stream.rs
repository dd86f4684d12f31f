//! Object order of a mesh that is streamed, measured as the others are.

use super::{Method, Order, Rendered, Spread, Times, timed};
use crate::common::stream::{MeshStream, StreamError};
use crate::common::{Camera, Observer, Options, Work};
use crate::rasterize::stream::{CHUNK, Canvas};

/// Renders a mesh that is streamed, in object order, on the rayon pool that this is called in.
///
/// The work is counted in a pass over the file of its own. If times are wanted, another pass is timed,
/// or with `repeat` so many after one to warm up; its visibility holds the reading of all faces.
/// `prepare` is how many milliseconds the vertices took; without it, no times are measured.
///
/// # Errors
///
/// What is wrong with the file.
///
/// # Panics
///
/// If `repeat` is 0, or the camera does not allow this number of samples.
pub fn render_stream(
    mesh: &mut MeshStream,
    camera: &Camera,
    options: &Options,
    repeat: Option<u32>,
    prepare: Option<f64>,
) -> Result<Rendered, StreamError> {
    let mut canvas = Canvas::new(camera, options);
    let mut work = Work::default();
    draw(mesh, &mut canvas, camera, &mut work)?;
    let Some(prepare) = prepare else {
        canvas.shade(mesh.positions(), camera);
        return Ok(rendered(canvas, work, None));
    };
    if repeat.is_some() {
        draw(mesh, &mut canvas, camera, &mut ())?;
        canvas.shade(mesh.positions(), camera);
    }
    let (mut visibility, mut shading) = (Vec::new(), Vec::new());
    for _ in 0..repeat.unwrap_or(1) {
        let (drawn, time) = timed(|| draw(mesh, &mut canvas, camera, &mut ()));
        drawn?;
        visibility.push(time);
        let ((), time) = timed(|| canvas.shade(mesh.positions(), camera));
        shading.push(time);
    }
    let times = Times {
        prepare: Spread::of(vec![prepare]),
        visibility: Spread::of(visibility),
        shading: Spread::of(shading),
    };
    Ok(rendered(canvas, work, Some(times)))
}

/// One pass: for each triangle in the file, for each sample it may affect.
fn draw(
    mesh: &mut MeshStream,
    canvas: &mut Canvas,
    camera: &Camera,
    observer: &mut impl Observer,
) -> Result<(), StreamError> {
    let mut pass = canvas.begin(camera, CHUNK, observer);
    mesh.for_each_triangle(|positions, triangle| pass.draw(positions, triangle))?;
    pass.finish(mesh.positions());
    Ok(())
}

fn rendered(canvas: Canvas, work: Work, times: Option<Times>) -> Rendered {
    let frame = canvas.into_frame();
    Rendered { order: Order::Object, method: Method::Fast, frame, work, times }
}
