//! What the camera sees, as a place to put things: points by their position in the picture and their depth.

use super::camera::exp2;
use super::style::{Scale, Style};
use crate::common::glam::{DVec3, Vec3};
use crate::common::{Camera, Projection};
use crate::fuzz::dice::Dice;

/// The place where objects are put before a camera, and the choices for them.
#[derive(Debug)]
pub(super) struct Stage<'a> {
    pub(super) dice: &'a mut Dice,
    pub(super) camera: &'a Camera,
    pub(super) style: Style,
    /// Fractions of a pixel in which a lattice counts: 2 for half pixels.
    steps: f64,
    /// Whether corners may lie on the eye.
    has_corners_on_eye: bool,
    /// The depths at which most of a lattice's faces lie.
    depths: [f64; 3],
}

/// A place in the picture: row and column in pixels from the top left corner, and the depth along the view.
#[derive(Clone, Copy, Debug)]
pub(super) struct PicturePoint {
    pub(super) row: f64,
    pub(super) column: f64,
    pub(super) depth: f64,
}

impl<'a> Stage<'a> {
    /// The stage of a camera for one scene.
    pub(super) fn new(
        dice: &'a mut Dice,
        camera: &'a Camera,
        style: Style,
        samples: u32,
        scale: Scale,
    ) -> Stage<'a> {
        // Samples lie on odd multiples of half their spacing.
        let steps = dice.one_of(&[2.0, 2.0, 4.0, 1.0]) * f64::from(samples);
        let distance = camera.distance();
        let depth = |dice: &mut Dice| distance * f64::from(exp2(dice.within(-1..=5)));
        let depths = [distance, depth(dice), depth(dice)];
        Stage { dice, camera, style, steps, has_corners_on_eye: !scale.is_large(), depths }
    }

    /// The width and the height of the image in pixels.
    fn image(&self) -> [f64; 2] {
        self.camera.image().map(f64::from)
    }

    /// Whether numbers have few bits.
    pub(super) fn is_lattice(&self) -> bool {
        matches!(self.style, Style::Lattice | Style::NearLattice)
    }

    /// A depth; on a lattice one of few.
    pub(super) fn depth(&mut self) -> f64 {
        if self.is_lattice() {
            return self.dice.one_of(&self.depths);
        }
        let exponents = if self.style == Style::Extreme { 20.0 } else { 4.0 };
        self.camera.distance() * self.dice.real(-1.0, exponents).exp2()
    }

    /// A number of pixels that belongs to the scene's style: on a lattice a multiple of its step.
    pub(super) fn pixels(&mut self, low: f64, high: f64) -> f64 {
        let number = self.dice.real(low, high);
        if self.is_lattice() { (number * self.steps).round() / self.steps } else { number }
    }

    /// A place in the picture or a little beside it.
    pub(super) fn place(&mut self) -> PicturePoint {
        let [width, height] = self.image();
        let (row, column) =
            (self.pixels(-0.25 * height, 1.25 * height), self.pixels(-0.25 * width, 1.25 * width));
        PicturePoint { row, column, depth: self.depth() }
    }

    /// A length in pixels, from a part of one to the whole picture.
    pub(super) fn length(&mut self) -> f64 {
        let [width, height] = self.image();
        let length = self.dice.real(-2.0, width.max(height).log2() + 1.0).exp2();
        let length = self.pixels(length, 1.5 * length);
        if length == 0.0 { 1.0 / self.steps } else { length }
    }

    /// The size of a pixel in the world, at a depth: its height and its width.
    pub(super) fn pixel_size(&self, depth: f64) -> [f64; 2] {
        let ([width, height], [vw, vh]) = (self.image(), self.camera.viewport());
        let scale = match self.camera.projection() {
            Projection::Perspective => depth / self.camera.distance(),
            Projection::Parallel => 1.0,
        };
        [vh / height * scale, vw / width * scale]
    }

    /// The point of the world that is seen at a place. For a camera along the axes and a place of few bits it is exact.
    pub(super) fn at(&self, place: PicturePoint) -> Vec3 {
        let [width, height] = self.image();
        let [high, wide] = self.pixel_size(place.depth);
        let x = (place.column - 0.5 * width) * wide;
        let y = (0.5 * height - place.row) * high;
        let (u, v, w) = (self.camera.u(), self.camera.v(), self.camera.w());
        stored(self.camera.eye().as_dvec3() + x * u + y * v - place.depth * w)
    }

    /// A point anywhere: mostly in sight, sometimes behind the eye, on it, or of extreme numbers.
    pub(super) fn point(&mut self) -> Vec3 {
        let place = self.place();
        if self.style == Style::Extreme && self.dice.once_in(2) {
            return Vec3::new(self.extreme(), self.extreme(), self.extreme());
        }
        let point = match self.dice.below(40) {
            0 if self.has_corners_on_eye => self.camera.eye(),
            // Behind, mirrored in the eye for a perspective camera.
            1 | 2 => self.at(PicturePoint { depth: -place.depth, ..place }),
            3 if self.has_corners_on_eye => self.at(PicturePoint { depth: 0.0, ..place }),
            _ => self.at(place),
        };
        self.nudged(point)
    }

    /// The point, in a near lattice perhaps with a coordinate one bit off.
    pub(super) fn nudged(&mut self, mut point: Vec3) -> Vec3 {
        if self.style == Style::NearLattice && self.dice.once_in(3) {
            let axis = self.dice.below(3);
            let moved = if self.dice.once_in(2) { f32::next_up } else { f32::next_down };
            point[axis] = moved(point[axis]);
        }
        tame(point)
    }

    /// A number of any size.
    pub(super) fn extreme(&mut self) -> f32 {
        let few = self.dice.within(-16..=16) as f32;
        let number = match self.dice.below(6) {
            0 => few,
            1 => self.dice.single(-4.0, 4.0),
            2 => exp2(self.dice.within(-149..=127)).copysign(few),
            // Numbers of few bits and of sizes at which error bounds overflow or vanish.
            3 => {
                let size = self.dice.one_of(&[-140, -126, -100, -64, 50, 64, 85, 100, 116]);
                few * exp2(size + self.dice.within(-6..=6))
            }
            4 => 0.0,
            _ => f32::from_bits(self.dice.bits()),
        };
        if number.is_finite() { number } else { 0.0 }
    }
}

/// The point as `f32`, or the origin where that is not finite.
#[expect(clippy::cast_possible_truncation, reason = "scenes are stored as f32")]
pub(super) fn stored(point: DVec3) -> Vec3 {
    tame(Vec3::new(point.x as f32, point.y as f32, point.z as f32))
}

/// The point, or the origin where it is not finite.
pub(super) fn tame(point: Vec3) -> Vec3 {
    if point.is_finite() { point } else { Vec3::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::CameraDescription;

    #[test]
    fn places_are_where_the_camera_sees_them() {
        for projection in [Projection::Perspective, Projection::Parallel] {
            let description = CameraDescription {
                projection,
                eye: Vec3::new(1.0, 2.0, 3.0),
                distance: 2.0,
                viewport: [8.0, 4.0],
                image: [8, 8],
                ..CameraDescription::default()
            };
            let camera = Camera::new(description).unwrap();
            let mut dice = Dice::new(0, 0);
            let stage = Stage::new(&mut dice, &camera, Style::Lattice, 1, Scale::Tiny);
            let point = stage.at(PicturePoint { row: 5.5, column: 2.5, depth: 6.0 });
            // The centre of pixel (5, 2), three times as far as the viewport.
            let ray = camera.viewing_ray(5, 2);
            let expected = match projection {
                Projection::Perspective => 3.0 * ray.direction,
                Projection::Parallel => ray.origin + 6.0 * ray.direction,
            };
            assert_eq!(point.as_dvec3() - camera.eye().as_dvec3(), expected, "{projection:?}");
        }
    }
}
