//! A scene as binary glTF 2.0 (Khronos Group, "glTF 2.0 Specification", 2021): a node for each object, and the camera.
//!
//! The parts of a mesh of different materials are primitives of one mesh, in the order of their triangles: whoever counts
//! triangles in the order of nodes and primitives has our ids.

use super::corners::Corners;
use super::error::ExportError;
use super::pictures::Pictures;
use super::pieces::{Form, Piece, Pieces};
use crate::common::glam::{DMat3, DQuat, Vec3};
use crate::common::scene::{Filter, Levels, Sampler, Texture, Wrap};
use crate::common::{Mesh, Primitive, Projection, View};
use serde_json::{Value, json};
use std::ops::Range;

pub(super) fn binary(
    view: &View,
    pieces: &Pieces,
    notes: &mut Vec<String>,
) -> Result<Vec<u8>, ExportError> {
    notes.push("lights and the background are left out".into());
    let mut file = File::default();
    let mut nodes: Vec<Value> = Vec::new();
    let mut meshes: Vec<Value> = Vec::new();
    for group in pieces.all.chunk_by(|one, other| one.object == other.object) {
        let mut primitives = Vec::new();
        for piece in group {
            let Form::Triangles(mesh, triangles) = &piece.form else { continue };
            primitives.push(file.primitive(piece, mesh, triangles));
        }
        nodes.push(json!({ "name": format!("object {}", group[0].object), "mesh": meshes.len() }));
        meshes.push(json!({ "primitives": primitives }));
    }
    let (camera, node) = camera(view, notes);
    nodes.push(node);
    file.add_images();
    let mut root = json!({
        "asset": { "version": "2.0", "generator": concat!("bothways ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": (0..nodes.len()).collect::<Vec<_>>() }],
        "nodes": nodes,
        "cameras": [camera],
        "meshes": meshes,
        "materials": file.materials,
        "accessors": file.accessors,
        "bufferViews": file.views,
        "buffers": [{ "byteLength": file.bytes.len() }],
    });
    // Lists without items are not allowed.
    if !file.textures.is_empty() {
        root["textures"] = json!(file.textures);
        root["samplers"] = json!(file.samplers);
        root["images"] = json!(file.images);
    }
    container(&root, file.bytes)
}

/// The numbers of the format for types of components, and for what a view holds.
const U32: u32 = 5125;
const F32: u32 = 5126;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;
/// The numbers of filters, without smaller levels and with them, and of what is beyond a picture.
const NEAREST: u32 = 9728;
const LINEAR: u32 = 9729;
const NEAREST_MIPMAP_NEAREST: u32 = 9984;
const LINEAR_MIPMAP_NEAREST: u32 = 9985;
const NEAREST_MIPMAP_LINEAR: u32 = 9986;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;
const REPEAT: u32 = 10497;
const CLAMP_TO_EDGE: u32 = 33071;
const MIRRORED_REPEAT: u32 = 33648;

/// The two chunks of a binary file.
fn container(root: &Value, mut bytes: Vec<u8>) -> Result<Vec<u8>, ExportError> {
    let mut text = serde_json::to_vec(root).expect("plain values become JSON");
    text.resize(text.len().next_multiple_of(4), b' ');
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let length = 12 + 8 + text.len() + 8 + bytes.len();
    let size = |length: usize| {
        let too_long =
            || std::io::Error::other("binary glTF files have less than 4 GiB; export as PLY");
        u32::try_from(length).map(u32::to_le_bytes).map_err(|_| too_long())
    };
    let mut out = Vec::with_capacity(length);
    out.extend(b"glTF");
    out.extend(2_u32.to_le_bytes());
    out.extend(size(length)?);
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &bytes)] {
        out.extend(size(chunk.len())?);
        out.extend(kind);
        out.extend(chunk);
    }
    Ok(out)
}

/// The file's tables.
#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Value>,
    textures: Vec<Value>,
    samplers: Vec<Value>,
    images: Vec<Value>,
    pictures: Pictures,
}

impl File {
    fn primitive(&mut self, piece: &Piece, mesh: &Mesh, triangles: &Range<usize>) -> Value {
        let corners = Corners::of(piece, mesh, triangles);
        let bounds = |pick: fn(f32, f32) -> f32| {
            let all = corners.positions.iter().copied();
            all.reduce(|one, other| [0, 1, 2].map(|axis| pick(one[axis], other[axis])))
        };
        let [least, largest] = [bounds(f32::min), bounds(f32::max)];
        let mut position = self.floats("VEC3", &corners.positions);
        position["min"] = json!(least);
        position["max"] = json!(largest);
        let mut attributes = json!({ "POSITION": self.accessor(position) });
        if let Some(normals) = &corners.normals {
            let accessor = self.floats("VEC3", normals);
            attributes["NORMAL"] = json!(self.accessor(accessor));
        }
        if let Some(coordinates) = &corners.coordinates {
            // Here v grows upwards, in glTF downwards.
            let down: Vec<[f32; 2]> = coordinates.iter().map(|[u, v]| [*u, 1.0 - v]).collect();
            let accessor = self.floats("VEC2", &down);
            attributes["TEXCOORD_0"] = json!(self.accessor(accessor));
        }
        if let Some(colors) = &corners.colors {
            let accessor = self.floats("VEC3", colors);
            attributes["COLOR_0"] = json!(self.accessor(accessor));
        }
        let bytes = corners.indices.iter().flat_map(|index| index.to_le_bytes());
        let view = self.view(Some(INDICES), bytes);
        let indices = json!({
            "bufferView": view, "componentType": U32, "count": corners.indices.len(), "type": "SCALAR",
        });
        let indices = self.accessor(indices);
        let material = self.material(piece, corners.coordinates.is_some());
        json!({ "attributes": attributes, "indices": indices, "material": material })
    }

    fn view(&mut self, target: Option<u32>, bytes: impl Iterator<Item = u8>) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - offset;
        let mut view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": length });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.views.len() - 1
    }

    fn floats<const N: usize>(&mut self, kind: &str, values: &[[f32; N]]) -> Value {
        let bytes = values.as_flattened().iter().flat_map(|value| value.to_le_bytes());
        let view = self.view(Some(VERTICES), bytes);
        json!({ "bufferView": view, "componentType": F32, "count": values.len(), "type": kind })
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// The number of a piece's material; equal ones are one.
    fn material(&mut self, piece: &Piece, has_coordinates: bool) -> usize {
        let material = piece.material;
        let [red, green, blue] = material.color.to_array();
        // Blinn and Phong's exponent n is as rough as α² = 2/(n + 2), and glTF's roughness is the root of α (Walter et
        // al., "Microfacet Models for Refraction through Rough Surfaces", 2007).
        let roughness = match material.specular > 0.0 {
            true => (2.0 / (material.shininess + 2.0)).sqrt().sqrt(),
            false => 1.0,
        };
        let mut value = json!({
            "pbrMetallicRoughness": {
                "baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.0, "roughnessFactor": roughness,
            },
            "doubleSided": true,
        });
        if let Some(texture) = material.texture.as_ref().filter(|_| has_coordinates) {
            value["pbrMetallicRoughness"]["baseColorTexture"] =
                json!({ "index": self.texture(texture) });
        }
        place(&mut self.materials, value)
    }

    fn texture(&mut self, texture: &Texture) -> usize {
        // The format multiplies a picture by the material's colour.
        let image = self.pictures.place(&texture.pyramid, Vec3::ONE);
        let sampler = place(&mut self.samplers, sampler(&texture.sampler));
        place(&mut self.textures, json!({ "source": image, "sampler": sampler }))
    }

    /// Puts the pictures behind all else.
    fn add_images(&mut self) {
        for file in std::mem::take(&mut self.pictures).files() {
            // A view begins where four bytes do, as accessors must.
            self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
            let view = self.view(None, file.into_iter());
            self.images.push(json!({ "bufferView": view, "mimeType": "image/png" }));
        }
    }
}

/// The number of a value in a list, to which it is added if it is not there yet.
fn place(list: &mut Vec<Value>, value: Value) -> usize {
    let known = list.iter().position(|one| *one == value);
    known.unwrap_or_else(|| {
        list.push(value);
        list.len() - 1
    })
}

fn sampler(sampler: &Sampler) -> Value {
    let magnified = match sampler.magnified {
        Filter::Nearest => NEAREST,
        Filter::Bilinear => LINEAR,
    };
    let minified = match (sampler.minified, sampler.levels) {
        (Filter::Nearest, Levels::One) => NEAREST,
        (Filter::Bilinear, Levels::One) => LINEAR,
        (Filter::Nearest, Levels::Nearest) => NEAREST_MIPMAP_NEAREST,
        (Filter::Bilinear, Levels::Nearest) => LINEAR_MIPMAP_NEAREST,
        (Filter::Nearest, Levels::Blended) => NEAREST_MIPMAP_LINEAR,
        (Filter::Bilinear, Levels::Blended) => LINEAR_MIPMAP_LINEAR,
    };
    let [across, up] = sampler.wrap.map(|wrap| match wrap {
        Wrap::Repeat => REPEAT,
        Wrap::Clamp => CLAMP_TO_EDGE,
        Wrap::Mirror => MIRRORED_REPEAT,
    });
    json!({ "magFilter": magnified, "minFilter": minified, "wrapS": across, "wrapT": up })
}

/// The camera, and its node. glTF's cameras look along −z with y up, as ours do.
fn camera(view: &View, notes: &mut Vec<String>) -> (Value, Value) {
    let camera = view.camera;
    let [vw, vh] = camera.viewport();
    let [width, height] = camera.image().map(f64::from);
    if ((vw * height) / (vh * width) - 1.0).abs() > 1e-6 {
        notes.push(
            "glTF's images have square pixels: there the picture is as wide as the viewport says"
                .into(),
        );
    }
    // glTF needs a near plane, and for parallel cameras a far one; neither may cut anything.
    let reach =
        view.primitives().fold(1.0_f64, |reach, (_, primitive)| reach.max(farthest(&primitive)));
    let described = match camera.projection() {
        Projection::Perspective => json!({
            "type": "perspective",
            "perspective": {
                "aspectRatio": vw / vh,
                "yfov": 2.0 * (vh / 2.0).atan2(camera.distance()),
                "znear": camera.distance() * 1e-3,
            },
        }),
        Projection::Parallel => json!({
            "type": "orthographic",
            "orthographic": { "xmag": vw / 2.0, "ymag": vh / 2.0, "znear": 0.0, "zfar": 2.0 * reach },
        }),
    };
    let turn = DQuat::from_mat3(&DMat3::from_cols(camera.u(), camera.v(), camera.w())).normalize();
    let node = json!({
        "name": "camera",
        "camera": 0,
        "translation": camera.eye().to_array(),
        "rotation": turn.to_array(),
    });
    (described, node)
}

/// How far a primitive reaches from the eye; a plane counts with its point.
fn farthest(primitive: &Primitive) -> f64 {
    match primitive {
        Primitive::Triangle(corners) => corners.iter().fold(0.0, |far, at| at.length().max(far)),
        Primitive::Sphere { center, radius } => center.length() + radius,
        Primitive::Plane { point, .. } => 10.0 * point.length(),
    }
}
