//! The scenes that test coverage alone: edges, corners, shared edges and slivers, in pixels.

use super::sketch::sketch;
use super::vector::{Group, Vector};

pub(super) fn vectors() -> Vec<Vector> {
    [edges(), corners(), shared_edges(), slivers()].concat()
}

fn edges() -> Vec<Vector> {
    let sketch = |name, point| sketch(Group::Edges, name, point);
    vec![
        sketch("one-triangle", "No sample lies on an edge: begin here.")
            .flat([[1.0, 1.0], [7.0, 2.25], [3.0, 7.25]])
            .done(),
        sketch("left-edge", "A vertical left edge owns the samples that lie on it.")
            .flat([[2.5, 0.75], [2.5, 7.25], [7.25, 4.0]])
            .done(),
        sketch("right-edge", "A vertical right edge does not own the samples that lie on it.")
            .flat([[5.5, 0.75], [5.5, 7.25], [0.75, 4.0]])
            .done(),
        sketch("top-edge", "A horizontal top edge owns the samples that lie on it.")
            .flat([[0.75, 2.5], [7.25, 2.5], [4.0, 7.25]])
            .done(),
        sketch("bottom-edge", "A horizontal bottom edge does not own the samples that lie on it.")
            .flat([[0.75, 5.5], [7.25, 5.5], [4.0, 0.75]])
            .done(),
        sketch("rising-left-edge", "An edge like / with the inside on its right owns its samples.")
            .flat([[1.0, 7.0], [7.0, 1.0], [7.25, 7.25]])
            .done(),
        sketch("rising-right-edge", "An edge like / with the inside on its left does not.")
            .flat([[1.0, 7.0], [7.0, 1.0], [0.75, 0.75]])
            .done(),
        sketch(
            "falling-left-edge",
            "An edge like \\ with the inside on its right owns its samples.",
        )
        .flat([[1.0, 1.0], [7.0, 7.0], [7.25, 0.75]])
        .done(),
        sketch("falling-right-edge", "An edge like \\ with the inside on its left does not.")
            .flat([[1.0, 1.0], [7.0, 7.0], [0.75, 7.25]])
            .done(),
        sketch("steep-left-edge", "A left edge through every other sample of its rows.")
            .flat([[3.0, 0.5], [6.5, 7.5], [7.75, 2.0]])
            .done(),
        sketch("square", "All sides lie on samples: a square of 5 x 5 pixels, not 6 x 6 or 4 x 4.")
            .flat_quad([[1.5, 1.5], [6.5, 1.5], [6.5, 6.5], [1.5, 6.5]])
            .done(),
        sketch("winding", "Clockwise and counter-clockwise cover alike: no face is culled.")
            .size(8, 16)
            .flat([[1.5, 1.5], [6.5, 1.5], [1.5, 6.5]])
            .flat([[9.5, 1.5], [9.5, 6.5], [14.5, 1.5]])
            .done(),
        sketch("first-corner", "It does not matter which corner of a triangle comes first.")
            .size(8, 24)
            .flat([[1.5, 1.5], [6.5, 3.5], [2.5, 6.5]])
            .flat([[14.5, 3.5], [10.5, 6.5], [9.5, 1.5]])
            .flat([[18.5, 6.5], [17.5, 1.5], [22.5, 3.5]])
            .done(),
    ]
}

fn corners() -> Vec<Vector> {
    let sketch = |name, point| sketch(Group::Corners, name, point);
    vec![
        sketch("corner-above", "A single top corner does not own the sample it lies on.")
            .flat([[3.5, 2.5], [6.25, 7.0], [1.25, 7.0]])
            .done(),
        sketch("corner-below", "A single bottom corner does not own the sample it lies on.")
            .flat([[3.5, 5.5], [1.25, 1.0], [6.25, 1.0]])
            .done(),
        sketch("corner-left", "A single left corner owns the sample it lies on.")
            .flat([[2.5, 3.5], [7.0, 1.25], [7.0, 6.25]])
            .done(),
        sketch("corner-right", "A single right corner does not own the sample it lies on.")
            .flat([[5.5, 3.5], [1.0, 1.25], [1.0, 6.25]])
            .done(),
        sketch("three-corners", "Each corner lies on a sample; the rule decides one by one.")
            .flat([[1.5, 1.5], [6.5, 3.5], [2.5, 6.5]])
            .done(),
        fan_around_a_sample(),
        sketch("one-sample", "A triangle smaller than a pixel covers the one sample within it.")
            .flat([[3.25, 3.25], [3.75, 3.375], [3.5, 3.75]])
            .done(),
        sketch(
            "no-sample",
            "A triangle nearly as large as a pixel covers nothing between samples.",
        )
        .flat([[3.625, 3.625], [4.375, 3.75], [4.0, 4.375]])
        .done(),
    ]
}

fn fan_around_a_sample() -> Vector {
    let point = "Eight triangles meet in a sample: exactly one of them owns it.";
    let around = [
        [6.5, 3.5],
        [6.5, 6.5],
        [3.5, 6.5],
        [0.5, 6.5],
        [0.5, 3.5],
        [0.5, 0.5],
        [3.5, 0.5],
        [6.5, 0.5],
    ];
    let mut fan = sketch(Group::Corners, "fan", point);
    for (index, &corner) in around.iter().enumerate() {
        fan = fan.flat([[3.5, 3.5], corner, around[(index + 1) % around.len()]]);
    }
    fan.done()
}

fn shared_edges() -> Vec<Vector> {
    let sketch = |name, point| sketch(Group::SharedEdges, name, point);
    vec![
        sketch("shared-diagonal", "A cut through samples: each has one owner, the right half.")
            .flat_quad([[1.0, 1.0], [7.0, 1.0], [7.0, 7.0], [1.0, 7.0]])
            .done(),
        sketch("shared-vertical", "An upright cut through samples: the right triangle owns them.")
            .flat([[3.5, 0.75], [3.5, 7.25], [0.75, 4.0]])
            .flat([[3.5, 0.75], [7.25, 4.0], [3.5, 7.25]])
            .done(),
        sketch("shared-horizontal", "A level cut through samples: the lower triangle owns them.")
            .flat([[0.75, 3.5], [7.25, 3.5], [4.0, 0.75]])
            .flat([[0.75, 3.5], [4.0, 7.25], [7.25, 3.5]])
            .done(),
        sketch("shared-mixed-winding", "The owner of a cut does not depend on either winding.")
            .flat([[1.0, 1.0], [7.0, 1.0], [7.0, 7.0]])
            .flat([[1.0, 1.0], [1.0, 7.0], [7.0, 7.0]])
            .done(),
        tiles(),
        strip(),
    ]
}

fn tiles() -> Vector {
    let point = "Eighteen triangles with every corner on a sample: no gap, no overlap.";
    let mut tiles = sketch(Group::SharedEdges, "tiles", point);
    for top in [0.5, 2.5, 4.5] {
        for left in [0.5, 2.5, 4.5] {
            let (right, bottom) = (left + 2.0, top + 2.0);
            tiles = tiles.flat_quad([[left, top], [right, top], [right, bottom], [left, bottom]]);
        }
    }
    tiles.done()
}

fn strip() -> Vector {
    let point = "A strip of triangles whose corners lie on 256ths of a pixel: no gap, no overlap.";
    let corners: [[u16; 2]; 8] = [
        [65, 3_105],
        [289, 703],
        [1_153, 3_487],
        [1_345, 353],
        [2_559, 3_807],
        [2_241, 801],
        [3_969, 2_879],
        [3_743, 223],
    ];
    let corners = corners.map(|corner| corner.map(|number| f32::from(number) / 256.0));
    let strip = sketch(Group::SharedEdges, "strip", point).size(16, 16);
    corners
        .windows(3)
        .fold(strip, |strip, window| strip.flat([window[0], window[1], window[2]]))
        .done()
}

/// About a thousandth of a pixel.
const THIN: f32 = 1.0 / 1024.0;
/// The width of a pixel after sixteen halvings.
const HAIR: f32 = 1.0 / 65_536.0;

fn slivers() -> Vec<Vector> {
    let sketch = |name, point| sketch(Group::Slivers, name, point);
    vec![
        sketch("needle-on-samples", "A needle along a row of samples covers those within it.")
            .flat([[0.25, 3.5 - 64.0 * THIN], [0.25, 3.5 + 64.0 * THIN], [7.75, 3.5]])
            .done(),
        sketch("needle-between-samples", "A thicker needle between two rows covers nothing.")
            .flat([[0.25, 3.75], [0.25, 4.25], [7.75, 4.0]])
            .done(),
        sketch(
            "needle-right-of-samples",
            "A needle on samples that are its left edge's: all eight.",
        )
        .flat([[0.25, 0.25], [7.75, 7.75], [7.75, 7.75 - THIN]])
        .done(),
        sketch("needle-left-of-samples", "A needle on samples that are its right edge's: none.")
            .flat([[0.25, 0.25], [7.75, 7.75], [7.75, 7.75 + THIN]])
            .done(),
        sketch("no-area", "Three corners in a line through samples cover nothing.")
            .flat([[0.5, 0.5], [3.5, 3.5], [7.5, 7.5]])
            .done(),
        sketch("one-point", "Three equal corners on a sample cover nothing.")
            .flat([[3.5; 2]; 3])
            .done(),
        sketch("hair", "Right edges that pass samples, or miss them, by 1/65536 of a pixel.")
            .size(8, 16)
            .flat([[5.5 + HAIR, 0.75], [5.5 + HAIR, 7.25], [0.75, 4.0]])
            .flat([[13.5 - HAIR, 0.75], [13.5 - HAIR, 7.25], [8.75, 4.0]])
            .done(),
        thin_fan(),
    ]
}

fn thin_fan() -> Vector {
    let point = "Sixteen slivers from one corner on a sample: no gap, no overlap.";
    let fan = sketch(Group::Slivers, "thin-fan", point).size(16, 16);
    let at = |step: u8| [15.5, 5.5 + 0.25 * f32::from(step)];
    (0..16).fold(fan, |fan, step| fan.flat([[0.5, 8.5], at(step), at(step + 1)])).done()
}
