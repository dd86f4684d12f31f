//! The sizes of a binary file's parts, which tell it from others.

/// The bytes of a binary file before its first facet.
pub(super) const HEADER: usize = 84;
/// The bytes of each facet.
pub(super) const FACET: usize = 50;

/// The first bytes of a file, which tell a binary one from text.
pub(super) const BEGINNING: u64 = 1 << 10;

/// The size of a binary file of so many facets.
pub(super) fn binary_size(facets: u32) -> u64 {
    HEADER as u64 + FACET as u64 * u64::from(facets)
}

/// The number of facets that a binary file promises.
pub(super) fn promised(beginning: &[u8]) -> Option<u32> {
    Some(u32::from_le_bytes(*beginning.get(80..84)?.first_chunk()?))
}

/// Tells whether a file that begins with these bytes and has this size is binary.
pub(crate) fn is_binary(beginning: &[u8], size: u64) -> bool {
    promised(beginning).is_some_and(|facets| size == binary_size(facets))
}
