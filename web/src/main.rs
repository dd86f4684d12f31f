//! Builds the lecture page: both orders, live, in one HTML file that opens from disk.
//!
//! ```sh
//! cargo run --release -p bothways-web              # writes out/lecture.html
//! cargo run --release -p bothways-web -- -o FILE
//! ```
//!
//! 1. [`module`] compiles `web/module` to WebAssembly, by a second cargo with a folder of its own, and lets `wasm-bindgen` write
//!    the JavaScript around it.
//! 2. [`instructions`] makes sure that the module has vector instructions, and none of the relaxed ones.
//! 3. [`stills`] draws the two pictures that stand on the page before any script has run.
//! 4. [`page`] puts all of it and the files of `web/page` into one text, with a Content-Security-Policy that allows just
//!    these scripts and this style.
//! 5. [`output`] writes it under a temporary name and renames it.

mod failure;
mod instructions;
mod module;
mod output;
mod page;
mod sources;
mod stills;

use failure::Failure;
use sources::Sources;
use std::path::PathBuf;
use std::process::ExitCode;

const USAGE: &str = "\
Builds the lecture page of bothways: one HTML file that opens from disk, without a server.

Usage: cargo run --release -p bothways-web [-- -o FILE]

Options:
  -o FILE     where to write the page [default: out/lecture.html]
  -h, --help  print this text";

fn main() -> ExitCode {
    match run() {
        Ok(said) => {
            println!("{said}");
            ExitCode::SUCCESS
        }
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::from(2)
        }
    }
}

/// Builds the page, and returns what is said about it.
fn run() -> Result<String, Failure> {
    let Some(out) = arguments(std::env::args().skip(1))? else { return Ok(USAGE.into()) };
    let sources = Sources::find()?;
    let module = module::build(&sources)?;
    let vectors = instructions::check(&module.wasm)?;
    let html = page::assemble(&sources, &module, &stills::draw()?)?;
    output::write(&out, &html)?;
    Ok(format!(
        "{}: {} KB, {} KB of them WebAssembly with {vectors} vector instructions; open it in a browser",
        out.display(),
        html.len() / 1000,
        module.wasm.len() / 1000,
    ))
}

/// The file to write; `None` if help is asked for.
fn arguments(mut given: impl Iterator<Item = String>) -> Result<Option<PathBuf>, Failure> {
    let mut out = PathBuf::from("out/lecture.html");
    while let Some(argument) = given.next() {
        match argument.as_str() {
            "-h" | "--help" => return Ok(None),
            "-o" => match given.next().filter(|file| !file.is_empty()) {
                Some(file) => out = file.into(),
                None => {
                    return Err(Failure::Arguments { what: "-o needs the name of a file".into() });
                }
            },
            other => {
                return Err(Failure::Arguments { what: format!("there is no argument {other:?}") });
            }
        }
    }
    Ok(Some(out))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_few() {
        let of = |words: &[&str]| arguments(words.iter().map(|&word| word.to_owned()));
        assert_eq!(of(&[]).unwrap(), Some("out/lecture.html".into()));
        assert_eq!(of(&["-o", "a.html"]).unwrap(), Some("a.html".into()));
        assert_eq!(of(&["--help"]).unwrap(), None);
        let says = of(&["a.html"]).unwrap_err().to_string();
        assert_eq!(says, "there is no argument \"a.html\"; --help lists them");
        assert_eq!(
            of(&["-o"]).unwrap_err().to_string(),
            "-o needs the name of a file; --help lists them"
        );
    }
}
