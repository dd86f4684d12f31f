//! The scene's camera with the changes from the command line.

use super::args::CameraArgs;
use super::failure::Failure;
use bothways::common::glam::Vec3;
use bothways::common::{Camera, CameraDescription, CameraError, Orientation, Projection};
use bothways::scenes::{LoadedScene, with_projection};
use bothways::wording::readable;

/// The camera to render with.
pub(super) fn camera(loaded: &LoadedScene, args: &CameraArgs) -> Result<Camera, Failure> {
    changed(loaded, args).and_then(Camera::new).map_err(|error| {
        let changes = options_given(args);
        let with = if changes.is_empty() { String::new() } else { " with ".to_owned() + &changes };
        Failure::new(format!("the camera of '{}'{with}: {error}", loaded.name))
    })
}

fn changed(loaded: &LoadedScene, args: &CameraArgs) -> Result<CameraDescription, CameraError> {
    let mut camera = loaded.camera;
    camera.eye = args.eye.unwrap_or(camera.eye);
    camera.orientation = orientation(camera.orientation, args.look_at, args.up);
    camera.distance = args.distance.unwrap_or(camera.distance);
    camera.image = args.size.unwrap_or(camera.image);

    let projection = args.projection.map_or(camera.projection, Projection::from);
    if let Some(degrees) = args.fov {
        camera = CameraDescription { projection, ..camera }.with_field_of_view(degrees)?;
    } else if let Some(viewport) = args.viewport {
        camera.viewport = viewport;
    } else {
        if args.size.is_some() && !loaded.viewport_stated {
            camera.viewport[0] = camera.width_of_square_pixels();
        }
        if projection != camera.projection {
            camera = with_projection(&camera, projection, &loaded.scene)?;
        }
    }
    camera.projection = projection;
    Ok(camera)
}

fn orientation(stated: Orientation, target: Option<Vec3>, up: Option<Vec3>) -> Orientation {
    let stated_up = match stated {
        Orientation::LookAt { up, .. } | Orientation::Direction { up, .. } => up,
        Orientation::Frame { v, .. } => v,
    };
    let up_or_stated = up.unwrap_or(stated_up);
    match (target, stated) {
        (Some(target), _) | (None, Orientation::LookAt { target, .. }) => {
            Orientation::LookAt { target, up: up_or_stated }
        }
        (None, Orientation::Direction { direction, .. }) => {
            Orientation::Direction { direction, up: up_or_stated }
        }
        (None, Orientation::Frame { w, .. }) if up.is_some() => {
            Orientation::Direction { direction: -w, up: up_or_stated }
        }
        (None, Orientation::Frame { .. }) => stated,
    }
}

/// The warning for an image and a viewport with different aspect ratios: the picture looks squashed, which may be
/// intended.
pub(super) fn squashed(camera: &Camera, args: &CameraArgs) -> Option<String> {
    let CameraDescription { viewport: [vw, vh], image: [width, height], .. } =
        *camera.description();
    let square = camera.description().width_of_square_pixels();
    // A rounded viewport, such as 1.33 x 1, counts as intended.
    let fits = (vw / square - 1.0).abs() < 0.01;
    (args.size.is_some() && !fits).then(|| {
        let [vw, vh, square] = [vw, vh, square].map(readable);
        format!(
            "the viewport is {vw} x {vh} whatever the size, so the pixels of an image of \
             {width}x{height} are not square; --viewport {square},{vh} makes them so"
        )
    })
}

/// The given options, for messages: `--eye, --up`.
pub(super) fn options_given(args: &CameraArgs) -> String {
    let given = [
        ("--size", args.size.is_some()),
        ("--projection", args.projection.is_some()),
        ("--eye", args.eye.is_some()),
        ("--look-at", args.look_at.is_some()),
        ("--up", args.up.is_some()),
        ("--distance", args.distance.is_some()),
        ("--viewport", args.viewport.is_some()),
        ("--fov", args.fov.is_some()),
    ];
    let names = given.iter().filter(|(_, given)| *given).map(|(name, _)| *name);
    names.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::super::args::ProjectionArg;
    use super::*;
    use bothways::common::{Plane, Scene, Shape, Sphere};

    fn loaded(camera: CameraDescription) -> LoadedScene {
        let plane = Shape::Plane(Plane { point: Vec3::ZERO, normal: Vec3::Y });
        let near = Shape::Sphere(Sphere { center: Vec3::new(0.0, 0.0, -3.0), radius: 1.0 });
        let far = Shape::Sphere(Sphere { center: Vec3::new(0.0, 0.0, -9.0), radius: 1.0 });
        let scene = Scene::new(vec![plane.into(), near.into(), far.into()]).unwrap();
        let (name, toml) = ("test".into(), String::new());
        LoadedScene { name, scene, camera, viewport_stated: false, toml, warnings: Vec::new() }
    }

    fn look_at(target: Vec3) -> CameraDescription {
        CameraDescription {
            orientation: Orientation::LookAt { target, up: Vec3::Y },
            viewport: [2.0, 1.0],
            image: [200, 100],
            ..CameraDescription::default()
        }
    }

    #[test]
    fn a_size_keeps_the_height_of_the_viewport() {
        let args = CameraArgs { size: Some([300, 100]), ..CameraArgs::default() };
        let mut scene = loaded(look_at(Vec3::NEG_Z));
        assert_eq!(changed(&scene, &args).unwrap().viewport, [3.0, 1.0]);
        scene.viewport_stated = true;
        assert_eq!(changed(&scene, &args).unwrap().viewport, [2.0, 1.0]);
    }

    #[test]
    fn another_projection_keeps_the_size_of_the_target() {
        let args = CameraArgs {
            projection: Some(ProjectionArg::Parallel),
            distance: Some(2.0),
            ..CameraArgs::default()
        };
        let camera = changed(&loaded(look_at(Vec3::new(0.0, 0.0, -8.0))), &args).unwrap();
        assert_eq!((camera.projection, camera.viewport), (Projection::Parallel, [8.0, 4.0]));

        let args =
            CameraArgs { projection: Some(ProjectionArg::Perspective), ..CameraArgs::default() };
        assert_eq!(changed(&loaded(camera), &args).unwrap().viewport, [2.0, 1.0]);
    }

    #[test]
    fn without_a_target_the_middle_of_the_objects_keeps_its_size() {
        let args =
            CameraArgs { projection: Some(ProjectionArg::Parallel), ..CameraArgs::default() };
        let canonical = CameraDescription { viewport: [1.0, 1.0], ..CameraDescription::default() };
        assert_eq!(changed(&loaded(canonical), &args).unwrap().viewport, [6.0, 6.0]);
        let behind = CameraDescription { eye: Vec3::new(0.0, 0.0, -20.0), ..canonical };
        assert_eq!(changed(&loaded(behind), &args).unwrap().viewport, [1.0, 1.0]);
    }

    #[test]
    fn a_stated_viewport_is_taken_as_it_is() {
        let args = CameraArgs {
            projection: Some(ProjectionArg::Parallel),
            viewport: Some([5.0, 7.0]),
            size: Some([9, 9]),
            ..CameraArgs::default()
        };
        assert_eq!(changed(&loaded(look_at(Vec3::NEG_Z)), &args).unwrap().viewport, [5.0, 7.0]);
    }

    #[test]
    fn a_field_of_view_follows_the_distance_and_the_image() {
        let args = CameraArgs {
            fov: Some(90.0),
            distance: Some(3.0),
            size: Some([30, 10]),
            ..CameraArgs::default()
        };
        let mut scene = loaded(look_at(Vec3::NEG_Z));
        assert_eq!(changed(&scene, &args).unwrap().viewport, [18.0, 6.0]);
        // The new viewport is stated, in every scene.
        scene.viewport_stated = true;
        assert_eq!(changed(&scene, &args).unwrap().viewport, [18.0, 6.0]);
        scene.camera.projection = Projection::Parallel;
        assert_eq!(changed(&scene, &args), Err(CameraError::ParallelFieldOfView));
        let args = CameraArgs { projection: Some(ProjectionArg::Perspective), ..args };
        assert_eq!(changed(&scene, &args).unwrap().viewport, [18.0, 6.0]);
    }

    #[test]
    fn a_picture_that_looks_squashed_is_told() {
        let mut scene = loaded(look_at(Vec3::NEG_Z));
        let size = |size| CameraArgs { size: Some(size), ..CameraArgs::default() };
        let says = |scene: &LoadedScene, args| squashed(&camera(scene, &args).unwrap(), &args);
        assert_eq!(says(&scene, size([100, 100])), None);
        scene.viewport_stated = true;
        assert_eq!(says(&scene, size([400, 200])), None);
        assert_eq!(says(&scene, CameraArgs::default()), None);
        let hint = "the viewport is 2 x 1 whatever the size, so the pixels of an image of 100x100 are \
                    not square; --viewport 1,1 makes them so";
        assert_eq!(says(&scene, size([100, 100])).unwrap(), hint);
    }

    #[test]
    fn a_frame_can_be_given_another_up() {
        let up = Some(Vec3::X);
        let frame = CameraDescription::default().orientation;
        let turned = Orientation::Direction { direction: Vec3::NEG_Z, up: Vec3::X };
        assert_eq!(orientation(frame, None, up), turned);
        let target = Vec3::new(1.0, 2.0, 3.0);
        let looking = Orientation::LookAt { target, up: Vec3::Y };
        assert_eq!(orientation(frame, Some(target), None), looking);
        assert_eq!(orientation(frame, None, None), frame);
    }

    #[test]
    fn a_degenerate_change_is_named() {
        let args = CameraArgs {
            up: Some(Vec3::Z),
            look_at: Some(Vec3::new(0.0, 0.0, -8.0)),
            ..CameraArgs::default()
        };
        let message = camera(&loaded(look_at(Vec3::X)), &args).unwrap_err().to_string();
        assert!(message.starts_with("the camera of 'test' with --look-at, --up: up "), "{message}");
    }
}
