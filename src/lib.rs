//! Renders one scene in object order and in image order, and proves that both see the same.

pub use bothways_common as common;
pub use bothways_rasterize as rasterize;
pub use bothways_raytrace as raytrace;
