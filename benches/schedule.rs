//! How many threads each order could keep busy, on a machine of any size: the critical path of a frame against all its work.
//!
//! A frame of 1920 × 1080 pixels is drawn on one thread, and each of its tasks is timed: chunks of vertices, batches of
//! primitives, tiles. On `n` threads a stage takes as long as the longest queue of tasks, each thread taking the next one
//! when it is done; what is in no task stays serial. So the printed speed-ups leave out what threads lose to one another
//! (memory, caches), and are what the cutting of the work allows at most.
//!
//! For each number of threads, frames are cut as they are for so many; the speed-up is over the frame on one thread, as
//! that is cut. Below it stands what this machine really reaches, as far as it has the cores, for visibility and for shading.
//!
//! `cargo bench --bench schedule -- [SCENE...] [--tile ROWSxCOLUMNS]` draws built-in scenes or files; without any, some that
//! differ much. `--tile` tries other tiles in object order (powers of two).

use bothways::common::engine::simd::best_level;
use bothways::common::engine::tasks::{TaskTimes, makespan};
use bothways::common::{Camera, CameraDescription, Frame, Options, Scene, Shape, View};
use bothways::formats::generate::Kind;
use bothways::scenes::{Framing, load};
use bothways::{rasterize, raytrace};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Of so many frames the fastest counts.
const FRAMES: usize = 15;
/// Frames on several threads are shorter, and meet more that disturbs them.
const MEASURED_FRAMES: usize = 60;
const FULL_HD: [u32; 2] = [1920, 1080];
const THREADS: [usize; 4] = [2, 4, 8, 16];

fn main() -> ExitCode {
    let Some((names, tile)) = read(std::env::args().skip(1).filter(|word| word != "--bench"))
    else {
        eprintln!(
            "give names of scenes, and a tile as --tile 128x256: its sides are powers of two"
        );
        return ExitCode::from(2);
    };
    let mut cases = Vec::new();
    for name in &names {
        match loaded(name) {
            Ok((scene, camera)) => cases.push((name.clone(), scene, camera)),
            Err(error) => {
                eprintln!("{error}");
                return ExitCode::from(2);
            }
        }
    }
    if names.is_empty() {
        cases = usual();
    }
    println!(
        "{:16} {:>6} {:>6} {:>9} {:>9} {:>9}  speed-up on {THREADS:?} threads",
        "scene", "order", "tasks", "all, ms", "serial", "longest"
    );
    for (name, scene, camera) in &cases {
        let view = View::new(scene, camera);
        pool(1).install(|| predict(name, &view, tile));
        measure(name, &view, tile);
    }
    ExitCode::SUCCESS
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("there are threads")
}

/// The names of scenes, and the logarithms of a tile's rows and columns.
fn read(mut words: impl Iterator<Item = String>) -> Option<(Vec<String>, Option<[u32; 2]>)> {
    let (mut names, mut tile) = (Vec::new(), None);
    while let Some(word) = words.next() {
        if word == "--tile" {
            let sides = words.next()?;
            let (rows, columns) = sides.split_once('x')?;
            let side = |text: &str| text.parse::<u32>().ok().filter(|side| side.is_power_of_two());
            tile = Some([side(rows)?, side(columns)?].map(u32::ilog2));
        } else {
            names.push(word);
        }
    }
    Some((names, tile))
}

/// A scene and its camera at full HD.
fn loaded(name: &str) -> Result<(Scene, Camera), String> {
    let loaded = load(name).map_err(|error| error.to_string())?;
    let height = loaded.camera.viewport[1];
    let viewport = [height * 1920.0 / 1080.0, height];
    let description = CameraDescription { viewport, image: FULL_HD, ..loaded.camera };
    let camera = Camera::new(description).map_err(|error| error.to_string())?;
    Ok((loaded.scene, camera))
}

fn usual() -> Vec<(String, Scene, Camera)> {
    let mut cases = Vec::new();
    for name in ["lecture", "many", "slivers"] {
        let (scene, camera) = loaded(name).expect("it is built in");
        cases.push((name.into(), scene, camera));
    }
    let bunny = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/meshes/stanford-bunny.obj");
    if let Ok((scene, camera)) = loaded(bunny) {
        cases.push(("bunny".into(), scene, camera));
    }
    let ball = Kind::Sphere.mesh([1000, 501]).expect("a sphere has so many divisions");
    let framing = Framing { image: FULL_HD, ..Framing::default() };
    let description = framing.camera(&ball).expect("the mesh has a size");
    let camera = Camera::new(description).expect("it is a camera");
    let scene = Scene::new(vec![Shape::Mesh(ball).into()]).expect("it is a scene");
    cases.push(("sphere of 1 M".into(), scene, camera));
    cases
}

/// Draws frames in both orders on one thread, and prints how many threads each could keep busy.
fn predict(name: &str, view: &View, tile: Option<[u32; 2]>) {
    let times = Arc::new(TaskTimes::default());
    let mut frame = Frame::new(view.camera, &Options::default());
    let mut draw = object_order(view, tile, Some(&times));
    print(name, "object", &times, |threads| draw(&mut frame, threads));
    let mut draw = image_order(view, Some(&times));
    print(name, "image", &times, |threads| draw(&mut frame, threads));
}

/// Draws and shades frames in both orders on more and more threads, and prints how much faster they become.
fn measure(name: &str, view: &View, tile: Option<[u32; 2]>) {
    let mut frame = Frame::new(view.camera, &Options::default());
    let mut draw = object_order(view, tile, None);
    print_measured(name, "object", |threads| draw(&mut frame, threads));
    print_measured(name, "object shading", |_| rasterize::shade(view, &mut frame));
    let mut draw = image_order(view, None);
    print_measured(name, "image", |threads| draw(&mut frame, threads));
    print_measured(name, "image shading", |_| raytrace::shade(view, &mut frame));
}

/// Draws a frame in object order, cut for a number of threads unless a tile is given.
fn object_order<'a>(
    view: &'a View,
    tile: Option<[u32; 2]>,
    times: Option<&Arc<TaskTimes>>,
) -> impl FnMut(&mut Frame, usize) + Send + use<'a> {
    let mut prepared = rasterize::fast::prepare(view.scene);
    if let Some(times) = times {
        prepared = prepared.timed_by(times.clone());
    }
    if let Some(tile) = tile {
        prepared = prepared.drawn_with(best_level(), tile);
    }
    move |frame, threads| {
        prepared.cut_for_threads(if tile.is_some() { 0 } else { threads });
        let options = Options::default();
        rasterize::fast::determine_visibility(&prepared, view, &options, frame, &mut ());
    }
}

/// Draws a frame in image order, cut for a number of threads.
fn image_order<'a>(
    view: &'a View,
    times: Option<&Arc<TaskTimes>>,
) -> impl FnMut(&mut Frame, usize) + Send + use<'a> {
    let mut prepared = raytrace::fast::prepare(view.scene);
    if let Some(times) = times {
        prepared = prepared.timed_by(times.clone());
    }
    move |frame, threads| {
        prepared.cut_for_threads(threads);
        let options = Options::default();
        raytrace::fast::determine_visibility(&prepared, view, &options, frame, &mut ());
    }
}

/// The fastest of some frames that are cut for a number of threads.
struct Fastest {
    all: Duration,
    stages: Vec<Vec<Duration>>,
}

impl Fastest {
    fn of(frames: usize, times: &TaskTimes, mut draw: impl FnMut()) -> Fastest {
        let frames = (0..frames).map(|_| {
            let begun = Instant::now();
            draw();
            Fastest { all: begun.elapsed(), stages: times.take() }
        });
        frames.min_by_key(|frame| frame.all).expect("there are frames")
    }

    /// What is in no task.
    fn serial(&self) -> Duration {
        self.all.saturating_sub(self.stages.iter().flatten().sum())
    }

    /// How long the frame takes on so many threads.
    fn on(&self, threads: usize) -> Duration {
        self.serial() + self.stages.iter().map(|stage| makespan(stage, threads)).sum::<Duration>()
    }

    /// The longest chain: one task of each stage, after what no task does.
    fn longest(&self) -> Duration {
        let longest = self.stages.iter().filter_map(|stage| stage.iter().max());
        longest.sum::<Duration>() + self.serial()
    }
}

fn print(name: &str, order: &str, times: &TaskTimes, mut draw: impl FnMut(usize)) {
    let one = Fastest::of(FRAMES, times, || draw(1));
    let milliseconds = |time: Duration| 1e3 * time.as_secs_f64();
    let speedups = THREADS.map(|threads| {
        let frame = Fastest::of(FRAMES, times, || draw(threads));
        format!("{:5.1}", one.all.as_secs_f64() / frame.on(threads).as_secs_f64())
    });
    println!(
        "{name:16} {order:>6} {:6} {:9.3} {:9.3} {:9.3}  {}",
        one.stages.iter().map(Vec::len).sum::<usize>(),
        milliseconds(one.all),
        milliseconds(one.serial()),
        milliseconds(one.longest()),
        speedups.join(" ")
    );
}

fn print_measured(name: &str, what: &str, mut draw: impl FnMut(usize) + Send) {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut fastest = |threads| {
        // No task is timed: that would take time of its own.
        let frames = || Fastest::of(MEASURED_FRAMES, &TaskTimes::default(), || draw(threads));
        pool(threads).install(frames).all.as_secs_f64()
    };
    let one = fastest(1);
    let speedups = THREADS.map(|threads| {
        let is_possible = threads <= cores;
        if is_possible {
            format!("{:5.1}", one / fastest(threads))
        } else {
            format!("{:>5}", "–")
        }
    });
    let (milliseconds, speedups) = (1e3 * one, speedups.join(" "));
    println!("{name:15} {what:>14} {milliseconds:9.3} {:>19}  {speedups}", "measured");
}
