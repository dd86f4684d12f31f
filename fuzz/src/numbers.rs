//! Coordinates from bytes: of few bits, ordinary, or extreme.

use bothways_common::glam::Vec3;
use libfuzzer_sys::arbitrary::{Result, Unstructured};

/// What a scene's coordinates look like.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Numbers {
    /// Small multiples of one unit: samples on edges and vertices, coplanar faces, equal distances.
    FewBits {
        /// The unit.
        unit: f32,
    },
    /// Anything of ordinary size, now and then a number of few bits.
    Ordinary,
    /// From denormal to nearly infinite, mixed.
    Extreme,
}

impl Numbers {
    pub(crate) fn choose(bytes: &mut Unstructured) -> Result<Numbers> {
        Ok(match bytes.int_in_range(0..=6)? {
            0 | 1 => Numbers::FewBits { unit: *bytes.choose(&[1.0, 0.5, 0.25])? },
            2 => Numbers::FewBits { unit: *bytes.choose(&[1.0 / 3.0, 0.1, 1024.0])? },
            3 | 4 => Numbers::Ordinary,
            _ => Numbers::Extreme,
        })
    }

    pub(crate) fn is_extreme(self) -> bool {
        matches!(self, Numbers::Extreme)
    }

    pub(crate) fn coordinate(self, bytes: &mut Unstructured) -> Result<f32> {
        let few = |bytes: &mut Unstructured| Ok(f32::from(bytes.int_in_range(-16..=16_i8)?));
        match self {
            Numbers::FewBits { unit } => Ok(unit * few(bytes)?),
            Numbers::Ordinary if bytes.ratio(1, 8)? => few(bytes),
            Numbers::Ordinary => Ok(share(bytes)? * 8.0 - 4.0),
            Numbers::Extreme => match bytes.int_in_range(0..=4)? {
                0 => few(bytes),
                1 => Ok(share(bytes)? * 8.0 - 4.0),
                2 => {
                    let power = (bytes.int_in_range(-149..=127)? as f32).exp2();
                    Ok(if bytes.arbitrary()? { power } else { -power })
                }
                // Near one end or the other, where bounds overflow or vanish, and in few bits.
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

    pub(crate) fn point(self, bytes: &mut Unstructured) -> Result<Vec3> {
        Ok(Vec3::new(self.coordinate(bytes)?, self.coordinate(bytes)?, self.coordinate(bytes)?))
    }
}

/// From 0 to 1, in steps of 2⁻²⁴.
pub(crate) fn share(bytes: &mut Unstructured) -> Result<f32> {
    Ok((bytes.arbitrary::<u32>()? >> 8) as f32 * (-24f32).exp2())
}
