//! Reads the facets of a binary STL file.

use super::error::{ReadStlError, StlFault};
use super::layout::FACET;
use glam::Vec3;
use std::io::{ErrorKind, Read};

/// Visits the corners of all facets, from the first on.
pub(super) fn read(
    file: &str,
    mut input: impl Read,
    visit: &mut impl FnMut([Vec3; 3]) -> Result<(), StlFault>,
) -> Result<(), ReadStlError> {
    let mut bytes = [0; FACET];
    for facet in 0.. {
        match input.read_exact(&mut bytes) {
            Ok(()) => {}
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => break,
            Err(error) => return Err(ReadStlError::Unreadable { file: file.to_owned(), error }),
        }
        // The first twelve bytes are the normal.
        let numbers: [f32; 9] = std::array::from_fn(|k| {
            let at = 12 + 4 * k;
            f32::from_bits(u32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[at + byte])))
        });
        let located = |fault| ReadStlError::Facet { file: file.to_owned(), facet, fault };
        if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
            return Err(located(StlFault::NotFinite { text: number.to_string() }));
        }
        let corners = [0, 3, 6].map(|k| Vec3::new(numbers[k], numbers[k + 1], numbers[k + 2]));
        visit(corners).map_err(located)?;
    }
    Ok(())
}
