//! Draws the time of a frame in both orders as charts: against triangles, and against pixels.
//!
//! `cargo bench --bench cost_curves -- FOLDER` measures, prints every measurement, and writes `cost-triangles.svg` and
//! `cost-pixels.svg`; without FOLDER, into `target/cost-curves`.
//!
//! The scene is a sphere, which is wholly visible, on one thread. A measurement is the median of some frames of visibility
//! after a warm-up, as `render --repeat` takes it. Each point of a chart is the least of several rounds over all points,
//! so that short disturbances by other programs do not show. `BOTHWAYS_LONG=1` continues to 8 million triangles.

mod chart;

use bothways::common::engine::simd::best_level;
use bothways::common::{Camera, Scene, Shape, View};
use bothways::formats::generate::Kind;
use bothways::orders::{self, Method, Order, RenderOptions};
use bothways::scenes::Framing;
use chart::{Chart, Curve};
use std::path::Path;
use std::process::ExitCode;

const FULL_HD: [u32; 2] = [1920, 1080];
/// The divisions of the sphere for the chart against pixels: 100 thousand triangles.
const FIXED: [u32; 2] = [316, 159];
const REPEAT: u32 = 15;
const ROUNDS: usize = 5;

/// The divisions of the spheres for the chart against triangles: from 80 triangles to 1 million, then 8 million.
const SPHERES: [[u32; 2]; 7] =
    [[10, 5], [32, 17], [100, 51], [178, 90], FIXED, [1000, 501], [2828, 1415]];
const IMAGES: [[u32; 2]; 6] =
    [[160, 90], [320, 180], [640, 360], [1280, 720], FULL_HD, [3840, 2160]];

/// The colours of the difference picture, on light pages and on dark ones.
const COLORS: [(Order, [&str; 2]); 2] =
    [(Order::Object, ["#b87600", "#e69f00"]), (Order::Image, ["#0072b2", "#56b4e9"])];

fn main() -> ExitCode {
    // Cargo adds the argument `--bench`.
    let folder = std::env::args().skip(1).find(|word| word != "--bench");
    let default = concat!(env!("CARGO_MANIFEST_DIR"), "/target/cost-curves");
    let folder = folder.unwrap_or_else(|| default.into());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let drawn = pool.expect("there is a thread").install(|| draw(Path::new(&folder)));
    match drawn {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{folder}: {error}; name a folder that can be written");
            ExitCode::from(2)
        }
    }
}

/// Measures, and writes both charts.
fn draw(folder: &Path) -> std::io::Result<()> {
    // Done first, because the measurements take minutes.
    std::fs::create_dir_all(folder)?;
    let level = format!("{:?}", best_level());
    let level = level.split('(').next().unwrap_or_default();
    let long = std::env::var_os("BOTHWAYS_LONG").is_some();
    let spheres = if long { &SPHERES[..] } else { &SPHERES[..SPHERES.len() - 1] };

    let curves =
        curves(spheres.iter().map(|divisions| (*divisions, FULL_HD)), |triangles, _| triangles);
    let chart = Chart {
        title: "A frame against its triangles".into(),
        note: format!("sphere, 1920 × 1080 pixels, one thread, {level}"),
        x: "triangles",
        y: "milliseconds a frame",
        curves,
    };
    write(folder, "cost-triangles.svg", &chart.svg())?;

    let curves = self::curves(IMAGES.iter().map(|image| (FIXED, *image)), |_, pixels| pixels);
    let chart = Chart {
        title: "A frame against its pixels".into(),
        note: format!("sphere of 100 k triangles, one thread, {level}"),
        x: "pixels",
        curves,
        ..chart
    };
    write(folder, "cost-pixels.svg", &chart.svg())
}

/// Measures both orders on spheres in images; `x` chooses between triangles and pixels.
fn curves(
    cases: impl Iterator<Item = ([u32; 2], [u32; 2])> + Clone,
    x: impl Fn(f64, f64) -> f64,
) -> Vec<Curve> {
    let curve = |(order, colors): (Order, _)| Curve { name: order.name(), colors, points: vec![] };
    let mut curves = COLORS.map(curve);
    for round in 0..ROUNDS {
        for (point, (divisions, image)) in cases.clone().enumerate() {
            let (triangles, times) = measure(divisions, image);
            let pixels = f64::from(image[0] * image[1]);
            for (curve, time) in curves.iter_mut().zip(times) {
                if round == 0 {
                    curve.points.push([x(triangles as f64, pixels), time]);
                }
                let least = &mut curve.points[point][1];
                *least = least.min(time);
            }
        }
    }
    curves.into()
}

/// The triangles of a sphere, and the milliseconds of a frame in each order.
fn measure(divisions: [u32; 2], [width, height]: [u32; 2]) -> (usize, [f64; 2]) {
    let mesh = Kind::Sphere.mesh(divisions).expect("a sphere has so many divisions");
    let triangles = mesh.triangles().len();
    let framing = Framing { image: [width, height], ..Framing::default() };
    let camera = framing.camera(&mesh).expect("a sphere has a size");
    let camera = Camera::new(camera).expect("it is a camera");
    let scene = Scene::new(vec![Shape::Mesh(mesh).into()]).expect("it is a scene");
    let times = COLORS.map(|(order, _)| {
        let options = RenderOptions { repeat: Some(REPEAT), ..RenderOptions::default() };
        let view = View::new(&scene, &camera);
        let rendered =
            orders::render(order, Method::Fast, &view, &options).expect("it is in memory");
        let time = rendered.times.expect("it was timed").visibility.median;
        println!("{}, {triangles} triangles, {width}x{height}: {time} ms", order.name());
        time
    });
    (triangles, times)
}

/// Writes a file under a temporary name, then renames it: no program can read half of it.
fn write(folder: &Path, name: &str, text: &str) -> std::io::Result<()> {
    let partial = folder.join(format!(".{name}.partial"));
    std::fs::write(&partial, text)?;
    std::fs::rename(partial, folder.join(name))?;
    println!("{}", folder.join(name).display());
    Ok(())
}
