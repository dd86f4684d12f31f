//! The camera from outside: a parallel camera to the right of, above and behind it, with hidden lines dashed.

use super::stage::Stage;
use super::viewing_ray::{ViewingRay, label_at};
use crate::common::glam::DVec3;
use crate::common::{Camera, CameraDescription, Frame, Options, Orientation, Projection, View};
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::project::Projector;
use crate::figure::sheet::{BOTTOM, MARGIN, Sheet, TOP, number};
use crate::figure::subject::{FigureError, Subject, seen, small_picture};
use crate::figure::theme::{Role, Theme, mixed};
use crate::picture::picture;
use image::RgbImage;

/// The panel of the view from outside.
const OUTSIDE: ([f64; 2], [f64; 2]) = ([MARGIN, TOP + 44.0], [1084.0, BOTTOM - TOP - 44.0]);

/// Draws the panel.
pub(super) fn draw(
    sheet: &mut Sheet,
    subject: &Subject,
    stage: &Stage,
    rays: &[ViewingRay],
) -> Result<(), FigureError> {
    let camera = subject.view.camera;
    let mut points: Vec<DVec3> = stage.viewport.to_vec();
    points.extend(stage.origins);
    points.extend(&stage.seen);
    points.extend(rays.iter().map(|ray| stage.end(ray, camera)));
    let axis = 0.6 * (stage.viewport[1] - stage.viewport[0]).length();
    points.extend([DVec3::ZERO, axis * camera.w(), axis * camera.u(), axis * camera.v()]);
    let outside = Outside::new(subject, &points).ok_or_else(|| {
        FigureError::new("the scene is too large or too small to be drawn from outside")
    })?;
    let (corner, size) = OUTSIDE;
    let [width, height] = camera.image();
    let note = match grid_step(width.max(height)) {
        1 => "dashed: behind something".to_owned(),
        step => format!("a cell of the grid is {step} × {step} pixels; dashed: behind something"),
    };
    sheet.heading(corner, size[0], "from outside", &note);
    let theme = sheet.theme;
    let drawing = &mut sheet.drawing;
    drawing.picture(faded(&picture(&outside.frame), &outside.frame, theme), corner, size);
    drawing.window(Some((corner, size)));
    for ray in rays.iter().rev() {
        let through = ray.at(stage.passing(camera));
        outside.line(drawing, through, stage.end(ray, camera), Pen::new(ray.color, 4.0));
    }
    let frame_pen = Pen::new(theme.of(Role::Camera), 3.0);
    pyramid(drawing, &outside, stage, camera, frame_pen);
    viewport(drawing, &outside, subject, stage, rays);
    ends_of_rays(drawing, &outside, stage, rays, subject);
    axes(drawing, &outside, stage, camera, theme);
    drawing.disc(outside.place(DVec3::ZERO), 9.0, theme.ink(Role::Camera));
    outside_labels(drawing, &outside, stage, camera, theme);
    for ray in rays {
        let Some(t) = ray.t() else { continue };
        let label = format!("t = {}", number(t, 4));
        label_at(
            drawing,
            outside.place(stage.end(ray, camera)),
            [0.7, 0.5],
            &label,
            theme,
            ray.color,
        );
    }
    drawing.window(None);
    sheet.border(corner, size);
    Ok(())
}

/// The rays up to the viewport, where they start, and what they hit.
fn ends_of_rays(
    drawing: &mut Drawing,
    outside: &Outside,
    stage: &Stage,
    rays: &[ViewingRay],
    subject: &Subject,
) {
    let camera = subject.view.camera;
    for ray in rays.iter().rev() {
        let (start, through) =
            (outside.place(ray.ray().origin), outside.place(ray.at(stage.passing(camera))));
        drawing.line(&[start, through], Pen::new(ray.color, 4.0));
        drawing.disc(start, 4.0, Ink::new(ray.color));
        if ray.t().is_some() {
            let end = outside.place(stage.end(ray, camera));
            drawing.disc(end, 9.0, Ink::new(subject.theme.background()));
            drawing.disc(end, 6.5, Ink::new(ray.color));
        }
    }
}

/// The view from outside: a parallel camera to the right of, above and behind the scene's camera.
struct Outside {
    camera: Camera,
    /// From the scene camera's eye to this one's.
    eye: DVec3,
    frame: Frame,
}

impl Outside {
    fn new(subject: &Subject, points: &[DVec3]) -> Option<Outside> {
        let own = subject.view.camera;
        let back = (0.72 * own.u() + 0.36 * own.v() + 0.52 * own.w()).normalize();
        let right = own.v().cross(back).normalize();
        let up = back.cross(right);
        let extent = |axis: DVec3| {
            points
                .iter()
                .map(|point| point.dot(axis))
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| {
                    [low.min(at), high.max(at)]
                })
        };
        let ([left, far_right], [low, high], [_, near]) = (extent(right), extent(up), extent(back));
        let (_, [panel_width, panel_height]) = OUTSIDE;
        let per_unit =
            ((far_right - left) / (0.86 * panel_width)).max((high - low) / (0.84 * panel_height));
        let size = [panel_width * per_unit, panel_height * per_unit];
        // What lies before all of the drawing is cut away: it would hide a camera in a room.
        let cut = near + 0.04 * (far_right - left + high - low);
        let center = 0.5 * (left + far_right) * right + 0.5 * (low + high) * up + cut * back;
        let single = |vector: DVec3| vector.as_vec3();
        let description = CameraDescription {
            projection: Projection::Parallel,
            eye: single(own.eye().as_dvec3() + center),
            orientation: Orientation::Frame { u: single(right), v: single(up), w: single(back) },
            distance: single(DVec3::splat(size[0])).x,
            viewport: size.map(|side| single(DVec3::splat(side)).x),
            image: [1084, 758],
        };
        let camera = Camera::new(description).ok()?;
        let eye = camera.eye().as_dvec3() - own.eye().as_dvec3();
        let frame = seen(&View::new(subject.view.scene, &camera), &Options::default());
        Some(Outside { camera, eye, frame })
    }

    /// The place on the canvas of a point relative to the scene camera's eye.
    fn place(&self, point: DVec3) -> [f64; 2] {
        let place = Projector { camera: &self.camera }.place(point - self.eye);
        let ([x, y], _) = OUTSIDE;
        place.map_or([f64::NAN; 2], |[column, row]| [x + column, y + row])
    }

    /// Whether something of the scene lies before the point.
    fn is_hidden(&self, point: DVec3) -> bool {
        let ([x, y], _) = OUTSIDE;
        let [column, row] = self.place(point);
        let (column, row) = (column - x, row - y);
        let within = |at: f64, side: usize| (at >= 0.0 && at < side as f64).then_some(at.floor());
        let (Some(column), Some(row)) =
            (within(column, self.frame.width()), within(row, self.frame.height()))
        else {
            return false;
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "within the picture"
        )]
        let t = self.frame.t(row as usize, column as usize);
        let depth = (self.eye - point).dot(self.camera.w());
        t.is_some_and(|t| f64::from(t) < depth - 2e-3 * self.camera.viewport()[0])
    }

    /// A line in space: thin where something lies before it.
    fn line(&self, drawing: &mut Drawing, from: DVec3, to: DVec3, pen: Pen) {
        const PARTS: u32 = 160;
        let at = |part: u32| from + f64::from(part) / f64::from(PARTS) * (to - from);
        let hidden: Vec<bool> =
            (0..PARTS).map(|part| self.is_hidden(0.5 * (at(part) + at(part + 1)))).collect();
        let mut begin = 0;
        for part in 1..=PARTS {
            if part == PARTS || hidden[part as usize] != hidden[begin as usize] {
                let behind = Pen { width: 0.5 * pen.width, ..pen.dashed(4.0, 8.0) };
                let pen = if hidden[begin as usize] { behind } else { pen };
                drawing.line(&[self.place(at(begin)), self.place(at(part))], pen);
                begin = part;
            }
        }
    }
}

/// From the eye, or the plane of the eye, to the corners of the viewport.
fn pyramid(drawing: &mut Drawing, outside: &Outside, stage: &Stage, camera: &Camera, pen: Pen) {
    let thin = Pen { width: 1.6, ..pen }.alpha(0.8);
    for (origin, corner) in stage.origins.into_iter().zip(stage.viewport) {
        drawing.line(&[outside.place(origin), outside.place(corner)], thin);
    }
    if camera.projection() == Projection::Parallel {
        drawing.closed_line(
            &stage.origins.map(|corner| outside.place(corner)),
            thin.dashed(10.0, 7.0),
        );
    }
    drawing
        .line(&[outside.place(DVec3::ZERO), outside.place(stage.middle())], thin.dashed(2.0, 7.0));
}

/// The viewport with the picture on it, its grid of pixels, and the pixels of the rays.
fn viewport(
    drawing: &mut Drawing,
    outside: &Outside,
    subject: &Subject,
    stage: &Stage,
    rays: &[ViewingRay],
) {
    let theme = subject.theme;
    let camera = subject.view.camera;
    let [a, b, c, d] = stage.viewport.map(|corner| outside.place(corner));
    drawing.tilted_picture(small_picture(&subject.view, 480), [a, b, d], 0.92);
    let at = |x: f64, y: f64| {
        [0, 1].map(|axis| {
            a[axis] * (1.0 - x) * (1.0 - y)
                + b[axis] * x * (1.0 - y)
                + c[axis] * x * y
                + d[axis] * (1.0 - x) * y
        })
    };
    let [width, height] = camera.image();
    let step = grid_step(width.max(height));
    let line = Pen::new(theme.of(Role::Camera), 1.0).alpha(0.75);
    for column in (step..width).step_by(step as usize) {
        let x = f64::from(column) / f64::from(width);
        drawing.line(&[at(x, 0.0), at(x, 1.0)], line);
    }
    for row in (step..height).step_by(step as usize) {
        let y = f64::from(row) / f64::from(height);
        drawing.line(&[at(0.0, y), at(1.0, y)], line);
    }
    drawing.closed_line(&[a, b, c, d], Pen::new(theme.of(Role::Camera), 3.5));
    for ray in rays {
        let [i, j] = ray.pixel.map(f64::from);
        let [w, h] = [width, height].map(f64::from);
        let pixel = [
            at(j / w, i / h),
            at((j + 1.0) / w, i / h),
            at((j + 1.0) / w, (i + 1.0) / h),
            at(j / w, (i + 1.0) / h),
        ];
        drawing.polygon(&pixel, Ink::new(ray.color));
        drawing.ring(at((j + 0.5) / w, (i + 0.5) / h), 8.0, Pen::new(ray.color, 2.5));
    }
}

/// How many pixels lie between two lines of the grid, so that at most sixteen cells are drawn.
fn grid_step(side: u32) -> u32 {
    let steps = (0..6).flat_map(|power| [1, 2, 4, 5, 8].map(|digit| digit * 10_u32.pow(power)));
    steps.into_iter().find(|step| side.div_ceil(*step) <= 16).unwrap_or(side)
}

/// The camera's frame at the eye.
fn axes(drawing: &mut Drawing, outside: &Outside, stage: &Stage, camera: &Camera, theme: Theme) {
    let viewport = (stage.viewport[1] - stage.viewport[0])
        .length()
        .max((stage.viewport[3] - stage.viewport[0]).length());
    let length = (0.5 * viewport)
        .clamp(0.06 * outside.camera.viewport()[0], 0.16 * outside.camera.viewport()[0]);
    for (axis, name) in [(camera.u(), "𝐮"), (camera.v(), "𝐯"), (camera.w(), "𝐰")] {
        let tip = outside.place(length * axis);
        drawing.arrow(outside.place(DVec3::ZERO), tip, Pen::new(theme.bright(), 3.0));
        let name_at = outside.place(1.16 * length * axis);
        let style = theme.text().semi_bold();
        drawing.text_with_halo(
            [name_at[0], name_at[1] + 8.0],
            Anchor::Middle,
            name,
            style,
            Some(theme.mat()),
        );
    }
}

fn outside_labels(
    drawing: &mut Drawing,
    outside: &Outside,
    stage: &Stage,
    camera: &Camera,
    theme: Theme,
) {
    label_at(
        drawing,
        outside.place(DVec3::ZERO),
        [-0.4, 1.0],
        "eye",
        theme,
        theme.of(Role::Camera),
    );
    let [vw, vh] = camera.viewport().map(|side| number(side, 4));
    let [a, b, c, d] = stage.viewport.map(|corner| outside.place(corner));
    let bottom = if c[1] > d[1] { c } else { d };
    let top = if a[1] < b[1] { a } else { b };
    label_at(
        drawing,
        top,
        [-0.6, -1.0],
        &format!("viewport, vw × vh = {vw} × {vh}"),
        theme,
        theme.of(Role::Camera),
    );
    if stage.enlarged != 1.0 {
        let how = if stage.enlarged > 1.0 {
            format!("{} times as far and as large", number(stage.enlarged, 3))
        } else {
            format!("at 1/{} of the distance and size", number(1.0 / stage.enlarged, 3))
        };
        let note = format!("drawn {how}: its rays are the same");
        label_at(drawing, bottom, [0.0, 1.0], &note, theme, theme.of(Role::Camera));
    }
    if stage.nearer {
        let note = "drawn nearer than d: no ray depends on d";
        label_at(drawing, bottom, [0.0, 1.0], note, theme, theme.of(Role::Camera));
    }
}

/// The picture from outside, paler than what is drawn over it.
fn faded(picture: &RgbImage, frame: &Frame, theme: Theme) -> RgbImage {
    let mut faded = picture.clone();
    for (x, y, pixel) in faded.enumerate_pixels_mut() {
        let seen = frame.id(y as usize, x as usize).is_some();
        let part = if seen { 0.62 } else { 0.0 };
        pixel.0 = mixed(theme.mat(), pixel.0, part);
    }
    faded
}
