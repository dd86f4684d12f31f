//! PLY files: the reader of meshes that scanners and sculpting programs write, and a writer.
//!
//! Of the format (Turk, "The PLY Polygon File Format", 1994) the reader takes all three encodings,
//! and of what is in a file the triangles, strictly:
//!
//! - `x`, `y`, `z` of the element `vertex`, of any type: rounded once, to the nearest `f32`.
//! - The list `vertex_indices` or `vertex_index` of the element `face`, of any integer types: a
//!   polygon of any size, cut into the fan `(0, k, k + 1)` in file order. Indices count from 0.
//! - Other properties and other elements are skipped, but must be there. Nothing may follow the last
//!   element, because then the header does not fit the file.
//!
//! A file is read value by value: no number that stands in it makes the reader take memory before
//! the values that it announces have come.

mod error;
mod header;
mod values;
mod write;

pub use error::{ElementFault, HeaderFault, Place, ReadPlyError};
pub use write::write;

use crate::source::quote::shown;
use crate::source::{READ_AT_ONCE, regular_file};
use bothways_common::scene::Mesh;
use glam::Vec3;
use header::{Elements, Form, Header, HeaderError, Scalar};
use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Seek, SeekFrom};
use std::path::Path;
use values::{Stop, Values};

/// Reads a mesh from a PLY file.
///
/// # Errors
///
/// As for [`parse`], and a file that cannot be read; messages call the file by `path`.
pub fn read(path: &Path) -> Result<Mesh, ReadPlyError> {
    PlyFile::open(path)?.mesh()
}

/// Reads a mesh from the bytes of a PLY file, which messages call `name`.
///
/// # Errors
///
/// A header or an element that is wrong or missing, an index without a vertex, more than the header
/// announces.
///
/// ```
/// use bothways_formats::ply;
///
/// let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
///               property float z\nelement face 1\nproperty list uchar int vertex_indices\n\
///               end_header\n";
/// let square = format!("{header}0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
/// let mesh = ply::parse("square.ply", square.as_bytes())?;
/// assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
///
/// let error = ply::parse("bad.ply", square.replace("1 2 3", "1 2 4").as_bytes()).unwrap_err();
/// let says = "bad.ply: face 0 (line 14): it names vertex 4, but vertices are counted from 0 and \
///             there are 4";
/// assert_eq!(error.to_string(), says);
/// # Ok::<(), ply::ReadPlyError>(())
/// ```
pub fn parse(name: &str, bytes: &[u8]) -> Result<Mesh, ReadPlyError> {
    PlyFile::new(name.to_owned(), Cursor::new(bytes))?.mesh()
}

/// A PLY file with its header read, to be walked through any number of times.
#[derive(Debug)]
pub(crate) struct PlyFile<R> {
    name: String,
    header: Header,
    input: R,
    length: u64,
}

/// What a walk through a file is for; it skips the rest.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    Vertices,
    Triangles,
    Everything,
}

impl PlyFile<BufReader<File>> {
    pub(crate) fn open(path: &Path) -> Result<Self, ReadPlyError> {
        let file = path.display().to_string();
        let opened = regular_file(path);
        let opened =
            opened.map_err(|error| ReadPlyError::Unreadable { file: file.clone(), error })?;
        PlyFile::new(file, BufReader::with_capacity(READ_AT_ONCE, opened))
    }
}

impl<R: BufRead + Seek> PlyFile<R> {
    fn new(name: String, mut input: R) -> Result<Self, ReadPlyError> {
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

    /// All of it as a mesh.
    fn mesh(&mut self) -> Result<Mesh, ReadPlyError> {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        self.walk(Wanted::Everything, &mut |p| positions.push(p), &mut |t| triangles.push(t))?;
        Ok(Mesh::new(positions, triangles).expect("the reader has checked numbers and indices"))
    }

    /// Visits all vertices; what comes behind them is not looked at.
    pub(crate) fn vertices(&mut self, mut visit: impl FnMut(Vec3)) -> Result<(), ReadPlyError> {
        self.walk(Wanted::Vertices, &mut visit, &mut |_| ())
    }

    /// Visits all triangles in file order, each with three indices of vertices that the header
    /// announces, and looks at the whole file but its vertices.
    pub(crate) fn triangles(
        &mut self,
        mut visit: impl FnMut([u32; 3]),
    ) -> Result<(), ReadPlyError> {
        self.walk(Wanted::Triangles, &mut |_| (), &mut visit)
    }

    fn walk(
        &mut self,
        wanted: Wanted,
        vertex: &mut impl FnMut(Vec3),
        triangle: &mut impl FnMut([u32; 3]),
    ) -> Result<(), ReadPlyError> {
        let PlyFile { name, header, input, length } = self;
        let unreadable = |error| ReadPlyError::Unreadable { file: name.clone(), error };
        input.seek(SeekFrom::Start(header.bytes)).map_err(unreadable)?;
        let mut values = Values::new(input, header, *length);
        for elements in &header.elements {
            let is_vertex = elements.name == "vertex";
            let stride = elements.stride().filter(|_| wanted != Wanted::Everything);
            let first = match stride.filter(|_| !is_vertex || wanted == Wanted::Triangles) {
                Some(stride) if values.is_binary() => {
                    values.skip(elements.count, stride).map_err(unreadable)?
                }
                _ => 0,
            };
            for number in first..elements.count {
                let element = element(&mut values, header, elements, vertex, triangle);
                element.map_err(|stop| located(name, elements, number, &values, stop))?;
            }
            if is_vertex && wanted == Wanted::Vertices {
                return Ok(());
            }
        }
        let place = values.place();
        match values.at_end() {
            Ok(true) => Ok(()),
            Err(Stop::Io(error)) => Err(unreadable(error)),
            _ => Err(ReadPlyError::Trailing { file: name.clone(), place }),
        }
    }
}

/// Reads one element, whichever it is.
fn element<R: BufRead + Seek>(
    values: &mut Values<R>,
    header: &Header,
    elements: &Elements,
    vertex: &mut impl FnMut(Vec3),
    triangle: &mut impl FnMut([u32; 3]),
) -> Result<(), Stop> {
    values.begin_element()?;
    let (is_vertex, is_face) = (elements.name == "vertex", elements.name == "face");
    let mut position = [0.0; 3];
    for (k, property) in elements.properties.iter().enumerate() {
        let axis = header.coordinates.iter().position(|&at| at == k).filter(|_| is_vertex);
        match (property.form, axis) {
            (Form::One(scalar), Some(axis)) => {
                position[axis] = values.coordinate(&property.name, scalar)?;
            }
            (Form::One(scalar), None) => values.ignore(scalar)?,
            (Form::List { length, item }, _) if is_face && k == header.corners => {
                fan(values, length, item, header.vertices, triangle)?;
            }
            (Form::List { length, item }, _) => {
                let length = values.integer(length)?;
                if length < 0 {
                    let name = shown(&property.name);
                    return Err(ElementFault::NegativeLength { name, length }.into());
                }
                (0..length).try_for_each(|_| values.ignore(item))?;
            }
        }
    }
    values.end_element()?;
    if is_vertex {
        vertex(position.into());
    }
    Ok(())
}

/// Reads one polygon and visits its fan; no more than three of its corners are in memory at once.
fn fan<R: BufRead + Seek>(
    values: &mut Values<R>,
    length: Scalar,
    item: Scalar,
    vertices: u32,
    triangle: &mut impl FnMut([u32; 3]),
) -> Result<(), Stop> {
    let corners = values.integer(length)?;
    if corners < 3 {
        return Err(ElementFault::TooFewCorners { corners }.into());
    }
    let mut corner = || {
        let index = values.integer(item)?;
        match u32::try_from(index) {
            Ok(known) if known < vertices => Ok(known),
            _ => Err(Stop::Fault(ElementFault::UnknownVertex { index, count: vertices })),
        }
    };
    let (first, mut before) = (corner()?, corner()?);
    for _ in 2..corners {
        let next = corner()?;
        triangle([first, before, next]);
        before = next;
    }
    Ok(())
}

fn located<R: BufRead + Seek>(
    name: &str,
    elements: &Elements,
    number: u64,
    values: &Values<R>,
    stop: Stop,
) -> ReadPlyError {
    let fault = match stop {
        Stop::Io(error) => return ReadPlyError::Unreadable { file: name.to_owned(), error },
        Stop::End => ElementFault::Truncated { count: elements.count },
        Stop::Fault(fault) => fault,
    };
    let (file, element) = (name.to_owned(), shown(&elements.name));
    ReadPlyError::Element { file, element, number, place: values.place(), fault: Box::new(fault) }
}

#[cfg(test)]
mod tests;
