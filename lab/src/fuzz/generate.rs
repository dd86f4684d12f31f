//! Random hostile scenes: close calls on purpose.
//!
//! A scene has one [`Style`] of numbers. Where numbers have few bits, corners and edges lie exactly on samples, faces are
//! coplanar, distances equal. Objects are placed as the camera sees them ([`Stage`]), so that most of them are in the
//! picture; some are not, or reach behind the eye.

mod camera;
mod instances;
mod meshes;
mod shapes;
mod stage;
mod style;

use super::case::Case;
use super::dice::Dice;
use crate::common::glam::Vec3;
use crate::common::{Camera, Crop, Shape};
use stage::Stage;
use style::{Scale, Style};

/// Scene number `scene` of a seed: always the same, and always accepted.
///
/// ```
/// let case = bothways_lab::fuzz::generate(7, 123);
/// assert!(case.accepted().is_some());
/// assert_eq!(case, bothways_lab::fuzz::generate(7, 123));
/// ```
pub fn generate(seed: u64, scene: u64) -> Case {
    generate_with(&mut Dice::new(seed, scene))
}

pub(super) fn generate_with(dice: &mut Dice) -> Case {
    let scale = dice.weighted(&[
        (40, Scale::Tiny),
        (35, Scale::Small),
        (15, Scale::Medium),
        (10, Scale::Large),
    ]);
    let style = dice.weighted(&[
        (40, Style::Lattice),
        (15, Style::NearLattice),
        (25, Style::Free),
        // There exact arithmetic decides nearly everything, which takes its time.
        (if scale.is_large() { 0 } else { 20 }, Style::Extreme),
    ]);
    let samples = dice.weighted(&[(12, 1), (2, 2), (1, 3), (1, 4)]);
    let samples = if scale == Scale::Large && !dice.once_in(4) { 1 } else { samples };
    let (description, camera) = loop {
        let description = camera::description(dice, style, scale);
        // Few of them are refused, such as those that look along their up.
        if let Ok(camera) = Camera::new(description) {
            break (description, camera);
        }
    };
    let mut stage = Stage::new(dice, &camera, style, samples, scale);
    let shapes = shapes(&mut stage, scale);
    let crop = stage.dice.once_in(10).then(|| crop(stage.dice, description.image));
    let mut case = Case { shapes, camera: description, samples, crop };
    if let Some(area) = drawable_area(&case, &camera) {
        case.crop = Some(part_of(stage.dice, case.pixels(), area));
    }
    debug_assert!(case.accepted().is_some(), "{case:?}");
    case
}

/// Triangles of a mesh that may be there several times.
const MOST_IN_INSTANCE: usize = 2000;

/// The objects of a scene, some of them nearly the same as earlier ones.
fn shapes(stage: &mut Stage, scale: Scale) -> Vec<Shape> {
    let most = match scale {
        Scale::Tiny => 6,
        Scale::Small => 10,
        Scale::Medium | Scale::Large => 8,
    };
    let count = 1 + stage.dice.below(most);
    let mut shapes: Vec<Shape> = Vec::new();
    while shapes.len() < count {
        if !shapes.is_empty() && stage.dice.once_in(5) {
            let earlier = shapes[stage.dice.below(shapes.len())].clone();
            shapes.push(shapes::near_copy(stage, earlier));
            continue;
        }
        match stage.dice.weighted(&[(6, 0), (1, 1), (1, 2), (3, 3)]) {
            0 => shapes.extend(shapes::triangles(stage)),
            1 => shapes.extend(shapes::spheres(stage)),
            2 => shapes.push(shapes::plane(stage)),
            _ => {
                let mesh = meshes::mesh(stage, scale);
                let is_small = mesh.triangles().len() <= MOST_IN_INSTANCE;
                shapes.push(if is_small && stage.dice.once_in(3) {
                    instances::instances(stage, mesh)
                } else {
                    Shape::Mesh(mesh)
                });
            }
        }
    }
    shapes
}

/// The tests of triangles that reach behind the eye for which there is time: image order tests each at every sample near
/// it, one after the other.
const TESTS_BEHIND: u64 = 300_000_000;

/// The number of pixels that can be drawn within seconds, if these are not all.
fn drawable_area(case: &Case, camera: &Camera) -> Option<u64> {
    let depth = |point: Vec3| -(point.as_dvec3() - camera.eye().as_dvec3()).dot(camera.w());
    let reaches_behind = |corners: &[Vec3; 3]| {
        corners.iter().any(|corner| depth(*corner) <= 0.0)
            && corners.iter().any(|corner| depth(*corner) > 0.0)
    };
    let count = |shape: &Shape| match shape {
        Shape::Mesh(mesh) => {
            let all = (0..mesh.triangles().len()).map(|triangle| mesh.corners(triangle));
            all.filter(reaches_behind).count() as u64
        }
        Shape::Instances(instances) => {
            let all = (0..instances.primitive_count()).map(|local| instances.corners(local));
            all.filter(reaches_behind).count() as u64
        }
        Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => 1,
    };
    let behind: u64 = case.shapes.iter().map(count).sum();
    let a_pixel = behind * u64::from(case.samples).pow(2);
    let pixels = case.pixels();
    let all = u64::from(pixels.height) * u64::from(pixels.width);
    (a_pixel.saturating_mul(all) > TESTS_BEHIND).then(|| (TESTS_BEHIND / a_pixel).max(1))
}

/// A rectangle of about this many pixels, anywhere in another one.
fn part_of(dice: &mut Dice, all: Crop, area: u64) -> Crop {
    let side = u32::try_from(area.isqrt()).expect("less than all pixels").max(1);
    let height = side.min(all.height);
    let width = u32::try_from(area / u64::from(height)).expect("less than all pixels");
    let width = width.clamp(1, all.width);
    let mut first = |from: u32, free: u32| {
        from + u32::try_from(dice.below(free as usize + 1)).expect("it is within the image")
    };
    let (row, column) = (first(all.row, all.height - height), first(all.column, all.width - width));
    Crop { row, column, height, width }
}

/// Any part of an image.
fn crop(dice: &mut Dice, [width, height]: [u32; 2]) -> Crop {
    let mut part = |length: u32| {
        let size = dice.size(1..=length);
        let first = dice.below((length - size) as usize + 1);
        [u32::try_from(first).expect("it is within the image"), size]
    };
    let ([column, width], [row, height]) = (part(width), part(height));
    Crop { row, column, height, width }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::Projection;
    use std::collections::HashSet;

    #[test]
    fn scenes_of_a_seed_are_accepted_and_of_all_kinds() {
        let mut kinds = HashSet::new();
        let mut largest = 0;
        for scene in 0..400 {
            let case = generate(3, scene);
            assert!(case.accepted().is_some(), "scene {scene}: {case:?}");
            let pixels = case.pixels();
            largest = largest.max(pixels.width * pixels.height);
            kinds.insert(match case.camera.projection {
                Projection::Perspective => "perspective",
                Projection::Parallel => "parallel",
            });
            kinds.insert(if case.crop.is_some() { "crop" } else { "no crop" });
            kinds.insert(if case.samples == 1 { "one sample" } else { "several samples" });
            kinds.extend(case.shapes.iter().map(|shape| match shape {
                Shape::Triangle(_) => "triangle",
                Shape::Sphere(_) => "sphere",
                Shape::Plane(_) => "plane",
                Shape::Mesh(mesh) if mesh.triangles().len() > 5000 => "large mesh",
                Shape::Mesh(_) => "mesh",
                Shape::Instances(_) => "instances",
            }));
        }
        assert_eq!(kinds.len(), 12, "{kinds:?}");
        assert!(largest > 500_000, "{largest}");
    }
}
