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
    /// Both sides are twice as long: a half side is taken for a whole one.
    Double,
    /// Both sides are half as long.
    Half,
    /// `vh = 2·d·tan θ` with the field of view `θ`, for `2·d·tan(θ/2)`.
    TangentOfWholeAngle,
    /// `vh = 2·d·tan(θ/4)`.
    TangentOfQuarterAngle,
    /// `vh = d·θ`, with `θ` in radians.
    AngleForTangent,
    /// `vh = 2·d·tan(θ/2)`, with degrees taken for radians.
    DegreesAsRadians,
    /// `θ` is taken for the angle between two opposite corners of the viewport.
    VerticalAsDiagonal,
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
    pub const ALL: [Field; 19] = [
        Field::AsStated,
        Field::VerticalAsHorizontal,
        Field::HorizontalAsVertical,
        Field::AspectLeftOut,
        Field::HeightIsWidth,
        Field::AspectInverted,
        Field::Double,
        Field::Half,
        Field::TangentOfWholeAngle,
        Field::TangentOfQuarterAngle,
        Field::AngleForTangent,
        Field::DegreesAsRadians,
        Field::VerticalAsDiagonal,
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
        self.is_of_angle()
            || matches!(
                self,
                HalfWidth | HalfHeight | DoubleWidth | DoubleHeight | Exchanged | HeightIsWidth
            )
    }

    /// Whether it is a mistake about the field of view, an angle that a parallel camera does not have.
    pub(in crate::diff::why) fn is_of_angle(self) -> bool {
        use Field::{
            AngleForTangent, DegreesAsRadians, TangentOfQuarterAngle, TangentOfWholeAngle,
            VerticalAsDiagonal,
        };
        matches!(
            self,
            TangentOfWholeAngle
                | TangentOfQuarterAngle
                | AngleForTangent
                | DegreesAsRadians
                | VerticalAsDiagonal
        )
    }

    /// Width and height of the viewport.
    pub fn viewport(self, camera: &Camera) -> [f64; 2] {
        let [vw, vh] = camera.viewport();
        let [width, height] = camera.image().map(f64::from);
        // tan(θ/2), and the viewport of the same form with another one.
        let tangent = vh / 2.0 / camera.distance();
        let angle = 2.0 * tangent.atan();
        let of_tangent = |other: f64| [vw, vh].map(|side| side * (other / tangent));
        match self {
            Field::AsStated | Field::DistanceLeftOut => [vw, vh],
            Field::VerticalAsHorizontal => [vh, vh * height / width],
            Field::HorizontalAsVertical => [vw * width / height, vw],
            Field::AspectLeftOut => [vh, vh],
            Field::HeightIsWidth => [vw, vw],
            Field::AspectInverted => [vh * height / width, vh],
            Field::Double => [2.0 * vw, 2.0 * vh],
            Field::Half => [vw / 2.0, vh / 2.0],
            Field::TangentOfWholeAngle => of_tangent(angle.tan()),
            Field::TangentOfQuarterAngle => of_tangent((angle / 4.0).tan()),
            Field::AngleForTangent => of_tangent(angle / 2.0),
            Field::DegreesAsRadians => of_tangent((angle.to_degrees() / 2.0).tan()),
            Field::VerticalAsDiagonal => of_tangent(tangent * vh / vw.hypot(vh)),
            Field::HalfWidth => [vw / 2.0, vh],
            Field::HalfHeight => [vw, vh / 2.0],
            Field::DoubleWidth => [2.0 * vw, vh],
            Field::DoubleHeight => [vw, 2.0 * vh],
            Field::Exchanged => [vh, vw],
        }
    }

    /// The distance of the viewport of a perspective camera.
    pub fn distance(self, camera: &Camera) -> f64 {
        if self == Field::DistanceLeftOut { 1.0 } else { camera.distance() }
    }

    /// The other fields of the same size, if it is not the stated one.
    pub(in crate::diff::why) fn of_same_size(self, camera: &Camera) -> impl Iterator<Item = Field> {
        let size = self.viewport(camera);
        let others = Field::ALL.into_iter().filter(move |&other| {
            !self.has_stated_size()
                && other != self
                && !other.has_stated_size()
                && other.is_possible(camera)
        });
        others.filter(move |other| is_same(other.viewport(camera), size))
    }

    /// Whether a renderer of this camera can have it.
    fn is_possible(self, camera: &Camera) -> bool {
        !(self.is_of_angle() && camera.projection() == Projection::Parallel)
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
    let others = Field::ALL.into_iter().filter(|field| !field.has_stated_size());
    for field in others.filter(|field| field.is_possible(camera)) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::CameraDescription;

    #[test]
    fn mistakes_about_the_field_of_view_have_the_viewport_of_their_formula() {
        let description =
            CameraDescription { distance: 1.5, image: [16, 12], ..CameraDescription::default() };
        let camera = Camera::new(description.with_field_of_view(50.0).unwrap()).unwrap();
        let radians = 50_f64.to_radians();
        // Of a picture with the sides 4 and 3, the diagonal is 5.
        for (field, tangent) in [
            (Field::AsStated, (radians / 2.0).tan()),
            (Field::TangentOfWholeAngle, radians.tan()),
            (Field::TangentOfQuarterAngle, (radians / 4.0).tan()),
            (Field::AngleForTangent, radians / 2.0),
            (Field::DegreesAsRadians, 25_f64.tan()),
            (Field::VerticalAsDiagonal, (radians / 2.0).tan() * 3.0 / 5.0),
        ] {
            let [vw, vh] = field.viewport(&camera);
            let expected = 2.0 * 1.5 * tangent;
            // The camera stores `f32`, and a tangent far from 0 takes its rounding several times.
            assert!((vh / expected - 1.0).abs() < 1e-5, "{field:?} {vh} {expected}");
            assert!((vw / vh - 4.0 / 3.0).abs() < 1e-6, "{field:?}");
        }
    }
}
