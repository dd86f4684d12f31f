//! A streamed mesh gives the same picture as in memory: the same ids, in chunks of any size.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use bothways::common::glam::Vec3;
use bothways::common::scene::Positions;
use bothways::common::{Camera, Frame, Mesh, Object, Options, Projection, Scene, View, Work};
use bothways::diff::compare;
use bothways::formats::generate::Kind;
use bothways::formats::mesh_file::Format;
use bothways::formats::mesh_stream::MeshStream;
use bothways::formats::{obj, stl};
use bothways::orders::{self, Method, Order, RenderOptions, Source};
use bothways::progress::{Progress, Stage};
use bothways::rasterize::{self, stream::CHUNK, stream::Canvas, stream::Look};
use bothways_test_support::{
    PROJECTIONS, assert_same_visibility, camera, cases, mesh, scene, turned,
};
use predicates::prelude::*;
use predicates::str::contains;
use proptest::collection::vec;
use proptest::prelude::{BoxedStrategy, Strategy, any, prop_oneof};
use proptest::test_runner::{Config, TestRng, TestRunner};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::time::Duration;
use tempfile::TempDir;

const CHUNKS: [usize; 5] = [1, 2, 3, 7, 1000];

/// The frame and the counts of a mesh that is drawn in chunks.
fn streamed(mesh: &Mesh, camera: &Camera, options: &Options, chunk: usize) -> (Frame, Work) {
    let mut positions = Positions::default();
    mesh.positions().iter().for_each(|&position| positions.push(position));
    let (mut canvas, mut work) = (Canvas::new(camera, options), Work::default());
    // Nothing of the first pass, which has another camera, may remain in the second.
    let away = turned(Projection::Parallel, [9.0, 9.0, 9.0], [0.0; 3], camera.image());
    for (camera, observer) in [(&away, &mut Work::default()), (camera, &mut work)] {
        let mut pass = canvas.begin(camera, chunk, observer);
        mesh.triangles().iter().for_each(|&triangle| pass.draw(&positions, triangle));
        pass.finish(&positions);
    }
    canvas.shade(&positions, camera, &Look::default());
    (canvas.into_frame(), work)
}

/// Streams a mesh in chunks of several sizes, and compares with the same mesh in memory.
fn check(one: &Mesh, camera: &Camera, options: &Options, what: &str) {
    let scene = scene(vec![mesh(one.clone())]);
    let view = View::new(&scene, camera);
    let expected = rasterize::textbook::render(&view, options);
    let (mut whole, mut work) = (Frame::new(camera, options), Work::default());
    let prepared = rasterize::fast::prepare(&scene);
    rasterize::fast::determine_visibility(&prepared, &view, options, &mut whole, &mut work);
    for chunk in CHUNKS {
        let (frame, streamed) = streamed(one, camera, options, chunk);
        let what = format!("{what}, {chunk} triangles at a time");
        assert_same_visibility(&expected, &frame, &what);
        assert_eq!(compare(&expected, &frame).color.differing_pixels, 0, "{what}: colour");
        // Each fragment of a sample except the first is compared once, either in a chunk or in the merge.
        let counts = |work: &Work| [work.primitives, work.tests, work.fragments, work.depth_tests];
        assert_eq!(counts(&streamed), counts(&work), "{what}");
    }
}

/// Triangles with corners of their own, as a mesh.
fn soup(corners: &[[[f32; 3]; 3]]) -> Mesh {
    let positions = corners.as_flattened().iter().copied().map(Vec3::from_array).collect();
    let count = u32::try_from(corners.len()).unwrap();
    Mesh::new(positions, (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect()).unwrap()
}

#[test]
fn coplanar_and_duplicated_triangles_keep_their_order() {
    let large = [[-3.0, -3.0, -4.0], [3.0, -3.0, -4.0], [0.0, 3.0, -4.0]];
    let [a, b, c] = large;
    let small = [[-1.0, -2.0, -4.0], [1.0, -2.0, -4.0], [0.0, 2.0, -4.0]];
    let tilted = [[-3.0, -1.0, -3.0], [3.0, -1.0, -3.0], [0.0, 1.0, -5.0]];
    let hair = a.map(|x| x * (1.0 + f32::EPSILON));
    let mesh = soup(&[small, large, [b, c, a], tilted, [c, b, a], [hair, b, c], large, tilted]);
    for projection in PROJECTIONS {
        for samples in 1..=3 {
            let camera = camera(projection, [0.0; 3], [2.0, 2.0], [9, 8]);
            check(
                &mesh,
                &camera,
                &Options { samples, ..Options::default() },
                &format!("{projection:?}"),
            );
        }
    }
}

#[test]
fn meshes_with_shared_vertices_give_the_same_frame() {
    for (kind, divisions) in [(Kind::Torus, [9, 6]), (Kind::Sphere, [8, 5]), (Kind::Box, [2, 2])] {
        let generated = kind.mesh(divisions).unwrap();
        let bare = Mesh::new(generated.positions().to_vec(), generated.triangles().to_vec());
        for projection in PROJECTIONS {
            let camera = turned(projection, [2.0, 1.5, 3.0], [0.0; 3], [21, 17]);
            let what = format!("{kind} {projection:?}");
            check(
                bare.as_ref().unwrap(),
                &camera,
                &Options { samples: 2, ..Options::default() },
                &what,
            );
        }
        let inside = turned(Projection::Perspective, [0.0; 3], [1.0, 0.2, 0.1], [12, 12]);
        check(bare.as_ref().unwrap(), &inside, &Options::default(), &format!("in {kind}"));
    }
}

#[test]
fn a_mesh_without_triangles_gives_an_empty_frame() {
    let camera = Camera::canonical(2, 3);
    let (frame, work) = streamed(&Mesh::default(), &camera, &Options::default(), 1);
    let scene = Scene::new(Vec::<Object>::new()).unwrap();
    let view = View::new(&scene, &camera);
    assert_eq!(frame, rasterize::textbook::render(&view, &Options::default()));
    assert_eq!(work, Work::default());
}

#[test]
fn progress_is_reported_chunk_by_chunk() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("long.obj");
    let triangles = CHUNK + 1;
    let text = ["v 0 0 -2\nv 1 0 -2\nv 0 1 -2\n", &"f 1 2 3\n".repeat(triangles)].concat();
    fs::write(&path, text).unwrap();
    let camera = Camera::canonical(3, 4);
    let reported = Mutex::new(Vec::new());
    let listener = |progress: Progress| {
        assert_eq!(progress.order, Order::Object);
        reported.lock().unwrap().push((progress.stage, progress.done, progress.total));
    };
    let options = RenderOptions { progress: Some(&listener), ..RenderOptions::default() };
    let mut stream = MeshStream::open(&path, Format::Obj).unwrap();
    // The length of the first pass is unknown.
    for (repeat, total) in [(None, 1), (None, 2), (Some(1), 6)] {
        let options = RenderOptions { repeat, no_times: repeat.is_none(), ..options };
        let (look, opening) = (&Look::default(), Duration::ZERO);
        let source = Source::Stream { mesh: &mut stream, camera: &camera, look, opening };
        let rendered = orders::render(Order::Object, Method::Fast, source, &options).unwrap();
        assert_eq!(rendered.work().map(|work| work.primitives), Some(triangles as u64));
        let is_executed = rendered.executed.map(|executed| executed.tiles > 0);
        assert_eq!(is_executed, repeat.map(|_| true));
        let steps = (0..=total).map(|done| (Stage::Rendering, done, total));
        let expected: Vec<_> = [(Stage::Preparing, 0, total)].into_iter().chain(steps).collect();
        assert_eq!(reported.lock().unwrap().split_off(0), expected);
    }
}

/// A coordinate of few bits, of ordinary size, or of any.
fn coordinate(extreme: bool) -> BoxedStrategy<f32> {
    let few = (-3..=3_i8).prop_map(f32::from);
    if !extreme {
        return prop_oneof![6 => few, 1 => -4.0..4.0_f32].boxed();
    }
    let finite = any::<f32>().prop_filter("finite", |x| x.is_finite());
    let power = (-149..127_i32, any::<bool>())
        .prop_map(|(e, minus)| if minus { -(e as f32).exp2() } else { (e as f32).exp2() });
    prop_oneof![2 => few, 4 => -4.0..4.0_f32, 2 => finite, 2 => power].boxed()
}

/// Few positions, which many triangles share: duplicates, slivers and coplanar faces.
fn hostile_mesh(extreme: bool) -> impl Strategy<Value = Mesh> {
    let position = [coordinate(extreme), coordinate(extreme), coordinate(extreme)];
    vec(position.prop_map(Vec3::from), 3..9).prop_flat_map(|positions| {
        let index = 0..u32::try_from(positions.len()).unwrap();
        vec([index.clone(), index.clone(), index], 1..14)
            .prop_map(move |triangles| Mesh::new(positions.clone(), triangles).unwrap())
    })
}

#[test]
fn hostile_meshes_give_the_same_frame() {
    for (extreme, count) in [(false, 400), (true, 250)] {
        let config = Config { cases: cases(count), failure_persistence: None, ..Config::default() };
        let rng = TestRng::deterministic_rng(config.rng_algorithm);
        let eye = [coordinate(extreme), coordinate(extreme), coordinate(extreme)];
        let strategy = (hostile_mesh(extreme), eye, any::<bool>(), 1..3_u32);
        TestRunner::new_with_rng(config, rng)
            .run(&strategy, |(mesh, eye, parallel, samples)| {
                let projection = PROJECTIONS[usize::from(parallel)];
                let camera = camera(projection, eye, [6.0, 6.0], [6, 6]);
                check(&mesh, &camera, &Options { samples, ..Options::default() }, "a hostile mesh");
                Ok(())
            })
            .unwrap();
    }
}

/// `bothways render --order object --stream` in a folder of its own.
fn stream(home: &TempDir, args: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).args(["render", "--order", "object", "--stream"]).args(args).assert()
}

fn in_memory(home: &TempDir, args: &[&str]) {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).args(["--order", "object"]).args(args).assert().code(0);
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// A torus as OBJ, with a vertex that no face uses, far away.
fn torus(home: &TempDir) {
    let mesh = Kind::Torus.mesh([24, 12]).unwrap();
    let mut positions = vec![Vec3::splat(900.0)];
    positions.extend(mesh.positions());
    let triangles = mesh.triangles().iter().map(|triangle| triangle.map(|index| index + 1));
    let mesh = Mesh::new(positions, triangles.collect()).unwrap();
    let mut text = Vec::new();
    obj::write(&mesh, &mut text).unwrap();
    fs::write(home.path().join("torus.obj"), text).unwrap();
}

#[test]
fn the_command_writes_the_same_files_with_and_without_stream() {
    let home = tempfile::tempdir().unwrap();
    torus(&home);
    let mut binary = Vec::new();
    stl::write(&Kind::Torus.mesh([24, 12]).unwrap(), &mut binary).unwrap();
    fs::write(home.path().join("torus.stl"), binary).unwrap();
    for (k, options) in [
        vec!["torus.obj", "--size", "50x40", "--samples", "2"],
        vec![
            "torus.obj",
            "--projection",
            "parallel",
            "--eye",
            "0,3,5",
            "--size",
            "31x20",
            "--threads",
            "1",
        ],
        vec!["torus.stl", "--size", "50x40"],
    ]
    .into_iter()
    .enumerate()
    {
        let [a, b] = ["a", "b"].map(|name| format!("{name}{k}"));
        let common = ["--buffers", "npy", "--no-times", "--json", "-o"];
        let with = |folder: &str| [&options[..], &common, &[folder]].concat().join(" ");
        let (streamed, memory) = (with(&a), with(&b));
        stream(&home, &streamed.split(' ').collect::<Vec<_>>()).code(0).stderr("");
        in_memory(&home, &memory.split(' ').collect::<Vec<_>>());
        let [a, b] = [a, b].map(|name| home.path().join(name));
        for name in ["mask-object-order.png", "object-order.ids.npy"] {
            assert_eq!(fs::read(a.join(name)).unwrap(), fs::read(b.join(name)).unwrap(), "{name}");
        }
        let [mut a, mut b] = [a, b].map(|folder| json(&folder.join("report.json")));
        // What is executed for chunks is another count, for which the file is not read again.
        assert!(a["object_order"]["executed"].is_null());
        // What was left to the judge depends on where chunks end.
        for report in [&mut a, &mut b] {
            report["object_order"].as_object_mut().unwrap().remove("executed");
            let work = report["object_order"]["work"].as_object_mut().unwrap();
            work.retain(|name, _| !name.starts_with("judged"));
        }
        assert_eq!(a, b);
    }
}

#[test]
fn materials_are_left_out_with_a_warning() {
    let home = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(home.path().join(name), text).unwrap();
    // A flat square has the same normals smooth and flat.
    let square = "v -1 0 0\nv 1 0 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";
    write("plain.obj", square);
    write("red.obj", &format!("mtllib red.mtl\nusemtl red\n{square}"));
    write("red.mtl", "newmtl red\nKd 1 0 0\n");
    let with = |file: &'static str, folder: &'static str| [file, "--no-times", "-o", folder];
    let picture = |name: &str| fs::read(home.path().join(name).join("object-order.png")).unwrap();

    let says =
        contains("red.obj: the materials and colours of a mesh that is streamed are not read")
            .count(1);
    stream(&home, &with("red.obj", "streamed")).code(0).stderr(says);
    stream(&home, &[&with("red.obj", "quiet")[..], &["--quiet"]].concat()).code(0).stderr("");
    in_memory(&home, &with("plain.obj", "default"));
    in_memory(&home, &with("red.obj", "red"));
    assert_eq!(picture("streamed"), picture("default"), "what is streamed has the default look");
    assert_ne!(picture("streamed"), picture("red"));
}

#[test]
fn times_are_measured_and_may_be_repeated() {
    let home = tempfile::tempdir().unwrap();
    torus(&home);
    stream(&home, &["torus.obj", "--size", "20x20", "--repeat", "2"])
        .code(0)
        .stdout(contains("torus: 576 primitives").and(contains("written to out/torus")));
    let report = json(&home.path().join("out/torus/report.json"));
    assert!(report["object_order"]["visibility_ms"]["median"].is_number());
    assert_eq!(report["image_order"], Value::Null);
    assert_eq!(report["coverage"], Value::Null);
}

#[test]
fn what_cannot_be_streamed_says_why_and_what_to_do() {
    let home = tempfile::tempdir().unwrap();
    torus(&home);
    let plain = |args: &[&str]| {
        let mut command = Command::cargo_bin("bothways").unwrap();
        command.current_dir(&home).args(args).assert()
    };
    let every_ray = contains("in image order every ray may need every triangle");
    for order in [&["--order", "both"][..], &["--order", "image"], &[]] {
        let args = [&["torus.obj", "--stream"], order].concat();
        plain(&args).code(2).stderr(contains("give --order object").and(every_ray.clone()));
    }
    stream(&home, &["torus.obj", "--method", "textbook"])
        .code(2)
        .stderr(contains("--method textbook"));
    for source in ["lecture", "scene.toml", "-", "/dev/stdin", "mesh.glb"] {
        let says = contains(format!("{source:?} is none; render it in memory"));
        stream(&home, &[source]).code(2).stderr(says);
    }
    stream(&home, &["none.obj"]).code(2).stderr(contains("none.obj: there is no such file"));
    stream(&home, &["torus.obj", "--size", "60000x60000"]).code(2);
    stream(&home, &["torus.obj", "--up", "0,0,0"])
        .code(2)
        .stderr(contains("the camera of 'torus'"));
    assert!(!home.path().join("out").exists());
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_and_not_waited_for() {
    let home = tempfile::tempdir().unwrap();
    let pipe = home.path().join("pipe.ply");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    if !made.is_ok_and(|status| status.success()) {
        println!("skipped: no pipe can be made here");
        return;
    }
    stream(&home, &["pipe.ply"]).code(2).stderr(contains("save it as a file first"));
}

#[test]
fn a_file_that_goes_wrong_midway_writes_nothing() {
    let home = tempfile::tempdir().unwrap();
    let header = "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty \
                  float y\nproperty float z\nelement face 2\nproperty list uchar uchar \
                  vertex_indices\nend_header\n";
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let vertices: Vec<u8> = corners.as_flattened().iter().flat_map(|x| x.to_be_bytes()).collect();
    let good = [header.as_bytes(), &vertices, &[3, 0, 1, 2, 3, 2, 1, 0]].concat();
    let write = |name: &str, bytes: &[u8]| fs::write(home.path().join(name), bytes).unwrap();
    let last = good.len() - 1;
    write("short.ply", &good[..last]);
    write("vertices.ply", &good[..header.len() + 30]);
    write("index.ply", &[&good[..last], &[3]].concat());
    write("more.ply", &[&good[..], &[3]].concat());
    write("faces.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n");
    write("none.obj", b"v 0 0 0\n");
    for (name, says) in [
        ("short.ply", "short.ply: face 1 (byte "),
        ("vertices.ply", "vertices.ply: vertex 2 (byte "),
        ("index.ply", "it names vertex 3, but vertices are counted from 0 and there are 3"),
        ("more.ply", "more.ply: something follows the last element"),
        ("faces.obj", "faces.obj:5: the face names vertex 4, but in the whole file only 3"),
        ("none.obj", "none.obj: no faces"),
    ] {
        stream(&home, &[name, "-o", "out"]).code(2).stdout("").stderr(contains(says));
    }
    assert!(!home.path().join("out").exists());
    write("good.ply", &good);
    stream(&home, &["good.ply", "-o", "out", "--quiet"]).code(0).stdout("");
}
