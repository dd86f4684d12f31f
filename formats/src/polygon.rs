//! Cuts polygons into triangles: into a fan where that covers the polygon, and else ear by ear.
//!
//! Files of several formats have polygons of any size, and mean their inside. The fan `(0, k, k + 1)` of a polygon that is
//! not convex may cover what lies outside. So each polygon is looked at along an axis, the one nearest to its normal:
//!
//! - If no two triangles of the fan turn different ways, the fan is taken. It covers each point as often as the polygon goes around
//!   it: once inside. So it is with every convex polygon, also with one whose corners lie in a plane only nearly.
//! - Otherwise ears are cut off: a corner is one if the triangle of it and its two neighbours lies inside (Meisters, "Polygons Have
//!   Ears", The American Mathematical Monthly 82, 1975). What is left is a polygon again.
//!
//! A polygon of `n` corners always becomes `n − 2` triangles, which go around as it does, and they depend on nothing but the
//! positions of its corners. Where corners repeat or lie on a line, some triangles have no area. A polygon that crosses itself
//! has ears until it has none; the rest of it becomes a fan. All signs are exact: see `turn.rs`.

mod fans;
#[cfg(test)]
mod tests;
mod turn;

use bothways_common::exact::Sign;
pub(crate) use fans::Fans;
use glam::{DVec3, Vec3};
use std::collections::VecDeque;
use turn::{Point, area_sign, goes_back, turn};

/// The most corners of a polygon that is cut ear by ear; one that has more is always a fan. The time for one grows with the
/// square of the number of its corners: of so many, a spiral takes 0.7 s, the longest that we found, and a star 0.06 s (one thread
/// of an AMD EPYC).
pub(crate) const MOST_CORNERS: usize = 1 << 14;

/// Cuts one polygon after another. Only what it needs for the largest one stays in memory.
#[derive(Debug, Default)]
pub(crate) struct Cutter {
    positions: Vec<Vec3>,
    /// The corners along the axis, such that the polygon goes around to the left.
    points: Vec<Point>,
    ring: Vec<Link>,
    /// The corners that are left and do not turn left: only these can lie in an ear.
    reflex: Vec<u32>,
    /// The corners that may be ears.
    waiting: VecDeque<u32>,
    triangles: Vec<[u32; 3]>,
}

/// A corner among those that are left.
#[derive(Clone, Copy, Debug)]
struct Link {
    before: u32,
    after: u32,
    turn: Sign,
    is_left: bool,
    is_waiting: bool,
}

impl Cutter {
    /// The triangles of a polygon, as numbers of its corners; `None` if they are the fan `(0, k, k + 1)`.
    pub(crate) fn cut(
        &mut self,
        corners: usize,
        position: impl Fn(usize) -> Vec3,
    ) -> Option<&[[u32; 3]]> {
        if !(4..=MOST_CORNERS).contains(&corners) {
            return None;
        }
        self.positions.clear();
        self.positions.extend((0..corners).map(position));
        let axes = axes_across(&self.positions);
        if is_fan(&self.positions, axes) {
            return None;
        }
        self.points.clear();
        self.points.extend(self.positions.iter().map(|&position| seen_along(axes, position)));
        match area_sign(&self.points) {
            Sign::Positive => {}
            // Seen in a mirror, it goes around to the left.
            Sign::Negative => self.points.iter_mut().for_each(|point| point.reverse()),
            // It has no inside.
            Sign::Zero => return None,
        }
        self.cut_ears();
        Some(&self.triangles)
    }

    /// Visits the triangles of a polygon. All of its vertices have a position.
    pub(crate) fn visit<C: Copy>(
        &mut self,
        corners: &[C],
        position: impl Fn(C) -> Vec3,
        mut triangle: impl FnMut([C; 3]),
    ) {
        match self.cut(corners.len(), |k| position(corners[k])) {
            None => fan(corners).for_each(triangle),
            Some(cut) => cut.iter().for_each(|of| triangle(of.map(|k| corners[k as usize]))),
        }
    }

    fn cut_ears(&mut self) {
        self.begin();
        let mut left = self.points.len();
        while left > 3 {
            // A polygon that does not cross itself has an ear. Whether a corner is one changes only with its neighbours: what
            // is left lies within what was there, so a triangle that was not inside never is.
            let Some(corner) = self.waiting.pop_front() else { break };
            self.ring[corner as usize].is_waiting = false;
            if self.ring[corner as usize].is_left && self.is_ear(corner) {
                self.cut_off(corner);
                left -= 1;
            }
        }
        self.cut_rest(left);
    }

    /// Links all corners of the polygon.
    fn begin(&mut self) {
        let points = &self.points;
        let count = number(points.len());
        let link = |corner: u32| {
            let (before, after) = ((corner + count - 1) % count, (corner + 1) % count);
            let [a, b, c] = [before, corner, after].map(|k| points[k as usize]);
            Link { before, after, turn: turn(a, b, c), is_left: true, is_waiting: false }
        };
        self.ring.clear();
        self.ring.extend((0..count).map(link));
        let ring = &self.ring;
        self.reflex.clear();
        self.reflex.extend((0..count).filter(|&k| ring[k as usize].turn != Sign::Positive));
        self.triangles.clear();
        self.waiting.clear();
        // Every second corner first: one ear beside another makes thin triangles.
        (1..count).step_by(2).chain((0..count).step_by(2)).for_each(|corner| self.wait(corner));
    }

    /// Tells whether the triangle of a corner and its neighbours lies inside of what is left.
    fn is_ear(&self, corner: u32) -> bool {
        let Link { before, after, turn, .. } = self.ring[corner as usize];
        let ear = [before, corner, after];
        match turn {
            Sign::Negative => false,
            // To cut off a thorn without width takes nothing away, wherever it lies. A corner on an edge stays, for a triangle that
            // has an area.
            Sign::Zero => self.is_thorn(corner),
            Sign::Positive => {
                let triangle = ear.map(|k| self.points[k as usize]);
                let [least, most] = bounds(triangle);
                !self.reflex.iter().any(|&other| {
                    let [x, y] = self.points[other as usize];
                    let is_near = least[0] <= x && x <= most[0] && least[1] <= y && y <= most[1];
                    is_near && !ear.contains(&other) && self.is_in_the_way(other, triangle)
                })
            }
        }
    }

    /// Tells whether the way goes back from a corner as it came, or stands still there.
    fn is_thorn(&self, corner: u32) -> bool {
        let Link { before, after, turn, .. } = self.ring[corner as usize];
        let [a, b, c] = [before, corner, after].map(|k| self.points[k as usize]);
        turn == Sign::Zero && goes_back(a, b, c)
    }

    /// Tells whether what is left has an edge in a triangle at this corner, or the corner lies on the edge that would be new.
    fn is_in_the_way(&self, corner: u32, [a, b, c]: [Point; 3]) -> bool {
        let point = self.points[corner as usize];
        let sides = [[a, b], [b, c], [c, a]];
        let of_point = sides.map(|[from, to]| turn(from, to, point));
        if of_point.contains(&Sign::Negative) {
            return false;
        }
        if of_point[..2] == [Sign::Positive; 2] {
            return true;
        }
        // It touches the triangle, as where a hole is joined to the outline by two edges in one place.
        let Link { before, after, .. } = self.ring[corner as usize];
        [before, after].iter().any(|&neighbour| {
            let is_inside = |[from, to]: [Point; 2]| {
                turn(from, to, self.points[neighbour as usize]) == Sign::Positive
            };
            sides.iter().zip(of_point).all(|(&side, on)| on == Sign::Positive || is_inside(side))
        })
    }

    /// Cuts off an ear.
    fn cut_off(&mut self, corner: u32) {
        let Link { before, after, turn, .. } = self.ring[corner as usize];
        self.triangles.push([before, corner, after]);
        self.ring[corner as usize].is_left = false;
        if turn != Sign::Positive {
            self.forget_reflex(corner);
        }
        self.ring[before as usize].after = after;
        self.ring[after as usize].before = before;
        for neighbour in [before, after] {
            self.turn_anew(neighbour);
        }
    }

    /// Finds how a corner with a new neighbour turns. It may be an ear now.
    fn turn_anew(&mut self, corner: u32) {
        let Link { before, after, turn: old, .. } = self.ring[corner as usize];
        let [a, b, c] = [before, corner, after].map(|k| self.points[k as usize]);
        let new = turn(a, b, c);
        match (old == Sign::Positive, new == Sign::Positive) {
            (false, true) => self.forget_reflex(corner),
            // Only where the polygon crosses itself.
            (true, false) => self.reflex.push(corner),
            _ => {}
        }
        self.ring[corner as usize].turn = new;
        self.wait(corner);
    }

    /// Puts a corner among those that may be ears: a thorn first. At its foot, where two corners lie in
    /// one place, neither tells whether it lies inside or outside.
    fn wait(&mut self, corner: u32) {
        let is_waiting = std::mem::replace(&mut self.ring[corner as usize].is_waiting, true);
        if self.is_thorn(corner) {
            self.waiting.push_front(corner);
        } else if !is_waiting {
            self.waiting.push_back(corner);
        }
    }

    fn forget_reflex(&mut self, corner: u32) {
        if let Some(at) = self.reflex.iter().position(|&reflex| reflex == corner) {
            self.reflex.swap_remove(at);
        }
    }

    /// Cuts the corners that are left into a fan: a triangle, or what has no ear.
    fn cut_rest(&mut self, left: usize) {
        let Some(first) = self.ring.iter().position(|link| link.is_left) else { return };
        let mut corner = self.ring[first].after;
        for _ in 2..left {
            let after = self.ring[corner as usize].after;
            self.triangles.push([number(first), corner, after]);
            corner = after;
        }
    }
}

/// The fan of a polygon.
pub(crate) fn fan<C: Copy>(corners: &[C]) -> impl Iterator<Item = [C; 3]> {
    (2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]])
}

/// Tells whether no two triangles of the fan turn different ways.
fn is_fan(positions: &[Vec3], axes: [usize; 2]) -> bool {
    let point = |k: usize| seen_along(axes, positions[k]);
    let (first, mut before) = (point(0), point(1));
    let mut way = Sign::Zero;
    (2..positions.len()).all(|k| {
        let next = point(k);
        let turned = turn(first, before, next);
        before = next;
        let agrees = way == Sign::Zero || turned == Sign::Zero || turned == way;
        way = way.or_else(|| turned);
        agrees
    })
}

/// The axes that are left without the one nearest to the polygon's normal, in the order in which a turn to the left around that
/// one leads from the first to the second.
///
/// The normal is that of Newell: the sum of the areas of the fan's triangles as vectors (Sutherland, Sproull and Schumacker, "A
/// Characterization of Ten Hidden-Surface Algorithms", ACM Computing Surveys 6, 1974). It is rounded: any axis will do that
/// does not lie in the plane of the polygon.
fn axes_across(positions: &[Vec3]) -> [usize; 2] {
    let first = positions[0].as_dvec3();
    let mut before = positions[1].as_dvec3() - first;
    let mut normal = DVec3::ZERO;
    for position in &positions[2..] {
        let next = position.as_dvec3() - first;
        normal += before.cross(next);
        before = next;
    }
    let size = normal.abs();
    if size.x >= size.y && size.x >= size.z {
        [1, 2]
    } else if size.y >= size.z {
        [2, 0]
    } else {
        [0, 1]
    }
}

fn seen_along(axes: [usize; 2], position: Vec3) -> Point {
    let coordinates = position.to_array();
    axes.map(|axis| f64::from(coordinates[axis]))
}

/// The least and the most coordinates of three points.
fn bounds([a, b, c]: [Point; 3]) -> [Point; 2] {
    let of = |choose: fn(f64, f64) -> f64| [0, 1].map(|k| choose(choose(a[k], b[k]), c[k]));
    [of(f64::min), of(f64::max)]
}

fn number(corner: usize) -> u32 {
    u32::try_from(corner).expect("no more than MOST_CORNERS")
}
