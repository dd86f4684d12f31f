//! Simpler numbers: fewer bits, and closer to 1.

use super::shrinker::Shrinker;
use crate::common::camera::Orientation;
use crate::common::glam::Vec3;
use crate::common::{Instances, Mesh, Placement, Plane, Shape, Sphere, Triangle};
use crate::fuzz::case::Case;
use std::collections::BTreeSet;

/// Numbers that are tried in the place of any other, the simplest first.
const SIMPLE: [f32; 7] = [0.0, 1.0, -1.0, 2.0, -2.0, 0.5, -0.5];
/// Significant bits that are tried, the fewest first.
const BITS: [u32; 7] = [1, 2, 3, 5, 8, 12, 17];

/// Makes numbers simpler: at first all equal ones together, which keeps shared corners and planes; then each alone.
pub(super) fn shrink(shrinker: &mut Shrinker) {
    let all: BTreeSet<u32> = numbers(&shrinker.case).into_iter().map(f32::to_bits).collect();
    for number in all.into_iter().map(f32::from_bits) {
        simplify(shrinker, number, |case, simpler| {
            change(case, |_, own| if own.to_bits() == number.to_bits() { simpler } else { own })
        });
    }
    for index in 0..numbers(&shrinker.case).len() {
        let Some(&number) = numbers(&shrinker.case).get(index) else { break };
        simplify(shrinker, number, |case, simpler| {
            change(case, |place, own| if place == index { simpler } else { own })
        });
    }
}

/// Tries simpler numbers in the place of one, by a function that makes the case with another number.
fn simplify(shrinker: &mut Shrinker, number: f32, with: impl Fn(&Case, f32) -> Option<Case>) {
    let rounded = BITS.into_iter().flat_map(|bits| {
        let down = truncated(number, bits);
        // One more in the last of these bits.
        [down, down + (down - truncated(down, bits.saturating_sub(1)))]
    });
    let halves = [64, 8, 1].into_iter().flat_map(|exponent| {
        let factor = (exponent as f32).exp2();
        [number * factor, number / factor]
    });
    let candidates = SIMPLE.into_iter().chain(rounded.chain(halves));
    for candidate in candidates.filter(|candidate| candidate.is_finite()) {
        let is_simpler = complexity(candidate) < complexity(number);
        if is_simpler && shrinker.try_change(|case| with(case, candidate)) {
            return;
        }
    }
}

/// What makes a number hard to read: its significant bits, how far it is from 1, and its sign.
fn complexity(number: f32) -> (u32, u32, bool) {
    if number == 0.0 {
        return (0, 0, number.is_sign_negative());
    }
    let number = f64::from(number);
    let significand = number.to_bits() << 12;
    let exponent = ((number.to_bits() >> 52) & 0x7ff).abs_diff(1023);
    let exponent = u32::try_from(exponent).expect("it has eleven bits");
    (1 + 64 - significand.trailing_zeros(), exponent, number < 0.0)
}

/// A number cut to its first significant bits, towards zero.
fn truncated(number: f32, bits: u32) -> f32 {
    let cut = 53_u32.saturating_sub(bits.max(1));
    let number = f64::from(number).to_bits() >> cut << cut;
    #[expect(clippy::cast_possible_truncation, reason = "it has fewer bits than an f32 had")]
    let number = f64::from_bits(number) as f32;
    number
}

/// All numbers of a case.
fn numbers(case: &Case) -> Vec<f32> {
    let mut numbers = Vec::new();
    // The copy is of no use.
    let _ = change(case, |_, number| {
        numbers.push(number);
        number
    });
    numbers
}

/// The case with each of its numbers replaced, given its place among them; `None` if a mesh refuses them.
fn change(case: &Case, mut number: impl FnMut(usize, f32) -> f32) -> Option<Case> {
    let mut place = 0;
    let mut one = |old: f32| {
        let new = number(place, old);
        place += 1;
        new
    };
    let mut vector = |v: Vec3| Vec3::from_array(v.to_array().map(&mut one));
    let mut shapes = Vec::with_capacity(case.shapes.len());
    for shape in &case.shapes {
        shapes.push(match shape {
            Shape::Triangle(Triangle { a, b, c }) => {
                Shape::Triangle(Triangle { a: vector(*a), b: vector(*b), c: vector(*c) })
            }
            Shape::Sphere(Sphere { center, radius }) => {
                // Three numbers, of which one counts.
                let radius = vector(Vec3::splat(*radius)).x;
                Shape::Sphere(Sphere { center: vector(*center), radius })
            }
            Shape::Plane(Plane { point, normal }) => {
                Shape::Plane(Plane { point: vector(*point), normal: vector(*normal) })
            }
            Shape::Mesh(mesh) => {
                let positions = mesh.positions().iter().map(|p| vector(*p)).collect();
                Shape::Mesh(Mesh::new(positions, mesh.triangles().to_vec()).ok()?)
            }
            Shape::Instances(instances) => {
                let mesh = instances.mesh();
                let positions = mesh.positions().iter().map(|p| vector(*p)).collect();
                let mesh = Mesh::new(positions, mesh.triangles().to_vec()).ok()?;
                // Twelve numbers, three at a time.
                let placed = instances.placements().iter().map(|placement| {
                    let mut rows = *placement.rows();
                    for three in rows.as_flattened_mut().chunks_exact_mut(3) {
                        three.copy_from_slice(&vector(Vec3::from_slice(three)).to_array());
                    }
                    Placement::from_rows(rows)
                });
                Shape::Instances(Instances::new(mesh, placed.collect()).ok()?)
            }
        });
    }
    let mut camera = case.camera;
    camera.eye = vector(camera.eye);
    camera.orientation = match camera.orientation {
        Orientation::LookAt { target, up } => {
            Orientation::LookAt { target: vector(target), up: vector(up) }
        }
        Orientation::Direction { direction, up } => {
            Orientation::Direction { direction: vector(direction), up: vector(up) }
        }
        // A frame must stay perpendicular: its numbers change only all at once.
        frame @ Orientation::Frame { .. } => frame,
    };
    camera.distance = one(camera.distance);
    camera.viewport = camera.viewport.map(one);
    Some(Case { shapes, camera, ..case.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fewer_bits_are_simpler_and_then_a_size_near_one() {
        let ordered = [0.0, 1.0, -1.0, 2.0, 0.25, 1e-45, 1.5, 3.0, 1.25, 0.3, -0.3];
        for pair in ordered.windows(2) {
            assert!(complexity(pair[0]) < complexity(pair[1]), "{pair:?}");
        }
    }

    #[test]
    fn numbers_are_cut_to_their_first_bits() {
        assert_eq!(truncated(7.9, 1), 4.0);
        assert_eq!(truncated(-7.9, 2), -6.0);
        assert_eq!(truncated(0.3, 24), 0.3);
        assert_eq!(truncated(1e-45, 1), 1e-45);
    }
}
