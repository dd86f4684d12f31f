//! The surroundings of a mesh file without light: warm plaster in front of a slate wall, lit over the viewer's left
//! shoulder.
//!
//! The scene file that shows the mesh contains this text; this module parses the same text.

use crate::common::{CameraDescription, Material, Scene};
use crate::formats::scene_file::{self, framed_mesh_toml};
use crate::formats::source::Files;

const BACKGROUND: &str = "background = \"#36424b\"\n";

const PLASTER: &str = "
[material.plaster]
color = \"#e6c9a5\"
specular = 0.12
shininess = 25
";

/// One light comes over the left shoulder in the standard view, from the right, and a little from behind, so that
/// nothing is black from any other side either.
const LIGHTS: &str = "
[[light]]
directional = [0.3, -1.15, -0.8]
intensity = 0.78

[[light]]
directional = [-1, -0.3, 0.1]
intensity = 0.2

[[light]]
directional = [0.2, -0.4, 1]
intensity = 0.15

[[light]]
ambient = true
intensity = 0.14
";

/// The scene file that shows a mesh file from a camera, whose viewport may be stated; a mesh with its own materials keeps
/// them.
pub(super) fn toml(
    camera: &CameraDescription,
    viewport_stated: bool,
    mesh: &str,
    plaster: bool,
) -> String {
    let file = framed_mesh_toml(camera, viewport_stated, mesh);
    let (camera, object) = file.split_once("\n[[object]]\n").expect("it has one object");
    let [material, name] = if plaster { [PLASTER, "material = \"plaster\"\n"] } else { ["", ""] };
    format!("{camera}{BACKGROUND}{material}{LIGHTS}\n[[object]]\n{object}{name}")
}

/// The material of a mesh, unless the mesh has its own material.
pub(super) fn material_for(has_its_own: bool) -> Option<Material> {
    (!has_its_own).then(|| sample().objects()[0].material.clone())
}

/// The scene in this light.
pub(super) fn lit(mut scene: Scene) -> Scene {
    let sample = sample();
    (scene.lights, scene.background) = (sample.lights, sample.background);
    scene
}

/// A scene with the complete studio.
fn sample() -> Scene {
    let ball = "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }\nmaterial = \"plaster\"\n";
    let text = format!("[camera]\n{BACKGROUND}{PLASTER}{LIGHTS}\n{ball}");
    scene_file::parse("studio.toml", &text, &Files::none()).expect("it is right").scene
}
