//! Pictures and colours of vertices: what is exported is loaded back, and looks as it did.

use super::super::{Export, Target, export};
use crate::common::glam::{DVec3, Vec2, Vec3};
use crate::common::look::color::linear_from_srgb;
use crate::common::look::texture::on_sphere;
use crate::common::scene::{Attribute, Filter, Levels, Pyramid, Sampler, Texture, Wrap};
use crate::common::{Camera, Light, Material, Mesh, Object, Scene, Shape, Sphere, View};
use crate::formats::source::{InputFile, Reach};
use crate::formats::{generate::Kind, gltf, mesh_file::Format, ply};
use crate::orders::{Method, Order, RenderOptions, render};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tempfile::TempDir;

/// A bright picture of 5 × 3 texels, each of another colour, from bytes.
fn picture() -> Arc<Pyramid> {
    let byte = |k: usize| u8::try_from(40 + (k * 37) % 200).unwrap();
    let texel =
        |k: usize| Vec3::from([byte(k), byte(3 * k + 1), byte(7 * k + 2)].map(linear_from_srgb));
    Arc::new(Pyramid::new(5, (0..15).map(texel).collect()))
}

/// A square of two triangles before the eye, its texture coordinates beyond the picture on all sides.
fn square(sampler: Sampler, color: Vec3, has_colors: bool) -> Scene {
    let [low, high] = [-1.0, 1.0];
    let positions = [[low, low], [high, low], [high, high], [low, high]];
    let positions = positions.map(|[x, y]| Vec3::new(x, y, -2.0)).to_vec();
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    // They have few bits, so that `1 − v` of glTF loses none.
    let values =
        [[-0.75, -0.375], [1.875, -0.375], [1.875, 2.25], [-0.75, 2.25]].map(Vec2::from).to_vec();
    let coordinates = Attribute { values, corners: triangles.clone() };
    let mut mesh = Mesh::new(positions, triangles).unwrap();
    mesh = mesh.with_texture_coordinates(coordinates).unwrap();
    if has_colors {
        let colors = [[255, 128, 3], [1, 255, 77], [40, 50, 255], [200, 200, 200]];
        mesh = mesh
            .with_colors(colors.map(|one| Vec3::from(one.map(linear_from_srgb))).to_vec())
            .unwrap();
    }
    let texture = Some(Texture { pyramid: picture(), sampler });
    let material = Material { color, texture, ..Material::default() };
    lit(vec![Object { shape: Shape::Mesh(mesh), material }])
}

fn lit(objects: Vec<Object>) -> Scene {
    let mut scene = Scene::new(objects).unwrap();
    scene.lights = vec![Light::Ambient { intensity: 0.9 }, Light::AtCamera { intensity: 0.1 }];
    scene
}

fn camera() -> Camera {
    Camera::canonical(80, 80)
}

/// The bytes of the picture, and the ids.
fn seen(scene: &Scene) -> (Vec<[u8; 3]>, Vec<Option<u64>>) {
    let camera = camera();
    let view = View::new(scene, &camera);
    let rendered = render(Order::Image, Method::Fast, &view, &RenderOptions::default()).unwrap();
    (rendered.frame.picture().to_vec(), rendered.frame.ids().iter().collect())
}

/// The files in a folder, and the one to open.
fn written(scene: &Scene, target: Target) -> (TempDir, PathBuf, Export) {
    let camera = camera();
    let exported = export(&View::new(scene, &camera), "looks", target).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in &exported.files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let first = folder.path().join(&exported.files[0].0);
    (folder, first, exported)
}

fn on_disk(path: &Path) -> InputFile<'static> {
    InputFile::on_disk(path, Reach::Folder)
}

/// Shapes with their own look, in the light of another scene.
fn alone(shapes: Vec<Shape>, scene: &Scene) -> Scene {
    let object = |shape: Shape| {
        let material = shape.mesh().unwrap().own_material();
        Object { shape, material }
    };
    let mut again = Scene::new(shapes.into_iter().map(object).collect()).unwrap();
    (again.lights, again.background) = (scene.lights.clone(), scene.background);
    again
}

fn texture_of(scene: &Scene) -> Texture {
    scene.objects()[0].material_of(0).texture.clone().unwrap()
}

#[test]
fn gltf_has_pictures_samplers_and_colors() {
    let filters = [
        (Filter::Nearest, Filter::Nearest, Levels::One),
        (Filter::Bilinear, Filter::Bilinear, Levels::One),
        (Filter::Nearest, Filter::Nearest, Levels::Nearest),
        (Filter::Nearest, Filter::Bilinear, Levels::Nearest),
        (Filter::Bilinear, Filter::Nearest, Levels::Blended),
        (Filter::Bilinear, Filter::Bilinear, Levels::Blended),
    ];
    let wraps = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];
    for (k, (magnified, minified, levels)) in filters.into_iter().enumerate() {
        let wrap = [wraps[k % 3], wraps[(k + k / 3 + 1) % 3]];
        let sampler = Sampler { magnified, minified, levels, wrap, tiles: [1.0; 2] };
        let scene = square(sampler, Vec3::new(0.9, 0.75, 1.0), k % 2 == 0);
        let (_folder, file, exported) = written(&scene, Target::Gltf);
        assert_eq!(exported.notes, ["lights and the background are left out"]);
        let model = gltf::read(&on_disk(&file)).unwrap();
        assert_eq!(model.warnings, []);
        let again = alone(model.shapes, &scene);
        assert_eq!(texture_of(&again), texture_of(&scene), "{sampler:?}");
        assert!(seen(&again) == seen(&scene), "{sampler:?}");
    }
}

/// What a validator calls unused, and what parts the vertices of a seam.
#[test]
fn texture_coordinates_go_only_where_a_picture_is() {
    let sphere = Kind::Sphere.mesh([8, 6]).unwrap().with_normals(Attribute::default()).unwrap();
    let texture = Some(Texture { pyramid: picture(), sampler: Sampler::BILINEAR });
    for texture in [None, texture] {
        let is_there = texture.is_some();
        let material = Material { texture, ..Material::default() };
        let scene = lit(vec![Object { shape: Shape::Mesh(sphere.clone()), material }]);
        for (target, file, word) in [
            (Target::Gltf, 0, &b"TEXCOORD_0"[..]),
            (Target::Mitsuba, 1, b"property float u"),
            (Target::Pbrt, 0, b"point2 uv"),
        ] {
            let (_folder, _, exported) = written(&scene, target);
            let bytes = &exported.files[file].1;
            let is_said = bytes.windows(word.len()).any(|part| part == word);
            assert_eq!(is_said, is_there, "{target:?}");
        }
        let (_folder, file, _) = written(&scene, Target::Gltf);
        let model = gltf::read(&on_disk(&file)).unwrap();
        let vertices = model.shapes[0].mesh().unwrap().positions().len();
        // Where the first and the last coordinate meet, a vertex has both.
        assert_eq!(vertices > sphere.positions().len(), is_there, "{vertices}");
    }
}

#[test]
fn gltf_repeats_a_picture_by_its_coordinates() {
    let scene = square(Sampler { tiles: [2.0, 4.0], ..Sampler::BILINEAR }, Vec3::ONE, false);
    let (_folder, file, _) = written(&scene, Target::Gltf);
    let again = alone(gltf::read(&on_disk(&file)).unwrap().shapes, &scene);
    assert!(seen(&again) == seen(&scene));
}

#[test]
fn obj_has_pictures_as_far_as_it_has_words() {
    let repeated = Sampler { tiles: [2.0, 0.5], ..Sampler::MIPMAPS };
    let clamped = Sampler { wrap: [Wrap::Clamp; 2], ..Sampler::MIPMAPS };
    for sampler in [repeated, clamped] {
        let scene = square(sampler, Vec3::ONE, false);
        let (_folder, file, exported) = written(&scene, Target::Obj);
        assert_eq!(exported.notes, ["OBJ has no camera and no lights"]);
        let names: Vec<&str> = exported.files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["looks.obj", "looks.mtl", "looks-picture-0.png"]);
        let (mesh, warnings) = Format::Obj.read_with_materials(&on_disk(&file)).unwrap();
        assert_eq!(warnings, []);
        let again = alone(vec![Shape::Mesh(mesh)], &scene);
        assert_eq!(texture_of(&again), texture_of(&scene));
        assert!(seen(&again) == seen(&scene), "{sampler:?}");
    }
    // A colour goes into the picture.
    let scene = square(repeated, Vec3::new(0.3, 0.9, 0.5), false);
    let (_folder, file, _) = written(&scene, Target::Obj);
    let mesh = Format::Obj.read_with_materials(&on_disk(&file)).unwrap().0;
    let again = alone(vec![Shape::Mesh(mesh)], &scene);
    let (expected, found) = (seen(&scene), seen(&again));
    assert_eq!(expected.1, found.1);
    let bytes = expected.0.as_flattened().iter().zip(found.0.as_flattened());
    assert!(bytes.map(|(one, other)| one.abs_diff(*other)).max() <= Some(1));
    // What there is no word for is said.
    let mirrored = square(Sampler { wrap: [Wrap::Mirror; 2], ..Sampler::MIPMAPS }, Vec3::ONE, true);
    let notes = written(&mirrored, Target::Obj).2.notes;
    assert!(notes.iter().any(|note| note.contains("OBJ says no filter")), "{notes:?}");
    assert!(
        notes.iter().any(|note| note.contains("colours of vertices are left out")),
        "{notes:?}"
    );
}

#[test]
fn materials_come_back_from_obj() {
    let colors = [[255, 0, 0], [10, 200, 30]].map(|one| Vec3::from(one.map(linear_from_srgb)));
    let specular = [0.0, 0.5];
    let object = |k: usize| {
        let x = 2.0 * k as f32 - 2.0;
        let positions =
            vec![Vec3::new(x, -1.0, -3.0), Vec3::new(x + 2.0, -1.0, -3.0), Vec3::new(x, 1.0, -3.0)];
        let mesh = Mesh::new(positions, vec![[0, 1, 2]]).unwrap();
        let material = Material { color: colors[k], specular: specular[k], ..Material::default() };
        Object { shape: Shape::Mesh(mesh), material }
    };
    let scene = lit(vec![object(0), object(1)]);
    let (_folder, file, _) = written(&scene, Target::Obj);
    let mesh = Format::Obj.read_with_materials(&on_disk(&file)).unwrap().0;
    let again = alone(vec![Shape::Mesh(mesh)], &scene);
    for (k, object) in scene.objects().iter().enumerate() {
        assert_eq!(again.objects()[0].material_of(k), &object.material, "{k}");
    }
    assert!(seen(&again) == seen(&scene));
}

#[test]
fn ply_has_the_colors_of_vertices() {
    let scene = square(Sampler::NEAREST, Vec3::ONE, true);
    let (_folder, file, exported) = written(&scene, Target::Ply);
    assert!(exported.notes.contains(&"pictures on surfaces are left out".to_owned()));
    let mesh = ply::read(&file).unwrap();
    assert_eq!(mesh.colors(), scene.objects()[0].shape.mesh().unwrap().colors());
}

#[test]
fn ray_tracers_get_pictures_beside_their_scene() {
    let sampler = Sampler { wrap: [Wrap::Clamp; 2], ..Sampler::BILINEAR };
    let scene = square(sampler, Vec3::ONE, false);
    for (target, words) in [
        (
            Target::Pbrt,
            [
                "\"string wrap\" [ \"clamp\" ]",
                "\"string filter\" [ \"bilinear\" ]",
                "\"point2 uv\" [",
            ],
        ),
        (
            Target::Mitsuba,
            [
                "name=\"wrap_mode\" value=\"clamp\"",
                "name=\"filter_type\" value=\"bilinear\"",
                "<texture type=\"bitmap\" name=\"reflectance\">",
            ],
        ),
    ] {
        let (folder, file, exported) = written(&scene, target);
        let text = std::fs::read_to_string(file).unwrap();
        for word in words {
            assert_eq!(text.matches(word).count(), 1, "{target:?}: {word}");
        }
        assert_eq!(text.matches("looks-picture-0.png").count(), 1, "{target:?}");
        let picture = image::open(folder.path().join("looks-picture-0.png")).unwrap();
        assert_eq!((picture.width(), picture.height()), (5, 3));
        assert!(
            !exported.notes.iter().any(|note| note.contains("picture")),
            "{:?}",
            exported.notes
        );
    }
    let colored = square(sampler, Vec3::ONE, true);
    let notes = |target| written(&colored, target).2.notes.join("\n");
    assert!(notes(Target::Pbrt).contains("colours of vertices are left out"));
    assert!(notes(Target::Mitsuba).contains("colours of vertices are left out where a picture is"));
}

/// The formula of contract.md against that of the generated sphere.
#[test]
fn a_sphere_keeps_its_texture_coordinates() {
    let sphere = Sphere { center: Vec3::new(0.5, -0.25, -4.0), radius: 1.5 };
    let texture = Some(Texture { pyramid: picture(), sampler: Sampler::BILINEAR });
    let material = Material { texture, color: Vec3::ONE, ..Material::default() };
    let scene = lit(vec![Object { shape: Shape::Sphere(sphere), material }]);
    let (_folder, file, _) = written(&scene, Target::Gltf);
    let model = gltf::read(&on_disk(&file)).unwrap();
    let mesh = model.shapes[0].mesh().unwrap();
    let mut compared = 0;
    for (triangle, corners) in mesh.triangles().iter().enumerate() {
        let coordinates = mesh.texture_coordinates().of(triangle).unwrap();
        for (vertex, coordinate) in corners.iter().zip(coordinates) {
            let offset = (mesh.positions()[*vertex as usize] - sphere.center).as_dvec3();
            let at_pole = DVec3::new(offset.x, 0.0, offset.z).length() < 1e-3;
            let (expected, _) = on_sphere(offset);
            let off = coordinate.as_dvec2() - expected;
            assert!(off.y.abs() < 1e-5, "{coordinate} {expected}");
            // The seam is 0 and 1.
            assert!(at_pole || (off.x - off.x.round()).abs() < 1e-5, "{coordinate} {expected}");
            compared += 1;
        }
    }
    assert!(compared > 10_000);
    let (ours, theirs) = (seen(&scene), seen(&alone(vec![Shape::Mesh(mesh.clone())], &scene)));
    let near = |(one, other): (&[u8; 3], &[u8; 3])| {
        one.iter().zip(other).all(|(one, other)| one.abs_diff(*other) <= 8)
    };
    let far = ours.0.iter().zip(&theirs.0).filter(|pair| !near(*pair)).count();
    assert!(far < 60, "{far} of {} pixels", ours.0.len());
}
