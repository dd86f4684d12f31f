//! The lecture's camera: where the eye is, how the viewport lies before it, and which ray belongs to
//! a pixel.

mod error;
pub mod wording;

pub use error::CameraError;

use crate::raster::{Raster, check_samples, viewport_coordinate};
use glam::{DVec3, Vec3};

/// How the camera projects the world onto its viewport.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Projection {
    /// All viewing rays start at the eye.
    #[default]
    Perspective,
    /// All viewing rays are parallel.
    Parallel,
}

/// Where the camera looks and which way up it is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Orientation {
    /// From the eye towards a point of the world.
    LookAt {
        /// The point in the middle of the picture.
        target: Vec3,
        /// Any direction that is not along the view; its part perpendicular to the view becomes `v`.
        up: Vec3,
    },
    /// From the eye along a direction.
    Direction {
        /// The direction of view, `−w`; its length does not matter.
        direction: Vec3,
        /// As for [`Orientation::LookAt`].
        up: Vec3,
    },
    /// The camera frame itself: right, up and back, perpendicular and right-handed.
    ///
    /// The lengths do not matter. Cosines between the axes may be up to 10⁻³ off 0: the camera keeps the direction of
    /// `w`, makes `u` perpendicular to it, and computes `v` from both.
    Frame {
        /// Right.
        u: Vec3,
        /// Up.
        v: Vec3,
        /// Back.
        w: Vec3,
    },
}

/// A camera as a user states it: any values, which [`Camera::new`] checks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraDescription {
    /// Perspective or parallel.
    pub projection: Projection,
    /// The eye, in the world.
    pub eye: Vec3,
    /// Where the camera looks.
    pub orientation: Orientation,
    /// The lecture's `d`: from the eye to the viewport, in lengths of the world, from 2⁻⁶⁴ to 2⁶⁴. No ray of a
    /// parallel camera depends on it.
    pub distance: f32,
    /// The viewport's width and height, the lecture's `vw` and `vh`, in lengths of the world: from 2⁻⁶⁴ to 2⁶⁴, and at
    /// most 2²⁰ times the distance.
    pub viewport: [f32; 2],
    /// The image's width and height in pixels, the lecture's `W` and `H`, as [`check_samples`] accepts them.
    pub image: [u32; 2],
}

impl Default for CameraDescription {
    /// The lecture's canonical camera with a 640 × 480 image and square pixels.
    fn default() -> Self {
        CameraDescription {
            projection: Projection::Perspective,
            eye: Vec3::ZERO,
            orientation: Orientation::Frame { u: Vec3::X, v: Vec3::Y, w: Vec3::Z },
            distance: 1.0,
            viewport: [640.0 / 480.0, 1.0],
            image: [640, 480],
        }
    }
}

/// The camera of the lecture, ready to make viewing rays.
///
/// Its frame is `f64` and orthonormal to the last bits; everything else is stored as given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    description: CameraDescription,
    u: DVec3,
    v: DVec3,
    w: DVec3,
}

impl CameraDescription {
    /// The same camera with a vertical field of view: its viewport is as high as this angle at the
    /// distance `d`, `vh = 2·d·tan(degrees/2)`, and so wide that the pixels of its image are squares.
    ///
    /// # Errors
    ///
    /// An angle that is not between 0 and 180 degrees, or a parallel camera, which has no field of view.
    ///
    /// ```
    /// use bothways_common::CameraDescription;
    ///
    /// let camera = CameraDescription { distance: 3.0, image: [20, 10], ..Default::default() };
    /// assert_eq!(camera.with_field_of_view(90.0)?.viewport, [12.0, 6.0]);
    /// # Ok::<(), bothways_common::CameraError>(())
    /// ```
    pub fn with_field_of_view(mut self, degrees: f32) -> Result<CameraDescription, CameraError> {
        if self.projection == Projection::Parallel {
            return Err(CameraError::ParallelFieldOfView);
        }
        if !(degrees > 0.0 && degrees < 180.0) {
            return Err(CameraError::FieldOfView { degrees });
        }
        let half = f64::from(degrees).to_radians() / 2.0;
        // libm gives the same result on every machine; the standard library does not promise that.
        self.viewport[1] = rounded(2.0 * f64::from(self.distance) * libm::tan(half));
        self.viewport[0] = self.width_of_square_pixels();
        Ok(self)
    }

    /// `vw = vh·W/H`, the width on which the pixels of the image are squares.
    pub fn width_of_square_pixels(&self) -> f32 {
        let [width, height] = self.image.map(f64::from);
        rounded(f64::from(self.viewport[1]) * width / height)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "the camera stores f32, and checks its range")]
fn rounded(value: f64) -> f32 {
    value as f32
}

impl Camera {
    /// Checks a description and computes the camera frame.
    ///
    /// # Errors
    ///
    /// Every way in which a camera can be degenerate or out of the accepted range: see
    /// [`CameraError`].
    pub fn new(description: CameraDescription) -> Result<Camera, CameraError> {
        finite("the eye", description.eye)?;
        check_lengths(&description)?;
        check_samples(description.image, 1)?;
        let [u, v, w] = frame(description.eye, description.orientation)?;
        Ok(Camera { description, u, v, w })
    }

    /// The lecture's first camera: eye at the origin, looking down the negative z axis,
    /// `vw = vh = d = 1`.
    ///
    /// The image's height comes first, as rows do in `(i, j)`; [`Camera::image`] and [`CameraDescription::image`] have the
    /// width first, as sizes of images are written.
    ///
    /// # Panics
    ///
    /// If [`check_samples`] refuses the size.
    ///
    /// ```
    /// use bothways_common::Camera;
    ///
    /// let camera = Camera::canonical(2, 2);
    /// let ray = camera.viewing_ray(0, 0);
    /// assert_eq!(ray.origin.to_array(), [0.0, 0.0, 0.0]);
    /// assert_eq!(ray.direction.to_array(), [-0.25, 0.25, -1.0]);
    /// assert_eq!(Camera::canonical(480, 640).image(), [640, 480]);
    /// ```
    pub fn canonical(height: u32, width: u32) -> Camera {
        let description = CameraDescription {
            viewport: [1.0, 1.0],
            image: [width, height],
            ..CameraDescription::default()
        };
        Camera::new(description).unwrap_or_else(|error| panic!("there is no such camera: {error}"))
    }

    /// What this camera was made from.
    pub fn description(&self) -> &CameraDescription {
        &self.description
    }

    /// Perspective or parallel.
    pub fn projection(&self) -> Projection {
        self.description.projection
    }

    /// The eye, in the world.
    pub fn eye(&self) -> Vec3 {
        self.description.eye
    }

    /// Right, a unit vector in the world's axes.
    pub fn u(&self) -> DVec3 {
        self.u
    }

    /// Up, a unit vector in the world's axes.
    pub fn v(&self) -> DVec3 {
        self.v
    }

    /// Back, a unit vector in the world's axes.
    pub fn w(&self) -> DVec3 {
        self.w
    }

    /// `d`, from the eye to the viewport.
    pub fn distance(&self) -> f64 {
        f64::from(self.description.distance)
    }

    /// `vw` and `vh`.
    pub fn viewport(&self) -> [f64; 2] {
        self.description.viewport.map(f64::from)
    }

    /// `W` and `H`, in pixels.
    pub fn image(&self) -> [u32; 2] {
        self.description.image
    }

    /// The viewing ray through the middle of pixel `(i, j)`, relative to the eye and in the world's axes.
    ///
    /// With the lecture's numbers, which count pixels from 1:
    /// `x = vw·((j − ½)/W − ½)`, `y = −vh·((i − ½)/H − ½)`, direction `x·u + y·v − d·w`.
    ///
    /// A row or column behind the image's last one is not refused: the ray then goes where that pixel would be if the image
    /// went on, beside the viewport.
    pub fn viewing_ray(&self, i: u32, j: u32) -> Ray {
        let [width, height] = self.image();
        let [vw, vh] = self.viewport();
        self.ray_through(viewport_coordinate(vw, j, width), -viewport_coordinate(vh, i, height))
    }

    /// The viewing ray through the point `(x, y)` of the viewport, relative to the eye and in the world's axes.
    ///
    /// Its rounded numbers *are* the ray: every statement about visibility is about them.
    #[inline]
    pub fn ray_through(&self, x: f64, y: f64) -> Ray {
        let across = x * self.u + y * self.v;
        match self.projection() {
            Projection::Perspective => {
                Ray { origin: DVec3::ZERO, direction: across - self.distance() * self.w }
            }
            Projection::Parallel => Ray { origin: across, direction: -self.w },
        }
    }

    /// The raster of the picture with `samples` × `samples` samples a pixel.
    ///
    /// # Panics
    ///
    /// If [`check_samples`] refuses the number of samples.
    pub fn raster(&self, samples: u32) -> Raster {
        Raster::new(self.image(), samples, self.viewport())
            .unwrap_or_else(|error| panic!("the picture has no such raster: {error}"))
    }

    /// All sample points of the picture, `samples` × `samples` a pixel on a regular grid.
    ///
    /// # Panics
    ///
    /// If [`check_samples`] refuses the number of samples.
    pub fn sample_grid(&self, samples: u32) -> SampleGrid<'_> {
        let raster = self.raster(samples);
        SampleGrid { camera: self, x: raster.x().collect(), y: raster.y().collect() }
    }
}

/// Half a line: the points `origin + t·direction` with `t > 0`, the eye at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the ray begins: the eye itself (zero) for a perspective camera, and for a parallel camera a point of the
    /// plane through the eye that is parallel to the viewport.
    pub origin: DVec3,
    /// The way that the ray goes, in the world's axes; its length is the unit of `t`.
    pub direction: DVec3,
}

/// The sample points of one picture, on the viewport.
#[derive(Clone, Debug)]
pub struct SampleGrid<'a> {
    camera: &'a Camera,
    x: Vec<f64>,
    y: Vec<f64>,
}

impl SampleGrid<'_> {
    /// The number of rows, `H·N`.
    pub fn height(&self) -> usize {
        self.y.len()
    }

    /// The number of columns, `W·N`.
    pub fn width(&self) -> usize {
        self.x.len()
    }

    /// `x` on the viewport, for each column from the left; ascending.
    pub fn x(&self) -> &[f64] {
        &self.x
    }

    /// `y` on the viewport, for each row from the top; descending.
    pub fn y(&self) -> &[f64] {
        &self.y
    }

    /// The viewing ray through a sample, relative to the eye and in the world's axes.
    ///
    /// # Panics
    ///
    /// If there is no such row or column.
    #[inline]
    pub fn ray(&self, row: usize, column: usize) -> Ray {
        self.camera.ray_through(self.x[column], self.y[row])
    }
}

fn check_lengths(description: &CameraDescription) -> Result<(), CameraError> {
    let CameraDescription { distance, viewport: [width, height], .. } = *description;
    let range = (-64f32).exp2()..=64f32.exp2();
    let lengths = [
        ("the distance", distance),
        ("the viewport's width", width),
        ("the viewport's height", height),
    ];
    for (what, value) in lengths {
        if !range.contains(&value) {
            return Err(CameraError::OutOfRange { what, value });
        }
    }
    if width.max(height) > distance * 20f32.exp2() {
        return Err(CameraError::TooWide { width, height, distance });
    }
    Ok(())
}

fn finite(what: &'static str, value: Vec3) -> Result<DVec3, CameraError> {
    if value.is_finite() {
        Ok(value.as_dvec3())
    } else {
        Err(CameraError::NotFinite { what, value })
    }
}

fn direction(what: &'static str, value: Vec3) -> Result<DVec3, CameraError> {
    match finite(what, value)? {
        DVec3::ZERO => Err(CameraError::NoDirection { what }),
        vector => Ok(unit(vector)),
    }
}

/// Right, up and back, orthonormal to the last bits.
fn frame(eye: Vec3, orientation: Orientation) -> Result<[DVec3; 3], CameraError> {
    let (w, up) = match orientation {
        Orientation::LookAt { target, up } => {
            let back = eye.as_dvec3() - finite("the point to look at", target)?;
            if back == DVec3::ZERO {
                return Err(CameraError::LooksAtItself { eye });
            }
            (unit(back), up)
        }
        Orientation::Direction { direction: view, up } => {
            (-direction("the direction of view", view)?, up)
        }
        Orientation::Frame { u, v, w } => return stated_frame(u, v, w),
    };
    let right = direction("up", up)?.cross(w);
    // Below this, rounding of w decides what is left of up.
    if right.length() < 1e-6 {
        return Err(CameraError::UpAlongView { up });
    }
    Ok(complete_frame(right, w))
}

fn stated_frame(u: Vec3, v: Vec3, w: Vec3) -> Result<[DVec3; 3], CameraError> {
    let (u, v, w) = (direction("u", u)?, direction("v", v)?, direction("w", w)?);
    // A frame with six decimals passes: people and programs write that many.
    const SKEW: f64 = 1e-3;
    let skew = u.dot(v).abs().max(v.dot(w).abs()).max(w.dot(u).abs());
    if skew > SKEW {
        return Err(CameraError::NotAFrame { reason: "they are not perpendicular" });
    }
    if w.cross(u).dot(v) < 0.0 {
        return Err(CameraError::NotAFrame { reason: "they are left-handed (v is not w x u)" });
    }
    Ok(complete_frame(u, w))
}

/// Makes `right` perpendicular to `w` and of unit length; `v` follows.
fn complete_frame(right: DVec3, w: DVec3) -> [DVec3; 3] {
    let w = clean(w);
    let u = clean(unit(right - right.dot(w) * w));
    let v = clean(w.cross(u));
    [u, v, w]
}

/// The vector scaled to unit length. In `f64` no finite `f32` vector over- or underflows here.
fn unit(vector: DVec3) -> DVec3 {
    vector / vector.length()
}

/// Components that are negligible beside 1 become 0, so that no product of the predicates underflows.
fn clean(vector: DVec3) -> DVec3 {
    DVec3::select(vector.abs().cmplt(DVec3::splat((-100f64).exp2())), DVec3::ZERO, vector)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::SizeError;

    #[test]
    fn the_canonical_camera_gives_the_lecture_s_rays() {
        // The slide for W = 4, H = 2, pixel (1, 1) counted from 1: x = (½)/4 − ½, y = −((½)/2 − ½).
        let camera = Camera::canonical(2, 4);
        let ray = camera.viewing_ray(0, 0);
        assert_eq!(ray.direction, DVec3::new(-0.375, 0.25, -1.0));
        assert_eq!(camera.viewing_ray(1, 3).direction, DVec3::new(0.375, -0.25, -1.0));
    }

    #[test]
    fn a_turned_camera_builds_the_ray_from_its_frame() {
        // Looking along +x with y up: u = +z, w = −x. Pixel (0, 2) of 4 x 4, vw = 4, vh = 2, d = 3:
        // x = 4·(5 − 4)/8 = ½, y = −2·(1 − 4)/8 = ¾; direction = ½·u + ¾·v − 3·w.
        let camera = Camera::new(CameraDescription {
            eye: Vec3::new(5.0, 6.0, 7.0),
            orientation: Orientation::Direction { direction: Vec3::X, up: Vec3::Y },
            distance: 3.0,
            viewport: [4.0, 2.0],
            image: [4, 4],
            ..CameraDescription::default()
        })
        .unwrap();
        assert_eq!(camera.viewing_ray(0, 2).direction, DVec3::new(3.0, 0.75, 0.5));
    }

    #[test]
    fn parallel_rays_start_on_a_plane_through_the_eye() {
        let camera = Camera::new(CameraDescription {
            projection: Projection::Parallel,
            viewport: [4.0, 4.0],
            image: [2, 2],
            ..CameraDescription::default()
        })
        .unwrap();
        let ray = camera.viewing_ray(0, 1);
        assert_eq!(ray.origin, DVec3::new(1.0, 1.0, 0.0));
        assert_eq!(ray.direction, DVec3::new(0.0, 0.0, -1.0));
    }

    #[test]
    fn samples_of_a_pixel_are_pixels_of_a_finer_picture() {
        let camera = Camera::canonical(5, 3);
        let fine = Camera::canonical(10, 6);
        let grid = camera.sample_grid(2);
        assert_eq!((grid.width(), grid.height()), (6, 10));
        for (row, column) in [(0, 0), (3, 5), (9, 2)] {
            let pixel = fine.viewing_ray(row, column);
            assert_eq!(grid.ray(row as usize, column as usize), pixel);
        }
    }

    #[test]
    fn the_picture_is_symmetric_to_the_last_bit() {
        let camera = Camera::canonical(1081, 1919);
        let grid = camera.sample_grid(1);
        for (left, right) in grid.x().iter().zip(grid.x().iter().rev()) {
            assert_eq!(*left, -*right);
        }
        assert_eq!(grid.x()[959], 0.0);
    }

    #[test]
    fn frames_are_orthonormal_to_the_last_bits() {
        for target in [[1.0, 0.7, 1.5], [-1e-20, 3.0, 1e-3], [1e30, -1e30, 2e29], [0.0, 1.0, 2e-6]]
        {
            let [u, v, w] = frame(
                Vec3::ZERO,
                Orientation::LookAt { target: Vec3::from_array(target), up: Vec3::Y },
            )
            .unwrap();
            for product in [u.dot(v), v.dot(w), w.dot(u), u.length() - 1.0, v.length() - 1.0] {
                assert!(product.abs() < 4e-16, "{target:?}: {product}");
            }
        }
    }

    #[test]
    fn a_field_of_view_is_a_viewport_at_its_distance() {
        let camera =
            CameraDescription { distance: 0.7, image: [640, 400], ..CameraDescription::default() };
        for degrees in [1e-3, 40.0, 53.130_1, 90.0, 179.0] {
            let [vw, vh] = camera.with_field_of_view(degrees).unwrap().viewport.map(f64::from);
            // The angle whose tangent is half the height over the distance.
            let angle = 2.0 * (vh / 2.0).atan2(f64::from(camera.distance)).to_degrees();
            assert!((angle / f64::from(degrees) - 1.0).abs() < 1e-6, "{degrees}: {angle}");
            assert!((vw / vh / 1.6 - 1.0).abs() < 1e-7, "{degrees}: {vw} x {vh}");
        }
        for degrees in [0.0, -0.0, -40.0, 180.0, 1e30, f32::INFINITY, f32::NAN] {
            let error = camera.with_field_of_view(degrees).unwrap_err();
            assert!(matches!(error, CameraError::FieldOfView { .. }), "{error}");
        }
        let parallel = CameraDescription { projection: Projection::Parallel, ..camera };
        assert_eq!(parallel.with_field_of_view(40.0), Err(CameraError::ParallelFieldOfView));
    }

    #[test]
    fn degenerate_cameras_are_refused() {
        let with = |change: &dyn Fn(&mut CameraDescription)| {
            let mut description = CameraDescription::default();
            change(&mut description);
            Camera::new(description).unwrap_err()
        };
        let look = |target, up| Orientation::LookAt { target, up };
        let up_along_view = with(&|c| c.orientation = look(Vec3::Y, Vec3::NEG_Y));
        assert!(matches!(up_along_view, CameraError::UpAlongView { .. }));
        let at_itself = with(&|c| c.orientation = look(Vec3::ZERO, Vec3::Y));
        assert!(matches!(at_itself, CameraError::LooksAtItself { .. }));
        let no_up = with(&|c| c.orientation = look(Vec3::X, Vec3::ZERO));
        assert_eq!(no_up, CameraError::NoDirection { what: "up" });
        let nan = with(&|c| c.eye.x = f32::NAN);
        assert!(matches!(nan, CameraError::NotFinite { what: "the eye", .. }));
        let left = with(&|c| {
            c.orientation = Orientation::Frame { u: Vec3::X, v: Vec3::NEG_Y, w: Vec3::Z }
        });
        assert!(left.to_string().contains("left-handed"));
        assert!(matches!(with(&|c| c.distance = 0.0), CameraError::OutOfRange { .. }));
        assert!(matches!(with(&|c| c.distance = f32::NAN), CameraError::OutOfRange { .. }));
        assert!(matches!(with(&|c| c.viewport[0] = 2e6), CameraError::TooWide { .. }));
        assert!(matches!(with(&|c| c.image = [0, 4]), CameraError::Size(SizeError::Empty { .. })));
        assert!(matches!(
            with(&|c| c.image = [65_537, 1]),
            CameraError::Size(SizeError::TooManySamples { .. })
        ));
        assert!(check_samples([40_000, 1], 2).is_err());
        assert_eq!(check_samples([4, 4], 0), Err(SizeError::NoSamples));
    }
}
