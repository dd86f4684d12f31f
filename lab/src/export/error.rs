//! Why a scene cannot be written for a program.

use super::target::Target;
use crate::exchange::ExchangeError;
use crate::wording::grouped;
use std::io;
use thiserror::Error;

/// The most triangles of instances that are copied.
pub(super) const MOST_COPIED: u64 = 100_000_000;
/// The most instances that are placed: some hundred bytes of text each.
pub(super) const MOST_PLACED: u64 = 10_000_000;

/// Why a scene cannot be exported.
#[derive(Debug, Error)]
pub enum ExportError {
    /// The camera cannot be said.
    #[error(transparent)]
    Camera(#[from] ExchangeError),
    /// There is nothing in it.
    #[error("the scene has no objects, and a file without triangles is refused by most programs")]
    Empty,
    /// Instances are copied, and these are too many.
    #[error(
        "its instances have {} triangles, each of which would be copied, and at most {} are; state fewer instances, or \
         export as glTF, where a mesh is written once",
        grouped(*triangles), grouped(MOST_COPIED)
    )]
    Copies {
        /// The triangles of all instances.
        triangles: u64,
    },
    /// Instances are placed, and these are too many.
    #[error(
        "it has {} instances, and at most {} are written; state fewer instances",
        grouped(*places), grouped(MOST_PLACED)
    )]
    Places {
        /// How many instances there are.
        places: u64,
    },
    /// There are more vertices than the files' numbers count.
    #[error("the scene has {vertices} vertices, and {} counts to 4,294,967,295", target.name())]
    TooMany {
        /// Which format.
        target: Target,
        /// How many there are.
        vertices: usize,
    },
    /// Memory that is full.
    #[error("the files cannot be made: {0}")]
    Write(#[from] io::Error),
}
