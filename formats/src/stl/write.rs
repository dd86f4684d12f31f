//! Writes STL files.

use bothways_common::scene::Mesh;
use glam::Vec3;
use std::io::{self, Write};

/// Writes the triangles of a mesh as a binary STL file, which [`parse`](super::parse) reads back with the same corners, bit
/// for bit.
///
/// Vertices at the same place become one, and vertices without triangles are left out: the format has neither. So are
/// normals at corners, texture coordinates and materials.
///
/// # Errors
///
/// Those of `out`, which should be buffered, and `InvalidInput` for more triangles than 32 bits can count.
///
/// ```
/// use bothways_common::{Mesh, glam::Vec3};
/// use bothways_formats::stl;
///
/// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, 0.1 * Vec3::Y], vec![[0, 1, 2]])?;
/// let mut file = Vec::new();
/// stl::write(&mesh, &mut file)?;
/// assert_eq!(file.len(), 84 + 50);
/// assert_eq!(stl::parse("mesh.stl", &file)?, mesh);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let facets = u32::try_from(mesh.triangles().len());
    let facets = facets.map_err(|_| io::Error::from(io::ErrorKind::InvalidInput))?;
    // A file that begins with "solid" would be taken for an ASCII one by some programs.
    let mut header = [b' '; 80];
    header[..10].copy_from_slice(b"binary STL");
    out.write_all(&header)?;
    out.write_all(&facets.to_le_bytes())?;
    for triangle in 0..mesh.triangles().len() {
        let corners = mesh.corners(triangle);
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
        for vector in [normal].into_iter().chain(corners) {
            for number in vector.to_array() {
                out.write_all(&number.to_le_bytes())?;
            }
        }
        out.write_all(&[0; 2])?;
    }
    Ok(())
}
