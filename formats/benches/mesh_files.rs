//! Times the readers of mesh files, and the smoothing of what they read, on all threads of rayon's pool.
//!
//! The meshes are spheres, in files that are written first. `tobj` reads the same OBJ file on one thread; it checks less,
//! and names no line. `RAYON_NUM_THREADS=1` gives our own time on one thread.

use bothways_common::Mesh;
use bothways_formats::generate::Kind;
use bothways_formats::{obj, ply, smooth};
use divan::Bencher;
use divan::counter::{BytesCount, ItemsCount};
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::PathBuf;
use std::sync::LazyLock;

fn main() {
    divan::main();
    drop(fs::remove_dir_all(folder()));
}

/// A million triangles without normals.
static MESH: LazyLock<Mesh> = LazyLock::new(|| {
    let sphere = Kind::Sphere.mesh([1000, 501]).expect("it is small");
    Mesh::new(sphere.positions().to_vec(), sphere.triangles().to_vec()).expect("it is right")
});

fn folder() -> PathBuf {
    std::env::temp_dir().join(format!("bothways-mesh-files-{}", std::process::id()))
}

/// Writes a file and reads it once, so that it is in the system's memory.
fn file(name: &str, write: impl Fn(&mut BufWriter<File>) -> std::io::Result<()>) -> PathBuf {
    let path = folder().join(name);
    fs::create_dir_all(folder()).expect("there is room");
    let mut out = BufWriter::new(File::create(&path).expect("there is room"));
    write(&mut out).and_then(|()| out.flush()).expect("there is room");
    fs::read(&path).expect("it was written");
    path
}

/// The sphere with normals and texture coordinates, as `bothways mesh` writes it.
fn with_all() -> PathBuf {
    let sphere = Kind::Sphere.mesh([1000, 501]).expect("it is small");
    file("all.obj", |out| obj::write(&sphere, out))
}

fn bare() -> PathBuf {
    file("bare.obj", |out| obj::write(&MESH, out))
}

fn time<T>(bencher: Bencher, path: PathBuf, read: impl Fn(&PathBuf) -> T) {
    let bytes = fs::metadata(&path).expect("it was written").len();
    let counted = bencher.counter(BytesCount::new(bytes)).counter(ItemsCount::new(1_000_000_u32));
    counted.bench_local(|| read(&path));
}

#[divan::bench]
fn read_bare_obj(bencher: Bencher) {
    time(bencher, bare(), |path| obj::read(path).expect("it is right"));
}

#[divan::bench]
fn read_bare_obj_with_tobj(bencher: Bencher) {
    time(bencher, bare(), |path| {
        tobj::load_obj(path, &tobj::LoadOptions::default()).expect("it is right")
    });
}

#[divan::bench]
fn read_obj_with_all(bencher: Bencher) {
    time(bencher, with_all(), |path| obj::read(path).expect("it is right"));
}

#[divan::bench]
fn read_obj_with_all_with_tobj(bencher: Bencher) {
    time(bencher, with_all(), |path| {
        tobj::load_obj(path, &tobj::LoadOptions::default()).expect("it is right")
    });
}

#[divan::bench]
fn read_binary_ply(bencher: Bencher) {
    time(bencher, file("a.ply", |out| ply::write(&MESH, out)), |path| {
        ply::read(path).expect("it is right")
    });
}

/// What the system needs for the file of `read_binary_ply`, whatever is in it.
#[divan::bench]
fn read_the_bytes_of_binary_ply(bencher: Bencher) {
    time(bencher, file("a.ply", |out| ply::write(&MESH, out)), |path| {
        fs::read(path).expect("it is there")
    });
}

#[divan::bench]
fn smooth_normals(bencher: Bencher) {
    bencher
        .counter(ItemsCount::new(1_000_000_u32))
        .with_inputs(|| MESH.clone())
        .bench_local_values(|mesh| smooth::with_normals(mesh, smooth::CREASE));
}
