//! Matrices into clip space, which OpenGL, Vulkan and Direct3D share but for signs, depths and the order of factors.

use super::numbers::number;
use crate::common::Camera;
use crate::opengl::{Depths, LAYOUT, Matrix, camera_from_world, clip_from_camera};
use serde::Serialize;

/// The matrices of a camera for a graphics processor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClipMatrices {
    /// `row-major`: each matrix is a list of its rows.
    pub layout: &'static str,
    /// `columns` if points are columns, `clip = projection · view · (x, y, z, 1)`; `rows` if they are rows,
    /// `clip = (x, y, z, 1) · view · projection`.
    pub vectors: &'static str,
    /// The image's width and height in pixels.
    pub image: [u32; 2],
    /// The depth along `−w` of the near plane.
    pub near: f64,
    /// The depth of the far plane; `None` means infinity.
    pub far: Option<f64>,
    /// `camera_from_world`: `x` right, `y` up, looking along `−z`.
    pub view: Matrix,
    /// `clip_from_camera`, with depths as the system has them by default.
    pub projection: Matrix,
    /// `clip_from_camera` for depths from 1 (near) to 0 (far): floating-point depth buffers resolve distances much
    /// better in this direction.
    pub projection_reversed_depth: Matrix,
}

/// Where the top of the picture and the near plane lie after the division by the clip coordinate `w`.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClipSpace {
    /// `y` of the picture's upper border: 1 or −1.
    pub(super) top: f64,
    /// The depth of the near plane: −1 or 0. That of the far plane is 1.
    pub(super) nearest: f64,
}

impl ClipMatrices {
    /// The matrices for columns.
    pub(super) fn new(camera: &Camera, depths: Depths, space: ClipSpace) -> ClipMatrices {
        let projection =
            |at_near, at_far| clip_from_camera(camera, depths, space.top, [at_near, at_far]);
        ClipMatrices {
            layout: LAYOUT,
            vectors: "columns",
            image: camera.image(),
            near: depths.near,
            far: depths.far,
            view: camera_from_world(camera),
            projection: projection(space.nearest, 1.0),
            projection_reversed_depth: projection(1.0, 0.0),
        }
    }

    /// The same matrices for points that are rows.
    pub(super) fn for_rows(self) -> ClipMatrices {
        ClipMatrices {
            vectors: "rows",
            view: transposed(&self.view),
            projection: transposed(&self.projection),
            projection_reversed_depth: transposed(&self.projection_reversed_depth),
            ..self
        }
    }

    /// The three matrices after a heading; `depths` is the range of depths, `reversed` what to set for reversed ones.
    pub(super) fn text(&self, heading: &str, depths: &str, reversed: &str) -> String {
        let far = self.far.map_or("infinity".into(), number);
        let planes = format!("near plane at {}, far plane at {far}", number(self.near));
        format!(
            "{heading}\n\n\
             view (camera_from_world): x right, y up, looks along -z; right-handed\n{}\n\
             projection: {planes}, depths {depths}\n{}\n\
             the same with reversed depth, 1 to 0: {reversed}\n{}\n\
             This program's rays have no near and no far plane: what is beyond them is cut off there.\n",
            rows(&self.view),
            rows(&self.projection),
            rows(&self.projection_reversed_depth),
        )
    }
}

fn transposed(matrix: &Matrix) -> Matrix {
    [0, 1, 2, 3].map(|column| matrix.map(|row| row[column]))
}

/// The rows, with aligned columns.
fn rows(matrix: &Matrix) -> String {
    let words = matrix.map(|row| row.map(number));
    let width = words.as_flattened().iter().map(String::len).max().unwrap_or(0);
    let row = |row: &[String; 4]| {
        let cells = row.iter().map(|word| format!("  {word:>width$}"));
        cells.collect::<String>() + "\n"
    };
    words.iter().map(row).collect()
}
