//! What all parts of a random scene have in common.

/// The style of a scene's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Style {
    /// Multiples of a fraction of a pixel, at a few depths: ties everywhere.
    Lattice,
    /// The same, with some numbers one bit off: near misses everywhere.
    NearLattice,
    /// Any numbers of ordinary size.
    Free,
    /// From denormal to nearly infinite, mixed with the others.
    Extreme,
}

/// The size of a picture, and what there is time for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scale {
    /// Up to 16 pixels a side.
    Tiny,
    /// Up to 64: the textbooks draw all of it.
    Small,
    /// Several tiles a side.
    Medium,
    /// About a thousand pixels a side, or a strip that is longer.
    Large,
}

impl Scale {
    /// Whether a picture has so many samples that exact arithmetic cannot decide them all within seconds. Then no corner lies
    /// on the eye, and no eye is so far away that coordinates keep no bits.
    pub(super) fn is_large(self) -> bool {
        matches!(self, Scale::Medium | Scale::Large)
    }
}
