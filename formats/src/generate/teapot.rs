//! Newell's teapot, from its Bézier patches.
//!
//! The numbers are Martin Newell's ("The Utilization of Procedure Models in Digital Image Synthesis",
//! PhD thesis, University of Utah, 1975), with the height that Blinn gave it and the bottom that
//! Crow added ("The Origins of the Teapot", IEEE Computer Graphics and Applications 7, 1987).
//!
//! The teapot has 32 patches. Those of rim, body, lid and bottom are a profile swept along four quarter arcs; those of
//! handle and spout are a row of cross-sections, mirrored. The tables below have this form, so that neighbouring patches
//! share their vertices by construction.

use super::tessellation::{Tessellation, Vertex};
use bothways_common::scene::Mesh;
use glam::{DVec2, DVec3};

/// Control points of consecutive cubic Bézier curves. Each curve begins at the end of the curve before it.
type Curves<T> = [[T; 4]];

/// Rim, body and bottom, from the inside of the rim down to the middle of the bottom: the distance from the axis, and the
/// height.
const BODY: &Curves<[f64; 2]> = &[
    [[1.4, 2.4], [1.3375, 2.53125], [1.4375, 2.53125], [1.5, 2.4]],
    [[1.5, 2.4], [1.75, 1.875], [2.0, 1.35], [2.0, 0.9]],
    [[2.0, 0.9], [2.0, 0.45], [1.5, 0.225], [1.5, 0.15]],
    [[1.5, 0.15], [1.5, 0.075], [1.425, 0.0], [0.0, 0.0]],
];

/// The lid, from the middle of its knob outward: the distance from the axis, and the height.
const LID: &Curves<[f64; 2]> = &[
    [[0.0, 3.15], [0.8, 3.15], [0.0, 2.85], [0.2, 2.7]],
    [[0.2, 2.7], [0.4, 2.55], [1.3, 2.55], [1.3, 2.4]],
];

/// A quarter of the unit circle as Newell drew it, with 0.56 where 0.5523 would be nearer to the circle.
const ARC: [[f64; 2]; 4] = [[1.0, 0.0], [1.0, 0.56], [0.56, 1.0], [0.0, 1.0]];

/// A cross-section of handle or spout: x and height of one end in the plane of symmetry, x and height of the other end,
/// and half the width.
type Section = [f64; 5];

const HANDLE: &Curves<Section> = &[
    [
        [-1.6, 2.025, -1.5, 2.25, 0.3],
        [-2.3, 2.025, -2.5, 2.25, 0.3],
        [-2.7, 2.025, -3.0, 2.25, 0.3],
        [-2.7, 1.8, -3.0, 1.8, 0.3],
    ],
    [
        [-2.7, 1.8, -3.0, 1.8, 0.3],
        [-2.7, 1.575, -3.0, 1.35, 0.3],
        [-2.5, 1.125, -2.65, 0.9375, 0.3],
        [-2.0, 0.9, -1.9, 0.6, 0.3],
    ],
];

const SPOUT: &Curves<Section> = &[
    [
        [1.7, 1.425, 1.7, 0.6, 0.66],
        [2.6, 1.425, 3.1, 0.825, 0.66],
        [2.3, 2.1, 2.4, 2.025, 0.25],
        [2.7, 2.4, 3.3, 2.4, 0.25],
    ],
    [
        [2.7, 2.4, 3.3, 2.4, 0.25],
        [2.8, 2.475, 3.525, 2.49375, 0.25],
        [2.9, 2.475, 3.45, 2.5125, 0.15],
        [2.8, 2.4, 3.2, 2.4, 0.15],
    ],
];

/// The teapot. The divisions are those of the two sides of each patch.
pub(super) fn teapot([across, up]: [u32; 2]) -> Mesh {
    let mut mesh = Tessellation::default();
    for profile in [BODY, LID] {
        revolve(&mut mesh, profile, [across, up]);
    }
    for sections in [HANDLE, SPOUT] {
        tube(&mut mesh, sections, [across, up]);
    }
    mesh.finish()
}

/// Adds a profile, given from its upper or inner end, swept along four quarter arcs.
fn revolve(mesh: &mut Tessellation, profile: &Curves<[f64; 2]>, [across, up]: [u32; 2]) {
    let steps = up * curve_count(profile);
    mesh.surface([4 * across, steps], |j, i| {
        // The surface runs up, the profile runs down.
        let ([radius, height], [radius_change, height_change]) = follow(profile, steps - i, up);
        let (quarter, along) = (j / across % 4, j % across);
        let (arc, arc_change) = bezier(&ARC, fraction(along, across));
        let (arc, arc_change) = (quarter_turns(arc, quarter), quarter_turns(arc_change, quarter));
        // The normal is the cross product of the tangents (R'·A, Z') and R·(A', 0). R is left out, so that poles have
        // a normal, too.
        let sideways = -height_change * DVec2::new(arc_change.y, -arc_change.x);
        let upward = radius_change * arc.perp_dot(arc_change);
        Vertex {
            position: upright((radius * arc).extend(height)),
            normal: upright(sideways.extend(upward)),
        }
    });
}

/// Adds handle or spout along its cross-sections: a left and a right half, which meet in the plane of symmetry.
fn tube(mesh: &mut Tessellation, sections: &Curves<Section>, [across, up]: [u32; 2]) {
    let steps = up * curve_count(sections);
    mesh.surface([2 * across, steps], |j, i| {
        let (half, along) = (j / across % 2, fraction(j % across, across));
        let (section, change) = follow(sections, i, up);
        // Each half runs from one end in the plane of symmetry to the other.
        let corners = |[x0, z0, x1, z1, width]: Section| {
            let points = [[x0, 0.0, z0], [x0, width, z0], [x1, width, z1], [x1, 0.0, z1]];
            let side = if half == 0 { 1.0 } else { -1.0 };
            let sided = points.map(|[x, y, z]| [x, side * y, z]);
            if half == 0 { sided } else { [sided[3], sided[2], sided[1], sided[0]] }
        };
        let (position, around) = bezier(&corners(section), along);
        let (along_tube, _) = bezier(&corners(change), along);
        let [position, around, along_tube] = [position, around, along_tube].map(DVec3::from);
        Vertex { position: upright(position), normal: upright(around.cross(along_tube)) }
    });
}

/// The number of curves.
fn curve_count<T>(curves: &Curves<T>) -> u32 {
    u32::try_from(curves.len()).expect("there are a few")
}

/// The point and the tangent at a step of consecutive curves, with `count` steps on each curve.
fn follow<const N: usize>(
    curves: &Curves<[f64; N]>,
    step: u32,
    count: u32,
) -> ([f64; N], [f64; N]) {
    let curve = (step / count).min(curve_count(curves) - 1);
    bezier(&curves[curve as usize], fraction(step - curve * count, count))
}

/// The point and the tangent of a cubic Bézier curve at `s` in 0 … 1, by Bernstein polynomials.
fn bezier<const N: usize>(points: &[[f64; N]; 4], s: f64) -> ([f64; N], [f64; N]) {
    let r = 1.0 - s;
    let weights = [r * r * r, 3.0 * r * r * s, 3.0 * r * s * s, s * s * s];
    let slopes = [-3.0 * r * r, 3.0 * r * (r - 2.0 * s), 3.0 * s * (2.0 * r - s), 3.0 * s * s];
    let sum = |factors: [f64; 4]| {
        std::array::from_fn(|axis| (0..4).map(|k| factors[k] * points[k][axis]).sum::<f64>())
    };
    (sum(weights), sum(slopes))
}

/// Turns a direction in the plane by a number of quarter turns.
fn quarter_turns(direction: [f64; 2], quarters: u32) -> DVec2 {
    (0..quarters).fold(DVec2::from(direction), |direction, _| direction.perp())
}

/// Turns Newell's axes, with z up, into ours, with y up.
fn upright(v: DVec3) -> DVec3 {
    DVec3::new(v.x, v.z, -v.y)
}

/// The parameter `step/count` of a curve.
fn fraction(step: u32, count: u32) -> f64 {
    f64::from(step) / f64::from(count)
}
