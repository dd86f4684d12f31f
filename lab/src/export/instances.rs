//! The instances of a mesh in programs that know some: the mesh once, and each place.

use super::target::Target;
use crate::common::glam::DVec3;
use crate::common::{Instances, Mesh, Placement};

/// The largest cosine of the angle between two axes that counts as a right angle: rounded to `f32`, rotations have less
/// than a fifth of it.
const SKEWED: f64 = 1e-6;

/// The largest volume between the axes, for axes of unit length, that counts as none.
const FLAT: f64 = 1e-4;

/// An instance as a program has it.
pub(super) enum Place<'a> {
    /// The mesh, placed.
    Shared(&'a Placement),
    /// A mesh of its own, since the program cannot say its place.
    Copied(Box<Mesh>),
}

/// The instances, in their order; those that the program cannot place are copied one at a time.
pub(super) fn places(target: Target, instances: &Instances) -> impl Iterator<Item = Place<'_>> {
    instances.placements().iter().enumerate().map(move |(instance, placement)| {
        if is_copied(target, placement) {
            Place::Copied(Box::new(instances.copied(instance)))
        } else {
            Place::Shared(placement)
        }
    })
}

/// How many instances the program cannot place.
pub(super) fn copies(target: Target, instances: &Instances) -> usize {
    instances.placements().iter().filter(|placement| is_copied(target, placement)).count()
}

/// Whether the program has instances.
pub(super) fn has_some(target: Target) -> bool {
    match target {
        Target::Gltf | Target::Pbrt | Target::Mitsuba => true,
        Target::Obj | Target::Ply => false,
    }
}

/// What an instance is like that the target cannot place.
pub(super) fn refused(target: Target) -> &'static str {
    match target {
        Target::Gltf => "skewed or flat",
        Target::Pbrt | Target::Mitsuba | Target::Obj | Target::Ply => "flat",
    }
}

fn is_copied(target: Target, placement: &Placement) -> bool {
    match target {
        Target::Gltf => is_skewed(placement),
        Target::Pbrt | Target::Mitsuba => is_flat(placement),
        Target::Obj | Target::Ply => true,
    }
}

/// Whether a map has no inverse, which ray tracers carry rays to the mesh by, or one that is far off in their `f32`.
fn is_flat(placement: &Placement) -> bool {
    let [x, y, z] = columns(placement);
    let volume = x.dot(y.cross(z)).abs();
    volume <= FLAT * x.length() * y.length() * z.length()
}

/// Whether a map is not a scale, then a rotation, then a translation: no other matrix is allowed in glTF ("glTF 2.0
/// Specification", 3.5.3), and programs would draw another one. Its axes are not at right angles, or one has no length.
fn is_skewed(placement: &Placement) -> bool {
    let [x, y, z] = columns(placement);
    let is_square = |a: DVec3, b: DVec3| a.dot(b).abs() <= SKEWED * a.length() * b.length();
    let has_length = [x, y, z].iter().all(|axis| *axis != DVec3::ZERO);
    !(has_length && is_square(x, y) && is_square(y, z) && is_square(z, x))
}

/// Where the axes of the mesh go.
pub(super) fn columns(placement: &Placement) -> [DVec3; 3] {
    let [x, y, z] = placement.rows();
    [0, 1, 2].map(|axis| DVec3::new(x[axis].into(), y[axis].into(), z[axis].into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::glam::{DAffine3, DMat3};

    #[test]
    fn rotations_and_mirrors_are_placed_and_skewed_ones_are_not() {
        let turned = |k: u32| {
            let axis = DVec3::new(f64::from(k % 7) - 3.0, f64::from(k % 5) - 1.9, 0.3);
            let scale = DVec3::new(1e-3 + f64::from(k % 3), -2.0, f64::from(k % 11) + 0.1);
            DMat3::from_axis_angle(axis.normalize(), f64::from(k)) * DMat3::from_diagonal(scale)
        };
        let placement = |matrix3| {
            Placement::from_affine(&DAffine3 { matrix3, translation: DVec3::new(1e6, 0.1, -7.0) })
        };
        assert!((0..1000).all(|k| !is_skewed(&placement(turned(k)))));
        let skew = DMat3::from_cols(DVec3::X, DVec3::new(1e-4, 1.0, 0.0), DVec3::Z);
        assert!(is_skewed(&placement(turned(4) * skew)) && is_skewed(&placement(skew)));
        assert!(is_skewed(&placement(DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)))));
        assert!(!is_skewed(&Placement::IDENTITY));
        // Ray tracers take any map that has an inverse.
        let flat = DMat3::from_cols(DVec3::X, DVec3::new(2.0, 1e-5, 0.0), DVec3::Z);
        assert!(is_flat(&placement(turned(4) * flat)));
        assert!((0..1000).all(|k| !is_flat(&placement(turned(k) * skew))));
    }
}
