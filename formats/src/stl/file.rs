//! An STL file, read in passes, one facet at a time. It does not need to fit into memory.

use super::builder::Places;
use super::error::{ReadStlError, StlFault};
use super::layout::{BEGINNING, HEADER, is_binary, promised};
use super::{ascii, binary};
use crate::source::{READ_AT_ONCE, regular_file};
use glam::Vec3;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// An open STL file, to be read in any number of passes.
#[derive(Debug)]
pub(crate) struct StlFile<R> {
    name: String,
    input: R,
    is_binary: bool,
    /// The vertices of a stream: facets have none in common, so they are found by their place.
    places: Places,
}

impl StlFile<BufReader<File>> {
    /// Opens a file that can be read several times.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadStlError> {
        let file = path.display().to_string();
        match regular_file(path) {
            Ok(opened) => StlFile::new(file, BufReader::with_capacity(READ_AT_ONCE, opened)),
            Err(error) => Err(ReadStlError::Unreadable { file, error }),
        }
    }
}

impl<R: BufRead + Seek> StlFile<R> {
    /// Finds out which form the file has.
    pub(super) fn new(name: String, mut input: R) -> Result<Self, ReadStlError> {
        let unreadable = |error| ReadStlError::Unreadable { file: name.clone(), error };
        let size = input.seek(SeekFrom::End(0)).map_err(unreadable)?;
        input.rewind().map_err(unreadable)?;
        let mut beginning = Vec::new();
        input.by_ref().take(BEGINNING).read_to_end(&mut beginning).map_err(unreadable)?;
        let (is_binary, begins) = (is_binary(&beginning, size), ascii::begins(&beginning));
        if beginning.is_empty() {
            Err(ReadStlError::Empty { file: name })
        } else if is_binary || (begins && !beginning.contains(&0)) {
            Ok(StlFile { name, input, is_binary, places: Places::default() })
        } else {
            // Binary files may begin with the same word. All have zeros soon: in their number of facets, and behind each.
            Err(ReadStlError::Neither { file: name, begins, size, facets: promised(&beginning) })
        }
    }

    /// Visits the corners of all facets, in the order of the file.
    pub(super) fn facets(
        &mut self,
        mut visit: impl FnMut([Vec3; 3]) -> Result<(), StlFault>,
    ) -> Result<(), ReadStlError> {
        StlFile::<R>::read(&self.name, &mut self.input, self.is_binary, &mut visit)
    }

    fn read(
        name: &str,
        input: &mut R,
        is_binary: bool,
        visit: &mut impl FnMut([Vec3; 3]) -> Result<(), StlFault>,
    ) -> Result<(), ReadStlError> {
        let begin = if is_binary { HEADER as u64 } else { 0 };
        let found = input.seek(SeekFrom::Start(begin));
        found.map_err(|error| ReadStlError::Unreadable { file: name.to_owned(), error })?;
        if is_binary { binary::read(name, input, visit) } else { ascii::read(name, input, visit) }
    }

    /// Visits all vertices, and keeps their places. This reads the whole file.
    pub(crate) fn vertices(&mut self, mut visit: impl FnMut(Vec3)) -> Result<(), ReadStlError> {
        let StlFile { name, input, is_binary, places } = self;
        StlFile::read(name, input, *is_binary, &mut |corners| {
            places.triangle(corners, &mut visit).map(drop)
        })?;
        if places.is_empty() { Err(ReadStlError::NoFacets { file: name.clone() }) } else { Ok(()) }
    }

    /// Visits all triangles in the order of the file, after the vertices.
    pub(crate) fn triangles(
        &mut self,
        mut visit: impl FnMut([u32; 3]),
    ) -> Result<(), ReadStlError> {
        let StlFile { name, input, is_binary, places } = self;
        StlFile::read(name, input, *is_binary, &mut |corners| places.known(corners).map(&mut visit))
    }
}
