//! How parts of a file are named: items of its lists by their index, and faults by what has them.

use super::error::GltfFault;
use ::gltf::json::Index;

/// A fault, and what has it, such as `accessor 3`; empty if it is the file itself.
pub(super) type Located = (String, GltfFault);

/// The extension that allows integers as positions and normals.
pub(super) const QUANTIZATION: &str = "KHR_mesh_quantization";

/// The extension that puts the mesh of a node at several places.
pub(super) const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// The item of a list that a file names by its index.
pub(super) fn item<'a, T, U>(
    list: &'a [T],
    index: Index<U>,
    what: &'static str,
) -> Result<(usize, &'a T), GltfFault> {
    let (index, count) = (index.value(), list.len());
    let item = list.get(index).ok_or(GltfFault::Unknown { what, index, count })?;
    Ok((index, item))
}
