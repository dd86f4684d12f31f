//! The sizes of a binary file's parts.

/// The bytes of a binary file before its first facet.
pub(super) const HEADER: usize = 84;
/// The bytes of each facet.
pub(super) const FACET: usize = 50;

/// The size of a binary file of so many facets.
pub(super) fn binary_size(facets: u32) -> u64 {
    HEADER as u64 + FACET as u64 * u64::from(facets)
}
