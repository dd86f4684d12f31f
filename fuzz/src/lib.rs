//! Shared parts of the fuzz targets: they turn bytes into a hostile scene, and check frames, meshes and messages.
//!
//! The first bytes choose the kind of coordinates, the next ones the camera, and all others the objects. So small changes
//! of the bytes are small changes of the scene.

mod numbers;
mod objects;
mod readers;

use bothways_common::engine::simd::{Level, levels};
use bothways_common::glam::{Quat, Vec3};
use bothways_common::{
    Camera, CameraDescription, Events, Frame, Options, Orientation, Projection, Scene, View,
};
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use numbers::Numbers;
pub use readers::{check_mesh, check_message, textured, with_checksums};

/// The largest side of an image: of most images, and of those that are larger than tiles and blocks.
const SIDES: [u32; 2] = [14, 48];

/// One scene, and how to draw it.
#[derive(Debug)]
pub struct Case {
    /// The scene.
    pub scene: Scene,
    /// The camera.
    pub camera: Camera,
    /// One or two samples along a side of a pixel, and no crop.
    pub options: Options,
    /// The SIMD level: an index into those of the machine, modulo their number.
    pub level: usize,
    /// The number of rows and of columns of a tile, as powers of two.
    pub tile: [u32; 2],
    /// A camera that draws into the same frame first, so that its memory is not fresh.
    pub before: Option<Camera>,
}

impl Case {
    /// The case that some bytes describe; `None` for a camera that is refused.
    pub fn decode(bytes: &[u8]) -> Option<Case> {
        decode(&mut Unstructured::new(bytes)).ok().flatten()
    }

    /// The scene as the camera sees it.
    pub fn view(&self) -> View<'_> {
        View::new(&self.scene, &self.camera)
    }
}

fn decode(bytes: &mut Unstructured) -> Result<Option<Case>> {
    let numbers = Numbers::choose(bytes)?;
    let samples = if bytes.ratio(1, 4)? { 2 } else { 1 };
    let level = usize::from(bytes.arbitrary::<u8>()?);
    let tile = [bytes.int_in_range(0..=7)?, bytes.int_in_range(0..=7)?];
    let description = camera(bytes, numbers)?;
    let moved = CameraDescription { eye: numbers.point(bytes)?, ..description };
    let reused = bytes.ratio(1, 4)?;
    let scene = Scene::new(objects::objects(bytes, numbers)?).expect("only valid objects are made");
    let case = |camera| Case {
        scene,
        camera,
        options: Options { samples, ..Options::default() },
        level,
        tile,
        before: Camera::new(moved).ok().filter(|_| reused),
    };
    Ok(Camera::new(description).ok().map(case))
}

fn camera(bytes: &mut Unstructured, numbers: Numbers) -> Result<CameraDescription> {
    let projection = *bytes.choose(&[Projection::Perspective, Projection::Parallel])?;
    let most = SIDES[usize::from(bytes.ratio(1, 8)?)];
    let image = [bytes.int_in_range(1..=most)?, bytes.int_in_range(1..=most)?];
    let eye = if bytes.ratio(1, 2)? { Vec3::ZERO } else { numbers.point(bytes)? };
    // Zero bytes give the first choice: aligned with the axes.
    let orientation = match bytes.int_in_range(0..=4)? {
        0 | 1 => Orientation::Frame { u: Vec3::X, v: Vec3::Y, w: Vec3::Z },
        // Tilted so little that rounded sums may lose it.
        2 => {
            let mut little = || -> Result<f32> {
                let part = f32::from(bytes.int_in_range(-3..=3_i8)?);
                Ok(part * (bytes.int_in_range(-100..=-20)? as f32).exp2())
            };
            let (w, roll) = (Vec3::new(little()?, little()?, 1.0), little()?);
            let (u, v) = (Vec3::new(1.0, roll, 0.0), Vec3::new(-roll, 1.0, 0.0));
            if bytes.arbitrary()? {
                Orientation::Frame { u, v, w }
            } else {
                Orientation::Direction { direction: -w, up: v }
            }
        }
        3 => Orientation::Direction { direction: numbers.point(bytes)?, up: numbers.point(bytes)? },
        _ => {
            let turn = Quat::from_rotation_y(numbers::fraction(bytes)? * 6.3)
                * Quat::from_rotation_x(numbers::fraction(bytes)? * 3.0 - 1.5)
                * Quat::from_rotation_z(numbers::fraction(bytes)? * 6.0);
            Orientation::Direction { direction: turn * Vec3::NEG_Z, up: turn * Vec3::Y }
        }
    };
    let (distance, viewport) = distance_and_viewport(bytes, numbers, image)?;
    Ok(CameraDescription { projection, eye, orientation, distance, viewport, image })
}

/// The distance and the viewport of a camera.
fn distance_and_viewport(
    bytes: &mut Unstructured,
    numbers: Numbers,
    image: [u32; 2],
) -> Result<(f32, [f32; 2])> {
    // The side of a pixel is a power of two.
    let aligned = |power: i32| image.map(|side| side as f32 * (power as f32).exp2());
    let wide = [8.0, 8.0 * image[1] as f32 / image[0] as f32];
    Ok(match bytes.int_in_range(0..=if numbers.is_extreme() { 7 } else { 3 })? {
        0 => (1.0, aligned(0)),
        1 => (*bytes.choose(&[0.5, 1.0, 2.0, 8.0])?, aligned(bytes.int_in_range(-4..=1)?)),
        2 => (1.0, wide),
        3 => {
            (2.0, [4.0 * numbers::fraction(bytes)? + 0.01, 4.0 * numbers::fraction(bytes)? + 0.01])
        }
        4 => ((-64f32).exp2(), [(-44f32).exp2(), (-60f32).exp2()]),
        5 => (64f32.exp2(), [(-64f32).exp2(), 64f32.exp2()]),
        6 => (1.0, [20f32.exp2(), 10f32.exp2()]),
        _ => {
            let side =
                (bytes.int_in_range(-40..=40)? as f32).exp2() * (1.0 + numbers::fraction(bytes)?);
            let distance = (bytes.int_in_range(-40..=40)? as f32).exp2();
            (distance.max(side * (-19f32).exp2()), [side, side])
        }
    })
}

/// Draws the case that some bytes describe with a textbook and with a fast renderer, and compares the frames.
///
/// `prepare` prepares the fast renderer at one of the SIMD levels of the machine, and returns the function that draws.
///
/// # Panics
///
/// If the frames differ.
pub fn check<D: Fn(&View, &mut Frame)>(
    bytes: &[u8],
    textbook: impl FnOnce(&View, &Options, &mut Frame, &mut dyn Events),
    prepare: impl FnOnce(&Case, Level) -> D,
) {
    let Some(case) = Case::decode(bytes) else {
        return;
    };
    let mut expected = Frame::new(&case.camera, &case.options);
    textbook(&case.view(), &case.options, &mut expected, &mut ());

    let levels = levels();
    let draw = prepare(&case, levels[case.level % levels.len()]);
    let mut frame = Frame::new(&case.camera, &case.options);
    if let Some(before) = &case.before {
        draw(&View::new(&case.scene, before), &mut frame);
    }
    draw(&case.view(), &mut frame);
    assert_same(&case, &expected, &frame);
}

/// Checks that ids are equal, and distances within a relative error of 10⁻⁵.
fn assert_same(case: &Case, expected: &Frame, frame: &Frame) {
    let width = expected.width();
    for index in 0..expected.ids().len() {
        let place = (index / width, index % width);
        let (id, other) = (expected.ids().get(index), frame.ids().get(index));
        assert_eq!(id, other, "ids at sample {place:?} of {case:#?}");
        let (t, other) = (expected.distances()[index], frame.distances()[index]);
        let close = t == other || (t - other).abs() <= 1e-5 * t;
        assert!(close, "t {t} and {other} at sample {place:?} of {case:#?}");
    }
}

/// Makes all parallel code run on the thread of the fuzzer, which runs several processes itself.
pub fn on_one_thread() {
    let builder = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    builder.build_global().expect("this is the first use of the pool");
}
