//! The programs that a scene can be written for.

/// A program, or a format of many programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// pbrt, version 4: one scene file, and its pictures.
    Pbrt,
    /// Mitsuba 3: a scene in XML, and a file for each mesh and each picture.
    Mitsuba,
    /// glTF 2.0, in one binary file.
    Gltf,
    /// Wavefront OBJ: triangles with normals and texture coordinates, a file of materials, and pictures.
    Obj,
    /// PLY: triangles and the colours of vertices.
    Ply,
}

impl Target {
    /// All of them.
    pub const ALL: [Target; 5] =
        [Target::Pbrt, Target::Mitsuba, Target::Gltf, Target::Obj, Target::Ply];

    /// The name, as its makers write it.
    pub fn name(self) -> &'static str {
        match self {
            Target::Pbrt => "pbrt",
            Target::Mitsuba => "Mitsuba",
            Target::Gltf => "glTF",
            Target::Obj => "OBJ",
            Target::Ply => "PLY",
        }
    }

    /// The ending of the file that is to be opened.
    pub fn ending(self) -> &'static str {
        match self {
            Target::Pbrt => "pbrt",
            Target::Mitsuba => "xml",
            Target::Gltf => "glb",
            Target::Obj => "obj",
            Target::Ply => "ply",
        }
    }
}
