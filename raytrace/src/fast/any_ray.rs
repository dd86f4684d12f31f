//! The first hit of any ray, not only of the rays of a picture.

use super::camera_map::CameraMap;
use super::one_primitive::unbounded::Unbounded;
use super::prepared::Prepared;
use super::search::tile_frustum::FrustumTemplate;
use super::search::walk::Walker;
use super::trace::trace_tiles;
use bothways_common::engine::fault::Sound;
use bothways_common::raster::Region;
use bothways_common::{Camera, CameraDescription, Orientation, Scene, View};
use glam::Vec3;

/// Half a line in the world: what lies at `origin + t·direction` with `t > 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldRay {
    /// Where it begins, in the world.
    pub origin: Vec3,
    /// Where it goes; the length does not matter.
    pub direction: Vec3,
}

/// The first primitive along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The id of the primitive.
    pub id: u64,
    /// How far it is from the ray's origin, in units of the world: the length of the ray's direction does not matter.
    pub distance: f32,
}

impl WorldRay {
    /// The camera of which this ray is the middle ray: perspective, at the ray's origin, `w` against its
    /// direction, `d = vw = vh = 1`, one pixel. Its up vector is the axis of the world that is most
    /// perpendicular to the ray, of equals the first of `y`, `z`, `x`.
    ///
    /// It states what is exactly true of the ray: the [`View::judge`] of this camera is the judge of
    /// [`first_hit`]. A ray through an edge or a vertex belongs to the primitive on its right, towards the `u` of this
    /// camera.
    ///
    /// # Panics
    ///
    /// If a number is not finite, or the direction is zero.
    pub fn camera(&self) -> Camera {
        let [x, y, z] = self.direction.abs().to_array();
        let up = if y <= z && y <= x {
            Vec3::Y
        } else if z <= x {
            Vec3::Z
        } else {
            Vec3::X
        };
        let orientation = Orientation::Direction { direction: self.direction, up };
        let description = CameraDescription {
            eye: self.origin,
            orientation,
            distance: 1.0,
            viewport: [1.0, 1.0],
            image: [1, 1],
            ..CameraDescription::default()
        };
        Camera::new(description).unwrap_or_else(|error| panic!("this ray has no camera: {error}"))
    }
}

/// Finds the first primitive along any ray, exactly: what is seen at the middle of
/// [`WorldRay::camera`]'s picture. `None` if the ray meets nothing.
///
/// # Panics
///
/// If the scene is not the one that was prepared, as far as the number of primitives tells, a number of the ray is not
/// finite, or its direction is zero.
///
/// ```
/// use bothways_raytrace::common::{Scene, Sphere, glam::Vec3};
/// use bothways_raytrace::fast::{self, WorldRay};
///
/// let sphere = Sphere { center: Vec3::new(5.0, 0.0, 0.0), radius: 2.0 };
/// let scene = Scene::new(vec![sphere.into()])?;
/// let prepared = fast::prepare(&scene);
/// let to_the_right = WorldRay { origin: Vec3::ZERO, direction: Vec3::X };
/// let hit = fast::first_hit(&prepared, &scene, to_the_right).expect("it meets the sphere");
/// assert_eq!((hit.id, hit.distance), (0, 3.0));
/// let to_the_left = WorldRay { direction: Vec3::NEG_X, ..to_the_right };
/// assert_eq!(fast::first_hit(&prepared, &scene, to_the_left), None);
/// # Ok::<(), bothways_raytrace::common::SceneError>(())
/// ```
pub fn first_hit(prepared: &Prepared, scene: &Scene, ray: WorldRay) -> Option<Hit> {
    assert_eq!(prepared.primitives, scene.primitive_count(), "another scene was prepared");
    let camera = ray.camera();
    let view = View::new(scene, &camera);
    let map = CameraMap::new(&view, 1, &prepared.bounds);
    let unbounded = Unbounded::for_rays(prepared, &map);
    let mut walker = Walker::new(prepared, &map, &unbounded);
    let template = FrustumTemplate::new(&map, 1);
    let (mut name, mut distance) = ([0], [0.0]);
    let (names, distances) = (&mut [&mut name[..]], &mut [&mut distance[..]]);
    let here = Region { rows: 0..1, columns: 0..1 };
    trace_tiles::<Sound>(&mut walker, &template, &here, (names, distances), &mut |_, _, _| {});
    walker.seen().map(|id| Hit { id, distance: distance[0] })
}
