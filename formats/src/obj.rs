//! Wavefront OBJ files: the reader and the writer of meshes.
//!
//! Of the format (Wavefront, "Advanced Visualizer" manual, appendix B1, "Object Files") the reader
//! takes what describes triangles, and takes it strictly:
//!
//! - `v x y z`, `vt u [v]`, `vn x y z`: numbers round once, to the nearest `f32`. What follows (a
//!   weight `w`, a colour) must be numbers and is ignored; `w` only weighs free-form curves.
//! - `f` with corners `v`, `v/vt`, `v//vn`, `v/vt/vn`: a polygon of any size, cut into the fan
//!   `(0, k, k + 1)` in file order. Indices count from 1, or back from what is defined above the
//!   face. A positive index may name what only follows below, anywhere in the file: some programs
//!   write faces first, and `tobj`, which the tests compare with, accepts it too.
//! - `#` before a word begins a comment; a backslash before the end of a line joins the next line.
//! - `usemtl` names the material of the faces below, `mtllib` a file that defines some: see
//!   [`read_with_materials`].
//! - Names, groups, points, lines, free-form geometry and display settings are skipped. Anything else
//!   is an error, `call` and `csh` too: they would run or include what is not here.
//!
//! A file that is read in passes, for [`stream`](crate::stream), tells its vertices and triangles only.

mod error;
mod lines;
mod materials;
mod parts;
mod passes;
mod write;

pub use error::{Element, ReadObjError, StatementFault};
pub use materials::{MaterialWarning, parse_materials};
pub(crate) use passes::ObjFile;
pub use write::write;

use std::path::Path;

use glam::{Vec2, Vec3};

use crate::source::quote::quote;
use bothways_common::scene::{Attribute, Mesh};
use lines::{Statements, Words};
use parts::Parts;

/// Reads a mesh from an OBJ file.
///
/// # Errors
///
/// As for [`parse`], and a file that cannot be read; messages call the file by `path`.
pub fn read(path: &Path) -> Result<Mesh, ReadObjError> {
    let mut file = ObjFile::open(path)?;
    let name = path.display().to_string();
    // A statement at a time: a file that is none ends the reader early, and never fills the memory.
    if file.length()? > MOST_BYTES {
        return Err(ReadObjError::TooLarge { file: name });
    }
    let mut reader = Reader::new(Parts::default(), None);
    match file.statements(|line, words| reader.statement(line, words))? {
        0 => Err(ReadObjError::Empty { file: name }),
        _ => finish(name, reader),
    }
}

/// Reads a mesh from an OBJ file, and its colours from the material files beside it.
///
/// A material file that is not there, or that lacks a material, is no error: many meshes come without
/// theirs. What is missing is told, and drawn in the material of the object.
///
/// # Errors
///
/// As for [`read`], and for each material file that is there.
pub fn read_with_materials(path: &Path) -> Result<(Mesh, Vec<MaterialWarning>), ReadObjError> {
    let mut mesh = read(path)?;
    let warnings = materials::resolve(&mut mesh, path)?;
    Ok((mesh, warnings))
}

/// Reads a mesh from the bytes of an OBJ file, which messages call `name`.
///
/// Normals and texture coordinates are there if any corner of a face names one. Materials have names,
/// but are not known: they stand in other files.
///
/// # Errors
///
/// A statement that is wrong or means nothing, an index of something that is not defined, a file
/// without faces.
///
/// ```
/// use bothways_formats::obj;
///
/// let square = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// assert_eq!(obj::parse("square.obj", square)?.triangles(), [[0, 1, 2], [0, 2, 3]]);
///
/// let error = obj::parse("bad.obj", b"v 0 0 0\nv 1 0 O\n").unwrap_err();
/// assert_eq!(error.to_string(), r#"bad.obj:2: "O" is not a number"#);
/// # Ok::<(), obj::ReadObjError>(())
/// ```
pub fn parse(name: &str, bytes: &[u8]) -> Result<Mesh, ReadObjError> {
    if bytes.is_empty() {
        return Err(ReadObjError::Empty { file: name.to_owned() });
    }
    if bytes.len() as u64 > MOST_BYTES {
        return Err(ReadObjError::TooLarge { file: name.to_owned() });
    }
    let located = |line, fault| ReadObjError::Statement { file: name.to_owned(), line, fault };
    let mut reader = Reader::new(Parts::default(), None);
    for (line, words) in Statements::new(without_mark(bytes)) {
        reader.statement(line, words).map_err(|fault| located(line, fault))?;
    }
    finish(name.to_owned(), reader)
}

/// Checks what faces name, once everything is defined.
fn finish(file: String, reader: Reader<Parts>) -> Result<Mesh, ReadObjError> {
    if let Err((line, fault)) = reader.check_forward() {
        return Err(ReadObjError::Statement { file, line, fault });
    }
    if !reader.sink.has_triangles() {
        return Err(ReadObjError::NoFace { file });
    }
    Ok(reader.sink.finish())
}

/// Some editors put a byte order mark before the first line.
const MARK: &[u8] = b"\xef\xbb\xbf";

fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(MARK).unwrap_or(bytes)
}

/// The shortest definition, `vt 0` and a line end, has five bytes: so many bytes define fewer than
/// 2³² − 1 things of any kind, and every index that is valid fits into a `u32` other than `NONE`.
const MOST_BYTES: u64 = 1 << 34;

/// Says that a corner lacks something: [`Attribute::NONE`], whatever the values are.
const NONE: u32 = Attribute::<()>::NONE;

/// Who takes what the statements of a file define, in its order.
pub(super) trait Sink {
    fn position(&mut self, position: Vec3);
    fn texture_coordinate(&mut self, _value: Vec2) {}
    fn normal(&mut self, _normal: Vec3) {}
    fn triangle(&mut self, corners: [Corner; 3]);
    /// The material of the triangles from here on; `None` is no name.
    fn material(&mut self, _name: Option<String>) {}
    /// A file that defines materials.
    fn material_library(&mut self, _name: &str) {}
}

/// Takes up statement after statement, and checks what faces name.
pub(super) struct Reader<S> {
    sink: S,
    /// How many are defined so far, for each [`Element`].
    defined: [usize; 3],
    /// How many the whole file defines, if that is known.
    total: Option<[usize; 3]>,
    /// What faces name before it is defined, for each [`Element`], as long as no total is known.
    forward: [Vec<Forward>; 3],
}

/// A face that names something below itself.
#[derive(Clone, Copy)]
struct Forward {
    line: usize,
    index: i64,
}

/// One corner of a face: its vertex, texture coordinate and normal, counted from 0.
pub(super) type Corner = [u32; 3];

/// In the order in which a corner names them.
const ELEMENTS: [Element; 3] = [Element::Vertex, Element::TextureCoordinate, Element::Normal];

impl<S: Sink> Reader<S> {
    fn new(sink: S, total: Option<[usize; 3]>) -> Self {
        Reader { sink, defined: [0; 3], total, forward: Default::default() }
    }

    fn statement(&mut self, line: usize, mut words: Words) -> Result<(), StatementFault> {
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword {
            b"v" => {
                self.sink.position(numbers(words, Element::Vertex, 3)?.into());
                self.defined[Element::Vertex as usize] += 1;
            }
            b"vn" => {
                self.sink.normal(numbers(words, Element::Normal, 3)?.into());
                self.defined[Element::Normal as usize] += 1;
            }
            b"vt" => {
                let value: [f32; 2] = numbers(words, Element::TextureCoordinate, 1)?;
                self.sink.texture_coordinate(value.into());
                self.defined[Element::TextureCoordinate as usize] += 1;
            }
            // Version 2 of the format had a second keyword, which became the first.
            b"f" | b"fo" => self.face(line, words)?,
            b"usemtl" => self.sink.material(words.text()),
            b"mtllib" => words.text().iter().for_each(|name| self.sink.material_library(name)),
            _ if is_skipped(keyword) => {}
            _ if !is_text(keyword) => return Err(StatementFault::NotText),
            _ => return Err(StatementFault::UnknownKeyword { keyword: quote(keyword) }),
        }
        Ok(())
    }

    /// Adds the fan of one polygon.
    fn face(&mut self, line: usize, words: Words) -> Result<(), StatementFault> {
        let (mut first, mut before) = ([NONE; 3], [NONE; 3]);
        let mut corners = 0;
        for word in words {
            let corner = self.corner(line, word)?;
            match corners {
                0 => first = corner,
                1 => {}
                _ => self.sink.triangle([first, before, corner]),
            }
            before = corner;
            corners += 1;
        }
        if corners < 3 { Err(StatementFault::TooFewCorners { corners }) } else { Ok(()) }
    }

    fn corner(&mut self, line: usize, word: &[u8]) -> Result<Corner, StatementFault> {
        let wrong = || StatementFault::NotACorner { text: quote(word) };
        let mut corner = [NONE; 3];
        for (place, text) in word.split(|&byte| byte == b'/').enumerate() {
            // Some programs write `v/` and `v//` where others write `v`; a vertex must be named.
            if text.is_empty() && place != 0 && place < 3 {
                continue;
            }
            let element = *ELEMENTS.get(place).ok_or_else(wrong)?;
            let index = integer(text).ok_or_else(wrong)?;
            corner[place] = self.resolve(line, element, index)?;
        }
        Ok(corner)
    }

    /// Turns an index of the file into one that counts from 0.
    fn resolve(&mut self, line: usize, what: Element, index: i64) -> Result<u32, StatementFault> {
        let defined = self.defined[what as usize];
        // A slice is never longer than i64::MAX.
        let count = i64::try_from(defined).unwrap_or(i64::MAX);
        let from_zero = match index {
            0 => return Err(StatementFault::IndexZero { what }),
            1.. => index - 1,
            _ if index < -count => {
                return Err(StatementFault::UnknownAbove { what, index, defined });
            }
            _ => count + index,
        };
        match self.total.map(|total| total[what as usize]) {
            _ if index <= count => {}
            None => self.note_forward(what, Forward { line, index }),
            Some(defined) if is_within(index, defined) => {}
            Some(defined) => return Err(StatementFault::Unknown { what, index, defined }),
        }
        // An index that does not fit is larger than any that can be defined: the note refuses it.
        Ok(u32::try_from(from_zero).unwrap_or(NONE))
    }

    /// Keeps a forward reference if it reaches farther than all before it: the first one that turns
    /// out to reach too far does.
    fn note_forward(&mut self, what: Element, forward: Forward) {
        let noted = &mut self.forward[what as usize];
        if noted.last().is_none_or(|last| last.index < forward.index) {
            noted.push(forward);
        }
    }

    /// Finds the first face that names what is not defined below it either.
    fn check_forward(&self) -> Result<(), (usize, StatementFault)> {
        let unknown = ELEMENTS.into_iter().filter_map(|what| {
            let (defined, noted) = (self.defined[what as usize], &self.forward[what as usize]);
            let first = noted.iter().find(|noted| !is_within(noted.index, defined))?;
            Some((first.line, StatementFault::Unknown { what, index: first.index, defined }))
        });
        unknown.min_by_key(|&(line, _)| line).map_or(Ok(()), Err)
    }
}

/// Whether so many elements have one of this index, counted from 1.
fn is_within(index: i64, count: usize) -> bool {
    usize::try_from(index).is_ok_and(|index| index <= count)
}

/// The first `N` numbers of a statement, `needed` of which must be there; the others are 0.
fn numbers<const N: usize>(
    words: Words,
    what: Element,
    needed: usize,
) -> Result<[f32; N], StatementFault> {
    let mut values = [0.0; N];
    let mut found = 0;
    for word in words {
        let value = number(word)?;
        if let Some(place) = values.get_mut(found) {
            *place = value;
        }
        found += 1;
    }
    if found < needed {
        return Err(StatementFault::MissingCoordinates { what, needed, found });
    }
    Ok(values)
}

/// The nearest `f32`: rounding to `f64` first could miss it.
fn number(word: &[u8]) -> Result<f32, StatementFault> {
    let parsed = str::from_utf8(word).ok().and_then(|text| text.parse::<f32>().ok());
    match parsed {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) if word.iter().any(u8::is_ascii_digit) => {
            Err(StatementFault::OutOfRange { text: quote(word) })
        }
        Some(_) => Err(StatementFault::NotFinite { text: quote(word) }),
        None => Err(StatementFault::NotANumber { text: quote(word) }),
    }
}

fn integer(text: &[u8]) -> Option<i64> {
    str::from_utf8(text).ok()?.parse().ok()
}

fn is_text(word: &[u8]) -> bool {
    str::from_utf8(word).is_ok_and(|text| !text.contains(char::is_control))
}

/// Statements of the format that describe nothing to draw here, with those of its version 2.
fn is_skipped(keyword: &[u8]) -> bool {
    match keyword {
        // Names and groups.
        b"o" | b"g" | b"s" | b"mg" => true,
        // Maps and display.
        b"usemap" | b"maplib" | b"bevel" | b"c_interp" => true,
        b"d_interp" | b"lod" | b"shadow_obj" | b"trace_obj" | b"ctech" | b"stech" => true,
        // Points and lines.
        b"p" | b"l" => true,
        // Free-form curves and surfaces.
        b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf" => true,
        b"parm" | b"trim" | b"hole" | b"scrv" | b"sp" | b"end" | b"con" => true,
        // Patches of version 2.
        b"bsp" | b"bzp" | b"cdc" | b"cdp" | b"res" => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests;
