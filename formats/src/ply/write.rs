//! Writes PLY files.

use bothways_common::scene::Mesh;
use std::io::{self, Write};

/// Writes the positions and triangles of a mesh as a binary PLY file (little-endian), which [`parse`](super::parse)
/// reads back bit for bit.
///
/// Materials, normals and texture coordinates are left out. Here normals and texture coordinates belong to the corners
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
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\n\
         property float y\nproperty float z\nelement face {faces}\n\
         property list uchar {index} vertex_indices\nend_header\n"
    )?;
    for coordinate in mesh.positions().iter().flat_map(|position| position.to_array()) {
        out.write_all(&coordinate.to_le_bytes())?;
    }
    for triangle in mesh.triangles() {
        out.write_all(&[3])?;
        for vertex in triangle {
            out.write_all(&vertex.to_le_bytes())?;
        }
    }
    Ok(())
}
