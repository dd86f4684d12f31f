//! A PLY file, read in passes, one value at a time. It does not need to fit into memory.

use super::error::{ElementFault, ReadPlyError};
use super::header::{ElementGroup, Header, HeaderError, PropertyType, ScalarType};
use super::quick::{Decoded, FaceLayout, VertexLayout};
use super::values::{ValueError, ValueReader};
use super::vertex::Vertex;
use crate::attributes::{NONE, linear_colors};
use crate::polygon::{Cutter, Fans, MOST_CORNERS, fan};
use crate::source::quote::shown;
use crate::source::{READ_AT_ONCE, regular_file};
use crate::warning::MaterialWarning;
use bothways_common::scene::{Attribute, Mesh, Positions};
use glam::Vec3;
use std::fs::File;
use std::io::{BufRead, BufReader, Seek, SeekFrom};
use std::path::Path;

/// An open PLY file with its header, to be read in any number of passes.
#[derive(Debug)]
pub(crate) struct PlyFile<R> {
    name: String,
    header: Header,
    input: R,
    length: u64,
}

/// What a pass over a file visits; it skips the rest where it can.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pass {
    Vertices,
    Triangles,
    Everything,
}

impl PlyFile<BufReader<File>> {
    /// Opens a file that can be read several times, and reads its header.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadPlyError> {
        let file = path.display().to_string();
        let opened = regular_file(path);
        let opened =
            opened.map_err(|error| ReadPlyError::Unreadable { file: file.clone(), error })?;
        PlyFile::new(file, BufReader::with_capacity(READ_AT_ONCE, opened))
    }
}

impl<R: BufRead + Seek> PlyFile<R> {
    /// Reads the header.
    pub(super) fn new(name: String, mut input: R) -> Result<Self, ReadPlyError> {
        let unreadable = |error| ReadPlyError::Unreadable { file: name.clone(), error };
        let length = input.seek(SeekFrom::End(0)).map_err(unreadable)?;
        input.rewind().map_err(unreadable)?;
        match Header::read(&mut input) {
            Ok(header) => Ok(PlyFile { name, header, input, length }),
            Err(HeaderError::Io(error)) => Err(unreadable(error)),
            Err(HeaderError::Fault { line, fault }) => {
                Err(ReadPlyError::Header { file: name, line, fault: Box::new(fault) })
            }
        }
    }

    /// Reads all elements into a mesh.
    pub(super) fn mesh(&mut self) -> Result<Mesh, ReadPlyError> {
        let (mut positions, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        let mut colors = Vec::new();
        let [has_normals, has_colors] =
            [self.header.normals, self.header.colors].map(|of| of.is_some());
        let mut vertex = |vertex: Vertex| {
            positions.push(vertex.position);
            if has_normals {
                normals.push(vertex.normal);
            }
            if has_colors {
                colors.push(vertex.color);
            }
        };
        // Faces may come before the vertices: which of them must not be fans is found at the end.
        let mut fans = Fans::default();
        let mut polygon = |corners: &[u32]| {
            fans.add(triangles.len(), corners.len());
            triangles.extend(fan(corners));
        };
        self.visit(Pass::Everything, &mut vertex, &mut polygon)?;
        fans.recuts(&positions, &triangles).apply(&mut triangles);
        let normals = normals_of(&triangles, normals);
        Ok(Mesh::new(positions, triangles)
            .and_then(|mesh| mesh.with_normals(normals))
            .and_then(|mesh| mesh.with_colors(linear_colors(colors)))
            .expect("the reader has checked numbers and indices"))
    }

    /// Reads all elements into a mesh, with a warning if its faces have colours and its vertices have none, and one if it has
    /// textures.
    pub(super) fn mesh_with_warnings(
        &mut self,
    ) -> Result<(Mesh, Vec<MaterialWarning>), ReadPlyError> {
        let Header { has_face_colors, has_textures, colors, .. } = self.header;
        let is_missed = has_face_colors && colors.is_none();
        let file = || self.name.clone();
        let of_faces = is_missed.then(|| MaterialWarning::FaceColors { file: file() });
        let textures = has_textures.then(|| MaterialWarning::PlyTextures { file: file() });
        let warnings = of_faces.into_iter().chain(textures).collect();
        Ok((self.mesh()?, warnings))
    }

    /// Visits all vertices, and does not read what follows them.
    pub(crate) fn vertices(&mut self, mut visit: impl FnMut(Vec3)) -> Result<(), ReadPlyError> {
        self.visit(
            Pass::Vertices,
            &mut |vertex: Vertex| visit(vertex.position),
            &mut |_: &[u32]| (),
        )
    }

    /// A warning if the file has colours or textures: no stream reads them.
    pub(crate) fn color_warning(&self) -> Option<MaterialWarning> {
        let Header { has_face_colors, has_textures, colors, .. } = self.header;
        let has_colors = has_face_colors || has_textures || colors.is_some();
        has_colors.then(|| MaterialWarning::Streamed { file: self.name.clone() })
    }

    /// Visits all triangles in file order, and reads the whole file but its vertices. The indices are those of
    /// vertices that the header announces, at these positions.
    pub(crate) fn triangles(
        &mut self,
        positions: &Positions,
        mut visit: impl FnMut([u32; 3]),
    ) -> Result<(), ReadPlyError> {
        let mut cutter = Cutter::default();
        let mut polygon = |corners: &[u32]| {
            cutter.visit(corners, |vertex| positions.get(vertex), &mut visit);
        };
        self.visit(Pass::Triangles, &mut |_| (), &mut polygon)
    }

    /// Reads the elements that a pass needs, in file order, and visits vertices and polygons. A polygon that is a fan whatever
    /// its positions may come as its triangles.
    fn visit(
        &mut self,
        pass: Pass,
        vertex: &mut impl FnMut(Vertex),
        polygon: &mut impl FnMut(&[u32]),
    ) -> Result<(), ReadPlyError> {
        let PlyFile { name, header, input, length } = self;
        let unreadable = |error| ReadPlyError::Unreadable { file: name.clone(), error };
        input.seek(SeekFrom::Start(header.bytes)).map_err(unreadable)?;
        let mut values = ValueReader::new(input, header, *length);
        for group in &header.groups {
            let is_vertex = group.name == "vertex";
            let stride = group.stride().filter(|_| pass != Pass::Everything);
            let first = match stride.filter(|_| !is_vertex || pass == Pass::Triangles) {
                Some(stride) if values.is_binary() => {
                    values.skip(group.count, stride).map_err(unreadable)?
                }
                _ => 0,
            };
            let quick = Quick::of(header, group);
            let mut number = first;
            while number < group.count {
                // All that is in memory at once; and then one element by itself, which is wrong, or not all in memory.
                let bytes = values.in_memory().map_err(unreadable)?;
                let decoded = quick.decode(bytes, group.count - number, vertex, polygon);
                values.consume(decoded.bytes);
                number += decoded.elements;
                if number < group.count {
                    let element = element(&mut values, header, group, vertex, polygon);
                    element.map_err(|error| located(name, group, number, &values, error))?;
                    number += 1;
                }
            }
            if is_vertex && pass == Pass::Vertices {
                return Ok(());
            }
        }
        let location = values.location();
        match values.at_end() {
            Ok(true) => Ok(()),
            Err(ValueError::Io(error)) => Err(unreadable(error)),
            _ => Err(ReadPlyError::Trailing { file: name.clone(), location }),
        }
    }
}

/// The elements that can be decoded many at a time.
enum Quick {
    Vertices(VertexLayout),
    Faces(FaceLayout),
    Nothing,
}

impl Quick {
    fn of(header: &Header, group: &ElementGroup) -> Quick {
        match group.name.as_str() {
            "vertex" => VertexLayout::new(header, group).map_or(Quick::Nothing, Quick::Vertices),
            "face" => FaceLayout::new(header, group).map_or(Quick::Nothing, Quick::Faces),
            _ => Quick::Nothing,
        }
    }

    /// Decodes at most `most` elements that are in memory.
    fn decode(
        &self,
        bytes: &[u8],
        most: u64,
        vertex: &mut impl FnMut(Vertex),
        polygon: &mut impl FnMut(&[u32]),
    ) -> Decoded {
        match self {
            Quick::Vertices(layout) => layout.decode(bytes, most, vertex),
            Quick::Faces(layout) => layout.decode(bytes, most, polygon),
            Quick::Nothing => Decoded::default(),
        }
    }
}

/// The normals of vertices, as an attribute of triangles. A normal without direction is none.
fn normals_of(triangles: &[[u32; 3]], mut values: Vec<Vec3>) -> Attribute<Vec3> {
    let has_direction = |normal: &Vec3| normal.is_finite() && *normal != Vec3::ZERO;
    if !values.iter().any(has_direction) {
        return Attribute::default();
    }
    let index = |v: u32| if has_direction(&values[v as usize]) { v } else { NONE };
    let corners = triangles.iter().map(|corners| corners.map(index)).collect();
    values.iter_mut().filter(|normal| !normal.is_finite()).for_each(|normal| *normal = Vec3::ZERO);
    Attribute { values, corners }
}

/// Reads one element of any kind.
fn element<R: BufRead + Seek>(
    values: &mut ValueReader<R>,
    header: &Header,
    group: &ElementGroup,
    vertex: &mut impl FnMut(Vertex),
    polygon: &mut impl FnMut(&[u32]),
) -> Result<(), ValueError> {
    values.begin_element()?;
    let (is_vertex, is_face) = (group.name == "vertex", group.name == "face");
    let [mut position, mut normal, mut color] = [[0.0; 3]; 3];
    for (k, property) in group.properties.iter().enumerate() {
        let axis = |of: &[usize; 3]| of.iter().position(|&at| at == k).filter(|_| is_vertex);
        match (property.kind, axis(&header.coordinates)) {
            (PropertyType::Scalar(scalar), Some(axis)) => {
                position[axis] = values.coordinate(&property.name, scalar)?;
            }
            (PropertyType::Scalar(scalar), None) => {
                let component = values.component(scalar)?;
                if let Some(axis) = header.normals.as_ref().and_then(axis) {
                    normal[axis] = component;
                } else if let Some(axis) = header.colors.as_ref().and_then(axis) {
                    color[axis] = component / scalar.full_color();
                }
            }
            (PropertyType::List { length, item }, _) if is_face && k == header.corners => {
                corners(values, length, item, header.vertices, polygon)?;
            }
            (PropertyType::List { length, item }, _) => {
                let length = values.integer(length)?;
                if length < 0 {
                    let name = shown(&property.name);
                    return Err(ElementFault::NegativeLength { name, length }.into());
                }
                (0..length).try_for_each(|_| values.component(item).map(drop))?;
            }
        }
    }
    values.end_element()?;
    if is_vertex {
        vertex(Vertex { position: position.into(), normal: normal.into(), color: color.into() });
    }
    Ok(())
}

/// Reads one polygon and visits it. One that is always a fan is visited as triangles: at most three of its corners are in
/// memory at once.
fn corners<R: BufRead + Seek>(
    values: &mut ValueReader<R>,
    length: ScalarType,
    item: ScalarType,
    vertices: u32,
    polygon: &mut impl FnMut(&[u32]),
) -> Result<(), ValueError> {
    let corners = values.integer(length)?;
    if corners < 3 {
        return Err(ElementFault::TooFewCorners { corners }.into());
    }
    // Its room is used again.
    let mut indices = std::mem::take(&mut values.indices);
    let mut corner = || {
        let index = values.integer(item)?;
        match u32::try_from(index) {
            Ok(known) if known < vertices => Ok(known),
            _ => Err(ValueError::Fault(ElementFault::UnknownVertex { index, count: vertices })),
        }
    };
    if usize::try_from(corners).is_ok_and(|corners| (4..=MOST_CORNERS).contains(&corners)) {
        indices.clear();
        for _ in 0..corners {
            indices.push(corner()?);
        }
        polygon(&indices);
    } else {
        let (first, mut before) = (corner()?, corner()?);
        for _ in 2..corners {
            let next = corner()?;
            polygon(&[first, before, next]);
            before = next;
        }
    }
    values.indices = indices;
    Ok(())
}

/// Adds the file and the location to an error.
fn located<R: BufRead + Seek>(
    name: &str,
    group: &ElementGroup,
    number: u64,
    values: &ValueReader<R>,
    error: ValueError,
) -> ReadPlyError {
    let fault = match error {
        ValueError::Io(error) => return ReadPlyError::Unreadable { file: name.to_owned(), error },
        ValueError::End => ElementFault::Truncated { count: group.count },
        ValueError::Fault(fault) => fault,
    };
    let (file, element) = (name.to_owned(), shown(&group.name));
    ReadPlyError::Element {
        file,
        element,
        number,
        location: values.location(),
        fault: Box::new(fault),
    }
}
