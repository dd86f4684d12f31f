//! The header of a PLY file: the encoding of its values, and the elements and properties that follow.

use super::error::HeaderFault;
use crate::source::quote::{self, quote};
use crate::source::without_mark;
use std::io::{self, BufRead, Read};
use std::ops::Range;

/// The encoding of the values after the header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Words, with one element on each line.
    Ascii,
    /// Binary, with the least significant byte first.
    LittleEndian,
    /// Binary, with the most significant byte first.
    BigEndian,
}

/// The type of one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ScalarType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl ScalarType {
    /// The type of this name: one of the original names, or one with the number of bits.
    fn named(word: &str) -> Option<ScalarType> {
        Some(match word {
            "char" | "int8" => ScalarType::I8,
            "uchar" | "uint8" => ScalarType::U8,
            "short" | "int16" => ScalarType::I16,
            "ushort" | "uint16" => ScalarType::U16,
            "int" | "int32" => ScalarType::I32,
            "uint" | "uint32" => ScalarType::U32,
            "float" | "float32" => ScalarType::F32,
            "double" | "float64" => ScalarType::F64,
            _ => return None,
        })
    }

    /// The size of one value in a binary file, in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            ScalarType::I8 | ScalarType::U8 => 1,
            ScalarType::I16 | ScalarType::U16 => 2,
            ScalarType::I32 | ScalarType::U32 | ScalarType::F32 => 4,
            ScalarType::F64 => 8,
        }
    }

    /// What a colour is divided by to be between 0 and 1.
    pub(super) fn full_color(self) -> f32 {
        match self {
            ScalarType::F32 | ScalarType::F64 => 1.0,
            ScalarType::I16 | ScalarType::U16 => 65535.0,
            ScalarType::I8 | ScalarType::U8 | ScalarType::I32 | ScalarType::U32 => 255.0,
        }
    }

    fn is_integer(self) -> bool {
        !matches!(self, ScalarType::F32 | ScalarType::F64)
    }
}

/// A property of all elements of one kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: PropertyType,
}

/// The type of a property: one value, or a list, which is a length followed by as many values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PropertyType {
    Scalar(ScalarType),
    List { length: ScalarType, item: ScalarType },
}

/// All elements of one kind. The groups follow one another in the order of the header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ElementGroup {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl ElementGroup {
    /// The size of one element in a binary file, in bytes; `None` if the sizes differ.
    pub(super) fn stride(&self) -> Option<usize> {
        self.size(0..self.properties.len())
    }

    /// The size of some properties of one element in a binary file, in bytes; `None` if one of them is a list.
    pub(super) fn size(&self, properties: Range<usize>) -> Option<usize> {
        let size = |property: &Property| match property.kind {
            PropertyType::Scalar(scalar) => Some(scalar.size()),
            PropertyType::List { .. } => None,
        };
        self.properties[properties].iter().map(size).sum()
    }

    /// The index of the property of this name.
    fn property(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|property| property.name == name)
    }
}

/// The content of a header, checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) groups: Vec<ElementGroup>,
    /// The number of vertices, which 32-bit indices can name.
    pub(super) vertices: u32,
    /// The indices of `x`, `y` and `z` among the properties of a vertex.
    pub(super) coordinates: [usize; 3],
    /// The indices of `nx`, `ny` and `nz` among the properties of a vertex, if it has all three.
    pub(super) normals: Option<[usize; 3]>,
    /// The indices of `red`, `green` and `blue` among the properties of a vertex, if it has all three.
    pub(super) colors: Option<[usize; 3]>,
    /// Whether faces have colours.
    pub(super) has_face_colors: bool,
    /// Whether a texture is named, or faces or vertices have texture coordinates.
    pub(super) has_textures: bool,
    /// The index of the list of corners among the properties of a face.
    pub(super) corners: usize,
    /// The number of bytes before the first element.
    pub(super) bytes: u64,
    /// The number of lines before the first element.
    pub(super) lines: u64,
}

/// Why a header could not be read.
pub(super) enum HeaderError {
    Io(io::Error),
    Fault { line: u64, fault: HeaderFault },
}

/// The most bytes of a line. Lines of real files have some tens.
const MOST_BYTES_A_LINE: u64 = 4096;
/// The most properties of all elements together. Real files have some tens.
const MOST_PROPERTIES: usize = 4096;

impl Header {
    /// Reads the header, and leaves the input at the first element.
    pub(super) fn read(input: &mut impl BufRead) -> Result<Header, HeaderError> {
        let mut lines = Lines { input, line: 0, bytes: 0, text: Vec::new() };
        let mut draft = Draft::default();
        while lines.next()? {
            let line = lines.line;
            let at_line = |fault| HeaderError::Fault { line, fault };
            if draft.statement(line, &lines.text).map_err(at_line)? {
                return draft.finish(lines.bytes, line).map_err(at_line);
            }
        }
        let fault = if lines.line == 0 { HeaderFault::Empty } else { HeaderFault::NoEnd };
        Err(HeaderError::Fault { line: lines.line.max(1), fault })
    }
}

/// Reads the lines of a header. Lines end with a line feed, with or without a carriage return before it.
struct Lines<'a, R> {
    input: &'a mut R,
    line: u64,
    bytes: u64,
    text: Vec<u8>,
}

impl<R: BufRead> Lines<'_, R> {
    /// Reads the next line into `text`, and tells whether there was one.
    fn next(&mut self) -> Result<bool, HeaderError> {
        self.text.clear();
        let mut limited = self.input.take(MOST_BYTES_A_LINE);
        let read = limited.read_until(b'\n', &mut self.text).map_err(HeaderError::Io)?;
        if read == 0 {
            return Ok(false);
        }
        self.line += 1;
        self.bytes += read as u64;
        let Some(text) = self.text.strip_suffix(b"\n") else {
            let fault = if self.line == 1 { HeaderFault::NotPly } else { HeaderFault::NoEnd };
            return Err(HeaderError::Fault { line: self.line, fault });
        };
        let length = text.strip_suffix(b"\r").unwrap_or(text).len();
        self.text.truncate(length);
        Ok(true)
    }
}

/// A header under construction.
#[derive(Default)]
struct Draft {
    encoding: Option<Encoding>,
    groups: Vec<ElementGroup>,
    properties: usize,
    names_texture: bool,
}

/// The beginning of the line in which some programs name a texture.
const TEXTURE: &[u8] = b"comment TextureFile";
/// The names that programs give to texture coordinates of vertices.
const TEXTURE_COORDINATES: [[&str; 2]; 3] = [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]];

impl Draft {
    /// Parses one line, and tells whether it ends the header.
    fn statement(&mut self, line: u64, text: &[u8]) -> Result<bool, HeaderFault> {
        if line == 1 {
            return if without_mark(text) == b"ply" { Ok(false) } else { Err(HeaderFault::NotPly) };
        }
        if text.starts_with(b"comment") || text.starts_with(b"obj_info") {
            self.names_texture |= text.starts_with(TEXTURE);
            return Ok(false);
        }
        let unknown = || HeaderFault::UnknownStatement { text: quote(text) };
        let words = str::from_utf8(text).map_err(|_| unknown())?;
        let words: Vec<&str> = words.split_ascii_whitespace().collect();
        match words[..] {
            ["format", encoding, version] => self.format(encoding, version)?,
            ["element", name, count] => self.element(name, count)?,
            ["property", "list", length, item, name] => {
                let [length, item] = [scalar_type(length)?, scalar_type(item)?];
                if !length.is_integer() {
                    return Err(HeaderFault::LengthNotInteger { name: quote::shown(name) });
                }
                self.property(name, PropertyType::List { length, item })?;
            }
            ["property", kind, name] => {
                self.property(name, PropertyType::Scalar(scalar_type(kind)?))?
            }
            ["end_header"] => return Ok(true),
            _ => return Err(unknown()),
        }
        Ok(false)
    }

    /// Parses `format`.
    fn format(&mut self, encoding: &str, version: &str) -> Result<(), HeaderFault> {
        let known = match encoding {
            "ascii" => Encoding::Ascii,
            "binary_little_endian" => Encoding::LittleEndian,
            "binary_big_endian" => Encoding::BigEndian,
            _ => return Err(HeaderFault::UnknownFormat { text: quote(encoding.as_bytes()) }),
        };
        if version != "1.0" {
            return Err(HeaderFault::UnknownVersion { text: quote(version.as_bytes()) });
        }
        match self.encoding.replace(known) {
            None => Ok(()),
            Some(_) => Err(HeaderFault::Twice { what: "format".into() }),
        }
    }

    /// Parses `element`.
    fn element(&mut self, name: &str, count: &str) -> Result<(), HeaderFault> {
        let shown = quote::shown(name);
        let Some(count) = whole(count) else {
            return Err(HeaderFault::NotACount { name: shown, text: quote(count.as_bytes()) });
        };
        if self.groups.iter().any(|group| group.name == name) {
            return Err(HeaderFault::Twice { what: format!("element {shown}") });
        }
        self.check_last()?;
        self.groups.push(ElementGroup { name: name.to_owned(), count, properties: Vec::new() });
        Ok(())
    }

    /// Parses `property`.
    fn property(&mut self, name: &str, kind: PropertyType) -> Result<(), HeaderFault> {
        let shown = quote::shown(name);
        let Some(group) = self.groups.last_mut() else {
            return Err(HeaderFault::NoElement { name: shown });
        };
        if group.property(name).is_some() {
            let what = format!("property {shown} of {}", quote::shown(&group.name));
            return Err(HeaderFault::Twice { what });
        }
        self.properties += 1;
        if self.properties > MOST_PROPERTIES {
            return Err(HeaderFault::TooManyProperties { most: MOST_PROPERTIES });
        }
        group.properties.push(Property { name: name.to_owned(), kind });
        Ok(())
    }

    /// Makes sure that the last element has a property. An element without properties would take no bytes, so that the
    /// file could announce any number of them.
    fn check_last(&self) -> Result<(), HeaderFault> {
        match self.groups.last() {
            Some(last) if last.properties.is_empty() => {
                Err(HeaderFault::NoProperties { name: quote::shown(&last.name) })
            }
            _ => Ok(()),
        }
    }

    /// Checks the whole header.
    fn finish(self, bytes: u64, lines: u64) -> Result<Header, HeaderFault> {
        self.check_last()?;
        let encoding = self.encoding.ok_or(HeaderFault::NoFormat)?;
        let named = |name| self.groups.iter().find(|group| group.name == name);
        let vertex = named("vertex").ok_or(HeaderFault::NoVertices)?;
        let face = named("face").filter(|face| face.count > 0).ok_or(HeaderFault::NoFaces)?;
        let vertices = u32::try_from(vertex.count).ok().filter(|&count| count < u32::MAX);
        let vertices = vertices.ok_or(HeaderFault::TooManyVertices { count: vertex.count })?;
        let coordinate = |name| match vertex.property(name) {
            Some(k) if matches!(vertex.properties[k].kind, PropertyType::Scalar(_)) => Ok(k),
            _ => Err(HeaderFault::NoCoordinate { name }),
        };
        let coordinates = [coordinate("x")?, coordinate("y")?, coordinate("z")?];
        let normals = match ["nx", "ny", "nz"].map(|name| coordinate(name).ok()) {
            [Some(x), Some(y), Some(z)] => Some([x, y, z]),
            _ => None,
        };
        let colors = match ["red", "green", "blue"].map(|name| coordinate(name).ok()) {
            [Some(red), Some(green), Some(blue)] => Some([red, green, blue]),
            _ => None,
        };
        let has_face_colors = face.property("red").is_some();
        let are_there =
            |names: &[&str; 2]| names.iter().all(|name| vertex.property(name).is_some());
        let has_textures = self.names_texture
            || face.property("texcoord").is_some()
            || TEXTURE_COORDINATES.iter().any(are_there);
        let corners = face.property("vertex_indices").or_else(|| face.property("vertex_index"));
        let is_index_list = |&k: &usize| match face.properties[k].kind {
            PropertyType::List { item, .. } => item.is_integer(),
            PropertyType::Scalar(_) => false,
        };
        let corners = corners.filter(is_index_list).ok_or(HeaderFault::NoCorners)?;
        let groups = self.groups;
        Ok(Header {
            encoding,
            groups,
            vertices,
            coordinates,
            normals,
            colors,
            has_face_colors,
            has_textures,
            corners,
            bytes,
            lines,
        })
    }
}

fn scalar_type(word: &str) -> Result<ScalarType, HeaderFault> {
    ScalarType::named(word).ok_or_else(|| HeaderFault::UnknownType { text: quote(word.as_bytes()) })
}

/// Reads a whole number without a sign: `parse` alone would accept `+1`.
fn whole(word: &str) -> Option<u64> {
    word.bytes().all(|byte| byte.is_ascii_digit()).then(|| word.parse().ok())?
}
