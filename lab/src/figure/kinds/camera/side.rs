//! The camera from the side, as the lecture draws it.

use super::stage::Stage;
use super::viewing_ray::{SIDE, ViewingRay, label_at};
use crate::common::glam::DVec3;
use crate::common::{Camera, CameraDescription, Crop, Options, View};
use crate::figure::drawing::{Drawing, Ink, Pen};
use crate::figure::sheet::{Sheet, number};
use crate::figure::subject::{Subject, seen};
use crate::figure::theme::{Role, Theme};

/// Draws the panel: `−w` to the right, `v` up, in the column of the first pixel.
pub(super) fn draw(sheet: &mut Sheet, subject: &Subject, stage: &Stage, ray: &ViewingRay) {
    let camera = subject.view.camera;
    let theme = sheet.theme;
    let (corner, size) = SIDE;
    let note = format!("the surfaces in column {}", ray.pixel[1]);
    sheet.heading(corner, size[0], "from the side", &note);
    sheet.mat(corner, size);
    let profile = profile(&subject.view, ray.pixel[1]);
    let side = |point: DVec3| [-point.dot(camera.w()), point.dot(camera.v())];
    let mut points: Vec<[f64; 2]> = profile.iter().map(|(point, _)| side(*point)).collect();
    points.retain(|[depth, _]| *depth <= stage.deepest);
    points.extend(stage.viewport.map(side));
    points.extend([[0.0, 0.0], side(stage.end(ray, camera))]);
    let ([near, far], [low, high]) = (bounds(&points, 0), bounds(&points, 1));
    let scale = (0.84 * size[0] / (far - near)).min(0.68 * size[1] / (high - low).max(1e-300));
    let place = |point: DVec3| {
        let [depth, height] = side(point);
        [
            corner[0] + 0.5 * size[0] + scale * (depth - 0.5 * (near + far)),
            corner[1] + 0.48 * size[1] - scale * (height - 0.5 * (low + high)),
        ]
    };
    let drawing = &mut sheet.drawing;
    drawing.window(Some((corner, size)));
    let eye = place(DVec3::ZERO);
    let axis = Pen::new(theme.quiet(), 1.5).dashed(2.0, 7.0);
    let right = corner[0] + size[0];
    drawing.line(&[eye, [right, eye[1]]], axis);
    for pair in profile.windows(2) {
        let ([from, to], same) = ([place(pair[0].0), place(pair[1].0)], pair[0].1 == pair[1].1);
        if same && (from[0] - to[0]).hypot(from[1] - to[1]) < 24.0 {
            drawing.line(&[from, to], Pen::new(theme.bright(), 4.0));
        }
    }
    let focus = theme.of(Role::Focus);
    let edge = Pen::new(theme.of(Role::Camera), 1.6).alpha(0.8);
    let [top, _, _, bottom] = stage.viewport;
    for (origin, end) in [(stage.origins[0], top), (stage.origins[3], bottom)] {
        drawing.line(&[place(origin), place(end)], edge);
    }
    drawing.line(&[place(ray.ray().origin), place(stage.end(ray, camera))], Pen::new(focus, 4.0));
    drawing.line(&[place(top), place(bottom)], Pen::new(theme.of(Role::Camera), 4.0));
    let end = place(stage.end(ray, camera));
    if ray.t().is_some() {
        drawing.disc(end, 6.5, Ink::new(focus));
    }
    drawing.disc(eye, 8.0, theme.ink(Role::Camera));
    label_at(drawing, eye, [-0.3, 1.0], "eye", theme, theme.of(Role::Camera));
    label_at(drawing, place(top), [0.0, -1.0], "viewport", theme, theme.of(Role::Camera));
    if ray.t().is_some() {
        label_at(drawing, end, [0.8, -0.5], "hit", theme, focus);
    }
    distance(drawing, [eye[0], place(bottom)[0]], place(bottom)[1] + 42.0, (stage, camera), theme);
    let ray_middle = place(0.5 * (ray.at(stage.passing(camera)) + stage.end(ray, camera)));
    formula_at(drawing, ray_middle, "𝐫(t) = 𝐩 + t 𝐝", theme, focus);
    let w = theme.label().semi_bold();
    drawing.label([right - 34.0, eye[1]], [0.0, 1.0], "−𝐰", w, Some(theme.mat()));
    drawing.window(None);
    sheet.border(corner, size);
}

/// How far the viewport is from the eye, along a line below both.
fn distance(
    drawing: &mut Drawing,
    [from, to]: [f64; 2],
    below: f64,
    (stage, camera): (&Stage, &Camera),
    theme: Theme,
) {
    const TICK: f64 = 7.0;
    let pen = Pen::new(theme.of(Role::Camera), 1.6);
    drawing.line(&[[from, below], [to, below]], pen);
    for end in [from, to] {
        drawing.line(&[[end, below - TICK], [end, below + TICK]], pen);
    }
    let d = number(camera.distance(), 4);
    let text = match stage.enlarged {
        _ if stage.nearer => format!("nearer than d = {d}"),
        enlarged if enlarged > 1.0 => format!("{} d (d = {d})", number(enlarged, 3)),
        enlarged if enlarged < 1.0 => format!("d/{} (d = {d})", number(1.0 / enlarged, 3)),
        _ => format!("d = {d}"),
    };
    formula_at(drawing, [0.5 * (from + to), below], &text, theme, theme.of(Role::Camera));
}

/// A formula above a point. Its letters are light, so that vectors are told from numbers.
fn formula_at(drawing: &mut Drawing, point: [f64; 2], text: &str, theme: Theme, color: [u8; 3]) {
    drawing.label(point, [0.0, -1.0], text, theme.label().of(color), Some(theme.mat()));
}

/// What is seen in the middle of one column of the picture, from top to bottom: points relative to the eye, and their objects. A picture
/// of few rows has more of them here, so that surfaces are lines.
fn profile(view: &View, column: u32) -> Vec<(DVec3, usize)> {
    // An odd number of columns has the middle of the one whose place they take.
    let times = ROWS.div_ceil(view.camera.image()[1]) | 1;
    match finer(view.camera, times) {
        Some(camera) => points(&View::new(view.scene, &camera), column * times + times / 2),
        None => points(view, column),
    }
}

/// The camera with so many times the rows and columns, if such an image is allowed.
fn finer(camera: &Camera, times: u32) -> Option<Camera> {
    let [width, height] = camera.image().map(|side| side.checked_mul(times));
    let image = [width?, height?];
    Camera::new(CameraDescription { image, ..*camera.description() }).ok()
}

/// The points that are seen in one column, and their objects.
fn points(view: &View, column: u32) -> Vec<(DVec3, usize)> {
    let [_, height] = view.camera.image();
    let crop = Crop { row: 0, column, height, width: 1 };
    let frame = seen(view, &Options { crop: Some(crop), ..Options::default() });
    let rows = 0..height;
    rows.filter_map(|row| {
        let (sample_row, sample_column) = (row as usize, column as usize);
        let (id, t) = (frame.id(sample_row, sample_column)?, frame.t(sample_row, sample_column)?);
        let ray = view.camera.viewing_ray(row, column);
        Some((ray.origin + f64::from(t) * ray.direction, view.scene.locate(id).0))
    })
    .collect()
}

/// The least rows of a profile.
const ROWS: u32 = 480;

/// The least and the greatest of a coordinate.
fn bounds(points: &[[f64; 2]], axis: usize) -> [f64; 2] {
    let coordinates = points.iter().map(|point| point[axis]);
    coordinates
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
}
