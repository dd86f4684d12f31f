//! Why do two renderings of one scene differ?
//!
//! - [`find_reasons`]: the reason for each differing pixel, decided by the exact judge.
//! - [`find_conventions`]: what a renderer does otherwise as a whole; the scene is drawn again under each hypothesis.
//! - [`find_common_conventions`]: the same by several pictures of one renderer.

mod blank;
mod candidate;
mod contour;
mod convention;
mod differences;
mod distances;
mod draw;
mod drawn;
mod encoding;
mod evidence;
mod expected;
mod finding;
mod fit;
mod layout;
mod missing;
mod near;
mod numbering;
mod observed;
mod outline;
mod pixels;
mod place;
mod rays;
mod reason;
mod renaming;
mod samples;
mod search;
mod sentence;
mod shown;
mod size;
mod snapped;
mod suggestions;
mod together;

pub use convention::{
    Between, Change, Clip, Convention, Depth, Edges, Evidence, Faces, Field, Framing,
    Interpolation, Look, Moved, NearPlane, Omission, Part, Placement, Pose, Rays, Sampling,
    Several, ShapeKind, Stance, Vertices,
};
pub use encoding::{DistanceEncoding, Encoding, IdEncoding, NothingEncoding};
pub use finding::{Explanation, Finding, Findings};
pub use layout::Layout;
pub use missing::{Missing, Scattered};
pub use pixels::{PixelReason, ReasonError, Reasons, Wrong, find_reasons, find_reasons_of_samples};
pub use reason::{Reason, ReasonKind, TieRules};
pub use samples::camera_of_samples;
pub use search::{SearchError, find_conventions};
pub use sentence::alternatives;
pub use size::{OtherSize, cause_of_size, check_size};
pub use together::{CommonExplanation, Rendering, find_common_conventions};

#[cfg(test)]
mod tests;
