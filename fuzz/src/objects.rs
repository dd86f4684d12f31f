//! Turns bytes into objects. Many of them share planes, edges and vertices with earlier ones.

use crate::numbers::Numbers;
use bothways_common::glam::Vec3;
use bothways_common::{Mesh, Object, Plane, Shape, Sphere, Triangle};
use libfuzzer_sys::arbitrary::{Result, Unstructured};

/// The most objects: the textbook tests every primitive at every sample.
const MOST_OBJECTS: usize = 16;
/// The most triangles of a mesh.
const MOST_TRIANGLES: usize = 40;

/// Makes objects until the bytes end.
pub(crate) fn objects(bytes: &mut Unstructured, numbers: Numbers) -> Result<Vec<Object>> {
    let mut shapes: Vec<Shape> = Vec::new();
    while !bytes.is_empty() && shapes.len() < MOST_OBJECTS {
        let Ok(shape) = shape(bytes, numbers, &shapes) else {
            break;
        };
        shapes.push(shape);
    }
    Ok(shapes.into_iter().map(Object::from).collect())
}

fn shape(bytes: &mut Unstructured, numbers: Numbers, before: &[Shape]) -> Result<Shape> {
    Ok(match bytes.int_in_range(0..=11)? {
        0..=2 => triangle(corners(bytes, numbers)?),
        3 | 4 => {
            // In one of a few planes that other triangles share.
            let z = -f32::from(bytes.int_in_range(1..=3_u8)?);
            triangle(corners(bytes, numbers)?.map(|corner| corner.with_z(z)))
        }
        5 => {
            let [a, b, c] = corners(bytes, numbers)?;
            // Triangles with equal corners, needles and collinear corners.
            triangle(
                [a, b, *bytes.choose(&[a, b, 0.5 * a + 0.5 * b, b + 1e-6 * (c - b)])?].map(tame),
            )
        }
        6 | 7 => mesh(bytes, numbers)?,
        8 => {
            let (center, radius) = (numbers.point(bytes)?, numbers.coordinate(bytes)?.abs());
            Shape::Sphere(Sphere { center, radius: if radius == 0.0 { 1.0 } else { radius } })
        }
        9 => {
            let (point, normal) = (numbers.point(bytes)?, numbers.point(bytes)?);
            Shape::Plane(Plane {
                point,
                normal: if normal == Vec3::ZERO { Vec3::Z } else { normal },
            })
        }
        _ if before.is_empty() => triangle(corners(bytes, numbers)?),
        _ => {
            let earlier = bytes.choose(before)?.clone();
            near_copy(bytes, earlier)?
        }
    })
}

fn corners(bytes: &mut Unstructured, numbers: Numbers) -> Result<[Vec3; 3]> {
    Ok([numbers.point(bytes)?, numbers.point(bytes)?, numbers.point(bytes)?])
}

fn triangle([a, b, c]: [Vec3; 3]) -> Shape {
    Shape::Triangle(Triangle { a, b, c })
}

/// The corner, or the origin if it is not finite: a sum of extreme numbers may be infinite.
fn tame(corner: Vec3) -> Vec3 {
    if corner.is_finite() { corner } else { Vec3::ZERO }
}

/// A mesh of a regular grid, or of triangles between any of a few positions.
fn mesh(bytes: &mut Unstructured, numbers: Numbers) -> Result<Shape> {
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let mut positions = Vec::new();
    if bytes.arbitrary()? {
        let [corner, across, up] = corners(bytes, numbers)?;
        let side = bytes.int_in_range(1..=4_u32)?;
        for k in 0..(side + 1) * (side + 1) {
            let [column, row] = [k % (side + 1), k / (side + 1)].map(|step| step as f32);
            positions.push(tame(corner + column * across + row * up));
        }
        for k in 0..side * side {
            let a = k / side * (side + 1) + k % side;
            let [b, c, d] = [a + 1, a + side + 2, a + side + 1];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    } else {
        for _ in 0..bytes.int_in_range(3..=16)? {
            positions.push(numbers.point(bytes)?);
        }
        let last = positions.len() as u32 - 1;
        for _ in 0..bytes.int_in_range(1..=MOST_TRIANGLES)? {
            let mut index = || bytes.int_in_range(0..=last);
            triangles.push([index()?, index()?, index()?]);
        }
    }
    Ok(Shape::Mesh(Mesh::new(positions, triangles).expect("positions are finite")))
}

/// A copy of an earlier shape: equal, with its corners in another order or one of them twice, or with one coordinate moved
/// by one bit.
fn near_copy(bytes: &mut Unstructured, shape: Shape) -> Result<Shape> {
    let how = bytes.int_in_range(0..=5_u8)?;
    let nudged = |corner: Vec3| {
        let moved = if how == 4 { corner.x.next_up() } else { corner.x.next_down() };
        tame(corner.with_x(moved))
    };
    Ok(match shape {
        Shape::Triangle(Triangle { a, b, c }) => triangle(match how {
            0 => [a, b, c],
            1 => [b, c, a],
            2 => [b, a, c],
            3 => [a, b, a],
            _ => [nudged(a), b, c],
        }),
        Shape::Mesh(mesh) if how >= 4 => {
            Shape::Mesh(mesh.map(nudged, |normal| normal).expect("positions stay finite"))
        }
        Shape::Sphere(Sphere { center, radius }) if how >= 4 => {
            Shape::Sphere(Sphere { center: nudged(center), radius })
        }
        other => other,
    })
}
