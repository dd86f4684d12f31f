//! Writes a rough sphere of any number of triangles as a binary PLY file. It may be larger than memory.
//! `bothways --order object --stream` draws it.
//!
//! ```sh
//! cargo run --example noisy_sphere -- 20000000 out/sphere.ply
//! cargo run --release -- out/sphere.ply --order object --stream
//! ```

use std::io::{BufWriter, Write};
use std::{error::Error, fs, path::Path};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let wanted: u32 = arguments.next().map_or(Ok(20_000), |count| count.parse())?;
    let path = arguments.next().unwrap_or("out/sphere.ply".into());

    // Rows of quads from pole to pole, with twice as many columns: 4·rows² triangles.
    let rows = (1..20_000).find(|rows| 4 * rows * rows >= wanted).ok_or("too many triangles")?;
    let columns = 2 * rows;
    let (vertices, triangles) = ((rows + 1) * columns, 2 * rows * columns);
    fs::create_dir_all(Path::new(&path).parent().ok_or("name a file")?)?;
    let mut out = BufWriter::new(fs::File::create(&path)?);
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\n\
         property float y\nproperty float z\nelement face {triangles}\n\
         property list uchar uint vertex_indices\nend_header\n"
    )?;
    for (row, column) in (0..=rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let (latitude, longitude) = (angle(row, rows, 0.5), angle(column, columns, 1.0));
        let radius = 1.0 + noise(row * columns + column) / rows as f32;
        let (up, around) = (radius * latitude.cos(), radius * latitude.sin());
        for coordinate in [around * longitude.sin(), up, around * longitude.cos()] {
            out.write_all(&coordinate.to_le_bytes())?;
        }
    }
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let vertex = |row, column| row * columns + column % columns;
        let (a, d) = (vertex(row, column), vertex(row + 1, column + 1));
        for index in [[a, vertex(row + 1, column), d], [a, d, vertex(row, column + 1)]] {
            out.write_all(&[3])?;
            index.iter().try_for_each(|vertex| out.write_all(&vertex.to_le_bytes()))?;
        }
    }
    println!("{path}: {triangles} triangles");
    Ok(out.flush()?)
}

/// A pseudorandom number from 0 to 1.
fn noise(number: u32) -> f32 {
    let mixed = (number ^ (number >> 15)).wrapping_mul(0x2c1b_3c6d);
    let mixed = (mixed ^ (mixed >> 12)).wrapping_mul(0x297a_2d39);
    (mixed >> 8) as f32 / (1 << 24) as f32
}

/// The angle after `step` of `steps` equal steps through so many turns, in radians.
fn angle(step: u32, steps: u32, turns: f32) -> f32 {
    turns * std::f32::consts::TAU * step as f32 / steps as f32
}
