//! Where an object is put: scaled, then rotated, then translated, in `f64`, rounded to `f32` once.

use super::error::Problem;
use super::reader::{Item, Table};
use crate::mesh::Mesh;
use crate::scene::{Plane, Shape, Sphere, Triangle};
use glam::{DVec3, Vec3};
use std::ops::Range;

/// The keys of an object's table that belong here.
pub(super) const KEYS: [&str; 3] = ["scale", "rotate", "translate"];

/// The world's coordinates from an object's own.
#[derive(Clone, Debug)]
pub(super) struct Transform {
    scale: f64,
    rotation: Option<Rotation>,
    translation: DVec3,
    /// Where the file states it.
    span: Range<usize>,
}

/// A turn about an axis through the origin.
#[derive(Clone, Copy, Debug)]
struct Rotation {
    /// Of unit length.
    axis: DVec3,
    sine: f64,
    cosine: f64,
}

impl Transform {
    /// What an object's table states; `None` if nothing, so that its numbers stay as they are.
    pub(super) fn read(object: &Table) -> Result<Option<Transform>, Problem> {
        let Some(&first) = object.present(&KEYS).first() else { return Ok(None) };
        let scale = object.get("scale").map_or(Ok(1.0), |item| item.positive())?;
        let rotation = object.get("rotate").map(|item| Rotation::read(&item)).transpose()?;
        let translation = object.get("translate").map_or(Ok(Vec3::ZERO), |item| item.vector())?;
        Ok(Some(Transform {
            scale: f64::from(scale),
            rotation,
            translation: translation.as_dvec3(),
            span: object.place_of(first),
        }))
    }

    /// The shape, where it is put.
    ///
    /// # Errors
    ///
    /// A coordinate that `f32` cannot hold, or a sphere that becomes too small to have a radius.
    pub(super) fn apply(&self, shape: Shape) -> Result<Shape, Problem> {
        Ok(match shape {
            Shape::Triangle(Triangle { a, b, c }) => {
                Shape::Triangle(Triangle { a: self.put(a)?, b: self.put(b)?, c: self.put(c)? })
            }
            Shape::Sphere(Sphere { center, radius }) => {
                Shape::Sphere(Sphere { center: self.put(center)?, radius: self.stretch(radius)? })
            }
            Shape::Plane(Plane { point, normal }) => {
                Shape::Plane(Plane { point: self.put(point)?, normal: self.turn(normal) })
            }
            Shape::Mesh(mesh) => Shape::Mesh(self.put_mesh(mesh)?),
        })
    }

    fn put(&self, position: Vec3) -> Result<Vec3, Problem> {
        let place = self.place(position);
        if place.is_finite() {
            Ok(place)
        } else {
            Err(self.beyond(&format!("{:?}", position.to_array())))
        }
    }

    fn put_mesh(&self, mesh: Mesh) -> Result<Mesh, Problem> {
        let moved = mesh.map(|position| self.place(position), |normal| self.turn(normal));
        moved.map_err(|_| self.beyond("a vertex"))
    }

    fn beyond(&self, what: &str) -> Problem {
        let message = format!("this puts {what} where no f32 number reaches");
        Problem::new(self.span.clone(), message).help("stay between -3.4e38 and 3.4e38")
    }

    fn place(&self, position: Vec3) -> Vec3 {
        let scaled = position.as_dvec3() * self.scale;
        let turned = self.rotation.map_or(scaled, |rotation| rotation.turn(scaled));
        (turned + self.translation).as_vec3()
    }

    /// A direction, turned. Its length may become half of what it was, so that it always fits.
    fn turn(&self, direction: Vec3) -> Vec3 {
        let Some(rotation) = self.rotation else { return direction };
        let turned = rotation.turn(direction.as_dvec3());
        let rounded = turned.as_vec3();
        if rounded.is_finite() { rounded } else { (0.5 * turned).as_vec3() }
    }

    fn stretch(&self, radius: f32) -> Result<f32, Problem> {
        #[expect(clippy::cast_possible_truncation, reason = "this is the one rounding")]
        let stretched = (f64::from(radius) * self.scale) as f32;
        if stretched > 0.0 && stretched.is_finite() {
            return Ok(stretched);
        }
        let message = format!("this makes the radius {stretched}");
        Err(Problem::new(self.span.clone(), message).help("choose another scale"))
    }
}

impl Rotation {
    fn read(item: &Item) -> Result<Rotation, Problem> {
        const EXAMPLE: &str = "rotate = { axis = [0, 1, 0], degrees = 30 }";
        let table = item.table(&["axis", "degrees"])?;
        let axis = table.need("axis", EXAMPLE)?.direction()?.as_dvec3();
        let [sine, cosine] = sine_and_cosine(table.need("degrees", EXAMPLE)?.number()?);
        Ok(Rotation { axis: axis / axis.length(), sine, cosine })
    }

    /// Counter-clockwise for whom the axis points at.
    ///
    /// The formula of Rodrigues (1840).
    fn turn(&self, vector: DVec3) -> DVec3 {
        let Rotation { axis, sine, cosine } = *self;
        let along = axis * axis.dot(vector) * (1.0 - cosine);
        vector * cosine + axis.cross(vector) * sine + along
    }
}

/// Exact for quarter turns, and the same on every machine.
fn sine_and_cosine(degrees: f32) -> [f64; 2] {
    let degrees = f64::from(degrees).rem_euclid(360.0);
    let rest = (degrees % 90.0).to_radians();
    let (sine, cosine) = (libm::sin(rest), libm::cos(rest));
    match degrees {
        0.0..90.0 => [sine, cosine],
        90.0..180.0 => [cosine, -sine],
        180.0..270.0 => [-sine, -cosine],
        270.0..360.0 => [-cosine, sine],
        // A tiny negative angle rounds to a whole turn.
        _ => [0.0, 1.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rotation(axis: DVec3, degrees: f32) -> Rotation {
        let [sine, cosine] = sine_and_cosine(degrees);
        Rotation { axis, sine, cosine }
    }

    fn transform(scale: f64, rotation: Option<Rotation>, translation: DVec3) -> Transform {
        Transform { scale, rotation, translation, span: 0..0 }
    }

    #[test]
    fn quarter_turns_are_exact() {
        let about_y = |degrees| rotation(DVec3::Y, degrees).turn(DVec3::X);
        assert_eq!(about_y(90.0), DVec3::NEG_Z);
        assert_eq!(about_y(180.0), DVec3::NEG_X);
        assert_eq!(about_y(-90.0), DVec3::Z);
        assert_eq!(about_y(720.0), DVec3::X);
        assert_eq!(about_y(-1e-30), DVec3::X);
    }

    #[test]
    fn a_third_of_a_turn_about_the_diagonal_swaps_the_axes() {
        let turned = rotation(DVec3::ONE.normalize(), 120.0).turn(DVec3::X);
        assert!((turned - DVec3::Y).length() < 1e-15, "{turned}");
    }

    #[test]
    fn objects_are_scaled_then_turned_then_moved() {
        // (1, 0, 0) · 2 = (2, 0, 0); a quarter turn about z makes it (0, 2, 0); + (5, 0, 0).
        let put = transform(2.0, Some(rotation(DVec3::Z, 90.0)), DVec3::new(5.0, 0.0, 0.0));
        assert_eq!(put.place(Vec3::X), Vec3::new(5.0, 2.0, 0.0));
        assert_eq!(put.turn(Vec3::X), Vec3::Y);
    }

    #[test]
    fn numbers_are_rounded_once() {
        // 3·(1 + 2^-23) needs 25 bits: rounding before the translation would give another number.
        let [x, less] = [1.0 + f32::EPSILON, -3.0];
        let put = transform(3.0, None, DVec3::new(f64::from(less), 0.0, 0.0));
        assert_eq!(put.place(Vec3::new(x, 0.0, 0.0)).x, 3.0 * f32::EPSILON);
        assert_ne!(3.0 * x + less, 3.0 * f32::EPSILON);
    }

    #[test]
    fn a_huge_normal_still_fits_when_it_is_turned() {
        let put = transform(1.0, Some(rotation(DVec3::Z, 45.0)), DVec3::ZERO);
        let turned = put.turn(Vec3::new(f32::MAX, f32::MAX, 0.0));
        assert!(turned.is_finite() && turned.y > 0.0 && turned.x.abs() < 1e-6 * turned.y);
    }
}
