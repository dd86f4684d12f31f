//! Every text that the program prints.
//!
//! The expected texts are in this file, except the help texts, which are long: those are in `snapshots/`. After an
//! intended change, `INSTA_UPDATE=always cargo test --test command_line texts` rewrites the help texts, and `cargo
//! insta review` (from `cargo install cargo-insta`) the texts in this file.
//!
//! The texts of `cover`, `pixel` and `camera` are in the files with those names.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use std::fs;
use tempfile::TempDir;

/// A picture with exact counts of work: the textbook method skips no work.
const TEXTBOOK: [&str; 5] = ["--method", "textbook", "--no-times", "--threads", "1"];

/// All commands, as the help lists them.
pub(crate) const COMMANDS: &[&str] = &[
    "render",
    "diff",
    "check",
    "grade",
    "figure",
    "slides",
    "scenes",
    "rules",
    "cover",
    "pixel",
    "film",
    "camera",
    "export",
    "mesh",
    "vectors",
    "fuzz",
    "sweep",
    "completions",
];

/// `bothways` in a separate folder, on a terminal 100 characters wide.
pub(crate) fn bothways(home: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).env("COLUMNS", "100").args(args);
    command
}

pub(crate) fn home() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// The text on stdout; stderr must be empty.
pub(crate) fn printed(mut command: Command, code: i32) -> String {
    let assert = command.assert().code(code).stderr("");
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

/// The text on stderr.
fn said(mut command: Command) -> String {
    String::from_utf8(command.assert().code(0).get_output().stderr.clone()).unwrap()
}

fn rendered(args: &[&str]) -> String {
    let home = home();
    let mut command = bothways(&home, args);
    command.args(TEXTBOOK);
    printed(command, 0)
}

#[test]
fn a_verdict_of_both_orders() {
    insta::assert_snapshot!(rendered(&["canonical", "--size", "12x12"]), @r"
    canonical: 3 primitives, 12 x 12 pixels, 1 sample a pixel

    textbook                          object order       image order
    samples covered                             91                91
    work of the algorithm, for each primitive or ray alone
      primitives                                 3                 -
      rays                                       -               144
      boxes tested                               -                 -
      primitive x sample tested                432               432
      of these, covered                        127               127
      depth comparisons                         36                36
      left to the exact judge                    -                 -

    match: both orders cover the same 91 samples and see the same primitive in each
    written to out/canonical
    ");
}

#[test]
fn one_order_alone() {
    insta::assert_snapshot!(rendered(&["canonical", "--size", "12x12", "--order", "image", "--samples", "2"]), @r"
    canonical: 3 primitives, 12 x 12 pixels, 2 x 2 samples a pixel

    textbook                           image order
    samples covered                            373
    work of the algorithm, for each primitive or ray alone
      primitives                                 -
      rays                                     576
      boxes tested                               -
      primitive x sample tested              1,728
      of these, covered                        536
      depth comparisons                        163
      left to the exact judge                    -

    written to out/canonical
    ");
}

#[test]
#[expect(clippy::too_many_lines, reason = "the expected text is long")]
fn the_report_in_its_stated_order() {
    insta::assert_snapshot!(rendered(&["canonical", "--size", "12x12", "--json"]), @r#"
    {
      "scene": "canonical",
      "size": [
        12,
        12
      ],
      "samples": 1,
      "threads": 1,
      "primitives": 3,
      "coverage": {
        "object_order": 91,
        "image_order": 91,
        "both": 91,
        "only_object_order": 0,
        "only_image_order": 0,
        "match": true
      },
      "visible": {
        "differing_pixels": 0,
        "first_differing": []
      },
      "depth": {
        "max_relative_difference": 0.0,
        "differing_pixels": 0
      },
      "colour": {
        "max_difference": 0,
        "differing_pixels": 0
      },
      "object_order": {
        "method": "textbook",
        "prepare_ms": null,
        "visibility_ms": null,
        "shading_ms": null,
        "work": {
          "primitives": 3,
          "rays": 0,
          "nodes": 0,
          "tests": 432,
          "fragments": 127,
          "depth_tests": 36,
          "judged_coverage": 0,
          "judged_nearest": 0
        },
        "executed": null
      },
      "image_order": {
        "method": "textbook",
        "prepare_ms": null,
        "visibility_ms": null,
        "shading_ms": null,
        "work": {
          "primitives": 0,
          "rays": 144,
          "nodes": 0,
          "tests": 432,
          "fragments": 127,
          "depth_tests": 36,
          "judged_coverage": 0,
          "judged_nearest": 0
        },
        "executed": null
      }
    }
    "#);
}

#[test]
fn the_built_in_scenes() {
    insta::assert_snapshot!(printed(bothways(&home(), &["scenes"]), 0), @r"
    lecture    The first slide: Newell's teapot, a sphere and a plane, with materials and light.
    canonical  The lecture's first camera before one triangle, one sphere and one plane.
    ties       Edges and vertices exactly on sample points, at every size that is a power of two.
    behind     Triangles, spheres and planes that reach behind the eye, and some that lie there.
    slivers    Needles down to thousandths of a pixel, and a fan of them that leaves no gap.
    overlap    Coplanar and duplicated faces, of which the first in the scene is always seen.
    parallel   A staircase of blocks and balls before a parallel camera: equal things are equally large.
    inside     A closed mesh seen from within: every pixel is covered, or the surface leaks.
    many       A necklace of some 100,000 triangles, so that searching well pays.
    ");
}

#[test]
fn the_camera_that_frames_a_mesh() {
    let home = home();
    fs::write(home.path().join("triangle.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    insta::assert_snapshot!(printed(bothways(&home, &["scenes", "triangle.obj"]), 0), @r##"
    [camera]
    eye = [1.9141034, 1.465538, 2.0996835]
    look_at = [0.5131661, 0.48488194, -0.0017223124]
    up = [0.0, 1.0, 0.0]
    distance = 2.2
    image = [640, 480]
    background = "#36424b"

    [material.plaster]
    color = "#e6c9a5"
    specular = 0.12
    shininess = 25

    [[light]]
    directional = [0.3, -1.15, -0.8]
    intensity = 0.78

    [[light]]
    directional = [-1, -0.3, 0.1]
    intensity = 0.2

    [[light]]
    directional = [0.2, -0.4, 1]
    intensity = 0.15

    [[light]]
    ambient = true
    intensity = 0.14

    [[object]]
    mesh = "triangle.obj"
    material = "plaster"
    "##);
}

#[test]
fn a_summary_of_the_conformance_set() {
    insta::assert_snapshot!(printed(bothways(&home(), &["vectors"]), 0), @r"
    edges            13 scenes
    corners           8 scenes
    shared edges      6 scenes
    slivers           8 scenes
    depth            13 scenes
    behind the eye    7 scenes
    parallel          6 scenes
    camera            7 scenes
    extremes          6 scenes

    74 scenes, on each of which both orders agree
    written to out/vectors; README.md there says how to use it
    ");
}

/// The canonical scene twice, the second time from a step up and back.
fn two_renderings() -> TempDir {
    let home = home();
    for (folder, eye) in [("a", "0,0,0"), ("b", "0,0.25,0.25")] {
        let args = ["canonical", "--eye", eye, "--size", "6x4", "--buffers", "npy", "--quiet"];
        bothways(&home, &args).args(TEXTBOOK).args(["-o", folder]).assert().code(0);
    }
    home
}

#[test]
fn equal_pictures() {
    let args = ["diff", "a/object-order.png", "a/image-order.png"];
    insta::assert_snapshot!(printed(bothways(&two_renderings(), &args), 0), @r"
    A  a/object-order.png: picture without coverage
    B  a/image-order.png: picture without coverage

    6 x 4 pixels, compared: colour

    pixels beyond 2/255 in colour              0

    mean difference in colour              0/255
    root mean square                       0/255
    PSNR                                infinite

    equal in everything compared: colour (within 2/255)
    ");
}

#[test]
fn different_distances() {
    let args = ["diff", "a/object-order.t.npy", "b/object-order.t.npy"];
    insta::assert_snapshot!(printed(bothways(&two_renderings(), &args), 1), @r"
    A  a/object-order.t.npy: distances t
    B  b/object-order.t.npy: distances t

    6 x 4 pixels, compared: coverage, t

    pixels covered in A                       14
    pixels covered in B                       13
    in both                                   13
    only in A                                  1
    only in B                                  0
    pixels with t beyond 1e-5                 13

    intersection over union               0.9285
    farthest from the other mask            1 px, at (1, 3)

    largest difference in t: 1.6e-1 of it, at (2, 0): A 6, B 7.125
    first pixels (row, column) that differ:
      (1, 2)  A t 4.573464   B t 4.8085485
      (1, 3)  A t 3.2095242  B nothing
      (2, 0)  A t 6          B t 7.125
      (2, 1)  A t 4.2907267  B t 4.511278
      (2, 2)  A t 4.5980306  B t 4.834378
      (2, 3)  A t 2.8060932  B t 3.0513854
      (2, 4)  A t 2.7826087  B t 3.0581477
      (2, 5)  A t 6          B t 7.125
      (3, 0)  A t 3          B t 3.5625
      (3, 1)  A t 3          B t 3.5625
    differ: 14 pixels of 24, in the bounding box from (1, 0) to (3, 5)
    ");
}

#[test]
fn different_ids() {
    let args = ["diff", "a/object-order.ids.npy", "b/object-order.ids.npy"];
    insta::assert_snapshot!(printed(bothways(&two_renderings(), &args), 1), @r"
    A  a/object-order.ids.npy: ids
    B  b/object-order.ids.npy: ids

    6 x 4 pixels, compared: coverage, ids

    pixels covered in A                       14
    pixels covered in B                       13
    in both                                   13
    only in A                                  1
    only in B                                  0
    in both, but other ids                     0

    intersection over union               0.9285
    farthest from the other mask            1 px, at (1, 3)

    first pixels (row, column) that differ:
      (1, 3)  A id 1  B nothing
    differ: 1 pixel of 24, at (1, 3)
    ");
}

#[test]
fn a_mesh_is_written() {
    let args = ["mesh", "torus", "--divisions", "8,5", "-o", "torus.obj"];
    insta::assert_snapshot!(said(bothways(&home(), &args)), @"wrote torus.obj: 80 triangles, 40 vertices");
}

#[test]
fn a_squashed_picture_has_a_hint() {
    let args = ["canonical", "--size", "8x4"];
    insta::assert_snapshot!(said(bothways(&home(), &args)), @"hint: the viewport is 1 x 1 whatever the size, so the pixels of an image of 8x4 are not square; --viewport 2,1 makes them so");
    assert_eq!(said(bothways(&home(), &[&args[..], &["--quiet"]].concat())), "");
}

#[test]
fn short_help() {
    insta::assert_snapshot!("help", printed(bothways(&home(), &["-h"]), 0));
    for &command in COMMANDS {
        let help = printed(bothways(&home(), &[command, "-h"]), 0);
        insta::assert_snapshot!(format!("help_{command}"), help);
    }
}

#[test]
fn no_text_is_wider_than_the_terminal() {
    for line in printed(bothways(&home(), &["render", "--help"]), 0).lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
}
