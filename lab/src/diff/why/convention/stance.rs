//! An eye and axes that no mistake of the list gives: the places of primitives in a file tell them.

use crate::common::glam::{DQuat, DVec3};
use crate::common::{Camera, CameraDescription, Orientation, Projection};

/// What of the eye and the axes of the camera is not as stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Moved {
    /// `u` and `v` are turned about `w`.
    Up,
    /// The direction of view is another one.
    Direction,
    /// All axes are others.
    Axes,
    /// The eye stands elsewhere, and looks in the same direction.
    Eye,
    /// The eye stands elsewhere, and looks at the same point. How far from it the eye of a parallel camera stands, no picture tells:
    /// as far as stated.
    EyeAroundTarget,
    /// The eye and all axes are others.
    All,
}

/// An eye and axes, `u`, `v` and `w`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    /// The eye, in the world.
    pub eye: DVec3,
    /// The axes of the camera: right, up and back, unit vectors.
    pub axes: [DVec3; 3],
    /// What of them is not as stated.
    pub moved: Moved,
    /// The number of the only object whose places tell it, of several in the scene: it alone may be moved.
    pub told_by: Option<usize>,
    /// Whether the contour of a mask alone tells it, which another field of view stretches much as another distance does.
    pub by_contour: bool,
}

impl Moved {
    /// What can be another with this camera, and shows as something else than a picture that is moved as a whole; but for
    /// [`Moved::All`].
    pub(in crate::diff::why) fn simple(stated: &Camera) -> Vec<Moved> {
        let mut all = vec![Moved::Up, Moved::Direction, Moved::Axes];
        if stated.projection() == Projection::Perspective {
            all.push(Moved::Eye);
        }
        if matches!(stated.description().orientation, Orientation::LookAt { .. }) {
            all.push(Moved::EyeAroundTarget);
        }
        all
    }

    /// Whether the eye may stand elsewhere.
    pub(in crate::diff::why) fn is_of_eye(self) -> bool {
        matches!(self, Moved::Eye | Moved::EyeAroundTarget | Moved::All)
    }

    /// In how many ways the stance can be another.
    pub(in crate::diff::why) fn freedom(self, projection: Projection) -> usize {
        match self {
            Moved::Up => 1,
            Moved::EyeAroundTarget if projection == Projection::Parallel => 2,
            Moved::Direction => 2,
            Moved::Axes | Moved::Eye | Moved::EyeAroundTarget => 3,
            Moved::All => 6,
        }
    }
}

impl Stance {
    /// The stance of a camera, from which something of it will be moved.
    pub(in crate::diff::why) fn stated(camera: &Camera, moved: Moved) -> Stance {
        let axes = [camera.u(), camera.v(), camera.w()];
        Stance { eye: camera.eye().as_dvec3(), axes, moved, told_by: None, by_contour: false }
    }

    /// The stance a step farther in each of its ways: along `u`, `v` and `w` in units of a length of the scene, and turned
    /// about them by radians. `None` if the eye comes to the point that it looks at.
    pub(in crate::diff::why) fn after(
        self,
        step: &[f64],
        length: f64,
        stated: &Camera,
    ) -> Option<Stance> {
        let axes @ [u, v, w] = self.axes;
        let turned = |by: DVec3| {
            let turn = DQuat::from_scaled_axis(by);
            axes.map(|axis| (turn * axis).normalize())
        };
        let along =
            |by: &[f64]| length * (by.iter().zip(axes).map(|(by, axis)| *by * axis).sum::<DVec3>());
        Some(match self.moved {
            Moved::Up => Stance { axes: turned(step[0] * w), ..self },
            Moved::Direction => {
                let axes = turned(step[0] * u + step[1] * v);
                Stance { axes: upright(axes[2], stated).unwrap_or(axes), ..self }
            }
            Moved::Axes => Stance { axes: turned(step[0] * u + step[1] * v + step[2] * w), ..self },
            Moved::Eye => Stance { eye: self.eye + along(step), ..self },
            Moved::EyeAroundTarget => {
                let target = target(stated)?;
                let from_target = self.eye + along(step) - target;
                let back = from_target.try_normalize()?;
                let eye = match stated.projection() {
                    Projection::Perspective => target + from_target,
                    Projection::Parallel => {
                        target + back * (stated.eye().as_dvec3() - target).length()
                    }
                };
                Stance { eye, axes: upright(back, stated)?, ..self }
            }
            Moved::All => {
                let about = step[3] * u + step[4] * v + step[5] * w;
                Stance { eye: self.eye + along(&step[..3]), axes: turned(about), ..self }
            }
        })
    }

    /// The stated camera with this eye and these axes.
    pub(in crate::diff::why) fn description(&self, stated: &Camera) -> CameraDescription {
        let description = *stated.description();
        CameraDescription { eye: self.eye.as_vec3(), orientation: frame(self.axes), ..description }
    }

    /// Where a point of the world is seen: columns to the right and rows down from the middle of the image, and its depth along
    /// the axis. `None` if it does not lie in front of the eye of a perspective camera.
    pub(in crate::diff::why) fn place(&self, point: DVec3, stated: &Camera) -> Option<[f64; 3]> {
        let offset = point - self.eye;
        let [x, y, z] = self.axes.map(|axis| axis.dot(offset));
        let depth = -z;
        let scale = match stated.projection() {
            Projection::Perspective => (depth > 0.0).then(|| stated.distance() / depth)?,
            Projection::Parallel => 1.0,
        };
        let ([vw, vh], [width, height]) = (stated.viewport(), stated.image().map(f64::from));
        Some([x * scale * width / vw, -y * scale * height / vh, depth])
    }

    /// The point of the world that is seen at a place, as [`Stance::place`] gives it.
    pub(in crate::diff::why) fn point(&self, [x, y, depth]: [f64; 3], stated: &Camera) -> DVec3 {
        let scale = match stated.projection() {
            Projection::Perspective => depth / stated.distance(),
            Projection::Parallel => 1.0,
        };
        let ([vw, vh], [width, height]) = (stated.viewport(), stated.image().map(f64::from));
        let [u, v, w] = self.axes;
        self.eye + x * vw / width * scale * u - y * vh / height * scale * v - depth * w
    }

    /// The angle in degrees by which `v` is turned to the left from that of the camera, where `w` is the same.
    pub(in crate::diff::why) fn roll(&self, stated: &Camera) -> f64 {
        let v = self.axes[1];
        f64::atan2(-v.dot(stated.u()), v.dot(stated.v())).to_degrees()
    }

    /// Whether it is held otherwise than the camera's `up` would hold it in its direction of view, by a degree or more.
    pub(in crate::diff::why) fn has_another_up(&self, stated: &Camera) -> bool {
        let upright = upright(self.axes[2], stated);
        upright.is_some_and(|[u, ..]| u.dot(self.axes[0]) < f64::to_radians(1.0).cos())
    }
}

/// Axes as a camera takes them.
pub(super) fn frame(axes: [DVec3; 3]) -> Orientation {
    let [u, v, w] = axes.map(DVec3::as_vec3);
    Orientation::Frame { u, v, w }
}

fn target(stated: &Camera) -> Option<DVec3> {
    match stated.description().orientation {
        Orientation::LookAt { target, .. } => Some(target.as_dvec3()),
        _ => None,
    }
}

/// The axes with this `w` that the camera's `up` gives; `None` where it has none, or where it lies along the view.
fn upright(w: DVec3, stated: &Camera) -> Option<[DVec3; 3]> {
    let up = match stated.description().orientation {
        Orientation::LookAt { up, .. } | Orientation::Direction { up, .. } => up.as_dvec3(),
        Orientation::Frame { .. } => return None,
    };
    let u = up.cross(w).try_normalize()?;
    Some([u, w.cross(u), w])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::View;
    use crate::common::glam::Vec3;
    use crate::diff::why::convention::tilted_camera;

    #[test]
    fn a_place_is_where_the_ray_of_the_pixel_goes() {
        for projection in [Projection::Perspective, Projection::Parallel] {
            let camera = tilted_camera(projection);
            let stance = Stance::stated(&camera, Moved::All);
            for (i, j) in [(0, 0), (2, 7), (5, 3)] {
                let ray = camera.viewing_ray(i, j);
                let point = stance.eye + ray.origin + 3.0 * ray.direction;
                let [x, y, depth] = stance.place(point, &camera).unwrap();
                assert!((x - (f64::from(j) + 0.5 - 4.0)).abs() < 1e-9, "{x}");
                assert!((y - (f64::from(i) + 0.5 - 3.0)).abs() < 1e-9, "{y}");
                assert!((depth + camera.w().dot(point - stance.eye)).abs() < 1e-9);
                assert!(stance.point([x, y, depth], &camera).abs_diff_eq(point, 1e-9));
            }
        }
        let behind = tilted_camera(Projection::Perspective);
        let stance = Stance::stated(&behind, Moved::All);
        assert_eq!(stance.place(stance.eye + behind.w(), &behind), None);
    }

    #[test]
    fn a_step_moves_what_it_says() {
        let camera = tilted_camera(Projection::Perspective);
        let [u, v, w] = [camera.u(), camera.v(), camera.w()];
        let step = |moved: Moved, step: &[f64]| {
            Stance::stated(&camera, moved).after(step, 2.0, &camera).unwrap()
        };
        let eye = camera.eye().as_dvec3();
        let rolled = step(Moved::Up, &[0.1]);
        assert!(rolled.axes[2].abs_diff_eq(w, 1e-15) && rolled.eye == eye);
        assert!((rolled.roll(&camera) - 0.1_f64.to_degrees()).abs() < 1e-9);
        let turned = step(Moved::Direction, &[0.0, 0.1]);
        assert!((turned.axes[2].dot(w) - 0.1_f64.cos()).abs() < 1e-9 && turned.eye == eye);
        let moved = step(Moved::Eye, &[0.5, 0.0, -0.25]);
        assert!(moved.eye.abs_diff_eq(eye + u - 0.5 * w, 1e-14) && moved.axes == [u, v, w]);
        let around = step(Moved::EyeAroundTarget, &[0.5, 0.0, -0.25]);
        // The camera that states this eye has these axes.
        let stated = CameraDescription { eye: around.eye.as_vec3(), ..*camera.description() };
        let stated = Camera::new(stated).unwrap();
        for (one, other) in around.axes.into_iter().zip([stated.u(), stated.v(), stated.w()]) {
            assert!(one.abs_diff_eq(other, 1e-6), "{one} {other}");
        }
        let all = step(Moved::All, &[0.5, 0.0, 0.0, 0.0, 0.0, 0.1]);
        assert!(all.eye.abs_diff_eq(eye + u, 1e-14) && all.axes == rolled.axes);
        // The camera of a stance sees from there.
        let seen = Camera::new(all.description(&camera)).unwrap();
        let scene = crate::common::Scene::new(Vec::new()).unwrap();
        let offset = View::new(&scene, &seen).offset(Vec3::ZERO);
        assert!(offset.abs_diff_eq(-all.eye, 1e-6));
    }
}
