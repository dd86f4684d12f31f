//! Direct3D: points are rows, the clip volume is `−w ≤ x, y ≤ w` and `0 ≤ z ≤ w` with `y` up, and the viewport counts
//! pixels from the upper left (Direct3D 11.3 functional specification, 3.3.1 and 15.6).
//!
//! Our world is right-handed, so these are the matrices of `XMMatrixLookToRH` and `XMMatrixPerspectiveRH` or
//! `XMMatrixOrthographicRH`: the camera looks along `−z`. The left-handed ones would mirror the picture.

use super::clip::{ClipMatrices, ClipSpace};
use super::depths::StatedDepths;
use super::error::ExchangeError;
use crate::common::View;

pub(super) fn matrices(view: &View, stated: StatedDepths) -> Result<ClipMatrices, ExchangeError> {
    let space = ClipSpace { top: 1.0, nearest: 0.0 };
    Ok(ClipMatrices::new(view.camera, stated.for_matrices(view)?, space).for_rows())
}

pub(super) fn text(matrices: &ClipMatrices) -> String {
    let [width, height] = matrices.image;
    let heading = format!(
        "Direct3D, with the viewport TopLeftX = 0, TopLeftY = 0, Width = {width}, Height = {height}, MinDepth = 0,\n\
         MaxDepth = 1. Right-handed, as XMMatrixLookToRH and XMMatrixPerspectiveRH are.\n\
         Matrices are row by row, for rows: clip = (x, y, z, 1) * view * projection, as XMFLOAT4X4 stores\n\
         them. HLSL reads constant buffers column by column: declare them row_major, or transpose them."
    );
    let reversed = "D3D11_COMPARISON_GREATER or\nD3D12_COMPARISON_FUNC_GREATER, cleared to 0";
    matrices.text(&heading, "0 to 1", reversed)
}
