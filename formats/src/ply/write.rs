//! The PLY writer.

use bothways_common::scene::Mesh;
use std::io::{self, Write};

/// Writes a mesh's positions and triangles as a binary PLY file (least significant byte first), which
/// [`parse`](super::parse) reads back bit for bit.
///
/// Normals and texture coordinates are left out: they belong to the corners of triangles here, and to
/// vertices in PLY, so that a mesh whose creases share vertices would have to be torn. So are materials.
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
    // Many programs read indices as `int` alone.
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
