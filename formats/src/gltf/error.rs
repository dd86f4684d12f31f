//! Errors about glTF files: each names the file, the object of the file, and the fault.

use crate::picture::ReadTextureError;
use crate::source::quote::quoted;
use crate::source::{FindFileError, Unreadable};
use std::io;

/// Why a glTF file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadGltfError {
    /// The file does not exist, is a folder or a pipe, or the system reports another error.
    #[error("{file}: {}", Unreadable::new(.error, "a glTF file"))]
    Unreadable {
        /// The file.
        file: String,
        /// The system's error. The message contains it, so it is not a [source](std::error::Error::source) as well.
        error: io::Error,
    },
    /// The file is larger than a binary file can be.
    #[error("{file}: a glTF file of more than 4 GiB cannot be read; split it")]
    TooLarge {
        /// The file.
        file: String,
    },
    /// Something in the file is wrong.
    #[error("{file}: {place}{}{fault}", if .place.is_empty() { "" } else { ": " })]
    Wrong {
        /// The file.
        file: String,
        /// What is wrong, such as `accessor 3`, counted from 0 as in the format; empty if it is the file itself.
        place: String,
        /// What is wrong with it.
        fault: Box<GltfFault>,
    },
}

/// What is wrong with a glTF file.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the messages explain the fields")]
pub enum GltfFault {
    #[error("the file is empty")]
    Empty,
    #[error("this is no glTF file: it begins neither with \"glTF\" nor with JSON")]
    NotGltf,
    #[error("a binary glTF file of version {version} is not read, only of version 2")]
    ContainerVersion { version: u32 },
    #[error(
        "it should have {stated} bytes, but has {found}; {}",
        if .found < .stated { "is it truncated?" } else { "is the length in its header wrong?" }
    )]
    ContainerLength { stated: u64, found: u64 },
    #[error("its first chunk is no JSON, or no chunk at all")]
    NoJson,
    #[error("a chunk of {stated} bytes begins where only {found} are left")]
    ChunkLength { stated: u64, found: u64 },
    #[error("its JSON has more than {most} {what}; split the scene up")]
    TooMuchJson { most: usize, what: &'static str },
    #[error("its JSON is not that of a glTF file: {}", quoted_long(.message))]
    Json { message: String },
    #[error("it is of version {}, and only 2.0 is read", quoted(.text))]
    Version { text: String },
    #[error(
        "it requires the extension {}, which is not supported; export it without (without compression, for example)",
        quoted(.name)
    )]
    Extension { name: String },
    #[error("it names {what} {index}, counted from 0, but there {}", Exist(*.count))]
    Unknown { what: &'static str, index: usize, count: usize },
    #[error("it is reached twice: by a circle of nodes, or from two parents")]
    ReachedTwice,
    #[error("its transformation has a number that is not finite")]
    TransformNotFinite,
    #[error("it has a matrix, and translation, rotation or scale as well; one excludes the other")]
    TwoTransforms,
    #[error("it moves vertex {vertex} of its mesh where no f32 number reaches")]
    OutOfRange { vertex: usize },
    #[error("it moves its mesh where no f32 number reaches")]
    InstanceOutOfRange,
    #[error("its EXT_mesh_gpu_instancing must state attributes, each by the number of an accessor")]
    InstanceAttributes,
    #[error("its EXT_mesh_gpu_instancing names none of TRANSLATION, ROTATION and SCALE")]
    NoInstances,
    #[error(
        "its EXT_mesh_gpu_instancing has {count} elements of {attribute}, but {other_count} of {other}"
    )]
    InstanceCount { attribute: &'static str, count: usize, other: &'static str, other_count: usize },
    #[error("with it, the scene has {count} instances of meshes; at most {most} are read")]
    TooManyInstances { count: usize, most: usize },
    #[error("it has no uri, and the file has no binary part that would be meant")]
    NoData,
    #[error("the URI {} cannot be read; {help}", quoted(.uri))]
    Uri { uri: String, help: &'static str },
    #[error(transparent)]
    NamedFile { error: FindFileError },
    #[error("{}: {}", quoted(.name), Unreadable::new(.error, "the data of a buffer"))]
    BufferFile { name: String, error: io::Error },
    #[error("it should have {stated} bytes, but its data has {found}")]
    BufferLength { stated: u64, found: u64 },
    #[error("it ends at byte {end} of its buffer, which has {length} bytes")]
    ViewTooLong { end: u128, length: u64 },
    #[error("it has a stride of {stride} bytes; a stride is a multiple of 4 from 4 to 252")]
    Stride { stride: usize },
    #[error("it has a stride of {stride} bytes, but its elements have {size}")]
    StrideTooShort { stride: usize, size: usize },
    #[error("its view has a stride, which is for attributes of vertices only")]
    StrideNotAllowed,
    #[error("it has no elements")]
    NoElements,
    #[error("its {count} elements end at byte {end}, but its view has {length} bytes")]
    AccessorTooLong { count: u64, end: u128, length: u64 },
    #[error("it begins at byte {offset} of its {of}, which is no multiple of {alignment}")]
    Unaligned { offset: u64, of: &'static str, alignment: u64 },
    #[error("its elements follow one another every {bytes} bytes, which is no multiple of 4")]
    UnalignedElements { bytes: usize },
    #[error("it has no view, so its {count} elements would all be 0")]
    NoView { count: u64 },
    #[error("its {what} must be {expected}, not {found}")]
    Type { what: &'static str, expected: &'static str, found: String },
    #[error("{what} is not known to the format")]
    Invalid { what: &'static str },
    #[error(
        "its {bound} must be a list of numbers, as many as its elements have components, which is {components}"
    )]
    Bounds { bound: &'static str, components: usize },
    #[error("number {number}, counted from 0, is not finite")]
    NotFinite { number: usize },
    #[error("it replaces {count} of {of} elements")]
    SparseCount { count: u64, of: u64 },
    #[error("it replaces element {index}{}; they must rise, and there are {count}", behind(*.before))]
    SparseIndices { index: u32, before: Option<u32>, count: u64 },
    #[error("index {place}, counted from 0, names vertex {index}, but there {}", Exist(*.count))]
    UnknownVertex { place: usize, index: u32, count: usize },
    #[error(
        "index {place}, counted from 0, is {index}: the largest number of its type begins a new primitive, and names no vertex"
    )]
    RestartIndex { place: usize, index: u32 },
    #[error("it has {count} corners, and {mode} need {need}")]
    CornerCount { count: usize, mode: &'static str, need: &'static str },
    #[error("it has no POSITION")]
    NoPositions,
    #[error("its attribute {attribute} has {count} elements for {positions} vertices")]
    AttributeCount { attribute: &'static str, count: u64, positions: u64 },
    #[error(
        "the KHR_texture_transform of its texture moves coordinates where no f32 number reaches"
    )]
    TextureTransform,
    #[error("image {image}: {error}")]
    Picture { image: usize, error: ReadTextureError },
    #[error("image {image} has neither a uri nor a view")]
    NoImage { image: usize },
    #[error("its base colour has a component that is not from 0 to 1")]
    Color,
    #[error("its {what} is {value}; it must be {range}")]
    Camera { what: &'static str, value: f32, range: &'static str },
    #[error(
        "its scene has {count} {what}, each mesh counted where it is copied; at most {most} are read"
    )]
    TooMany { count: u64, what: &'static str, most: u64 },
    #[error("its scene has no triangles, so nothing to draw")]
    NoTriangles,
}

/// Names the element before another, if there is one.
fn behind(before: Option<u32>) -> String {
    before.map_or(String::new(), |before| format!(" behind element {before}"))
}

/// A message of a library, shortened if it is long.
fn quoted_long(message: &str) -> String {
    /// No message of the JSON parser is longer, unless it quotes the file.
    const MOST: usize = 160;
    let some: String = message.chars().take(MOST).collect();
    crate::source::quote::visible(&some).into_owned()
}

/// Displays "are only 8", with the right grammar for any number.
struct Exist(usize);

impl std::fmt::Display for Exist {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            0 => f.write_str("is none"),
            1 => f.write_str("is only 1"),
            count => write!(f, "are only {count}"),
        }
    }
}
