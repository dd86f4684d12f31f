//! How the distance of a triangle follows from those of its corners.

/// How a renderer finds the distance of a triangle at a pixel. (A ray tracer, which meets its plane, interpolates nothing.)
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// `1/t` is linear in the picture of a perspective camera.
    #[default]
    Perspective,
    /// `t` itself is taken to be linear in the picture.
    Linear,
    /// All pixels have the mean of the corners' distances.
    Mean,
    /// All pixels have the distance of the first corner.
    FirstCorner,
}

impl Interpolation {
    /// What renderers do wrongly.
    pub const OTHERS: [Interpolation; 3] =
        [Interpolation::Linear, Interpolation::Mean, Interpolation::FirstCorner];
}
