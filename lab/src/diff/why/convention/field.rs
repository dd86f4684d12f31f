//! The size of the viewport.

use crate::common::{Camera, Projection};

/// The size of the viewport.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Field {
    /// The camera's `vw` and `vh`.
    #[default]
    AsStated,
    /// `vh` is taken for the width, and the height follows from the form of the image.
    VerticalAsHorizontal,
    /// `vw` is taken for the height, and the width follows from the form of the image.
    HorizontalAsVertical,
    /// The width is `vh`: the form of the image is left out.
    AspectLeftOut,
    /// The height is `vw`: likewise.
    HeightIsWidth,
    /// The width is `vh·H/W` for `vh·W/H`.
    AspectInverted,
    /// Both sides are twice as long: a half side or half angle is taken for a whole one, or the other way round.
    Double,
    /// Both sides are half as long.
    Half,
    /// The width alone is half as long.
    HalfWidth,
    /// The height alone is half as long.
    HalfHeight,
    /// The width alone is twice as long.
    DoubleWidth,
    /// The height alone is twice as long.
    DoubleHeight,
    /// `vw` is taken for the height and `vh` for the width.
    Exchanged,
    /// 1 is taken for the distance `d` of the viewport. With `d` times as large a viewport, the picture is the same.
    DistanceLeftOut,
}

impl Field {
    /// All fields, ours first.
    pub const ALL: [Field; 14] = [
        Field::AsStated,
        Field::VerticalAsHorizontal,
        Field::HorizontalAsVertical,
        Field::AspectLeftOut,
        Field::HeightIsWidth,
        Field::AspectInverted,
        Field::Double,
        Field::Half,
        Field::HalfWidth,
        Field::HalfHeight,
        Field::DoubleWidth,
        Field::DoubleHeight,
        Field::Exchanged,
        Field::DistanceLeftOut,
    ];

    /// Whether few renderers make the mistake.
    pub(super) fn is_rare(self) -> bool {
        use Field::{DoubleHeight, DoubleWidth, Exchanged, HalfHeight, HalfWidth, HeightIsWidth};
        matches!(
            self,
            HalfWidth | HalfHeight | DoubleWidth | DoubleHeight | Exchanged | HeightIsWidth
        )
    }

    /// Width and height of the viewport.
    pub fn viewport(self, camera: &Camera) -> [f64; 2] {
        let [vw, vh] = camera.viewport();
        let [width, height] = camera.image().map(f64::from);
        match self {
            Field::AsStated => [vw, vh],
            Field::VerticalAsHorizontal => [vh, vh * height / width],
            Field::HorizontalAsVertical => [vw * width / height, vw],
            Field::AspectLeftOut => [vh, vh],
            Field::HeightIsWidth => [vw, vw],
            Field::AspectInverted => [vh * height / width, vh],
            Field::Double => [2.0 * vw, 2.0 * vh],
            Field::Half => [vw / 2.0, vh / 2.0],
            Field::HalfWidth => [vw / 2.0, vh],
            Field::HalfHeight => [vw, vh / 2.0],
            Field::DoubleWidth => [2.0 * vw, vh],
            Field::DoubleHeight => [vw, 2.0 * vh],
            Field::Exchanged => [vh, vw],
            Field::DistanceLeftOut => {
                let distance = match camera.projection() {
                    Projection::Perspective => camera.distance(),
                    Projection::Parallel => 1.0,
                };
                [vw, vh].map(|side| side * distance)
            }
        }
    }
}

/// The fields that differ from the stated viewport, each size once.
pub(super) fn fields(camera: &Camera) -> Vec<Field> {
    let mut sizes = vec![Field::AsStated.viewport(camera)];
    let mut fields = Vec::new();
    for field in Field::ALL.into_iter().skip(1) {
        let size = field.viewport(camera);
        let same = |other: &[f64; 2]| {
            // A viewport in `f32` that was made for the form of the image.
            other.iter().zip(size).all(|(one, other)| (one / other - 1.0).abs() < 1e-6)
        };
        if !sizes.iter().any(same) {
            sizes.push(size);
            fields.push(field);
        }
    }
    fields
}
