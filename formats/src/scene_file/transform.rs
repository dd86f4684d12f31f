//! The transformation of an object: scaled (by one factor, or by one for each axis), then rotated, then translated.
//!
//! All of it is computed in `f64`, and each coordinate is rounded once to `f32`.

use super::document::{Item, Table};
use super::error::Problem;
use bothways_common::scene::{Instances, Mesh, Placement, Plane, Shape, Sphere, Triangle};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use std::ops::Range;

/// The keys of the transformation in an object's table.
pub(super) const KEYS: [&str; 3] = ["scale", "rotate", "translate"];

/// A transformation from the coordinates of an object to those of the world.
#[derive(Clone, Debug)]
pub(super) struct Transform {
    scale: DVec3,
    rotation: Option<Rotation>,
    translation: DVec3,
    /// Where the file states the first part of it.
    span: Range<usize>,
    /// Where the file states the scale.
    scale_span: Range<usize>,
}

/// Reads one factor for all axes, or one for each axis. Negative factors mirror; zero would flatten.
fn factors(item: &Item) -> Result<DVec3, Problem> {
    if item.is_number() {
        // A number that is not finite is a problem of its own, which a mirror does not solve.
        item.number()?;
        let factor = item.positive().map_err(|problem| {
            problem.help("to mirror, give three factors, such as scale = [-1, 1, 1]")
        })?;
        return Ok(DVec3::splat(factor.into()));
    }
    let [x, y, z] = item.not_zero_triple()?;
    Ok(Vec3::new(x, y, z).as_dvec3())
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
    /// The transformation that an object's table states; `None` if it states none, so that no number changes.
    pub(super) fn read(object: &Table) -> Result<Option<Transform>, Problem> {
        let Some(&first) = object.present(&KEYS).first() else { return Ok(None) };
        let scale = object.get("scale").map_or(Ok(DVec3::ONE), |item| factors(&item))?;
        let rotation = object.get("rotate").map(|item| Rotation::read(&item)).transpose()?;
        let translation = object.get("translate").map_or(Ok(Vec3::ZERO), |item| item.vector())?;
        Ok(Some(Transform {
            scale,
            rotation,
            translation: translation.as_dvec3(),
            span: object.span_of(first),
            scale_span: object.get("scale").map_or(0..0, |item| item.span),
        }))
    }

    /// Transforms a shape.
    ///
    /// # Errors
    ///
    /// A coordinate is out of the range of `f32`, or a sphere gets a radius of 0 or becomes an ellipsoid.
    pub(super) fn apply(&self, shape: Shape) -> Result<Shape, Problem> {
        Ok(match shape {
            Shape::Triangle(Triangle { a, b, c }) => Shape::Triangle(Triangle {
                a: self.finite_position(a)?,
                b: self.finite_position(b)?,
                c: self.finite_position(c)?,
            }),
            Shape::Sphere(Sphere { center, radius }) => Shape::Sphere(Sphere {
                center: self.finite_position(center)?,
                radius: self.radius(radius)?,
            }),
            Shape::Plane(Plane { point, normal }) => Shape::Plane(Plane {
                point: self.finite_position(point)?,
                normal: self.plane_normal(normal)?,
            }),
            Shape::Mesh(mesh) => Shape::Mesh(self.mesh(mesh)?),
            Shape::Instances(instances) => Shape::Instances(self.instances(instances)?),
        })
    }

    /// The transformation as that of an instance.
    pub(super) fn placement(&self) -> Placement {
        Placement::from_affine(&self.affine())
    }

    fn affine(&self) -> DAffine3 {
        let column = |axis: DVec3| {
            let scaled = axis * self.scale;
            self.rotation.map_or(scaled, |rotation| rotation.rotate(scaled))
        };
        DAffine3 {
            matrix3: DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z)),
            translation: self.translation,
        }
    }

    fn finite_position(&self, position: Vec3) -> Result<Vec3, Problem> {
        let placed = self.position(position);
        if placed.is_finite() {
            Ok(placed)
        } else {
            Err(self.out_of_range(&format!("{:?}", position.to_array())))
        }
    }

    fn mesh(&self, mesh: Mesh) -> Result<Mesh, Problem> {
        let moved = mesh.map(|position| self.position(position), |normal| self.normal(normal));
        let moved = moved.map_err(|_| self.out_of_range("a vertex"))?;
        // A mirror makes counter-clockwise triangles clockwise. They are turned, so that the outside stays outside.
        let mirrors = self.scale.x * self.scale.y * self.scale.z < 0.0;
        Ok(if mirrors { moved.turned_inside_out() } else { moved })
    }

    /// Instances of a mesh, each moved. Of their maps there is one list at any time.
    fn instances(&self, instances: Instances) -> Result<Instances, Problem> {
        let own = self.affine();
        let moved = |placement: Placement| {
            let [x, y, z] = placement.rows().map(|row| row.map(f64::from));
            let rows = [x, y, z].map(|[x, y, z, _]| [x, y, z]);
            let matrix3 = DMat3::from_cols_array_2d(&rows).transpose();
            let translation = DVec3::new(x[3], y[3], z[3]);
            Placement::from_affine(&(own * DAffine3 { matrix3, translation }))
        };
        let (mesh, placements) = instances.into_parts();
        let placements = placements.into_iter().map(moved).collect();
        Instances::new(mesh, placements).map_err(|_| self.out_of_range("a vertex"))
    }

    fn out_of_range(&self, what: &str) -> Problem {
        let message = format!("this puts {what} where no f32 number reaches");
        Problem::new(self.span.clone(), message).help("stay between -3.4e38 and 3.4e38")
    }

    fn position(&self, position: Vec3) -> Vec3 {
        let scaled = position.as_dvec3() * self.scale;
        let turned = self.rotation.map_or(scaled, |rotation| rotation.rotate(scaled));
        (turned + self.translation).as_vec3()
    }

    /// Transforms a normal. Its length does not matter, and is chosen so that the result is in the range of `f32`.
    ///
    /// A normal is scaled by the reciprocals, so that it stays perpendicular: `n·v = (n/s)·(s·v)`.
    fn normal(&self, normal: Vec3) -> Vec3 {
        let scaled = if self.is_uniform() {
            normal.as_dvec3()
        } else {
            let scaled = normal.as_dvec3() / self.scale;
            // A power of two: the product is exact.
            let size = scaled.abs().max_element();
            if size > 0.0 { scaled * (-size.log2().floor()).exp2() } else { scaled }
        };
        let turned = self.rotation.map_or(scaled, |rotation| rotation.rotate(scaled));
        let rounded = turned.as_vec3();
        if rounded.is_finite() { rounded } else { (0.5 * turned).as_vec3() }
    }

    /// Transforms the normal of a plane, which must not become zero.
    fn plane_normal(&self, normal: Vec3) -> Result<Vec3, Problem> {
        match self.normal(normal) {
            Vec3::ZERO => Err(self.out_of_range("the plane's normal")),
            normal => Ok(normal),
        }
    }

    /// Tells whether the scale keeps the directions of normals.
    fn is_uniform(&self) -> bool {
        let DVec3 { x, y, z } = self.scale;
        x == y && y == z && x > 0.0
    }

    fn radius(&self, radius: f32) -> Result<f32, Problem> {
        let [factor, y, z] = self.scale.abs().to_array();
        if factor != y || factor != z {
            let message =
                "a sphere stays a sphere: its three factors must be equal, but for their signs";
            let help = "scale it by one number, or generate a mesh of the kind \"sphere\"";
            return Err(Problem::new(self.scale_span.clone(), message).help(help));
        }
        #[expect(clippy::cast_possible_truncation, reason = "this is the one rounding")]
        let stretched = (f64::from(radius) * factor) as f32;
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

    /// Rotates a vector: counter-clockwise as seen by a viewer that the axis points at.
    ///
    /// The formula of Rodrigues (1840).
    fn rotate(&self, vector: DVec3) -> DVec3 {
        let Rotation { axis, sine, cosine } = *self;
        let along = axis * axis.dot(vector) * (1.0 - cosine);
        vector * cosine + axis.cross(vector) * sine + along
    }
}

/// The sine and the cosine of an angle: exact for quarter turns, and the same on every machine.
pub(super) fn sine_and_cosine(degrees: f32) -> [f64; 2] {
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
        let scale = DVec3::splat(scale);
        Transform { scale, rotation, translation, span: 0..0, scale_span: 0..0 }
    }

    fn scaled(scale: [f64; 3]) -> Transform {
        Transform { scale: DVec3::from_array(scale), ..transform(1.0, None, DVec3::ZERO) }
    }

    #[test]
    fn normals_stay_perpendicular_under_any_scale() {
        let quarter = Some(rotation(DVec3::ONE.normalize(), 33.0));
        for scale in [[2.0, 3.0, 5.0], [-1.0, 1.0, 1.0], [1e-30, 4.0, 1e30], [-2.0, -3.0, -7.0]] {
            let placed = Transform { rotation: quarter, ..scaled(scale) };
            // The plane 2x + 3y − z = 0 and two directions in it.
            let normal = placed.normal(Vec3::new(2.0, 3.0, -1.0)).as_dvec3().normalize();
            for within in [Vec3::new(1.0, 0.0, 2.0), Vec3::new(0.0, 1.0, 3.0)] {
                let within = placed.position(within).as_dvec3().normalize();
                assert!(normal.dot(within).abs() < 1e-6, "{scale:?}: {normal} {within}");
            }
        }
        // The normal stays on its side of the surface: a mirror in x reverses (1, 0, 0).
        assert!(scaled([-2.0, 1.0, 1.0]).normal(Vec3::X).x < 0.0);
        let huge = scaled([1e-45, 1.0, 1.0]).normal(Vec3::new(f32::MAX, 1.0, 1.0));
        assert!(huge.is_finite() && huge.x > 0.0, "{huge}");
    }

    #[test]
    fn a_mirrored_mesh_is_not_turned_inside_out() {
        use crate::generate::Kind;
        let volume = |mesh: &Mesh| -> f64 {
            let corners = (0..mesh.triangles().len()).map(|triangle| mesh.corners(triangle));
            corners.map(|[a, b, c]| a.as_dvec3().dot(b.as_dvec3().cross(c.as_dvec3())) / 6.0).sum()
        };
        let ball = || Kind::named("sphere").unwrap().mesh([16, 8]).unwrap();
        let whole = volume(&ball());
        assert!(whole > 0.0);
        for (scale, factor) in [([1.0, 2.0, 3.0], 6.0), ([-1.0, 2.0, 3.0], 6.0), ([-2.0; 3], 8.0)] {
            let placed = scaled(scale).mesh(ball()).unwrap();
            assert!((volume(&placed) / (factor * whole) - 1.0).abs() < 1e-5, "{scale:?}");
            // The normal of every corner still points outward.
            for triangle in 0..placed.triangles().len() {
                let Some(normals) = placed.normals().of(triangle) else { continue };
                for (corner, normal) in placed.corners(triangle).iter().zip(normals) {
                    assert!(corner.dot(normal) > 0.0, "{scale:?}: triangle {triangle}");
                }
            }
        }
    }

    #[test]
    fn quarter_turns_are_exact() {
        let about_y = |degrees| rotation(DVec3::Y, degrees).rotate(DVec3::X);
        assert_eq!(about_y(90.0), DVec3::NEG_Z);
        assert_eq!(about_y(180.0), DVec3::NEG_X);
        assert_eq!(about_y(-90.0), DVec3::Z);
        assert_eq!(about_y(720.0), DVec3::X);
        assert_eq!(about_y(-1e-30), DVec3::X);
    }

    #[test]
    fn a_third_of_a_turn_about_the_diagonal_swaps_the_axes() {
        let turned = rotation(DVec3::ONE.normalize(), 120.0).rotate(DVec3::X);
        assert!((turned - DVec3::Y).length() < 1e-15, "{turned}");
    }

    #[test]
    fn objects_are_scaled_then_turned_then_moved() {
        // (1, 0, 0) · 2 = (2, 0, 0); a quarter turn about z makes it (0, 2, 0); + (5, 0, 0).
        let placed = transform(2.0, Some(rotation(DVec3::Z, 90.0)), DVec3::new(5.0, 0.0, 0.0));
        assert_eq!(placed.position(Vec3::X), Vec3::new(5.0, 2.0, 0.0));
        assert_eq!(placed.normal(Vec3::X), Vec3::Y);
    }

    #[test]
    fn numbers_are_rounded_once() {
        // 3·(1 + 2^-23) needs 25 bits: rounding before the translation would give another number.
        let [x, less] = [1.0 + f32::EPSILON, -3.0];
        let placed = transform(3.0, None, DVec3::new(f64::from(less), 0.0, 0.0));
        assert_eq!(placed.position(Vec3::new(x, 0.0, 0.0)).x, 3.0 * f32::EPSILON);
        assert_ne!(3.0 * x + less, 3.0 * f32::EPSILON);
    }

    #[test]
    fn a_huge_normal_still_fits_when_it_is_turned() {
        let placed = transform(1.0, Some(rotation(DVec3::Z, 45.0)), DVec3::ZERO);
        let turned = placed.normal(Vec3::new(f32::MAX, f32::MAX, 0.0));
        assert!(turned.is_finite() && turned.y > 0.0 && turned.x.abs() < 1e-6 * turned.y);
    }
}
