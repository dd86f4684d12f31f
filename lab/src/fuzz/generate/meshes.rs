//! Meshes with shared vertices: fans, grids, soups, clouds of small triangles, closed surfaces; some large ones, so that
//! clusters, bins and hierarchies are used.

use super::stage::{PicturePoint, Stage, stored, tame};
use super::style::Scale;
use crate::common::Mesh;
use crate::common::glam::{DVec3, Vec3};
use crate::formats::generate::Kind;

/// A mesh.
pub(super) fn mesh(stage: &mut Stage, scale: Scale) -> Mesh {
    let most = most_triangles(stage, scale);
    match stage.dice.below(8) {
        0 | 1 => fan(stage),
        2..=4 => grid(stage, most),
        5 => soup(stage, most.min(if scale.is_large() { 20 } else { 200 })),
        6 => cloud(stage, most),
        _ => closed(stage, most),
    }
}

/// A limit for the triangles of a mesh: low for most, so that many scenes are drawn in a second.
fn most_triangles(stage: &mut Stage, scale: Scale) -> usize {
    let most: u32 = match scale {
        Scale::Tiny => 60,
        Scale::Small => 300,
        Scale::Medium => 3000,
        Scale::Large if stage.dice.once_in(4) => 100_000,
        Scale::Large => 8000,
    };
    stage.dice.size(8..=most) as usize
}

fn made(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh::new(positions, triangles).expect("positions are finite, and triangles name them")
}

/// Triangles around a vertex, closed or not, seen from one side or folded.
fn fan(stage: &mut Stage) -> Mesh {
    let count = 3 + u32::try_from(stage.dice.below(9)).expect("it is small");
    let center = stage.place();
    let radius = stage.length();
    let mut positions = vec![stage.at(center)];
    let flat = stage.dice.once_in(2);
    for k in 0..count {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
        let place = if stage.is_lattice() {
            // On the lattice, and so not always in the order of their angles.
            let mut rim = stage.place();
            if flat {
                rim.depth = center.depth;
            }
            rim
        } else {
            let depth = if flat { center.depth } else { stage.depth() };
            PicturePoint {
                row: center.row + radius * angle.sin(),
                column: center.column + radius * angle.cos(),
                depth,
            }
        };
        let rim = stage.at(place);
        positions.push(stage.nudged(rim));
    }
    let is_closed = stage.dice.once_in(2);
    let last = if is_closed { count } else { count - 1 };
    made(positions, (0..last).map(|k| [0, 1 + k, 1 + (k + 1) % count]).collect())
}

/// Squares over the picture or a part of it, each divided by one of its diagonals: flat, sloped or rough.
fn grid(stage: &mut Stage, most: usize) -> Mesh {
    let count = most / 2;
    let rows = (1 + stage.dice.below(count.isqrt() * 2)).min(count);
    let columns = (count / rows).max(1);
    let corner = stage.place();
    // A square has the same number of pixels everywhere; on a lattice its corners are on it.
    let [high, wide] = [stage.length() / rows as f64, stage.length() / columns as f64];
    let [high, wide] = if stage.is_lattice() {
        [high, wide].map(|side| (side * 4.0).round().max(1.0) / 4.0)
    } else {
        [high, wide]
    };
    let rough = stage.dice.weighted(&[(3, 0.0), (1, 0.01), (1, 0.5)]);
    let slope = stage.dice.one_of(&[0.0, 0.0, 0.25, -0.015_625]);
    let mut positions = Vec::with_capacity((rows + 1) * (columns + 1));
    for i in 0..=rows {
        for j in 0..=columns {
            let noise = if rough > 0.0 { stage.dice.real(0.0, rough) } else { 0.0 };
            let depth = corner.depth * (1.0 + noise + slope * i as f64);
            let place = PicturePoint {
                row: corner.row + high * i as f64,
                column: corner.column + wide * j as f64,
                depth,
            };
            positions.push(stage.at(place));
        }
    }
    let alternate = stage.dice.once_in(2);
    let square = |k: usize| {
        let (i, j) = (k / columns, k % columns);
        let a = index(i * (columns + 1) + j);
        let (b, below) = (a + 1, a + index(columns + 1));
        let c = below + 1;
        if alternate && (i + j).is_multiple_of(2) {
            [[a, below, c], [a, c, b]]
        } else {
            [[a, below, b], [b, below, c]]
        }
    };
    made(positions, (0..rows * columns).flat_map(square).collect())
}

/// Triangles between any of a few points, some of them degenerate.
fn soup(stage: &mut Stage, most: usize) -> Mesh {
    let points = 3 + stage.dice.below(30);
    let positions: Vec<Vec3> = (0..points).map(|_| stage.point()).collect();
    let count = 1 + stage.dice.below(most);
    let triangles = (0..count).map(|_| [0; 3].map(|_: u32| index(stage.dice.below(points))));
    let triangles = triangles.collect();
    made(positions, triangles)
}

/// Small triangles all over the picture, from a part of a pixel to several.
fn cloud(stage: &mut Stage, most: usize) -> Mesh {
    let side = stage.dice.real(-3.0, 5.0).exp2();
    let mut positions = Vec::with_capacity(3 * most);
    for _ in 0..most {
        let place = stage.place();
        positions.push(stage.at(place));
        for _ in 0..2 {
            let (rows, columns) = (stage.pixels(-side, side), stage.pixels(-side, side));
            let depth = if stage.dice.once_in(3) {
                place.depth * stage.dice.real(0.9, 1.1)
            } else {
                place.depth
            };
            positions.push(stage.at(PicturePoint {
                row: place.row + rows,
                column: place.column + columns,
                depth,
            }));
        }
    }
    let triangles = (0..most).map(|k| [0, 1, 2].map(|corner| index(3 * k + corner)));
    made(positions, triangles.collect())
}

/// A closed surface: a generated mesh, stretched and placed, in front of the eye or around it.
fn closed(stage: &mut Stage, most: usize) -> Mesh {
    let kind = stage.dice.one_of(&["sphere", "torus", "box", "cylinder", "cone"]);
    let kind = Kind::named(kind).expect("it is one of the kinds");
    let [least, other] = kind.least_divisions();
    let side = u32::try_from((most / 2).isqrt()).expect("meshes are small");
    let mesh = kind.mesh([side.max(least), side.max(other)]);
    let mesh = mesh.expect("these divisions are neither too few nor too many");
    let place = stage.place();
    let center = if stage.dice.once_in(6) { stage.camera.eye() } else { stage.at(place) };
    let size = stage.length() * stage.pixel_size(place.depth)[1];
    let stretch = DVec3::new(1.0, stage.dice.one_of(&[1.0, 1.0, 0.125]), 1.0) * size;
    let (u, v, w) = (stage.camera.u(), stage.camera.v(), stage.camera.w());
    let positions = mesh.positions().iter().map(|position| {
        let p = position.as_dvec3() * stretch;
        tame(stored(center.as_dvec3() + p.x * u + p.y * v + p.z * w))
    });
    made(positions.collect(), mesh.triangles().to_vec())
}

fn index(place: usize) -> u32 {
    u32::try_from(place).expect("meshes are small")
}
