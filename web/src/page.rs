//! Puts everything into one HTML file.
//!
//! `index.html` has four sorts of places: `{{csp}}` for the Content-Security-Policy, `{{still-object}}` and
//! `{{still-image}}` for the addresses of pictures, a comment `style` and a comment `script`. Scripts and styles are concatenated
//! in the order of their `order.txt`. The module and the worker's script are data, which no browser runs, until the page
//! makes a worker of them.

use crate::failure::Failure;
use crate::module::Module;
use crate::sources::Sources;
use crate::stills::Stills;
use base64::prelude::{BASE64_STANDARD, Engine};
use flate2::Compression;
use flate2::write::GzEncoder;
use sha2::{Digest, Sha256};
use std::io::Write;

/// The page.
pub(crate) fn assemble(
    sources: &Sources,
    module: &Module,
    stills: &Stills,
) -> Result<String, Failure> {
    let style = concatenated(&sources.in_order("style")?);
    let mut scripts = sources.in_order("js")?;
    let worker = ("worker.js".to_owned(), sources.read("worker.js")?);
    for (name, text) in scripts.iter().chain([&worker]) {
        check_script(sources, name, text)?;
    }
    scripts.insert(0, (String::new(), "(() => {\n\"use strict\";\n".into()));
    scripts.push((String::new(), "})();\n".into()));
    let script = concatenated(&scripts);
    let worker = format!("{}\n{}", module.glue, worker.1);
    let data =
        |id: &str, text: &str| format!("<script type=\"text/plain\" id=\"{id}\">{text}</script>\n");
    let png = |bytes: &[u8]| format!("data:image/png;base64,{}", BASE64_STANDARD.encode(bytes));
    let script_part = [
        data("bothways-worker", &worker),
        data("bothways-module", &BASE64_STANDARD.encode(compressed(&module.wasm))),
        format!("<script>{script}</script>"),
    ];
    let mut page = sources.read("index.html")?;
    for (place, text) in [
        ("{{csp}}", policy(&script, &style)),
        ("{{still-object}}", png(&stills.object_order)),
        ("{{still-image}}", png(&stills.image_order)),
        ("<!-- style -->", format!("<style>{style}</style>")),
        ("<!-- script -->", script_part.concat()),
    ] {
        if page.matches(place).count() != 1 {
            let what = format!("it must have the place {place} once");
            return Err(Failure::Page { path: sources.page("index.html"), what });
        }
        page = page.replace(place, &text);
    }
    Ok(page)
}

/// The bytes in the format of gzip, which every browser with vector instructions can undo.
fn compressed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    written.expect("a vector takes all bytes")
}

fn concatenated(files: &[(String, String)]) -> String {
    files.iter().map(|(_, text)| format!("{}\n", text.trim_end())).collect()
}

/// The end of a script, or the beginning of a comment of HTML, would end the script that it stands in.
fn check_script(sources: &Sources, name: &str, text: &str) -> Result<(), Failure> {
    let lower = text.to_ascii_lowercase();
    let found = ["</script", "<script", "<!--"].into_iter().find(|word| lower.contains(word));
    match found {
        None => Ok(()),
        Some(word) => {
            let what = format!("a script in a page cannot contain {word:?}; write it in two parts");
            Err(Failure::Page { path: sources.page(name), what })
        }
    }
}

/// The policy: nothing is loaded from anywhere, and only this script and this style are used. WebAssembly may be compiled.
fn policy(script: &str, style: &str) -> String {
    let hash = |text: &str| BASE64_STANDARD.encode(Sha256::digest(text.as_bytes()));
    format!(
        "default-src 'none'; script-src 'sha256-{}' 'wasm-unsafe-eval'; style-src 'sha256-{}'; \
         img-src data: blob:; worker-src blob:; base-uri 'none'; form-action 'none'",
        hash(script),
        hash(style)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_policy_names_the_hashes() {
        // From the Content Security Policy specification, level 3, section 8.3.
        let policy = policy("doSomething();", "");
        let hash = "'sha256-RFWPLDbv2BY+rCkDzsE+0fr8ylGr2R2faWMhq4lfEQc='";
        assert!(policy.contains(hash), "{policy}");
        assert!(policy.starts_with("default-src 'none'; "));
    }
}
