//! What can be rendered by name: the built-in scenes, scene files, and mesh files, which get a
//! camera that frames them.

mod built_in;
mod framing;
mod load;
mod open;
mod projection;
mod studio;

pub use built_in::{BUILT_IN, BuiltIn, DEFAULT};
pub use framing::{FrameMeshError, Framing, framed};
pub use load::{LoadError, LoadOptions, LoadedScene, load, load_file, load_with};
pub use open::{OpenedScene, StreamedScene, open, open_stream};
pub use projection::with_projection;

#[cfg(test)]
mod tests;
