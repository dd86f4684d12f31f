//! An OBJ file that is read from its beginning to its end several times, a statement at a time,
//! so that it need not fit into memory.

use super::error::{Element, ReadObjError, StatementFault};
use super::lines::{BufferedStatements, Words};
use super::{Corner, MARK, MaterialWarning, Reader, Sink, is_text};
use crate::source::{READ_AT_ONCE, regular_file};
use glam::Vec3;
use std::fs::File;
use std::io::{BufRead, BufReader, Seek};
use std::path::Path;

/// The longest statement that is read: a polygon of some million corners.
const MOST_BYTES_A_STATEMENT: usize = 1 << 24;

/// An OBJ file, and what its first pass found.
#[derive(Debug)]
pub(crate) struct ObjFile {
    name: String,
    input: BufReader<File>,
    /// How many the file defines, for each [`Element`].
    total: [usize; 3],
    names_materials: bool,
}

/// Takes positions, or triangles, and leaves the rest.
struct Visit<V, T> {
    vertex: V,
    triangle: T,
    names_materials: bool,
}

impl<V, T> Visit<V, T> {
    fn new(vertex: V, triangle: T) -> Self {
        Visit { vertex, triangle, names_materials: false }
    }
}

impl<V: FnMut(Vec3), T: FnMut([u32; 3])> Sink for Visit<V, T> {
    fn position(&mut self, position: Vec3) {
        (self.vertex)(position);
    }

    fn triangle(&mut self, corners: [Corner; 3]) {
        (self.triangle)(corners.map(|[vertex, _, _]| vertex));
    }

    fn material(&mut self, name: Option<String>) {
        self.names_materials |= name.is_some();
    }
}

impl ObjFile {
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

    /// The first pass: visits all vertices and counts what there is. Faces wait for the second, which
    /// knows then whether what they name is defined anywhere.
    pub(crate) fn vertices(&mut self, visit: impl FnMut(Vec3)) -> Result<(), ReadObjError> {
        let mut reader = Reader::new(Visit::new(visit, |_| ()), None);
        let read = |line, words: Words| match words.clone().next() {
            Some(b"f" | b"fo") => Ok(()),
            _ => {
                reader.statement(line, words)?;
                check_count(reader.defined[Element::Vertex as usize])
            }
        };
        let statements = self.statements(read)?;
        self.total = reader.defined;
        self.names_materials = reader.sink.names_materials;
        if statements == 0 { Err(ReadObjError::Empty { file: self.name.clone() }) } else { Ok(()) }
    }

    /// That the file names materials, if the first pass has found so: no pass reads them.
    pub(crate) fn material_warning(&self) -> Option<MaterialWarning> {
        self.names_materials.then(|| MaterialWarning::Streamed { file: self.name.clone() })
    }

    /// A later pass: visits all triangles in file order, each with three indices of vertices that the
    /// first pass has visited.
    pub(crate) fn triangles(
        &mut self,
        mut visit: impl FnMut([u32; 3]),
    ) -> Result<(), ReadObjError> {
        let mut found = false;
        let triangle = |corners| {
            found = true;
            visit(corners);
        };
        let mut reader = Reader::new(Visit::new(|_| (), triangle), Some(self.total));
        self.statements(|line, words| reader.statement(line, words))?;
        if found { Ok(()) } else { Err(ReadObjError::NoFace { file: self.name.clone() }) }
    }

    /// How many bytes the file has.
    pub(super) fn length(&self) -> Result<u64, ReadObjError> {
        let unreadable = |error| ReadObjError::Unreadable { file: self.name.clone(), error };
        Ok(self.input.get_ref().metadata().map_err(unreadable)?.len())
    }

    /// Takes up all statements from the first on, and gives their number.
    pub(super) fn statements(
        &mut self,
        mut statement: impl FnMut(usize, Words) -> Result<(), StatementFault>,
    ) -> Result<usize, ReadObjError> {
        let ObjFile { name, input, .. } = self;
        let unreadable = |error| ReadObjError::Unreadable { file: name.clone(), error };
        input.rewind().map_err(unreadable)?;
        if input.fill_buf().map_err(unreadable)?.starts_with(MARK) {
            input.consume(MARK.len());
        }
        let located = |line, fault| ReadObjError::Statement { file: name.clone(), line, fault };
        let mut statements = BufferedStatements::new(input);
        let mut count = 0;
        while let Some((line, words)) =
            statements.next(MOST_BYTES_A_STATEMENT).map_err(unreadable)?
        {
            if words.length() > MOST_BYTES_A_STATEMENT {
                let fault = match words.clone().next() {
                    Some(word) if !is_text(word) => StatementFault::NotText,
                    _ => StatementFault::TooLong { most: MOST_BYTES_A_STATEMENT },
                };
                return Err(located(line, fault));
            }
            statement(line, words).map_err(|fault| located(line, fault))?;
            count += 1;
        }
        Ok(count)
    }
}

/// Every index that is valid fits into a `u32`, and is not the largest.
fn check_count(vertices: usize) -> Result<(), StatementFault> {
    if u32::try_from(vertices).is_ok_and(|vertices| vertices < u32::MAX) {
        Ok(())
    } else {
        Err(StatementFault::TooManyVertices)
    }
}
