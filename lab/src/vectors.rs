//! A conformance set for other renderers: small scenes, each with its only right answer.
//!
//! Every [`Vector`] makes one point, with triangles and one camera. [`all`] lists the vectors, [`expected`] gives the
//! expected frame, and the other functions write both for programs in any language: [`raster`] in pixels, [`json()`]
//! and [`readme()`] as text.

mod camera;
mod coverage;
mod depth;
mod extremes;
mod eye;
mod json;
pub mod raster;
mod readme;
mod sketch;
mod vector;

pub use json::{Entry, index, json};
pub use readme::readme;
pub use vector::{ENDINGS, Group, Vector};

use crate::common::{Frame, View};
use crate::diff::compare;
use crate::orders::{self, Method, Order, RenderOptions};

/// The whole set, group by group.
pub fn all() -> Vec<Vector> {
    let groups =
        [coverage::vectors, depth::vectors, eye::vectors, camera::vectors, extremes::vectors];
    groups.into_iter().flat_map(|vectors| vectors()).collect()
}

/// The orders see different primitives, so the right answer is unknown.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the scene {scene:?}: {method} object order and image order {verdict}; nothing is written, \
     because the expected answer is not known; please report this as a bug"
)]
pub struct Disagreement {
    scene: String,
    method: &'static str,
    verdict: String,
}

/// The expected frame: the textbook's answer, if both orders give the same answer, each in both methods.
///
/// # Errors
///
/// An error if any of the four renderers sees another primitive at some sample.
pub fn expected(vector: &Vector) -> Result<Frame, Disagreement> {
    let (scene, camera) = (vector.scene(), vector.camera());
    let view = View::new(&scene, &camera);
    let options = RenderOptions { no_counts: true, no_times: true, ..RenderOptions::default() };
    let rendered = |order, method| {
        let rendered = orders::render(order, method, &view, &options);
        rendered.expect("only a stream has errors").frame
    };
    let answer = rendered(Order::Object, Method::Textbook);
    for method in [Method::Textbook, Method::Fast] {
        for order in [Order::Object, Order::Image] {
            agree(vector.name, method, &answer, &rendered(order, method))?;
        }
    }
    Ok(answer)
}

fn agree(scene: &str, method: Method, answer: &Frame, other: &Frame) -> Result<(), Disagreement> {
    let comparison = compare(answer, other);
    if comparison.matches() {
        return Ok(());
    }
    Err(Disagreement { scene: scene.into(), method: method.name(), verdict: comparison.verdict() })
}

#[cfg(test)]
mod tests;
