//! How a primitive is drawn, by the number of samples in its box.

/// Boxes of at most this many samples are drawn together, apart from larger ones: sixteen triangles take
/// as long as the one with most samples.
pub(super) const VERY_FEW_SAMPLES: u32 = 4;
/// Triangles over at most this many samples are drawn a triangle a lane.
pub(super) const FEW_SAMPLES: u32 = 16;
/// Boxes of more columns or rows than this are not for `f32`.
pub(super) const MOST_SAMPLES_ACROSS: i32 = 256;

/// How a primitive is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SizeClass {
    /// A triangle over very few samples: sixteen triangles at a time.
    VeryFew,
    /// A triangle over few samples: likewise, but apart from smaller ones.
    Few,
    /// A triangle over more samples: sixteen samples at a time.
    Many,
    /// Everything else: one primitive at a time, set up in `f64`.
    Large,
}

impl SizeClass {
    /// How many classes there are.
    pub(super) const COUNT: u32 = 4;
    /// The classes whose triangles are set up together.
    pub(super) const IN_LANES: [SizeClass; 3] =
        [SizeClass::VeryFew, SizeClass::Few, SizeClass::Many];
}
