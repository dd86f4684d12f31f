//! The primitives at or near the samples of some pixels, found primitive by primitive.

use super::distances::slope_of;
use super::outline::{
    Area, Linear, PlaneDistance, TriangleOutline, area_of_sphere, area_of_triangle, whole,
};
use super::rays::ViewingRays;
use crate::common::{Judge, Primitive, View};

/// A pixel that is not looked at.
const NONE: u32 = u32::MAX;

/// For each of the pixels `[i, j]`, the primitives that cover its sample, or whose outline lies within so many pixels of
/// it. Spheres may lie farther away.
pub(super) fn near_primitives(
    view: &View,
    rays: &ViewingRays,
    pixels: &[[u32; 2]],
    reach: f64,
) -> Vec<Vec<u32>> {
    let slots = Slots::new(rays, pixels);
    let (judge, spacing) = (rays.judge(), rays.spacing());
    let mut near = vec![Vec::new(); pixels.len()];
    for (id, primitive) in (0..).zip(view.primitives().map(|(_, primitive)| primitive)) {
        let Some((area, region)) = Region::new(&primitive, rays, spacing, reach) else { continue };
        slots.each(&area, |slot, i, j| {
            if region.holds(&judge, &primitive, rays, [i, j]) {
                near[slot as usize].push(id);
            }
        });
    }
    near
}

/// The pixels that are looked at, by row and column.
struct Slots {
    width: usize,
    slots: Vec<u32>,
    /// Whether a row has any of them.
    in_row: Vec<bool>,
}

impl Slots {
    fn new(rays: &ViewingRays, pixels: &[[u32; 2]]) -> Slots {
        let (width, height) = (rays.x.len(), rays.y.len());
        let mut slots = vec![NONE; width * height];
        let mut in_row = vec![false; height];
        for (slot, pixel) in (0..).zip(pixels) {
            let [i, j] = pixel.map(|number| number as usize);
            slots[i * width + j] = slot;
            in_row[i] = true;
        }
        Slots { width, slots, in_row }
    }

    fn each(&self, area: &Area, mut tell: impl FnMut(u32, usize, usize)) {
        for i in area.rows.clone().filter(|&i| self.in_row[i]) {
            for j in area.columns.clone() {
                let slot = self.slots[i * self.width + j];
                if slot != NONE {
                    tell(slot, i, j);
                }
            }
        }
    }
}

/// Where samples are near a primitive.
enum Region {
    /// Where the edge functions have at least these values.
    Triangle(TriangleOutline, [f64; 3]),
    /// Where the plane covers the sample, or the function of its horizon is at most this large.
    Plane(Linear, f64),
    /// Anywhere in its area.
    Sphere,
}

impl Region {
    /// The region and the pixels around it; `None` for a triangle that is seen edge-on.
    fn new(
        primitive: &Primitive,
        rays: &ViewingRays,
        spacing: [f64; 2],
        reach: f64,
    ) -> Option<(Area, Region)> {
        Some(match primitive {
            Primitive::Triangle(corners) => {
                let outline = TriangleOutline::new(corners, rays)?;
                let least = |edge: Linear| -reach * slope_of(&edge, spacing) - edge.error;
                let region = Region::Triangle(outline, outline.edges.map(least));
                (area_of_triangle(corners, rays, reach.ceil()), region)
            }
            Primitive::Sphere { center, radius } => {
                (area_of_sphere(*center, *radius, rays, reach.ceil()), Region::Sphere)
            }
            Primitive::Plane { point, normal } => {
                let along =
                    PlaneDistance::of_plane(*point, *normal, normal.length(), rays).denominator;
                (whole(rays), Region::Plane(along, reach * slope_of(&along, spacing)))
            }
        })
    }

    fn holds(
        &self,
        judge: &Judge,
        primitive: &Primitive,
        rays: &ViewingRays,
        [i, j]: [usize; 2],
    ) -> bool {
        let (x, y) = (rays.x[j], rays.y[i]);
        match self {
            Region::Triangle(outline, least) => {
                outline.edges.iter().zip(least).all(|(edge, least)| edge.at(x, y) >= *least)
            }
            Region::Plane(along, most) => {
                along.at(x, y).abs() <= *most || judge.covers(primitive, &rays.ray(i, j))
            }
            Region::Sphere => true,
        }
    }
}
