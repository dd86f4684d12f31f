//! Where the eye is, and how the axes of the camera lie.

use super::stance::{Stance, frame};
use crate::common::glam::{DVec3, Vec3};
use crate::common::{Camera, CameraDescription, Orientation, Projection};

/// The eye and the axes of the camera, `u`, `v` and `w`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Pose {
    /// The camera's.
    #[default]
    AsStated,
    /// The eye is the origin of the world.
    EyeLeftOut,
    /// The eye is added to each vertex where it should be subtracted.
    EyeAdded,
    /// Vertices are turned first, and the eye is subtracted then.
    EyeAfterTurn,
    /// `u`, `v` and `w` are the axes of the world.
    AxesLeftOut,
    /// The rotation of the camera has its rows and columns exchanged.
    AxesExchanged,
    /// The matrix from the camera to the world is taken for its inverse.
    MatrixNotInverted,
    /// The point to look at is taken for the direction of view.
    TargetAsDirection,
    /// The direction of view is taken for a point to look at.
    DirectionAsTarget,
    /// The eye stands at the point to look at, and looks at the eye.
    EyeAndTargetExchanged,
    /// `(0, 1, 0)` is taken for `up`.
    UpLeftOut,
    /// `up` is taken for `v`, although it is not perpendicular to the view.
    UpAsV,
    /// `u = up × w` has not unit length, and so has not `v = w × u`.
    SidesNotNormalized,
    /// `w` has the length of the direction of view, `u` and `v` have unit length.
    BackNotNormalized,
    /// `w` and `v = w × u` have the length of the direction of view.
    OnlyRightNormalized,
    /// No axis has unit length.
    NothingNormalized,
    /// Others, for which no reason is known: the file tells them.
    Measured(Stance),
}

impl Pose {
    /// All poses that have a reason, ours first.
    pub const ALL: [Pose; 16] = [
        Pose::AsStated,
        Pose::EyeLeftOut,
        Pose::EyeAdded,
        Pose::EyeAfterTurn,
        Pose::AxesLeftOut,
        Pose::AxesExchanged,
        Pose::MatrixNotInverted,
        Pose::TargetAsDirection,
        Pose::DirectionAsTarget,
        Pose::EyeAndTargetExchanged,
        Pose::UpLeftOut,
        Pose::UpAsV,
        Pose::SidesNotNormalized,
        Pose::BackNotNormalized,
        Pose::OnlyRightNormalized,
        Pose::NothingNormalized,
    ];

    /// The camera of a renderer that has this pose; `None` if it cannot have it, or no camera can.
    ///
    /// Axes that are not of unit length are those of a camera with another viewport or another distance.
    pub fn camera(self, stated: &Camera) -> Option<Camera> {
        let with = match self {
            Pose::AsStated => *stated.description(),
            Pose::Measured(stance) => stance.description(stated),
            Pose::EyeLeftOut
            | Pose::EyeAdded
            | Pose::EyeAfterTurn
            | Pose::AxesLeftOut
            | Pose::AxesExchanged
            | Pose::MatrixNotInverted => self.of_matrix(stated),
            Pose::TargetAsDirection
            | Pose::DirectionAsTarget
            | Pose::EyeAndTargetExchanged
            | Pose::UpLeftOut => self.of_words(stated.description())?,
            Pose::UpAsV
            | Pose::SidesNotNormalized
            | Pose::BackNotNormalized
            | Pose::OnlyRightNormalized
            | Pose::NothingNormalized => self.of_axes(stated)?,
        };
        Camera::new(with).ok()
    }

    /// The camera of a renderer that has another eye or other axes, as a wrong matrix makes them; of all other poses the
    /// stated one.
    fn of_matrix(self, stated: &Camera) -> CameraDescription {
        let description = *stated.description();
        let eye = description.eye.as_dvec3();
        let axes @ [u, v, w] = [stated.u(), stated.v(), stated.w()];
        let exchanged =
            [DVec3::new(u.x, v.x, w.x), DVec3::new(u.y, v.y, w.y), DVec3::new(u.z, v.z, w.z)];
        let (eye, axes) = match self {
            Pose::EyeLeftOut => (DVec3::ZERO, axes),
            Pose::EyeAdded => (-eye, axes),
            Pose::EyeAfterTurn => (eye.x * u + eye.y * v + eye.z * w, axes),
            Pose::AxesLeftOut => (eye, [DVec3::X, DVec3::Y, DVec3::Z]),
            Pose::AxesExchanged => (eye, exchanged),
            Pose::MatrixNotInverted => (-DVec3::new(u.dot(eye), v.dot(eye), w.dot(eye)), exchanged),
            _ => return description,
        };
        CameraDescription { eye: eye.as_vec3(), orientation: frame(axes), ..description }
    }

    /// The camera of a renderer that takes one word of the scene file for another; `None` if the file has not that word.
    fn of_words(self, description: &CameraDescription) -> Option<CameraDescription> {
        use Orientation::{Direction, LookAt};
        let eye = description.eye;
        let (eye, orientation) = match (self, description.orientation) {
            (Pose::TargetAsDirection, LookAt { target, up }) => {
                (eye, Direction { direction: target, up })
            }
            (Pose::DirectionAsTarget, Direction { direction, up }) => {
                (eye, LookAt { target: direction, up })
            }
            (Pose::EyeAndTargetExchanged, LookAt { target, up }) => {
                (target, LookAt { target: eye, up })
            }
            (Pose::UpLeftOut, LookAt { target, .. }) => (eye, LookAt { target, up: Vec3::Y }),
            (Pose::UpLeftOut, Direction { direction, .. }) => {
                (eye, Direction { direction, up: Vec3::Y })
            }
            _ => return None,
        };
        Some(CameraDescription { eye, orientation, ..*description })
    }

    /// The camera of a renderer whose axes are not perpendicular or not of unit length; `None` if the scene file gives
    /// the axes themselves.
    fn of_axes(self, stated: &Camera) -> Option<CameraDescription> {
        let [along, across] = lengths(stated)?;
        let description = *stated.description();
        let scaled = |[x, y]: [f64; 2], depth: f64| {
            let [vw, vh] = stated.viewport();
            let (viewport, distance) = ([vw * x, vh * y], stated.distance() * depth);
            CameraDescription {
                viewport: viewport.map(rounded),
                distance: rounded(distance),
                ..description
            }
        };
        match self {
            Pose::UpAsV if description.projection == Projection::Perspective => {
                let (u, up) = (stated.u(), unit_up(&description)?);
                let back = u.cross(up);
                let orientation = frame([u, up, back]);
                Some(CameraDescription { orientation, ..scaled([1.0, 1.0], back.dot(stated.w())) })
            }
            Pose::SidesNotNormalized => Some(scaled([across, across], 1.0)),
            Pose::BackNotNormalized => Some(scaled([1.0, 1.0], along)),
            Pose::OnlyRightNormalized => Some(scaled([1.0, along], along)),
            Pose::NothingNormalized => {
                Some(scaled([along * across, along * along * across], along))
            }
            _ => None,
        }
    }

    /// By how much the middle of the viewport lies above the axis of the camera that [`camera`](Pose::camera) gives.
    pub(in crate::diff::why) fn rise(self, stated: &Camera) -> f64 {
        let up = if self == Pose::UpAsV { unit_up(stated.description()) } else { None };
        // The viewport is spanned by `u` and `up`, and its middle is the eye − d·w.
        up.map_or(0.0, |up| -stated.distance() * stated.w().dot(up))
    }
}

/// The poses that a renderer of this camera can take by mistake, and that are not the stated one.
pub(super) fn poses(stated: &Camera) -> Vec<Pose> {
    let is_another = |camera: Camera| {
        let is_near = |one: f64, other: f64| (one - other).abs() <= 1e-6 * other.abs().max(1e-3);
        let [[a, b], [c, d]] = [&camera, stated].map(Camera::viewport);
        let is_perspective = stated.projection() == Projection::Perspective;
        let axes = |camera: &Camera| [camera.u(), camera.v(), camera.w()];
        let turns = axes(&camera).into_iter().zip(axes(stated));
        camera.eye() != stated.eye()
            || turns.into_iter().any(|(one, other)| !one.abs_diff_eq(other, 1e-6))
            || !(is_near(a, c) && is_near(b, d))
            || (is_perspective && !is_near(camera.distance(), stated.distance()))
    };
    let others = Pose::ALL.into_iter().filter(|&pose| pose != Pose::AsStated);
    others.filter(|pose| pose.camera(stated).is_some_and(is_another)).collect()
}

/// `up` with unit length, where the camera has one.
fn unit_up(description: &CameraDescription) -> Option<DVec3> {
    let up = match description.orientation {
        Orientation::LookAt { up, .. } | Orientation::Direction { up, .. } => up,
        Orientation::Frame { .. } => return None,
    };
    Some(up.as_dvec3().normalize())
}

/// The lengths of the direction of view and of `up × w`, where they follow from a direction and `up` as they are given.
fn lengths(stated: &Camera) -> Option<[f64; 2]> {
    let CameraDescription { eye, orientation, .. } = *stated.description();
    let (direction, up) = match orientation {
        Orientation::LookAt { target, up } => (target.as_dvec3() - eye.as_dvec3(), up),
        Orientation::Direction { direction, up } => (direction.as_dvec3(), up),
        Orientation::Frame { .. } => return None,
    };
    Some([direction.length(), up.as_dvec3().cross(stated.w()).length()])
}

#[expect(clippy::cast_possible_truncation, reason = "the camera stores f32, and checks its range")]
fn rounded(value: f64) -> f32 {
    value as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diff::why::convention::{Change, Convention, tilted_camera};
    use crate::diff::why::rays::ViewingRays;

    fn is_near(one: DVec3, other: DVec3) -> bool {
        (one - other).length() <= 1e-6 * one.length().max(1.0)
    }

    /// The axes that a renderer makes of the direction of view, with unit length or without.
    #[test]
    fn axes_that_are_not_normalized_make_the_rays_of_their_formula() {
        let camera = tilted_camera(Projection::Perspective);
        let Orientation::LookAt { target, up } = camera.description().orientation else { panic!() };
        let (up, back) = (up.as_dvec3(), (camera.eye() - target).as_dvec3());
        let (w, u) = (back.normalize(), up.cross(back).normalize());
        let (long_u, longest_u) = (up.cross(w), up.cross(back));
        for (pose, [u, v, w]) in [
            (Pose::AsStated, [u, w.cross(u), w]),
            (Pose::UpAsV, [u, up.normalize(), w]),
            (Pose::SidesNotNormalized, [long_u, w.cross(long_u), w]),
            (Pose::BackNotNormalized, [u, w.cross(u), back]),
            (Pose::OnlyRightNormalized, [u, back.cross(u), back]),
            (Pose::NothingNormalized, [longest_u, back.cross(longest_u), back]),
        ] {
            let convention = Convention::default().with(Change::Pose(pose));
            let rays = ViewingRays::new(&camera, &convention);
            for (i, j) in [(0_u32, 0_u32), (5, 0), (2, 7)] {
                let x = 2.0 * ((f64::from(j) + 0.5) / 8.0 - 0.5);
                let y = -1.5 * ((f64::from(i) + 0.5) / 6.0 - 0.5);
                let direction = rays.ray(i as usize, j as usize).direction;
                let expected = x * u + y * v - 1.5 * w;
                assert!(is_near(direction, expected), "{pose:?} {direction} {expected}");
            }
        }
    }

    /// A renderer that multiplies vertices by a matrix: the camera of the pose sees them where the matrix puts them.
    #[test]
    fn a_wrong_matrix_puts_vertices_where_the_camera_of_its_pose_sees_them() {
        for projection in [Projection::Perspective, Projection::Parallel] {
            let camera = tilted_camera(projection);
            let (eye, [u, v, w]) = (camera.eye().as_dvec3(), [camera.u(), camera.v(), camera.w()]);
            let by_rows = |p: DVec3| DVec3::new(u.dot(p), v.dot(p), w.dot(p));
            let by_columns = |p: DVec3| p.x * u + p.y * v + p.z * w;
            let p = DVec3::new(-0.75, 0.5, -2.25);
            for (pose, put) in [
                (Pose::AsStated, by_rows(p - eye)),
                (Pose::EyeLeftOut, by_rows(p)),
                (Pose::EyeAdded, by_rows(p + eye)),
                (Pose::EyeAfterTurn, by_rows(p) - eye),
                (Pose::AxesLeftOut, p - eye),
                (Pose::AxesExchanged, by_columns(p - eye)),
                (Pose::MatrixNotInverted, by_columns(p) + eye),
            ] {
                let camera = pose.camera(&camera).unwrap();
                let offset = p - camera.eye().as_dvec3();
                let seen = DVec3::new(
                    camera.u().dot(offset),
                    camera.v().dot(offset),
                    camera.w().dot(offset),
                );
                assert!(is_near(seen, put), "{pose:?} {seen} {put}");
            }
        }
    }

    #[test]
    fn the_canonical_camera_has_no_pose_to_confuse() {
        assert_eq!(poses(&Camera::canonical(4, 4)), []);
    }

    #[test]
    fn poses_are_those_that_the_camera_s_words_allow() {
        let camera = tilted_camera(Projection::Parallel);
        let found = poses(&camera);
        // The distance is nothing to parallel rays, and `up` for `v` no camera of ours.
        let never = [Pose::DirectionAsTarget, Pose::UpAsV, Pose::BackNotNormalized];
        let expected = Pose::ALL[1..].iter().filter(|pose| !never.contains(pose));
        assert_eq!(found, expected.copied().collect::<Vec<_>>());
    }
}
