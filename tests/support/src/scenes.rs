//! Small scenes.

use crate::cameras::{PROJECTIONS, on_integers};
use bothways_common::glam::{Vec2, Vec3};
use bothways_common::{Camera, Mesh, Object, Scene, Shape, Triangle};

/// One triangle.
pub fn triangle(corners: [[f32; 3]; 3]) -> Object {
    let [a, b, c] = corners.map(Vec3::from_array);
    Shape::Triangle(Triangle { a, b, c }).into()
}

/// A scene of these objects.
pub fn scene(objects: Vec<Object>) -> Scene {
    Scene::new(objects).expect("it is a scene")
}

/// A mesh as an object.
pub fn mesh(mesh: Mesh) -> Object {
    Shape::Mesh(mesh).into()
}

/// Grids of squares with several side lengths, each with its camera and its name. The corners are on quarters of the
/// camera's samples.
pub fn grids_on_quarters() -> impl Iterator<Item = (Scene, Camera, String)> {
    // Each grid reaches beyond its picture. For small squares, a small picture shows as much as a large one, and the
    // textbook tests all squares at all samples.
    let sides =
        [(0.25, 52, 6), (0.5, 28, 6), (1.0, 24, 10), (2.0, 12, 10), (4.0, 6, 10), (9.0, 2, 10)];
    PROJECTIONS.into_iter().flat_map(move |projection| {
        sides.into_iter().flat_map(move |(side, squares, half)| {
            [Vec2::ZERO, Vec2::new(0.25, 0.5)].into_iter().map(move |shift| {
                let what = format!("{projection:?}, squares of {side}, moved by {shift}");
                (scene(vec![grid(side, squares, shift)]), on_integers(projection, half), what)
            })
        })
    })
}

/// The corners of a grid of squares in the plane z = −1, moved by `shift`, divided by both diagonals in turn.
#[expect(clippy::cast_possible_truncation, reason = "small numbers")]
fn grid(side: f32, squares: usize, shift: Vec2) -> Object {
    let count = squares + 1;
    let half = 0.5 * side * squares as f32;
    let place = |k: usize| {
        let [column, row] = [k % count, k / count].map(|index| side * index as f32 - half);
        Vec3::new(column + shift.x, row + shift.y, -1.0)
    };
    let square = |k: usize| {
        let a = (k / squares * count + k % squares) as u32;
        let [b, c, d] = [a + 1, a + count as u32 + 1, a + count as u32];
        if k.is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    let triangles = (0..squares * squares).flat_map(square).collect();
    mesh(Mesh::new((0..count * count).map(place).collect(), triangles).expect("it is a mesh"))
}
