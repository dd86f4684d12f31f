//! A scene for Mitsuba 3: XML, and a file for each mesh, which XML cannot hold.
//!
//! Meshes with normals are OBJ files, others PLY files, whose faces are then flat by `face_normals` (Mitsuba 3
//! documentation, "Shapes"). Colours are linear, with the primaries of sRGB ("Spectra").

use super::corners::Corners;
use super::lights::{Physical, lights};
use super::pieces::{Form, Piece, Pieces};
use super::{ExportError, Target};
use crate::common::{Sphere, View};
use crate::exchange::{StatedDepths, System, exchange};
use crate::formats::{obj, ply};

pub(super) fn files(
    view: &View,
    pieces: &Pieces,
    name: &str,
    notes: &mut Vec<String>,
) -> Result<Vec<(String, Vec<u8>)>, ExportError> {
    let mut xml = String::from("<scene version=\"3.0.0\">\n<integrator type=\"path\"/>\n");
    xml += &exchange(view, System::Mitsuba, StatedDepths::default())?.text();
    for light in lights(view, pieces, notes) {
        xml += &emitter(light);
    }
    let mut meshes = Vec::new();
    for (number, piece) in pieces.all.iter().enumerate() {
        xml += &shape(piece, name, number, &mut meshes)?;
    }
    xml += "</scene>\n";
    let mut files = vec![(format!("{name}.{}", Target::Mitsuba.ending()), xml.into_bytes())];
    files.extend(meshes);
    Ok(files)
}

fn emitter(light: Physical) -> String {
    let grey = |name: &str, value: f64| {
        format!("    <rgb name=\"{name}\" value=\"{value:?}, {value:?}, {value:?}\"/>\n")
    };
    let place = |kind: &str, name: &str, [x, y, z]: [f64; 3]| {
        format!("    <{kind} name=\"{name}\" x=\"{x:?}\" y=\"{y:?}\" z=\"{z:?}\"/>\n")
    };
    let (plugin, inside) = match light {
        Physical::Constant { radiance } => ("constant", grey("radiance", radiance)),
        Physical::Distant { direction, irradiance } => (
            "directional",
            place("vector", "direction", direction.to_array()) + &grey("irradiance", irradiance),
        ),
        Physical::Point { position, intensity } => (
            "point",
            place("point", "position", position.to_array()) + &grey("intensity", intensity),
        ),
    };
    format!("<emitter type=\"{plugin}\">\n{inside}</emitter>\n")
}

/// The XML of a piece; its mesh goes to a file.
fn shape(
    piece: &Piece,
    name: &str,
    number: usize,
    meshes: &mut Vec<(String, Vec<u8>)>,
) -> Result<String, ExportError> {
    let [red, green, blue] = piece.material.color.to_array();
    let material = format!(
        "    <bsdf type=\"twosided\"><bsdf type=\"diffuse\">\n        \
             <rgb name=\"reflectance\" value=\"{red:?}, {green:?}, {blue:?}\"/>\n    </bsdf></bsdf>\n"
    );
    let (plugin, inside) = match &piece.form {
        Form::Sphere(Sphere { center: c, radius }) => (
            "sphere",
            format!(
                "    <point name=\"center\" x=\"{:?}\" y=\"{:?}\" z=\"{:?}\"/>\n    \
                     <float name=\"radius\" value=\"{radius:?}\"/>\n",
                c.x, c.y, c.z
            ),
        ),
        Form::Triangles(mesh, triangles) => {
            let corners = Corners::of(mesh, triangles);
            let is_smooth = corners.normals.is_some();
            let mesh = corners.mesh();
            let mut bytes = Vec::new();
            let (plugin, flat) = if is_smooth {
                obj::write(&mesh, &mut bytes)?;
                ("obj", "")
            } else {
                ply::write(&mesh, &mut bytes)?;
                ("ply", "    <boolean name=\"face_normals\" value=\"true\"/>\n")
            };
            let file = format!("{name}-{number}.{plugin}");
            let inside = format!("    <string name=\"filename\" value=\"{file}\"/>\n{flat}");
            meshes.push((file, bytes));
            (plugin, inside)
        }
    };
    Ok(format!("<shape type=\"{plugin}\">\n{inside}{material}</shape>\n"))
}
