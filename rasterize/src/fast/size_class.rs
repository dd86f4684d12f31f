//! How many samples triangles may cover, in classes: each class has its own way to be drawn.

/// Triangles with boxes of at most this many samples are drawn apart from larger ones: sixteen triangles take
/// as long as the one with most samples.
pub(super) const VERY_FEW: u32 = 4;
/// Triangles with boxes of at most this many samples are drawn one a lane.
pub(super) const FEW: u32 = 16;
/// Triangles with boxes of more rows or columns than this are not drawn from `f32` setups.
pub(super) const MOST_SAMPLES_ACROSS: i32 = 256;
/// A triangle is thin if it has no more columns than this in the row where it has most. Most of a block of sixteen samples in a
/// row lies beside it then.
pub(super) const THIN: f32 = 6.0;
/// Triangles of [`SizeClass::Many`] that have no more columns in all are drawn as others are, even if they are thin.
pub(super) const FEW_COLUMNS_IN_ALL: i32 = 32;

/// How a primitive is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SizeClass {
    /// A triangle over very few samples: sixteen triangles at a time.
    VeryFew,
    /// A triangle over few samples: likewise, but apart from smaller ones.
    Few,
    /// A triangle over more samples: sixteen samples at a time, or sixteen rows if it is thin.
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
