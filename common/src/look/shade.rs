//! The look of surface points: one function for both orders, which each bring their own normals
//! and texture coordinates.

use crate::engine::simd::{Select, Simd, SimdBase, SimdMask, f32x16, mask32x16};
use crate::look::lanes::{Vec3x16, each};
use crate::look::power::{Exponent, power};
use crate::scene::material::{Light, Material};
use crate::view::View;
use glam::{DVec3, Vec3};

/// What is seen at sixteen samples.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoints<S: Simd> {
    /// Unit normals, towards the viewer.
    pub normals: Vec3x16<S>,
    /// Unit directions towards the viewer, against the viewing rays; any others where the look [does not depend on
    /// them](Lighting::looks_at_viewer).
    pub to_viewer: Vec3x16<S>,
    /// The fraction of the material's pattern that has the second colour.
    pub fraction: f32x16<S>,
    /// What textures and colours of vertices leave of the material's colour, where [`Finish`] says that there are any.
    pub tint: [f32x16<S>; 3],
}

/// A material, prepared for all its samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish<'a> {
    material: &'a Material,
    /// Whether each sample has a tint.
    is_tinted: bool,
    /// That of the square of a cosine.
    exponent: Exponent,
}

impl Finish<'_> {
    /// The look of this material, whose surface has a tint at each sample or not.
    pub fn new(material: &Material, is_tinted: bool) -> Finish<'_> {
        Finish { material, is_tinted, exponent: Exponent::new(0.5 * material.shininess) }
    }

    /// Whether it is the look of this very material, with a tint or not.
    pub fn is_of(&self, material: &Material, is_tinted: bool) -> bool {
        std::ptr::eq(self.material, material) && self.is_tinted == is_tinted
    }
}

/// The lights of a view, prepared for all its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Lighting {
    ambient: f32,
    lamps: Vec<Lamp>,
    points: Vec<DVec3>,
}

/// A light that comes from somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Lamp {
    place: LightSource,
    intensity: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum LightSource {
    /// Far away, in this unit direction.
    Towards(Vec3),
    /// In the point with this number.
    At(usize),
    /// Where the viewing ray begins.
    AtCamera,
}

impl Lighting {
    /// The lights of the view's scene, around its eye.
    pub fn new(view: &View) -> Lighting {
        let (mut ambient, mut lamps, mut points) = (0.0, Vec::new(), Vec::new());
        for light in &view.scene.lights {
            let (place, intensity) = match *light {
                Light::Ambient { intensity } => {
                    ambient += intensity;
                    continue;
                }
                Light::Directional { direction, intensity } => {
                    (LightSource::Towards(-direction.normalize_or_zero()), intensity)
                }
                Light::Point { position, intensity } => {
                    points.push(view.offset(position));
                    (LightSource::At(points.len() - 1), intensity)
                }
                Light::AtCamera { intensity } => (LightSource::AtCamera, intensity),
            };
            lamps.push(Lamp { place, intensity });
        }
        Lighting { ambient, lamps, points }
    }

    /// The points from which light comes in all directions, relative to the eye, in the order of the scene's lights.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Whether it matters to this look from where it is seen.
    #[inline(always)]
    pub fn looks_at_viewer(&self, finish: &Finish) -> bool {
        finish.material.specular != 0.0
            || self.lamps.iter().any(|lamp| lamp.place == LightSource::AtCamera)
    }

    /// The linear red, green and blue of surface points of one material: ambient light, Lambert's cosine and a
    /// Blinn–Phong highlight. Colours above 1 are left to the picture to clamp. `to_light` gives the ways from the surface
    /// points to the point of light with a number among [`Lighting::points`], of any length.
    ///
    /// Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977.
    #[inline(always)]
    pub fn colors<S: Simd>(
        &self,
        simd: S,
        points: &SurfacePoints<S>,
        finish: &Finish,
        to_light: impl Fn(usize) -> Vec3x16<S>,
    ) -> [f32x16<S>; 3] {
        let material = finish.material;
        let splat = |value: f32| f32x16::splat(simd, value);
        let mut diffuse = splat(self.ambient);
        let mut highlights = splat(0.0);
        for Lamp { place, intensity } in &self.lamps {
            let to_light = match place {
                LightSource::Towards(direction) => Vec3x16::splat(simd, *direction),
                LightSource::At(number) => to_light(*number).directions(simd),
                LightSource::AtCamera => points.to_viewer,
            };
            let cosine = points.normals.dot(to_light);
            let is_lit = cosine.simd_gt(splat(0.0));
            if is_lit.all_false() {
                continue;
            }
            let intensity = splat(*intensity);
            diffuse += is_lit.select(intensity * cosine, splat(0.0));
            if material.specular != 0.0
                && let Some(highlight) = highlight(simd, points, to_light, finish.exponent, is_lit)
            {
                highlights += intensity * highlight;
            }
        }
        let highlights = highlights * splat(material.specular);
        let colors = reflectance(simd, finish, points);
        each!(k in [0, 1, 2] => colors[k] * diffuse + highlights)
    }
}

/// Blinn's highlight: the cosine between the normal and halfway from the light to the viewer, to the power of the
/// shininess. It is found from the square of the cosine, without a root. `None` if it is 0 for all.
#[inline(always)]
fn highlight<S: Simd>(
    simd: S,
    points: &SurfacePoints<S>,
    to_light: Vec3x16<S>,
    exponent: Exponent,
    is_lit: mask32x16<S>,
) -> Option<f32x16<S>> {
    let halfway = to_light + points.to_viewer;
    let along = points.normals.dot(halfway);
    let zero = f32x16::splat(simd, 0.0);
    let (square, below) = (along * along, halfway.dot(halfway));
    // Most of a surface has no highlight.
    let is_some = exponent.is_some(simd, [square, below]) & along.simd_gt(zero) & is_lit;
    if is_some.all_false() {
        return None;
    }
    Some(is_some.select(power(simd, square / below, exponent), zero))
}

/// The material's colour, and what is drawn over it.
#[inline(always)]
fn reflectance<S: Simd>(simd: S, finish: &Finish, points: &SurfacePoints<S>) -> [f32x16<S>; 3] {
    let own = finish.material.color.to_array();
    match &finish.material.checker {
        None if finish.is_tinted => {
            each!(k in [0, 1, 2] => f32x16::splat(simd, own[k]) * points.tint[k])
        }
        None => each!(k in [0, 1, 2] => f32x16::splat(simd, own[k])),
        Some(checker) => each!(k in [0, 1, 2] => {
            let step = f32x16::splat(simd, checker.color[k] - own[k]);
            f32x16::splat(simd, own[k]) + step * points.fraction
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::engine::simd::{dispatch, levels};
    use crate::scene::Scene;

    /// The colours of a point in front of the eye that faces it, at every level of SIMD.
    fn colors(material: &Material, lights: &[Light]) -> Vec<[f32; 3]> {
        let mut scene = Scene::new(Vec::new()).unwrap();
        scene.lights = lights.to_vec();
        let camera = Camera::canonical(1, 1);
        let lighting = Lighting::new(&View::new(&scene, &camera));
        let of_level = |level| {
            dispatch!(level, simd => {
                let zero = f32x16::splat(simd, 0.0);
                let towards = Vec3x16::splat(simd, Vec3::Z);
                let points = SurfacePoints {
                    normals: towards,
                    to_viewer: towards,
                    fraction: zero,
                    tint: [zero; 3],
                };
                let finish = Finish::new(material, false);
                // The point lies before the eye.
                let to_light = |light: usize| {
                    Vec3x16::splat(simd, lighting.points()[light].as_vec3() + Vec3::Z)
                };
                lighting.colors(simd, &points, &finish, to_light).map(|channel| channel[3])
            })
        };
        levels().into_iter().map(of_level).collect()
    }

    #[test]
    fn a_surface_that_faces_the_light_shows_its_color() {
        let material = Material { color: Vec3::new(0.5, 0.25, 0.0), ..Material::default() };
        let eye = Camera::canonical(1, 1).eye();
        let shown = [
            Light::Ambient { intensity: 1.0 },
            Light::Directional { direction: Vec3::new(0.0, 0.0, -2.0), intensity: 1.0 },
            Light::AtCamera { intensity: 1.0 },
            Light::Point { position: eye, intensity: 1.0 },
        ];
        for light in shown {
            for color in colors(&material, &[light]) {
                assert_eq!(color, [0.5, 0.25, 0.0], "{light:?}");
            }
        }
        let behind = Light::Directional { direction: Vec3::Z, intensity: 1.0 };
        assert!(colors(&material, &[behind]).iter().all(|color| *color == [0.0; 3]));
        let nowhere = Light::Directional { direction: Vec3::ZERO, intensity: 1.0 };
        assert!(colors(&material, &[nowhere]).iter().all(|color| *color == [0.0; 3]));
    }

    #[test]
    fn the_viewer_matters_to_highlights_and_to_light_from_the_camera() {
        let of = |specular: f32, light: Light| {
            let mut scene = Scene::new(Vec::new()).unwrap();
            scene.lights = vec![light];
            let camera = Camera::canonical(1, 1);
            let material = Material { specular, ..Material::default() };
            Lighting::new(&View::new(&scene, &camera))
                .looks_at_viewer(&Finish::new(&material, false))
        };
        let from_above = Light::Directional { direction: Vec3::NEG_Y, intensity: 1.0 };
        let at_camera = Light::AtCamera { intensity: 1.0 };
        assert!(!of(0.0, from_above) && !of(0.0, Light::Ambient { intensity: 1.0 }));
        assert!(of(0.1, from_above) && of(0.0, at_camera) && of(0.1, at_camera));
    }

    #[test]
    fn each_point_of_light_lights_in_its_own_direction() {
        let material = Material { color: Vec3::ONE, ..Material::default() };
        let eye = Camera::canonical(1, 1).eye();
        // The point that is seen is one before the eye.
        let at = |place: Vec3, intensity: f32| Light::Point { position: eye + place, intensity };
        let behind = Light::Directional { direction: Vec3::Z, intensity: 1.0 };
        let lights = [at(Vec3::ZERO, 0.5), behind, at(Vec3::X, 0.25), at(-3.0 * Vec3::Z, 1.0)];
        for [red, ..] in colors(&material, &lights) {
            assert!((red - (0.5 + 0.25 * 0.5_f32.sqrt())).abs() < 1e-6, "{red}");
        }
    }

    #[test]
    fn a_highlight_is_the_cosine_halfway_to_the_power_of_the_shininess() {
        let material =
            Material { color: Vec3::ZERO, specular: 0.5, shininess: 20.0, ..Material::default() };
        for degrees in [0.0_f32, 10.0, 45.0, 80.0] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let direction = Vec3::new(sine, 0.0, -cosine);
            let expected = 0.5 * (degrees.to_radians() / 2.0).cos().powf(20.0);
            for [red, ..] in colors(&material, &[Light::Directional { direction, intensity: 1.0 }])
            {
                assert!((red - expected).abs() < 1e-5, "{degrees}: {red} {expected}");
            }
        }
    }
}
