//! A scene of the set.

use crate::common::{Camera, CameraDescription, Mesh, Scene, Shape};

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
    /// Cameras with another eye, other axes or another distance.
    Camera,
    /// Very large, very small and very far.
    Extremes,
}

impl Group {
    /// All kinds of difficulty.
    pub const ALL: [Group; 9] = [
        Group::Edges,
        Group::Corners,
        Group::SharedEdges,
        Group::Slivers,
        Group::Depth,
        Group::Behind,
        Group::Parallel,
        Group::Camera,
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
            Group::Camera => "camera",
            Group::Extremes => "extremes",
        }
    }
}

/// The endings of the files of a scene, after its name.
pub const ENDINGS: [&str; 6] = [".toml", ".obj", ".json", ".ids.npy", ".t.npy", ".mask.png"];

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
