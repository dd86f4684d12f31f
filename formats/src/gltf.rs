//! Reads the scene of a glTF 2.0 file, `.gltf` or `.glb`, as meshes and instances, with its cameras.
//!
//! # What is read
//!
//! The reader takes the part of the format that describes triangles (Khronos, "glTF 2.0 Specification", 2021), and is strict
//! about it:
//!
//! - The nodes of the default scene (or of the first, or all nodes if there is no scene), each with its transformation: all are
//!   composed in `f64`, and each vertex is rounded to `f32` once. Nodes come in the order of the file, children behind their
//!   parent, and a mesh that several nodes name is there several times: the order of the triangles is the order of ids.
//! - Where a node states `EXT_mesh_gpu_instancing` (Khronos, 2022), its mesh is there once for each instance, in the order of the
//!   accessors, as if the node had children with these transformations: at most 2²⁴ in all. Attributes of an application's own
//!   are not read.
//! - A large mesh that is there several times is stored once: nodes in a row become [`Instances`](bothways_common::scene::Instances)
//!   of it, 48 bytes for each place, with the numbers of their maps rounded to `f32`. [`read_as_one`] copies all of them instead.
//! - `POSITION`, `NORMAL`, `COLOR_0` and the texture coordinates of the base colour of primitives of triangles, strips and fans; also sparse, and as integers
//!   (`KHR_mesh_quantization`). Points and lines are skipped.
//! - The base colour of materials: its factor, its texture with the sampler's filters and ways to wrap, and the colours of vertices,
//!   all multiplied; `KHR_texture_transform` moves its coordinates. A material of `KHR_materials_pbrSpecularGlossiness` has its diffuse
//!   colour and texture instead, which are black for metals: its specular colour is not read. Opacity is not read. Pictures (PNG or JPEG) are in views, in `data:` URIs, or in files; a warning names
//!   those that are missing.
//! - Cameras, by name.
//!
//! Animations, skins and morph targets are not read: the mesh rests as it lies in the file, where its node is. Materials that are
//! not to be shaded (`KHR_materials_unlit`) are shaded. Warnings say so of skins, of morph targets with a weight, of such
//! materials, and of textures at coordinates that a primitive lacks. A file that requires any other extension is refused.
//!
//! # The rules for accessors
//!
//! Every accessor is checked before anything is read from it. These rules of the specification, 3.6.2 and 3.7.2.1, are kept; a
//! file that breaks one is refused, and the message names the accessor, or its view:
//!
//! | What | Rule |
//! |---|---|
//! | Type | `VEC3` for `POSITION` and `NORMAL`, `VEC2` for texture coordinates, `VEC3` or `VEC4` for `COLOR_0`, `SCALAR` for indices; for instances `VEC3` for `TRANSLATION` and `SCALE`, `VEC4` for `ROTATION` |
//! | Components | floats; for texture coordinates and colours normalized unsigned bytes or shorts as well; what `KHR_mesh_quantization` adds, if the file uses it; for indices unsigned bytes, shorts or ints; for `ROTATION` of instances normalized bytes or shorts as well |
//! | `normalized` | for bytes and shorts of attributes alone: neither floats nor indices are normalized |
//! | `count` | at least 1, and the same for all attributes of a primitive, and for all lists of a node's instances |
//! | `byteOffset` | in the view and in the buffer a multiple of the size of a component; for attributes in the view also of 4 |
//! | `byteStride` | a multiple of 4 from 4 to 252, no less than an element; for attributes only. Without it elements of attributes have a multiple of 4 bytes |
//! | End | `byteOffset + byteStride × (count − 1)` and one element more are in the view, the view in its buffer, and the buffer in its data |
//! | `min`, `max` | if there, a number for each component |
//! | Numbers | floats are finite; an index names a vertex, and is not the largest number of its type |
//! | Sparse | from 1 to `count` elements are replaced; their indices are unsigned, rise strictly and are below `count`; both views have no stride, both offsets are multiples of the size of a component, and both lists are in their views |
//!
//! What nothing is drawn by is not asked for. `POSITION` must state `min` and `max`, and both must be those of the data; files
//! without them, or with wrong ones, are read, and drawn as their data says. The same holds of a view's `target`, and of a view
//! without a stride that several accessors share. An accessor with neither a view nor sparse elements would be all zeros, and is refused.
//!
//! Buffers are in the file, in `data:` URIs, or in files that the file names: see [`source::files`](crate::source::files).
//! Nothing is fetched.

mod accessor;
mod buffers;
mod camera;
mod container;
mod error;
mod item;
mod mesh;
mod nodes;
mod places;
mod shapes;
mod texture;
mod undrawn;

pub use camera::GltfCamera;
pub use error::{GltfFault, ReadGltfError};

use crate::source::{Files, InputFile};
use crate::warning::MaterialWarning;
use ::gltf::json::Root;
use bothways_common::scene::{Mesh, Shape};
use buffers::Buffers;
use item::{INSTANCING, Located, QUANTIZATION};
use mesh::Meshes;
use std::borrow::Cow;
use texture::Textures;
use undrawn::Undrawn;

/// The scene of a glTF file.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Meshes, and instances of meshes, where the nodes put them, in the order of ids.
    pub shapes: Vec<Shape>,
    /// The cameras, in the order of the nodes that hold them.
    pub cameras: Vec<GltfCamera>,
    /// What of its colours and of its pose is not drawn.
    pub warnings: Vec<MaterialWarning>,
}

/// The most bytes of a file: the lengths in a binary file have 32 bits.
const MOST_BYTES: u64 = u32::MAX as u64;

/// Reads the scene of a glTF file, and of the files that it names.
///
/// # Errors
///
/// A file cannot be read, or one of the errors of [`parse`]; messages call the file by its path.
pub fn read(input: &InputFile) -> Result<Model, ReadGltfError> {
    let name = input.name();
    model(&name, &bytes(input)?, input.files(), true)
}

/// Reads the scene of a glTF file as one mesh: the mesh of each node is copied to where the node puts it.
///
/// # Errors
///
/// As for [`read`]; and at most 2²⁶ triangles, and as many vertices, are copied.
pub fn read_as_one(input: &InputFile) -> Result<(Mesh, Vec<MaterialWarning>), ReadGltfError> {
    let name = input.name();
    let Model { shapes, warnings, .. } = model(&name, &bytes(input)?, input.files(), false)?;
    let mesh = shapes.into_iter().find_map(|shape| match shape {
        Shape::Mesh(mesh) => Some(mesh),
        _ => None,
    });
    Ok((mesh.expect("what is not shared is one mesh"), warnings))
}

/// The bytes of a file.
fn bytes<'f>(input: &InputFile<'f>) -> Result<Cow<'f, [u8]>, ReadGltfError> {
    match input.beginning(MOST_BYTES + 1) {
        Err(error) => Err(ReadGltfError::Unreadable { file: input.name(), error }),
        Ok(bytes) if bytes.len() as u64 > MOST_BYTES => {
            Err(ReadGltfError::TooLarge { file: input.name() })
        }
        Ok(bytes) => Ok(bytes),
    }
}

/// Reads the scene of a glTF file from its bytes, which messages call `name`. No other file is read.
///
/// # Errors
///
/// The file is no glTF file of version 2; it names what does not exist, or breaks another rule of the format; it requires an
/// extension; it has no triangles, or too many.
///
/// ```
/// use bothways_formats::common::scene::Shape;
/// use bothways_formats::gltf;
///
/// // Three points as nine floats, in base 64.
/// let json = r#"{ "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }],
///     "nodes": [{ "mesh": 0, "translation": [0, 0, 5] }],
///     "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
///     "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
///                     "min": [0, 0, 0], "max": [1, 1, 0] }],
///     "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
///     "buffers": [{ "byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" }] }"#;
/// let model = gltf::parse("a.gltf", json.as_bytes())?;
/// let [Shape::Mesh(mesh)] = &model.shapes[..] else { panic!("it is one mesh") };
/// assert_eq!(mesh.corners(0)[1].to_array(), [1.0, 0.0, 5.0]);
///
/// let error = gltf::parse("a.gltf", json.replace("\"count\": 3", "\"count\": 6").as_bytes()).unwrap_err();
/// let says = "a.gltf: mesh 0, primitive 0, accessor 0: its 6 elements end at byte 72, but its view has 36 bytes";
/// assert_eq!(error.to_string(), says);
/// # Ok::<(), gltf::ReadGltfError>(())
/// ```
pub fn parse(name: &str, bytes: &[u8]) -> Result<Model, ReadGltfError> {
    model(name, bytes, &Files::none(), true)
}

/// Tells whether bytes are the beginning of a binary glTF file.
pub(crate) fn is_binary(beginning: &[u8]) -> bool {
    beginning.starts_with(container::MAGIC)
}

fn model(file: &str, bytes: &[u8], files: &Files, sharing: bool) -> Result<Model, ReadGltfError> {
    read_model(file, bytes, files, sharing).map_err(|(place, fault)| ReadGltfError::Wrong {
        file: file.to_owned(),
        place,
        fault: Box::new(fault),
    })
}

fn read_model(file: &str, bytes: &[u8], files: &Files, sharing: bool) -> Result<Model, Located> {
    let whole = |fault| (String::new(), fault);
    let container = container::split(bytes).map_err(whole)?;
    let root = container::root(container.json).map_err(whole)?;
    check_version(&root).map_err(whole)?;
    let buffers = Buffers::read(&root, container.bin, files)?;
    let placed = nodes::placed(&root)?;
    let cameras = camera::cameras(&root, &placed)?;
    let places = places::places(&root, &buffers, &placed)?;
    let textures = Textures::new(&root, &buffers, files);
    let mut meshes = Meshes::new(&root, &buffers, textures, Undrawn::of_nodes(&root, &places));
    let shapes = shapes::shapes(&root, &mut meshes, &places, sharing)?;
    let warnings = meshes.textures.warnings(file).chain(meshes.undrawn.warnings(file)).collect();
    Ok(Model { shapes, cameras, warnings })
}

/// Makes sure that the file is of a version that is read, and requires no extension that is not.
fn check_version(root: &Root) -> Result<(), GltfFault> {
    let is_2 = |version: &str| version == "2" || version.starts_with("2.");
    let least = root.asset.min_version.as_deref();
    if !is_2(&root.asset.version) || least.is_some_and(|least| least != "2.0") {
        let text = least.unwrap_or(&root.asset.version).to_owned();
        return Err(GltfFault::Version { text });
    }
    match root.extensions_required.iter().find(|name| !READ_EXTENSIONS.contains(&name.as_str())) {
        Some(name) => Err(GltfFault::Extension { name: name.clone() }),
        None => Ok(()),
    }
}

/// The extensions that a file may require.
const READ_EXTENSIONS: [&str; 5] = [
    QUANTIZATION,
    INSTANCING,
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_texture_transform",
];

#[cfg(test)]
mod tests;
