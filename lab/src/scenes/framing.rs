//! A camera that shows all of a mesh of any size and in any place.

use crate::common::glam::{DVec3, Vec3};
use crate::common::scene::Placement;
use crate::common::{CameraDescription, Mesh, Orientation, Shape};
use crate::wording::readable;
use rayon::prelude::*;
use std::collections::HashMap;

/// The reason why no camera frames a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FrameMeshError {
    /// The mesh has no triangle.
    #[error("there is no triangle to frame")]
    Empty,
    /// The mesh has no size.
    #[error("all triangles lie in one point, so no camera can frame them")]
    Point,
    /// The position of the eye would exceed the range of `f32`.
    #[error(
        "the triangles reach over {}, too far for a camera that sees them all; \
         scale them down in a scene file",
        about(*.diagonal)
    )]
    TooLarge {
        /// The diagonal of the triangles' bounding box.
        diagonal: f64,
    },
    /// The triangles are so small relative to their distance from the origin that rounding moves the eye among them.
    #[error(
        "the triangles reach over {} only, too little for the numbers around them; \
         move them to the origin or scale them up in a scene file",
        about(*.diagonal)
    )]
    TooSmall {
        /// The diagonal of the triangles' bounding box.
        diagonal: f64,
    },
}

/// The first three digits of a length.
fn about(length: f64) -> String {
    readable::<f64>(format!("{length:.2e}").parse().expect("a number is written as a number"))
}

/// The view for framing a mesh: the direction, and the image.
///
/// ```
/// use bothways_lab::common::{Camera, glam::Vec3};
/// use bothways_lab::formats::generate::Kind;
/// use bothways_lab::scenes::Framing;
///
/// let teapot = Kind::Teapot.mesh([10, 10])?;
/// let from_above = Framing {
///     towards_eye: Vec3::new(0.0, 3.0, 1.0),
///     image: [1920, 1080],
///     ..Framing::default()
/// };
/// let camera = Camera::new(from_above.camera(&teapot)?)?;
/// assert!(camera.eye().y > 3.15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framing {
    /// The direction from the mesh to the eye; its length does not matter.
    pub towards_eye: Vec3,
    /// The up direction of the picture: any direction that is not along the view.
    pub up: Vec3,
    /// The image's width and height in pixels; the viewport gets the same aspect ratio, and has height 1.
    pub image: [u32; 2],
    /// `d`, the distance from the eye to the viewport.
    pub distance: f32,
    /// The part of the picture's width or height that the mesh fills; the tighter of the two decides.
    pub filled: f64,
}

impl Default for Framing {
    /// A view from the right, above and in front, for a 640 × 480 image, with a focal length that is a little longer
    /// than that of the human eye, as for a portrait.
    fn default() -> Self {
        Framing {
            towards_eye: Vec3::new(1.0, 0.7, 1.5),
            up: Vec3::Y,
            image: [640, 480],
            distance: 2.2,
            filled: 0.92,
        }
    }
}

/// The part of half the picture that a mesh fills at most after a change to a parallel projection.
const FILLED_IN_PARALLEL: f64 = 0.98;

/// The most steps of the search for the middle; few meshes take more than three steps.
const MOST_STEPS: u32 = 16;

/// The most positions that are looked at one by one, several times.
const MOST_POSITIONS: usize = 1 << 24;

/// A camera that looks at a mesh from a little above and sees the whole mesh, in the middle of a 640 × 480 image.
///
/// # Errors
///
/// The errors of [`Framing::camera`].
///
/// ```
/// use bothways_lab::common::Camera;
/// use bothways_lab::formats::generate::Kind;
///
/// let torus = Kind::Torus.mesh([24, 12])?;
/// let camera = Camera::new(bothways_lab::scenes::framed(&torus)?)?;
/// assert_eq!(camera.image(), [640, 480]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn framed(mesh: &Mesh) -> Result<CameraDescription, FrameMeshError> {
    Framing::default().camera(mesh)
}

impl Framing {
    /// The camera that sees the whole mesh in the middle of the picture. Only the vertices that triangles use count.
    ///
    /// # Errors
    ///
    /// An error for a mesh without triangles or without size, or for a camera beyond the range of `f32`.
    ///
    /// # Panics
    ///
    /// If `up` runs along `towards_eye`, a side of the image is 0, or `distance` or `filled` is not positive.
    pub fn camera(&self, mesh: &Mesh) -> Result<CameraDescription, FrameMeshError> {
        let used = used_vertices(mesh);
        let parts = || {
            let parts = mesh.positions().par_chunks(PART).zip(used.par_chunks(PART));
            parts.map(|(positions, used)| {
                let all = positions.iter().zip(used).filter(|(_, used)| **used);
                all.map(|(position, _)| position.as_dvec3())
            })
        };
        // The greatest of all parts does not depend on the threads that work on them.
        self.camera_around(
            parts().filter_map(bounds).reduce_with(around),
            |axes, slopes, center| {
                let reaches = parts().map(|points| reach(axes, slopes, points.map(|p| p - center)));
                reaches.reduce(|| NOWHERE, farther)
            },
        )
    }

    /// The camera that sees all of these positions in the middle of the picture: those that a mesh's triangles use, each
    /// at least once. The function iterates over the positions several times.
    ///
    /// # Errors
    ///
    /// The errors of [`camera`](Framing::camera).
    ///
    /// # Panics
    ///
    /// In the cases of [`camera`](Framing::camera).
    pub fn camera_of(
        &self,
        positions: impl Iterator<Item = Vec3> + Clone,
    ) -> Result<CameraDescription, FrameMeshError> {
        let points = positions.map(|position| position.as_dvec3());
        self.camera_around(bounds(points.clone()), |axes, slopes, center| {
            reach(axes, slopes, points.clone().map(|point| point - center))
        })
    }

    /// The camera that sees all of these meshes and instances in the middle of the picture.
    ///
    /// Of very many vertices, those of each instance are replaced by the corners of the box around its mesh.
    ///
    /// # Errors
    ///
    /// The errors of [`camera`](Framing::camera).
    ///
    /// # Panics
    ///
    /// In the cases of [`camera`](Framing::camera).
    pub fn camera_of_shapes(&self, shapes: &[Shape]) -> Result<CameraDescription, FrameMeshError> {
        if let [Shape::Mesh(mesh)] = shapes {
            return self.camera(mesh);
        }
        // Once for each mesh, however many instances share it.
        let mut known: HashMap<*const Mesh, Vec<Vec3>> = HashMap::new();
        let mut placed = 0_usize;
        for shape in shapes {
            if let Some(mesh) = shape.mesh() {
                let used =
                    known.entry(std::ptr::from_ref(mesh)).or_insert_with(|| used_positions(mesh));
                let instances = places(shape).len();
                placed = placed.saturating_add(used.len().saturating_mul(instances));
            }
        }
        if placed > MOST_POSITIONS {
            known.values_mut().for_each(|used| *used = corners_of_box(used));
        }
        let positions = shapes.iter().flat_map(|shape| {
            let used = shape.mesh().map_or(&[][..], |mesh| &known[&std::ptr::from_ref(mesh)]);
            places(shape)
                .iter()
                .flat_map(|place| used.iter().map(|position| place.position(*position)))
        });
        self.camera_of(positions)
    }

    /// The camera for a mesh with these bounds. `reach` is [`reach`] for the mesh, seen from a center.
    fn camera_around(
        &self,
        bounds: Option<(DVec3, DVec3)>,
        reach: impl Fn(&[DVec3; 3], [f64; 2], DVec3) -> Reach,
    ) -> Result<CameraDescription, FrameMeshError> {
        let (low, high) = bounds.ok_or(FrameMeshError::Empty)?;
        let (center, diagonal) = (0.5 * (low + high), (high - low).length());
        if diagonal == 0.0 {
            return Err(FrameMeshError::Point);
        }
        let axes = self.axes();
        let place = self.place_of_eye(diagonal, |slopes| reach(&axes, slopes, center));
        let [u, v, w] = axes;
        // The point in the middle of the picture, as far away as the middle of the mesh.
        let middle = center + place.x * u + place.y * v;
        let (eye, target) = ((middle + place.z * w).as_vec3(), middle.as_vec3());
        if !eye.is_finite() {
            return Err(FrameMeshError::TooLarge { diagonal });
        }
        // If the distance between neighbouring f32 numbers is more than the width of the mesh, rounding moves both
        // points to other places.
        let away = (eye.as_dvec3() - target.as_dvec3()).length();
        if (away / place.z - 1.0).abs() > 0.01 {
            return Err(FrameMeshError::TooSmall { diagonal });
        }
        Ok(CameraDescription {
            eye,
            orientation: Orientation::LookAt { target, up: self.up },
            distance: self.distance,
            viewport: [self.image[0] as f32 / self.image[1] as f32, 1.0],
            image: self.image,
            ..CameraDescription::default()
        })
    }

    /// The axes `u`, `v` and `w`.
    fn axes(&self) -> [DVec3; 3] {
        let w = self.towards_eye.as_dvec3().normalize();
        let u = self.up.as_dvec3().cross(w).normalize();
        assert!(u.is_finite(), "up runs along towards_eye, or one of them has no length");
        [u, w.cross(u), w]
    }

    /// The position of the eye relative to the middle of the mesh, along the axes.
    ///
    /// A point at (x, y, z) along the axes is seen within ±s of the viewport's half width, at distance 1, from an eye
    /// at (X, Y, Z) if x + s·z ≤ X + s·Z and −x + s·z ≤ −X + s·Z. Of all points only the greatest left sides count, A
    /// and B: there is such an X if A + B ≤ 2·s·Z, and both sides touch the margin if they are equal and
    /// X = (A − B)/2. So it is with the height.
    ///
    /// From this position, a parallel projection also shows the whole mesh, although it shows distant parts larger.
    fn place_of_eye(&self, diagonal: f64, reach: impl Fn([f64; 2]) -> Reach) -> DVec3 {
        let [width, height] = self.image.map(f64::from);
        let lens = 2.0 * f64::from(self.distance);
        let half = [width / height / lens, 1.0 / lens];
        let slopes = half.map(|half| self.filled * half);
        let [across, down] = [0, 1].map(|axis| {
            let [right, left] = reach(slopes)[axis];
            (right + left) / (2.0 * slopes[axis])
        });
        // A needle that points at the eye has no width in the picture, but has a length.
        let mut away = across.max(down).max(diagonal);
        let flat = reach([0.0; 2]);
        for _ in 0..MOST_STEPS {
            let place = in_the_middle(away, slopes, &half, &reach);
            let parallel = [0, 1].map(|axis| {
                let [right, left] = flat[axis];
                (right - place[axis]).max(left + place[axis]) / (FILLED_IN_PARALLEL * half[axis])
            });
            let needed = parallel[0].max(parallel[1]);
            if needed <= away {
                return DVec3::new(place[0], place[1], away);
            }
            // A factor slightly above 1, so that the loop ends.
            away = needed * 1.001;
        }
        let place = in_the_middle(away, slopes, &half, &reach);
        DVec3::new(place[0], place[1], away)
    }
}

/// The coordinates of the eye along `u` and `v`, at a distance at which a mesh fits within these slopes, with equal
/// free space on both sides.
///
/// At least one of the two sides is not tight. The slope at which that side would be tight is a fixed point. The
/// mesh's part of the distance is the factor by which each step reduces the distance to the fixed point.
fn in_the_middle(
    away: f64,
    slopes: [f64; 2],
    half: &[f64; 2],
    reach: impl Fn([f64; 2]) -> Reach,
) -> [f64; 2] {
    let mut tight = slopes;
    for _ in 0..MOST_STEPS {
        let next = reach(tight).map(|[right, left]| (right + left) / (2.0 * away));
        let moved = |axis: usize| (next[axis] - tight[axis]).abs() > 1e-3 * half[axis];
        let is_moving = moved(0) || moved(1);
        tight = next;
        if !is_moving {
            break;
        }
    }
    reach(tight).map(|[right, left]| 0.5 * (right - left))
}

/// For `u` and for `v` with their slopes, the greatest of x + s·z and of −x + s·z of some points.
type Reach = [[f64; 2]; 2];

/// The reach of no point.
const NOWHERE: Reach = [[f64::NEG_INFINITY; 2]; 2];

fn reach([u, v, w]: &[DVec3; 3], slopes: [f64; 2], points: impl Iterator<Item = DVec3>) -> Reach {
    points.fold(NOWHERE, |most, point| {
        let (x, y, z) = (point.dot(*u), point.dot(*v), point.dot(*w));
        let [across, down] = slopes.map(|slope| slope * z);
        farther(most, [[x + across, -x + across], [y + down, -y + down]])
    })
}

/// The reach of the points of both.
fn farther(a: Reach, b: Reach) -> Reach {
    [0, 1].map(|axis| [0, 1].map(|side| a[axis][side].max(b[axis][side])))
}

/// The least and the greatest coordinates of the points.
fn bounds(points: impl Iterator<Item = DVec3>) -> Option<(DVec3, DVec3)> {
    points.map(|p| (p, p)).reduce(around)
}

/// The bounds of both.
fn around(a: (DVec3, DVec3), b: (DVec3, DVec3)) -> (DVec3, DVec3) {
    (a.0.min(b.0), a.1.max(b.1))
}

/// The positions that triangles use.
fn used_positions(mesh: &Mesh) -> Vec<Vec3> {
    let used = used_vertices(mesh);
    let all = mesh.positions().iter().zip(&used).filter(|(_, used)| **used);
    all.map(|(position, _)| *position).collect()
}

/// Where a shape's mesh is.
fn places(shape: &Shape) -> &[Placement] {
    match shape {
        Shape::Instances(instances) => instances.placements(),
        _ => &[Placement::IDENTITY],
    }
}

/// The corners of the box around some positions.
fn corners_of_box(positions: &[Vec3]) -> Vec<Vec3> {
    let Some(&first) = positions.first() else { return Vec::new() };
    let around =
        |[low, high]: [Vec3; 2], position: &Vec3| [low.min(*position), high.max(*position)];
    let sides = positions.iter().fold([first; 2], around);
    let corner = |k: usize| Vec3::new(sides[k & 1].x, sides[k >> 1 & 1].y, sides[k >> 2].z);
    (0..8).map(corner).collect()
}

/// For each vertex of a mesh, whether a triangle uses it.
fn used_vertices(mesh: &Mesh) -> Vec<bool> {
    let mut used = vec![false; mesh.positions().len()];
    for &vertex in mesh.triangles().iter().flatten() {
        used[vertex as usize] = true;
    }
    used
}

/// The number of vertices that one thread looks at in one go.
const PART: usize = 1 << 14;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{Camera, Projection};
    use crate::formats::generate::Kind;

    fn corners(corners: &[[f32; 3]]) -> Mesh {
        let positions = corners.iter().copied().map(Vec3::from_array).collect();
        Mesh::new(positions, vec![[0, 1, 2]]).unwrap()
    }

    /// The parts of the viewport's half width and half height that a mesh fills: left, right, below, above.
    fn sides(mesh: &Mesh, description: CameraDescription) -> [f64; 4] {
        let camera = Camera::new(description).unwrap();
        let half = camera.viewport().map(|side| side / 2.0);
        let mut sides = [f64::NEG_INFINITY; 4];
        for &vertex in mesh.triangles().iter().flatten() {
            let p = mesh.positions()[vertex as usize].as_dvec3() - camera.eye().as_dvec3();
            let scale = match camera.projection() {
                Projection::Perspective => camera.distance() / -p.dot(camera.w()),
                Projection::Parallel => 1.0,
            };
            assert!(scale > 0.0);
            let [x, y] = [p.dot(camera.u()) * scale / half[0], p.dot(camera.v()) * scale / half[1]];
            for (side, here) in sides.iter_mut().zip([-x, x, -y, y]) {
                *side = side.max(here);
            }
        }
        sides
    }

    /// The camera that `--projection parallel` makes.
    fn parallel(camera: CameraDescription) -> CameraDescription {
        let Orientation::LookAt { target, .. } = camera.orientation else { unreachable!() };
        let scale = (target - camera.eye).length() / camera.distance;
        let viewport = camera.viewport.map(|side| side * scale);
        CameraDescription { projection: Projection::Parallel, viewport, ..camera }
    }

    #[test]
    fn all_of_a_mesh_is_seen_in_the_middle_and_touches_the_margin() {
        // The last vertex belongs to no triangle.
        let triangle =
            corners(&[[2.0, 4.0, 6.5], [4.0, 4.0, 7.5], [2.0, 6.0, 7.0], [900.0, 900.0, 900.0]]);
        let long = corners(&[[0.0, 0.0, 0.0], [9.0, 0.5, 0.0], [9.0, 1.0, 0.5]]);
        let high = corners(&[[0.0, 0.0, 0.0], [0.5, 9.0, 0.0], [0.0, 0.0, 0.5]]);
        let teapot = Kind::Teapot.mesh([10, 10]).unwrap();
        for mesh in [triangle, long, high, teapot] {
            for image in [[640, 480], [1920, 1080], [500, 500], [300, 900], [2000, 50]] {
                let framing = Framing { image, ..Framing::default() };
                let camera = framing.camera(&mesh).unwrap();
                let [left, right, below, above] = sides(&mesh, camera);
                let tightest = left.max(right).max(below).max(above);
                assert!(tightest < 0.92 + 1e-4, "{image:?}: {tightest}");
                let in_the_middle = (left - right).abs() < 0.01 && (below - above).abs() < 0.01;
                assert!(in_the_middle, "{image:?}: {left} {right} {below} {above}");
                assert!(sides(&mesh, parallel(camera)).iter().all(|&side| side < 1.0), "{image:?}");
            }
        }
    }

    #[test]
    fn the_teapot_fills_the_width() {
        let teapot = Kind::Teapot.mesh([10, 10]).unwrap();
        let [left, right, ..] = sides(&teapot, framed(&teapot).unwrap());
        assert!(left > 0.85 && right > 0.85, "{left} {right}");
    }

    #[test]
    fn a_needle_that_points_at_the_eye_keeps_its_distance() {
        let tip = Framing::default().towards_eye.to_array();
        let needle = corners(&[[0.0; 3], tip, [0.0; 3]]);
        let camera = Camera::new(framed(&needle).unwrap()).unwrap();
        assert!((camera.eye().as_dvec3() - Vec3::from_array(tip).as_dvec3()).length() > 0.5);
    }

    #[test]
    fn meshes_of_all_sizes_are_framed() {
        for size in [1e-36, 1e-3, 1.0, 1e6, 1e37] {
            let mesh = corners(&[[0.0, 0.0, 0.0], [size, 0.0, 0.0], [0.0, size, 0.0]]);
            Camera::new(framed(&mesh).unwrap()).unwrap();
        }
    }

    #[test]
    fn a_mesh_that_no_camera_frames_is_refused() {
        let says = |mesh: &Mesh| framed(mesh).unwrap_err().to_string();
        assert_eq!(says(&Mesh::default()), "there is no triangle to frame");
        let point = corners(&[[1.0; 3]; 3]);
        assert_eq!(says(&point), "all triangles lie in one point, so no camera can frame them");
        let large = corners(&[[-3e38, 0.0, 0.0], [3e38, 0.0, 0.0], [0.0, 3e38, 0.0]]);
        let message = "the triangles reach over 6.71e38, too far for a camera that sees them all; \
                       scale them down in a scene file";
        assert_eq!(says(&large), message);
        let small = corners(&[[1e8, 0.0, 1e8], [1e8, 0.125, 1e8], [1e8, 0.0, 1e8]]);
        let message = "the triangles reach over 0.125 only, too little for the numbers around \
                       them; move them to the origin or scale them up in a scene file";
        assert_eq!(says(&small), message);
    }
}
