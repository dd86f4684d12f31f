//! The eye, the axes and the viewport of a renderer in sentences.

use crate::common::Camera;
use crate::diff::why::convention::{Field, Pose};

/// The eye and the axes.
pub(super) fn of_pose(pose: Pose) -> &'static str {
    match pose {
        Pose::AsStated => "has the camera's eye and axes",
        Pose::EyeLeftOut => {
            "looks from the origin of the world: begin its rays at the eye, or subtract the eye from each vertex"
        }
        Pose::EyeAdded => "looks from -eye: it adds the eye to each vertex; subtract it",
        Pose::EyeAfterTurn => {
            "turns first, and subtracts the eye then: subtract the eye from each vertex, and then multiply by u, v and w"
        }
        Pose::AxesLeftOut => {
            "does not turn: it has the axes of the world for u, v and w; take those of the camera"
        }
        Pose::AxesExchanged => {
            "turns the other way: rows and columns of its rotation are exchanged (from the world to the camera, u, v \
             and w are its rows; from the camera to the world, its columns)"
        }
        Pose::MatrixNotInverted => {
            "takes the matrix from the camera to the world for that from the world to the camera: invert it"
        }
        Pose::TargetAsDirection => {
            "looks along look_at, as if it were a direction: the direction of view is look_at - eye"
        }
        Pose::DirectionAsTarget => {
            "looks at the direction of view, as if it were a point: do not subtract the eye from it"
        }
        Pose::EyeAndTargetExchanged => {
            "exchanges eye and look_at: it looks from look_at to the eye"
        }
        Pose::UpLeftOut => "takes (0, 1, 0) for up: the camera has another up",
        Pose::UpAsV => "takes up for v: v = w x u is perpendicular to the view, and up need not be",
        Pose::SidesNotNormalized => {
            "does not normalize u: divide u = up x w by its length, and take v = w x u then"
        }
        Pose::BackNotNormalized => {
            "does not normalize w: divide it by its length, or d w is not d long"
        }
        Pose::OnlyRightNormalized => {
            "does not normalize w: divide it by its length before v = w x u and d w, which are too long otherwise"
        }
        Pose::NothingNormalized => {
            "does not normalize w and u: divide w by its length, then u = up x w by its length, and take v = w x u then"
        }
    }
}

/// The viewport, and every other one of the same size, if a camera tells.
pub(super) fn of_fields(field: Field, camera: Option<&Camera>) -> String {
    let others = camera.into_iter().flat_map(|camera| field.of_same_size(camera));
    let all = std::iter::once(field).chain(others);
    all.map(of_field).collect::<Vec<_>>().join("; or it ")
}

fn of_field(field: Field) -> &'static str {
    match field {
        Field::AsStated => "has the camera's viewport",
        Field::VerticalAsHorizontal => {
            "takes the vertical field of view for the horizontal one: its viewport is vh wide and vh H/W high"
        }
        Field::HorizontalAsVertical => {
            "takes the horizontal field of view for the vertical one: its viewport is vw high and vw W/H wide"
        }
        Field::AspectLeftOut => {
            "leaves out the form of the image: its viewport is vh wide as well; multiply x by W/H"
        }
        Field::HeightIsWidth => {
            "leaves out the form of the image: its viewport is vw high as well; multiply y by H/W"
        }
        Field::AspectInverted => {
            "has the form of the image upside down: it multiplies x by H/W for W/H"
        }
        Field::Double => {
            "has a viewport twice as wide and as high: half of vw and vh is missing (x goes from -vw/2 to vw/2)"
        }
        Field::Half => "has a viewport half as wide and as high: vw and vh are halved twice",
        Field::TangentOfWholeAngle => {
            "takes the tangent of the whole field of view for that of its half: vh = 2 d tan(fov/2)"
        }
        Field::TangentOfQuarterAngle => {
            "takes the tangent of a quarter of the field of view for that of its half: vh = 2 d tan(fov/2)"
        }
        Field::AngleForTangent => "takes the angle for its tangent: vh = 2 d tan(fov/2), not d fov",
        Field::DegreesAsRadians => {
            "takes the tangent of degrees where radians are meant: multiply the field of view by pi/180"
        }
        Field::VerticalAsDiagonal => {
            "takes the vertical field of view for that between two opposite corners: vh = 2 d tan(fov/2) is the height"
        }
        Field::HalfWidth => "has a viewport half as wide: vw is halved once too often",
        Field::HalfHeight => "has a viewport half as high: vh is halved once too often",
        Field::DoubleWidth => {
            "has a viewport twice as wide: half of vw is missing (x goes from -vw/2 to vw/2)"
        }
        Field::DoubleHeight => {
            "has a viewport twice as high: half of vh is missing (y goes from -vh/2 to vh/2)"
        }
        Field::Exchanged => "exchanges the sides of the viewport: it is vh wide and vw high",
        Field::DistanceLeftOut => {
            "takes 1 for the distance d of the viewport: the direction is x u + y v - d w"
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::CameraDescription;

    #[test]
    fn a_viewport_is_named_with_the_others_of_its_size_and_none_that_is_right() {
        let description =
            CameraDescription { distance: 2.0, image: [8, 8], ..CameraDescription::default() };
        let square =
            Camera::new(CameraDescription { viewport: [1.0, 1.0], ..description }).unwrap();
        let only = of_fields(Field::DistanceLeftOut, Some(&square));
        assert_eq!(only, of_field(Field::DistanceLeftOut));
        let wide = CameraDescription { viewport: [2.0, 1.0], image: [16, 8], ..description };
        let both = of_fields(Field::AspectLeftOut, Some(&Camera::new(wide).unwrap()));
        assert!(both.contains("; or it has a viewport half as wide: vw"), "{both}");
    }
}
