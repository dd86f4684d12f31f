//! Writes OBJ files.

use crate::attributes::NONE;
use bothways_common::scene::{Attribute, Mesh, MeshMaterials};
use std::fmt;
use std::io::{self, Write};

/// Writes a mesh as an OBJ file that [`parse`](super::parse) reads back bit for bit.
///
/// Numbers are written as the shortest decimals that read back as the same numbers. Triangles keep their order;
/// positions, normals and texture coordinates keep their indices; materials keep their names. An attribute that no
/// corner uses is left out. A mesh without triangles, and values that are not finite, are written, but the reader
/// refuses them.
///
/// # Errors
///
/// Those of `out`, which should be buffered.
///
/// ```
/// use bothways_common::{Mesh, glam::Vec3};
/// use bothways_formats::obj;
///
/// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, 0.1 * Vec3::Y], vec![[0, 1, 2]])?;
/// let mut file = Vec::new();
/// obj::write(&mesh, &mut file)?;
/// assert_eq!(file, b"v 0 0 0\nv 1 0 0\nv 0 0.1 0\nf 1 2 3\n");
/// assert_eq!(obj::parse("mesh.obj", &file)?, mesh);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let materials = mesh.materials();
    for library in materials.map_or(&[][..], MeshMaterials::libraries) {
        writeln!(out, "mtllib {library}")?;
    }
    for &position in mesh.positions() {
        write_values(out, "v", position.to_array())?;
    }
    let (texture, normals) = (mesh.texture_coordinates(), mesh.normals());
    if is_used(texture) {
        for &value in &texture.values {
            write_values(out, "vt", value.to_array())?;
        }
    }
    if is_used(normals) {
        for &value in &normals.values {
            write_values(out, "vn", value.to_array())?;
        }
    }
    let named = materials.map_or(&[][..], MeshMaterials::named);
    let mut spans = materials.map_or(&[][..], MeshMaterials::spans).iter().peekable();
    for (triangle, &vertices) in mesh.triangles().iter().enumerate() {
        if let Some(span) = spans.next_if(|span| span.first == triangle) {
            let name = span.material.map(|place| &named[place as usize].name);
            // A `usemtl` without a name ends the use of the material before it.
            writeln!(out, "usemtl{}", name.map_or(String::new(), |name| format!(" {name}")))?;
        }
        write!(out, "f")?;
        for (corner, &vertex) in vertices.iter().enumerate() {
            let (texture, normal) =
                (index_of(texture, triangle, corner), index_of(normals, triangle, corner));
            write_corner(out, vertex, texture, normal)?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Tells whether any corner has an index into an attribute.
fn is_used<T>(attribute: &Attribute<T>) -> bool {
    attribute.corners.as_flattened().iter().any(|&index| index != NONE)
}

/// The index of a corner's value of an attribute, if it has one.
fn index_of<T>(attribute: &Attribute<T>, triangle: usize, corner: usize) -> Option<u32> {
    let corners = attribute.corners.get(triangle)?;
    Some(corners[corner]).filter(|&index| index != NONE)
}

fn write_corner(
    out: &mut impl Write,
    vertex: u32,
    texture: Option<u32>,
    normal: Option<u32>,
) -> io::Result<()> {
    // OBJ counts from 1. The sum cannot overflow: the largest number stands for no index.
    let vertex = vertex + 1;
    match (texture.map(|index| index + 1), normal.map(|index| index + 1)) {
        (None, None) => write!(out, " {vertex}"),
        (Some(texture), None) => write!(out, " {vertex}/{texture}"),
        (None, Some(normal)) => write!(out, " {vertex}//{normal}"),
        (Some(texture), Some(normal)) => write!(out, " {vertex}/{texture}/{normal}"),
    }
}

fn write_values<const N: usize>(
    out: &mut impl Write,
    keyword: &str,
    values: [f32; N],
) -> io::Result<()> {
    out.write_all(keyword.as_bytes())?;
    for value in values {
        write!(out, " {}", Shortest(value))?;
    }
    writeln!(out)
}

/// Displays a number with the fewest digits that read back as the same number, and with a power of ten where it would
/// have many zeros.
struct Shortest(f32);

impl fmt::Display for Shortest {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Shortest(value) = *self;
        if value == 0.0 || (1e-4..1e9).contains(&value.abs()) {
            write!(f, "{value}")
        } else {
            write!(f, "{value:e}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec2, Vec3};

    #[test]
    fn numbers_are_short_and_corners_have_their_indices() {
        let positions =
            vec![Vec3::new(-0.0, 0.1, f32::MAX), Vec3::splat(f32::MIN_POSITIVE), Vec3::NEG_Y];
        let normals = Attribute { values: vec![Vec3::Z], corners: vec![[0, 0, NONE], [NONE; 3]] };
        let texture = Attribute { values: vec![Vec2::X], corners: vec![[NONE, 0, 0], [NONE; 3]] };
        let mesh = Mesh::new(positions, vec![[0, 1, 2], [2, 1, 0]]).unwrap();
        let mesh = mesh.with_normals(normals).unwrap().with_texture_coordinates(texture).unwrap();
        let lines = [
            "v -0 0.1 3.4028235e38",
            "v 1.1754944e-38 1.1754944e-38 1.1754944e-38",
            "v 0 -1 0",
            "vt 1 0",
            "vn 0 0 1",
            "f 1//1 2/1/1 3/1",
            "f 3 2 1",
        ];
        let mut out = Vec::new();
        write(&mesh, &mut out).unwrap();
        assert_eq!(String::from_utf8(out).unwrap().lines().collect::<Vec<_>>(), lines);
    }
}
