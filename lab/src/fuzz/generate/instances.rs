//! Instances of a mesh: where it is, beside that, turned by quarters, mirrored, stretched, flattened.

use super::stage::Stage;
use crate::common::glam::Vec3;
use crate::common::{Instances, Mesh, Placement, Shape};

/// A mesh in some places; the mesh alone where they would leave the range of numbers.
pub(super) fn instances(stage: &mut Stage, mesh: Mesh) -> Shape {
    let count = 1 + stage.dice.below(6);
    // A vertex of the mesh stays in the picture if it comes to a place that is seen there.
    let about = mesh.positions()[stage.dice.below(mesh.positions().len())];
    let placements = (0..count).map(|_| placement(stage, about)).collect();
    match Instances::new(mesh.clone(), placements) {
        Ok(instances) => Shape::Instances(instances),
        Err(_) => Shape::Mesh(mesh),
    }
}

fn placement(stage: &mut Stage, about: Vec3) -> Placement {
    const ORDERS: [[usize; 3]; 6] =
        [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    if stage.dice.once_in(4) {
        return Placement::IDENTITY;
    }
    let target = stage.point();
    let how = stage.dice.below(5);
    let order = if how < 2 { ORDERS[0] } else { stage.dice.one_of(&ORDERS) };
    let mut rows = [[0.0_f32; 4]; 3];
    for axis in 0..3 {
        rows[axis][order[axis]] = match how {
            0..=1 => 1.0,
            2 => stage.dice.one_of(&[1.0, -1.0]),
            3 => stage.dice.one_of(&[1.0, -2.0, 0.5, 0.0]),
            _ => stage.dice.single(-1.5, 1.5),
        };
        if how == 4 {
            rows[axis][order[(axis + 1) % 3]] = stage.dice.single(-1.0, 1.0);
        }
    }
    // From where the linear part alone puts the vertex.
    let linear = Placement::from_rows(rows).position(about);
    for axis in 0..3 {
        rows[axis][3] = target[axis] - linear[axis];
    }
    Placement::from_rows(rows)
}
