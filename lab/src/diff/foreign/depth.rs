//! What the numbers of a file of distances mean, and how they become our `t`.

use crate::common::{Camera, Projection};
use crate::diff::buffer::{Buffer, Content};

/// The meaning of a number that says how far something is. What is not finite is nothing, whatever the meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Depth {
    /// Lengths of the viewing ray's direction, as this program writes them.
    T,
    /// The distance along the ray, from where it begins: `t·|(x, y, −d)|` of a perspective camera.
    Ray,
    /// The distance along the axis of the view, from the eye: `t·d` of a perspective camera.
    Axis,
    /// The window depth of OpenGL, from 0 on the near plane to 1 on the far plane; there, it is nothing. With a near plane
    /// farther away than the far plane, the depth is reversed: 1 is near. A far plane may be infinitely far.
    OpenGl {
        /// The distance of the near plane along the axis.
        near: f64,
        /// The distance of the far plane along the axis.
        far: f64,
    },
}

/// Why numbers do not become distances.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DepthError {
    /// The camera has another image.
    #[error(
        "the camera's image is {}x{}, and the file has {} x {} pixels; give --size {}x{}",
        .camera[0], .camera[1], .file[0], .file[1], .file[0], .file[1]
    )]
    Size {
        /// The width and height of the camera's image.
        camera: [u32; 2],
        /// The width and height of the file.
        file: [u32; 2],
    },
    /// A parallel camera cannot see infinitely far.
    #[error(
        "--depth opengl with an infinite plane is of a perspective camera, but this one is parallel; give \
         both planes as numbers"
    )]
    InfinitelyFar,
    /// A window depth is not from 0 to 1.
    #[error(
        "the depth at ({}, {}) is {depth}, but OpenGL's window depth goes from 0 to 1; if these are \
         distances, say --depth axis or --depth ray",
        .at[0], .at[1]
    )]
    OutOfRange {
        /// The row and the column.
        at: [u32; 2],
        /// The number in the file.
        depth: f64,
    },
}

impl Depth {
    /// The meaning in the words of a message.
    pub fn name(self) -> &'static str {
        match self {
            Depth::T => "t",
            Depth::Ray => "distances along the ray",
            Depth::Axis => "distances along the axis",
            Depth::OpenGl { near, far } if near > far => "reversed depths of OpenGL",
            Depth::OpenGl { .. } => "depths of OpenGL",
        }
    }

    /// The buffer with its distances as `t`; a buffer without distances stays as it is.
    ///
    /// # Errors
    ///
    /// If the camera's image has another size, or a number is none of this meaning.
    ///
    /// ```
    /// use bothways_lab::common::{Camera, CameraDescription};
    /// use bothways_lab::diff::foreign::{Buffer, Content, Depth};
    ///
    /// let camera = CameraDescription { distance: 2.0, image: [1, 1], ..Default::default() };
    /// let along_the_axis = Buffer::new([1, 1], 1, Content::Distances(vec![6.0]));
    /// let t = Depth::Axis.to_t(along_the_axis, &Camera::new(camera)?)?;
    /// assert_eq!(t.content(), &Content::Distances(vec![3.0]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn to_t(
        self,
        buffer: Buffer<'static>,
        camera: &Camera,
    ) -> Result<Buffer<'static>, DepthError> {
        let Content::Distances(depths) = buffer.content() else { return Ok(buffer) };
        let (size, samples) = (buffer.size(), buffer.samples());
        if camera.image() != size {
            return Err(DepthError::Size { camera: camera.image(), file: size });
        }
        if let Depth::OpenGl { near, far } = self
            && camera.projection() == Projection::Parallel
            && !(near.is_finite() && far.is_finite())
        {
            return Err(DepthError::InfinitelyFar);
        }
        let raster = camera.raster(samples);
        let (x, y): (Vec<f64>, Vec<f64>) = (raster.x().collect(), raster.y().collect());
        // The samples of a pixel lie together, row by row.
        let n = samples as usize;
        let (width, per_pixel) = (size[0] as usize, n * n);
        let convert = |(index, &depth): (usize, &f64)| {
            let (pixel, sample) = (index / per_pixel, index % per_pixel);
            let (row, column) = (pixel / width * n + sample / n, pixel % width * n + sample % n);
            self.t(depth, camera, [x[column], y[row]]).ok_or_else(|| {
                let at = [pixel / width, pixel % width];
                let at = at.map(|side| u32::try_from(side).expect("less than 2^16"));
                DepthError::OutOfRange { at, depth }
            })
        };
        let t = depths.iter().enumerate().map(convert).collect::<Result<_, _>>()?;
        Ok(Buffer::new(size, samples, Content::Distances(t)))
    }

    /// The distance of a sample at `(x, y)` on the viewport; `None` for a number that has no meaning.
    fn t(self, depth: f64, camera: &Camera, [x, y]: [f64; 2]) -> Option<f64> {
        let along_axis = match self {
            _ if !depth.is_finite() => return Some(depth),
            Depth::T => return Some(depth),
            Depth::Axis => depth,
            Depth::Ray => {
                return Some(match camera.projection() {
                    Projection::Perspective => {
                        depth / (x * x + y * y + camera.distance().powi(2)).sqrt()
                    }
                    Projection::Parallel => depth,
                });
            }
            Depth::OpenGl { near, far } => {
                if !(0.0..=1.0).contains(&depth) {
                    return None;
                }
                let nothing = if near > far { 0.0 } else { 1.0 };
                if depth == nothing {
                    return Some(f64::INFINITY);
                }
                match camera.projection() {
                    // 1/z is linear on the screen; 1/∞ is 0.
                    Projection::Perspective => 1.0 / ((1.0 - depth) / near + depth / far),
                    Projection::Parallel => (1.0 - depth) * near + depth * far,
                }
            }
        };
        Some(match camera.projection() {
            Projection::Perspective => along_axis / camera.distance(),
            Projection::Parallel => along_axis,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::CameraDescription;

    fn camera(projection: Projection) -> Camera {
        let description = CameraDescription {
            projection,
            distance: 2.0,
            viewport: [6.0, 6.0],
            image: [3, 1],
            ..CameraDescription::default()
        };
        Camera::new(description).unwrap()
    }

    fn converted(depth: Depth, projection: Projection, numbers: [f64; 3]) -> Vec<f64> {
        let buffer = Buffer::new([3, 1], 1, Content::Distances(numbers.to_vec()));
        let t = depth.to_t(buffer, &camera(projection)).unwrap();
        let Content::Distances(t) = t.content() else { panic!("no distances") };
        t.clone()
    }

    #[test]
    fn distances_become_lengths_of_the_ray() {
        use Projection::{Parallel, Perspective};
        // The rays are (-2, 0, -2), (0, 0, -2) and (2, 0, -2).
        let long = 8.0_f64.sqrt();
        let nothing = f64::INFINITY;
        assert_eq!(converted(Depth::Ray, Perspective, [long, 4.0, nothing]), [1.0, 2.0, nothing]);
        assert_eq!(converted(Depth::Axis, Perspective, [2.0, 4.0, nothing]), [1.0, 2.0, nothing]);
        assert_eq!(converted(Depth::T, Perspective, [2.0, 4.0, nothing]), [2.0, 4.0, nothing]);
        for depth in [Depth::Ray, Depth::Axis] {
            assert_eq!(converted(depth, Parallel, [2.0, 4.0, nothing]), [2.0, 4.0, nothing]);
        }
    }

    #[test]
    fn depths_of_opengl_are_undone() {
        use Projection::{Parallel, Perspective};
        let nothing = f64::INFINITY;
        // The formula of glFrustum for near 1, far 4: (z·5 − 8)/(3·z)/2 + 1/2, which is 2/3 for z = 2.
        let usual = Depth::OpenGl { near: 1.0, far: 4.0 };
        let [near, two, far] =
            <[f64; 3]>::try_from(converted(usual, Perspective, [0.0, 2.0 / 3.0, 1.0])).unwrap();
        assert_eq!((near, far), (0.5, nothing));
        assert!((two - 1.0).abs() < 1e-15);
        assert_eq!(converted(usual, Parallel, [0.0, 0.5, 1.0]), [1.0, 2.5, nothing]);
        let reversed = Depth::OpenGl { near: f64::INFINITY, far: 1.0 };
        assert_eq!(converted(reversed, Perspective, [1.0, 0.25, 0.0]), [0.5, 2.0, nothing]);
        let infinite = Depth::OpenGl { near: 1.0, far: f64::INFINITY };
        assert_eq!(converted(infinite, Perspective, [0.0, 0.75, 1.0]), [0.5, 2.0, nothing]);
    }

    #[test]
    fn numbers_without_a_meaning_are_named() {
        let buffer = Buffer::new([3, 1], 1, Content::Distances(vec![0.5, 1.0, 1.5]));
        let depth = Depth::OpenGl { near: 1.0, far: 4.0 };
        let error = depth.to_t(buffer.clone(), &camera(Projection::Perspective)).unwrap_err();
        assert_eq!(error, DepthError::OutOfRange { at: [0, 2], depth: 1.5 });
        let infinite = Depth::OpenGl { near: 1.0, far: f64::INFINITY };
        let error = infinite.to_t(buffer, &camera(Projection::Parallel)).unwrap_err();
        assert_eq!(error, DepthError::InfinitelyFar);
        let other = Buffer::new([1, 3], 1, Content::Distances(vec![1.0; 3]));
        let error = Depth::Axis.to_t(other, &camera(Projection::Perspective)).unwrap_err();
        assert_eq!(error, DepthError::Size { camera: [3, 1], file: [1, 3] });
    }

    #[test]
    fn samples_lie_where_their_rays_go() {
        let numbers = vec![1.0; 3 * 4];
        let buffer = Buffer::new([3, 1], 2, Content::Distances(numbers));
        let camera = camera(Projection::Perspective);
        let t = Depth::Ray.to_t(buffer, &camera).unwrap();
        let Content::Distances(t) = t.content() else { panic!("no distances") };
        let rays = camera.sample_grid(2);
        for (index, [row, column]) in
            [[0, 0], [0, 1], [1, 0], [1, 1], [0, 2]].into_iter().enumerate()
        {
            let length = rays.ray(row, column).direction.length();
            assert!((t[index] * length - 1.0).abs() < 1e-15, "{row} {column}");
        }
    }
}
