//! What both views of the camera show: the viewport as it is drawn, and points of what is seen.

use super::super::interest::samples;
use super::viewing_ray::ViewingRay;
use crate::common::glam::DVec3;
use crate::common::{Camera, CameraDescription, Options, Projection, Ray, Shape, View};
use crate::figure::subject::{Subject, seen};

/// What both views show, relative to the eye.
pub(super) struct Stage {
    /// The corners of the viewport as it is drawn: top left, top right, bottom right, bottom left.
    pub(super) viewport: [DVec3; 4],
    /// How many times as far, and as large, as the camera's own viewport it is drawn; below 1 where it is nearer and smaller.
    pub(super) enlarged: f64,
    /// Whether the viewport of a parallel camera is drawn nearer than it is.
    pub(super) nearer: bool,
    /// Where the rays of those corners start.
    pub(super) origins: [DVec3; 4],
    /// Points of what is seen, and how far each ray is drawn that hits nothing.
    pub(super) seen: Vec<DVec3>,
    pub(super) deepest: f64,
}

impl Stage {
    pub(super) fn new(subject: &Subject, rays: &[ViewingRay]) -> Stage {
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
        let enlarged = enlargement(camera, [nearest, middle], deepest);
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
    pub(super) fn end(&self, ray: &ViewingRay, camera: &Camera) -> DVec3 {
        let per_t = -ray.ray().direction.dot(camera.w());
        ray.at(ray.t().unwrap_or(self.deepest / per_t))
    }

    /// The middle of the viewport.
    pub(super) fn middle(&self) -> DVec3 {
        0.5 * (self.viewport[0] + self.viewport[2])
    }

    /// The `t` at which rays pass the viewport as it is drawn.
    pub(super) fn passing(&self, camera: &Camera) -> f64 {
        match camera.projection() {
            Projection::Perspective => self.enlarged,
            Projection::Parallel => -self.middle().dot(camera.w()),
        }
    }
}

/// A viewport that is too small to see beside the scene is drawn so many times as far and as large: its rays are the
/// same. One, two, five or ten times, and so on, as long as it stays before what is seen. Where most of what is seen lies before
/// the viewport, it is drawn at a half, a fifth or a tenth: the picture frame stands between the eye and the scene.
fn enlargement(camera: &Camera, [nearest, middle]: [f64; 2], deepest: f64) -> f64 {
    let own = camera.distance();
    if camera.projection() == Projection::Parallel {
        return 1.0;
    }
    let steps = (0..24).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(power)));
    let most = 0.8 * nearest / own;
    if middle > 0.0 && middle < own {
        return steps.map(|step| 1.0 / step).find(|part| *part <= most).unwrap_or(1.0);
    }
    let [width, height] = camera.viewport();
    let wanted = 0.3 * deepest / width.max(height).max(0.5 * own);
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
