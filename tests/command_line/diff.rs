//! `bothways diff` of two files in the use of a student: real outputs compared with edited copies, and what counts as equal.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

pub(crate) fn bothways(home: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).args(args);
    command
}

/// A folder with `out/`, in which the canonical scene is rendered at a small size.
pub(crate) fn rendered(samples: &str) -> TempDir {
    let home = tempfile::tempdir().unwrap();
    let args = ["canonical", "--size", "24x16", "--buffers", "npy", "--samples", samples];
    bothways(&home, &args).args(["--quiet", "-o", "out"]).assert().code(0);
    home
}

/// Copies a buffer, and replaces a number of pixel `(i, j)`.
fn edited<const N: usize>(home: &TempDir, name: &str, [i, j]: [usize; 2], number: [u8; N]) {
    let mut bytes = fs::read(home.path().join("out").join(name)).unwrap();
    let start = bytes.len() - N * (24 * 16 - 24 * i - j);
    bytes[start..start + N].copy_from_slice(&number);
    fs::write(home.path().join("mine.npy"), bytes).unwrap();
}

pub(crate) fn json_of(home: &TempDir, args: &[&str]) -> Value {
    let output = bothways(home, args).arg("--json").output().unwrap();
    serde_json::from_slice(&output.stdout).unwrap()
}

pub(crate) fn count(folder: &Path) -> usize {
    fs::read_dir(folder).unwrap().count()
}

#[test]
fn a_file_that_is_right_is_not_said_to_lack_anything() {
    let home = rendered("1");
    // No primitive has this id.
    edited(&home, "object-order.ids.npy", [8, 12], 77_u32.to_le_bytes());
    let ours = "out/image-order.ids.npy";
    for (a, b, wrong, right) in [("mine.npy", ours, "A", "B"), (ours, "mine.npy", "B", "A")] {
        let factual = format!("{wrong} shows the primitive 77, which {right} never shows");
        let blamed = format!("{right} never shows the primitive 77 of {wrong}");
        let by_scene = contains(factual).and(contains(blamed.clone()).not());
        let scene = ["diff", a, b, "--scene", "canonical"];
        bothways(&home, &scene).assert().code(1).stdout(by_scene);
        // Without the scene, neither is known to be right.
        bothways(&home, &["diff", a, b]).assert().code(1).stdout(contains(blamed));
    }
}

#[test]
fn both_orders_are_equal_in_every_file() {
    for samples in ["1", "2"] {
        let home = rendered(samples);
        for (object, image) in [
            ("object-order.ids.npy", "image-order.ids.npy"),
            ("object-order.t.npy", "image-order.t.npy"),
            ("object-order.png", "image-order.png"),
            ("mask-object-order.png", "mask-image-order.png"),
            ("object-order.ids.npy", "image-order.t.npy"),
            ("object-order.t.npy", "mask-image-order.png"),
        ] {
            let files = [object, image].map(|name| format!("out/{name}"));
            let equal = contains("equal in everything compared");
            bothways(&home, &["diff", &files[0], &files[1]]).assert().code(0).stdout(equal);
        }
        // The command line does not ask for output.
        assert_eq!(count(home.path()), 1);
    }
}

#[test]
fn an_edited_id_is_found_and_shown() {
    let home = rendered("1");
    edited(&home, "object-order.ids.npy", [0, 3], 7_u32.to_le_bytes());
    let args = ["diff", "out/object-order.ids.npy", "mine.npy"];
    let said = contains("(0, 3)  A nothing  B id 7")
        .and(contains("differ: 1 pixel of 384"))
        .and(contains("\u{1b}").not());
    bothways(&home, &args).assert().code(1).stdout(said).stderr("");

    let report = json_of(&home, &args);
    assert_eq!(report["equal"], false);
    assert_eq!(report["compared"], json!(["coverage", "ids"]));
    assert_eq!(report["first_differing"], json!([[0, 3]]));
    assert_eq!(report["region"], json!([0, 3, 1, 1]));
    assert_eq!(report["coverage"]["only_b"], 1);
    assert_eq!(report["depth"], Value::Null);
    assert_eq!(report["a"]["file"], "out/object-order.ids.npy");

    bothways(&home, &args).args(["-o", "new/diff"]).assert().code(1);
    let picture = image::open(home.path().join("new/diff/difference.png")).unwrap().to_rgb8();
    // Every pixel is a square of 512 / 24.
    assert_eq!(picture.dimensions(), (21 * 24, 21 * 16));
    let only_b = |x: u32, y: u32| picture[(x, y)].0 == [0x00, 0x72, 0xb2];
    assert!(only_b(63, 0) && only_b(83, 20) && !only_b(62, 0) && !only_b(84, 0) && !only_b(63, 21));
    assert_eq!(count(&home.path().join("new/diff")), 1);
}

#[test]
fn an_edited_distance_is_measured() {
    let home = rendered("1");
    let report = json_of(&home, &["diff", "out/object-order.t.npy", "out/image-order.t.npy"]);
    assert!(report["depth"]["max_relative_difference"].as_f64().unwrap() <= 1e-5);
    edited(&home, "object-order.t.npy", [0, 3], 2.5_f32.to_le_bytes());
    let args = ["diff", "mine.npy", "out/object-order.t.npy"];
    let said = contains("A t 2.5").and(contains("B nothing")).and(contains("only in A"));
    bothways(&home, &args).assert().code(1).stdout(said);
}

#[test]
fn a_mask_against_ids_is_compared_in_coverage() {
    let home = rendered("1");
    let args = ["diff", "out/mask-object-order.png", "out/image-order.ids.npy"];
    let said = contains("compared: coverage\n").and(contains("not compared: ids: only B tells"));
    bothways(&home, &args).assert().code(0).stdout(said);
}

#[test]
fn an_output_folder_of_render_keeps_its_files() {
    let home = rendered("1");
    let before = count(&home.path().join("out"));
    let args = ["diff", "out/object-order.png", "out/image-order.png", "-o", "out"];
    bothways(&home, &args).assert().code(0).stdout(contains("written to"));
    assert_eq!(count(&home.path().join("out")), before);
}

#[test]
fn a_background_makes_a_mask_of_a_picture() {
    let home = tempfile::tempdir().unwrap();
    let save = |name: &str, pixels: &[[u8; 3]]| {
        let width = u32::try_from(pixels.len()).unwrap();
        let picture = image::RgbImage::from_raw(width, 1, pixels.concat()).unwrap();
        picture.save(home.path().join(name)).unwrap();
    };
    save("a.png", &[[16, 20, 24], [200, 0, 0], [9, 9, 9]]);
    save("b.ppm", &[[16, 20, 24], [190, 0, 0], [16, 20, 24]]);
    let args = ["diff", "a.png", "b.ppm"];
    let said = contains("largest difference in colour: 15/255, at (0, 2): A #090909, B #101418")
        .and(contains("compared: colour\n"));
    bothways(&home, &args).assert().code(1).stdout(said);
    let said = contains("largest difference in colour: 10/255, at (0, 1): A #c80000, B #be0000")
        .and(contains("compared: coverage, colour\n"));
    bothways(&home, &args).args(["--background", "#101418"]).assert().code(1).stdout(said);
}

#[test]
fn the_text_names_counts_pixels_and_hints() {
    let home = tempfile::tempdir().unwrap();
    let save = |name: &str, pixels: &[u8]| {
        let picture = image::GrayImage::from_raw(4, 2, pixels.to_vec()).unwrap();
        picture.save(home.path().join(name)).unwrap();
    };
    save("a.png", &[0, 255, 255, 0, 0, 255, 0, 0]);
    save("b.png", &[0, 1, 0, 0, 0, 1, 1, 0]);
    let expected = "\
A  a.png: mask
B  b.png: mask

4 x 2 pixels, compared: coverage

pixels covered in A                        3
pixels covered in B                        3
in both                                    2
only in A                                  1
only in B                                  1

intersection over union               0.5000
farthest from the other mask            1 px, at (0, 2)

first pixels (row, column) that differ:
  (0, 2)  A covered  B nothing
  (1, 2)  A nothing  B covered
hint: each of these alone explains every difference
  - B agrees with A once it is turned upside down
  - B agrees with A once it is moved 1 row up; where edges lie on samples, half a pixel does that
differ: 2 pixels of 8, in the bounding box from (0, 2) to (1, 2)
";
    bothways(&home, &["diff", "a.png", "b.png"]).assert().code(1).stdout(expected);
}

#[test]
fn what_counts_as_equal_may_be_chosen() {
    let home = rendered("1");
    edited(&home, "object-order.ids.npy", [0, 3], 7_u32.to_le_bytes());
    let files = ["diff", "out/object-order.ids.npy", "mine.npy"];
    let with = |option: &[&str]| bothways(&home, &[&files[..], option].concat()).assert();
    let allowed = "equal enough: they differ in 1 pixel of 384 (2 may), at (0, 3)\n";
    with(&["--allow-pixels", "2"]).code(0).stdout(predicates::str::ends_with(allowed)).stderr("");
    let ignored = contains("ignored: 8 pixels, of the rectangles 0,2,2,3 and 0,2,1,5\n")
        .and(contains("equal in everything compared: coverage, ids\n"));
    with(&["--ignore", "0,2,2,3", "--ignore", "0,2,1,5"]).code(0).stdout(ignored);
    let more = contains("differ: 1 pixel of 380 compared, at (0, 3)");
    with(&["--ignore", "1,2,2,2"]).code(1).stdout(more);
    let report = json_of(&home, &[&files[..], &["--allow-pixels", "1"]].concat());
    assert_eq!([&report["equal"], &report["passes"]], [false, true]);
    assert_eq!(report["tolerances"], json!({ "t": 1e-5, "normals": 0.1, "colour": 2.0 }));

    // The same for all pairs of two folders.
    let args = ["canonical", "--size", "24x16", "--buffers", "npy", "--quiet", "-o", "mine"];
    bothways(&home, &args).assert().code(0);
    fs::copy(home.path().join("mine.npy"), home.path().join("mine/object-order.ids.npy")).unwrap();
    // The slides tell of times.
    for folder in ["out", "mine"] {
        fs::remove_file(home.path().join(folder).join("side-by-side.png")).unwrap();
    }
    let said = contains("equal enough: 1 pixel of 384 (1 may) differ, first (0, 3)")
        .and(contains("11 of 11 pairs equal enough"));
    let folders = ["diff", "out", "mine"];
    bothways(&home, &folders).args(["--allow-pixels", "1"]).assert().code(0).stdout(said);
    bothways(&home, &folders).args(["--ignore", "0,3,1,1"]).assert().code(0);
    bothways(&home, &folders).assert().code(1).stdout(contains("10 of 11 pairs equal, 1 differs"));
}

#[test]
fn a_tolerance_decides_on_distances_and_colors() {
    let home = rendered("1");
    edited(&home, "object-order.t.npy", [8, 12], 2.5_f32.to_le_bytes());
    let files = ["diff", "out/object-order.t.npy", "mine.npy"];
    let equal = contains("equal in everything compared: coverage, t (within 0.5)\n");
    bothways(&home, &files).assert().code(1);
    bothways(&home, &files).args(["--tolerance", "0.5"]).assert().code(0).stdout(equal);
    let pictures = ["diff", "out/object-order.png", "out/object-order.ids.png"];
    let equal = contains("equal in everything compared: colour (within 255/255)\n");
    bothways(&home, &pictures).assert().code(1);
    bothways(&home, &pictures).args(["--color-tolerance", "255"]).assert().code(0).stdout(equal);
}

/// The distances of the canonical scene, each changed by its pixel, as another file.
fn changed_t(home: &TempDir, name: &str, change: impl Fn([usize; 2], f32) -> f32) {
    let mut bytes = fs::read(home.path().join("out/object-order.t.npy")).unwrap();
    let start = bytes.len() - 4 * 24 * 16;
    for (index, number) in bytes[start..].chunks_exact_mut(4).enumerate() {
        let t = f32::from_le_bytes(number.try_into().unwrap());
        number.copy_from_slice(&change([index / 24, index % 24], t).to_le_bytes());
    }
    fs::write(home.path().join(name), bytes).unwrap();
}

#[test]
fn distances_of_other_meanings_become_t_with_the_scene() {
    let home = tempfile::tempdir().unwrap();
    let camera = ["--distance", "2", "--viewport", "3,2"];
    let args = ["canonical", "--size", "24x16", "--buffers", "npy", "--quiet", "-o", "out"];
    bothways(&home, &args).args(camera).assert().code(0);
    changed_t(&home, "axis.npy", |_, t| 2.0 * t);
    changed_t(&home, "ray.npy", |[i, j], t| {
        let (x, y) = ((2.0 * j as f32 - 23.0) / 16.0, (2.0 * i as f32 - 15.0) / 16.0);
        t * (x * x + y * y + 4.0).sqrt()
    });
    // Near 1 and far 100 along the axis; what is not seen has the depth 1.
    let window = |z: f32| if z.is_finite() { (1.0 / z - 1.0) / (1.0 / 100.0 - 1.0) } else { 1.0 };
    changed_t(&home, "opengl.npy", |_, t| window(2.0 * t));
    changed_t(&home, "reversed.npy", |_, t| 1.0 - window(2.0 * t));
    for (file, meaning, note) in [
        ("axis.npy", "axis", "distances t (from distances along the axis)"),
        ("ray.npy", "ray", "distances t (from distances along the ray)"),
        ("opengl.npy", "opengl:1,100", "distances t (from depths of OpenGL)"),
        ("reversed.npy", "opengl:100,1", "distances t (from reversed depths of OpenGL)"),
    ] {
        let files = ["diff", "out/object-order.t.npy", file, "--tolerance", "1e-3"];
        let with = |more: &[&str]| bothways(&home, &files).args(more).assert();
        let scene = [&["--depth", meaning, "--scene", "canonical"][..], &camera].concat();
        let said = contains("A  out/object-order.t.npy: distances t (t by its name)\n")
            .and(contains(note));
        with(&scene).code(0).stdout(said).stderr("");
        // Both files may be said of, each by itself.
        with(&[&["--depth", "t"], &scene[..]].concat()).code(0);
        with(&[]).code(1);
        let why = "only with the camera do";
        with(&["--depth", meaning]).code(2).stdout("").stderr(contains(why));
    }
    let parallel = ["--depth", "opengl:1,inf", "--scene", "canonical", "--projection", "parallel"];
    let refused =
        contains("with an infinite plane is of a perspective camera, but this one is parallel");
    let args = ["diff", "out/object-order.t.npy", "opengl.npy"];
    bothways(&home, &args).args(parallel).assert().code(2).stderr(refused);
    let refused =
        contains("opengl.npy: the camera's image is 8x8, and the file has 24 x 16 pixels");
    let other = ["--depth", "axis", "--scene", "canonical", "--size", "8x8"];
    bothways(&home, &args).args(other).assert().code(2).stderr(refused);
    let refused =
        contains("axis.npy: the depth at (3, 10) is 4.538").and(contains("goes from 0 to 1"));
    let args = ["diff", "axis.npy", "axis.npy", "--depth", "opengl:1,9", "--scene", "canonical"];
    bothways(&home, &args).assert().code(2).stderr(refused);
}

#[test]
fn an_exr_is_compared_by_the_channels_that_are_chosen() {
    use exr::prelude::*;
    let home = rendered("1");
    let ids = fs::read(home.path().join("out/object-order.ids.npy")).unwrap();
    let ids: Vec<u32> = ids[ids.len() - 4 * 24 * 16..]
        .chunks_exact(4)
        .map(|id| u32::from_le_bytes(id.try_into().unwrap()))
        .collect();
    let depth = vec![1.0; ids.len()];
    let channels = AnyChannels::sort(SmallVec::from_vec(vec![
        AnyChannel::new("object_id", FlatSamples::U32(ids)),
        AnyChannel::new("Z", FlatSamples::F32(depth)),
    ]));
    let layer = Layer::new((24, 16), LayerAttributes::default(), Encoding::FAST_LOSSLESS, channels);
    Image::from_layer(layer).write().to_file(home.path().join("mine.exr")).unwrap();

    let files = ["diff", "out/object-order.ids.npy", "mine.exr"];
    let refused = contains(
        "mine.exr: choose what to read of it with --channels NAME[,NAME...]; its channels are Z, object_id",
    );
    bothways(&home, &files).assert().code(2).stdout("").stderr(refused);
    let said = contains("B  mine.exr: ids (channel object_id; not read: Z)\n")
        .and(contains("equal in everything compared: coverage, ids\n"));
    let args = ["--channels", "object_id"];
    bothways(&home, &files).args(args).assert().code(0).stdout(said).stderr("");
    let both = ["diff", "mine.exr", "mine.exr", "--channels", "Z", "--channels", "object_id"];
    let said = contains("A  mine.exr: distances t (channel Z;").and(contains("B  mine.exr: ids"));
    bothways(&home, &both).assert().code(1).stdout(said);
}

#[test]
fn a_jpeg_is_compared_with_a_warning() {
    let home = rendered("1");
    let mask = image::open(home.path().join("out/mask-object-order.png")).unwrap();
    mask.save(home.path().join("mask.jpg")).unwrap();
    let warning = contains("warning: mask.jpg: JPEG changes pixels, most of all at edges");
    let args = ["diff", "out/mask-object-order.png", "mask.jpg"];
    bothways(&home, &args).assert().stderr(warning);
}

#[test]
fn two_empty_masks_are_no_evidence() {
    let home = tempfile::tempdir().unwrap();
    image::GrayImage::new(4, 2).save(home.path().join("empty.png")).unwrap();
    let args = ["diff", "empty.png", "empty.png"];
    let said = contains("intersection over union       no evidence: neither covers anything\n");
    bothways(&home, &args).assert().code(0).stdout(said);
    let report = json_of(&home, &args);
    assert_eq!(report["measures"]["coverage"]["intersection_over_union"], Value::Null);
}

#[test]
fn bad_input_is_named_and_nothing_is_written() {
    let home = rendered("1");
    let args = ["canonical", "--size", "16x24", "--quiet", "-o", "other"];
    bothways(&home, &args).assert().code(0);
    fs::write(home.path().join("text"), "no picture").unwrap();
    let ids = "out/object-order.ids.npy";
    let refused: [(&[&str], &str); 12] = [
        (
            &[ids, ids, "--ignore", "0,20,16,5"],
            "--ignore: the rectangle 0,20,16,5 ends at pixel (15, 24)",
        ),
        (
            &[ids, ids, "--ignore", "0,0,1"],
            "it has 3 numbers, but needs four; give ROW,COLUMN,HEIGHT",
        ),
        (&[ids, ids, "--allow-pixels", "-1"], "give a whole number of pixels, from 0"),
        (&[ids, ids, "--tolerance", "-1"], "give a number from 0, such as 1e-4"),
        (&[ids, ids, "--color-tolerance", "nan"], "give a number from 0; 255 is the difference of"),
        (&[ids, "missing.png"], "cannot read missing.png"),
        (&[ids, "text"], "text is neither a picture"),
        (&[ids, "out"], "out is a folder and out/object-order.ids.npy is none"),
        (&[ids, "other/mask-object-order.png"], "A is 24 x 16 pixels and B is 16 x 24"),
        (&[ids, "out/object-order.png"], "nothing in common"),
        (&[ids, ids, "--background", "black"], "six hexadecimal digits"),
        (&[ids, ids, "-o", "text"], "cannot write into the folder text"),
    ];
    let before = count(home.path());
    for (args, message) in refused {
        let said = contains(message).and(contains("panicked").not());
        bothways(&home, &["diff"]).args(args).assert().code(2).stdout("").stderr(said);
    }
    assert_eq!(count(home.path()), before);
    let help = contains("Examples:").and(contains("Exit codes"));
    bothways(&home, &["diff", "--help"]).assert().code(0).stdout(help);
}

#[test]
fn ids_that_are_saved_as_floats_are_read_as_ids() {
    let home = rendered("1");
    let mut bytes = fs::read(home.path().join("out/object-order.ids.npy")).unwrap();
    let header = bytes.len() - 4 * 24 * 16;
    let dtype = bytes.windows(3).position(|three| three == b"<u4").unwrap();
    bytes[dtype + 1] = b'f';
    for number in bytes[header..].as_chunks_mut::<4>().0 {
        let id = u32::from_le_bytes(*number);
        let float = if id == u32::MAX { -1.0 } else { f32::from(u16::try_from(id).unwrap()) };
        *number = float.to_le_bytes();
    }
    fs::write(home.path().join("floats.npy"), bytes).unwrap();
    let warning =
        || contains("floats.npy: these numbers look like ids saved as floating-point numbers");
    for scene in [&[][..], &["--scene", "canonical"]] {
        let ids = ["diff", "out/image-order.ids.npy", "floats.npy"];
        let compared = contains("compared: coverage, ids");
        bothways(&home, &ids).args(scene).assert().code(0).stdout(compared).stderr(warning());
        let as_distances = bothways(&home, &ids).args(scene).args(["--depth", "t"]).assert();
        as_distances.code(1).stdout(contains("not compared: ids: only A tells"));
    }
}
