//! Triangles, spheres and planes: alone, side by side, one on the other, through one another.

use super::camera::exp2;
use super::stage::{PicturePoint, Stage, stored, tame};
use super::style::Style;
use crate::common::glam::Vec3;
use crate::common::{Plane, Projection, Shape, Sphere, Triangle};

pub(super) fn triangle([a, b, c]: [Vec3; 3]) -> Shape {
    Shape::Triangle(Triangle { a, b, c })
}

/// One or a few triangles.
pub(super) fn triangles(stage: &mut Stage) -> Vec<Shape> {
    match stage.dice.below(8) {
        0 | 1 => vec![triangle([stage.point(), stage.point(), stage.point()])],
        2 | 3 => coplanar(stage),
        4 => crossing(stage),
        5 | 6 => vec![sliver(stage)],
        _ => vec![reaching(stage)],
    }
}

/// Two or three triangles in one plane, parallel to the viewport or not: they overlap or share an edge.
fn coplanar(stage: &mut Stage) -> Vec<Shape> {
    let [a, b, c] = [stage.place(), stage.place(), stage.place()];
    if stage.dice.once_in(2) {
        // Corners at one depth.
        let flat = |place: PicturePoint| PicturePoint { depth: a.depth, ..place };
        let [d, e] = [stage.place(), stage.place()].map(flat);
        let [a, b, c, d, e] = [a, flat(b), flat(c), d, e].map(|place| stage.at(place));
        return vec![triangle([a, b, c]), triangle([c, b, d]), triangle([a, e, d])];
    }
    let [a, b, c] = [a, b, c].map(|place| stage.at(place));
    // The fourth corner of the parallelogram lies in the plane exactly if no sum rounds.
    let d = tame(b + (c - a));
    let middle = tame(0.5 * a + 0.5 * b);
    vec![triangle([a, b, c]), triangle([b, d, c]), triangle([middle, c, a])]
}

/// Two triangles that cross in a column or a row of the picture: one comes nearer where the other one recedes.
fn crossing(stage: &mut Stage) -> Vec<Shape> {
    let (place, reach) = (stage.place(), stage.length());
    let far = 2.0 * place.depth;
    let upright = stage.dice.once_in(2);
    let corner = |along: f64, across: f64, depth: f64| {
        let [rows, columns] = if upright { [across, along] } else { [along, across] };
        PicturePoint { row: place.row + rows, column: place.column + columns, depth }
    };
    let one = [
        corner(-reach, -reach, place.depth),
        corner(-reach, reach, place.depth),
        corner(reach, 0.0, far),
    ];
    let other = [
        corner(reach, -reach, place.depth),
        corner(reach, reach, place.depth),
        corner(-reach, 0.0, far),
    ];
    [one, other].map(|corners| triangle(corners.map(|place| stage.at(place)))).to_vec()
}

/// A triangle that is thinner than a pixel, along a row or a column of samples or across the picture; or without area.
fn sliver(stage: &mut Stage) -> Shape {
    let (start, long) = (stage.place(), stage.length());
    let thin = f64::from(exp2(stage.dice.within(-26..=0)));
    let [rows, columns] =
        stage.dice.one_of(&[[0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [1.0, -1.0], [0.25, 1.0]]);
    let end = PicturePoint {
        row: start.row + long * rows,
        column: start.column + long * columns,
        ..start
    };
    let beside =
        PicturePoint { row: end.row + thin * columns, column: end.column - thin * rows, ..end };
    let [a, b, c] = [start, end, beside].map(|place| stage.at(place));
    match stage.dice.below(8) {
        0 => triangle([a, b, b]),
        1 => triangle([a, b, tame(0.5 * a + 0.5 * b)]),
        2 => triangle([c, b, a]),
        3 => triangle([stage.nudged(a), stage.nudged(b), b]),
        _ => triangle([a, b, c]),
    }
}

/// A large triangle that reaches behind the eye, or far beyond the picture.
fn reaching(stage: &mut Stage) -> Shape {
    let far = f64::from(exp2(stage.dice.within(2..=20)));
    let [a, b, c] = [stage.place(), stage.place(), stage.place()];
    let behind = match stage.dice.below(3) {
        0 => PicturePoint { depth: -b.depth, ..b },
        1 => PicturePoint { row: far * b.row, column: -far * b.column, ..b },
        _ => PicturePoint { depth: -far * c.depth, row: far * b.row, ..b },
    };
    let corners = [a, behind, c].map(|place| stage.at(place));
    triangle(corners.map(|corner| stage.nudged(corner)))
}

/// A sphere, or two that touch, contain or equal one another.
pub(super) fn spheres(stage: &mut Stage) -> Vec<Shape> {
    let place = stage.place();
    let [high, wide] = stage.pixel_size(place.depth);
    let (center, size) = (stage.at(place), stage.length());
    let radius = match stage.dice.below(6) {
        // The eye on the sphere, if the distance has few bits.
        0 => (center - stage.camera.eye()).length(),
        // Around the eye.
        1 => 2.0 * (center - stage.camera.eye()).length(),
        // Its silhouette on a row or a column of samples: exactly so for parallel rays.
        2 => lower(size.ceil().max(0.5) * high),
        _ => lower(size * wide),
    };
    let first = Sphere { center, radius: positive(radius) };
    if !stage.dice.once_in(2) {
        return vec![Shape::Sphere(first)];
    }
    let second = match stage.dice.below(4) {
        0 => first,
        1 => Sphere { center, radius: positive(0.5 * first.radius) },
        2 => Sphere { center, radius: positive(first.radius.next_up()) },
        _ => {
            // It touches the first from outside, or from inside.
            let way = stage.dice.one_of(&[Vec3::X, Vec3::NEG_Y, Vec3::Z, Vec3::new(0.6, 0.8, 0.0)]);
            let sum = stage.dice.one_of(&[1.5, 0.5]) * first.radius;
            Sphere { center: tame(center + sum * way), radius: positive(0.5 * first.radius) }
        }
    };
    vec![Shape::Sphere(first), Shape::Sphere(second)]
}

#[expect(clippy::cast_possible_truncation, reason = "scenes are stored as f32")]
fn lower(length: f64) -> f32 {
    length as f32
}

/// The radius, or 1 where there is none.
fn positive(radius: f32) -> f32 {
    if radius > 0.0 && radius.is_finite() { radius } else { 1.0 }
}

/// A plane: parallel to the viewport, through corners of the lattice, or through the eye.
pub(super) fn plane(stage: &mut Stage) -> Shape {
    let (u, v, w) = (stage.camera.u(), stage.camera.v(), stage.camera.w());
    let (place, few) = (stage.place(), |stage: &mut Stage| f64::from(stage.dice.within(-3..=3)));
    let point = match stage.dice.below(8) {
        0 => stage.camera.eye(),
        _ => stage.at(place),
    };
    let normal = match stage.dice.below(4) {
        0 => stored(w),
        1 => stored(v),
        2 if stage.style == Style::Extreme => {
            tame(Vec3::new(stage.extreme(), stage.extreme(), stage.extreme()))
        }
        _ => stored(few(stage) * u + few(stage) * v + few(stage) * w),
    };
    let normal = if normal == Vec3::ZERO { Vec3::new(0.0, 1.0, 0.0) } else { normal };
    Shape::Plane(Plane { point, normal })
}

/// A copy of an earlier shape: the same, with its corners in another order, moved, or with a number one bit off.
pub(super) fn near_copy(stage: &mut Stage, shape: Shape) -> Shape {
    let how = stage.dice.below(7);
    let axis = stage.dice.below(3);
    let moved = move |mut point: Vec3| {
        point[axis] = if how == 5 { point[axis].next_up() } else { point[axis].next_down() };
        tame(point)
    };
    match shape {
        Shape::Triangle(Triangle { a, b, c }) => triangle(match how {
            0 => [a, b, c],
            1 => [b, c, a],
            2 => [b, a, c],
            3 => [c, b, stage.point()],
            4 => [a, b, tame(2.0 * c - a)],
            _ => [moved(a), b, c],
        }),
        Shape::Mesh(mesh) if how == 4 => Shape::Mesh(mesh.turned_inside_out()),
        Shape::Mesh(mesh) if how > 4 => {
            Shape::Mesh(mesh.map(moved, |normal| normal).expect("positions stay finite"))
        }
        Shape::Sphere(Sphere { center, radius }) => match how {
            0..=2 => Shape::Sphere(Sphere { center, radius }),
            3 => Shape::Sphere(Sphere { center, radius: positive(radius.next_up()) }),
            _ => Shape::Sphere(Sphere { center: moved(center), radius }),
        },
        Shape::Plane(Plane { point, normal }) => match how {
            0..=2 => Shape::Plane(Plane { point, normal: -normal }),
            3 | 4 => {
                // The plane that touches a sphere or passes a corner, seen by parallel rays or not.
                let along =
                    if stage.camera.projection() == Projection::Parallel { 1.0 } else { 2.0 };
                Shape::Plane(Plane { point, normal: tame(along * normal) })
            }
            _ => Shape::Plane(Plane { point: moved(point), normal }),
        },
        other @ (Shape::Mesh(_) | Shape::Instances(_)) => other,
    }
}
