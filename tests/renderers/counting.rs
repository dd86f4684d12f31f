//! The counting of work: counts by event equal counts by sums, as long as the work is within bounds, and counting
//! does not change the frame.

use assert_cmd::Command;
use bothways::common::glam::Vec3;
use bothways::common::observe::budget::{Budget, WorkWithin};
use bothways::common::observe::{Events, Question};
use bothways::common::raster::Region;
use bothways::common::raster::Sample;
use bothways::common::{
    Frame, Mesh, Observer, Options, Projection, Scene, Shape, Sphere, View, Work,
};
use bothways::orders::{self, Counts, Method, Order, RenderOptions};
use bothways::report::Report;
use bothways::{rasterize, raytrace, scenes};
use bothways_test_support::{Dice, PROJECTIONS, crowd, mesh, scene, turned};
use predicates::str::contains;

/// An observer that counts as [`Work`] does, but requires every single event.
#[derive(Clone, Debug, Default)]
struct OneByOne(Work);

impl Observer for OneByOne {
    fn fork(&self) -> Self {
        OneByOne::default()
    }

    fn join(&mut self, part: Self) {
        self.0.join(part.0);
    }
}

impl Events for OneByOne {
    fn primitive_begun(&mut self, primitive: u64, region: &Region) {
        self.0.primitive_begun(primitive, region);
    }

    fn ray_begun(&mut self, sample: Sample) {
        self.0.ray_begun(sample);
    }

    fn node_opened(&mut self, sample: Sample, node: u32, entered: bool) {
        self.0.node_opened(sample, node, entered);
    }

    fn sample_tested(&mut self, sample: Sample, primitive: u64) {
        self.0.sample_tested(sample, primitive);
    }

    fn fragment(&mut self, sample: Sample, primitive: u64) {
        self.0.fragment(sample, primitive);
    }

    fn depth_test(&mut self, sample: Sample, incoming: u64, stored: u64, replaced: bool) {
        self.0.depth_test(sample, incoming, stored, replaced);
    }

    fn judged(&mut self, sample: Sample, question: Question) {
        self.0.judged(sample, question);
    }
}

/// The frame of one order's `fast` renderer, drawn with an observer.
fn watched<O: Observer>(order: Order, view: &View, options: &Options, watcher: &mut O) -> Frame {
    let mut frame = Frame::new(view.camera, options);
    match order {
        Order::Object => {
            let prepared = rasterize::fast::prepare(view.scene);
            rasterize::fast::determine_visibility(&prepared, view, options, &mut frame, watcher);
        }
        Order::Image => {
            let prepared = raytrace::fast::prepare(view.scene);
            raytrace::fast::determine_visibility(&prepared, view, options, &mut frame, watcher);
        }
    }
    frame
}

/// Needles through the whole scene, each of them long and in its own direction.
fn needles(count: u32) -> Mesh {
    let mut dice = Dice(7);
    let mut positions = Vec::new();
    for _ in 0..count {
        let [from, to] = [(); 2].map(|()| dice.point());
        positions.extend([from, to, to + 0.005 * dice.point()]);
    }
    let triangles = (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Mesh::new(positions, triangles).expect("it is a mesh")
}

/// The same triangle again and again, and others in its plane.
fn ties(count: u32) -> Scene {
    let corner = |k: u32| {
        let turn = 0.1 * k as f32;
        Vec3::new(turn.cos(), turn.sin(), 0.0)
    };
    let positions: Vec<Vec3> = (0..63).map(corner).collect();
    let triangles = (0..count).map(|k| [k % 7, k % 7 + 20, k % 7 + 40]).collect();
    scene(vec![mesh(Mesh::new(positions, triangles).expect("it is a mesh"))])
}

fn some_scenes() -> Vec<Scene> {
    let ball = Shape::Sphere(Sphere { center: Vec3::new(0.2, 0.1, 0.3), radius: 0.4 });
    // Rays are walked in squares, but not those that meet instances, as in a crowd; many of the triangles of `many` lie
    // between the samples.
    let built_in = ["overlap", "ties", "slivers", "inside", "many"];
    let built_in = built_in.map(|name| scenes::load(name).expect("it is built in").scene);
    let others = [scene(vec![mesh(needles(300)), ball.into()]), ties(200), crowd(1).0];
    built_in.into_iter().chain(others).collect()
}

#[test]
fn sums_are_those_of_the_events() {
    for (k, scene) in some_scenes().iter().enumerate() {
        for projection in PROJECTIONS {
            let camera = turned(projection, [0.4, 0.3, 2.5], [0.0; 3], [147, 90]);
            let view = View::new(scene, &camera);
            for order in [Order::Object, Order::Image] {
                let (mut sums, mut events) = (Work::default(), OneByOne::default());
                let options = Options::default();
                let frames = [
                    watched(order, &view, &options, &mut sums),
                    watched(order, &view, &options, &mut events),
                ];
                let what = format!("scene {k}, {projection:?}, {}", order.name());
                assert_eq!(sums, events.0, "{what}");
                assert!(sums.fragments > 0, "{what}");
                assert_eq!(frames[0], frames[1], "{what}");
            }
        }
    }
}

/// Tiles of rays that miss all boxes are counted without a walk; the sums are those of the walk.
#[test]
fn rays_that_miss_everything_count_what_they_test() {
    let somewhere = |mesh: &Mesh, by: Vec3| {
        let positions = mesh.positions().iter().map(|position| 0.2 * position + by).collect();
        Mesh::new(positions, mesh.triangles().to_vec()).expect("it is a mesh")
    };
    let needles = needles(500);
    let mut missed = 0;
    for (k, by) in
        [[0.0; 3], [1.5, 0.5, 0.0], [0.0, 0.0, 2.6], [-0.4, 0.2, 40.0]].iter().enumerate()
    {
        let scene = scene(vec![mesh(somewhere(&needles, Vec3::from(*by)))]);
        for projection in PROJECTIONS {
            for distance in [0.3, 3.0, 1e3, 1e6] {
                let camera =
                    turned(projection, [0.1 * distance, 0.0, distance], [0.0; 3], [230, 170]);
                let (view, options) = (View::new(&scene, &camera), Options::default());
                let (mut sums, mut events) = (Work::default(), OneByOne::default());
                let frame = watched(Order::Image, &view, &options, &mut sums);
                watched(Order::Image, &view, &options, &mut events);
                assert_eq!(sums, events.0, "mesh {k}, {projection:?} from {distance}");
                missed += frame.ids().len() - frame.ids().covered();
            }
        }
    }
    assert!(missed > 1_000_000, "{missed}");
}

#[test]
fn a_budget_decides_by_the_work_alone_and_changes_no_frame() {
    for (k, scene) in some_scenes().iter().enumerate() {
        for order in [Order::Object, Order::Image] {
            let camera = turned(Projection::Perspective, [0.4, 0.3, 2.5], [0.0; 3], [147, 90]);
            let (view, options) = (View::new(scene, &camera), Options::default());
            let mut work = Work::default();
            let expected = watched(order, &view, &options, &mut work);
            let steps = work.steps();
            for (most, is_counted) in
                [(steps, true), (steps - 1, false), (steps / 3, false), (0, false)]
            {
                for threads in [1, 3] {
                    let budget = Budget::new(most);
                    let mut within = WorkWithin::new(&budget);
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                    let pool = pool.expect("there are threads");
                    let frame = pool.install(|| watched(order, &view, &options, &mut within));
                    let what = format!("scene {k}, {}, {most} of {steps}", order.name());
                    assert_eq!(within.work(), is_counted.then_some(work), "{what}");
                    assert_eq!(frame, expected, "{what}");
                }
            }
        }
    }
}

#[test]
fn counting_ends_soon_after_its_budget() {
    let scene = scene(vec![mesh(needles(4000))]);
    let camera = turned(Projection::Perspective, [0.4, 0.3, 2.5], [0.0; 3], [300, 200]);
    let (view, options) = (View::new(&scene, &camera), Options::default());
    for order in [Order::Object, Order::Image] {
        let mut whole = Work::default();
        let expected = watched(order, &view, &options, &mut whole);
        // The whole work is a hundred times the budget.
        let most = whole.steps() / 100;
        let budget = Budget::new(most);
        let mut counted = Within { within: WorkWithin::new(&budget), received: Work::default() };
        assert_eq!(watched(order, &view, &options, &mut counted), expected);
        let received = counted.received.steps();
        println!("{}: {received} steps of {most}, {} in all", order.name(), whole.steps());
        assert!(received > most && received < 4 * most, "{received} steps for a budget of {most}");
    }
}

/// An observer that counts within a budget, and counts all steps that it receives.
struct Within<'a> {
    within: WorkWithin<'a>,
    received: Work,
}

impl Observer for Within<'_> {
    fn fork(&self) -> Self {
        Within { within: self.within.fork(), received: Work::default() }
    }

    fn join(&mut self, part: Self) {
        self.within.join(part.within);
        self.received.join(part.received);
    }
}

impl Events for Within<'_> {
    fn has_enough(&mut self) -> bool {
        self.within.has_enough()
    }

    fn node_opened(&mut self, sample: Sample, node: u32, entered: bool) {
        self.within.node_opened(sample, node, entered);
        self.received.node_opened(sample, node, entered);
    }

    fn sample_tested(&mut self, sample: Sample, primitive: u64) {
        self.within.sample_tested(sample, primitive);
        self.received.sample_tested(sample, primitive);
    }
}

#[test]
fn counts_may_be_left_out() {
    let scene = ties(4000);
    let camera = turned(Projection::Perspective, [0.4, 0.3, 2.5], [0.0; 3], [2, 2]);
    let view = View::new(&scene, &camera);
    for order in [Order::Object, Order::Image] {
        for method in [Method::Fast, Method::Textbook] {
            let counted = orders::render(order, method, &view, &RenderOptions::default()).unwrap();
            let without = RenderOptions { no_counts: true, ..RenderOptions::default() };
            let without = orders::render(order, method, &view, &without).unwrap();
            assert!(counted.work().is_some() && without.work().is_none());
            assert_eq!((without.work, &without.frame), (Counts::LeftOut, &counted.frame));
            let report = Report::new("ties", 4000, 1, &[without], None).to_json().unwrap();
            assert!(report.contains("\"work\": null"), "{report}");
        }
    }
    assert_eq!(orders::most_steps(640 * 480), (1 << 28) + 640 * 480 * 1024);
}

#[test]
fn ten_thousand_triangles_in_one_place_take_little_memory() {
    // The memory of other tests in this process does not count.
    const ALONE: &str = "BOTHWAYS_TEST_ALONE";
    if std::env::var_os(ALONE).is_none() {
        let name = "counting::ten_thousand_triangles_in_one_place_take_little_memory";
        let mut alone = Command::new(std::env::current_exe().unwrap());
        alone
            .env(ALONE, "1")
            .args(["--exact", name])
            .assert()
            .success()
            .stdout(contains("1 passed"));
        return;
    }
    // To keep 16 bytes for every tied fragment would take some hundred megabytes.
    let scene = ties(10_000);
    let camera = turned(Projection::Parallel, [0.0, 0.0, 2.0], [0.0; 3], [256, 256]);
    let (view, options) = (View::new(&scene, &camera), Options::default());
    let mut ids = Vec::new();
    for order in [Order::Object, Order::Image] {
        let mut work = Work::default();
        ids.push(watched(order, &view, &options, &mut work).ids().iter().collect::<Vec<_>>());
        assert!(order == Order::Image || work.fragments > 10_000_000, "{work:?}");
    }
    assert_eq!(ids[0], ids[1]);
    let before = peak_memory();
    let prepared = rasterize::fast::prepare(&scene);
    let mut frame = Frame::new(&camera, &options);
    rasterize::fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut ());
    if let (Some(before), Some(after)) = (before, peak_memory()) {
        println!("{before} kB before, {after} kB after");
        assert!(after < 200_000, "{after} kB");
    }
}

/// The most memory of this process so far in kilobytes, if the system reports it.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

#[test]
fn the_command_line_leaves_counts_out() {
    let folder = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| {
        let mut command = Command::cargo_bin("bothways").unwrap();
        command.current_dir(&folder).args(["canonical", "--size", "8x6", "--no-times"]);
        let output = command.args(more).assert().success().get_output().stdout.clone();
        String::from_utf8(output).unwrap()
    };
    let (algorithm, executed) = ("work of the algorithm", "executed for a frame");
    let counted = run(&[]);
    assert!(counted.contains(algorithm) && counted.contains("left to the exact judge"));
    assert!(counted.contains(executed) && counted.contains("tiles"));
    // What a frame executes is counted by itself, and costs nothing to count.
    let without = run(&["--no-counts"]);
    assert!(without.contains("samples covered") && without.contains("match"), "{without}");
    assert!(without.contains(executed) && without.contains("tiles"), "{without}");
    for row in [algorithm, "primitives  ", "rays", "sample tested", "judge", "not counted"] {
        assert!(!without.contains(row), "{row}: {without}");
    }
    let report: serde_json::Value = serde_json::from_str(&run(&["--no-counts", "--json"])).unwrap();
    for order in ["object_order", "image_order"] {
        assert_eq!(report[order]["work"], serde_json::Value::Null);
        assert_eq!(report[order]["method"], "fast");
    }
    let report: serde_json::Value = serde_json::from_str(&run(&["--json"])).unwrap();
    assert_eq!(report["image_order"]["work"]["rays"], 48);
}
