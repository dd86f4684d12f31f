//! The look of a surface point: one function for both orders, which each bring their own normals
//! and texture coordinates.

use crate::look::texture::TexturePoint;
use crate::scene::material::{Light, Material};
use glam::{DVec3, Vec3};

/// What is seen at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Where it is, relative to the eye. The eye may be far away, hence `f64`.
    pub position: DVec3,
    /// Unit normal, towards the viewer.
    pub normal: Vec3,
    /// Unit direction towards the viewer, against the viewing ray.
    pub to_viewer: Vec3,
    /// Where it is on its texture; without a texture point no pattern is drawn.
    pub texture: Option<TexturePoint>,
}

/// The linear colour of a surface point: ambient light, Lambert's cosine and a Blinn–Phong highlight.
///
/// `eye` is where the eye is in the world. Colours above 1 are left to the picture to clamp.
///
/// Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977.
#[inline]
pub fn color(point: &SurfacePoint, material: &Material, lights: &[Light], eye: Vec3) -> Vec3 {
    let plain = Material { color: reflectance(point, material), ..*material };
    lights.iter().map(|light| lit_by(light, point, &plain, eye)).sum()
}

/// The material's colour at this point of its pattern.
#[inline]
fn reflectance(point: &SurfacePoint, material: &Material) -> Vec3 {
    match (&material.checker, &point.texture) {
        (Some(checker), Some(texture)) => {
            material.color.lerp(checker.color, checker.fraction(texture))
        }
        _ => material.color,
    }
}

#[inline]
fn lit_by(light: &Light, point: &SurfacePoint, material: &Material, eye: Vec3) -> Vec3 {
    let (to_light, intensity) = match *light {
        Light::Ambient { intensity } => return material.color * intensity,
        Light::Directional { direction, intensity } => (-direction, intensity),
        Light::Point { position, intensity } => {
            let to_light = (position.as_dvec3() - eye.as_dvec3()) - point.position;
            (to_light.as_vec3(), intensity)
        }
        Light::AtCamera { intensity } => (point.to_viewer, intensity),
    };
    let to_light = to_light.normalize_or_zero();
    let cosine = point.normal.dot(to_light);
    if cosine <= 0.0 {
        return Vec3::ZERO;
    }
    let halfway = (to_light + point.to_viewer).normalize_or_zero();
    let highlight = point.normal.dot(halfway).max(0.0).powf(material.shininess);
    intensity * (material.color * cosine + Vec3::splat(material.specular * highlight))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_surface_that_faces_the_light_shows_its_color() {
        let point = SurfacePoint {
            position: -DVec3::Z,
            normal: Vec3::Z,
            to_viewer: Vec3::Z,
            texture: None,
        };
        let material = Material { color: Vec3::new(0.5, 0.25, 0.0), ..Material::default() };
        let lit = |direction| {
            let light = Light::Directional { direction, intensity: 1.0 };
            color(&point, &material, &[light], Vec3::ZERO)
        };
        assert_eq!(lit(-Vec3::Z), material.color);
        assert_eq!(lit(Vec3::Z), Vec3::ZERO);
    }
}
