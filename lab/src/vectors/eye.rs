//! The scenes that test the eye: triangles that reach behind the eye, and parallel rays, which have no eye.

use super::sketch::sketch;
use super::vector::{Group, Vector};

pub(super) fn vectors() -> Vec<Vector> {
    [behind(), parallel()].concat()
}

fn behind() -> Vec<Vector> {
    let sketch = |name, point| sketch(Group::Behind, name, point).size(16, 16);
    vec![
        sketch("one-corner-behind", "One corner lies behind the eye: what is before it is seen.")
            .world([[-6.0, -4.0, -16.0], [6.0, -4.0, -16.0], [0.0, 4.0, 8.0]])
            .done(),
        sketch("two-corners-behind", "Two corners lie behind the eye: the tip before it is seen.")
            .world([[0.0, 4.0, -16.0], [-6.0, -4.0, 8.0], [6.0, -4.0, 8.0]])
            .done(),
        sketch("all-behind", "All corners lie behind the eye: no mirror image is seen.")
            .world([[-6.0, -6.0, 16.0], [6.0, -6.0, 16.0], [0.0, 6.0, 16.0]])
            .done(),
        sketch("corner-beside", "A corner at depth 0 has no place in the picture; the rest has.")
            .world([[-4.0, -4.0, -16.0], [4.0, -4.0, -16.0], [1.0, 8.0, 0.0]])
            .done(),
        sketch("ground", "A floor from behind the eye to far before it: cut like any shared edge.")
            .world_quad([
                [-64.0, -2.0, 16.0],
                [64.0, -2.0, 16.0],
                [1024.0, -2.0, -1024.0],
                [-1024.0, -2.0, -1024.0],
            ])
            .done(),
        sketch("seen-edge-on", "The eye lies in the triangle's plane: nothing is seen of it.")
            .size(9, 9)
            .world([[-2.0, 0.0, -16.0], [2.0, 0.0, -16.0], [0.0, 0.0, 4.0]])
            .done(),
        room(),
    ]
}

fn room() -> Vector {
    let point = "The eye is inside a closed box: every sample is covered, and by one face.";
    let [left, right, floor, ceiling, front, back] = [-8.0, 8.0, -8.0, 8.0, -24.0, 8.0];
    let corner = |x, y, z| [x, y, z];
    let ring = |z| {
        [
            corner(left, floor, z),
            corner(right, floor, z),
            corner(right, ceiling, z),
            corner(left, ceiling, z),
        ]
    };
    let (near, far) = (ring(back), ring(front));
    let mut room =
        sketch(Group::Behind, "room", point).size(17, 17).world_quad(near).world_quad(far);
    for side in 0..4 {
        let next = (side + 1) % 4;
        room = room.world_quad([near[side], near[next], far[next], far[side]]);
    }
    room.done()
}

fn parallel() -> Vec<Vector> {
    let sketch = |name, point| sketch(Group::Parallel, name, point).parallel();
    vec![
        sketch("parallel-square", "Parallel rays obey the top-left rule, too: 5 x 5 pixels.")
            .flat_quad([[1.5, 1.5], [6.5, 1.5], [6.5, 6.5], [1.5, 6.5]])
            .done(),
        sketch("parallel-depth-is-linear", "With parallel rays depth itself is linear in pixels.")
            .pixels([[0.25, 0.5, 4.0], [0.25, 7.5, 4.0], [7.75, 4.0, 64.0]])
            .flat([[7.75, 0.5], [7.75, 7.5], [0.25, 4.0]])
            .done(),
        sketch(
            "parallel-coplanar",
            "Two triangles of one slanted plane overlap: the first is seen.",
        )
        .pixels([[1.0, 1.0, 9.0], [7.0, 2.0, 15.0], [2.0, 6.0, 10.0]])
        .pixels([[7.0, 7.0, 15.0], [1.0, 5.0, 9.0], [6.0, 1.0, 14.0]])
        .done(),
        sketch(
            "parallel-crossing",
            "They cross on samples: there the one nearer to the right is seen.",
        )
        .flat([[0.75, 0.5], [0.75, 7.5], [7.5, 4.0]])
        .pixels([[1.5, 1.0, 18.0], [7.5, 2.0, 12.0], [1.5, 7.0, 18.0]])
        .done(),
        sketch(
            "parallel-behind",
            "It passes the eye's plane on samples: what lies in it is not seen.",
        )
        .size(9, 9)
        .world([[-3.0, -3.0, -8.0], [3.0, -3.0, -8.0], [0.0, 3.0, 8.0]])
        .done(),
        sketch("parallel-edge-on", "A triangle along the rays, right on samples, is not seen.")
            .size(9, 9)
            .world([[0.0, -3.0, -8.0], [0.0, 3.0, -8.0], [0.0, 0.0, -24.0]])
            .done(),
    ]
}
