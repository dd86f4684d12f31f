//! Why a slide cannot be drawn.

use thiserror::Error;

/// Why a slide cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct SlideError(pub(crate) String);
