//! A scene as binary glTF 2.0 (Khronos Group, "glTF 2.0 Specification", 2021): a node for each object and for each instance,
//! and the camera.
//!
//! The parts of a mesh of different materials are primitives of one mesh, in the order of their triangles: whoever counts
//! triangles in the order of nodes and primitives has our ids.

mod nodes;

use super::corners::Corners;
use super::error::ExportError;
use super::instances::{Place, places};
use super::pictures::Pictures;
use super::pieces::{Form, Piece, Pieces, box_corners};
use super::target::Target;
use crate::common::glam::{DMat3, DQuat, Vec3};
use crate::common::scene::{Filter, Levels, Sampler, Texture, Wrap};
use crate::common::{Mesh, Plane, Projection, Shape, Sphere, Triangle, View};
use nodes::Node;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::ops::Range;

pub(super) fn binary(
    view: &View,
    pieces: &Pieces,
    notes: &mut Vec<String>,
) -> Result<Vec<u8>, ExportError> {
    notes.push("lights and the background are left out".into());
    let mut file = File::default();
    let mut nodes: Vec<Node> = Vec::new();
    let mut roots = Vec::new();
    for group in pieces.all.chunk_by(|one, other| one.object == other.object) {
        roots.push(nodes.len());
        file.add_object(group, &mut nodes);
    }
    let (camera, node) = camera(view, notes);
    roots.push(nodes.len());
    nodes.push(node);
    file.add_images();
    let root = Root {
        asset: json!({ "version": "2.0", "generator": concat!("bothways ", env!("CARGO_PKG_VERSION")) }),
        scene: 0,
        scenes: [json!({ "nodes": roots })],
        nodes: &nodes,
        cameras: [camera],
        meshes: &file.meshes,
        materials: &file.materials,
        textures: &file.textures,
        samplers: &file.samplers,
        images: &file.images,
        accessors: &file.accessors,
        buffer_views: &file.views,
        buffers: [json!({ "byteLength": file.bytes.len() })],
    };
    let text = serde_json::to_vec(&root).expect("plain values become JSON");
    container(text, &file.bytes)
}

/// The text of a file. Lists without items are not allowed.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Root<'a> {
    asset: Value,
    scene: usize,
    scenes: [Value; 1],
    nodes: &'a [Node],
    cameras: [Value; 1],
    meshes: &'a [Value],
    materials: &'a [Value],
    #[serde(skip_serializing_if = "<[Value]>::is_empty")]
    textures: &'a [Value],
    #[serde(skip_serializing_if = "<[Value]>::is_empty")]
    samplers: &'a [Value],
    #[serde(skip_serializing_if = "<[Value]>::is_empty")]
    images: &'a [Value],
    accessors: &'a [Value],
    buffer_views: &'a [Value],
    buffers: [Value; 1],
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
fn container(mut text: Vec<u8>, bytes: &[u8]) -> Result<Vec<u8>, ExportError> {
    text.resize(text.len().next_multiple_of(4), b' ');
    let rest = bytes.len().next_multiple_of(4) - bytes.len();
    let bytes = [bytes, &[0; 3][..rest]];
    let length = 12 + 8 + text.len() + 8 + bytes[0].len() + rest;
    let size = |length: usize| {
        let too_long =
            || std::io::Error::other("binary glTF files have less than 4 GiB; export as PLY");
        u32::try_from(length).map(u32::to_le_bytes).map_err(|_| too_long())
    };
    let mut out = Vec::with_capacity(length);
    out.extend(b"glTF");
    out.extend(2_u32.to_le_bytes());
    out.extend(size(length)?);
    for (kind, chunk) in [(b"JSON", [&text[..], &[]]), (b"BIN\0", bytes)] {
        out.extend(size(chunk[0].len() + chunk[1].len())?);
        out.extend(kind);
        out.extend_from_slice(chunk[0]);
        out.extend_from_slice(chunk[1]);
    }
    Ok(out)
}

/// The file's tables.
#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    meshes: Vec<Value>,
    /// The meshes of instances, by where they are in memory and by the materials of their primitives.
    shared: HashMap<(*const Mesh, Vec<usize>), usize>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Value>,
    textures: Vec<Value>,
    samplers: Vec<Value>,
    images: Vec<Value>,
    pictures: Pictures,
}

impl File {
    /// Adds the node of an object, and behind it those of its instances.
    fn add_object(&mut self, pieces: &[Piece], nodes: &mut Vec<Node>) {
        let name = Some(format!("object {}", pieces[0].object));
        let Some(instances) = pieces[0].instances else {
            let mesh = Some(self.mesh(pieces, None));
            return nodes.push(Node { name, mesh, ..Node::default() });
        };
        let parent = nodes.len();
        nodes.push(Node { name, ..Node::default() });
        for place in places(Target::Gltf, instances) {
            nodes.push(match place {
                Place::Shared(placement) => Node::placed(self.shared_mesh(pieces), placement),
                Place::Copied(mesh) => {
                    let mesh = Some(self.mesh(pieces, Some(&mesh)));
                    Node { mesh, ..Node::default() }
                }
            });
        }
        nodes[parent].children = (parent + 1..nodes.len()).collect();
    }

    /// The number of a mesh of these pieces, written once for all instances of all objects.
    fn shared_mesh(&mut self, pieces: &[Piece]) -> usize {
        let Form::Triangles(mesh, _) = &pieces[0].form else { return self.mesh(pieces, None) };
        let mesh: *const Mesh = &raw const **mesh;
        let materials = pieces.iter().map(|piece| self.material(piece)).collect();
        let key = (mesh, materials);
        if let Some(known) = self.shared.get(&key) {
            return *known;
        }
        let number = self.mesh(pieces, None);
        self.shared.insert(key, number);
        number
    }

    /// The number of a new mesh of these pieces, or with these triangles in place of theirs.
    fn mesh(&mut self, pieces: &[Piece], copy: Option<&Mesh>) -> usize {
        let mut primitives = Vec::new();
        for piece in pieces {
            let Form::Triangles(mesh, triangles) = &piece.form else { continue };
            primitives.push(self.primitive(piece, copy.unwrap_or(mesh), triangles));
        }
        self.meshes.push(json!({ "primitives": primitives }));
        self.meshes.len() - 1
    }

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
        let material = self.material(piece);
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
    fn material(&mut self, piece: &Piece) -> usize {
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
        if let Some(texture) = material.texture.as_ref().filter(|_| piece.has_coordinates()) {
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
fn camera(view: &View, notes: &mut Vec<String>) -> (Value, Node) {
    let camera = view.camera;
    let [vw, vh] = camera.viewport();
    let [width, height] = camera.image().map(f64::from);
    if ((vw * height) / (vh * width) - 1.0).abs() > 1e-6 {
        notes.push(
            "glTF's images have square pixels: there the picture is as wide as the viewport says"
                .into(),
        );
    }
    let described = match camera.projection() {
        Projection::Perspective => json!({
            "type": "perspective",
            "perspective": {
                "aspectRatio": vw / vh,
                "yfov": 2.0 * (vh / 2.0).atan2(camera.distance()),
                "znear": camera.distance() * 1e-3,
            },
        }),
        // It needs a near plane, and for parallel cameras a far one; neither may cut anything.
        Projection::Parallel => json!({
            "type": "orthographic",
            "orthographic": { "xmag": vw / 2.0, "ymag": vh / 2.0, "znear": 0.0, "zfar": 2.0 * reach(view) },
        }),
    };
    let turn = DQuat::from_mat3(&DMat3::from_cols(camera.u(), camera.v(), camera.w())).normalize();
    let node = Node {
        name: Some("camera".into()),
        camera: Some(0),
        translation: Some(camera.eye().as_dvec3().to_array()),
        rotation: Some(turn.to_array()),
        ..Node::default()
    };
    (described, node)
}

/// How far anything reaches from the eye, at least 1; a plane counts with its point.
fn reach(view: &View) -> f64 {
    let eye = view.camera.eye().as_dvec3();
    let from_eye = |point: Vec3| (point.as_dvec3() - eye).length();
    let farthest =
        |points: &mut dyn Iterator<Item = Vec3>| points.map(from_eye).fold(0.0, f64::max);
    let of_shape = |shape: &Shape| match shape {
        Shape::Triangle(Triangle { a, b, c }) => farthest(&mut [*a, *b, *c].into_iter()),
        Shape::Mesh(mesh) => farthest(&mut mesh.positions().iter().copied()),
        Shape::Instances(instances) => farthest(&mut box_corners(instances)),
        Shape::Sphere(Sphere { center, radius }) => from_eye(*center) + f64::from(*radius),
        Shape::Plane(Plane { point, .. }) => 10.0 * from_eye(*point),
    };
    view.scene.objects().iter().map(|object| of_shape(&object.shape)).fold(1.0, f64::max)
}
