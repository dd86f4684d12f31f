//! `bothways render --order object --stream`: one pass over a mesh file after another, and never all
//! of it in memory.

use super::args::{MethodArg, OrderArg, RenderArgs};
use super::failure::Failure;
use super::progress::Bar;
use super::render::{Run, prepared_output, render_options, thread_pool};
use bothways::orders::render_stream;
use bothways::progress::Listener;
use bothways::report::Report;
use bothways::scenes::{StreamedScene, open_stream};
use std::process::ExitCode;
use std::time::Instant;

/// Renders, writes and prints, as the same run without `--stream`.
pub(super) fn run(args: &RenderArgs) -> Result<ExitCode, Failure> {
    check(args)?;
    let begun = Instant::now();
    let opened =
        Bar::during("reading the scene", args, || open_stream(&args.scene, args.camera.size))?;
    let StreamedScene { loaded, mut mesh, triangles, look } = opened;
    let prepare = begun.elapsed().as_secs_f64() * 1e3;
    let (camera, staging, folder) = prepared_output(args, &loaded)?;

    let bar = Bar::of_run(args);

    thread_pool(args)?.install(|| {
        let listener = bar.as_ref().map(|bar| move |progress| bar.show(progress));
        let options = render_options(args, listener.as_ref().map(|listener| listener as Listener));
        let prepare = (!args.output.no_times).then_some(prepare);
        let rendered = render_stream(&mut mesh, &camera, &look, &options, prepare);
        let rendered = vec![rendered.map_err(|error| Failure::new(error.to_string()))?];
        let threads = rayon::current_num_threads();
        let report = Report::new(&loaded.name, triangles, threads, &rendered, None);
        Run { args, about: None, rendered, comparison: None, report }.finish(staging, &folder, bar)
    })
}

/// Refuses what cannot be streamed.
fn check(args: &RenderArgs) -> Result<(), Failure> {
    let order = match args.method.order {
        OrderArg::Object => None,
        OrderArg::Both => Some("both"),
        OrderArg::Image => Some("image"),
    };
    if let Some(order) = order {
        return Err(Failure::new(format!(
            "--stream cannot be used with --order {order}: in image order every ray may need every \
             triangle, so all must be in memory; give --order object, which needs one at a time"
        )));
    }
    match args.method.method {
        MethodArg::Fast => Ok(()),
        MethodArg::Textbook => Err(Failure::new(
            "--stream cannot be used with --method textbook, whose loop walks a scene in memory; \
             leave one of them out",
        )),
    }
}
