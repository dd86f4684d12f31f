//! The scenes that test which of several triangles is visible. Corners are `[x, y, depth]`; at depth 16 one unit of
//! the world is one pixel.
//!
//! In a slanted plane, `1/depth` is linear in pixels: 1/32, 1/16 and 1/8 lie at distances 1 : 2.

use super::sketch::sketch;
use super::vector::{Group, Vector};

pub(super) fn vectors() -> Vec<Vector> {
    [order(), ties(), crossings()].concat()
}

fn order() -> Vec<Vector> {
    let sketch = |name, point| sketch(Group::Depth, name, point);
    let near = [[1.0, 1.0, 8.0], [7.0, 2.0, 8.0], [2.0, 6.0, 8.0]];
    let far = [[7.0, 7.0, 32.0], [1.0, 5.0, 32.0], [6.0, 1.0, 32.0]];
    vec![
        sketch("near-first", "The nearer triangle is seen when it comes first.")
            .pixels(near)
            .pixels(far)
            .done(),
        sketch("near-last", "The nearer triangle is seen when it comes last.")
            .pixels(far)
            .pixels(near)
            .done(),
        sketch("one-millionth-nearer", "The second triangle is nearer by a millionth: it is seen.")
            .flat([[1.0, 1.0], [7.0, 2.0], [2.0, 6.0]])
            .pixels([[7.0, 7.0], [1.0, 5.0], [6.0, 1.0]].map(|[x, y]| [x, y, ALMOST]))
            .done(),
        sketch("depth-is-not-linear", "Depth interpolated linearly in pixels picks the wrong one.")
            .pixels([[0.25, 0.5, 4.0], [0.25, 7.5, 4.0], [7.75, 4.0, 64.0]])
            .flat([[7.75, 0.5], [7.75, 7.5], [0.25, 4.0]])
            .done(),
    ]
}

/// A depth of 16, less 2⁻²⁰ of it: about a millionth.
const ALMOST: f32 = 16.0 - 1.0 / 65_536.0;

fn ties() -> Vec<Vector> {
    let sketch = |name, point| sketch(Group::Depth, name, point);
    let [a, b, c] = [[1.5, 1.5], [6.5, 2.5], [2.5, 6.5]];
    vec![
        sketch(
            "duplicate",
            "One triangle three times, wound and begun differently: the first is seen.",
        )
        .flat([a, b, c])
        .flat([b, c, a])
        .flat([a, c, b])
        .done(),
        sketch("coplanar", "Two triangles of one plane overlap: the first in the scene is seen.")
            .flat([[1.0, 1.0], [7.0, 2.0], [2.0, 6.0]])
            .flat([[7.0, 7.0], [1.0, 5.0], [6.0, 1.0]])
            .done(),
        sketch("coplanar-slanted", "The same in a slanted plane, from other corners: no flicker.")
            .pixels([[2.0, 1.0, 32.0], [8.0, 2.0, 8.0], [4.0, 7.0, 16.0]])
            .pixels([[2.0, 6.5, 32.0], [8.0, 6.0, 8.0], [4.0, 0.5, 16.0]])
            .done(),
        sketch("fold", "Two faces fold to the right along samples: there the nearer face is seen.")
            .pixels([[3.5, 1.0, 16.0], [3.5, 7.0, 16.0], [7.5, 4.0, 32.0]])
            .pixels([[3.5, 1.0, 16.0], [3.5, 7.0, 16.0], [7.5, 4.0, 8.0]])
            .done(),
        sketch("ridge", "Two faces meet in a ridge on samples: the right one owns it.")
            .pixels([[3.5, 0.75, 8.0], [3.5, 7.25, 8.0], [0.5, 4.0, 16.0]])
            .pixels([[3.5, 0.75, 8.0], [3.5, 7.25, 8.0], [7.5, 4.0, 16.0]])
            .done(),
    ]
}

fn crossings() -> Vec<Vector> {
    let sketch = |name, point| sketch(Group::Depth, name, point);
    vec![
        sketch("crossing", "Two triangles cross between samples: each is seen on its side.")
            .flat([[0.5, 0.75], [0.5, 7.25], [7.5, 4.0]])
            .pixels([[2.0, 1.0, 32.0], [8.0, 2.0, 8.0], [2.0, 7.0, 32.0]])
            .done(),
        sketch(
            "crossing-on-samples",
            "They cross on samples: there the one nearer to the right is seen.",
        )
        .flat([[0.75, 0.5], [0.75, 7.5], [7.5, 4.0]])
        .pixels([[1.5, 1.0, 32.0], [7.5, 2.0, 8.0], [1.5, 7.0, 32.0]])
        .done(),
        sketch(
            "crossing-in-a-row",
            "They cross along a row: there the one nearer just below is seen.",
        )
        .flat([[0.5, 0.75], [7.5, 0.75], [4.0, 7.5]])
        .pixels([[1.0, 1.5, 32.0], [2.0, 7.5, 8.0], [7.0, 1.5, 32.0]])
        .done(),
        sketch(
            "cycle",
            "Each of three needles lies before the next: no order of painting is right.",
        )
        .size(16, 16)
        .pixels([[1.0, 12.0, 8.0], [1.0, 15.0, 8.0], [15.0, 13.5, 32.0]])
        .pixels([[13.0, 15.0, 8.0], [16.0, 15.0, 8.0], [8.0, 1.0, 32.0]])
        .pixels([[7.0, 1.0, 8.0], [10.0, 1.0, 8.0], [2.0, 15.5, 32.0]])
        .done(),
    ]
}
