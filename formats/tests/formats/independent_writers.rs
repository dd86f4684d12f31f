//! Files of independent writers, which `files/make.py` makes: all show the same mesh, whatever the format.

use bothways_common::Mesh;
use bothways_common::glam::{DVec2, Vec3};
use bothways_common::look::color::linear_from_srgb;
use bothways_common::scene::{Filter, Levels, Sampler, Shape, Texture, Wrap};
use bothways_formats::gltf;
use bothways_formats::mesh_file::Format;
use bothways_formats::source::{GivenFile, InputFile, Reach};
use std::fs;
use std::path::PathBuf;

fn folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/files"))
}

fn input(name: &str) -> InputFile<'static> {
    InputFile::on_disk(&folder().join(name), Reach::Folder)
}

/// Reads a file in the format that its content tells. Its name without an extension tells none.
fn read(name: &str) -> Mesh {
    let path = folder().join(name);
    let bytes = fs::read(&path).expect("the file is committed");
    let nameless = [GivenFile::new("nameless", &bytes)];
    let told = Format::of_file(&InputFile::given(&nameless, 0));
    let told = told.or_else(|| Format::of(&path)).expect("it has a name");
    assert_eq!(Some(told), Format::of(&path), "{name}");
    told.read(&input(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// The mesh of a model that has one.
fn mesh_of(model: &gltf::Model) -> &Mesh {
    let [Shape::Mesh(mesh)] = &model.shapes[..] else { panic!("{:?}", model.shapes) };
    mesh
}

/// The corners of all triangles.
fn corners(mesh: &Mesh) -> Vec<[Vec3; 3]> {
    (0..mesh.triangles().len()).map(|triangle| mesh.corners(triangle)).collect()
}

/// The pyramid, as `make.py` states it.
fn pyramid() -> Vec<[Vec3; 3]> {
    let positions =
        [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], [0.1, 1.7, 0.3]];
    let triangles = [[0, 1, 2], [0, 2, 3], [1, 0, 4], [2, 1, 4], [3, 2, 4], [0, 3, 4]];
    triangles
        .map(|corners| corners.map(|corner: usize| Vec3::from_array(positions[corner])))
        .to_vec()
}

#[test]
fn the_same_triangles_are_read_in_the_same_order_from_every_format() {
    let names = [
        "trimesh.obj",
        "trimesh.ply",
        "trimesh-ascii.ply",
        "trimesh.stl",
        "trimesh.glb",
        "plyfile-little.ply",
        "plyfile-big.ply",
        "plyfile-ascii.ply",
        "numpy-stl.stl",
    ];
    for name in names {
        let mesh = read(name);
        assert_eq!(corners(&mesh), pyramid(), "{name}");
        assert_eq!(mesh.positions().len(), 5, "{name}");
    }
    // These writers round to some digits.
    for name in ["trimesh-ascii.stl", "numpy-stl-ascii.stl"] {
        let mesh = read(name);
        assert_eq!(mesh.positions().len(), 5, "{name}");
        for (found, expected) in corners(&mesh).iter().flatten().zip(pyramid().iter().flatten()) {
            assert!((*found - *expected).length() < 1e-6, "{name}");
        }
    }
}

#[test]
fn normals_of_ply_files_are_those_that_were_written() {
    for name in ["plyfile-little.ply", "plyfile-big.ply", "plyfile-ascii.ply"] {
        let mesh = read(name);
        let [a, _, top] = mesh.normals().of(2).unwrap();
        assert_eq!([a, top], [Vec3::new(1.0, 0.0, -1.0), Vec3::Y], "{name}");
    }
}

#[test]
fn the_nodes_of_a_scene_place_its_meshes() {
    let mesh = read("trimesh-scene.glb");
    assert_eq!(mesh.triangles().len(), 12);
    assert_eq!(corners(&mesh)[..6], pyramid()[..]);
    // What trimesh itself makes of the file, in another order: trimesh.load(...).to_geometry().vertices[4].
    let (top, expected) = (mesh.corners(6 + 2)[2], Vec3::new(3.622_845, 0.776_932_2, -1.327_452));
    assert!((top - expected).length() < 1e-5, "{top}");
}

#[test]
fn models_of_pygltflib_are_alike_wherever_their_buffer_is() {
    let model = |name: &str| gltf::read(&input(name)).unwrap();
    let binary = model("pygltflib.glb");
    for name in ["pygltflib-beside.gltf", "pygltflib-data.gltf"] {
        assert_eq!(model(name), binary);
    }
    // Half a turn about y, upside down, and moved; the mirror turns the triangles.
    let placed = |p: Vec3| Vec3::new(1.0 - p.x, 2.0 - p.y, 3.0 - p.z);
    let expected: Vec<[Vec3; 3]> =
        pyramid().into_iter().map(|[a, b, c]| [placed(a), placed(c), placed(b)]).collect();
    for (found, expected) in
        corners(mesh_of(&binary)).iter().flatten().zip(expected.iter().flatten())
    {
        assert!((*found - *expected).length() < 1e-6, "{found} {expected}");
    }
    let materials = mesh_of(&binary).materials().unwrap();
    assert_eq!(
        (materials.named()[0].name.as_str(), materials.of(5).unwrap().color),
        ("copper", Vec3::new(0.6, 0.25, 0.1))
    );
    // The mirror has exchanged the last two corners.
    let [_, top, _] = mesh_of(&binary).texture_coordinates().of(2).unwrap();
    assert_eq!(top.to_array(), [128.0 / 255.0, 1.0 - 51.0 / 255.0]);
    let camera = &binary.cameras[0];
    assert_eq!(
        (camera.name.as_str(), camera.camera.viewport, camera.camera.image),
        ("front", [1.5, 1.0], [720, 480])
    );
    assert!((camera.camera.distance - 0.5 / 0.4_f32.tan()).abs() < 1e-5);
}

/// What is read at a texture coordinate.
fn read_at(texture: &Texture, x: f64, y: f64) -> Vec3 {
    texture.color(DVec2::new(x, y), 0.0)
}

/// `textured_with_trimesh`: at the corners, trimesh reads blue, grey, green and red.
#[test]
fn a_texture_stands_as_its_writer_meant_it() {
    let grey = Vec3::splat(linear_from_srgb(188));
    let corners =
        [([0.0, 0.0], Vec3::Z), ([1.0, 0.0], grey), ([1.0, 1.0], Vec3::Y), ([0.0, 1.0], Vec3::X)];
    for name in ["trimesh-texture.glb", "trimesh-texture.obj"] {
        let file = input(name);
        let format = Format::of_file(&file).expect("it is a mesh");
        let (mesh, warnings) = format.read_with_materials(&file).expect("it is right");
        assert_eq!(warnings, [], "{name}");
        let texture = mesh.materials().unwrap().of(1).unwrap().texture.clone().expect("it has one");
        for (position, coordinates) in (0..2).flat_map(|triangle| {
            mesh.corners(triangle).into_iter().zip(mesh.texture_coordinates().of(triangle).unwrap())
        }) {
            let (_, color) =
                corners.iter().find(|(at, _)| *at == position.truncate().to_array()).unwrap();
            // A little towards the middle, where the nearest texel is the corner's.
            let at = coordinates.as_dvec2() * 0.9 + 0.05;
            let nearest = Texture { sampler: Sampler::NEAREST, ..texture.clone() };
            assert_eq!(read_at(&nearest, at.x, at.y), *color, "{name}: {position}");
        }
    }
}

/// `textured_with_pygltflib`.
#[test]
fn pictures_in_views_uris_and_files_are_the_same() {
    let names =
        ["pygltflib-texture.glb", "pygltflib-texture-data.gltf", "pygltflib-texture-beside.gltf"];
    let meshes = names.map(|name| {
        let model = gltf::read(&input(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(model.warnings, [], "{name}");
        mesh_of(&model).clone()
    });
    assert_eq!(meshes[0], meshes[1]);
    assert_eq!(meshes[0], meshes[2]);
    let mesh = &meshes[0];
    let material = mesh.materials().unwrap().of(0).unwrap();
    assert_eq!(material.color, Vec3::new(1.0, 0.5, 0.25));
    let texture = material.texture.as_ref().expect("it has one");
    let expected = Sampler {
        magnified: Filter::Nearest,
        minified: Filter::Bilinear,
        levels: Levels::Nearest,
        wrap: [Wrap::Mirror, Wrap::Clamp],
        tiles: [1.0; 2],
    };
    assert_eq!(texture.sampler, expected);
    // TEXCOORD_1, counted from the lower edge: the picture's lower left corner is blue.
    assert_eq!(mesh.texture_coordinates().of(0).unwrap()[0].to_array(), [-1.0, -1.0]);
    assert_eq!(read_at(texture, 0.25, 0.25), Vec3::Z);
    assert_eq!(read_at(texture, -0.25, 0.75), Vec3::X, "mirrored to the left");
    assert_eq!(read_at(texture, 0.75, 7.0), Vec3::Y, "its upper border goes on");
    // COLOR_0 is linear: 51 of 255 is a fifth.
    assert_eq!(mesh.colors()[1], Vec3::new(0.2, 1.0, 1.0));
}

#[test]
fn colors_of_ply_files_are_those_that_were_written() {
    let expected = Vec3::from([200, 100, 50].map(linear_from_srgb));
    for name in ["plyfile-little.ply", "plyfile-big.ply", "plyfile-ascii.ply"] {
        assert_eq!(read(name).colors(), [expected; 5], "{name}");
    }
}
