//! Near and far planes, which our rays do not have and other systems need.

use super::error::ExchangeError;
use super::system::System;
use crate::common::{Projection, Shape, View};
use crate::opengl::{Depths, NEAR, behind_everything};

/// The depths of the near and the far plane along `−w`, in lengths of the world, as far as they are stated.
///
/// What is not stated is chosen so that as little as possible is cut off. A perspective camera's near plane lies at
/// `d / 1024`, and its far plane at infinity where the system knows that. A parallel camera's near plane goes through the
/// eye, or nearly so, and its far plane lies behind all primitives except planes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatedDepths {
    /// The depth of the near plane.
    pub near: Option<f64>,
    /// The depth of the far plane.
    pub far: Option<f64>,
}

impl StatedDepths {
    /// For a system that has no such planes: none may be stated.
    pub(super) fn none(self, system: System) -> Result<(), ExchangeError> {
        match self {
            StatedDepths { near: None, far: None } => Ok(()),
            _ => Err(ExchangeError::NoDepths { system }),
        }
    }

    /// For matrices: a perspective camera's far plane may be at infinity, a parallel camera's near plane at the eye.
    pub(super) fn for_matrices(self, view: &View) -> Result<Depths, ExchangeError> {
        match view.camera.projection() {
            Projection::Perspective => {
                let near = self.near.unwrap_or(NEAR * view.camera.distance());
                let depths = Depths { near, far: self.far };
                check(depths, near > 0.0, "a perspective camera needs one before the eye")
            }
            Projection::Parallel => {
                let near = self.near.unwrap_or(0.0);
                let far = self.far.unwrap_or_else(|| behind_everything(view).max(2.0 * near));
                let depths = Depths { near, far: Some(far) };
                check(depths, near >= 0.0, "no ray begins behind the plane of the eye")
            }
        }
    }

    /// For a system whose near plane is never nearer than `least`, nor at the eye, and whose far plane is never at
    /// infinity. Where the scene has planes, the far plane is moved back a thousandfold.
    pub(super) fn finite(
        self,
        view: &View,
        least: f64,
        what: &'static str,
    ) -> Result<[f64; 2], ExchangeError> {
        let objects = view.scene.objects().iter();
        let planes =
            objects.map(|object| &object.shape).any(|shape| matches!(shape, Shape::Plane(_)));
        let behind = behind_everything(view) * if planes { 1024.0 } else { 1.0 };
        let chosen = match view.camera.projection() {
            Projection::Perspective => NEAR * view.camera.distance(),
            Projection::Parallel => NEAR * NEAR * behind,
        };
        let near = self.near.unwrap_or(chosen.max(least));
        let far = self.far.unwrap_or(behind.max(2.0 * near));
        check(Depths { near, far: Some(far) }, near > 0.0 && near >= least, what)?;
        Ok([near, far])
    }
}

fn check(depths: Depths, near_is_right: bool, what: &'static str) -> Result<Depths, ExchangeError> {
    let Depths { near, far } = depths;
    let finite = |plane, depth: f64| {
        let problem = ExchangeError::NotFinite { plane, depth };
        if depth.is_finite() { Ok(()) } else { Err(problem) }
    };
    finite("near", near)?;
    if !near_is_right {
        return Err(ExchangeError::Near { near, what });
    }
    if let Some(far) = far {
        finite("far", far)?;
        if far <= near {
            return Err(ExchangeError::Far { near, far });
        }
    }
    Ok(depths)
}
