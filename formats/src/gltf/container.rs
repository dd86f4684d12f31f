//! The parts of a glTF file: its JSON, and in a binary file what follows it.

use super::error::GltfFault;
use crate::source::without_mark;
use ::gltf::json::{Root, deserialize};

/// The beginning of a binary file.
pub(super) const MAGIC: &[u8] = b"glTF";

/// The parts of a file.
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    /// The binary part, if there is one.
    pub(super) bin: Option<&'a [u8]>,
}

/// Splits a file into its parts.
pub(super) fn split(bytes: &[u8]) -> Result<Container<'_>, GltfFault> {
    if !bytes.starts_with(MAGIC) {
        let json = without_mark(bytes);
        return match json.trim_ascii_start().first() {
            Some(b'{') => Ok(Container { json, bin: None }),
            Some(_) => Err(GltfFault::NotGltf),
            None => Err(GltfFault::Empty),
        };
    }
    let found = bytes.len() as u64;
    let number = |at| number(bytes, at).ok_or(GltfFault::ContainerLength { stated: 12, found });
    let (version, stated) = (number(4)?, u64::from(number(8)?));
    if version != 2 {
        return Err(GltfFault::ContainerVersion { version });
    }
    let content = usize::try_from(stated).ok().and_then(|end| bytes.get(12..end));
    let content = content.ok_or(GltfFault::ContainerLength { stated, found })?;
    let Some((b"JSON", json, rest)) = chunk(content)? else { return Err(GltfFault::NoJson) };
    // Only the second chunk can be the binary one. Chunks of other kinds are for extensions.
    let bin = match chunk(rest)? {
        Some((b"BIN\0", bin, _)) => Some(bin),
        _ => None,
    };
    Ok(Container { json, bin })
}

/// The kind, the content, and what follows.
type Chunk<'a> = (&'a [u8; 4], &'a [u8], &'a [u8]);

/// The first chunk; `None` if too few bytes are left for one.
fn chunk(bytes: &[u8]) -> Result<Option<Chunk<'_>>, GltfFault> {
    let (Some(length), Some(kind)) = (number(bytes, 0), bytes.get(4..8)) else { return Ok(None) };
    let rest = &bytes[8..];
    let (stated, found) = (u64::from(length), rest.len() as u64);
    let content = rest.split_at_checked(length as usize);
    let (content, rest) = content.ok_or(GltfFault::ChunkLength { stated, found })?;
    Ok(kind.first_chunk().map(|kind| (kind, content, rest)))
}

fn number(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?))
}

/// The most objects in the JSON, the most names in them, and the most items of lists and objects. In memory an object takes up
/// to 1 KB, and of extensions, which are kept, a name takes 160 bytes and an item up to 32, whatever they take in the file:
/// together less than 3 GiB.
const MOST_OBJECTS: usize = 1 << 20;
const MOST_NAMES: usize = 1 << 23;
const MOST_ITEMS: usize = 1 << 24;

/// Parses the JSON. Nothing that it says has been checked.
pub(super) fn root(json: &[u8]) -> Result<Root, GltfFault> {
    let limits =
        [(b'{', MOST_OBJECTS, "objects"), (b':', MOST_NAMES, "names"), (b',', MOST_ITEMS, "items")];
    for (byte, most, what) in limits {
        if memchr::memchr_iter(byte, json).count() > most {
            return Err(GltfFault::TooMuchJson { most, what });
        }
    }
    deserialize::from_slice(json).map_err(|error| GltfFault::Json { message: error.to_string() })
}
