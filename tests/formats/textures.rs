//! Textures of scene files: what their pictures become, and what is said about files that are none.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use bothways::common::glam::{DVec2, Vec3};
use bothways::common::look::color::linear_from_srgb;
use bothways::common::scene::Texture;
use bothways::formats::scene_file::{self, ReadSceneError};
use bothways::formats::source::{Files, Reach};
use image::{GrayImage, Luma, Rgb, RgbImage, Rgba, RgbaImage};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A folder with the folder of a scene in it, which has a picture of four pixels.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let scene = folder.path().join("scene");
    fs::create_dir(&scene).unwrap();
    four().save(scene.join("four.png")).unwrap();
    four().save(folder.path().join("beside.png")).unwrap();
    folder
}

/// Red and green above, blue and grey below.
fn four() -> RgbImage {
    let colors = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [188, 188, 188]];
    RgbImage::from_fn(2, 2, |x, y| Rgb(colors[(2 * y + x) as usize]))
}

/// The files of the scene.
fn files(folder: &Path) -> Files<'static> {
    Files::in_folder(&folder.join("scene"), Reach::Folder)
}

fn scene_with(folder: &Path, texture: &str) -> Result<scene_file::SceneFile, ReadSceneError> {
    let text = format!(
        "[material.m]\ntexture = {texture}\n[[object]]\nmaterial = 'm'\n\
         sphere = {{ center = [0, 0, 0], radius = 1 }}\n"
    );
    scene_file::parse("scene.toml", &text, &files(folder))
}

fn texture(folder: &Path, texture: &str) -> Texture {
    let file = scene_with(folder, texture).unwrap_or_else(|error| panic!("{error}"));
    let material = &file.scene.objects()[0].material;
    assert_eq!(material.color, Vec3::ONE, "the picture shows in its own colours");
    material.texture.clone().expect("it has one")
}

fn error(folder: &Path, texture: &str) -> String {
    let error = scene_with(folder, texture).expect_err("it is wrong").to_string();
    error.replace(&format!("{}/", folder.join("scene").display()), "")
}

#[test]
fn a_picture_is_decoded_from_srgb() {
    let folder = folder();
    let nearest = texture(folder.path(), "{ file = 'four.png', filter = 'nearest' }");
    let at = |x, y| nearest.color(DVec2::new(x, y), 0.0);
    assert_eq!(at(0.25, 0.75), Vec3::X, "(0, 1) is the upper left corner");
    assert_eq!(at(0.25, 0.25), Vec3::Z);
    // IEC 61966-2-1: 188 stands for half of the light, nearly.
    let grey = f64::from(at(0.75, 0.25).x);
    let expected = ((188.0 / 255.0 + 0.055) / 1.055_f64).powf(2.4);
    assert!((grey - expected).abs() < 1e-6 && (grey - 0.5).abs() < 0.005, "{grey}");
    // Half of red and half of green, in linear light.
    let bilinear = texture(folder.path(), "'four.png'");
    let between = bilinear.color(DVec2::new(0.5, 0.75), 0.0);
    assert!((between - Vec3::new(0.5, 0.5, 0.0)).length() < 1e-6, "{between}");
}

#[test]
fn pictures_of_every_kind_have_the_same_texels() {
    let folder = folder();
    let scene = folder.path().join("scene");
    let expected = texture(folder.path(), "'four.png'");
    four().save(scene.join("four.bmp")).unwrap();
    four().save(scene.join("four.ppm")).unwrap();
    let alpha = RgbaImage::from_fn(2, 2, |x, y| {
        let [r, g, b] = four().get_pixel(x, y).0;
        Rgba([r, g, b, 77])
    });
    alpha.save(scene.join("alpha.png")).unwrap();
    let fine = image::ImageBuffer::from_fn(2, 2, |x, y| {
        Rgb(four().get_pixel(x, y).0.map(|value| u16::from(value) * 257))
    });
    fine.save(scene.join("fine.png")).unwrap();
    for file in ["four.bmp", "four.ppm", "alpha.png", "fine.png"] {
        assert_eq!(texture(folder.path(), &format!("'{file}'")), expected, "{file}");
    }
    GrayImage::from_pixel(3, 1, Luma([188])).save(scene.join("grey.png")).unwrap();
    let grey = texture(folder.path(), "'grey.png'").color(DVec2::new(0.3, 0.3), 0.0);
    assert_eq!(grey, Vec3::splat(linear_from_srgb(188)));
}

#[test]
fn a_file_that_two_materials_name_is_read_once() {
    let folder = folder();
    let text = "material.a.texture = 'four.png'\n\
                material.b.texture = { file = './four.png', filter = 'nearest' }\n\
                [[object]]\nmaterial = 'a'\nsphere = { center = [0, 0, 0], radius = 1 }\n\
                [[object]]\nmaterial = 'b'\nsphere = { center = [0, 0, 0], radius = 1 }\n";
    let file = scene_file::parse("a.toml", text, &files(folder.path())).unwrap();
    let texture = |k: usize| file.scene.objects()[k].material.texture.as_ref().unwrap();
    assert!(std::sync::Arc::ptr_eq(&texture(0).pyramid, &texture(1).pyramid));
    assert_ne!(texture(0).sampler, texture(1).sampler);
}

#[test]
fn what_is_no_texture_is_refused_with_its_reason() {
    let folder = folder();
    let scene = folder.path().join("scene");
    let png = fs::read(scene.join("four.png")).unwrap();
    fs::write(scene.join("short.png"), &png[..png.len() - 20]).unwrap();
    fs::write(scene.join("text.png"), "no picture\n").unwrap();
    fs::write(scene.join("empty.png"), "").unwrap();
    fs::write(scene.join("huge.png"), huge(&png)).unwrap();
    fs::write(scene.join("none.ppm"), "P6\n0 4\n255\n").unwrap();
    fs::create_dir(scene.join("folder.png")).unwrap();
    let short = png.len() - 20;
    let cases = [
        ("'missing.png'", "missing.png: there is no such file".to_owned()),
        ("'folder.png'", "folder.png: this is a folder, not a picture".to_owned()),
        ("'text.png'", "text.png is no picture (PNG, JPEG, BMP or PNM); save it as one of these".into()),
        ("'empty.png'", "empty.png is no picture (PNG, JPEG, BMP or PNM); save it as one of these".into()),
        (
            "'short.png'",
            format!("short.png: the file ends early, after {short} bytes; copy it or write it again"),
        ),
        (
            "'huge.png'",
            "huge.png: it has 60000 x 60000 pixels; the textures of a file may have 134217728 together, \
             and 134217728 are left: make it smaller"
                .into(),
        ),
    ];
    for (file, expected) in cases {
        assert_eq!(error(folder.path(), file), format!("scene.toml:2:11: {expected}"));
    }
    assert!(error(folder.path(), "'none.ppm'").starts_with("scene.toml:2:11: none.ppm: "));
}

/// The picture with a header that states 60,000 × 60,000 pixels, and the right checksum.
fn huge(png: &[u8]) -> Vec<u8> {
    let mut bytes = png.to_vec();
    let side = 60_000_u32.to_be_bytes();
    bytes[16..20].copy_from_slice(&side);
    bytes[20..24].copy_from_slice(&side);
    let checksum = bytes[12..29].iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg())
        })
    });
    bytes[29..33].copy_from_slice(&(!checksum).to_be_bytes());
    bytes
}

#[test]
fn a_picture_outside_of_the_folder_is_not_read() {
    let folder = folder();
    let absolute = folder.path().join("beside.png").display().to_string();
    for name in ["../beside.png", "x/../../beside.png", "../no-such.png", &absolute, "C:\\a.png"] {
        let expected = format!(
            "scene.toml:2:11: \"{}\" is not in the folder of the file that was opened, or below it; move it there, \
             or allow it with --allow-outside",
            name.replace('\\', "\\\\")
        );
        let scene = scene_with(folder.path(), &format!("'{name}'"));
        let said = scene.expect_err("it is outside").to_string();
        assert!(said == expected || said == expected.replace("\\\\", "\\"), "{said}\n{expected}");
    }
    #[cfg(unix)]
    {
        let link = folder.path().join("scene/link.png");
        std::os::unix::fs::symlink(folder.path().join("beside.png"), link).unwrap();
        assert!(error(folder.path(), "'link.png'").contains("is not in the folder"));
    }
    // Below it, all names are read.
    fs::create_dir(folder.path().join("scene/below")).unwrap();
    four().save(folder.path().join("scene/below/b.png")).unwrap();
    texture(folder.path(), "'below/../below/b.png'");
}

#[test]
fn what_is_wrong_with_the_keys_of_a_texture() {
    let folder = folder();
    let cases = [
        ("3", "2:11: texture is a whole number; it must be a string"),
        (
            "{ filter = 'nearest' }",
            "2:11: texture lacks file; write for example texture = { file = \"tiles.png\", filter = \"bilinear\" }",
        ),
        (
            "{ file = 'four.png', filter = 'linear' }",
            "2:41: filter is \"linear\"; did you mean \"bilinear\"?",
        ),
        (
            "{ file = 'four.png', wrap = ['repeat', 'mirrored'] }",
            "2:50: wrap[1] is \"mirrored\"; did you mean \"mirror\"?",
        ),
        (
            "{ file = 'four.png', wrap = ['clamp'] }",
            "2:39: wrap has 1 element; it must be a word, or two words in brackets",
        ),
        ("{ file = 'four.png', tiles = [1, 0] }", "2:44: tiles[1] is 0; it must be greater than 0"),
        ("{ file = 'four.png', scale = 2 }", "2:32: texture has no key \"scale\""),
        (
            "'four.png'\nchecker = { color = '#000000', divisions = [2, 2] }",
            "2:1: a material takes one of checker and texture, and this one has both; remove one of them",
        ),
    ];
    for (texture, expected) in cases {
        let error = error(folder.path(), texture);
        let expected = format!("scene.toml:{expected}");
        assert!(
            error == expected || error.starts_with(&format!("{expected};")),
            "{error}\n{expected}"
        );
    }
}

#[test]
fn the_program_draws_a_texture_and_says_what_is_wrong_with_it() {
    let folder = folder();
    let scene = folder.path().join("scene");
    let text = "material.m.texture = 'four.png'\n[camera]\nimage = [16, 12]\neye = [0, 0, 3]\n\
                [[object]]\nmaterial = 'm'\nsphere = { center = [0, 0, 0], radius = 1 }\n";
    fs::write(scene.join("a.toml"), text).unwrap();
    fs::write(scene.join("b.toml"), text.replace("four.png", "text.png")).unwrap();
    fs::write(scene.join("text.png"), "no picture\n").unwrap();
    let run = |file: &str| {
        let mut command = assert_cmd::Command::cargo_bin("bothways").expect("it is built");
        command.current_dir(&scene).env("NO_COLOR", "1").args([
            file,
            "-o",
            file.strip_suffix(".toml").unwrap(),
        ]);
        command.output().expect("it runs")
    };
    let good = run("a.toml");
    assert_eq!(good.status.code(), Some(0), "{}", String::from_utf8_lossy(&good.stderr));
    assert!(scene.join("a/object-order.png").exists());
    let bad = run("b.toml");
    assert_eq!(bad.status.code(), Some(2));
    let said = String::from_utf8(bad.stderr).unwrap();
    assert!(
        said.contains("text.png is no picture (PNG, JPEG, BMP or PNM); save it as one of these"),
        "{said}"
    );
    assert!(said.contains("b.toml:1:22"), "{said}");
    assert!(!scene.join("b").exists(), "nothing half written");
}
