//! A scene for pbrt, version 4: one text.
//!
//! Colours are linear, with the primaries of sRGB, as ours are (pbrt-v4 file format, "Spectra").

use super::ExportError;
use super::corners::Corners;
use super::lights::{Physical, lights};
use super::pieces::{Form, Piece, Pieces};
use crate::common::{Mesh, Sphere, View};
use crate::exchange::{StatedDepths, System, exchange};
use std::fmt::Write as _;
use std::io::{self, Write};
use std::ops::Range;

pub(super) fn scene(
    view: &View,
    pieces: &Pieces,
    notes: &mut Vec<String>,
) -> Result<Vec<u8>, ExportError> {
    let mut out = exchange(view, System::Pbrt, StatedDepths::default())?.text().into_bytes();
    out.write_all(b"Integrator \"path\"\nSampler \"independent\" \"integer pixelsamples\" [ 64 ]\n\nWorldBegin\n")?;
    for light in lights(view, pieces, notes) {
        out.write_all(text_of(light).as_bytes())?;
    }
    for piece in &pieces.all {
        write_piece(&mut out, piece)?;
    }
    Ok(out)
}

fn text_of(light: Physical) -> String {
    match light {
        Physical::Constant { radiance } => {
            format!(
                "LightSource \"infinite\" \"rgb L\" [ {radiance:?} {radiance:?} {radiance:?} ]\n"
            )
        }
        Physical::Distant { direction: to, irradiance: e } => format!(
            "LightSource \"distant\" \"point3 from\" [ 0 0 0 ] \"point3 to\" [ {:?} {:?} {:?} ] \"rgb L\" [ {e:?} {e:?} {e:?} ]\n",
            to.x, to.y, to.z
        ),
        Physical::Point { position: at, intensity: i } => format!(
            "LightSource \"point\" \"point3 from\" [ {:?} {:?} {:?} ] \"rgb I\" [ {i:?} {i:?} {i:?} ]\n",
            at.x, at.y, at.z
        ),
    }
}

fn write_piece(out: &mut Vec<u8>, piece: &Piece) -> io::Result<()> {
    let [red, green, blue] = piece.material.color.to_array();
    writeln!(out, "\n# object {}\nAttributeBegin", piece.object)?;
    writeln!(out, "Material \"diffuse\" \"rgb reflectance\" [ {red:?} {green:?} {blue:?} ]")?;
    match &piece.form {
        Form::Sphere(Sphere { center, radius }) => {
            writeln!(out, "Translate {:?} {:?} {:?}", center.x, center.y, center.z)?;
            writeln!(out, "Shape \"sphere\" \"float radius\" [ {radius:?} ]")?;
        }
        Form::Triangles(mesh, triangles) => write_triangles(out, mesh, triangles)?,
    }
    writeln!(out, "AttributeEnd")
}

/// Vertices with all that they carry: pbrt has one index for a corner.
fn write_triangles(out: &mut Vec<u8>, mesh: &Mesh, triangles: &Range<usize>) -> io::Result<()> {
    let corners = Corners::of(mesh, triangles);
    let mut text = String::from("Shape \"trianglemesh\"\n    \"integer indices\" [");
    for (place, index) in corners.indices.iter().enumerate() {
        let between = if place % 12 == 0 { "\n       " } else { "" };
        let _ = write!(text, "{between} {index}");
    }
    text += "\n    ]\n";
    write_vectors(&mut text, "point3 P", &corners.positions);
    if let Some(normals) = &corners.normals {
        write_vectors(&mut text, "normal N", normals);
    }
    out.write_all(text.as_bytes())
}

fn write_vectors(text: &mut String, name: &str, vectors: &[[f32; 3]]) {
    let _ = writeln!(text, "    \"{name}\" [");
    for [x, y, z] in vectors {
        let _ = writeln!(text, "        {:?} {:?} {:?}", x + 0.0, y + 0.0, z + 0.0);
    }
    *text += "    ]\n";
}
