//! Light in the physical units of other programs.
//!
//! Here a surface of colour `c` sends `c·i·cos θ` to the viewer, where a light has the intensity `i`. A diffuse surface of
//! other programs sends `c/π·E·cos θ`, where `E` is the irradiance: so `E` is `π·i`. A point there sends less the farther
//! a surface is; here it does not, so it is given what makes it as strong in the middle of the scene.

use super::pieces::Pieces;
use crate::common::glam::{DVec3, Vec3};
use crate::common::{Light, Projection, View};
use std::f64::consts::PI;

/// A light as other programs know them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Physical {
    /// The same radiance from everywhere.
    Constant { radiance: f64 },
    /// Parallel light, along a unit vector.
    Distant { direction: DVec3, irradiance: f64 },
    /// A point; its intensity is power a solid angle.
    Point { position: DVec3, intensity: f64 },
}

/// The lights of a view, and a note where they fade.
pub(super) fn lights(view: &View, pieces: &Pieces, notes: &mut Vec<String>) -> Vec<Physical> {
    let eye = view.camera.eye().as_dvec3();
    let point = |position: DVec3, intensity: f32| Physical::Point {
        position,
        intensity: PI * f64::from(intensity) * (pieces.middle - position).length_squared(),
    };
    let distant = |direction: DVec3, intensity: f32| Physical::Distant {
        direction: direction.normalize_or(DVec3::NEG_Z),
        irradiance: PI * f64::from(intensity),
    };
    let physical = |light: &Light| match *light {
        Light::Ambient { intensity } => Physical::Constant { radiance: f64::from(intensity) },
        Light::Directional { direction, intensity } => distant(direction.as_dvec3(), intensity),
        Light::Point { position, intensity } => point(position.as_dvec3(), intensity),
        Light::AtCamera { intensity } => match view.camera.projection() {
            Projection::Perspective => point(eye, intensity),
            Projection::Parallel => distant(-view.camera.w(), intensity),
        },
    };
    let all: Vec<Physical> = view.scene.lights.iter().map(physical).collect();
    if all.iter().any(|light| matches!(light, Physical::Point { .. })) {
        notes.push("lights at a point fade with the distance there; in the middle of the scene they are as here".into());
    }
    if view.scene.background != Vec3::ZERO {
        notes.push("the background is left out".into());
    }
    all
}
