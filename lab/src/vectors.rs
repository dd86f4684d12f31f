//! A conformance set for other renderers: small scenes, each with its only right answer.
//!
//! Every [`Vector`] makes one point, with triangles and one camera. [`all`] lists the vectors, [`expected`] gives the
//! expected frame, and the other functions write both for programs in any language: [`raster`] in pixels, [`json()`]
//! and [`readme()`] as text.

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
    /// The scene's name. The names of the scene's files begin with this name.
    pub name: &'static str,
    /// The kind of difficulty.
    pub group: Group,
    /// The point of the scene, in one sentence.
    pub point: &'static str,
    /// All triangles of the scene; the id of a primitive is the index of its triangle.
    pub mesh: Mesh,
    /// The camera of the scene.
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
    /// Which of several triangles is visible.
    Depth,
    /// Triangles that reach behind the eye.
    Behind,
    /// Parallel viewing rays.
    Parallel,
    /// Very large, very small, and cameras that are not straight.
    Extremes,
}

impl Group {
    /// All kinds of difficulty.
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

    /// The name of this kind in files.
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

/// The endings of the files of a scene, after its name.
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
