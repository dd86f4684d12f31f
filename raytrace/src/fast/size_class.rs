//! How many samples triangles may cover, in classes: each class has its own way to be drawn.

/// Triangles over at most this many samples are drawn one a lane.
pub(super) const FEW: f32 = 16.0;
/// At most this many samples are very few.
pub(super) const VERY_FEW: f32 = 3.0;

/// How many samples the largest of some triangles may cover.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum SizeClass {
    VeryFew,
    Few,
    Many,
}
