//! Decodes the binary elements that are in memory already, without a look at each value's type by itself. What is unusual is
//! left to the reader of single values, which gives the same result, or says what is wrong.

use super::header::{ElementGroup, Encoding, Header, PropertyType, ScalarType};
use super::vertex::Vertex;
use glam::Vec3;

/// How far the elements were decoded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Decoded {
    pub(super) elements: u64,
    pub(super) bytes: usize,
}

/// Where the numbers of a vertex stand in its bytes.
#[derive(Clone, Debug)]
pub(super) struct VertexLayout {
    is_big_endian: bool,
    stride: usize,
    coordinates: [(usize, ScalarType); 3],
    normals: Option<[(usize, ScalarType); 3]>,
    colors: Option<[(usize, ScalarType); 3]>,
}

/// Where the corners of a face stand in its bytes.
#[derive(Clone, Debug)]
pub(super) struct FaceLayout {
    is_big_endian: bool,
    /// The bytes before the length of the list of corners, and behind the last corner.
    before: usize,
    after: usize,
    length: ScalarType,
    item: ScalarType,
    vertices: u32,
}

impl VertexLayout {
    /// The layout of a file's vertices; `None` if their sizes differ, or if they are words.
    pub(super) fn new(header: &Header, group: &ElementGroup) -> Option<VertexLayout> {
        let is_big_endian = is_big_endian(header)?;
        let stride = group.stride()?;
        let place = |property: usize| match group.properties[property].kind {
            PropertyType::Scalar(scalar) => Some((group.size(0..property)?, scalar)),
            PropertyType::List { .. } => None,
        };
        let places = |[x, y, z]: [usize; 3]| Some([place(x)?, place(y)?, place(z)?]);
        let coordinates = places(header.coordinates)?;
        let normals = header.normals.and_then(places);
        let colors = header.colors.and_then(places);
        Some(VertexLayout { is_big_endian, stride, coordinates, normals, colors })
    }

    /// Decodes at most `most` vertices, up to the first with a coordinate that is not finite.
    pub(super) fn decode(&self, bytes: &[u8], most: u64, mut visit: impl FnMut(Vertex)) -> Decoded {
        let mut decoded = Decoded::default();
        for vertex in bytes.chunks_exact(self.stride) {
            let vector = |places: [(usize, ScalarType); 3]| {
                Vec3::from(places.map(|(at, scalar)| self.number(vertex, at, scalar)))
            };
            let position = vector(self.coordinates);
            if decoded.elements == most || !position.is_finite() {
                break;
            }
            let color = |places: [(usize, ScalarType); 3]| {
                vector(places) / Vec3::from(places.map(|(_, scalar)| scalar.full_color()))
            };
            visit(Vertex {
                position,
                normal: self.normals.map_or(Vec3::ZERO, vector),
                color: self.colors.map_or(Vec3::ONE, color),
            });
            decoded.elements += 1;
            decoded.bytes += self.stride;
        }
        decoded
    }

    /// A number, rounded once to `f32`.
    #[inline]
    fn number(&self, bytes: &[u8], at: usize, scalar: ScalarType) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "to the nearest, once")]
        #[expect(clippy::cast_precision_loss, reason = "to the nearest, once")]
        match scalar {
            ScalarType::F32 => {
                f32::from_bits(u32::from_le_bytes(array(bytes, at, self.is_big_endian)))
            }
            ScalarType::F64 => {
                f64::from_bits(u64::from_le_bytes(array(bytes, at, self.is_big_endian))) as f32
            }
            integer => whole(bytes, at, integer, self.is_big_endian) as f32,
        }
    }
}

impl FaceLayout {
    /// The layout of a file's faces; `None` if they have other lists, too, or if they are words.
    pub(super) fn new(header: &Header, group: &ElementGroup) -> Option<FaceLayout> {
        let PropertyType::List { length, item } = group.properties[header.corners].kind else {
            return None;
        };
        Some(FaceLayout {
            is_big_endian: is_big_endian(header)?,
            before: group.size(0..header.corners)?,
            after: group.size(header.corners + 1..group.properties.len())?,
            length,
            item,
            vertices: header.vertices,
        })
    }

    /// Decodes at most `most` faces into polygons, up to the first that is wrong or goes on behind the bytes.
    pub(super) fn decode(&self, bytes: &[u8], most: u64, mut visit: impl FnMut(&[u32])) -> Decoded {
        let (length_size, item_size) = (self.length.size(), self.item.size());
        let (mut decoded, mut known) = (Decoded::default(), [0; MOST_CORNERS]);
        while decoded.elements < most {
            let triangles =
                self.decode_triangles(&bytes[decoded.bytes..], most - decoded.elements, &mut visit);
            decoded.elements += triangles.elements;
            decoded.bytes += triangles.bytes;
            if decoded.elements == most {
                break;
            }
            let face = &bytes[decoded.bytes..];
            if face.len() < self.before + length_size {
                break;
            }
            let corners = whole(face, self.before, self.length, self.is_big_endian);
            let first = self.before + length_size;
            // A longer list is left to the reader of single values.
            let Some(corners) = usize::try_from(corners)
                .ok()
                .filter(|corners| (3..=MOST_CORNERS).contains(corners))
            else {
                break;
            };
            let end = first + corners * item_size + self.after;
            if face.len() < end {
                break;
            }
            let index =
                |k: usize| whole(face, first + k * item_size, self.item, self.is_big_endian);
            let is_known = |k: usize| (0..i64::from(self.vertices)).contains(&index(k));
            if !(0..corners).all(is_known) {
                break;
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a vertex")]
            let vertex = |k: usize| index(k) as u32;
            known[..corners].iter_mut().enumerate().for_each(|(k, known)| *known = vertex(k));
            visit(&known[..corners]);
            decoded.elements += 1;
            decoded.bytes += end;
        }
        decoded
    }
}

impl FaceLayout {
    /// Decodes the triangles at the beginning, if indices have four bytes and their number one, as in most files.
    fn decode_triangles(&self, bytes: &[u8], most: u64, mut visit: impl FnMut(&[u32])) -> Decoded {
        let mut decoded = Decoded::default();
        if self.length.size() != 1 || self.item.size() != 4 {
            return decoded;
        }
        // A negative index is too large, as an unsigned one.
        let is_signed = self.item == ScalarType::I32;
        let vertices = if is_signed { self.vertices.min(1 << 31) } else { self.vertices };
        let size = self.before + 13 + self.after;
        for face in bytes.chunks_exact(size) {
            let (corners, indices) = (face[self.before], &face[self.before + 1..]);
            let triangle =
                [0, 4, 8].map(|at| u32::from_le_bytes(array(indices, at, self.is_big_endian)));
            let is_known = triangle.iter().all(|&index| index < vertices);
            if corners != 3 || !is_known || decoded.elements == most {
                break;
            }
            visit(&triangle);
            decoded.elements += 1;
            decoded.bytes += size;
        }
        decoded
    }
}

/// The most corners of a face that is decoded in one go.
const MOST_CORNERS: usize = 64;

/// The order of the bytes of a number; `None` for words.
fn is_big_endian(header: &Header) -> Option<bool> {
    match header.encoding {
        Encoding::Ascii => None,
        Encoding::LittleEndian => Some(false),
        Encoding::BigEndian => Some(true),
    }
}

/// A number of an integer type.
#[inline]
fn whole(bytes: &[u8], at: usize, scalar: ScalarType, is_big: bool) -> i64 {
    match scalar {
        ScalarType::I8 => i8::from_le_bytes(array(bytes, at, is_big)).into(),
        ScalarType::U8 => bytes[at].into(),
        ScalarType::I16 => i16::from_le_bytes(array(bytes, at, is_big)).into(),
        ScalarType::U16 => u16::from_le_bytes(array(bytes, at, is_big)).into(),
        ScalarType::I32 => i32::from_le_bytes(array(bytes, at, is_big)).into(),
        ScalarType::U32 => u32::from_le_bytes(array(bytes, at, is_big)).into(),
        ScalarType::F32 | ScalarType::F64 => unreachable!("the header was checked"),
    }
}

/// The bytes of a number, the least significant one first.
#[inline]
fn array<const N: usize>(bytes: &[u8], at: usize, is_big_endian: bool) -> [u8; N] {
    let mut array = [0; N];
    array.copy_from_slice(&bytes[at..at + N]);
    if is_big_endian {
        array.reverse();
    }
    array
}
