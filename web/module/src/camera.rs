//! The camera in the words of scene files, as the page's fields and its address have them.

use bothways_lab::common::glam::Vec3;
use bothways_lab::common::{Camera, CameraDescription, Orientation, Projection};
use bothways_lab::wording::{self, grouped};
use serde::{Deserialize, Serialize};

/// A camera as JSON. It states where it looks by `u`, `v`, `w`, or else by `look_at`, or else by `direction`, the last two with
/// `up`; an answer has `direction` and `up` in any case, so that a page shows them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CameraJson {
    projection: ProjectionJson,
    eye: [f32; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    u: Option<[f32; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    v: Option<[f32; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    w: Option<[f32; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    look_at: Option<[f32; 3]>,
    #[serde(default)]
    direction: [f32; 3],
    #[serde(default = "up")]
    up: [f32; 3],
    d: f32,
    vw: f32,
    vh: f32,
    height: u32,
    width: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ProjectionJson {
    Perspective,
    Parallel,
}

/// The most pixels of an image: as many as a 4K screen has, and a few more.
const MOST_PIXELS: u64 = 1 << 23;

/// From where a message looks: a camera, and another size of its image. Without a camera it is the scene's own.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub(crate) struct Viewpoint {
    #[serde(default)]
    camera: Option<CameraJson>,
    #[serde(default)]
    height: Option<u32>,
    #[serde(default)]
    width: Option<u32>,
}

/// The frame of a camera.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct FrameJson {
    pub(crate) u: [f64; 3],
    pub(crate) v: [f64; 3],
    pub(crate) w: [f64; 3],
}

fn up() -> [f32; 3] {
    Vec3::Y.to_array()
}

impl From<Projection> for ProjectionJson {
    fn from(projection: Projection) -> Self {
        match projection {
            Projection::Perspective => ProjectionJson::Perspective,
            Projection::Parallel => ProjectionJson::Parallel,
        }
    }
}

impl From<ProjectionJson> for Projection {
    fn from(projection: ProjectionJson) -> Self {
        match projection {
            ProjectionJson::Perspective => Projection::Perspective,
            ProjectionJson::Parallel => Projection::Parallel,
        }
    }
}

impl CameraJson {
    /// The words for a camera.
    pub(crate) fn new(camera: &CameraDescription) -> CameraJson {
        let CameraDescription { projection, eye, orientation, distance, viewport, image } = *camera;
        let mut json = CameraJson {
            projection: projection.into(),
            eye: plain(eye),
            u: None,
            v: None,
            w: None,
            look_at: None,
            direction: [0.0; 3],
            up: up(),
            d: distance,
            vw: viewport[0],
            vh: viewport[1],
            height: image[1],
            width: image[0],
        };
        match orientation {
            Orientation::LookAt { target, up } => {
                json.look_at = Some(plain(target));
                (json.direction, json.up) = (plain(target - eye), plain(up));
            }
            Orientation::Direction { direction, up } => {
                (json.direction, json.up) = (plain(direction), plain(up));
            }
            Orientation::Frame { u, v, w } => {
                [json.u, json.v, json.w] = [u, v, w].map(|axis| Some(plain(axis)));
                (json.direction, json.up) = (plain(-w), plain(v));
            }
        }
        json
    }

    /// The description, which [`Camera::new`] has still to check.
    pub(crate) fn description(&self) -> CameraDescription {
        let vector = Vec3::from_array;
        let up = vector(self.up);
        let orientation = match (self.u, self.v, self.w, self.look_at) {
            (Some(u), Some(v), Some(w), _) => {
                Orientation::Frame { u: vector(u), v: vector(v), w: vector(w) }
            }
            (.., Some(target)) => Orientation::LookAt { target: vector(target), up },
            _ => Orientation::Direction { direction: vector(self.direction), up },
        };
        CameraDescription {
            projection: self.projection.into(),
            eye: vector(self.eye),
            orientation,
            distance: self.d,
            viewport: [self.vw, self.vh],
            image: [self.width, self.height],
        }
    }
}

impl Viewpoint {
    /// The camera.
    ///
    /// # Errors
    ///
    /// A camera that is refused, in the words of the command line.
    pub(crate) fn camera(&self, own: &CameraDescription) -> Result<Camera, String> {
        let mut description = self.camera.as_ref().map_or(*own, CameraJson::description);
        description.image[0] = self.width.unwrap_or(description.image[0]);
        description.image[1] = self.height.unwrap_or(description.image[1]);
        let [width, height] = description.image;
        if u64::from(width) * u64::from(height) > MOST_PIXELS {
            return Err(format!(
                "an image of {width}x{height} is too large for a browser, which draws at most {} pixels here; choose a \
                 smaller one",
                grouped(MOST_PIXELS)
            ));
        }
        Camera::new(description).map_err(|error| error.to_string())
    }
}

/// A pixel of a camera's image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub(crate) struct Pixel {
    pub(crate) row: u32,
    pub(crate) column: u32,
}

impl Pixel {
    /// Makes sure that the image has the pixel.
    ///
    /// # Errors
    ///
    /// Which pixels there are.
    pub(crate) fn check(self, camera: &Camera) -> Result<Pixel, String> {
        let (Pixel { row, column }, [width, height]) = (self, camera.image());
        if row < height && column < width {
            return Ok(self);
        }
        Err(format!(
            "there is no pixel ({row}, {column}) in an image of {width}x{height}: the row goes from 0 to {}, the \
             column from 0 to {}",
            height - 1,
            width - 1
        ))
    }
}

impl FrameJson {
    pub(crate) fn new(camera: &Camera) -> FrameJson {
        let [u, v, w] = [camera.u(), camera.v(), camera.w()].map(wording::plain);
        FrameJson { u, v, w }
    }
}

/// The vector without a negative zero.
fn plain(vector: Vec3) -> [f32; 3] {
    (vector + Vec3::ZERO).to_array()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_lab::scenes::{self, BUILT_IN};

    /// The page keeps every camera in this form: it must come back as the same camera, to the last bit.
    #[test]
    fn the_cameras_of_all_scenes_come_back_as_they_were() {
        for scene in BUILT_IN {
            let camera = scenes::load(scene.name).unwrap().camera;
            let text = serde_json::to_string(&CameraJson::new(&camera)).unwrap();
            // JavaScript reads numbers as f64.
            let numbers: serde_json::Value = serde_json::from_str(&text).unwrap();
            let again: CameraJson = serde_json::from_value(numbers).unwrap();
            assert_eq!(again.description(), camera, "{}: {text}", scene.name);
        }
    }
}
