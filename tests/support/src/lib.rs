//! Shared code for the tests of several packages: small scenes, cameras, observers and comparisons.
//!
//! A caller's mistake panics, as in any test. This package depends on `common` alone. Shared code that needs both
//! orders is next to the tests that use it, in `tests/contract/four_renderers.rs`.

mod cameras;
mod crowds;
mod dice;
mod frames;
pub mod hostile;
mod observers;
pub mod repeats;
mod scenes;
mod shading;

pub use cameras::*;
pub use crowds::*;
pub use dice::*;
pub use frames::*;
pub use observers::*;
pub use scenes::*;
pub use shading::*;

/// The number of cases of a property test: fifty times as many with `BOTHWAYS_LONG` set.
pub fn cases(usual: u32) -> u32 {
    if std::env::var_os("BOTHWAYS_LONG").is_some() { usual * 50 } else { usual }
}
