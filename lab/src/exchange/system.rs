//! The systems that a camera can be written for.

/// A system that a camera can be written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum System {
    /// OpenGL: matrices for columns, depths from −1 to 1.
    OpenGl,
    /// Vulkan: matrices for columns, `y` down, depths from 0 to 1.
    Vulkan,
    /// Direct3D: matrices for rows, right-handed, depths from 0 to 1.
    DirectX,
    /// pbrt, version 4: a part of a scene file.
    Pbrt,
    /// Mitsuba 3: a sensor in XML.
    Mitsuba,
    /// Blender: a Python script.
    Blender,
    /// OpenCV: `K`, `R` and `t`.
    OpenCv,
    /// COLMAP: a line of `cameras.txt` and one of `images.txt`.
    Colmap,
}

impl System {
    /// All systems.
    pub const ALL: [System; 8] = [
        System::OpenGl,
        System::Vulkan,
        System::DirectX,
        System::Pbrt,
        System::Mitsuba,
        System::Blender,
        System::OpenCv,
        System::Colmap,
    ];

    /// The name, as its makers write it.
    pub fn name(self) -> &'static str {
        match self {
            System::OpenGl => "OpenGL",
            System::Vulkan => "Vulkan",
            System::DirectX => "DirectX",
            System::Pbrt => "pbrt",
            System::Mitsuba => "Mitsuba",
            System::Blender => "Blender",
            System::OpenCv => "OpenCV",
            System::Colmap => "COLMAP",
        }
    }
}
