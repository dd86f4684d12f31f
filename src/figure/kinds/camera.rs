//! The lecture's drawing of the camera: eye, frame, viewport and viewing rays, from outside and from the side, and the
//! formulas with the numbers of one pixel.

use crate::common::glam::{DVec3, Vec3};
use crate::common::{
    Camera, CameraDescription, Crop, Frame, Options, Orientation, Projection, Ray, Shape, View,
};
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::project::Projector;
use crate::figure::sheet::{BOTTOM, MARGIN, RIGHT, Sheet, TOP, number};
use crate::figure::subject::{FigureError, Subject, seen, small_picture};
use crate::figure::theme::{Role, Theme, mixed};
use crate::picture::picture;
use crate::pixel::{self, SampleReport};
use std::collections::BTreeMap;

/// The panel of the view from outside.
const OUTSIDE: ([f64; 2], [f64; 2]) = ([MARGIN, TOP + 44.0], [1084.0, BOTTOM - TOP - 44.0]);
/// The panel of the view from the side.
const SIDE: ([f64; 2], [f64; 2]) = ([1204.0, TOP + 44.0], [RIGHT - 1204.0, 330.0]);
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
            "All viewing rays have the direction −w; each starts where its pixel lies in the plane of the eye.",
        ),
    };
    let mut sheet = Sheet::new(subject, title, point);
    let chosen =
        if subject.pixels.is_empty() { telling(&subject.view) } else { subject.pixels.to_vec() };
    let colors = ray_colors(subject.theme);
    let rays: Vec<ViewingRay> = chosen
        .iter()
        .zip(colors.into_iter().cycle())
        .map(|(pixel, color)| ViewingRay::new(&subject.view, *pixel, color))
        .collect();
    let stage = Stage::new(subject, &rays);
    outside(&mut sheet, subject, &stage, &rays)?;
    from_the_side(&mut sheet, subject, &stage, &rays[0]);
    formulas(&mut sheet, subject, &rays[0]);
    Ok(sheet.drawing)
}

/// The viewing ray of a pixel, and what it hits. All points are relative to the eye.
struct ViewingRay {
    pixel: [u32; 2],
    color: [u8; 3],
    report: SampleReport,
}

impl ViewingRay {
    fn new(view: &View, pixel: [u32; 2], color: [u8; 3]) -> ViewingRay {
        let report = pixel::report(view, &Options::default(), pixel[0], pixel[1]).remove(0);
        ViewingRay { pixel, color, report }
    }

    fn ray(&self) -> Ray {
        self.report.ray
    }

    fn at(&self, t: f64) -> DVec3 {
        self.ray().origin + t * self.ray().direction
    }

    fn t(&self) -> Option<f64> {
        self.report.covering.first().map(|nearest| nearest.t)
    }
}

/// Pixels that show different objects: of each of the largest objects in the picture, the pixel nearest to the middle of
/// what is seen of it. The one nearest to the middle of the picture comes first.
fn telling(view: &View) -> Vec<[u32; 2]> {
    const ACROSS: u32 = 64;
    let [width, height] = view.camera.image();
    let step = (width.max(height) / ACROSS).max(1);
    let description = CameraDescription {
        image: [width, height].map(|side| side.div_ceil(step)),
        ..*view.camera.description()
    };
    let camera = Camera::new(description).expect("a smaller image is allowed");
    let small = View::new(view.scene, &camera);
    let frame = seen(&small, &Options::default());
    let mut objects: BTreeMap<usize, Vec<[usize; 2]>> = BTreeMap::new();
    for (row, column) in samples(&frame) {
        if let Some(id) = frame.id(row, column) {
            objects.entry(view.scene.locate(id).0).or_default().push([row, column]);
        }
    }
    let mut objects: Vec<Vec<[usize; 2]>> = objects.into_values().collect();
    objects.sort_by_key(|samples| std::cmp::Reverse(samples.len()));
    objects.truncate(RAYS);
    let middle = [frame.height() as f64 / 2.0, frame.width() as f64 / 2.0];
    let far =
        |[row, column]: [usize; 2], [y, x]: [f64; 2]| (row as f64 - y).hypot(column as f64 - x);
    let mut chosen: Vec<[usize; 2]> = objects
        .iter()
        .filter_map(|samples| {
            let mean = |axis: usize| {
                samples.iter().map(|sample| sample[axis] as f64).sum::<f64>() / samples.len() as f64
            };
            let center = [mean(0), mean(1)];
            samples.iter().copied().min_by(|a, b| far(*a, center).total_cmp(&far(*b, center)))
        })
        .collect();
    chosen.sort_by(|a, b| far(*a, middle).total_cmp(&far(*b, middle)));
    if chosen.is_empty() {
        chosen.push([frame.height() / 2, frame.width() / 2]);
    }
    let whole = |small: usize, side: u32| {
        u32::try_from(small)
            .expect("within the picture")
            .saturating_mul(step)
            .saturating_add(step / 2)
            .min(side - 1)
    };
    chosen.into_iter().map(|[row, column]| [whole(row, height), whole(column, width)]).collect()
}

fn samples(frame: &Frame) -> impl Iterator<Item = (usize, usize)> + use<> {
    let (height, width) = (frame.height(), frame.width());
    (0..height).flat_map(move |row| (0..width).map(move |column| (row, column)))
}

/// What both views show, relative to the eye.
struct Stage {
    /// The corners of the viewport as it is drawn: top left, top right, bottom right, bottom left.
    viewport: [DVec3; 4],
    /// How many times as far, and as large, as the camera's own viewport it is drawn.
    enlarged: f64,
    /// Whether the viewport of a parallel camera is drawn nearer than it is.
    nearer: bool,
    /// Where the rays of those corners start.
    origins: [DVec3; 4],
    /// Points of what is seen, and how far each ray is drawn that hits nothing.
    seen: Vec<DVec3>,
    deepest: f64,
}

impl Stage {
    fn new(subject: &Subject, rays: &[ViewingRay]) -> Stage {
        let camera = subject.view.camera;
        let depth = |point: &DVec3| -point.dot(camera.w());
        let seen = hits(&subject.view);
        let mut depths: Vec<f64> = seen.iter().map(depth).collect();
        depths.sort_by(f64::total_cmp);
        let of_rays = rays.iter().filter_map(|ray| Some(depth(&ray.at(ray.t()?))));
        let chosen = of_rays.fold(0.0, f64::max);
        let middle = depths.get(depths.len() / 2).copied().unwrap_or(0.0);
        // What lies far behind the rest, such as a floor near its horizon, is left out of the drawing.
        let most = 1.25 * chosen.max(1.6 * middle);
        let own = camera.distance();
        let deepest = if most > 0.0 { most } else { 3.0 * own };
        let nearest = depths.first().copied().unwrap_or(deepest);
        let enlarged = enlargement(camera, nearest, deepest);
        let [vw, vh] = camera.viewport();
        let corners = [[-0.5, 0.5], [0.5, 0.5], [0.5, -0.5], [-0.5, -0.5]];
        let rays = corners.map(|[x, y]| camera.ray_through(x * vw, y * vh));
        // A parallel camera's directions have length 1, a perspective camera's reach to the viewport.
        let reach = match camera.projection() {
            Projection::Perspective => enlarged,
            Projection::Parallel => own.min(0.45 * deepest),
        };
        Stage {
            nearer: camera.projection() == Projection::Parallel && reach < own,
            viewport: rays.map(|ray| ray.origin + reach * ray.direction),
            enlarged,
            origins: rays.map(|ray| ray.origin),
            seen: seen.into_iter().filter(|point| depth(point) <= deepest).collect(),
            deepest,
        }
    }

    /// The end of a ray as it is drawn.
    fn end(&self, ray: &ViewingRay, camera: &Camera) -> DVec3 {
        let per_t = -ray.ray().direction.dot(camera.w());
        ray.at(ray.t().unwrap_or(self.deepest / per_t))
    }

    fn middle(&self) -> DVec3 {
        0.5 * (self.viewport[0] + self.viewport[2])
    }
}

/// A viewport that is too small to see beside the scene is drawn so many times as far and as large: its rays are the
/// same. One, two, five or ten times, and so on, as long as it stays before what is seen.
fn enlargement(camera: &Camera, nearest: f64, deepest: f64) -> f64 {
    if camera.projection() == Projection::Parallel {
        return 1.0;
    }
    let [width, height] = camera.viewport();
    let wanted = 0.3 * deepest / width.max(height).max(0.5 * camera.distance());
    let most = 0.8 * nearest / camera.distance();
    let steps = (0..24).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(power)));
    steps.take_while(|step| *step <= wanted && *step <= most).last().unwrap_or(1.0)
}

/// Points that a coarse grid of rays hits: of planes only if there is nothing else, because a plane has no end.
fn hits(view: &View) -> Vec<DVec3> {
    let description = CameraDescription { image: [24, 18], ..*view.camera.description() };
    let Ok(camera) = Camera::new(description) else { return Vec::new() };
    let frame = seen(&View::new(view.scene, &camera), &Options::default());
    let grid = camera.sample_grid(1);
    let hit = |(row, column)| {
        let ray: Ray = grid.ray(row, column);
        let (id, t) = (frame.id(row, column)?, frame.t(row, column)?);
        let (object, _) = view.scene.locate(id);
        let is_plane = matches!(view.scene.objects()[object].shape, Shape::Plane(_));
        Some((is_plane, ray.origin + f64::from(t) * ray.direction))
    };
    let hits: Vec<(bool, DVec3)> = samples(&frame).filter_map(hit).collect();
    let only_planes = hits.iter().all(|(is_plane, _)| *is_plane);
    hits.into_iter()
        .filter(|(is_plane, _)| only_planes || !is_plane)
        .map(|(_, point)| point)
        .collect()
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

fn outside(
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
        let through = ray.at(reach(stage, camera));
        outside.line(drawing, through, stage.end(ray, camera), Pen::new(ray.color, 4.0));
    }
    let frame_pen = Pen::new(theme.of(Role::Camera), 3.0);
    pyramid(drawing, &outside, stage, camera, frame_pen);
    viewport(drawing, &outside, subject, stage, rays);
    for ray in rays.iter().rev() {
        let (start, through) =
            (outside.place(ray.ray().origin), outside.place(ray.at(reach(stage, camera))));
        drawing.line(&[start, through], Pen::new(ray.color, 4.0));
        drawing.disc(outside.place(ray.ray().origin), 4.0, Ink::new(ray.color));
        if ray.t().is_some() {
            let end = stage.end(ray, camera);
            drawing.disc(outside.place(end), 9.0, Ink::new(theme.background()));
            drawing.disc(outside.place(end), 6.5, Ink::new(ray.color));
        }
    }
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

/// The `t` at which rays pass the viewport as it is drawn.
fn reach(stage: &Stage, camera: &Camera) -> f64 {
    match camera.projection() {
        Projection::Perspective => stage.enlarged,
        Projection::Parallel => -stage.middle().dot(camera.w()),
    }
}

/// The colours of the rays: what is looked at first, then categories.
fn ray_colors(theme: Theme) -> [[u8; 3]; 4] {
    [theme.of(Role::Focus), theme.of(Role::Image), theme.of(Role::Good), theme.of(Role::Object)]
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
    for (axis, name) in [(camera.u(), "u"), (camera.v(), "v"), (camera.w(), "w")] {
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
    if stage.enlarged > 1.0 {
        let note = format!(
            "drawn {} times as far and as large: its rays are the same",
            number(stage.enlarged, 3)
        );
        label_at(drawing, bottom, [0.0, 1.0], &note, theme, theme.of(Role::Camera));
    }
    if stage.nearer {
        let note = "drawn nearer than d: no ray depends on d";
        label_at(drawing, bottom, [0.0, 1.0], note, theme, theme.of(Role::Camera));
    }
    let middle = outside.place(0.5 * stage.middle());
    label_at(
        drawing,
        middle,
        [0.2, 1.0],
        &format!("d = {}", number(camera.distance(), 4)),
        theme,
        theme.of(Role::Camera),
    );
}

/// A label beside a point, where it meets no other.
fn label_at(
    drawing: &mut Drawing,
    point: [f64; 2],
    prefer: [f64; 2],
    text: &str,
    theme: Theme,
    color: [u8; 3],
) {
    drawing.label(point, prefer, text, theme.label().of(color).semi_bold(), Some(theme.mat()));
}

/// The view from the side, as the lecture draws it: `−w` to the right, `v` up, in the column of the first pixel.
fn from_the_side(sheet: &mut Sheet, subject: &Subject, stage: &Stage, ray: &ViewingRay) {
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
    let bound = |axis: usize| {
        points
            .iter()
            .map(|point| point[axis])
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
    };
    let ([near, far], [low, high]) = (bound(0), bound(1));
    let scale = (0.84 * size[0] / (far - near)).min(0.76 * size[1] / (high - low).max(1e-300));
    let place = |point: DVec3| {
        let [depth, height] = side(point);
        [
            corner[0] + 0.5 * size[0] + scale * (depth - 0.5 * (near + far)),
            corner[1] + 0.52 * size[1] - scale * (height - 0.5 * (low + high)),
        ]
    };
    let drawing = &mut sheet.drawing;
    drawing.window(Some((corner, size)));
    let eye = place(DVec3::ZERO);
    let axis = Pen::new(theme.quiet(), 1.5).dashed(2.0, 7.0);
    drawing.line(&[eye, [corner[0] + size[0], eye[1]]], axis);
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
    if ray.t().is_some() {
        drawing.disc(place(stage.end(ray, camera)), 6.5, Ink::new(focus));
    }
    drawing.disc(eye, 8.0, theme.ink(Role::Camera));
    label_at(drawing, eye, [-0.3, 1.0], "eye", theme, theme.of(Role::Camera));
    label_at(drawing, place(top), [0.0, -1.0], "viewport", theme, theme.of(Role::Camera));
    if ray.t().is_some() {
        label_at(drawing, place(stage.end(ray, camera)), [0.8, -0.5], "hit", theme, focus);
    }
    let ray_middle = place(0.5 * (ray.at(reach(stage, camera)) + stage.end(ray, camera)));
    label_at(drawing, ray_middle, [0.0, -1.0], "r(t) = p + t d", theme, focus);
    drawing.label(
        [corner[0] + size[0] - 34.0, eye[1]],
        [0.0, 1.0],
        "−w",
        theme.label().semi_bold(),
        Some(theme.mat()),
    );
    drawing.window(None);
    sheet.border(corner, size);
}

/// What is seen in one column of the picture, from top to bottom: points relative to the eye, and their objects.
fn profile(view: &View, column: u32) -> Vec<(DVec3, usize)> {
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
            (format!("origin = eye = {origin}"), formula),
            (format!("direction = x u + y v − d w = {direction}"), formula),
        ]),
        Projection::Parallel => {
            let moved = vector(camera.eye().as_dvec3() + ray.ray().origin);
            lines.extend([
                (format!("origin = eye + x u + y v = {moved}"), formula),
                (format!("direction = −w = {direction}"), formula),
            ]);
        }
    }
    lines.push(match ray.report.covering.first() {
        None => ("It hits nothing: the background is seen.".into(), formula),
        Some(nearest) => {
            let kind = nearest.kind;
            (
                format!("nearest hit: t = {}, {kind}, id {}", number(nearest.t, 5), nearest.id),
                formula,
            )
        }
    });
    let lines: Vec<_> = lines.iter().map(|(line, style)| (line.as_str(), *style)).collect();
    sheet.lines([left, FORMULAS], width_of_lines, 46.0, &lines);
}

/// The picture from outside, paler than what is drawn over it.
fn faded(picture: &image::RgbImage, frame: &Frame, theme: Theme) -> image::RgbImage {
    let mut faded = picture.clone();
    for (x, y, pixel) in faded.enumerate_pixels_mut() {
        let seen = frame.id(y as usize, x as usize).is_some();
        let part = if seen { 0.62 } else { 0.0 };
        pixel.0 = mixed(theme.mat(), pixel.0, part);
    }
    faded
}
