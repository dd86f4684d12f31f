//! `bothways pixel` and its library function: the report agrees with the picture, pixel by pixel.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use bothways::common::exact::Side;
use bothways::common::glam::Vec3;
use bothways::common::{
    Camera, CameraDescription, Object, Observer, Options, Plane, Projection, Scene, Shape, Sphere,
    View, Work,
};
use bothways::orders::{Method, Order, RenderOptions, render};
use bothways::pixel::{Behind, report};
use bothways::scenes;
use serde_json::{Value, json};

/// Asserts that the reports of all pixels together have the results and the work of the whole frame.
fn check_whole_picture(view: &View, options: &Options) {
    let once = RenderOptions { frame: *options, ..RenderOptions::default() };
    let frames = [Order::Object, Order::Image]
        .map(|order| render(order, Method::Fast, view, &once).unwrap());
    let mut work = [Work::default(); 2];
    let [width, height] = view.camera.image();
    for (i, j) in (0..height).flat_map(|i| (0..width).map(move |j| (i, j))) {
        for sample in report(view, options, i, j) {
            assert!(sample.agrees(), "pixel ({i}, {j}): {sample:?}");
            let (row, column) = (sample.sample.row, sample.sample.column);
            let answers = [sample.object_order, sample.image_order];
            for ((work, answer), one) in work.iter_mut().zip(answers).zip(&frames) {
                assert_eq!(answer.id, one.frame.id(row, column));
                assert_eq!(answer.t, one.frame.t(row, column));
                work.join(answer.work);
            }
        }
    }
    for (mut sum, one) in work.into_iter().zip(&frames) {
        // A frame counts a primitive once, the reports once for each sample in its region.
        let whole = *one.work().unwrap();
        sum.primitives = whole.primitives;
        // When fragments are settled depends on how many are open around them.
        sum.judged_nearest = whole.judged_nearest;
        assert_eq!(sum, whole, "{}", one.order.name());
    }
}

#[test]
fn all_pixels_together_are_the_picture() {
    for name in ["ties", "overlap", "behind"] {
        let loaded = scenes::load(name).unwrap();
        for (projection, samples) in [(Projection::Perspective, 1), (Projection::Parallel, 2)] {
            let mut description = loaded.camera;
            (description.projection, description.image) = (projection, [8, 8]);
            let camera = Camera::new(description).unwrap();
            check_whole_picture(
                &View::new(&loaded.scene, &camera),
                &Options { samples, ..Options::default() },
            );
        }
    }
}

/// The reason why each primitive at the middle of a 5 × 5 picture is behind the one before it.
fn reasons(objects: Vec<Object>) -> Vec<(u64, Option<Behind>)> {
    let (scene, camera) = (Scene::new(objects).unwrap(), Camera::canonical(5, 5));
    let samples = report(&View::new(&scene, &camera), &Options::default(), 2, 2);
    assert!(samples[0].agrees());
    samples[0].covering.iter().map(|covering| (covering.id, covering.behind)).collect()
}

#[test]
fn every_reason_for_being_behind_is_named() {
    let ball = |z: f32| Shape::Sphere(Sphere { center: Vec3::new(0.0, 0.0, z), radius: 1.0 });
    let wall = |normal| Shape::Plane(Plane { point: Vec3::new(0.0, 0.0, -3.0), normal }).into();
    let facing = || wall(Vec3::Z);
    assert_eq!(
        reasons(vec![ball(-4.0).into(), facing(), facing(), ball(-9.0).into()]),
        [(1, None), (2, Some(Behind::Later)), (0, Some(Behind::Round)), (3, Some(Behind::Farther))]
    );
    // To the right, the tilted wall comes nearer.
    let tilted = wall(Vec3::new(-1.0, 0.0, 1.0));
    assert_eq!(reasons(vec![facing(), tilted]), [(1, None), (0, Some(Behind::Nudged))]);
}

#[test]
fn a_shared_edge_is_covered_by_one_and_touched_by_the_other() {
    let corners = [[-1.0, -1.0, -2.0], [1.0, 1.0, -2.0]];
    let left = bothways_test_support::triangle([corners[0], corners[1], [-1.0, 1.0, -2.0]]);
    let right = bothways_test_support::triangle([corners[1], corners[0], [1.0, -1.0, -2.0]]);
    let (scene, camera) =
        (bothways_test_support::scene(vec![left, right]), Camera::canonical(5, 5));
    let sample = report(&View::new(&scene, &camera), &Options::default(), 2, 2).remove(0);
    assert_eq!(sample.covering.iter().map(|one| one.id).collect::<Vec<_>>(), [1]);
    assert_eq!(sample.touching.iter().map(|one| one.id).collect::<Vec<_>>(), [0]);
}

fn bothways(args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.arg("pixel").args(args);
    command
}

fn printed(args: &[&str]) -> String {
    let output = bothways(args).assert().code(0).stderr("").get_output().stdout.clone();
    String::from_utf8(output).unwrap()
}

#[test]
fn a_tie_is_derived_and_decided() {
    insta::assert_snapshot!(printed(&["ties", "8", "8", "--size", "16x16"]), @r"
    ties: pixel (8, 8) of 16 x 16, row from the top, column from the left, counted from 0

    the viewing ray, as the lecture writes it: it counts from 1, so that i = 9, j = 9
      x =  vw ((j - 1/2)/W - 1/2) =  1 ((9 - 1/2)/16 - 1/2) = 0.03125
      y = -vh ((i - 1/2)/H - 1/2) = -1 ((9 - 1/2)/16 - 1/2) = -0.03125
      u = (1, 0, 0)
      v = (0, 1, 0)
      w = (0, 0, 1)
      origin    = eye = (0, 0, 4)
      direction = x u + y v - d w, with d = 1
                = (0.03125, -0.03125, -1)
      t counts in lengths of the direction: t d is the depth along -w

    2 primitives cover it, near to far
    a triangle covers a sample if its edge functions have the sign of its facing F; where one is 0,
    the sample is moved a little to the right, and less down: left and top edges own it
      id 1: triangle, object 1, t = 3.096774194 (seen)
        E_ab -1.75, E_bc -0.1875, E_ca 0 (tie: a left edge, nudged to -); F -6
      id 250: triangle of a mesh, object 10, t = 4 (farther)
        E_ab -0.0234375, E_bc -0.0390625, E_ca 0 (tie: a left edge, nudged to -); F -0.25

    exactly on an edge of 2 triangles, but owned by its other side: not covered
      id 0: object 0
        E_ab -1.75, E_bc 0 (tie: a right edge, nudged to +), E_ca -0.1875; F -6
      id 251: object 10
        E_ab 0 (tie: a right edge, nudged to +), E_bc -0.0390625, E_ca -0.0234375; F -0.25

    object order saw id 1 at t = 3.096774
      4 bounding regions around it, 4 primitive tests, 2 fragments, 1 depth comparison, 2 questions to the exact judge
    image order saw id 1 at t = 3.096774
      15 box tests, 4 primitive tests, 1 fragment

    match: both orders saw what is nearest
    ");
}

#[test]
fn parallel_rays_begin_beside_the_eye() {
    let text = printed(&["canonical", "1", "2", "--size", "8x8", "--projection", "parallel"]);
    assert!(text.contains("origin    = eye + x u + y v = (0, 0, 0)"), "{text}");
    assert!(text.contains("direction = -w = (0, 0, -1)"), "{text}");
}

#[test]
fn the_edge_that_a_sample_lies_on_has_its_name() {
    let expected = [
        ("left-edge", (3, 2), Side::Left),
        ("right-edge", (3, 5), Side::Right),
        ("top-edge", (2, 3), Side::Top),
        ("bottom-edge", (5, 3), Side::Bottom),
    ];
    for (name, (i, j), side) in expected {
        let vector = bothways::vectors::all().into_iter().find(|one| one.name == name).unwrap();
        for projection in [Projection::Perspective, Projection::Parallel] {
            // At this depth both projections see the same.
            let description = CameraDescription { projection, ..vector.camera };
            let (scene, camera) = (vector.scene(), Camera::new(description).unwrap());
            let sample = report(&View::new(&scene, &camera), &Options::default(), i, j).remove(0);
            let owns = matches!(side, Side::Left | Side::Top);
            let values = match (sample.covering.first(), sample.touching.first()) {
                (Some(covering), None) if owns => covering.values.unwrap(),
                (None, Some(touching)) if !owns => touching.values,
                _ => panic!("{name}: {sample:?}"),
            };
            let sides: Vec<Side> = values.sides.into_iter().flatten().collect();
            assert_eq!(sides, [side], "{name}");
            // E_ab + E_bc + E_ca = n·D and t = F/(n·D).
            if let (Some(covering), Projection::Perspective) = (sample.covering.first(), projection)
            {
                let t = values.facing / values.at_sample.iter().sum::<f64>();
                assert!((t / covering.t - 1.0).abs() < 1e-12, "{name}: {t}");
            }
        }
    }
}

#[test]
fn the_ids_of_several_samples_are_printed_as_a_grid() {
    let text = printed(&["ties", "8", "8", "--size", "16x16", "--samples", "3"]);
    assert!(text.contains("(9 - 1 + 1/6)/16"), "{text}");
    let (_, grid) = text.split_once("the ids seen at all samples of the pixel\n").unwrap();
    assert_eq!(grid.lines().take(3).map(|line| line.split_whitespace().count()).max(), Some(3));
}

#[test]
fn numbers_are_as_short_as_they_read_back() {
    let args = ["ties", "8", "8", "--size=16x16", "--eye=0.1,2.1,4", "--viewport=1.3,0.7"];
    let text = printed(&[&args[..], &["--distance=0.6"]].concat());
    assert!(text.contains("origin    = eye = (0.1, 2.1, 4)\n"), "{text}");
    // The formulas compute with `f64`: with this number of digits, a calculator gives the same result.
    let [vw, d] = [1.3_f32, 0.6].map(f64::from);
    assert!(text.contains(&format!(" =  {vw} ((9 - 1/2)/16 - 1/2)")), "{text}");
    assert!(text.contains(&format!("with d = {d}\n")), "{text}");
    assert_eq!(
        [vw, d].map(|length| length.to_string()),
        ["1.2999999523162842", "0.6000000238418579"]
    );
    let report: Value = serde_json::from_str(&printed(&[&args[..], &["--json"]].concat())).unwrap();
    assert_eq!(report["eye"].to_string(), "[0.1,2.1,4.0]");
}

#[test]
fn json_has_every_fact() {
    let args = ["ties", "8", "8", "--size", "16x16", "--samples", "2", "--json"];
    let report: Value = serde_json::from_str(&printed(&args)).unwrap();
    assert_eq!((&report["pixel"], &report["agree"]), (&json!([8, 8]), &json!(true)));
    let samples = report["at"].as_array().unwrap();
    let places: Vec<&Value> = samples.iter().map(|sample| &sample["sample"]).collect();
    assert_eq!(places, [&json!([16, 16]), &json!([16, 17]), &json!([17, 16]), &json!([17, 17])]);
    let first = &samples[0];
    assert_eq!(first["x"], 0.015_625);
    assert_eq!(first["direction"], json!([0.015_625, -0.015_625, -1.0]));
    assert_eq!(first["covering"][0]["id"], first["object_order"]["id"]);
    let edges = &first["covering"][0]["edges"];
    let of_sign = |number: &Value| match number.as_f64().unwrap() {
        0.0 => 0.0,
        number => number.signum(),
    };
    assert_eq!(of_sign(&edges["facing_value"]), edges["facing"].as_f64().unwrap());
    assert_eq!(edges["on_edge"].as_array().unwrap().len(), 3);
    let values = edges["values"].as_array().unwrap().iter().map(of_sign);
    assert!(values.eq(edges["at_sample"].as_array().unwrap().iter().map(of_sign)), "{edges}");
    assert_eq!(edges["tie"], true);
    assert!(first["image_order"]["work"]["nodes"].as_u64().unwrap() > 0);
}

#[cfg(target_os = "linux")]
#[test]
fn one_pixel_of_a_picture_that_is_larger_than_memory_needs_its_own_samples_alone() {
    // All samples of the picture are 2^30, which take 32 bytes each; in KiB, less than half of that.
    let script =
        "ulimit -v 16000000; exec \"$0\" pixel canonical 64 64 --size 128x128 --samples 256";
    let program = assert_cmd::cargo::cargo_bin("bothways");
    let output = std::process::Command::new("sh").args(["-c", script]).arg(program).output();
    let output = output.unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success() && text.ends_with("both orders saw what is nearest\n"));
}
