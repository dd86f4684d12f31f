//! What surfaces are made of, and where light comes from.

use super::texture::Texture;
use glam::Vec3;

/// How a surface reflects light.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Diffuse reflectance, linear red, green and blue in 0 … 1. Textures and colours of vertices are multiplied by it.
    pub color: Vec3,
    /// Strength of the highlight, 0 … 1.
    pub specular: f32,
    /// The Blinn–Phong exponent: larger is a smaller highlight.
    pub shininess: f32,
    /// A second colour over the texture coordinates.
    pub checker: Option<Checker>,
    /// A picture over the texture coordinates; then there is no checker.
    pub texture: Option<Texture>,
}

impl Material {
    /// Whether anything is drawn over the texture coordinates.
    pub fn has_pattern(&self) -> bool {
        self.checker.is_some() || self.texture.is_some()
    }
}

impl Default for Material {
    /// Matt light grey.
    fn default() -> Self {
        Material {
            color: Vec3::splat(0.6),
            specular: 0.0,
            shininess: 32.0,
            checker: None,
            texture: None,
        }
    }
}

/// Where light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// The same light from everywhere.
    Ambient {
        /// Its strength; 1 shows a material in its own colour.
        intensity: f32,
    },
    /// Parallel light, as from the sun.
    Directional {
        /// The way that the light goes, in the world; its length does not matter.
        direction: Vec3,
        /// Its strength on a surface that faces it.
        intensity: f32,
    },
    /// Light from a point of the world; it does not fade with distance.
    Point {
        /// Where it is, in the world.
        position: Vec3,
        /// Its strength on a surface that faces it.
        intensity: f32,
    },
    /// Light from where the viewing rays begin: a surface that faces the viewer is bright.
    AtCamera {
        /// Its strength on a surface that faces it.
        intensity: f32,
    },
}

/// A pattern of two colours: the material's own in the cell at (0, 0), this one beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checker {
    /// The other diffuse reflectance, linear red, green and blue in 0 … 1.
    pub color: Vec3,
    /// Cells to one unit of the texture coordinate, in both directions; positive.
    pub divisions: [f32; 2],
}
