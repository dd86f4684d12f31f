//! Vulkan: points are columns, the clip volume is `−w ≤ x, y ≤ w` and `0 ≤ z ≤ w` with `y` down, and the framebuffer
//! counts pixels from the upper left (Vulkan 1.3 specification, "Primitive Clipping" and "Controlling the Viewport").

use super::clip::{ClipMatrices, ClipSpace};
use super::depths::StatedDepths;
use super::error::ExchangeError;
use crate::common::View;

pub(super) fn matrices(view: &View, stated: StatedDepths) -> Result<ClipMatrices, ExchangeError> {
    let space = ClipSpace { top: -1.0, nearest: 0.0 };
    Ok(ClipMatrices::new(view.camera, stated.for_matrices(view)?, space))
}

pub(super) fn text(matrices: &ClipMatrices) -> String {
    let [width, height] = matrices.image;
    let heading = format!(
        "Vulkan, with the viewport x = 0, y = 0, width = {width}, height = {height}, minDepth = 0, maxDepth = 1.\n\
         Matrices are row by row, for columns: clip = projection * view * (x, y, z, 1); y points down in\n\
         clip space, and the projection turns it. GLSL reads matrices column by column: transpose them,\n\
         or declare them row_major."
    );
    matrices.text(&heading, "0 to 1", "VK_COMPARE_OP_GREATER, cleared to 0")
}
