//! Compiles the module, and lets `wasm-bindgen` write the JavaScript around it.
//!
//! A second cargo does it, in a target folder of its own. (It must not be a build script's: that cargo would wait for the
//! folder that the first one holds, forever.)

use crate::failure::Failure;
use crate::sources::Sources;
use serde::Deserialize;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use wasm_bindgen_cli_support::Bindgen;

const TARGET: &str = "wasm32-unknown-unknown";
const PACKAGE: &str = "bothways-web-module";
/// Vectors, and a stack as large as a thread of a native program has: readers of files are recursive.
const FLAGS: [&str; 2] = ["-Ctarget-feature=+simd128", "-Clink-arg=-zstack-size=8388608"];

/// With this variable in the environment the functions keep their names, for profilers.
const KEEP_NAMES: &str = "BOTHWAYS_KEEP_NAMES";

/// The module, and what calls it.
#[derive(Debug)]
pub(crate) struct Module {
    /// WebAssembly.
    pub(crate) wasm: Vec<u8>,
    /// JavaScript that defines `wasm_bindgen`.
    pub(crate) glue: String,
}

/// Compiles the module.
pub(crate) fn build(sources: &Sources) -> Result<Module, Failure> {
    check_target()?;
    let compiled = compile(sources)?;
    bind(&compiled)
}

/// The programs of the toolchain, as cargo names them to the programs that it runs.
fn tool(variable: &str, name: &str) -> OsString {
    std::env::var_os(variable).unwrap_or_else(|| name.into())
}

/// Makes sure that the target is installed: without it, the compiler says of every crate that it cannot find `core`.
fn check_target() -> Result<(), Failure> {
    let rustc = tool("RUSTC", "rustc");
    let mut command = Command::new(&rustc);
    command.args(["--print", "target-libdir", "--target", TARGET]);
    let output = command.output().map_err(|error| not_started(&rustc, error))?;
    let folder = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
    let is_core = |name: &str| name.starts_with("libcore-");
    let mut files = folder.read_dir().into_iter().flatten().flatten();
    match files.any(|file| file.file_name().to_str().is_some_and(is_core)) {
        true => Ok(()),
        false => Err(Failure::NoTarget),
    }
}

/// Runs cargo, and returns the file that it wrote.
fn compile(sources: &Sources) -> Result<PathBuf, Failure> {
    let cargo = tool("CARGO", "cargo");
    let target = tool("CARGO_TARGET_DIR", "target");
    let mut command = Command::new(&cargo);
    command
        .current_dir(sources.root())
        .args(["rustc", "--locked", "--package", PACKAGE, "--lib", "--crate-type", "cdylib"])
        .args(["--profile", "web", "--target", TARGET, "--message-format=json-render-diagnostics"])
        .arg("--target-dir")
        .arg(PathBuf::from(target).join("web"))
        .env("CARGO_ENCODED_RUSTFLAGS", FLAGS.join("\u{1f}"))
        .env_remove("RUSTFLAGS")
        .stdin(Stdio::null())
        .stderr(Stdio::inherit());
    let output = command.output().map_err(|error| not_started(&cargo, error))?;
    if !output.status.success() {
        return Err(Failure::NotCompiled);
    }
    let said = String::from_utf8_lossy(&output.stdout);
    let file = said.lines().find_map(wasm_file);
    file.ok_or_else(|| Failure::NoModule { said: said.into_owned() })
}

fn not_started(program: &OsString, error: std::io::Error) -> Failure {
    Failure::NotStarted { program: program.display().to_string(), error }
}

/// The file of WebAssembly in a line of cargo's messages, if it has one.
fn wasm_file(line: &str) -> Option<PathBuf> {
    #[derive(Deserialize)]
    struct Message {
        #[serde(default)]
        filenames: Vec<PathBuf>,
    }
    let message: Message = serde_json::from_str(line).ok()?;
    message.filenames.into_iter().find(|file| file.extension().is_some_and(|end| end == "wasm"))
}

/// Lets `wasm-bindgen` write classic JavaScript, which runs in a worker that is made from a text.
fn bind(compiled: &PathBuf) -> Result<Module, Failure> {
    let bound = || {
        let mut bindgen = Bindgen::new();
        bindgen.input_path(compiled).no_modules(true)?.typescript(false).demangle(false);
        bindgen
            .remove_name_section(std::env::var_os(KEEP_NAMES).is_none())
            .remove_producers_section(true);
        bindgen.omit_default_module_path(true);
        bindgen.generate_output()
    };
    let mut output = bound().map_err(|error| Failure::Bindgen { reason: format!("{error:#}") })?;
    Ok(Module { glue: output.js().to_owned(), wasm: output.wasm_mut().emit_wasm() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_module_is_found_in_the_messages_of_cargo() {
        let line = r#"{"reason":"compiler-artifact","filenames":["/t/a.rlib","/t/b.wasm"]}"#;
        assert_eq!(wasm_file(line), Some("/t/b.wasm".into()));
        assert_eq!(wasm_file(r#"{"reason":"build-finished","success":true}"#), None);
        assert_eq!(wasm_file("warning: unused"), None);
    }
}
