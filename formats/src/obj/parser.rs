//! The parser of OBJ files: from statements to positions, values and polygons with checked indices.

use super::error::{IndexKind, StatementFault};
use super::visitor::{Corner, Visitor};
use super::words::{Words, integer, is_text, number};
use crate::attributes::NONE;
use crate::source::quote::quote;

/// Parses statement after statement, checks the indices of faces, and calls a [`Visitor`].
pub(super) struct Parser<V> {
    pub(super) visitor: V,
    /// The number of definitions so far, for each [`IndexKind`].
    pub(super) defined: [usize; 3],
    /// The number of definitions in the whole file, if it is known.
    total: Option<[usize; 3]>,
    /// References to definitions further down, for each [`IndexKind`]; empty if the total is known.
    forward: [Vec<ForwardReference>; 3],
    /// The corners of a face while it is parsed.
    corners: Vec<Corner>,
}

/// A face that names something further down in the file.
#[derive(Clone, Copy)]
struct ForwardReference {
    line: usize,
    index: i64,
}

/// The kinds of index, in the order in which a corner has them.
pub(super) const INDEX_KINDS: [IndexKind; 3] =
    [IndexKind::Vertex, IndexKind::TextureCoordinate, IndexKind::Normal];

impl<V: Visitor> Parser<V> {
    /// A parser at the beginning of a file. `total` is the number of definitions in the whole file, for each
    /// [`IndexKind`], if it is known from an earlier pass.
    pub(super) fn new(visitor: V, total: Option<[usize; 3]>) -> Self {
        let (forward, corners) = Default::default();
        Parser { visitor, defined: [0; 3], total, forward, corners }
    }

    /// A parser behind so many definitions, for each [`IndexKind`].
    pub(super) fn behind(visitor: V, defined: [usize; 3]) -> Self {
        Parser { defined, ..Parser::new(visitor, None) }
    }

    /// Parses one statement, which begins on line `line`.
    pub(super) fn statement(
        &mut self,
        line: usize,
        mut words: Words,
    ) -> Result<(), StatementFault> {
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword {
            b"v" => {
                let (numbers, found) = numbers::<6>(words, IndexKind::Vertex, 3)?;
                self.vertex(numbers, found);
            }
            b"vn" => {
                self.visitor.normal(numbers::<3>(words, IndexKind::Normal, 3)?.0.into());
                self.defined[IndexKind::Normal as usize] += 1;
            }
            b"vt" => {
                let (value, _) = numbers::<2>(words, IndexKind::TextureCoordinate, 1)?;
                self.visitor.texture_coordinate(value.into());
                self.defined[IndexKind::TextureCoordinate as usize] += 1;
            }
            // Version 2 of the format had a second keyword for faces.
            b"f" | b"fo" => self.face(line, words)?,
            b"usemtl" => self.visitor.material(words.text()),
            b"mtllib" => words.text().iter().for_each(|name| self.visitor.material_library(name)),
            _ if is_skipped(keyword) => {}
            _ if !is_text(keyword) => return Err(StatementFault::NotText),
            _ => return Err(StatementFault::UnknownKeyword { keyword: quote(keyword) }),
        }
        Ok(())
    }

    /// Passes on a vertex, and its colour if there are six numbers.
    #[inline]
    pub(super) fn vertex(&mut self, [x, y, z, red, green, blue]: [f32; 6], found: usize) {
        self.visitor.position([x, y, z].into());
        if found == 6 {
            self.visitor.color([red, green, blue].into());
        }
        self.defined[IndexKind::Vertex as usize] += 1;
    }

    /// Passes on a polygon.
    fn face(&mut self, line: usize, words: Words) -> Result<(), StatementFault> {
        self.corners.clear();
        for word in words {
            let corner = self.corner(line, word)?;
            self.corners.push(corner);
        }
        match self.corners.len() {
            corners @ 0..3 => Err(StatementFault::TooFewCorners { corners }),
            _ => {
                self.visitor.polygon(&self.corners);
                Ok(())
            }
        }
    }

    fn corner(&mut self, line: usize, word: &[u8]) -> Result<Corner, StatementFault> {
        let wrong = || StatementFault::NotACorner { text: quote(word) };
        let mut corner = [NONE; 3];
        for (position, text) in word.split(|&byte| byte == b'/').enumerate() {
            // Some programs write `v/` and `v//` where others write `v`. The vertex must be there.
            if text.is_empty() && position != 0 && position < 3 {
                continue;
            }
            let kind = *INDEX_KINDS.get(position).ok_or_else(wrong)?;
            let index = integer(text).ok_or_else(wrong)?;
            corner[position] = self.resolve(line, kind, index)?;
        }
        Ok(corner)
    }

    /// Turns an index as the file writes it into one that counts from 0.
    pub(super) fn resolve(
        &mut self,
        line: usize,
        kind: IndexKind,
        index: i64,
    ) -> Result<u32, StatementFault> {
        let defined = self.defined[kind as usize];
        // No file has as many definitions as i64::MAX.
        let count = i64::try_from(defined).unwrap_or(i64::MAX);
        let from_zero = match index {
            0 => return Err(StatementFault::IndexZero { kind }),
            1.. => index - 1,
            _ if index < -count => {
                return Err(StatementFault::UnknownAbove { kind, index, defined });
            }
            _ => count + index,
        };
        match self.total.map(|total| total[kind as usize]) {
            _ if index <= count => {}
            None => self.note_forward(kind, ForwardReference { line, index }),
            Some(defined) if is_within(index, defined) => {}
            Some(defined) => return Err(StatementFault::Unknown { kind, index, defined }),
        }
        // An index that does not fit is larger than any number of definitions: `check_forward` refuses it.
        Ok(u32::try_from(from_zero).unwrap_or(NONE))
    }

    /// Adds what the parser of the next piece of the file found, which began with the number of definitions so far.
    pub(super) fn follow(&mut self, piece: Parser<impl Visitor>) {
        self.defined = piece.defined;
        for (kind, forward) in INDEX_KINDS.into_iter().zip(piece.forward) {
            forward.into_iter().for_each(|forward| self.note_forward(kind, forward));
        }
    }

    /// Keeps a forward reference if its index is larger than those of all references before it. The first
    /// reference that turns out to be wrong is always among them.
    fn note_forward(&mut self, kind: IndexKind, forward: ForwardReference) {
        let noted = &mut self.forward[kind as usize];
        if noted.last().is_none_or(|last| last.index < forward.index) {
            noted.push(forward);
        }
    }

    /// Finds the first face whose reference is not defined further down either; called at the end of the file.
    pub(super) fn check_forward(&self) -> Result<(), (usize, StatementFault)> {
        let unknown = INDEX_KINDS.into_iter().filter_map(|kind| {
            let (defined, noted) = (self.defined[kind as usize], &self.forward[kind as usize]);
            let first = noted.iter().find(|noted| !is_within(noted.index, defined))?;
            Some((first.line, StatementFault::Unknown { kind, index: first.index, defined }))
        });
        unknown.min_by_key(|&(line, _)| line).map_or(Ok(()), Err)
    }
}

/// Tells whether `count` definitions include one with this index, counted from 1.
fn is_within(index: i64, count: usize) -> bool {
    usize::try_from(index).is_ok_and(|index| index <= count)
}

/// Reads the first `N` numbers of a statement, and tells how many there are. At least `needed` must be there; the others are
/// 0. All words after them must be numbers, too.
fn numbers<const N: usize>(
    words: Words,
    kind: IndexKind,
    needed: usize,
) -> Result<([f32; N], usize), StatementFault> {
    let mut values = [0.0; N];
    let mut found = 0;
    for word in words {
        let value = number(word)?;
        if let Some(slot) = values.get_mut(found) {
            *slot = value;
        }
        found += 1;
    }
    if found < needed {
        return Err(StatementFault::MissingCoordinates { kind, needed, found });
    }
    Ok((values, found))
}

/// Tells whether a statement of the format, of version 2 too, describes nothing that is drawn here.
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
