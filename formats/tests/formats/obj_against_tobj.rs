//! The OBJ reader against the crate `tobj`: both read the same triangles at the same positions.

use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::{fs, io};

use bothways_common::look::color::linear_from_encoded;
use bothways_common::{Mesh, glam::Vec3};
use bothways_formats::obj;

/// Triangles as `tobj` reads them: the bits of the positions, texture coordinates and normals of their corners. `tobj`
/// invents texture coordinates and normals for corners that have none.
struct Oracle {
    positions: Vec<[[u32; 3]; 3]>,
    texture_coordinates: Vec<[[u32; 2]; 3]>,
    normals: Vec<[[u32; 3]; 3]>,
    colors: Vec<[[u32; 3]; 3]>,
}

/// Reads a file with `tobj`. It begins a new model at each `o`, `g` or `usemtl`.
fn read_with_tobj(bytes: &[u8]) -> Oracle {
    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    let no_material = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut BufReader::new(bytes), &options, no_material)
        .expect("the oracle reads the file");
    let mut oracle = Oracle {
        positions: Vec::new(),
        texture_coordinates: Vec::new(),
        normals: Vec::new(),
        colors: Vec::new(),
    };
    for tobj::Model { mesh, .. } in models {
        oracle.positions.extend(triangles(&mesh.positions, &mesh.indices));
        oracle.texture_coordinates.extend(triangles(&mesh.texcoords, &mesh.texcoord_indices));
        oracle.normals.extend(triangles(&mesh.normals, &mesh.normal_indices));
        if !mesh.vertex_color.is_empty() {
            oracle.colors.extend(triangles(&mesh.vertex_color, &mesh.indices));
        }
    }
    oracle
}

/// The bits of the `N` numbers at each corner of each triangle.
fn triangles<const N: usize>(values: &[f32], indices: &[u32]) -> Vec<[[u32; N]; 3]> {
    let (values, _) = values.as_chunks::<N>();
    let (triangles, _) = indices.as_chunks::<3>();
    let value = |index: u32| values[index as usize].map(f32::to_bits);
    triangles.iter().map(|triangle| triangle.map(value)).collect()
}

/// Reads a file, compares the mesh with that of the oracle, and returns it.
fn check(name: &str, bytes: &[u8]) -> Mesh {
    let mesh = obj::parse(name, bytes).expect("the reader reads the file");
    let oracle = read_with_tobj(bytes);
    assert_eq!(mesh.triangles().len(), oracle.positions.len(), "{name}");
    for triangle in 0..mesh.triangles().len() {
        let bits = |p: Vec3| p.to_array().map(f32::to_bits);
        let positions = mesh.corners(triangle).map(bits);
        assert_eq!(positions, oracle.positions[triangle], "{name}, triangle {triangle}");
        if let Some(normals) = mesh.normals().of(triangle) {
            assert_eq!(normals.map(bits), oracle.normals[triangle], "{name}, triangle {triangle}");
        }
        if let Some(values) = mesh.texture_coordinates().of(triangle) {
            let values = values.map(|value| value.to_array().map(f32::to_bits));
            let expected = oracle.texture_coordinates[triangle];
            assert_eq!(values, expected, "{name}, triangle {triangle}");
        }
        if !mesh.colors().is_empty() {
            let of = |vertex: u32| mesh.colors()[vertex as usize];
            let linear =
                |bits: [u32; 3]| Vec3::from(bits.map(f32::from_bits).map(linear_from_encoded));
            let expected = oracle.colors[triangle].map(linear);
            let apart = |k: usize| (of(mesh.triangles()[triangle][k]) - expected[k]).length();
            assert!((0..3).all(|k| apart(k) < 1e-6), "{name}, triangle {triangle}");
        }
    }
    mesh
}

#[test]
fn handwritten_files_are_read_alike() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let attributes = "vt 0 0\nvt 1 0\nvt 1 1 0.5\nvt 0 1\nvn 0 0 1\nvn 0 0 2\n";
    let check = |what: &str, text: String| check(what, text.as_bytes());
    check("a triangle", format!("{square}f 1 2 3\n"));
    check("a quad", format!("{square}f 1 2 3 4\n"));
    check("a polygon", format!("{square}v -1 0.5 0\nf 1 2 3 4 5\n"));
    check("a polygon of six", format!("{square}v -1 .5 0\nv -1 2.5e-1 1E0\nf 6 1 2 3 4 5\n"));
    check("negative indices", format!("{square}f -4 -3 -2\nv 0 0 1\nf -1 -2 1 2\n"));
    check("a vertex below its face", format!("f 1 2 3\n{square}f 2 3 4\n"));
    check("blanks and comments", format!("# x\r\n\r\n{square}\n  f\t1  2 3 \r\n#\n"));
    let mesh =
        check("colours", "v 2 1 0 0.5 0.25 1\nv 3 3 3 0 0 0\nv 0 0 0 1 1 1\nf 1 2 3\n".to_owned());
    assert_eq!(mesh.colors().len(), 3);
    check("weights", format!("{square}v 2 2 2 1\nf 1 2 5\n"));
    check("groups", format!("o a\n{square}g b c\nf 1 2 3\ng d\ns 1\nusemtl m\nf 2 3 4\n"));
    check("numbers", "v 0.1 1e-46 -1.17549435e-38\nv 3.4028235e38 -0 +7\nf 1 2 1\n".to_owned());
    check("a square twice", format!("{square}{square}f 5 6 7 8\nf 1 -5 -6 -7\n"));

    let mesh = check("texture", format!("{square}{attributes}f 1/1 2/2 3/3 4/4\n"));
    assert!(mesh.texture_coordinates().of(1).is_some() && mesh.normals().of(1).is_none());
    let mesh = check("normals", format!("{square}{attributes}f 1//1 2//2 -2//-1 4//-2\n"));
    assert!(mesh.texture_coordinates().of(1).is_none() && mesh.normals().of(1).is_some());
    let mesh = check("both", format!("{square}{attributes}f 1/4/1 2/-4/2 3/3/1\nf 1 2 4\n"));
    assert!(mesh.texture_coordinates().of(0).is_some() && mesh.normals().of(0).is_some());
    assert!(mesh.texture_coordinates().of(1).is_none() && mesh.normals().of(1).is_none());
}

#[test]
fn well_known_meshes_are_read_alike() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/meshes");
    let Ok(files) = obj_files(&folder) else {
        println!("skipped: the well-known meshes are not here; they are no part of the repository");
        return;
    };
    for file in files {
        let mesh = check(&file.display().to_string(), &fs::read(&file).unwrap());
        assert_eq!(obj::read(&file).unwrap(), mesh);
        println!("{}: {} triangles", file.display(), mesh.triangles().len());
    }
}

fn obj_files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let files: io::Result<Vec<_>> = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect();
    Ok(files?.into_iter().filter(|path| path.extension().is_some_and(|e| e == "obj")).collect())
}
