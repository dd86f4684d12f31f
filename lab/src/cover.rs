//! The pixels that a triangle in raster coordinates covers.
//!
//! Raster coordinates count in pixels, `x` to the right and `y` down from the image's top left
//! corner, so that the centre of pixel `(i, j)` is `x = j + ½`, `y = i + ½`. A pixel is covered if
//! its centre is inside, or on a left or top edge (the top-left rule).
//!
//! **Exact parts**: everything. The camera of the test is a parallel camera with the axes of the raster (`u` = right,
//! `v` = up = `−y`), with its eye over the origin: offsets from the eye *are* the stored raster coordinates, `f32` of
//! any size, and the pixels' centres are the rays' origins, without any rounding. Only a decimal that is no exact
//! `f32`, such as 0.1, is rounded, once, to the nearest `f32`: [`Cover::triangle`] holds the rounded corners.

use crate::common::exact::EdgeSigns;
use crate::common::glam::{DVec3, Vec2, Vec3};
use crate::common::{Camera, CameraDescription, CameraError, Judge, Orientation, Projection, Sign};
use image::GrayImage;
use rayon::prelude::*;
use std::ops::Range;

/// The coverage of a triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct Cover {
    /// The corners in the test.
    pub triangle: [Vec2; 3],
    /// The image's width and height.
    pub image: [u32; 2],
    /// The orientation of the corners, in their order: `Negative` is counter-clockwise, `Positive` clockwise. `Zero`
    /// is a triangle without area, which covers nothing.
    pub facing: Sign,
    /// The rows in which the triangle covers or touches a pixel's centre, from the top.
    pub rows: Vec<Row>,
}

/// The coverage of a triangle in one row of pixels. A triangle has no gaps, so each field is a run of columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// The row from the top, counted from 0.
    pub i: u32,
    /// The columns that the triangle covers.
    pub covered: Range<u32>,
    /// The columns with a centre inside all edges.
    pub inside: Range<u32>,
    /// The columns with a centre inside the triangle or exactly on an edge or corner.
    pub touched: Range<u32>,
}

/// The position of a pixel's centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Containment {
    /// Outside: not covered.
    Outside,
    /// Exactly on an edge or a corner.
    OnEdge {
        /// Whether the top-left rule gives the pixel to this triangle.
        covered: bool,
    },
    /// Inside all edges: covered.
    Inside,
}

/// The reason why the coverage cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CoverError {
    /// A coordinate is NaN or infinite.
    #[error("corner {corner} is {value}; give two finite numbers")]
    NotFinite {
        /// The number of the corner, counted from 1.
        corner: usize,
        /// The given value.
        value: Vec2,
    },
    /// The image is empty or too large.
    #[error(transparent)]
    Image(#[from] CameraError),
}

/// Finds the pixels of a `[width, height]` image that a triangle in raster coordinates covers.
///
/// The corners may be anywhere, in either order. The two triangles of a shared edge together cover each pixel on the
/// edge once.
///
/// # Errors
///
/// An error for a corner that is not finite, or an image of a size that no camera allows.
///
/// ```
/// use bothways_lab::common::glam::vec2;
/// use bothways_lab::cover::cover;
///
/// // The hypotenuse passes through the centres of (0, 3), (1, 2), (2, 1), (3, 0): a right edge.
/// let cover = cover([vec2(0.0, 0.0), vec2(0.0, 4.0), vec2(4.0, 0.0)], [4, 4])?;
/// let row = |i| (0..4).map(|j| if cover.covers(i, j) { '#' } else { '.' }).collect::<String>();
/// assert_eq!([row(0), row(1), row(2), row(3)], ["###.", "##..", "#...", "...."]);
/// assert_eq!((cover.covered(), cover.on_edge(), cover.on_edge_and_covered()), (6, 4, 0));
/// # Ok::<(), bothways_lab::cover::CoverError>(())
/// ```
pub fn cover(triangle: [Vec2; 3], image: [u32; 2]) -> Result<Cover, CoverError> {
    if let Some(corner) = triangle.iter().position(|corner| !corner.is_finite()) {
        return Err(CoverError::NotFinite { corner: corner + 1, value: triangle[corner] });
    }
    let raster = RasterView::new(triangle, image)?;
    let [columns, rows] = bounds(triangle, image);
    if raster.facing == Sign::Zero || columns.is_empty() || rows.is_empty() {
        return Ok(Cover { triangle, image, facing: raster.facing, rows: Vec::new() });
    }
    let found = rows.into_par_iter().map(|i| raster.row(i, &columns));
    let rows = found.filter(|row| !row.touched.is_empty()).collect();
    Ok(Cover { triangle, image, facing: raster.facing, rows })
}

impl Cover {
    /// The position of the centre of pixel `(i, j)`.
    pub fn place(&self, i: u32, j: u32) -> Containment {
        let Ok(index) = self.rows.binary_search_by_key(&i, |row| row.i) else {
            return Containment::Outside;
        };
        self.rows[index].place(j)
    }

    /// Whether pixel `(i, j)` is covered.
    pub fn covers(&self, i: u32, j: u32) -> bool {
        matches!(self.place(i, j), Containment::Inside | Containment::OnEdge { covered: true })
    }

    /// The number of covered pixels.
    pub fn covered(&self) -> u64 {
        self.rows.iter().map(|row| row.covered.len() as u64).sum()
    }

    /// The number of pixels with a centre exactly on an edge or a corner.
    pub fn on_edge(&self) -> u64 {
        self.rows.iter().map(|row| (row.touched.len() - row.inside.len()) as u64).sum()
    }

    /// The number of these pixels that are covered.
    pub fn on_edge_and_covered(&self) -> u64 {
        self.rows.iter().map(|row| (row.covered.len() - row.inside.len()) as u64).sum()
    }

    /// The mask: 255 where a pixel is covered, 0 elsewhere.
    pub fn mask(&self) -> GrayImage {
        let [width, height] = self.image;
        let mut mask = GrayImage::new(width, height);
        for row in &self.rows {
            let place = |column: u32| row.i as usize * width as usize + column as usize;
            mask.as_mut()[place(row.covered.start)..place(row.covered.end)].fill(u8::MAX);
        }
        mask
    }
}

impl Row {
    /// The position of the centre of this row's pixel in column `j`.
    pub fn place(&self, j: u32) -> Containment {
        if self.inside.contains(&j) {
            Containment::Inside
        } else if self.touched.contains(&j) {
            Containment::OnEdge { covered: self.covered.contains(&j) }
        } else {
            Containment::Outside
        }
    }
}

/// The triangle in front of the camera with the axes of the raster.
struct RasterView {
    camera: Camera,
    judge: Judge,
    corners: [DVec3; 3],
    facing: Sign,
}

impl RasterView {
    fn new(triangle: [Vec2; 3], image: [u32; 2]) -> Result<RasterView, CameraError> {
        let orientation = Orientation::Frame { u: Vec3::X, v: Vec3::NEG_Y, w: Vec3::NEG_Z };
        let camera = Camera::new(CameraDescription {
            projection: Projection::Parallel,
            eye: Vec3::NEG_Z,
            orientation,
            viewport: [1.0, 1.0],
            image,
            ..CameraDescription::default()
        })?;
        let judge = Judge::new(&camera);
        // The corners relative to the eye at (0, 0, −1), in the same way as the offsets of a view.
        let corners = triangle.map(|corner| corner.extend(0.0).as_dvec3() - DVec3::NEG_Z);
        let facing = judge.facing(&corners, &camera.ray_through(0.0, 0.0));
        Ok(RasterView { camera, judge, corners, facing })
    }

    /// The judge's signs for the triangle's edges at the centre of pixel `(i, j)`.
    fn signs(&self, i: u32, j: u32) -> EdgeSigns {
        let ray = self.camera.ray_through(f64::from(j) + 0.5, -(f64::from(i) + 0.5));
        self.judge.edge_signs(&self.corners, &ray)
    }

    fn row(&self, i: u32, columns: &Range<u32>) -> Row {
        let outside = -self.facing;
        let run = |holds: &dyn Fn(&EdgeSigns, usize) -> bool| {
            let halves = [0, 1, 2].map(|edge| half(columns, |j| holds(&self.signs(i, j), edge)));
            halves.into_iter().reduce(|a, b| overlap(&a, &b)).expect("there are three edges")
        };
        let covered = run(&|signs, edge| signs.decided[edge] == self.facing);
        let inside = run(&|signs, edge| signs.at_sample[edge] == self.facing);
        let touched = run(&|signs, edge| signs.at_sample[edge] != outside);
        Row { i, covered, inside, touched }
    }
}

/// The columns on one side of an edge. Along a row an edge function is affine, nudged or not, so its sign changes at
/// most once: bisection with the exact sign finds the place.
fn half(columns: &Range<u32>, holds: impl Fn(u32) -> bool) -> Range<u32> {
    let Range { start, end } = *columns;
    let at_start = holds(start);
    if at_start == holds(end - 1) {
        return if at_start { start..end } else { start..start };
    }
    let (mut before, mut after) = (start, end - 1);
    while after - before > 1 {
        let middle = before.midpoint(after);
        if holds(middle) == at_start {
            before = middle;
        } else {
            after = middle;
        }
    }
    if at_start { start..after } else { after..end }
}

fn overlap(a: &Range<u32>, b: &Range<u32>) -> Range<u32> {
    let (start, end) = (a.start.max(b.start), a.end.min(b.end));
    if start < end { start..end } else { 0..0 }
}

/// The ranges of the pixels with a centre that may lie in the triangle: first the columns, then the rows.
///
/// `low − ½` is rounded, but rounding keeps order and whole numbers: no pixel gets lost.
fn bounds(triangle: [Vec2; 3], image: [u32; 2]) -> [Range<u32>; 2] {
    [0, 1].map(|axis| {
        let side = image[axis];
        let coordinates = triangle.map(|corner| f64::from(corner[axis]));
        let low = coordinates.into_iter().fold(f64::INFINITY, f64::min);
        let high = coordinates.into_iter().fold(f64::NEG_INFINITY, f64::max);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to the image"
        )]
        let clamped = |place: f64| place.clamp(0.0, side.into()) as u32;
        clamped((low - 0.5).ceil())..clamped((high - 0.5).floor() + 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::glam::vec2;

    fn triangle(corners: [[f32; 2]; 3]) -> [Vec2; 3] {
        corners.map(Vec2::from_array)
    }

    fn drawn(corners: [[f32; 2]; 3], image: [u32; 2]) -> Vec<String> {
        let cover = cover(triangle(corners), image).unwrap();
        let letter = |i, j| match cover.place(i, j) {
            Containment::Inside => '#',
            Containment::OnEdge { covered: true } => '+',
            Containment::OnEdge { covered: false } => 'o',
            Containment::Outside => '.',
        };
        (0..image[1]).map(|i| (0..image[0]).map(|j| letter(i, j)).collect()).collect()
    }

    #[test]
    fn left_and_top_edges_own_their_pixels() {
        let upper = drawn([[0.5, 0.5], [0.5, 3.5], [3.5, 0.5]], [4, 4]);
        assert_eq!(upper, ["+++o", "+#o.", "+o..", "o..."]);
        let lower = drawn([[3.5, 0.5], [0.5, 3.5], [3.5, 3.5]], [4, 4]);
        assert_eq!(lower, ["...o", "..+o", ".+#o", "oooo"]);
    }

    #[test]
    fn winding_changes_the_facing_alone() {
        let [a, b, c] = triangle([[0.5, 0.5], [0.5, 3.5], [3.5, 0.5]]);
        let (one, other) = (cover([a, b, c], [4, 4]).unwrap(), cover([a, c, b], [4, 4]).unwrap());
        assert_eq!((one.facing, other.facing), (Sign::Negative, Sign::Positive));
        assert_eq!(one.rows, other.rows);
    }

    #[test]
    fn without_area_nothing_is_covered() {
        let cover = cover(triangle([[0.5, 0.5], [2.5, 2.5], [3.5, 3.5]]), [4, 4]).unwrap();
        assert_eq!((cover.facing, cover.covered()), (Sign::Zero, 0));
    }

    #[test]
    fn beyond_the_image_nothing_is_lost() {
        let all = drawn([[-1e30, -1e30], [3e38, -1e30], [-1e30, 3e38]], [3, 2]);
        assert_eq!(all, ["###", "###"]);
        assert_eq!(drawn([[9.0, 0.0], [12.0, 0.0], [9.0, 5.0]], [3, 2]), ["...", "..."]);
    }

    #[test]
    fn the_smallest_shift_of_a_corner_decides() {
        // The left edge passes through the centre (0.5, 0.5), or by it at a distance of 2^-149.
        let corners = |x| triangle([[x, 0.0], [1.0 + x, 1.0], [0.0, 2.0]]);
        let place = |x| cover(corners(x), [1, 1]).unwrap().place(0, 0);
        assert_eq!(place(0.0), Containment::OnEdge { covered: false });
        assert_eq!(place(f32::from_bits(1)), Containment::Inside);
        assert_eq!(place(-f32::from_bits(1)), Containment::Outside);
    }

    #[test]
    fn what_is_not_finite_is_refused() {
        let nan = [vec2(0.0, 0.0), vec2(1.0, f32::NAN), vec2(0.0, 1.0)];
        let message = cover(nan, [4, 4]).unwrap_err().to_string();
        assert!(message.starts_with("corner 2 is [1, NaN]"), "{message}");
        assert!(matches!(cover([Vec2::ZERO; 3], [0, 4]), Err(CoverError::Image(_))));
    }

    #[test]
    fn the_mask_shows_what_is_covered() {
        let cover = cover(triangle([[0.0, 0.0], [0.0, 2.0], [2.0, 0.0]]), [3, 2]).unwrap();
        assert_eq!(cover.mask().into_raw(), [255, 0, 0, 0, 0, 0]);
    }
}
