//! The `[camera]` table. The documentation of [`scene_file`](super) lists its keys.

use super::color::color;
use super::document::{Item, Table};
use super::error::Problem;
use super::suggestion::suggestion;
use crate::source::quote::quoted;
use bothways_common::camera::{Camera, CameraDescription, CameraError, Orientation, Projection};
use bothways_common::raster::check_samples;
use glam::Vec3;
use std::ops::Range;

/// The content of the table.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CameraTable {
    pub(super) description: CameraDescription,
    pub(super) viewport_stated: bool,
    pub(super) background: Option<Vec3>,
}

const KEYS: [&str; 13] = [
    "projection",
    "eye",
    "look_at",
    "direction",
    "up",
    "u",
    "v",
    "w",
    "distance",
    "viewport",
    "fov",
    "image",
    "background",
];

/// Reads the table, and makes sure that [`Camera::new`] accepts the camera.
pub(super) fn read(item: &Item) -> Result<CameraTable, Problem> {
    let table = item.table(&KEYS)?;
    let misplaced =
        |error: CameraError| Problem::new(span(&table, &error), message(&table, &error));
    let standard = CameraDescription::default();
    let image = table.get("image").map_or(Ok(standard.image), |item| item.counts())?;
    // Checked first: the viewport is computed from it.
    check_samples(image, 1).map_err(CameraError::from).map_err(misplaced)?;
    let viewport = table.get("viewport").map(|item| item.pair()).transpose()?;
    let description = CameraDescription {
        projection: table.get("projection").map_or(Ok(standard.projection), |i| projection(&i))?,
        eye: table.get("eye").map_or(Ok(standard.eye), |item| item.vector())?,
        orientation: orientation(&table)?.unwrap_or(standard.orientation),
        distance: table.get("distance").map_or(Ok(standard.distance), |item| item.positive())?,
        viewport: viewport.unwrap_or(square_pixels(image)),
        image,
    };
    let description = match table.get("fov") {
        Some(item) => field_of_view(&table, &item, description)?,
        None => description,
    };
    let background = table.get("background").map(|item| color(&item)).transpose()?;
    Camera::new(description).map_err(misplaced)?;
    Ok(CameraTable { description, viewport_stated: viewport.is_some(), background })
}

/// The camera with the viewport that a field of view gives.
fn field_of_view(
    table: &Table,
    item: &Item,
    camera: CameraDescription,
) -> Result<CameraDescription, Problem> {
    let (degrees, precise) = item.number_and_f64()?;
    if let [first, second] = table.present(&["fov", "viewport"])[..] {
        let message =
            format!("the viewport's size is stated by {first} already, so not by {second}");
        let help = "give fov, the vertical angle in degrees, or viewport = [vw, vh]";
        return Err(Problem::new(table.span_of(second), message).help(help));
    }
    let refused = |error: CameraError| match error {
        CameraError::FieldOfView { .. } => {
            let written = item.written();
            let rounded = match precise {
                0.0..180.0 if precise > 0.0 => {
                    format!(", which single precision rounds to {degrees}")
                }
                _ => String::new(),
            };
            let range = "it must be greater than 0 and less than 180";
            item.problem(format!("is {written}{rounded}; {range}"))
                .help("it is the vertical angle in degrees")
        }
        _ => item
            .problem("belongs to a perspective camera; parallel rays never part")
            .help("give viewport = [vw, vh] instead"),
    };
    camera.with_field_of_view(degrees).map_err(refused)
}

/// The viewport of height 1 on which the pixels of an image are square.
pub(super) fn square_pixels([width, height]: [u32; 2]) -> [f32; 2] {
    [width as f32 / height as f32, 1.0]
}

fn projection(item: &Item) -> Result<Projection, Problem> {
    match item.text()? {
        "perspective" => Ok(Projection::Perspective),
        "parallel" => Ok(Projection::Parallel),
        other => Err(item.problem(format!("is {}", quoted(other))).help(suggestion(
            "projections",
            other,
            ["perspective", "parallel"],
        ))),
    }
}

/// The camera frame as the table states it; `None` if it does not.
fn orientation(table: &Table) -> Result<Option<Orientation>, Problem> {
    let stated = table.present(&["look_at", "direction", "u", "v", "w"]);
    let first = stated.first().copied();
    let by_axes = first.is_some_and(is_axis);
    let excess = |key: &&str| Some(*key) != first && !(by_axes && is_axis(key));
    let up = table.present(&["up"]).into_iter().filter(|_| by_axes);
    if let (Some(first), Some(excess)) = (first, stated.iter().copied().chain(up).find(excess)) {
        let message =
            format!("the camera's frame is stated by {first} already, so not by {excess}");
        let help = "give look_at and up, or direction and up, or u, v and w";
        return Err(Problem::new(table.span_of(excess), message).help(help));
    }

    if by_axes {
        let axis = |key, example| table.need(key, example)?.direction();
        let (u, v) = (axis("u", "u = [1, 0, 0]")?, axis("v", "v = [0, 1, 0]")?);
        return Ok(Some(Orientation::Frame { u, v, w: axis("w", "w = [0, 0, 1]")? }));
    }
    let up = table.get("up").map(|item| item.direction()).transpose()?;
    let target = table.get("look_at").map(|item| item.vector()).transpose()?;
    let view = table.get("direction").map(|item| item.direction()).transpose()?;
    Ok(match (target, view, up) {
        (None, None, None) => None,
        (Some(target), ..) => Some(Orientation::LookAt { target, up: up.unwrap_or(Vec3::Y) }),
        (None, view, up) => Some(Orientation::Direction {
            direction: view.unwrap_or(Vec3::NEG_Z),
            up: up.unwrap_or(Vec3::Y),
        }),
    })
}

fn is_axis(key: &str) -> bool {
    matches!(key, "u" | "v" | "w")
}

/// The message about an error. It names `fov` if the viewport follows from it.
fn message(table: &Table, error: &CameraError) -> String {
    let fov = table.get("fov").filter(|_| is_about_viewport(error));
    fov.map_or(error.to_string(), |fov| format!("fov is {}, so {error}", fov.written()))
}

fn is_about_viewport(error: &CameraError) -> bool {
    match error {
        CameraError::OutOfRange { what, .. } => *what != DISTANCE,
        CameraError::TooWide { .. } => true,
        _ => false,
    }
}

/// What [`CameraError::OutOfRange`] calls the distance.
const DISTANCE: &str = "the distance";

/// The place of the key that an error is about, or of the table.
fn span(table: &Table, error: &CameraError) -> Range<usize> {
    let keys: &[&str] = match error {
        CameraError::LooksAtItself { .. } => &["look_at"],
        CameraError::UpAlongView { .. } => &["up", "look_at", "direction"],
        CameraError::NotAFrame { .. } => &["u"],
        CameraError::OutOfRange { what: DISTANCE, .. } => &["distance"],
        CameraError::OutOfRange { .. } | CameraError::TooWide { .. } => {
            &["viewport", "fov", "distance", "image"]
        }
        CameraError::Size(_) => &["image"],
        CameraError::FieldOfView { .. } | CameraError::ParallelFieldOfView => &["fov"],
        // These cannot occur: the reader has refused numbers that are not finite and directions that are zero.
        CameraError::NotFinite { .. } | CameraError::NoDirection { .. } => &[],
    };
    let item = keys.iter().find_map(|key| table.get(key));
    item.map_or(table.span.clone(), |item| item.span)
}
