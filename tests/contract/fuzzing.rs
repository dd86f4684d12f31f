//! The fuzzer finds planted faults within some hundred scenes, and shrinks each to what shows it: a primitive or two on a few
//! pixels. Sound renderers agree.

use bothways::common::{Frame, Judge, Mesh, Options, Primitive, Ray, Scene, Shape, Sign, View};
use bothways::fuzz::{self, Case, Disagreement, Event, Finding, Limit, Renderers, Summary};
use bothways::orders::{Method, Order};
use bothways::rasterize;
use std::num::NonZero;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Whether a primitive covers a sample, in a renderer that may be wrong.
type Covers = fn(&Judge, &Primitive, &Ray) -> bool;
/// Whether the primitive of the first id is seen rather than the stored one.
type Nearer = fn(&Judge, (u64, &Primitive), (u64, &Primitive), &Ray) -> bool;

/// The textbook's loop with other rules, for the primitives of these ids.
fn draw(
    view: &View,
    frame: &mut Frame,
    covers: Covers,
    nearer: Nearer,
    is_drawn: impl Fn(u64) -> bool,
) {
    frame.clear();
    let (judge, region) = (view.judge(), frame.region().clone());
    let grid = view.camera.sample_grid(frame.samples());
    for (id, primitive) in view.primitives().filter(|(id, _)| is_drawn(*id)) {
        for row in region.rows.clone() {
            for column in region.columns.clone() {
                let ray = grid.ray(row, column);
                let is_seen = covers(&judge, &primitive, &ray)
                    && frame.id(row, column).is_none_or(|stored| {
                        let other = view.primitive(stored);
                        nearer(&judge, (id, &primitive), (stored, &other), &ray)
                    });
                if is_seen {
                    frame.set(row, column, id, judge.distance(&primitive, &ray));
                }
            }
        }
    }
}

fn covers(judge: &Judge, primitive: &Primitive, ray: &Ray) -> bool {
    judge.covers(primitive, ray)
}

fn nearer(
    judge: &Judge,
    incoming: (u64, &Primitive),
    stored: (u64, &Primitive),
    ray: &Ray,
) -> bool {
    judge.nearer(incoming, stored, ray)
}

/// Every edge owns its samples.
fn with_inclusive_edges(judge: &Judge, primitive: &Primitive, ray: &Ray) -> bool {
    let covers = judge.coverage(primitive, ray);
    let Some(edges) = covers.edges else { return covers.covers };
    let Primitive::Triangle(corners) = primitive else { return covers.covers };
    let facing = judge.facing(corners, ray);
    let inside = |sign: &Sign| *sign == facing || *sign == Sign::Zero;
    covers.covers
        || (facing != Sign::Zero
            && edges.at_sample.iter().all(inside)
            && judge.distance(primitive, ray) > 0.0)
}

/// Distances are compared after rounding to `f32`, and the later primitive wins.
#[expect(clippy::cast_possible_truncation, reason = "that is the fault")]
fn by_rounded_distance(
    judge: &Judge,
    (_, incoming): (u64, &Primitive),
    (_, stored): (u64, &Primitive),
    ray: &Ray,
) -> bool {
    let [incoming, stored] =
        [incoming, stored].map(|primitive| judge.distance(primitive, ray) as f32);
    incoming <= stored
}

/// Renderers of which the fast rasterizer is another one. It draws small scenes only: it is slow.
fn broken(draw: impl Fn(&View, &Options, &mut Frame) + Send + Sync + 'static) -> Renderers {
    Renderers::sound().with(Order::Object, Method::Fast, move |view, options, frame, _| {
        let samples = view.scene.primitive_count() * frame.region().area() as u64;
        if samples <= 1 << 16 {
            draw(view, options, frame);
        } else {
            let prepared = rasterize::fast::prepare(view.scene);
            rasterize::fast::determine_visibility(&prepared, view, options, frame, &mut ());
        }
    })
}

fn run(scenes: u64, renderers: &Renderers) -> Summary {
    let options =
        fuzz::Options { seed: 1, limit: Limit::Scenes(scenes), ..fuzz::Options::default() };
    fuzz::run(&options, renderers)
}

/// The smallest finding within so many scenes, which must be there.
fn smallest(scenes: u64, renderers: &Renderers) -> Finding {
    // The run ends at the third disagreement: shrinking ten of them takes time.
    let (stop, found) = (AtomicBool::new(false), Mutex::new(0));
    let listener = |event: Event| {
        if let Event::Found(_) = event {
            let mut found = found.lock().expect("no thread panics with it");
            *found += 1;
            stop.store(*found >= 3, Ordering::Relaxed);
        }
    };
    let options = fuzz::Options {
        seed: 1,
        limit: Limit::Scenes(scenes),
        threads: NonZero::new(1),
        stop: Some(&stop),
        listener: Some(&listener),
        ..fuzz::Options::default()
    };
    let summary = fuzz::run(&options, renderers);
    println!("{}", summary.verdict());
    for finding in &summary.findings {
        println!("{}\n  {:?}", finding.about(), finding.case);
    }
    let size = |finding: &Finding| {
        let [width, height] = finding.shrunk.pixels;
        (finding.shrunk.primitives, width * height)
    };
    summary.findings.into_iter().min_by_key(size).expect("a disagreement is found")
}

/// Holds a finding against what it may have at most.
fn assert_small(finding: &Finding, primitives: u64, pixels: u32) {
    let [width, height] = finding.shrunk.pixels;
    let size = finding.shrunk;
    assert!(size.primitives <= primitives && width * height <= pixels, "{finding:#?}");
    assert_eq!(size.samples, 1);
    // The whole image is as small as what is drawn: nothing is cropped.
    assert_eq!(finding.case.crop, None);
}

#[test]
fn sound_renderers_agree() {
    let summary = run(60, &Renderers::sound());
    assert_eq!((summary.scenes, summary.disagreements, summary.ended_early), (60, 0, false));
    assert!(summary.pixels > 500_000 && summary.textbook_pixels > 20_000, "{summary:?}");
    assert!(summary.exact_ties > 10_000 && summary.exact_fallbacks > 1000, "{summary:?}");
}

#[test]
fn the_result_does_not_depend_on_threads() {
    // A renderer that fails in many scenes, so that there are findings to compare.
    let broken = broken(|view, _, frame| draw(view, frame, covers, by_rounded_distance, |_| true));
    let summary = |threads| {
        let options = fuzz::Options {
            seed: 2,
            first: 17,
            limit: Limit::Scenes(24),
            threads: NonZero::new(threads),
            ..fuzz::Options::default()
        };
        fuzz::run(&options, &broken)
    };
    let one = summary(1);
    assert!(!one.findings.is_empty());
    assert_eq!(summary(3), one);
}

#[test]
fn inclusive_edges_are_found() {
    let broken = broken(|view, _, frame| draw(view, frame, with_inclusive_edges, nearer, |_| true));
    let finding = smallest(200, &broken);
    assert_small(&finding, 1, 1);
    let Disagreement::Ids { ids, .. } = finding.disagreement else { panic!("{finding:?}") };
    assert_eq!(ids, [Some(0), None]);
}

#[test]
fn a_skipped_last_triangle_is_found() {
    let broken = broken(|view, _, frame| {
        let last = view.scene.primitive_count() - 1;
        let is_drawn = |id| id != last || view.scene.triangle(id).is_none();
        draw(view, frame, covers, nearer, is_drawn);
    });
    assert_small(&smallest(200, &broken), 1, 1);
}

#[test]
fn depths_compared_in_single_precision_are_found() {
    let broken = broken(|view, _, frame| draw(view, frame, covers, by_rounded_distance, |_| true));
    assert_small(&smallest(200, &broken), 2, 1);
}

#[test]
fn a_lost_column_of_tiles_is_found() {
    // The second tile of eight columns: no picture of fewer than nine shows it.
    let broken = broken(|view, options, frame| {
        let prepared = rasterize::fast::prepare(view.scene);
        rasterize::fast::determine_visibility(&prepared, view, options, frame, &mut ());
        for mut tile in frame.tiles_mut(usize::MAX >> 1, 8) {
            if tile.region.columns.start / 8 == 1 {
                tile.ids.clear();
            }
        }
    });
    assert_small(&smallest(200, &broken), 1, 9);
}

#[test]
fn a_fault_that_only_meshes_show_keeps_its_mesh() {
    // Triangles of a mesh of at least three are lost.
    let is_lost = |scene: &Scene, id: u64| {
        let (object, _) = scene.locate(id);
        let shape = &scene.objects()[object].shape;
        matches!(shape, Shape::Mesh(mesh) if mesh.triangles().len() >= 3)
    };
    let broken = broken(move |view, _, frame| {
        draw(view, frame, covers, nearer, |id| !is_lost(view.scene, id));
    });
    let finding = smallest(200, &broken);
    assert_small(&finding, 3, 1);
    let is_mesh = |shape: &Shape| matches!(shape, Shape::Mesh(mesh) if mesh.triangles().len() == 3);
    assert!(matches!(&finding.case.shapes[..], [mesh] if is_mesh(mesh)), "{finding:?}");
}

#[test]
fn panics_are_found() {
    let broken = broken(|view, _, frame| {
        let is_large = |mesh: &Mesh| mesh.positions().iter().any(|p| p.x.abs() > 100.0);
        let shapes = view.scene.objects().iter().map(|object| &object.shape);
        for shape in shapes {
            assert!(!matches!(shape, Shape::Mesh(mesh) if is_large(mesh)), "x is too large");
        }
        draw(view, frame, covers, nearer, |_| true);
    });
    // Their messages are results here.
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !fuzz::is_watched() {
            usual(info);
        }
    }));
    let finding = smallest(200, &broken);
    assert_small(&finding, 1, 1);
    let message = finding.disagreement.to_string();
    assert_eq!(message, "object order (fast) panicked: x is too large");
}

#[test]
fn a_finding_is_drawn_again_from_its_files() {
    let broken = broken(|view, _, frame| draw(view, frame, with_inclusive_edges, nearer, |_| true));
    let finding = smallest(200, &broken);
    let files = fuzz::scene_files(&finding, "found");
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in &files {
        std::fs::write(folder.path().join(name), content).unwrap();
    }
    let read = bothways::scenes::load(folder.path().join("found.toml").to_str().unwrap()).unwrap();
    let shapes = read.scene.objects().iter().map(|object| object.shape.clone()).collect();
    let Case { samples, crop, .. } = finding.case;
    let again = Case { shapes, camera: read.camera, samples, crop };
    assert_eq!(again, finding.case);
}

#[test]
fn a_scene_that_does_not_end_is_named() {
    static IS_RELEASED: AtomicBool = AtomicBool::new(false);
    static IS_STOPPED: AtomicBool = AtomicBool::new(false);
    let stuck = Renderers::sound().with(Order::Image, Method::Fast, |_, _, _, _| {
        while !IS_RELEASED.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(1));
        }
    });
    let events: Mutex<Vec<String>> = Mutex::default();
    let listener = |event: Event| {
        let mut events = events.lock().unwrap();
        match event {
            Event::Slow(scene) => {
                events.push(format!("slow {scene}"));
                IS_STOPPED.store(true, Ordering::Relaxed);
            }
            Event::Overdue(Summary { unfinished, .. }) => {
                events.push(format!("overdue {unfinished:?}"));
                IS_RELEASED.store(true, Ordering::Relaxed);
            }
            Event::Checked(_) | Event::Found(_) => {}
        }
    };
    let options = fuzz::Options {
        seed: 7,
        first: 40,
        threads: NonZero::new(1),
        stop: Some(&IS_STOPPED),
        patience: Duration::from_millis(30),
        listener: Some(&listener),
        ..fuzz::Options::default()
    };
    let summary = fuzz::run(&options, &stuck);
    assert_eq!(events.into_inner().unwrap(), ["slow 40", "overdue [40]"]);
    // In the end it ended.
    assert!(summary.unfinished.is_empty() && summary.scenes == 1);
}
