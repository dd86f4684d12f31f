//! Object order of a mesh that is streamed, measured as the others are.

use super::{
    Counting, Counts, Method, Order, Part, RenderOptions, Rendered, Spread, Times, repeated,
};
use crate::common::{Camera, Observer};
use crate::formats::mesh_stream::{MeshStream, StreamError};
use crate::progress::Steps;
use crate::rasterize::stream::{CHUNK, Canvas, Look};
use std::sync::atomic::AtomicU64;

/// Renders a mesh that is streamed, in object order, on the rayon pool that this is called in.
///
/// The work is counted in a pass over the file of its own, if it is to be counted. If times are wanted, another pass is timed,
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
    look: &Look,
    options: &RenderOptions,
    prepare: Option<f64>,
) -> Result<Rendered, StreamError> {
    // As long as nobody knows how many triangles there are, passes count as a whole.
    let chunks = mesh.triangles().map(|count| u64::from(count).div_ceil(CHUNK as u64).max(1));
    let done = AtomicU64::new(0);
    let counting = Counting::new(camera, options);
    let passes = if prepare.is_some() { options.frames(&counting) } else { 1 };
    let steps = Steps::new(Order::Object, options.progress, chunks, passes, &done);
    let mut canvas = Canvas::new(camera, &options.frame);

    steps.preparing();
    steps.frames_done(0);
    let work = counting.count(|work| draw(mesh, &mut canvas, camera, work, &steps))?;
    steps.frames_done(counting.frames());
    let Some(prepare) = prepare else {
        if counting.frames() == 0 {
            draw(mesh, &mut canvas, camera, &mut (), &steps)?;
            steps.frames_done(1);
        }
        canvas.shade(mesh.positions(), camera, look);
        return Ok(rendered(canvas, work, None));
    };
    let run = |part| {
        match part {
            Part::Visibility => draw(mesh, &mut canvas, camera, &mut (), &steps)?,
            Part::Shading => canvas.shade(mesh.positions(), camera, look),
        }
        Ok::<_, StreamError>(())
    };
    let [visibility, shading] = repeated(options.repeat, &steps, run)?;
    let times = Times { prepare: Spread::of(vec![prepare]), visibility, shading };
    Ok(rendered(canvas, work, Some(times)))
}

/// One pass: for each triangle in the file, for each sample it may affect.
fn draw(
    mesh: &mut MeshStream,
    canvas: &mut Canvas,
    camera: &Camera,
    observer: &mut impl Observer,
    steps: &Steps,
) -> Result<(), StreamError> {
    let mut pass = canvas.begin(camera, CHUNK, observer);
    let (chunked, mut count) = (mesh.triangles().is_some(), 0_usize);
    mesh.for_each_triangle(|positions, triangle| {
        if chunked && count.is_multiple_of(CHUNK) {
            steps.begin();
        }
        count += 1;
        pass.draw(positions, triangle);
    })?;
    pass.finish(mesh.positions());
    Ok(())
}

fn rendered(canvas: Canvas, work: Counts, times: Option<Times>) -> Rendered {
    let frame = canvas.into_frame();
    Rendered { order: Order::Object, method: Method::Fast, frame, work, times }
}
