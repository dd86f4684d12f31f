//! A conformance set for other renderers: small scenes with the one right answer to each.
//!
//! Every [`Vector`] makes one point, in triangles and one camera. [`all`] lists them, [`expected`]
//! says what is seen, and the rest writes it down for programs in any language: [`raster`] in
//! pixels, [`json()`] and [`readme()`] as text.

mod coverage;
mod depth;
mod extremes;
mod eye;
mod json;
pub mod raster;
mod readme;
mod sketch;

pub use json::{Entry, index, json};
pub use readme::readme;

use crate::common::{Camera, CameraDescription, Frame, Mesh, Scene, Shape, View};
use crate::diff::compare;
use crate::orders::{self, Method, Order, RenderOptions};

/// One scene of the set.
#[derive(Clone, Debug, PartialEq)]
pub struct Vector {
    /// Its files' names begin with it.
    pub name: &'static str,
    /// What kind of difficulty it is.
    pub group: Group,
    /// Its point, in a sentence.
    pub point: &'static str,
    /// All its triangles; a primitive's id is its triangle's index.
    pub mesh: Mesh,
    /// From where.
    pub camera: CameraDescription,
}

/// The kinds of difficulty, in the order of the set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// The top-left rule, edge by edge.
    Edges,
    /// Corners on samples.
    Corners,
    /// Edges that two triangles share.
    SharedEdges,
    /// Triangles thinner than a pixel, or without area.
    Slivers,
    /// Which of several triangles is seen.
    Depth,
    /// Triangles that reach behind the eye.
    Behind,
    /// Parallel viewing rays.
    Parallel,
    /// Very large, very small, and cameras that are not straight.
    Extremes,
}

impl Group {
    /// All of them.
    pub const ALL: [Group; 8] = [
        Group::Edges,
        Group::Corners,
        Group::SharedEdges,
        Group::Slivers,
        Group::Depth,
        Group::Behind,
        Group::Parallel,
        Group::Extremes,
    ];

    /// As files say it.
    pub fn name(self) -> &'static str {
        match self {
            Group::Edges => "edges",
            Group::Corners => "corners",
            Group::SharedEdges => "shared edges",
            Group::Slivers => "slivers",
            Group::Depth => "depth",
            Group::Behind => "behind the eye",
            Group::Parallel => "parallel",
            Group::Extremes => "extremes",
        }
    }
}

/// The endings of the files that a scene is written as, after its name.
pub const ENDINGS: [&str; 6] = [".toml", ".obj", ".json", ".ids.npy", ".t.npy", ".mask.png"];

/// The whole set, group by group.
pub fn all() -> Vec<Vector> {
    [coverage::vectors(), depth::vectors(), eye::vectors(), extremes::vectors()].concat()
}

impl Vector {
    /// The scene, of one mesh.
    pub fn scene(&self) -> Scene {
        Scene::new(vec![Shape::Mesh(self.mesh.clone()).into()]).expect("one mesh is a scene")
    }

    /// The camera, ready to make rays.
    pub fn camera(&self) -> Camera {
        Camera::new(self.camera).expect("the set's cameras are cameras")
    }
}

/// The orders do not see the same, so the right answer is not known.
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

/// What is seen: the textbook's answer, if both orders give it, each in both ways.
///
/// # Errors
///
/// Any of the four renderers sees another primitive at some sample.
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
