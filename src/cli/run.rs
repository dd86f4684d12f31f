//! `bothways render`: from a scene to the output folder and the verdict.

use super::args::{BuffersArg, MethodArg, OnlyArg, OrderArg, RenderArgs, check_narrow};
use super::camera::{camera, squashed};
use super::failure::Failure;
use super::output::{NewFile, Out, Staging};
use super::patience::Patience;
use super::progress::Bar;
use super::thread_pool::thread_pool;
use super::{exr, memory, npy, table, terminal};
use bothways::common::raster::check_samples;
use bothways::common::{Camera, View};
use bothways::diff::{Comparison, compare_shown};
use bothways::figure::{Slide, Theme};
use bothways::orders::{self, Order, RenderOptions, Rendered};
use bothways::picture::{enlarged, id_picture, mask, picture};
use bothways::progress::Listener;
use bothways::report::Report;
use bothways::scenes::{self, LoadedScene, OpenedScene};
use bothways::verify::{self, Verified};
use image::RgbImage;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The width of the slide beside the pictures, in pixels.
const SLIDE_WIDTH: u32 = 1920;

/// Renders, writes and prints; the exit code is 0 if both orders see the same primitives (or if one order ran), 1
/// otherwise.
pub(super) fn run(args: &RenderArgs) -> Result<ExitCode, Failure> {
    check_rules(args)?;
    check_only(args)?;
    let stream = args.method.stream;
    if stream {
        check_stream(args)?;
    }
    let mut scene = Bar::during("reading the scene", args, || {
        scenes::open(&args.scene, args.files.options(args.camera.size), stream)
    })?;
    for rule in [Order::Object, Order::Image].map(|order| args.method.rules().of(order)) {
        let Some(rule) = rule else { continue };
        let loaded = scene.loaded();
        check_narrow(&loaded.scene, &loaded.name, &format!("{} draws", rule.option()))?;
    }
    check_verify(args)?;
    let (camera, staging, folder) = prepared_output(args, scene.loaded())?;
    let pool = thread_pool(args.method.threads.unwrap_or(0).into())?;
    let bar = Bar::of_run(args);
    pool.install(|| {
        let run = Run::new(args, &mut scene, &camera, bar.as_ref())?;
        run.finish(staging, &folder, bar)
    })
}

/// Refuses options that do not work with the rules of ordinary renderers.
fn check_rules(args: &RenderArgs) -> Result<(), Failure> {
    for order in [Order::Object, Order::Image] {
        let Some(rule) = args.method.rules().of(order) else { continue };
        let given = format!("{} {rule}", rule.option());
        let refused = if !args.method.order.orders().contains(&order) {
            format!("{given} is for {}, which --order leaves out; drop one of them", order.name())
        } else if args.method.method == MethodArg::Textbook {
            format!(
                "{given} cannot be used with --method textbook, which is exact; leave one of them out"
            )
        } else if args.method.stream {
            format!("{given} cannot be used with --stream, which is exact; leave one of them out")
        } else if args.method.verify.is_some() {
            format!(
                "{given} cannot be used with --verify, which holds exact renderers against their textbook; \
                 leave one of them out"
            )
        } else {
            continue;
        };
        return Err(Failure::new(refused));
    }
    Ok(())
}

/// Refuses to write nothing but what shows both orders where one is drawn: the files of an earlier run would be removed for it.
fn check_only(args: &RenderArgs) -> Result<(), Failure> {
    let of_both = [(OnlyArg::Difference, "difference"), (OnlyArg::Slide, "slide")];
    let asked = of_both.into_iter().find(|(what, _)| args.output.only.contains(what));
    let ([order], Some((_, name))) = (args.method.order.orders(), asked) else { return Ok(()) };
    Err(Failure::new(format!(
        "--only {name} shows both orders, and --order draws {} alone; leave one of them out",
        order.name()
    )))
}

/// Refuses options that do not work with a stream.
fn check_stream(args: &RenderArgs) -> Result<(), Failure> {
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

/// The camera and the output folder, checked before the work: the user does not wait for pictures that cannot be
/// written. This function also warns about missing parts of the scene.
fn prepared_output(
    args: &RenderArgs,
    loaded: &LoadedScene,
) -> Result<(Camera, Staging, PathBuf), Failure> {
    if !args.output.quiet {
        terminal::warn(&loaded.warnings);
    }
    let camera = camera(loaded, &args.camera)?;
    check_samples(camera.image(), args.method.samples)
        .map_err(|error| Failure::new(format!("--samples {}: {error}", args.method.samples)))?;
    let options = args.method.options();
    let checked = options.pixels(camera.image()).check(camera.image());
    checked.map_err(|error| Failure::new(format!("--crop: {error}")))?;
    memory::check(&camera, args)?;
    let folder = match &args.output.folder {
        Some(folder) => folder.clone(),
        None => Path::new("out").join(folder_name(&loaded.name)),
    };
    let staging = Staging::begin(&folder)?;
    if let Some(hint) = squashed(&camera, &args.camera).filter(|_| !args.output.quiet) {
        anstream::eprintln!("hint: {hint}");
    }
    Ok((camera, staging, folder))
}

/// Refuses `--verify` with the textbook method: a comparison of the textbook with itself has no use.
fn check_verify(args: &RenderArgs) -> Result<(), Failure> {
    if args.method.verify.is_some() && args.method.method == MethodArg::Textbook {
        return Err(Failure::new(
            "--verify holds the fast method against the textbook, which --method textbook is; leave one of \
             them out",
        ));
    }
    Ok(())
}

/// The name of a scene's folder below `out`: the scene's name, unless that name leads to another folder (a file may
/// have the name `...toml`) or cannot be typed.
pub(super) fn folder_name(name: &str) -> String {
    let typed = |c: char| if c.is_control() || "/\\:".contains(c) { '_' } else { c };
    if name.bytes().all(|byte| byte == b'.') {
        "scene".into()
    } else {
        name.chars().map(typed).collect()
    }
}

/// The options for one order.
fn render_options<'a>(args: &RenderArgs, progress: Option<Listener<'a>>) -> RenderOptions<'a> {
    RenderOptions {
        frame: args.method.options(),
        rules: args.method.rules(),
        repeat: args.method.repeat,
        no_counts: !args.output.counts(),
        no_times: args.output.no_times,
        colors_and_normals: args.output.buffers == BuffersArg::Exr,
        progress,
    }
}

/// The results of the rendering.
struct Run<'a> {
    args: &'a RenderArgs,
    /// The scene in one line.
    about: Option<&'a str>,
    rendered: Vec<Rendered>,
    /// The picture of each order.
    pictures: Vec<RgbImage>,
    comparison: Option<Comparison>,
    camera: &'a Camera,
    /// The work at each sample of each order, for `buffers.exr` and where it was counted.
    works: Vec<Option<Vec<f32>>>,
    report: Report,
}

impl<'a> Run<'a> {
    fn new(
        args: &'a RenderArgs,
        scene: &'a mut OpenedScene,
        camera: &'a Camera,
        bar: Option<&Bar>,
    ) -> Result<Run<'a>, Failure> {
        let listener = bar.map(|bar| move |progress| bar.show(progress));
        let options = render_options(args, listener.as_ref().map(|listener| listener as Listener));
        let method = args.method.method.into();
        let mut rendered = Vec::new();
        for &order in args.method.order.orders() {
            let one = orders::render(order, method, scene.source(camera), &options);
            rendered.push(one.map_err(|error| Failure::new(error.to_string()))?);
        }
        let scene = &*scene;
        bar.inspect(|bar| bar.say("comparing and drawing"));
        let pictures: Vec<RgbImage> = rendered.iter().map(|one| picture(&one.frame)).collect();
        let comparison = match (rendered.as_slice(), pictures.as_slice()) {
            ([object_order, image_order], [by_object, by_image]) => {
                let frames = [&object_order.frame, &image_order.frame];
                Some(compare_shown(frames, [by_object, by_image]))
            }
            _ => None,
        };
        let mut report = Report::new(
            &scene.loaded().name,
            scene.primitive_count(),
            rayon::current_num_threads(),
            &rendered,
            comparison.as_ref(),
        );
        if let (Some(samples), OpenedScene::InMemory(loaded)) = (args.method.verify, scene) {
            let view = View::new(&loaded.scene, camera);
            let pixels_of = |one: &Rendered| verify::pixels(&one.frame, samples.into());
            let patience = Patience::new(rendered.iter().map(pixels_of).sum(), bar);
            let verified = verify::verify(&view, &rendered, samples.into(), &|| patience.step());
            report.verified = Some(verified);
        }
        let works = match scene {
            OpenedScene::InMemory(loaded) if args.output.buffers == BuffersArg::Exr => {
                let view = View::new(&loaded.scene, camera);
                rendered.iter().map(|one| exr::work(&view, one)).collect()
            }
            _ => vec![None; rendered.len()],
        };
        let about = scene.loaded().about();
        Ok(Run { args, about, rendered, pictures, comparison, camera, works, report })
    }

    /// Writes everything, and prints the report.
    fn finish(
        &self,
        mut staging: Staging,
        folder: &Path,
        bar: Option<Bar>,
    ) -> Result<ExitCode, Failure> {
        let json = self.report.to_json().map_err(|error| Failure::new(error.to_string()))?;
        let layers: Vec<exr::Layer> = self.layers().collect();
        staging.write_all(self.files(&json, &layers))?;
        staging.commit()?;
        // The bar ends before any text is printed to the same terminal.
        drop(bar);

        if self.args.output.json {
            terminal::print(&json)?;
        } else if !self.args.output.quiet {
            let comparison = self.comparison.as_ref();
            terminal::print(&table::table(&self.report, &self.rendered, comparison, folder))?;
        }
        Ok(ExitCode::from(status(self.comparison.as_ref(), self.report.verified.as_ref())))
    }

    /// The layers of `buffers.exr`.
    fn layers(&self) -> impl Iterator<Item = exr::Layer<'_>> {
        self.rendered.iter().zip(&self.works).map(|(one, work)| exr::Layer {
            order: one.order,
            frame: &one.frame,
            work: work.as_deref(),
        })
    }

    /// The files of the run, those first that take longest.
    fn files<'b>(&'b self, json: &'b str, layers: &'b [exr::Layer<'b>]) -> Vec<NewFile<'b>> {
        let wants = |what| self.args.output.wants(what);
        let mut files = Vec::new();
        if let ([object_order, image_order], [by_object, by_image], Some(comparison)) =
            (self.rendered.as_slice(), self.pictures.as_slice(), &self.comparison)
        {
            let slide = Slide {
                scene: &self.report.scene,
                about: self.about,
                primitives: self.report.primitives,
                threads: self.report.threads,
                object_order,
                image_order,
                pictures: [by_object, by_image],
                comparison,
            };
            if wants(OnlyArg::Slide) {
                let drawing = move || slide.draw(Theme::Dark);
                files.push(NewFile::drawing("side-by-side.png", drawing, SLIDE_WIDTH));
            }
            let difference = move || {
                let difference = comparison.classes().picture(by_object);
                // For a crop, the picture has the size of the crop, as all output has.
                let whole = object_order.frame.crop().is_none();
                if whole { enlarged(difference) } else { difference }
            };
            if wants(OnlyArg::Difference) {
                files.push(NewFile::rgb("difference.png", difference));
            }
        }
        if self.args.output.buffers == BuffersArg::Exr {
            let content = |out: &mut _| exr::write(layers, self.camera, out);
            files.push(NewFile::seekable(exr::NAME, content));
        }
        for (Rendered { order, frame, .. }, picture) in self.rendered.iter().zip(&self.pictures) {
            let stem = order.file_stem();
            if wants(OnlyArg::Picture) {
                files.push(NewFile::finished_rgb(format!("{stem}.png"), picture));
            }
            if wants(OnlyArg::Mask) {
                files.push(NewFile::grey(format!("mask-{stem}.png"), || mask(frame)));
            }
            if self.args.output.buffers == BuffersArg::Npy {
                files.push(NewFile::rgb(format!("{stem}.ids.png"), || id_picture(frame)));
                let ids = |out: &mut Out| npy::write_ids(frame, out);
                files.push(NewFile::new(format!("{stem}.ids.npy"), ids));
                let distances = |out: &mut Out| npy::write_distances(frame, out);
                files.push(NewFile::new(format!("{stem}.t.npy"), distances));
            }
        }
        if wants(OnlyArg::Report) {
            files.push(NewFile::new("report.json", |out| out.write_all(json.as_bytes())));
        }
        files
    }
}

/// The exit code of a run without errors: one order alone can differ from its textbook only.
fn status(comparison: Option<&Comparison>, verified: Option<&Verified>) -> u8 {
    let differs = !comparison.is_none_or(Comparison::matches);
    u8::from(differs || verified.is_some_and(|verified| !verified.matches))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways::common::{Frame, Options};
    use bothways::diff::compare;

    #[test]
    fn no_scene_s_folder_lies_outside_of_out() {
        for (name, folder) in [
            ("bunny", "bunny"),
            ("a b.c", "a b.c"),
            ("-x", "-x"),
            ("", "scene"),
            (".", "scene"),
            ("..", "scene"),
            ("...", "scene"),
            ("../up", ".._up"),
            ("a\nb\\c:d\u{9b}", "a_b_c_d_"),
        ] {
            assert_eq!(folder_name(name), folder, "{name:?}");
        }
    }

    #[test]
    fn a_difference_is_exit_code_1() {
        let nothing = Frame::new(&Camera::canonical(2, 2), &Options::default());
        let mut something = nothing.clone();
        something.set(1, 1, 0, 1.0);
        assert_eq!(status(Some(&compare(&nothing, &something)), None), 1);
        assert_eq!(status(Some(&compare(&something, &something)), None), 0);
        assert_eq!(status(None, None), 0);
    }
}
