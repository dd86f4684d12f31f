//! A picture of the scene as a renderer with other conventions draws it.
//!
//! The loop is the lecture's object order with bounding boxes. It decides in `f64` where the bound of the roundoff
//! allows, and asks the exact judge elsewhere: a hypothesis is held against the pixels without noise of its own.

use super::convention::{Convention, Depth, Edges, Faces, Interpolation, Look, Omission, Vertices};
use super::drawn::{Drawn, Rows};
use super::outline::{
    Area, PlaneDistance, TriangleOutline, area_of_sphere, area_of_triangle, whole,
};
use super::rays::ViewingRays;
use super::snapped::{Snapped, SnappedTriangle};
use crate::common::exact::{CachedJudge, Comparison};
use crate::common::frame::NO_PRIMITIVE;
use crate::common::glam::DVec3;
use crate::common::{Judge, Primitive, Projection, Ray, Sign, View};
use std::cell::OnceCell;
use std::cmp::Ordering;
use std::ops::Range;

/// Draws the scene under a convention; placement is left to the reader of the picture.
pub(super) fn draw(view: &View, convention: &Convention, rows: Rows) -> Drawn {
    draw_those(view, convention, rows, |_| true)
}

/// The same of those primitives alone for which a condition holds.
pub(super) fn draw_those(
    view: &View,
    convention: &Convention,
    rows: Rows,
    is_there: impl Fn(u32) -> bool,
) -> Drawn {
    let rays = ViewingRays::new(view.camera, convention);
    let camera = convention.camera(view.camera);
    let view = &View::new(view.scene, &camera);
    let (width, height) = (rays.x.len(), rays.y.len());
    let numbers = rows.numbers(height);
    let count = numbers.len() * width;
    let mut canvas = Canvas {
        view,
        judge: rays.judge(),
        pairs: CachedJudge::new(rays.judge()),
        rays,
        convention: *convention,
        step: rows.step,
        drawn: Drawn {
            width,
            rows: numbers,
            ids: vec![NO_PRIMITIVE; count],
            t: vec![f64::INFINITY; count],
        },
        errors: vec![0.0; count],
    };
    for (id, primitive) in (0..).zip(view.primitives().map(|(_, primitive)| primitive)) {
        if is_there(id) && !convention.omission.omits(id, &primitive) {
            canvas.add(id, &primitive);
        }
    }
    if canvas.rays.are_one() {
        canvas.drawn.repeat_first();
    }
    if convention.framing.is_alone {
        let [rows, columns] = [(1, height), (0, width)]
            .map(|(axis, count)| convention.framing.own_lines(axis, count));
        canvas.drawn.keep_only(&rows, &columns);
    }
    if let Omission::Part(part) = convention.omission {
        canvas.drawn.clear(&part);
    }
    canvas.drawn
}

/// The same picture for each primitive that rounding in `f32` cannot tell from the one that is seen, where the rays of
/// all pixels are one. Another rounding of that one ray is no other convention, although it changes every pixel.
pub(super) fn equally_near(view: &View, convention: &Convention, drawn: &Drawn) -> Vec<Drawn> {
    /// The largest relative difference of two distances that another rounding may exchange.
    const CLOSE: f64 = 1e-5;
    let rays = ViewingRays::new(view.camera, convention);
    let camera = convention.camera(view.camera);
    let view = &View::new(view.scene, &camera);
    let (Some(&seen), Some(&nearest)) = (drawn.ids.first(), drawn.t.first()) else {
        return Vec::new();
    };
    if !rays.are_one() || seen == NO_PRIMITIVE {
        return Vec::new();
    }
    let (ray, judge) = (rays.ray(0, 0), rays.judge());
    let all = (0..).zip(view.primitives().map(|(_, primitive)| primitive));
    let others = all.filter(|(id, _)| *id != seen);
    let on_the_ray = others.filter(|(_, primitive)| judge.covers(primitive, &ray));
    on_the_ray
        .map(|(id, primitive)| (id, judge.distance(&primitive, &ray)))
        .filter(|(_, t)| (t - nearest).abs() <= CLOSE * nearest)
        .map(|(id, t)| Drawn {
            ids: vec![id; drawn.ids.len()],
            t: vec![t; drawn.t.len()],
            ..drawn.clone()
        })
        .collect()
}

/// The picture so far.
struct Canvas<'a> {
    view: &'a View<'a>,
    rays: ViewingRays,
    judge: Judge,
    /// Compares the planes of two primitives once for all pixels.
    pairs: CachedJudge,
    convention: Convention,
    step: usize,
    drawn: Drawn,
    /// A bound for the error of each stored distance.
    errors: Vec<f32>,
}

/// A primitive at a sample, by rounded arithmetic.
enum Rounded {
    Outside,
    /// Covered, with `t` and the bound of its error.
    Inside(f64, f64),
    Uncertain,
    /// The same of a triangle whose distance is not that of its plane.
    UncertainAt(f64, f64),
}

impl Canvas<'_> {
    fn add(&mut self, id: u32, primitive: &Primitive) {
        match primitive {
            Primitive::Triangle(corners) => self.triangle((id, primitive, corners)),
            Primitive::Sphere { center, radius } => {
                let area = area_of_sphere(*center, *radius, &self.rays, 0.0);
                self.fill(id, primitive, &area, |canvas, row, column| {
                    canvas.sphere(*center, *radius, row, column)
                });
            }
            Primitive::Plane { point, normal } => {
                let PlaneDistance { numerator, denominator } =
                    PlaneDistance::of_plane(*point, *normal, normal.length(), &self.rays);
                let area = whole(&self.rays);
                self.fill(id, primitive, &area, |canvas, row, column| {
                    let (x, y) = (canvas.rays.x[column], canvas.rays.y[row]);
                    let [n, d] = [numerator.at(x, y), denominator.at(x, y)];
                    if n.abs() <= numerator.error || d.abs() <= denominator.error {
                        return Rounded::Uncertain;
                    }
                    if n / d < 0.0 {
                        return Rounded::Outside;
                    }
                    let relative = numerator.error / n.abs() + denominator.error / d.abs();
                    Rounded::Inside(n / d, 2.0 * relative * (n / d))
                });
            }
        }
    }

    /// The indices of the drawn rows within an area. Where all rays are one, the first pixel stands for all.
    fn rows_of(&self, area: &Area) -> Range<usize> {
        let first = self.drawn.rows.first().copied().unwrap_or(0);
        let index = |row: usize| row.saturating_sub(first).div_ceil(self.step);
        let count = if self.rays.are_one() { 1 } else { self.drawn.rows.len() };
        index(area.rows.start)..index(area.rows.end).min(count)
    }

    /// The columns within an area that are drawn.
    fn columns(&self, area: &Area) -> Range<usize> {
        if self.rays.are_one() { 0..1 } else { area.columns.clone() }
    }

    fn fill(
        &mut self,
        id: u32,
        primitive: &Primitive,
        area: &Area,
        rounded: impl Fn(&Self, usize, usize) -> Rounded,
    ) {
        for index in self.rows_of(area) {
            let row = self.drawn.rows[index];
            for column in self.columns(area) {
                let at = rounded(self, row, column);
                self.keep(id, primitive, [index, column], at);
            }
        }
    }

    fn triangle(&mut self, triangle @ (id, primitive, corners): (u32, &Primitive, &[DVec3; 3])) {
        let vertices = self.convention.vertices;
        // A corner on the grid may lie a pixel farther.
        let margin = if vertices == Vertices::Projected { 0.0 } else { 1.0 };
        let area = area_of_triangle(corners, &self.rays, margin);
        if self.rows_of(&area).is_empty() || area.columns.is_empty() {
            return;
        }
        let Some(outline) = TriangleOutline::new(corners, &self.rays) else { return };
        let culled = match self.convention.faces {
            Faces::Both => false,
            Faces::BackCulled => !outline.is_front,
            Faces::FrontCulled => outline.is_front,
        };
        if culled {
            return;
        }
        match Snapped::new(corners, &self.rays, vertices) {
            Snapped::Unmoved => self.add_triangle(triangle, &outline, &area),
            Snapped::Triangle(snapped) => {
                let plane = self.distance_of(corners);
                self.add_snapped((id, primitive), &snapped, &plane);
            }
            Snapped::Vanished => {}
        }
    }

    fn add_snapped(
        &mut self,
        (id, primitive): (u32, &Primitive),
        triangle: &SnappedTriangle,
        plane: &PlaneDistance,
    ) {
        let area = triangle.area(&self.rays);
        for index in self.rows_of(&area) {
            let row = self.drawn.rows[index];
            for column in triangle.columns(row, &area) {
                if !triangle.covers(row, column, self.convention.edges) {
                    continue;
                }
                let (t, error) = plane.t(self.rays.x[column], self.rays.y[row]);
                // Beside the triangle, its plane may lie behind the eye, or infinitely far away.
                if t > error {
                    self.keep(id, primitive, [index, column], Rounded::Inside(t, error));
                }
            }
        }
    }

    fn add_triangle(
        &mut self,
        (id, primitive, corners): (u32, &Primitive, &[DVec3; 3]),
        outline: &TriangleOutline,
        area: &Area,
    ) {
        // Many triangles are so small that they cover no sample.
        let distance = OnceCell::new();
        for index in self.rows_of(area) {
            let row = self.drawn.rows[index];
            let y = self.rays.y[row];
            for column in self.columns_of(outline, y, area) {
                let x = self.rays.x[column];
                let distance = || distance.get_or_init(|| self.distance_of(corners));
                let mut rounded = rounded_triangle(outline, distance, [x, y]);
                if let Rounded::Uncertain = rounded
                    && self.convention.interpolation != Interpolation::Perspective
                {
                    let (t, error) = distance().t(x, y);
                    rounded = Rounded::UncertainAt(t, error);
                }
                self.keep(id, primitive, [index, column], rounded);
            }
        }
    }

    /// The distance of a triangle, as the renderer has it. Behind the eye, nothing is interpolated.
    fn distance_of(&self, corners: &[DVec3; 3]) -> PlaneDistance {
        let interpolation = self.convention.interpolation;
        PlaneDistance::interpolated(corners, &self.rays, interpolation)
            .unwrap_or_else(|| PlaneDistance::of_triangle(corners, &self.rays))
    }

    /// The columns of a row that may lie inside all edges.
    fn columns_of(&self, outline: &TriangleOutline, y: f64, area: &Area) -> Range<usize> {
        // Below so many columns, to test them takes less time than to solve for their ends.
        const FEW: usize = 12;
        if area.columns.len() <= FEW || self.rays.are_one() {
            return self.columns(area);
        }
        let [mut low, mut high] = [f64::NEG_INFINITY, f64::INFINITY];
        for edge in &outline.edges {
            let rest = edge.constant + edge.along_y * y;
            // With an edge function of this slope or less, the column does not matter.
            if edge.along_x.abs() * self.rays.extent() <= edge.error {
                if rest < -2.0 * edge.error {
                    return 0..0;
                }
            } else {
                let crossing = -rest / edge.along_x;
                let slack = 2.0 * edge.error / edge.along_x.abs();
                if edge.along_x > 0.0 {
                    low = low.max(crossing - slack);
                } else {
                    high = high.min(crossing + slack);
                }
            }
        }
        let columns = self.rays.x.indices([low, high], 1.0);
        if low > high {
            // The two ends are less than a pixel apart, or there is nothing between them.
            let pixel = self.rays.x.indices([high, low], 1.0);
            if pixel.len() > 4 {
                return 0..0;
            }
            return pixel.start.max(area.columns.start)..pixel.end.min(area.columns.end);
        }
        columns.start.max(area.columns.start)..columns.end.min(area.columns.end)
    }

    fn sphere(&self, center: DVec3, radius: f64, row: usize, column: usize) -> Rounded {
        let ray = self.rays.ray(row, column);
        let (offset, direction) = (center - ray.origin, ray.direction);
        let [a, b] = [direction.length_squared(), offset.dot(direction)];
        let c = offset.length_squared() - radius * radius;
        let size = b * b + a * (offset.length_squared() + radius * radius);
        let discriminant = b * b - a * c;
        // Some ten roundings of terms that are no larger than `size`.
        let error = size * 1e-14 + 1e-280;
        if discriminant < -error {
            return Rounded::Outside;
        }
        if discriminant <= error * 1e4 || c.abs() <= size / a * 1e-10 {
            return Rounded::Uncertain;
        }
        let root = discriminant.sqrt();
        let near = self.convention.near.map_or(0.0, |plane| plane.clip.at.middle());
        let shows_other_side = self.convention.near.is_some_and(|plane| !plane.hides_spheres);
        let [first, second] = [b - root, b + root].map(|numerator| numerator / a);
        let t = if c < 0.0 || (first < near && shows_other_side) { second } else { first };
        if t < near { Rounded::Outside } else { Rounded::Inside(t, t * 1e-9) }
    }

    /// Keeps a primitive at a pixel, if it covers the sample and its depth wins.
    fn keep(&mut self, id: u32, primitive: &Primitive, at: [usize; 2], rounded: Rounded) {
        let [index, column] = at;
        let ray = || self.rays.ray(self.drawn.rows[index], column);
        let (t, error) = match rounded {
            Rounded::Outside => return,
            Rounded::Inside(t, error) => (t, error),
            _ if !covers(&self.judge, self.convention.edges, primitive, &ray()) => return,
            Rounded::UncertainAt(t, error) => (t, error),
            Rounded::Uncertain => {
                let t = self.judge.distance(primitive, &ray());
                // The judge rounds to within a few parts in 10¹⁰.
                (t, t * 1e-9)
            }
        };
        let Convention { near, far, .. } = self.convention;
        let is_beyond_a_plane = near.is_some_and(|near| t < near.clip.at.middle())
            || far.is_some_and(|far| t > far.at.middle());
        if is_beyond_a_plane {
            return;
        }
        let pixel = index * self.drawn.width + column;
        if self.wins(id, primitive, (t, error), pixel, at) {
            self.drawn.ids[pixel] = id;
            self.drawn.t[pixel] = t;
            self.errors[pixel] = above(error);
        }
    }

    fn wins(
        &mut self,
        id: u32,
        primitive: &Primitive,
        (t, error): (f64, f64),
        pixel: usize,
        [index, column]: [usize; 2],
    ) -> bool {
        let stored = self.drawn.ids[pixel];
        if stored == NO_PRIMITIVE {
            return true;
        }
        let depth = self.convention.depth;
        match depth {
            Depth::LastDrawn => return true,
            Depth::FirstDrawn => return false,
            _ => {}
        }
        let difference = t - self.drawn.t[pixel];
        let order = if difference.abs() > error + f64::from(self.errors[pixel]) {
            difference.total_cmp(&0.0)
        } else {
            let ray = self.rays.ray(self.drawn.rows[index], column);
            let order = self.compare((id, primitive), stored, &ray);
            if depth == Depth::Nearest { order.decided } else { order.at_sample }
        };
        match depth {
            Depth::Farthest => order == Ordering::Greater,
            Depth::LastOfEqual => order != Ordering::Greater,
            // Primitives come in the order of their ids: the stored one is the first of the two.
            _ => order.then(id.cmp(&stored)) == Ordering::Less,
        }
    }

    /// Which of two primitives is nearer along a ray.
    fn compare(&mut self, incoming: (u32, &Primitive), stored: u32, ray: &Ray) -> Comparison {
        let held = self.view.primitive(stored.into());
        // The cache has the parallel rays of a camera in mind, which do not run backward.
        if self.rays.projection == Projection::Parallel && self.convention.look == Look::Backward {
            self.judge.compare(incoming.1, &held, ray)
        } else {
            self.pairs.compare(incoming, (stored, &held), ray)
        }
    }
}

fn rounded_triangle<'a>(
    outline: &TriangleOutline,
    distance: impl FnOnce() -> &'a PlaneDistance,
    [x, y]: [f64; 2],
) -> Rounded {
    let mut certain = true;
    for edge in &outline.edges {
        let value = edge.at(x, y);
        if value < -edge.error {
            return Rounded::Outside;
        }
        certain &= value > edge.error;
    }
    let (t, error) = distance().t(x, y);
    if certain && t > error {
        Rounded::Inside(t, error)
    } else if certain && t < -error {
        Rounded::Outside
    } else {
        Rounded::Uncertain
    }
}

/// Whether a primitive covers a sample when these edges own theirs.
pub(super) fn covers(judge: &Judge, edges: Edges, primitive: &Primitive, ray: &Ray) -> bool {
    let Primitive::Triangle(corners) = primitive else { return judge.covers(primitive, ray) };
    if edges == Edges::TopLeft {
        return judge.covers(primitive, ray);
    }
    let signs = judge.edge_signs(corners, ray);
    if signs.facing == Sign::Zero || !signs.in_front {
        return false;
    }
    let sides = judge.edge_sides(corners, ray, &signs);
    signs.at_sample.iter().zip(sides).all(|(&sign, side)| match side {
        Some(side) => edges.own(side),
        None => sign == signs.facing,
    })
}

/// The next `f32` above a bound.
#[expect(clippy::cast_possible_truncation, reason = "rounded, then moved up")]
fn above(error: f64) -> f32 {
    (error as f32).next_up()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::glam::Vec3;
    use crate::common::{Camera, CameraDescription, Object, Options, Scene, Shape, Triangle};
    use crate::diff::why::convention::{Change, Sampling};
    use crate::scenes;

    fn with_camera(name: &str, image: [u32; 2], check: impl Fn(&View)) {
        let loaded = scenes::load(name).unwrap();
        for projection in [Projection::Perspective, Projection::Parallel] {
            let camera = CameraDescription { projection, image, ..loaded.camera };
            check(&View::new(&loaded.scene, &Camera::new(camera).unwrap()));
        }
    }

    fn line(drawn: &Drawn, index: usize) -> (&[u32], &[f64]) {
        let line = index * drawn.width..(index + 1) * drawn.width;
        (&drawn.ids[line.clone()], &drawn.t[line])
    }

    #[test]
    fn under_our_conventions_it_draws_what_both_orders_draw() {
        for scene in scenes::BUILT_IN {
            with_camera(scene.name, [64, 48], |view| {
                let drawn = draw(view, &Convention::default(), Rows::ALL);
                let frame = crate::rasterize::fast::render(
                    &crate::rasterize::fast::prepare(view.scene),
                    view,
                    &Options::default(),
                );
                assert_eq!(Some(&drawn.ids[..]), frame.ids().narrow(), "{}", scene.name);
                for (t, expected) in drawn.t.iter().zip(frame.distances()) {
                    let expected = f64::from(*expected);
                    assert!((t - expected).abs() <= 1e-6 * expected || *t == expected);
                }
            });
        }
    }

    #[test]
    fn under_every_convention_the_nearest_is_what_the_exact_judge_says() {
        // Triangles in one plane, and one beside it by less than rounding sees; the same behind the eye.
        let triangle = |[x, y, off]: [f32; 3], side: f32| {
            let corner = |x: f32, y: f32| Vec3::new(x, y, side * (2.0 + 0.25 * x + off));
            let [a, b, c] = [corner(x, y), corner(x + 1.5, y), corner(x, y + 1.25)];
            Object::from(Shape::Triangle(Triangle { a, b, c }))
        };
        let off = 2.0 * f32::EPSILON;
        let places =
            [[-0.75, -0.5, 0.0], [-0.75, -0.5, off], [-0.5, -0.75, 0.0], [-1.0, -0.25, 0.0]];
        let sides = [-1.0, 1.0].into_iter();
        let objects = sides.flat_map(|side| places.map(|place| triangle(place, side)));
        let scene = Scene::new(objects.collect()).unwrap();
        for projection in [Projection::Perspective, Projection::Parallel] {
            let image = [16, 12];
            let camera = CameraDescription { projection, image, ..CameraDescription::default() };
            let camera = Camera::new(camera).unwrap();
            let view = &View::new(&scene, &camera);
            let primitives: Vec<_> = view.primitives().collect();
            for change in Change::of_rendering(view.camera) {
                let convention = Convention::default().with(change);
                let is_of_the_nearest =
                    convention.depth == Depth::Nearest && convention.faces == Faces::Both;
                let is_exact = convention.vertices == Vertices::Projected
                    && convention.interpolation == Interpolation::Perspective;
                if !is_of_the_nearest || !is_exact {
                    continue;
                }
                let drawn = draw(view, &convention, Rows::ALL);
                let rays = ViewingRays::new(view.camera, &convention);
                let judge = rays.judge();
                for (index, &id) in drawn.ids.iter().enumerate() {
                    let ray = rays.ray(index / drawn.width, index % drawn.width);
                    let mut nearest: Option<&(u64, Primitive)> = None;
                    for one in &primitives {
                        if covers(&judge, convention.edges, &one.1, &ray)
                            && nearest.is_none_or(|held| {
                                judge.nearer((one.0, &one.1), (held.0, &held.1), &ray)
                            })
                        {
                            nearest = Some(one);
                        }
                    }
                    let expected = nearest.map(|one| one.0);
                    let id = (id != NO_PRIMITIVE).then_some(u64::from(id));
                    assert_eq!(id, expected, "{change:?} at {index}");
                }
            }
        }
    }

    #[test]
    fn some_rows_are_rows_of_the_whole_picture() {
        with_camera("lecture", [64, 50], |view| {
            let whole = draw(view, &Convention::default(), Rows::ALL);
            let some = draw(view, &Convention::default(), Rows { step: 7 });
            assert_eq!(some.rows, [0, 7, 14, 21, 28, 35, 42, 49]);
            for (index, &row) in some.rows.iter().enumerate() {
                assert_eq!(line(&some, index), line(&whole, row));
            }
        });
    }

    #[test]
    fn a_sample_a_pixel_to_the_right_sees_the_next_pixel() {
        with_camera("canonical", [64, 64], |view| {
            let ours = draw(view, &Convention::default(), Rows::ALL);
            let after = Convention::default().with(Change::Columns(Sampling::PixelAfter));
            let after = draw(view, &after, Rows::ALL);
            for row in 0..64 {
                assert_eq!(line(&after, row).0[..63], line(&ours, row).0[1..]);
            }
        });
    }

    #[test]
    fn every_change_of_rendering_changes_the_picture_of_some_scene() {
        let mut unseen = Vec::new();
        for change in Change::of_rendering(&Camera::canonical(32, 64)) {
            let mut seen = false;
            for name in ["lecture", "ties", "overlap", "behind", "slivers"] {
                let loaded = scenes::load(name).unwrap();
                for projection in [Projection::Perspective, Projection::Parallel] {
                    let camera = CameraDescription { projection, image: [64, 64], ..loaded.camera };
                    let camera = Camera::new(camera).unwrap();
                    let view = View::new(&loaded.scene, &camera);
                    let ours = draw(&view, &Convention::default(), Rows::ALL);
                    let other = draw(&view, &Convention::default().with(change), Rows::ALL);
                    seen |= other.ids != ours.ids;
                }
            }
            if !seen {
                unseen.push(change);
            }
        }
        // Our ties differ from the first of equals only where a silhouette is met exactly.
        let silhouettes = Change::Depth(Depth::FirstOfEqual);
        assert_eq!(unseen, [silhouettes], "these changes are never seen");
    }
}
