//! The scenes that test size: very large, very small and very far.

use super::sketch::sketch;
use super::vector::{Group, Vector};

/// A million pixels.
const FAR_OFF: f32 = 1_048_576.0;

pub(super) fn vectors() -> Vec<Vector> {
    let sketch = |name, point| sketch(Group::Extremes, name, point);
    let halves = [[1.0, 1.0], [7.0, 1.0], [7.0, 7.0], [1.0, 7.0]];
    vec![
        sketch("far-off-corners", "A cut through samples between corners a million pixels off.")
            .size(16, 16)
            .flat_quad([
                [-FAR_OFF, -FAR_OFF],
                [FAR_OFF, -FAR_OFF],
                [FAR_OFF, FAR_OFF],
                [-FAR_OFF, FAR_OFF],
            ])
            .done(),
        sketch(
            "far-off-sliver",
            "A sliver through the picture between corners a million pixels off.",
        )
        .size(16, 16)
        .flat([[-FAR_OFF, -FAR_OFF], [FAR_OFF, FAR_OFF], [FAR_OFF, FAR_OFF - 2.0]])
        .done(),
        sketch("huge-world", "The scene shared-diagonal, 2^100 times as large and as far.")
            .flat_quad(halves)
            .scaled(2_f32.powi(100))
            .done(),
        sketch("tiny-world", "The scene shared-diagonal, 2^100 times as small and as near.")
            .flat_quad(halves)
            .scaled(2_f32.powi(-100))
            .done(),
        sketch(
            "near-and-far",
            "Depths of 2^-20 and of 2^40 in one picture: no plane clips either.",
        )
        .pixels([[1.0, 1.0], [7.0, 2.0], [2.0, 6.0]].map(|[x, y]| [x, y, 40_f32.exp2()]))
        .pixels([[7.0, 7.0], [1.0, 5.0], [6.0, 1.0]].map(|[x, y]| [x, y, (-20_f32).exp2()]))
        .done(),
        sketch("oblong-pixels", "Pixels twice as high as wide: the rule is about pixels.")
            .size(12, 24)
            .viewport([12.0, 12.0])
            .flat_quad([[1.25, 1.5], [8.25, 1.5], [8.25, 8.5], [1.25, 8.5]])
            .done(),
    ]
}
