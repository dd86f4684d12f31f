//! What the tests of several packages share: small scenes, cameras, observers and comparisons.
//!
//! A caller's mistake panics, as in any test. The package knows `common` alone. What needs both orders lies beside the tests that use it, in
//! `tests/contract/four_renderers.rs`.

mod cameras;
mod dice;
mod frames;
pub mod hostile;
mod observers;
pub mod repeats;
mod scenes;

pub use cameras::*;
pub use dice::*;
pub use frames::*;
pub use observers::*;
pub use scenes::*;

/// How many cases a property test tries: fifty times as many with `BOTHWAYS_LONG` set.
pub fn cases(usual: u32) -> u32 {
    if std::env::var_os("BOTHWAYS_LONG").is_some() { usual * 50 } else { usual }
}
