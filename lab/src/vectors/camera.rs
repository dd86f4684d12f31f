//! The scenes that test the camera: another eye, other axes, another distance.

use super::sketch::{Sketch, sketch};
use super::vector::{Group, Vector};

pub(super) fn vectors() -> Vec<Vector> {
    let sketch = |name, point| sketch(Group::Camera, name, point).size(16, 20);
    let center = [0.25, -0.75, -0.25];
    vec![
        with_house(
            sketch("moved-eye", "The eye is not the world's origin, but the axes are its axes.")
                .standing([1.75, 0.375, 12.75]),
        ),
        with_house(
            sketch("turned-aside", "The camera turns to the right: u and w are not x and z.")
                .looking([-6.5, 1.125, 9.0], [0.75, -0.25, -0.5]),
        ),
        with_house(
            sketch("looking-down", "The camera looks down: v is not the up that it is given.")
                .looking([5.125, 9.0, 7.75], center),
        ),
        with_house(
            sketch("rolled", "Another up, longer than 1: the house stands aslant.")
                .looking([-6.0, 1.5, 8.875], [0.75, -0.25, -0.5])
                .holding([1.0, 2.0, 0.25]),
        ),
        with_house(
            sketch("near-viewport", "The viewport is small, and nearer to the eye.")
                .looking([5.625, 8.25, 7.625], center)
                .viewport([1.875, 1.5])
                .at_distance(1.25),
        ),
        with_house(
            sketch("turned-parallel", "Parallel rays of a camera that looks down askew.")
                .parallel()
                .looking([4.75, 8.375, 8.0], center)
                .viewport([12.5, 10.0]),
        ),
        turned_box(),
    ]
}

/// A house on a floor. It is not symmetric, so that every wrong turn is seen.
fn with_house(sketch: Sketch) -> Vector {
    sketch
        .world_quad([
            [-5.5, -2.0, 4.5],
            [6.25, -2.0, 4.5],
            [6.25, -2.0, -5.25],
            [-5.5, -2.0, -5.25],
        ])
        .world_quad([
            [-3.25, -2.0, 1.75],
            [0.5, -2.0, 1.75],
            [0.5, 1.25, 1.75],
            [-3.25, 1.25, 1.75],
        ])
        .world_quad([[0.5, -2.0, 1.75], [0.5, -2.0, -3.5], [0.5, 1.25, -3.5], [0.5, 1.25, 1.75]])
        .world([[-3.25, 1.25, 1.75], [0.5, 1.25, 1.75], [-1.25, 3.5, -0.75]])
        .world([[0.5, 1.25, 1.75], [0.5, 1.25, -3.5], [-1.25, 3.5, -0.75]])
        .world([[3.0, -2.0, 2.5], [4.75, -2.0, 0.25], [3.75, 2.5, 1.25]])
        .done()
}

fn turned_box() -> Vector {
    let point = "A box before a camera that looks down on it askew: no gap along any edge.";
    let corner =
        |index: usize| [0, 1, 2].map(|axis| if index >> axis & 1 == 1 { 3.0 } else { -3.0 });
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let turned =
        sketch(Group::Camera, "turned-box", point).size(16, 20).looking([9.0, 7.0, 13.0], [0.0; 3]);
    faces.into_iter().fold(turned, |turned, face| turned.world_quad(face.map(corner))).done()
}
