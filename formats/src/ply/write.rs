//! Writes PLY files.

use bothways_common::look::color::{encoded_from_linear, linear_from_srgb, srgb_from_linear};
use bothways_common::scene::Mesh;
use glam::Vec3;
use std::io::{self, Write};

/// Writes the positions and triangles of a mesh, and the colours of its vertices, as a binary PLY file (little-endian),
/// which [`parse`](super::parse) reads back bit for bit.
///
/// Colours are written as sRGB: in bytes if these stand for each of them, else as numbers from 0 to 1, which are read back
/// but for the last bits. Materials, normals and texture coordinates are left out. Here normals and texture coordinates belong to the corners
/// of triangles, in PLY to vertices: a mesh with creases would need duplicates of its vertices.
///
/// # Errors
///
/// Those of `out`, which should be buffered.
///
/// ```
/// use bothways_common::{Mesh, glam::Vec3};
/// use bothways_formats::ply;
///
/// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, 0.1 * Vec3::Y], vec![[0, 1, 2]])?;
/// let mut file = Vec::new();
/// ply::write(&mesh, &mut file)?;
/// assert_eq!(ply::parse("mesh.ply", &file)?, mesh);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let (vertices, faces) = (mesh.positions().len(), mesh.triangles().len());
    // Many programs read indices only as `int`.
    let index = if i32::try_from(vertices).is_ok() { "int" } else { "uint" };
    let colors = Colors::of(mesh.colors());
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\n\
         property float y\nproperty float z\n{}element face {faces}\n\
         property list uchar {index} vertex_indices\nend_header\n",
        colors.properties()
    )?;
    for (vertex, position) in mesh.positions().iter().enumerate() {
        for coordinate in position.to_array() {
            out.write_all(&coordinate.to_le_bytes())?;
        }
        colors.write(vertex, out)?;
    }
    for triangle in mesh.triangles() {
        out.write_all(&[3])?;
        for vertex in triangle {
            out.write_all(&vertex.to_le_bytes())?;
        }
    }
    Ok(())
}

/// The colours of all vertices, encoded.
enum Colors {
    None,
    Bytes(Vec<[u8; 3]>),
    Numbers(Vec<[f32; 3]>),
}

impl Colors {
    fn of(linear: &[Vec3]) -> Colors {
        let values = || linear.iter().map(|color| color.to_array());
        let is_byte = |value: f32| linear_from_srgb(srgb_from_linear(value)) == value;
        if linear.is_empty() {
            Colors::None
        } else if values().flatten().all(is_byte) {
            Colors::Bytes(values().map(|color| color.map(srgb_from_linear)).collect())
        } else {
            Colors::Numbers(values().map(|color| color.map(encoded)).collect())
        }
    }

    /// The lines of the header.
    fn properties(&self) -> String {
        let of = |kind: &str| {
            ["red", "green", "blue"].map(|name| format!("property {kind} {name}\n")).concat()
        };
        match self {
            Colors::None => String::new(),
            Colors::Bytes(_) => of("uchar"),
            Colors::Numbers(_) => of("float"),
        }
    }

    fn write(&self, vertex: usize, out: &mut impl Write) -> io::Result<()> {
        match self {
            Colors::None => Ok(()),
            Colors::Bytes(colors) => out.write_all(&colors[vertex]),
            Colors::Numbers(colors) => {
                colors[vertex].iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
            }
        }
    }
}

/// The sRGB value of a linear one, rounded to what is written.
#[expect(clippy::cast_possible_truncation, reason = "the rounding")]
fn encoded(linear: f32) -> f32 {
    encoded_from_linear(linear.into()) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ply::parse;

    #[test]
    fn colors_come_back() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let mesh = Mesh::new(positions, vec![[0, 1, 2]]).unwrap();
        let written = |colors: [Vec3; 3]| {
            let mesh = mesh.clone().with_colors(colors.to_vec()).unwrap();
            let mut file = Vec::new();
            write(&mesh, &mut file).unwrap();
            (String::from_utf8_lossy(&file).into_owned(), parse("a.ply", &file).unwrap())
        };
        let bytes = [[0, 1, 2], [127, 128, 129], [253, 254, 255]]
            .map(|color| Vec3::from(color.map(linear_from_srgb)));
        let (text, back) = written(bytes);
        assert!(text.contains("property uchar green\n"), "{text}");
        assert_eq!(back.colors(), bytes);
        let fine = bytes.map(|color| color * 0.9);
        let (text, back) = written(fine);
        assert!(text.contains("property float green\n"), "{text}");
        for (color, expected) in back.colors().iter().zip(fine) {
            assert!((color - expected).length() < 1e-6, "{color} {expected}");
        }
    }
}
