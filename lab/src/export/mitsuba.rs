//! A scene for Mitsuba 3: XML, and a file for each mesh and each picture, which XML cannot hold.
//!
//! Meshes are PLY files; those without normals are flat by `face_normals` (Mitsuba 3 documentation, "Shapes"). Colours are
//! linear, with the primaries of sRGB ("Spectra"), also those of vertices.

use super::corners::Corners;
use super::error::ExportError;
use super::instances::{Place, places};
use super::lights::{Physical, lights};
use super::pictures::Pictures;
use super::pieces::{Form, Piece, Pieces};
use super::target::Target;
use crate::common::scene::{Filter, Levels, Texture, Wrap};
use crate::common::{Instances, Mesh, Sphere, View};
use crate::exchange::{StatedDepths, System, exchange};

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
    let mut beside = Beside::new(name);
    let mut number = 0;
    for group in pieces.all.chunk_by(|one, other| one.object == other.object) {
        match group[0].instances {
            None => {
                for (number, piece) in (number..).zip(group) {
                    xml += &shape(piece, &number.to_string(), None, &mut beside);
                }
            }
            Some(instances) => add_instances(&mut xml, group, number, instances, &mut beside),
        }
        number += group.len();
    }
    xml += "</scene>\n";
    notes.extend(beside.notes());
    let mut files = vec![(format!("{name}.{}", Target::Mitsuba.ending()), xml.into_bytes())];
    files.extend(beside.meshes);
    files.extend(beside.pictures.named(name));
    Ok(files)
}

/// The files that the XML names, and what was not said.
struct Beside<'a> {
    scene: &'a str,
    meshes: Vec<(String, Vec<u8>)>,
    pictures: Pictures,
    has_levels: bool,
    has_two_wraps: bool,
}

impl<'a> Beside<'a> {
    fn new(scene: &'a str) -> Beside<'a> {
        let (meshes, pictures) = (Vec::new(), Pictures::default());
        Beside { scene, meshes, pictures, has_levels: false, has_two_wraps: false }
    }

    fn notes(&self) -> impl Iterator<Item = String> + use<> {
        const LEVELS: &str = "Mitsuba reads no smaller pictures where a texel is smaller than a pixel: it takes more samples";
        const WRAPS: &str =
            "Mitsuba has one wrap for both directions: pictures have the one across them";
        let levels = self.has_levels.then_some(LEVELS);
        let wraps = self.has_two_wraps.then_some(WRAPS);
        [levels, wraps].into_iter().flatten().map(str::to_owned)
    }
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

/// A group of shapes, and where it is (Mitsuba 3 documentation, "Shape group" and "Instance").
fn add_instances(
    xml: &mut String,
    pieces: &[Piece],
    number: usize,
    instances: &Instances,
    beside: &mut Beside,
) {
    let group = format!("object-{}", pieces[0].object);
    let mut is_defined = false;
    for (instance, place) in places(Target::Mitsuba, instances).enumerate() {
        let placement = match place {
            Place::Shared(placement) => placement,
            Place::Copied(mesh) => {
                for (number, piece) in (number..).zip(pieces) {
                    *xml += &shape(piece, &format!("{number}-{instance}"), Some(&mesh), beside);
                }
                continue;
            }
        };
        if !is_defined {
            let inside: String = (number..)
                .zip(pieces)
                .map(|(number, piece)| shape(piece, &number.to_string(), None, beside))
                .collect();
            *xml += &format!("<shape type=\"shapegroup\" id=\"{group}\">\n{inside}</shape>\n");
            is_defined = true;
        }
        let numbers = placement.rows().as_flattened().iter();
        let matrix: String = numbers.map(|number| format!("{number:?} ")).collect();
        *xml += &format!(
            "<shape type=\"instance\"><ref id=\"{group}\"/><transform name=\"to_world\">\
             <matrix value=\"{matrix}0 0 0 1\"/></transform></shape>\n"
        );
    }
}

/// The XML of a piece, or of these triangles in place of its own; its mesh and its picture go to files.
fn shape(piece: &Piece, number: &str, copy: Option<&Mesh>, beside: &mut Beside) -> String {
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
            let mut corners = Corners::of(piece, copy.unwrap_or(mesh), triangles);
            corners.multiply_colors(piece.material.color);
            let flat = match corners.normals {
                Some(_) => "",
                None => "    <boolean name=\"face_normals\" value=\"true\"/>\n",
            };
            let file = format!("{}-{number}.ply", beside.scene);
            let inside = format!("    <string name=\"filename\" value=\"{file}\"/>\n{flat}");
            beside.meshes.push((file, ply(&corners)));
            ("ply", inside)
        }
    };
    let reflectance = reflectance(piece, beside);
    format!(
        "<shape type=\"{plugin}\">\n{inside}    \
             <bsdf type=\"twosided\"><bsdf type=\"diffuse\">\n{reflectance}    </bsdf></bsdf>\n</shape>\n"
    )
}

/// A picture, the colours of the vertices, or one colour.
fn reflectance(piece: &Piece, beside: &mut Beside) -> String {
    let color = piece.material.color;
    if let Some(Texture { pyramid, sampler }) =
        piece.material.texture.as_ref().filter(|_| piece.has_coordinates())
    {
        // Nothing there multiplies a picture by a colour.
        let file = Pictures::name(beside.scene, beside.pictures.place(pyramid, color));
        let filter = match sampler.magnified {
            Filter::Nearest => "nearest",
            Filter::Bilinear => "bilinear",
        };
        let wrap = match sampler.wrap[0] {
            Wrap::Repeat => "repeat",
            Wrap::Clamp => "clamp",
            Wrap::Mirror => "mirror",
        };
        beside.has_levels |= sampler.levels != Levels::One;
        beside.has_two_wraps |= sampler.wrap[0] != sampler.wrap[1];
        return format!(
            "        <texture type=\"bitmap\" name=\"reflectance\">\n            \
                 <string name=\"filename\" value=\"{file}\"/>\n            \
                 <string name=\"filter_type\" value=\"{filter}\"/>\n            \
                 <string name=\"wrap_mode\" value=\"{wrap}\"/>\n        </texture>\n"
        );
    }
    if piece.has_colors() {
        return "        <texture type=\"mesh_attribute\" name=\"reflectance\">\n            \
                    <string name=\"name\" value=\"vertex_color\"/>\n        </texture>\n"
            .into();
    }
    let [red, green, blue] = color.to_array();
    format!("        <rgb name=\"reflectance\" value=\"{red:?}, {green:?}, {blue:?}\"/>\n")
}

/// A binary PLY file with the names that Mitsuba knows.
fn ply(corners: &Corners) -> Vec<u8> {
    // There v grows downwards in a picture.
    let down = |[u, v]: &[f32; 2]| [*u, 1.0 - v];
    let coordinates: Option<Vec<[f32; 2]>> =
        corners.coordinates.as_ref().map(|values| values.iter().map(down).collect());
    let of_three =
        |values: &'_ Option<Vec<[f32; 3]>>| values.as_ref().map(|one| one.as_flattened().to_vec());
    let columns = [
        (&["x", "y", "z"][..], Some(corners.positions.as_flattened().to_vec())),
        (&["nx", "ny", "nz"], of_three(&corners.normals)),
        (&["u", "v"], coordinates.map(|values| values.as_flattened().to_vec())),
        (&["r", "g", "b"], of_three(&corners.colors)),
    ];
    let columns: Vec<(&[&str], Vec<f32>)> =
        columns.into_iter().filter_map(|(names, values)| Some((names, values?))).collect();
    let names = columns.iter().flat_map(|(names, _)| names.iter());
    let properties: String = names.map(|name| format!("property float {name}\n")).collect();
    let (vertices, faces) = (corners.positions.len(), corners.indices.len() / 3);
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\n{properties}\
         element face {faces}\nproperty list uchar uint vertex_indices\nend_header\n"
    )
    .into_bytes();
    for vertex in 0..vertices {
        for (names, values) in &columns {
            let of_vertex = &values[names.len() * vertex..][..names.len()];
            bytes.extend(of_vertex.iter().flat_map(|value| value.to_le_bytes()));
        }
    }
    for triangle in corners.indices.as_chunks::<3>().0 {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
    }
    bytes
}
