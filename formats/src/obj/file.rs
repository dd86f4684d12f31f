//! An OBJ or MTL file on disk, read in passes from its beginning to its end, one statement at a time. It does not
//! need to fit into memory.

use super::error::{IndexKind, ReadObjError, StatementFault};
use super::parser::Parser;
use super::statements::{BufferedStatements, MOST_BYTES_A_STATEMENT, check_length};
use super::visitor::{Corner, Visitor};
use super::words::Words;
use crate::polygon::Cutter;
use crate::source::{BYTE_ORDER_MARK, READ_AT_ONCE, regular_file};
use crate::warning::MaterialWarning;
use bothways_common::scene::Positions;
use glam::Vec3;
use std::fs::File;
use std::io::{BufRead, BufReader, Seek};
use std::path::Path;

/// An open OBJ or MTL file, and what the first pass over it found.
#[derive(Debug)]
pub(crate) struct ObjFile {
    name: String,
    input: BufReader<File>,
    /// The number of definitions in the file, for each [`IndexKind`].
    total: [usize; 3],
    names_materials: bool,
}

/// Passes positions and polygons on, and ignores everything else.
struct GeometryOnly<V, P> {
    vertex: V,
    polygon: P,
    names_materials: bool,
}

impl<V, P> GeometryOnly<V, P> {
    fn new(vertex: V, polygon: P) -> Self {
        GeometryOnly { vertex, polygon, names_materials: false }
    }
}

impl<V: FnMut(Vec3), P: FnMut(&[Corner])> Visitor for GeometryOnly<V, P> {
    fn position(&mut self, position: Vec3) {
        (self.vertex)(position);
    }

    fn polygon(&mut self, corners: &[Corner]) {
        (self.polygon)(corners);
    }

    fn material(&mut self, name: Option<String>) {
        self.names_materials |= name.is_some();
    }
}

impl ObjFile {
    /// Opens a file that can be read several times.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadObjError> {
        let name = path.display().to_string();
        match regular_file(path) {
            Ok(file) => {
                let input = BufReader::with_capacity(READ_AT_ONCE, file);
                Ok(ObjFile { name, input, total: [0; 3], names_materials: false })
            }
            Err(error) => Err(ReadObjError::Unreadable { file: name, error }),
        }
    }

    /// The first pass: visits all vertices and counts all definitions. It skips faces: the next pass knows which
    /// indices are defined.
    pub(crate) fn vertices(&mut self, visit: impl FnMut(Vec3)) -> Result<(), ReadObjError> {
        let mut parser = Parser::new(GeometryOnly::new(visit, |_: &[Corner]| ()), None);
        let read = |line, words: Words| match words.clone().next() {
            Some(b"f" | b"fo") => Ok(()),
            _ => {
                parser.statement(line, words)?;
                check_count(parser.defined[IndexKind::Vertex as usize])
            }
        };
        let statements = self.statements(read)?;
        self.total = parser.defined;
        self.names_materials = parser.visitor.names_materials;
        if statements == 0 { Err(ReadObjError::Empty { file: self.name.clone() }) } else { Ok(()) }
    }

    /// A warning if the first pass has found that the file names materials: no pass reads them.
    pub(crate) fn material_warning(&self) -> Option<MaterialWarning> {
        self.names_materials.then(|| MaterialWarning::Streamed { file: self.name.clone() })
    }

    /// A later pass: visits all triangles in file order. Their indices are those of vertices that the first pass
    /// has visited, at these positions.
    pub(crate) fn triangles(
        &mut self,
        positions: &Positions,
        mut visit: impl FnMut([u32; 3]),
    ) -> Result<(), ReadObjError> {
        let (mut found, mut cutter) = (false, Cutter::default());
        let polygon = |corners: &[Corner]| {
            found = true;
            let position = |[vertex, _, _]: Corner| positions.get(vertex);
            cutter.visit(corners, position, |of| visit(of.map(|[vertex, _, _]| vertex)));
        };
        let mut parser = Parser::new(GeometryOnly::new(|_| (), polygon), Some(self.total));
        self.statements(|line, words| parser.statement(line, words))?;
        if found { Ok(()) } else { Err(ReadObjError::NoFaces { file: self.name.clone() }) }
    }

    /// The file itself, from its beginning on.
    pub(super) fn unread(self) -> Result<File, ReadObjError> {
        let ObjFile { name, mut input, .. } = self;
        match input.rewind() {
            Ok(()) => Ok(input.into_inner()),
            Err(error) => Err(ReadObjError::Unreadable { file: name, error }),
        }
    }

    /// The number of bytes in the file.
    pub(super) fn length(&self) -> Result<u64, ReadObjError> {
        let unreadable = |error| ReadObjError::Unreadable { file: self.name.clone(), error };
        Ok(self.input.get_ref().metadata().map_err(unreadable)?.len())
    }

    /// Calls `visit` with the line and the words of every statement, from the first on, and returns the number of
    /// statements.
    pub(super) fn statements(
        &mut self,
        mut visit: impl FnMut(usize, Words) -> Result<(), StatementFault>,
    ) -> Result<usize, ReadObjError> {
        let ObjFile { name, input, .. } = self;
        let unreadable = |error| ReadObjError::Unreadable { file: name.clone(), error };
        input.rewind().map_err(unreadable)?;
        if input.fill_buf().map_err(unreadable)?.starts_with(BYTE_ORDER_MARK) {
            input.consume(BYTE_ORDER_MARK.len());
        }
        let located = |line, fault| ReadObjError::Statement { file: name.clone(), line, fault };
        let mut statements = BufferedStatements::new(input);
        let mut count = 0;
        while let Some((line, words)) =
            statements.next(MOST_BYTES_A_STATEMENT).map_err(unreadable)?
        {
            check_length(&words)
                .and_then(|()| visit(line, words))
                .map_err(|fault| located(line, fault))?;
            count += 1;
        }
        Ok(count)
    }
}

/// Makes sure that every valid index fits into a `u32` and is not the largest one.
fn check_count(vertices: usize) -> Result<(), StatementFault> {
    if u32::try_from(vertices).is_ok_and(|vertices| vertices < u32::MAX) {
        Ok(())
    } else {
        Err(StatementFault::TooManyVertices)
    }
}
