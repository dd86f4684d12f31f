//! Where the corners of triangles lie on the raster.

/// Where a renderer puts the corners of a triangle on the raster. Its depth stays that of the triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Vertices {
    /// Where they are projected.
    #[default]
    Projected,
    /// At the nearest whole multiples of `1/2^bits` of a pixel.
    Rounded {
        /// The bits below the pixel.
        bits: u8,
    },
}

impl Vertices {
    /// What renderers do. Desktop GPUs have 8 bits below the pixel, and Vulkan asks for at least 4; programs that count in whole
    /// pixels have none.
    pub const OTHERS: [Vertices; 3] = [
        Vertices::Rounded { bits: 8 },
        Vertices::Rounded { bits: 4 },
        Vertices::Rounded { bits: 0 },
    ];

    /// Whether they move by so little that the picture is nearly the same.
    pub fn is_nearly_exact(self) -> bool {
        matches!(self, Vertices::Projected | Vertices::Rounded { bits: 1.. })
    }
}
