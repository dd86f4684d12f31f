//! Golden pictures: approved pictures of the built-in scenes.
//!
//! The pictures are in `tests/golden/`. Our own diff compares them within its tolerance for colours: other machines
//! round powers and text differently, by a step or two of 255. The textbooks render all pictures, so that the counts
//! on the slides also agree with the definition of work; slides have a quarter of their size.
//!
//! A failure leaves the new picture and the difference in `target/tmp/golden/`. If the change is intended, look at
//! the new pictures, rewrite the old pictures, and review them like code:
//!
//! ```sh
//! BOTHWAYS_WRITE_GOLDEN=1 cargo test --test figures golden
//! ```

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use bothways::common::glam::Vec3;
use bothways::common::{Camera, CameraDescription, View};
use bothways::diff::{compare, foreign};
use bothways::figure::{Kind, Slide, Subject, Theme};
use bothways::orders::{Method, Order, RenderOptions, Rules, render};
use bothways::scenes::load;
use bothways::wording::count;
use image::{RgbImage, imageops};
use std::fs;
use std::path::{Path, PathBuf};

/// Scenes that show much in few pixels. `lecture` and `many` take long, and their looks change more often.
const SCENES: [(&str, &str); 6] = [
    ("canonical", "48x48"),
    ("ties", "64x64"),
    ("behind", "64x48"),
    ("slivers", "40x30"),
    ("overlap", "40x30"),
    ("inside", "40x30"),
];

/// Whether the approved pictures are being rewritten.
fn writing() -> bool {
    std::env::var_os("BOTHWAYS_WRITE_GOLDEN").is_some()
}

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name)
}

/// The folder for the pictures of failed tests. Tests that run at the same time use different names.
fn workshop(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Compares a picture with the approved one.
///
/// # Errors
///
/// If they differ: by how much, and where the new picture and the difference are.
fn compare_with(approved: &Path, picture: &RgbImage, workshop: &Path) -> Result<(), String> {
    let name = approved.file_name().unwrap().to_str().unwrap();
    let new = workshop.join(name);
    let difference = workshop.join(format!("difference-{name}"));
    picture.save(&new).unwrap();
    let _ = fs::remove_file(&difference);
    let read = |path: &Path| foreign::read(path, None).map_err(|error| error.to_string());
    let comparison = foreign::compare(&read(approved)?, &read(&new)?)
        .map_err(|error| format!("A = {}, B = {}: {error}", approved.display(), new.display()))?;
    if comparison.equal {
        fs::remove_file(new).unwrap();
        return Ok(());
    }
    comparison.picture().save(&difference).unwrap();
    let pixels = count(comparison.differing_pixels, "pixels");
    let most = comparison.color.map_or(0.0, |color| color.max_difference);
    let (new, difference) = (new.display(), difference.display());
    Err(format!(
        "{name}: {pixels} beyond the tolerance, by up to {most}/255: see {new} and {difference}"
    ))
}

/// Compares all pictures with the approved ones, or replaces those.
fn check(pictures: &[(String, RgbImage)]) {
    if writing() {
        for (name, picture) in pictures {
            picture.save(golden(name)).unwrap();
        }
        return;
    }
    let workshop = workshop("golden");
    let results =
        pictures.iter().map(|(name, picture)| compare_with(&golden(name), picture, &workshop));
    let failures: Vec<String> = results.filter_map(Result::err).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

fn reduced(slide: &RgbImage) -> RgbImage {
    imageops::thumbnail(slide, slide.width() / 4, slide.height() / 4)
}

#[test]
fn the_built_in_scenes_look_as_they_did() {
    let home = tempfile::tempdir().unwrap();
    let mut pictures = Vec::new();
    for (scene, size) in SCENES {
        let args = [scene, "--size", size, "--method", "textbook", "--no-times", "--quiet"];
        let mut command = Command::cargo_bin("bothways").unwrap();
        command.current_dir(&home).args(args).args(["-o", "."]).assert().code(0);
        let picture = |name: &str| image::open(home.path().join(name)).unwrap().to_rgb8();
        for name in ["object-order.png", "image-order.png", "difference.png"] {
            pictures.push((format!("{scene}-{name}"), picture(name)));
        }
        if scene == "canonical" {
            let name = format!("{scene}-side-by-side.png");
            pictures.push((name, reduced(&picture("side-by-side.png"))));
        }
    }
    check(&pictures);
}

#[test]
fn a_slide_shows_every_kind_of_difference() {
    let loaded = load("canonical").unwrap();
    let description = CameraDescription { image: [48, 48], ..loaded.camera };
    // As if image order had its eye elsewhere.
    let moved = CameraDescription { eye: Vec3::new(0.25, 0.125, 0.0), ..description };
    let [here, there] = [description, moved].map(|camera| Camera::new(camera).unwrap());
    let rendered = |order, camera| {
        let view = View::new(&loaded.scene, camera);
        let options = RenderOptions { no_times: true, ..RenderOptions::default() };
        render(order, Method::Textbook, &view, &options).unwrap()
    };
    let object_order = rendered(Order::Object, &here);
    let image_order = rendered(Order::Image, &there);
    let pictures = [&object_order, &image_order].map(|one| bothways::picture::picture(&one.frame));
    let slide = Slide {
        scene: "canonical, with the eye moved for one of them",
        about: loaded.about(),
        primitives: loaded.scene.primitive_count(),
        threads: 1,
        object_order: &object_order,
        image_order: &image_order,
        pictures: pictures.each_ref(),
        comparison: &compare(&object_order.frame, &image_order.frame),
    };
    check(&[("differing-side-by-side.png".into(), reduced(&slide.draw(Theme::Dark).pixels(1920)))]);
}

#[test]
fn the_figures_look_as_they_did() {
    let loaded = load("canonical").unwrap();
    let description = CameraDescription { image: [32, 24], ..loaded.camera };
    let camera = Camera::new(description).unwrap();
    let figure = |kind: Kind| {
        // A mistake to see, where figures compare.
        let object_order = Some("corner".parse().unwrap()).filter(|_| kind.compares());
        let subject = Subject {
            name: "canonical",
            about: loaded.about(),
            view: View::new(&loaded.scene, &camera),
            pixels: &[],
            samples: 1,
            rules: Rules { object_order, image_order: None },
            theme: Theme::Dark,
        };
        (format!("figure-{kind}.png"), kind.draw(&subject).unwrap().pixels(480))
    };
    check(&Kind::ALL.map(figure));
}

#[test]
fn a_picture_that_changes_is_noticed() {
    if writing() {
        return;
    }
    let workshop = workshop("golden-noticed");
    let approved = golden("canonical-object-order.png");
    let mut picture = image::open(&approved).unwrap().to_rgb8();
    assert_eq!(compare_with(&approved, &picture, &workshop), Ok(()));
    picture[(20, 30)].0[1] ^= 2;
    assert_eq!(compare_with(&approved, &picture, &workshop), Ok(()));
    picture[(20, 30)].0[1] ^= 8;
    let failure = compare_with(&approved, &picture, &workshop).unwrap_err();
    assert!(failure.starts_with("canonical-object-order.png: 1 pixel beyond"), "{failure}");
    assert!(workshop.join("difference-canonical-object-order.png").exists());

    let other = golden("behind-object-order.png");
    assert!(compare_with(&other, &picture, &workshop).unwrap_err().contains("is 48 x 48"));
}
