//! The look of what is seen: shading, texture coordinates and colours. What a look *is* stands here; where on a
//! surface a sample lies is for each order to find out.

pub mod bands;
pub mod color;
pub mod lanes;
mod power;
mod sampling;
pub mod shade;
pub mod texture;

pub use sampling::level_of;
