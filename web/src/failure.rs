//! Why the page could not be built, and what to do.

use std::io;
use std::path::PathBuf;

/// Why the page could not be built.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// The command line.
    #[error("{what}; --help lists them")]
    Arguments {
        /// What is wrong.
        what: String,
    },
    /// A file of the repository, or a folder.
    #[error(
        "{}: {error}; the page is built from the repository: run 'cargo run --release -p bothways-web' in a clone of it",
        .path.display()
    )]
    Source {
        /// The file.
        path: PathBuf,
        /// Why it cannot be read.
        error: io::Error,
    },
    /// The toolchain cannot compile for WebAssembly.
    #[error(
        "this Rust cannot compile for WebAssembly yet: its target wasm32-unknown-unknown is not installed; run \
         'rustup target add wasm32-unknown-unknown', and then this again"
    )]
    NoTarget,
    /// A program does not start.
    #[error("{program} does not start: {error}; run this by 'cargo run --release -p bothways-web'")]
    NotStarted {
        /// The program.
        program: String,
        /// Why.
        error: io::Error,
    },
    /// The compiler has said why.
    #[error("the module does not compile: see above")]
    NotCompiled,
    /// The compiler succeeded without the file.
    #[error("cargo names no file for the module; it said:\n{said}")]
    NoModule {
        /// What it said.
        said: String,
    },
    /// `wasm-bindgen` refuses the module.
    #[error("wasm-bindgen cannot use the module: {reason}")]
    Bindgen {
        /// Why, with all causes.
        reason: String,
    },
    /// The module cannot be read.
    #[error("the module cannot be checked: {0}")]
    Unreadable(#[from] wasmparser::BinaryReaderError),
    /// The module has no vector instructions.
    #[error(
        "the module has no vector instructions, and would be too slow; the builder asks for +simd128, so something \
         else decides how cargo compiles: look for rustflags in the configuration of cargo"
    )]
    NoVectors,
    /// The module has instructions whose results depend on the machine.
    #[error(
        "the module has {count} relaxed vector instructions, whose results depend on the machine: pictures would no \
         longer be equal everywhere; compile it without relaxed-simd"
    )]
    Relaxed {
        /// How many.
        count: u64,
    },
    /// A built-in scene cannot be drawn.
    #[error("the still picture cannot be drawn: {reason}")]
    Still {
        /// Why.
        reason: String,
    },
    /// A file of the page has something that a page in one file cannot have.
    #[error("{}: {what}", .path.display())]
    Page {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// The page cannot be written.
    #[error("{}: {error}; choose another file with -o", .path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
}
