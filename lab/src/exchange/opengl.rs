//! OpenGL: points are columns, the clip volume is `−w ≤ x, y, z ≤ w` with `y` up, and the window counts pixels from the
//! lower left (OpenGL 4.6 core specification, 13.7 and 13.8).

use super::clip::{ClipMatrices, ClipSpace};
use super::depths::StatedDepths;
use super::error::ExchangeError;
use crate::common::View;

pub(super) fn matrices(view: &View, stated: StatedDepths) -> Result<ClipMatrices, ExchangeError> {
    let space = ClipSpace { top: 1.0, nearest: -1.0 };
    Ok(ClipMatrices::new(view.camera, stated.for_matrices(view)?, space))
}

pub(super) fn text(matrices: &ClipMatrices) -> String {
    let [width, height] = matrices.image;
    let heading = format!(
        "OpenGL, with glViewport(0, 0, {width}, {height}); row i of the picture is its row {} - i.\n\
         Matrices are row by row, for columns: clip = projection * view * (x, y, z, 1). glUniformMatrix4fv\n\
         wants them column by column: pass GL_TRUE as its transpose argument, or transpose them.",
        height - 1
    );
    let reversed =
        "glClipControl(GL_LOWER_LEFT,\nGL_ZERO_TO_ONE), glDepthFunc(GL_GREATER), glClearDepth(0)";
    matrices.text(&heading, "-1 to 1", reversed)
}
