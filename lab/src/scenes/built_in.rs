//! The scenes that come with the program.

/// A scene that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuiltIn {
    /// The name on the command line.
    pub name: &'static str,
    /// The point of the scene, in one sentence; the first line of the scene file has the same sentence.
    pub about: &'static str,
    /// The scene file.
    pub toml: &'static str,
}

/// The name of the default scene.
pub const DEFAULT: &str = "lecture";

/// All built-in scenes, the default first.
pub const BUILT_IN: &[BuiltIn] = &[
    BuiltIn {
        name: "lecture",
        about: "The first slide: Newell's teapot, a sphere and a plane, with materials and light.",
        toml: include_str!("../../../scenes/lecture.toml"),
    },
    BuiltIn {
        name: "canonical",
        about: "The lecture's first camera before one triangle, one sphere and one plane.",
        toml: include_str!("../../../scenes/canonical.toml"),
    },
    BuiltIn {
        name: "ties",
        about: "Edges and vertices exactly on sample points, at every size that is a power of two.",
        toml: include_str!("../../../scenes/ties.toml"),
    },
    BuiltIn {
        name: "behind",
        about: "Triangles, spheres and planes that reach behind the eye, and some that lie there.",
        toml: include_str!("../../../scenes/behind.toml"),
    },
    BuiltIn {
        name: "slivers",
        about: "Needles down to thousandths of a pixel, and a fan of them that leaves no gap.",
        toml: include_str!("../../../scenes/slivers.toml"),
    },
    BuiltIn {
        name: "overlap",
        about: "Coplanar and duplicated faces, of which the first in the scene is always seen.",
        toml: include_str!("../../../scenes/overlap.toml"),
    },
    BuiltIn {
        name: "parallel",
        about: "A staircase of blocks and balls before a parallel camera: equal things are equally large.",
        toml: include_str!("../../../scenes/parallel.toml"),
    },
    BuiltIn {
        name: "inside",
        about: "A closed mesh seen from within: every pixel is covered, or the surface leaks.",
        toml: include_str!("../../../scenes/inside.toml"),
    },
    BuiltIn {
        name: "many",
        about: "A necklace of some 100,000 triangles, so that searching well pays.",
        toml: include_str!("../../../scenes/many.toml"),
    },
];

/// All names, the default first.
pub(super) fn names() -> Vec<&'static str> {
    BUILT_IN.iter().map(|built_in| built_in.name).collect()
}
