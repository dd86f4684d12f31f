//! Random cameras: along the world's axes, tilted by next to nothing, turned anyhow; pixels of all forms.

use super::style::{Scale, Style};
use crate::common::glam::{Quat, Vec3};
use crate::common::{CameraDescription, Orientation, Projection};
use crate::fuzz::dice::Dice;

/// A camera for a scene of this style; one in some hundred is refused.
pub(super) fn description(dice: &mut Dice, style: Style, scale: Scale) -> CameraDescription {
    let projection = dice.one_of(&[Projection::Perspective, Projection::Parallel]);
    let image = image(dice, scale);
    let (distance, viewport) = lens(dice, style, image);
    let orientation = orientation(dice, style);
    CameraDescription {
        projection,
        eye: eye(dice, style, scale),
        orientation,
        distance,
        viewport,
        image,
    }
}

/// The width and height of an image.
fn image(dice: &mut Dice, scale: Scale) -> [u32; 2] {
    let [width, height] = match scale {
        Scale::Tiny => [dice.size(1..=16), dice.size(1..=16)],
        Scale::Small => [dice.size(1..=64), dice.size(1..=64)],
        Scale::Medium => [dice.size(16..=300), dice.size(16..=300)],
        Scale::Large if dice.once_in(8) => [dice.size(2000..=9000), dice.size(30..=200)],
        Scale::Large => [dice.size(500..=2000), dice.size(500..=1200)],
    };
    if dice.once_in(4) { [height, width] } else { [width, height] }
}

fn eye(dice: &mut Dice, style: Style, scale: Scale) -> Vec3 {
    let few = |dice: &mut Dice| dice.within(-8..=8) as f32;
    match style {
        _ if dice.once_in(2) => Vec3::ZERO,
        // So far that a coordinate keeps few bits, or none.
        _ if !scale.is_large() && dice.once_in(10) => {
            let far = exp2(dice.within(8..=if style == Style::Extreme { 120 } else { 26 }));
            far * Vec3::new(few(dice), few(dice), few(dice))
        }
        Style::Lattice | Style::NearLattice => 0.5 * Vec3::new(few(dice), few(dice), few(dice)),
        Style::Free | Style::Extreme => {
            Vec3::new(dice.single(-4.0, 4.0), dice.single(-4.0, 4.0), few(dice))
        }
    }
}

fn orientation(dice: &mut Dice, style: Style) -> Orientation {
    let kinds = match style {
        Style::Lattice | Style::NearLattice => [(8, 0), (4, 1), (1, 2), (1, 3)],
        Style::Free | Style::Extreme => [(2, 0), (1, 1), (2, 2), (6, 3)],
    };
    match dice.weighted(&kinds) {
        0 => Orientation::Frame { u: Vec3::X, v: Vec3::Y, w: Vec3::Z },
        1 => {
            // Along the axes in any other way.
            let axes = [Vec3::X, Vec3::Y, Vec3::Z];
            let first = dice.below(3);
            let sign = |dice: &mut Dice| dice.one_of(&[1.0_f32, -1.0]);
            let u = sign(dice) * axes[first];
            let v = sign(dice) * axes[(first + 1 + dice.below(2)) % 3];
            Orientation::Frame { u, v, w: u.cross(v) }
        }
        2 => {
            // Tilted so little that rounded sums may lose it.
            let mut little = || dice.within(-3..=3) as f32 * exp2(dice.within(-100..=-12));
            let (w, roll) = (Vec3::new(little(), little(), 1.0), little());
            let (u, v) = (Vec3::new(1.0, roll, 0.0), Vec3::new(-roll, 1.0, 0.0));
            if dice.once_in(2) {
                Orientation::Frame { u, v, w }
            } else {
                Orientation::Direction { direction: -w, up: v }
            }
        }
        _ => {
            let turn = Quat::from_rotation_y(dice.single(0.0, 6.3))
                * Quat::from_rotation_x(dice.single(-1.5, 1.5))
                * Quat::from_rotation_z(dice.single(-3.0, 3.0));
            Orientation::Direction { direction: turn * Vec3::NEG_Z, up: turn * Vec3::Y }
        }
    }
}

/// The distance and the viewport.
fn lens(dice: &mut Dice, style: Style, image: [u32; 2]) -> (f32, [f32; 2]) {
    let [width, height] = image.map(|side| side as f32);
    if style == Style::Extreme && dice.once_in(3) {
        return dice.one_of(&[
            (exp2(-64), [exp2(-44), exp2(-60)]),
            (exp2(64), [exp2(-64), exp2(64)]),
            (1.0, [exp2(20), exp2(10)]),
            (exp2(30), [exp2(-30), exp2(-20)]),
        ]);
    }
    let is_aligned = matches!(style, Style::Lattice | Style::NearLattice);
    // The side of a pixel is a power of two, so that samples have few bits.
    let pixel = exp2(dice.within(-6..=0));
    let stretched = if dice.once_in(4) { exp2(dice.within(-3..=3)) } else { 1.0 };
    let distance = exp2(dice.within(-1..=4));
    if is_aligned && !dice.once_in(8) {
        return (distance, [width * pixel, height * pixel * stretched]);
    }
    // As people choose them: square pixels, seldom others.
    let side = dice.single(0.3, 3.0);
    (1.0, [side * width / height, side * stretched])
}

pub(super) fn exp2(exponent: i32) -> f32 {
    (exponent as f32).exp2()
}
