//! The colours of OBJ files: read in the same way as `tobj` reads them, drawn alike by both orders, and replaced if
//! they are missing, with a warning.

use crate::four_renderers::RENDERERS;
use assert_cmd::Command;
use bothways::common::glam::{DVec3, Vec3};
use bothways::common::look::color::{linear_from_encoded, srgb_from_linear};
use bothways::common::scene::{Levels, MeshMaterials, Sampler, Wrap};
use bothways::common::{Frame, Material, Mesh, Options, Scene, Shape, View};
use bothways::diff::compare;
use bothways::formats::source::{Files, InputFile, Reach};
use bothways::formats::{obj, scene_file};
use bothways_test_support::{PROJECTIONS, turned};
use predicates::prelude::*;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Two squares and two triangles, in five materials; one name has blanks and a `#`.
const CARDS: &str = "\
mtllib cards.mtl more colours.mtl
v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 1\nv -1 1 1
usemtl clay
f 1 2 3 4
usemtl Material #25
f 5 6 7
usemtl clay
usemtl Material #26
f 5 7 8
usemtl matt
f 1 6 7 3
";

const CARDS_MTL: &str = "\
# by hand
newmtl clay
Ka 1 1 1
Kd 0.8 0.25 0.125
Ks 0.25 0.5 0.75
Ns 40.5
d 0.5
illum 2
map_Ks clay.png

newmtl Material #25
  Kd 0 0 1
newmtl unused
Kd 1 0 1
newmtl matt
Kd 0.5
Ks 0.5 0.5 0.5
Ns 0
";

const MORE_MTL: &str = "newmtl Material #26\r\nKd 0.1 0.9 0.1\r\nPr 0.5\r\nKs 1 1 1\r\nNs 8\r\n";

/// A folder with these files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder can be made");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("it can be written");
    }
    folder
}

/// A mesh and its two material files, which one line names with a blank between them.
fn cards() -> (TempDir, PathBuf) {
    let text = CARDS.replace("more colours.mtl", "more.mtl");
    let folder = folder(&[("cards.obj", &text), ("cards.mtl", CARDS_MTL), ("more.mtl", MORE_MTL)]);
    let path = folder.path().join("cards.obj");
    (folder, path)
}

fn read(path: &Path) -> Mesh {
    let (mesh, warnings) =
        obj::read_with_materials(&InputFile::on_disk(path, Reach::Folder)).expect("it is a mesh");
    assert_eq!(warnings, []);
    mesh
}

#[test]
fn names_and_colors_are_those_that_tobj_reads() {
    // To `tobj`, what stands behind mtllib is one file.
    let both = format!("{CARDS_MTL}{MORE_MTL}");
    // It panics where green and blue are left out.
    let both = both.replace("Kd 0.5\n", "Kd 0.5 0.5 0.5\n");
    let text = CARDS.replace("cards.mtl more colours.mtl", "all of them.mtl");
    let folder = folder(&[("cards.obj", &text), ("all of them.mtl", &both)]);
    let path = folder.path().join("cards.obj");
    let mesh = read(&path);

    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    let (models, theirs) = tobj::load_obj(&path, &options).unwrap();
    let theirs = theirs.unwrap();
    // A model begins with each material.
    let of_triangle = models.iter().flat_map(|model| {
        let triangles = model.mesh.indices.len() / 3;
        std::iter::repeat_n(model.mesh.material_id.unwrap(), triangles)
    });
    let mut triangle = 0;
    for id in of_triangle {
        let (ours, theirs) = (mesh.materials().unwrap().of(triangle).unwrap(), &theirs[id]);
        let named = mesh.materials().unwrap().named();
        let place = named.iter().position(|named| named.name == theirs.name).unwrap();
        assert_eq!(named[place].material.as_ref(), Some(ours), "triangle {triangle}");
        triangle += 1;
        if theirs.name == "matt" {
            // An exponent of 0 is no highlight to us.
            assert_eq!(
                *ours,
                Material { color: Vec3::splat(linear_from_encoded(0.5)), ..Material::default() }
            );
            continue;
        }
        let diffuse = theirs.diffuse.unwrap();
        assert_eq!(ours.color, Vec3::from(diffuse.map(linear_from_encoded)), "{}", theirs.name);
        assert_eq!(ours.shininess, theirs.shininess.unwrap_or(32.0), "{}", theirs.name);
        let specular = theirs.specular.map_or(0.0, |[r, g, b]| (r + g + b) / 3.0);
        assert_eq!(ours.specular, specular, "{}", theirs.name);
    }
    assert_eq!(triangle, mesh.triangles().len());
}

#[test]
fn several_files_may_be_named_between_blanks() {
    let (_folder, path) = cards();
    let mesh = read(&path);
    let names: Vec<&str> =
        mesh.materials().unwrap().named().iter().map(|named| named.name.as_str()).collect();
    assert_eq!(names, ["clay", "Material #25", "Material #26", "matt"]);
    let of: Vec<f32> =
        (0..6).map(|triangle| mesh.materials().unwrap().of(triangle).unwrap().shininess).collect();
    assert_eq!(of, [40.5, 40.5, 32.0, 8.0, 32.0, 32.0]);
}

#[test]
fn both_orders_draw_each_triangle_in_its_own_material() {
    let (_folder, path) = cards();
    let mesh = read(&path);
    let plain = mesh.clone().with_materials(MeshMaterials::default());
    let scene = Scene::new(vec![Shape::Mesh(mesh).into()]).unwrap();
    let plain = Scene::new(vec![Shape::Mesh(plain).into()]).unwrap();
    for projection in PROJECTIONS {
        let camera = turned(projection, [1.0, 0.7, 4.0], [0.0; 3], [48, 36]);
        let options = Options { samples: 2, ..Options::default() };
        let view = View::new(&scene, &camera);
        let frames = RENDERERS.map(|(_, render)| render(&view, &options));
        for frame in &frames[1..] {
            let comparison = compare(&frames[0], frame);
            assert!(comparison.matches() && comparison.color.differing_pixels == 0);
        }
        let seen: BTreeSet<Option<u64>> = frames[0].ids().iter().collect();
        assert!(seen.len() > 4, "{seen:?}");
        let grey = RENDERERS[0].1(&View::new(&plain, &camera), &options);
        assert!(compare(&frames[0], &grey).color.differing_pixels > 100);
    }
}

#[test]
fn a_material_of_the_scene_file_is_used_instead() {
    let (folder, _) = cards();
    // The file's own colours are not read.
    fs::write(folder.path().join("cards.mtl"), "Kd what").unwrap();
    let text = "[material.gold]\ncolor = '#ffd700'\n[[object]]\nmesh = 'cards.obj'\n";
    let own = scene_file::parse("a.toml", text, &files(&folder)).unwrap_err().to_string();
    assert!(
        own.ends_with(
            "cards.mtl:1: Kd stands before the first newmtl, so it describes no material"
        ),
        "{own}"
    );
    let gold = format!("{text}material = 'gold'\n");
    let file = scene_file::parse("a.toml", &gold, &files(&folder)).unwrap();
    let object = &file.scene.objects()[0];
    assert!((0..6).all(|triangle| *object.material_of(triangle) == object.material));
    assert_eq!(file.warnings, [""; 0]);
}

#[test]
fn what_is_moved_keeps_its_colors() {
    let (folder, _) = cards();
    let text = "[[object]]\nmesh = 'cards.obj'\nscale = 2\n";
    let file = scene_file::parse("a.toml", text, &files(&folder)).unwrap();
    assert_eq!(file.scene.objects()[0].material_of(0).shininess, 40.5);
}

#[test]
fn names_are_written_back() {
    let (folder, path) = cards();
    let mesh = read(&path);
    let mut text = Vec::new();
    obj::write(&mesh, &mut text).unwrap();
    let again = folder.path().join("again.obj");
    fs::write(&again, &text).unwrap();
    assert_eq!(read(&again), mesh);
    let text = String::from_utf8(text).unwrap();
    assert_eq!(text.matches("usemtl").count(), 4, "{text}");
}

/// The files that a scene in the folder may name.
fn files(folder: &TempDir) -> Files<'static> {
    Files::in_folder(folder.path(), Reach::Folder)
}

fn bothways(folder: &Path, args: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("bothways").expect("it is built");
    command.current_dir(folder).env("NO_COLOR", "1").args(args).assert()
}

#[test]
fn a_missing_material_file_is_a_warning() {
    let folder = folder(&[("cards.obj", CARDS), ("cards.mtl", CARDS_MTL)]);
    let says = "warning: cards.obj: there is no material file \"cards.mtl more colours.mtl\" beside \
                it; what needs it is drawn in light grey\n";
    let small = ["cards.obj", "--size", "16x12", "-o", "out"];
    bothways(folder.path(), &small).code(0).stderr(says);
    bothways(folder.path(), &[&small[..], &["--quiet"]].concat()).code(0).stderr("").stdout("");
    bothways(folder.path(), &["pixel", "cards.obj", "3", "4"]).code(0).stderr(says);

    // If a file is missing or lacks some materials, the warning names the materials.
    let undefined = CARDS.replace("mtllib cards.mtl more colours.mtl", "mtllib cards.mtl");
    fs::write(folder.path().join("cards.obj"), undefined).unwrap();
    fs::write(folder.path().join("cards.mtl"), "newmtl matt\nKd 1 1 1\n").unwrap();
    let says = "warning: cards.obj: no material file defines \"clay\", \"Material #25\", \
                \"Material #26\"; what is made of it is drawn in light grey\n";
    bothways(folder.path(), &small).code(0).stderr(says);
}

#[test]
fn a_wrong_material_file_is_an_error_that_names_its_line() {
    let (folder, _) = cards();
    let small = ["cards.obj", "--size", "16x12", "-o", "out"];
    for (text, says) in [
        ("newmtl clay\nKd 0.5 0.5 red\n", "cards.mtl:2: \"red\" is not a number"),
        ("newmtl clay\nKd 1 1 1.5\n", "cards.mtl:2: Kd has the value 1.5; it must be from 0 to 1"),
        ("newmtl clay\nKs -1 0 0\n", "cards.mtl:2: Ks has the value -1; it must be from 0 to 1"),
        ("newmtl clay\n\nKd 1 1\n", "cards.mtl:3: Kd needs one number, or three"),
        ("newmtl clay\nNs\n", "cards.mtl:2: Ns needs a number"),
        ("newmtl clay\nNs -2\n", "cards.mtl:2: Ns has the value -2; it must be at least 0"),
        ("newmtl clay\nNs nan\n", "cards.mtl:2: \"nan\" is not a finite number"),
        ("newmtl\n", "cards.mtl:1: newmtl needs the material's name"),
        ("Ns 3\n", "cards.mtl:1: Ns stands before the first newmtl, so it describes no material"),
        ("\0\x01\n", "cards.mtl:1: this is not plain text, as an OBJ or MTL file must be"),
    ] {
        fs::write(folder.path().join("cards.mtl"), text).unwrap();
        bothways(folder.path(), &small).code(2).stderr(predicate::str::contains(says));
        assert!(!folder.path().join("out").exists(), "{text:?} left something behind");
    }
}

/// What is drawn of a material is its picture, in the colours of the picture; the picture is beside the material file.
#[test]
fn a_picture_stands_in_the_place_of_a_color() {
    let (folder, path) = cards();
    let map = "Kd 0.8 0.25 0.125\nmap_Kd -s 2 3 1 -clamp on -bm 0.5 pictures\\clay tiles.png\n";
    let text = CARDS_MTL.replace("Kd 0.8 0.25 0.125\n", map);
    fs::write(folder.path().join("cards.mtl"), &text).unwrap();
    let (mesh, warnings) =
        obj::read_with_materials(&InputFile::on_disk(&path, Reach::Folder)).unwrap();
    let says = "there is no picture \"pictures/clay tiles.png\" beside it; what has it as its texture is drawn without";
    assert!(warnings.len() == 1 && warnings[0].to_string().ends_with(says), "{warnings:?}");
    let clay = mesh.materials().unwrap().of(0).unwrap();
    assert_eq!(clay.color, Vec3::from([0.8, 0.25, 0.125].map(linear_from_encoded)));

    fs::create_dir(folder.path().join("pictures")).unwrap();
    let file = folder.path().join("pictures/clay tiles.png");
    image::RgbImage::from_pixel(2, 1, image::Rgb([255, 0, 0])).save(&file).unwrap();
    let mesh = read(&path);
    let clay = mesh.materials().unwrap().of(0).unwrap();
    let texture = clay.texture.as_ref().unwrap();
    assert_eq!((clay.color, texture.pyramid.levels()[0].size()), (Vec3::ONE, [2, 1]));
    let Sampler { tiles, wrap, levels, .. } = texture.sampler;
    assert_eq!((tiles, wrap, levels), ([2.0, 3.0], [Wrap::Clamp; 2], Levels::Blended));

    fs::write(&file, "no picture").unwrap();
    let error = obj::read_with_materials(&InputFile::on_disk(&path, Reach::Folder))
        .unwrap_err()
        .to_string();
    assert!(
        error.ends_with("is no picture (PNG, JPEG, BMP or PNM); save it as one of these"),
        "{error}"
    );
}

/// A square whose corners have colours, and one half of which is made of a material.
#[test]
fn colors_of_vertices_are_drawn_alike_by_both_orders() {
    let text = "v -1 -1 0 1 0 0\nv 1 -1 0 0 1 0\nv 1 1 -3 0 0 1\nv -1 1 -3 1 1 1\nf 1 2 3\nusemtl clay\nf 1 3 4\n";
    let folder =
        folder(&[("a.obj", &format!("mtllib cards.mtl\n{text}")), ("cards.mtl", CARDS_MTL)]);
    let scene = "[[light]]\nambient = true\n[[object]]\nmesh = 'a.obj'\n";
    let colored = scene_file::parse("a.toml", scene, &files(&folder)).unwrap().scene;
    assert_eq!(colored.objects()[0].material.color, Vec3::ONE, "colours show as they are");
    for projection in PROJECTIONS {
        let camera = turned(projection, [0.5, 0.7, 3.0], [0.0, 0.0, -1.0], [60, 48]);
        let (view, options) = (View::new(&colored, &camera), Options::default());
        let frames = RENDERERS.map(|(_, render)| render(&view, &options));
        for frame in &frames[1..] {
            assert_eq!(compare(&frames[0], frame).color.differing_pixels, 0);
        }
        check_interpolated(&view, &frames[0]);
    }
    let stated = format!("{scene}material = 'grey'\n[material.grey]\ncolor = '#808080'\n");
    let stated = scene_file::parse("a.toml", &stated, &files(&folder)).unwrap().scene;
    let Shape::Mesh(mesh) = &stated.objects()[0].shape else { panic!("it is a mesh") };
    assert!(mesh.colors().is_empty(), "a stated material replaces them");
}

/// Under ambient light alone, a pixel shows the colour that the weights of its hit point give, in linear light.
fn check_interpolated(view: &View, frame: &Frame) {
    let Shape::Mesh(mesh) = &view.scene.objects()[0].shape else { panic!("it is a mesh") };
    let grid = view.camera.sample_grid(1);
    let mut seen = 0;
    for (row, &y) in grid.y().iter().enumerate() {
        for (column, &x) in grid.x().iter().enumerate() {
            let Some(id) = frame.id(row, column) else { continue };
            let triangle = mesh.triangles()[usize::try_from(id).expect("it is small")];
            let [a, b, c] = triangle.map(|v| view.offset(mesh.positions()[v as usize]));
            let ray = view.camera.ray_through(x, y);
            let normal = (b - a).cross(c - a);
            let hit = ray.origin
                + ray.direction * (normal.dot(a - ray.origin) / normal.dot(ray.direction));
            let part =
                |p: DVec3, q: DVec3| (p - hit).cross(q - hit).dot(normal) / normal.length_squared();
            let weights = [part(b, c), part(c, a), part(a, b)];
            let colors = triangle.map(|v| mesh.colors()[v as usize].as_dvec3());
            let mixed: DVec3 = (0..3).map(|k| colors[k] * weights[k]).sum();
            let material =
                view.scene.objects()[0].material_of(usize::try_from(id).expect("it is small"));
            let expected = (mixed.as_vec3() * material.color).to_array().map(srgb_from_linear);
            let found = frame.picture()[row * frame.width() + column];
            assert!((0..3).all(|k| found[k].abs_diff(expected[k]) <= 1), "{found:?} {expected:?}");
            seen += 1;
        }
    }
    assert!(seen > 300, "{seen}");
}
