//! The set that a renderer is checked with: the built-in one, or one that was written to a folder.

use crate::common::{Camera, Scene};
use crate::diff::pairs::{self, PairsError, SetScene};
use crate::scenes::{self, LoadError};
use crate::vectors;
use std::path::PathBuf;

/// A conformance set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ConformanceSet {
    /// The set of [`vectors`].
    BuiltIn,
    /// A set in a folder, as `bothways vectors` writes it.
    Folder(PathBuf),
}

/// The reason why a set cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum SetError {
    /// The folder has no index of a set.
    #[error(
        "{} is no conformance set: it has no index.json of one; write one with bothways vectors -o {}",
        .folder.display(), .folder.display()
    )]
    NoSet {
        /// The folder.
        folder: PathBuf,
    },
    /// The index of the set is damaged.
    #[error(transparent)]
    Index(#[from] PairsError),
    /// A scene of the set cannot be loaded.
    #[error("{0}; write the set again with bothways vectors")]
    Scene(#[from] LoadError),
    /// The camera of a scene of the set is none.
    #[error("the camera of {scene}: {problem}; write the set again with bothways vectors")]
    Camera {
        /// The scene.
        scene: String,
        /// The problem.
        problem: String,
    },
}

impl ConformanceSet {
    /// The names and the points of the scenes.
    pub(super) fn scenes(&self) -> Result<Vec<SetScene>, SetError> {
        match self {
            ConformanceSet::BuiltIn => {
                let scene = |vector: vectors::Vector| SetScene {
                    name: vector.name.into(),
                    point: vector.point.into(),
                };
                Ok(vectors::all().into_iter().map(scene).collect())
            }
            ConformanceSet::Folder(folder) => pairs::scenes_of_set(folder)?
                .ok_or_else(|| SetError::NoSet { folder: folder.clone() }),
        }
    }

    /// A scene of the set, and its camera.
    pub(super) fn load(&self, name: &str) -> Result<(Scene, Camera), SetError> {
        match self {
            ConformanceSet::BuiltIn => {
                let vector = vectors::all().into_iter().find(|vector| vector.name == name);
                let vector = vector.expect("the name is one of the set's");
                Ok((vector.scene(), vector.camera()))
            }
            ConformanceSet::Folder(folder) => {
                let path = folder.join(format!("{name}.toml"));
                let loaded = scenes::load(&path.to_string_lossy())?;
                let camera = Camera::new(loaded.camera).map_err(|error| SetError::Camera {
                    scene: path.display().to_string(),
                    problem: error.to_string(),
                })?;
                Ok((loaded.scene, camera))
            }
        }
    }
}
