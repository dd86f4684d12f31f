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
    /// 1 is taken for the distance `d` of the viewport.
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
            Field::AsStated | Field::DistanceLeftOut => [vw, vh],
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
        }
    }

    /// The distance of the viewport of a perspective camera.
    pub fn distance(self, camera: &Camera) -> f32 {
        if self == Field::DistanceLeftOut { 1.0 } else { camera.description().distance }
    }

    /// The other fields of the same size, if it is not the stated one.
    pub(in crate::diff::why) fn of_same_size(self, camera: &Camera) -> impl Iterator<Item = Field> {
        let size = self.viewport(camera);
        let others = Field::ALL.into_iter().filter(move |&other| {
            !self.has_stated_size() && other != self && !other.has_stated_size()
        });
        others.filter(move |other| is_same(other.viewport(camera), size))
    }

    /// Whether the viewport has the stated size.
    fn has_stated_size(self) -> bool {
        matches!(self, Field::AsStated | Field::DistanceLeftOut)
    }
}

/// The fields that differ from the stated viewport, each size once.
pub(super) fn fields(camera: &Camera) -> Vec<Field> {
    let mut sizes = vec![Field::AsStated.viewport(camera)];
    let mut fields = Vec::new();
    for field in Field::ALL.into_iter().filter(|field| !field.has_stated_size()) {
        let size = field.viewport(camera);
        if !sizes.iter().any(|&other| is_same(other, size)) {
            sizes.push(size);
            fields.push(field);
        }
    }
    if camera.projection() == Projection::Perspective && camera.distance() != 1.0 {
        fields.push(Field::DistanceLeftOut);
    }
    fields
}

/// Whether two viewports are one, but for the rounding of one that was made in `f32` for the form of the image.
fn is_same(one: [f64; 2], other: [f64; 2]) -> bool {
    one.into_iter().zip(other).all(|(one, other)| (one / other - 1.0).abs() < 1e-6)
}
