//! The conformance set from the view of another project: files alone, and a rasterizer of one page in rational
//! numbers that shares no code with this project.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::Command;
use bothways::common::glam::{DMat4, DVec3};
use bothways::common::{Shape, View};
use bothways::formats::obj;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use predicates::str::contains;
use serde_json::Value;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn vectors(home: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.current_dir(home).arg("vectors").args(args);
    command
}

/// The set, freshly written.
fn written() -> TempDir {
    let home = tempfile::tempdir().unwrap();
    vectors(&home, &["-o", "."]).assert().code(0).stdout(contains("both orders agree")).stderr("");
    home
}

fn json(folder: &Path, name: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.join(name)).unwrap()).unwrap()
}

/// The entry of each scene in the index, and the content of its JSON file.
fn scenes(folder: &Path) -> Vec<(Value, Value)> {
    let index = json(folder, "index.json");
    let entries = index["scenes"].as_array().unwrap().clone();
    let scene = |entry: &Value| json(folder, &format!("{}.json", text(&entry["name"])));
    entries.into_iter().map(|entry| (entry.clone(), scene(&entry))).collect()
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap()
}

fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    list(value).iter().map(|number| number.as_f64().unwrap()).collect()
}

/// The numbers of a table, row by row; `nothing` for null.
fn table(value: &Value, nothing: f64) -> Vec<f64> {
    let rows = list(value).iter().flat_map(list);
    rows.map(|cell| if cell.is_null() { nothing } else { cell.as_f64().unwrap() }).collect()
}

/// The `f32` that a JSON number gives in its shortest form; infinity for null.
fn single(value: &Value) -> f32 {
    if value.is_null() { f32::INFINITY } else { value.to_string().parse().unwrap() }
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
    entries
        .map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap()))
        .collect()
}

// ---- the independent rasterizer ----

type Number = BigRational;

/// A corner in pixels, and what is linear between corners: the larger, the nearer.
struct Corner {
    x: Number,
    y: Number,
    nearness: Number,
}

/// A linear function of the picture at a sample: its value, and its slopes to the right and down.
/// In this order they decide its sign, or whether it is larger, as if the sample were moved
/// infinitely little to the right and far less still down.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Linear([Number; 3]);

impl Linear {
    /// Twice the signed area of the triangle `a`, `b`, sample.
    fn edge(a: &Corner, b: &Corner, x: &Number, y: &Number) -> Linear {
        let (dx, dy) = (&b.x - &a.x, &b.y - &a.y);
        Linear([&dx * (y - &a.y) - &dy * (x - &a.x), -dy, dx])
    }

    /// The sign of the function beside the sample; `Equal` only if the function is zero everywhere.
    fn sign(&self) -> Ordering {
        let decisive = self.0.iter().find(|number| !number.is_zero());
        decisive.map_or(Ordering::Equal, |number| number.cmp(&Number::zero()))
    }
}

/// The nearness of a triangle at a sample; `None` if the triangle does not cover the sample.
fn nearness([a, b, c]: &[Corner; 3], x: &Number, y: &Number) -> Option<Linear> {
    let area = Linear::edge(a, b, &c.x, &c.y).0[0].clone();
    let edges = [(b, c), (c, a), (a, b)].map(|(p, q)| Linear::edge(p, q, x, y));
    let facing = area.cmp(&Number::zero());
    if area.is_zero() || edges.iter().any(|edge| edge.sign() != facing) {
        return None;
    }
    let weighted = |part: usize| {
        let corners = [a, b, c].into_iter().zip(&edges);
        let sum = corners.map(|(corner, edge)| &corner.nearness * &edge.0[part]).sum::<Number>();
        sum / &area
    };
    Some(Linear([weighted(0), weighted(1), weighted(2)]))
}

fn rational(value: &Value) -> Number {
    Number::from_float(value.as_f64().unwrap()).unwrap()
}

fn corners(triangle: &Value, interpolate: &str) -> [Corner; 3] {
    [0, 1, 2].map(|corner| {
        let [x, y, t] = [0, 1, 2].map(|axis| rational(&triangle[corner][axis]));
        assert!(t.is_positive());
        let nearness = if interpolate == "1/t" { t.recip() } else { -t };
        Corner { x, y, nearness }
    })
}

/// The id of the visible triangle at a sample, and its `t`.
fn seen(triangles: &[[Corner; 3]], interpolate: &str, i: u32, j: u32) -> Option<(u64, f64)> {
    let [x, y] = [j, i].map(|index| Number::from_float(f64::from(index) + 0.5).unwrap());
    let covering = (0..)
        .zip(triangles)
        .filter_map(|(id, triangle)| nearness(triangle, &x, &y).map(|nearness| (id, nearness)));
    // Of equals the first stays.
    let nearest = covering.reduce(|held, next| if next.1 > held.1 { next } else { held });
    nearest.map(|(id, Linear([nearness, ..]))| {
        let t = if interpolate == "1/t" { nearness.recip() } else { -nearness };
        (id, t.to_f64().unwrap())
    })
}

#[test]
fn an_independent_rasterizer_sees_the_same() {
    let home = written();
    let mut checked = 0;
    for (entry, scene) in scenes(home.path()) {
        assert_eq!(entry["raster"], !scene["raster"].is_null());
        let Some(triangles) = scene["raster"].as_array() else { continue };
        let interpolate = text(&scene["interpolate"]);
        let triangles: Vec<_> =
            triangles.iter().map(|triangle| corners(triangle, interpolate)).collect();
        for (i, (ids, distances)) in (0..).zip(list(&scene["ids"]).iter().zip(list(&scene["t"]))) {
            for (j, (id, t)) in (0..).zip(list(ids).iter().zip(list(distances))) {
                let seen = seen(&triangles, interpolate, i, j);
                let name = &scene["name"];
                assert_eq!(seen.map(|(id, _)| id), id.as_u64(), "{name}: pixel ({i}, {j})");
                let Some((_, exact)) = seen else { continue };
                // Half a unit in the last place of an f32, and what the f64 before it lost.
                let error = (f64::from(single(t)) - exact).abs();
                assert!(error <= exact * 6.1e-8, "{name}: t {t} at ({i}, {j}), not {exact}");
                checked += 1;
            }
        }
    }
    assert!(checked > 1000, "only {checked} samples were covered");
}

/// The nearness of a triangle of the world along the ray of a sample; `None` if the triangle does not cover the sample.
///
/// The ray's direction is a sum `α·a + β·b + γ·c` of the corners; the sample is covered if all three
/// are positive, and `1/t` is their sum, wherever the corners are. Like the direction they are linear
/// in the sample's place, which moves right along `x` and down against `y`.
fn nearness_in_the_world([a, b, c]: &[[Number; 3]; 3], direction: &[Number; 3]) -> Option<Linear> {
    let volume = determinant(a, b, c);
    if volume.is_zero() {
        return None;
    }
    let [zero, one] = [0, 1].map(|number| Number::from_integer(number.into()));
    let moves = [
        direction.clone(),
        [one.clone(), zero.clone(), zero.clone()],
        [zero.clone(), -one, zero.clone()],
    ];
    let part = |p, q| Linear([0, 1, 2].map(|k| determinant(&moves[k], p, q) / &volume));
    let parts = [part(b, c), part(c, a), part(a, b)];
    let covered = parts.iter().all(|part| part.sign().is_gt());
    let sum = |k: usize| parts.iter().map(|part| &part.0[k]).sum::<Number>();
    covered.then(|| Linear([sum(0), sum(1), sum(2)]))
}

fn determinant(a: &[Number; 3], b: &[Number; 3], c: &[Number; 3]) -> Number {
    let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
    &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1)
}

/// Whether the camera is a perspective camera at the origin, along the world's axes, with pixels of side 1.
fn is_straight(scene: &Value) -> bool {
    let axes = ["eye", "u", "v", "w"].map(|key| numbers(&scene[key]));
    let straight = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    scene["projection"] == "perspective"
        && numbers(&scene["viewport"]) == numbers(&scene["image"])
        && axes.iter().zip(straight).all(|(axis, straight)| *axis == straight)
}

#[test]
fn independent_rays_see_the_same_behind_the_eye_too() {
    let home = written();
    let mut behind = 0;
    for (_, scene) in scenes(home.path()).iter().filter(|(_, scene)| is_straight(scene)) {
        behind += u32::from(scene["raster"].is_null());
        let vertex = |index: &Value| {
            let vertex = usize::try_from(index.as_u64().unwrap()).unwrap();
            [0, 1, 2].map(|axis| rational(&scene["vertices"][vertex][axis]))
        };
        let triangles: Vec<_> = list(&scene["triangles"])
            .iter()
            .map(|triangle| [0, 1, 2].map(|corner| vertex(&triangle[corner])))
            .collect();
        let half = |side: usize| scene["image"][side].as_f64().unwrap() / 2.0;
        for (i, ids) in (0_u32..).zip(list(&scene["ids"])) {
            for (j, id) in (0_u32..).zip(list(ids)) {
                let [x, y] = [f64::from(j) + 0.5 - half(0), half(1) - 0.5 - f64::from(i)];
                let [x, y] = [x, y].map(|number| Number::from_float(number).unwrap());
                let direction = [x, y, -rational(&scene["distance"])];
                let covering = (0_u64..).zip(&triangles).filter_map(|(id, triangle)| {
                    nearness_in_the_world(triangle, &direction).map(|nearness| (id, nearness))
                });
                let seen = covering.reduce(|held, next| if next.1 > held.1 { next } else { held });
                let name = &scene["name"];
                assert_eq!(seen.map(|(id, _)| id), id.as_u64(), "{name}: pixel ({i}, {j})");
            }
        }
    }
    assert!(behind >= 7, "only {behind} scenes reach behind the eye");
}

#[test]
fn every_file_is_there_and_says_the_same() {
    let home = written();
    let mut listed = vec!["README.md".to_owned(), "index.json".to_owned()];
    let scenes = scenes(home.path());
    assert!((40..=80).contains(&scenes.len()), "{} scenes", scenes.len());
    for (entry, scene) in scenes {
        listed.extend(list(&entry["files"]).iter().map(|file| text(file).to_owned()));
        let name = text(&entry["name"]);
        let place = |ending: &str| home.path().join(format!("{name}{ending}"));
        for key in ["name", "group", "point", "image"] {
            assert_eq!(entry[key], scene[key], "{name}: {key}");
        }

        let ids = table(&scene["ids"], f64::from(u32::MAX));
        let npy: Vec<u32> =
            npyz::NpyFile::new(&*fs::read(place(".ids.npy")).unwrap()).unwrap().into_vec().unwrap();
        assert_eq!(npy.into_iter().map(f64::from).collect::<Vec<_>>(), ids, "{name}: ids");
        let npy: Vec<f32> =
            npyz::NpyFile::new(&*fs::read(place(".t.npy")).unwrap()).unwrap().into_vec().unwrap();
        let distances: Vec<f32> = list(&scene["t"]).iter().flat_map(list).map(single).collect();
        assert_eq!(npy, distances, "{name}: t");
        let mask = image::open(place(".mask.png")).unwrap().into_luma8();
        assert_eq!(numbers(&scene["image"]), [mask.width(), mask.height()].map(f64::from));
        let covered: Vec<bool> = ids.iter().map(|&id| id < f64::from(u32::MAX)).collect();
        assert!(mask.iter().zip(&covered).all(|(&byte, &covered)| byte == 255 * u8::from(covered)));
        let count = covered.iter().filter(|&&covered| covered).count();
        assert_eq!(entry["covered"].as_u64(), Some(count as u64), "{name}: covered");

        check_scene(name, &scene, &place(".toml"), &place(".obj"));
    }
    listed.sort();
    assert_eq!(files(home.path()).into_keys().collect::<Vec<_>>(), listed);
}

/// The scene file, the mesh and the JSON describe one scene.
fn check_scene(name: &str, scene: &Value, toml: &Path, mesh: &Path) {
    let loaded = bothways::scenes::load(toml.to_str().unwrap()).unwrap();
    let mesh = obj::read(mesh).unwrap();
    let [object] = loaded.scene.objects() else { panic!("{name}: one mesh") };
    // A mesh without normals gets smooth ones in a scene; what covers pixels stays.
    let Shape::Mesh(shown) = &object.shape else { panic!("{name}: the object is no mesh") };
    assert_eq!(shown.positions(), mesh.positions(), "{name}: positions");
    assert_eq!(shown.triangles(), mesh.triangles(), "{name}: triangles");
    let positions: Vec<Vec<f64>> =
        mesh.positions().iter().map(|position| position.as_dvec3().to_array().to_vec()).collect();
    let stated: Vec<Vec<f64>> = list(&scene["vertices"]).iter().map(numbers).collect();
    assert_eq!(positions, stated, "{name}: vertices");
    assert_eq!(serde_json::json!(mesh.triangles()), scene["triangles"], "{name}: triangles");

    let camera = bothways::common::Camera::new(loaded.camera).unwrap();
    let stated = ["u", "v", "w"].map(|axis| numbers(&scene[axis]));
    assert_eq!([camera.u(), camera.v(), camera.w()].map(|axis| axis.to_array().to_vec()), stated);
    assert_eq!(camera.viewport().to_vec(), numbers(&scene["viewport"]), "{name}: viewport");
}

#[test]
fn the_matrices_put_vertices_where_the_raster_coordinates_are() {
    let home = written();
    for (_, scene) in scenes(home.path()).iter().filter(|(_, scene)| !scene["raster"].is_null()) {
        assert_eq!(scene["opengl_layout"], "row-major");
        let matrix = |key: &str| {
            let rows: Vec<f64> = list(&scene[key]).iter().flat_map(numbers).collect();
            DMat4::from_cols_slice(&rows).transpose()
        };
        let clip_from_world = matrix("opengl_projection") * matrix("opengl_view");
        let image = numbers(&scene["image"]);
        for (triangle, corners) in list(&scene["triangles"]).iter().zip(list(&scene["raster"])) {
            for (vertex, corner) in list(triangle).iter().zip(list(corners)) {
                let vertex = usize::try_from(vertex.as_u64().unwrap()).unwrap();
                let position = DVec3::from_slice(&numbers(&scene["vertices"][vertex]));
                let place = clip_from_world.project_point3(position);
                let corner = numbers(corner);
                let x = (1.0 + place.x) / 2.0 * image[0];
                let y = (1.0 - place.y) / 2.0 * image[1];
                let error = (x - corner[0]).abs().max((y - corner[1]).abs());
                assert!(error < 1e-9, "{}: ({x}, {y}) is not {corner:?}", scene["name"]);
            }
        }
    }
}

#[test]
fn the_camera_writes_its_matrices_in_the_same_layout() {
    let home = written();
    let mut command = Command::cargo_bin("bothways").unwrap();
    command.args(["camera", "--json"]).arg(home.path().join("turned-box.toml"));
    let camera: Value = serde_json::from_slice(&command.output().unwrap().stdout).unwrap();
    let scene = json(home.path(), "turned-box.json");
    assert_eq!(camera["opengl"]["layout"], scene["opengl_layout"]);
    // The view has no symmetry that would hide a transposition.
    assert_eq!(camera["opengl"]["view"], scene["opengl_view"]);
    assert_ne!(camera["opengl"]["view"][0][3], camera["opengl"]["view"][3][0]);
}

#[test]
fn distances_are_written_in_at_most_nine_digits() {
    let home = written();
    for (entry, scene) in scenes(home.path()) {
        for t in list(&scene["t"]).iter().flat_map(list).filter(|t| !t.is_null()) {
            let text = t.to_string();
            // Nine significant digits distinguish all `f32`.
            let digits = text.split('e').next().unwrap().trim_matches(['0', '.']);
            let digits = digits.chars().filter(char::is_ascii_digit).count();
            assert!(digits <= 9, "{}: {text}", entry["name"]);
        }
    }
}

/// The visible primitives if `x` and `y` are computed in `f64` in the order in which the lecture writes them.
fn seen_with_the_lecture_s_formula(vector: &bothways::vectors::Vector) -> Vec<Option<u64>> {
    let (scene, camera) = (vector.scene(), vector.camera());
    let view = View::new(&scene, &camera);
    let ([width, height], [vw, vh]) = (camera.image(), camera.viewport());
    let place = |side: f64, index: u32, count: u32| {
        side * ((f64::from(index + 1) - 0.5) / f64::from(count) - 0.5)
    };
    let pixels = (0..height).flat_map(|i| (0..width).map(move |j| (i, j)));
    let seen = |(i, j)| {
        let ray = camera.ray_through(place(vw, j, width), -place(vh, i, height));
        let covering = view.primitives().filter(|(_, one)| view.judge().covers(one, &ray));
        let nearest = covering.reduce(|held, next| {
            let nearer = view.judge().nearer((next.0, &next.1), (held.0, &held.1), &ray);
            if nearer { next } else { held }
        });
        nearest.map(|(id, _)| id)
    };
    pixels.map(seen).collect()
}

#[test]
fn the_readme_s_numbers_are_those_of_the_set() {
    let home = written();
    let readme = fs::read_to_string(home.path().join("README.md")).unwrap();
    let scenes = scenes(home.path());
    let without: Vec<&str> = scenes
        .iter()
        .filter(|(_, scene)| scene["raster"].is_null())
        .map(|(entry, _)| text(&entry["name"]))
        .collect();
    assert_eq!((without.len(), scenes.len()), (15, 74));
    assert!(readme.contains("\n15 of the 74: `one-corner-behind`, "), "{readme}");
    for name in without {
        assert!(readme.contains(&format!("`{name}`")), "{name}");
    }

    // The lecture's formula without changes, in doubles.
    let mut rounded = Vec::new();
    for (vector, (_, scene)) in bothways::vectors::all().iter().zip(&scenes) {
        let ids = table(&scene["ids"], -1.0);
        let seen = seen_with_the_lecture_s_formula(vector);
        if seen.iter().map(|id| id.map_or(-1.0, |id| id as f64)).ne(ids.iter().copied()) {
            rounded.push(vector.name);
        }
    }
    assert_eq!(rounded, ["first-corner", "room", "parallel-behind", "oblong-pixels"]);
    let names = "`first-corner`, `room`, `parallel-behind` and `oblong-pixels`";
    assert!(readme.replace("\n ", "").contains(names), "{readme}");

    // The section on OpenGL names 22 scenes of the set.
    let (_, opengl) = readme.split_once("## What OpenGL makes of it").unwrap();
    let (opengl, _) = opengl.split_once("\n## ").unwrap();
    let known = |name: &&str| scenes.iter().any(|(entry, _)| entry["name"] == **name);
    assert_eq!(opengl.split('`').filter(known).count(), 22);
}

#[test]
fn the_set_is_the_same_every_time_and_leaves_other_files_alone() {
    let (first, second) = (written(), written());
    fs::write(second.path().join("notes.txt"), "mine").unwrap();
    vectors(&second, &["-o", "."]).assert().code(0);
    let mut files_now = files(second.path());
    assert_eq!(files_now.remove("notes.txt").as_deref(), Some(&b"mine"[..]));
    assert!(files_now == files(first.path()));
}

#[test]
fn the_index_is_printed_for_programs() {
    let home = tempfile::tempdir().unwrap();
    let output = vectors(&home, &["--json"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let written = fs::read(home.path().join("out/vectors/index.json")).unwrap();
    assert_eq!(output.stdout, written);
}

#[test]
fn what_cannot_be_written_is_refused_and_nothing_is_left() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("file"), "mine").unwrap();
    let refused = contains("cannot write into the folder file");
    vectors(&home, &["-o", "file"]).assert().code(2).stdout("").stderr(refused);
    fs::create_dir(home.path().join("square.obj")).unwrap();
    let refused = contains("square.obj is a folder");
    vectors(&home, &["-o", "."]).assert().code(2).stdout("").stderr(refused);
    let mut left: Vec<_> = fs::read_dir(&home).unwrap().map(|e| e.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["file", "square.obj"]);
}
