//! A scene for pbrt, version 4: one text, and a file for each picture.
//!
//! Colours are linear, with the primaries of sRGB, as ours are (pbrt-v4 file format, "Spectra").

use super::corners::Corners;
use super::error::ExportError;
use super::instances::{Place, places};
use super::lights::{Physical, lights};
use super::pictures::Pictures;
use super::pieces::{Form, Piece, Pieces};
use super::target::Target;
use crate::common::scene::{Filter, Levels, Sampler, Texture, Wrap};
use crate::common::{Instances, Mesh, Sphere, View};
use crate::exchange::{StatedDepths, System, exchange};
use std::fmt::Write as _;
use std::io::{self, Write};
use std::ops::Range;

pub(super) fn files(
    view: &View,
    pieces: &Pieces,
    name: &str,
    notes: &mut Vec<String>,
) -> Result<Vec<(String, Vec<u8>)>, ExportError> {
    let mut out = exchange(view, System::Pbrt, StatedDepths::default())?.text().into_bytes();
    out.write_all(b"Integrator \"path\"\nSampler \"independent\" \"integer pixelsamples\" [ 64 ]\n\nWorldBegin\n")?;
    for light in lights(view, pieces, notes) {
        out.write_all(text_of(light).as_bytes())?;
    }
    let mut textures = Textures::new(name);
    for group in pieces.all.chunk_by(|one, other| one.object == other.object) {
        let parts: Vec<Part> = group
            .iter()
            .map(|piece| Ok((piece, textures.write(&mut out, piece)?)))
            .collect::<io::Result<_>>()?;
        match group[0].instances {
            None => write_parts(&mut out, &parts, None)?,
            Some(instances) => write_instances(&mut out, &parts, instances)?,
        }
    }
    if textures.has_other_wraps {
        notes.push("pbrt repeats or clamps a picture in both directions: where another wrap is, it repeats".into());
    }
    let mut files = vec![(format!("{name}.{}", Target::Pbrt.ending()), out)];
    files.extend(textures.pictures.named(name));
    Ok(files)
}

/// The textures that are defined, each once.
struct Textures<'a> {
    scene: &'a str,
    known: Vec<(usize, Sampler)>,
    pictures: Pictures,
    has_other_wraps: bool,
}

impl<'a> Textures<'a> {
    fn new(scene: &'a str) -> Textures<'a> {
        let (known, pictures) = (Vec::new(), Pictures::default());
        Textures { scene, known, pictures, has_other_wraps: false }
    }

    /// The number of a piece's texture, which is defined where it is needed first.
    fn write(&mut self, out: &mut Vec<u8>, piece: &Piece) -> io::Result<Option<usize>> {
        let texture = piece.material.texture.as_ref().filter(|_| piece.has_coordinates());
        let Some(Texture { pyramid, sampler }) = texture else { return Ok(None) };
        // Nothing there multiplies a picture by a colour.
        let picture = self.pictures.place(pyramid, piece.material.color);
        // The texture coordinates are in pictures already.
        let key = (picture, Sampler { tiles: [1.0; 2], ..*sampler });
        if let Some(known) = self.known.iter().position(|one| *one == key) {
            return Ok(Some(known));
        }
        let number = self.known.len();
        self.known.push(key);
        let file = Pictures::name(self.scene, picture);
        let filter = match (sampler.magnified, sampler.levels) {
            (Filter::Nearest, Levels::One) => "point",
            (Filter::Bilinear, Levels::One) => "bilinear",
            (_, Levels::Nearest | Levels::Blended) => "trilinear",
        };
        let wrap = match sampler.wrap {
            [Wrap::Clamp, Wrap::Clamp] => "clamp",
            [Wrap::Repeat, Wrap::Repeat] => "repeat",
            _ => {
                self.has_other_wraps = true;
                "repeat"
            }
        };
        writeln!(
            out,
            "\nTexture \"texture-{number}\" \"spectrum\" \"imagemap\" \"string filename\" [ \"{file}\" ]\n    \
             \"string filter\" [ \"{filter}\" ] \"string wrap\" [ \"{wrap}\" ]"
        )?;
        Ok(Some(number))
    }
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

/// A piece, and the number of its texture.
type Part<'a> = (&'a Piece<'a>, Option<usize>);

/// A mesh by its name, and where it is: the transformation's sixteen numbers, column by column (pbrt-v4 file format,
/// "Object Instancing" and "Transformations").
fn write_instances(out: &mut Vec<u8>, parts: &[Part], instances: &Instances) -> io::Result<()> {
    let name = format!("object {}", parts[0].0.object);
    let mut is_defined = false;
    for place in places(Target::Pbrt, instances) {
        let placement = match place {
            Place::Shared(placement) => placement,
            Place::Copied(mesh) => {
                write_parts(out, parts, Some(&mesh))?;
                continue;
            }
        };
        if !is_defined {
            writeln!(out, "\nObjectBegin \"{name}\"")?;
            write_parts(out, parts, None)?;
            writeln!(out, "ObjectEnd\n")?;
            is_defined = true;
        }
        let [x, y, z] = placement.rows();
        write!(out, "AttributeBegin Transform [")?;
        for column in 0..4 {
            let last = if column == 3 { 1 } else { 0 };
            write!(out, " {:?} {:?} {:?} {last}", x[column], y[column], z[column])?;
        }
        writeln!(out, " ] ObjectInstance \"{name}\" AttributeEnd")?;
    }
    Ok(())
}

/// The pieces of an object, or of one of its instances: with these triangles in place of theirs.
fn write_parts(out: &mut Vec<u8>, parts: &[Part], copy: Option<&Mesh>) -> io::Result<()> {
    parts.iter().try_for_each(|(piece, texture)| write_piece(out, piece, *texture, copy))
}

fn write_piece(
    out: &mut Vec<u8>,
    piece: &Piece,
    texture: Option<usize>,
    copy: Option<&Mesh>,
) -> io::Result<()> {
    let [red, green, blue] = piece.material.color.to_array();
    writeln!(out, "\n# object {}\nAttributeBegin", piece.object)?;
    let reflectance = match texture {
        Some(number) => format!("\"texture reflectance\" [ \"texture-{number}\" ]"),
        None => format!("\"rgb reflectance\" [ {red:?} {green:?} {blue:?} ]"),
    };
    writeln!(out, "Material \"diffuse\" {reflectance}")?;
    match &piece.form {
        Form::Sphere(Sphere { center, radius }) => {
            writeln!(out, "Translate {:?} {:?} {:?}", center.x, center.y, center.z)?;
            writeln!(out, "Shape \"sphere\" \"float radius\" [ {radius:?} ]")?;
        }
        Form::Triangles(mesh, triangles) => {
            write_triangles(out, piece, copy.unwrap_or(mesh), triangles)?;
        }
    }
    writeln!(out, "AttributeEnd")
}

/// Vertices with all that they carry: pbrt has one index for a corner.
fn write_triangles(
    out: &mut Vec<u8>,
    piece: &Piece,
    mesh: &Mesh,
    triangles: &Range<usize>,
) -> io::Result<()> {
    let corners = Corners::of(piece, mesh, triangles);
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
    if let Some(coordinates) = &corners.coordinates {
        write_vectors(&mut text, "point2 uv", coordinates);
    }
    out.write_all(text.as_bytes())
}

fn write_vectors<const N: usize>(text: &mut String, name: &str, vectors: &[[f32; N]]) {
    let _ = writeln!(text, "    \"{name}\" [");
    for vector in vectors {
        *text += "       ";
        for value in vector {
            let _ = write!(text, " {:?}", value + 0.0);
        }
        *text += "\n";
    }
    *text += "    ]\n";
}
