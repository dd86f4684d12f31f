//! Turns bytes into coordinates: of few bits, ordinary, or extreme.

use bothways_common::glam::Vec3;
use libfuzzer_sys::arbitrary::{Result, Unstructured};

/// The kind of coordinates in a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Numbers {
    /// Small multiples of one unit: samples on edges and vertices, coplanar faces, equal distances.
    FewBits {
        /// The unit.
        unit: f32,
    },
    /// Numbers of ordinary size, sometimes of few bits.
    Ordinary,
    /// Numbers of all sizes, from denormal to nearly infinite.
    Extreme,
}

impl Numbers {
    /// Chooses a kind.
    pub(crate) fn choose(bytes: &mut Unstructured) -> Result<Numbers> {
        Ok(match bytes.int_in_range(0..=6)? {
            0 | 1 => Numbers::FewBits { unit: *bytes.choose(&[1.0, 0.5, 0.25])? },
            2 => Numbers::FewBits { unit: *bytes.choose(&[1.0 / 3.0, 0.1, 1024.0])? },
            3 | 4 => Numbers::Ordinary,
            _ => Numbers::Extreme,
        })
    }

    /// Tells whether the coordinates are of all sizes.
    pub(crate) fn is_extreme(self) -> bool {
        matches!(self, Numbers::Extreme)
    }

    /// One coordinate.
    pub(crate) fn coordinate(self, bytes: &mut Unstructured) -> Result<f32> {
        let few = |bytes: &mut Unstructured| Ok(f32::from(bytes.int_in_range(-16..=16_i8)?));
        match self {
            Numbers::FewBits { unit } => Ok(unit * few(bytes)?),
            Numbers::Ordinary if bytes.ratio(1, 8)? => few(bytes),
            Numbers::Ordinary => Ok(fraction(bytes)? * 8.0 - 4.0),
            Numbers::Extreme => match bytes.int_in_range(0..=4)? {
                0 => few(bytes),
                1 => Ok(fraction(bytes)? * 8.0 - 4.0),
                2 => {
                    let power = (bytes.int_in_range(-149..=127)? as f32).exp2();
                    Ok(if bytes.arbitrary()? { power } else { -power })
                }
                // Numbers of few bits and of sizes at which error bounds overflow or vanish.
                3 => {
                    let exponent = *bytes.choose(&[-140, -126, -100, -64, 50, 64, 85, 100, 116])?;
                    let power = ((exponent + bytes.int_in_range(-6..=6)?) as f32).exp2();
                    Ok(few(bytes)? * power)
                }
                _ => {
                    let any = f32::from_bits(bytes.arbitrary()?);
                    Ok(if any.is_finite() { any } else { 0.0 })
                }
            },
        }
    }

    /// Three coordinates.
    pub(crate) fn point(self, bytes: &mut Unstructured) -> Result<Vec3> {
        Ok(Vec3::new(self.coordinate(bytes)?, self.coordinate(bytes)?, self.coordinate(bytes)?))
    }
}

/// A number from 0 to 1, in steps of 2⁻²⁴.
pub(crate) fn fraction(bytes: &mut Unstructured) -> Result<f32> {
    Ok((bytes.arbitrary::<u32>()? >> 8) as f32 * (-24f32).exp2())
}
