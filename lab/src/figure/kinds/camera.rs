//! The lecture's drawing of the camera: eye, frame, viewport and viewing rays, from outside and from the side, and the
//! formulas with the numbers of one pixel.

mod outside;
mod side;
mod stage;
mod viewing_ray;

use self::stage::Stage;
use self::viewing_ray::{SIDE, ViewingRay};
use super::interest::pixels_of_objects;
use crate::common::Projection;
use crate::common::glam::{DVec3, Vec3};
use crate::figure::drawing::Drawing;
use crate::figure::sheet::{Sheet, number};
use crate::figure::subject::{FigureError, Subject};
use crate::figure::theme::{Role, Theme};

/// The first baseline of the formulas.
const FORMULAS: f64 = 628.0;
/// How many rays are drawn if nobody chooses pixels.
const RAYS: usize = 3;

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let camera = subject.view.camera;
    let (title, point) = match camera.projection() {
        Projection::Perspective => (
            "The camera: perspective projection",
            "All viewing rays start at the eye; each goes through the middle of its pixel on the viewport.",
        ),
        Projection::Parallel => (
            "The camera: parallel projection",
            "All viewing rays have the direction −𝐰; each starts where its pixel lies in the plane of the eye.",
        ),
    };
    let mut sheet = Sheet::new(subject, title, point);
    let chosen = if subject.pixels.is_empty() {
        pixels_of_objects(&subject.view, RAYS)
    } else {
        subject.pixels.to_vec()
    };
    let colors = ray_colors(subject.theme);
    let rays: Vec<ViewingRay> = chosen
        .iter()
        .zip(colors.into_iter().cycle())
        .map(|(pixel, color)| ViewingRay::new(&subject.view, *pixel, color))
        .collect();
    let stage = Stage::new(subject, &rays);
    outside::draw(&mut sheet, subject, &stage, &rays)?;
    side::draw(&mut sheet, subject, &stage, &rays[0]);
    formulas(&mut sheet, subject, &rays[0]);
    Ok(sheet.drawing)
}

/// The colours of the rays: what is looked at first, then categories.
fn ray_colors(theme: Theme) -> [[u8; 3]; 4] {
    [theme.of(Role::Focus), theme.of(Role::Image), theme.of(Role::Good), theme.of(Role::Object)]
}

/// The lecture's formulas with the numbers of the first pixel.
fn formulas(sheet: &mut Sheet, subject: &Subject, ray: &ViewingRay) {
    let camera = subject.view.camera;
    let theme = sheet.theme;
    let [i, j] = ray.pixel;
    let ([vw, vh], [width, height]) =
        (camera.viewport().map(|side| number(side, 4)), camera.image());
    let [x, y] = ray.report.place.map(|part| number(part, 4));
    let vector = |vector: DVec3| {
        format!("({}, {}, {})", number(vector.x, 4), number(vector.y, 4), number(vector.z, 4))
    };
    let eye = |eye: Vec3| vector(eye.as_dvec3());
    let direction = vector(ray.ray().direction);
    let [left, width_of_lines] = [SIDE.0[0], SIDE.1[0]];
    let (formula, quiet) = (theme.text(), theme.label());
    let focus = theme.heading().sized(27.0).of(theme.of(Role::Focus));
    let mut lines = vec![
        (format!("The ray of pixel ({i}, {j})"), focus),
        (format!("The lecture counts from 1: i = {}, j = {}", i + 1, j + 1), quiet),
        (format!("x = vw ((j − ½)/W − ½) = {vw} (({} − ½)/{width} − ½) = {x}", j + 1), formula),
        (format!("y = −vh ((i − ½)/H − ½) = −{vh} (({} − ½)/{height} − ½) = {y}", i + 1), formula),
    ];
    let origin = eye(camera.eye());
    match camera.projection() {
        Projection::Perspective => lines.extend([
            (format!("origin 𝐩 = eye = {origin}"), formula),
            (format!("direction 𝐝 = x 𝐮 + y 𝐯 − d 𝐰 = {direction}"), formula),
        ]),
        Projection::Parallel => {
            let moved = vector(camera.eye().as_dvec3() + ray.ray().origin);
            lines.extend([
                (format!("origin 𝐩 = eye + x 𝐮 + y 𝐯 = {moved}"), formula),
                (format!("direction 𝐝 = −𝐰 = {direction}"), formula),
            ]);
        }
    }
    lines.push(match ray.report.covering.first() {
        None => ("It hits nothing: the background is seen.".into(), formula),
        Some(nearest) => {
            let kind = nearest.kind;
            (
                format!("nearest hit: {kind}, id {}, at t = {}", nearest.id, number(nearest.t, 5)),
                formula,
            )
        }
    });
    let lines: Vec<_> = lines.iter().map(|(line, style)| (line.as_str(), *style)).collect();
    sheet.lines([left, FORMULAS], width_of_lines, 46.0, &lines);
}
