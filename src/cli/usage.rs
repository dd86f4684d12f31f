//! Reading the command line, and what is said when a word is too many.

use super::Cli;
use super::failure::Failure;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser};

/// The command line; help, version and nearly all mistakes are answered here, and end the program.
///
/// # Errors
///
/// A word after the scene, which the parser takes for a subcommand, and a subcommand after options,
/// which it takes for the scene.
pub(super) fn parse() -> Result<Cli, Failure> {
    let cli = Cli::try_parse().map_err(|error| match excess(&error) {
        Some(message) => Failure::new(message),
        None => error.exit(),
    })?;
    match (&cli.command, cli.render.scene.as_str()) {
        (None, "help") => Err(Failure::new("for help, write bothways --help")),
        (None, word) if is_subcommand(word) => Err(Failure::new(late(word))),
        _ => Ok(cli),
    }
}

fn is_subcommand(word: &str) -> bool {
    Cli::command().find_subcommand(word).is_some()
}

fn late(word: &str) -> String {
    format!("'{word}' is a subcommand, so it comes first: bothways {word}, then all else")
}

fn excess(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidSubcommand) else {
        return None;
    };
    if error.kind() != ErrorKind::ArgumentConflict {
        return None;
    }
    Some(match word.as_str() {
        word if is_subcommand(word) => late(word),
        word => format!("'{word}' is a word too many: one scene is rendered at a time"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_after_the_scene_is_explained() {
        let says = |line: &[&str]| excess(&Cli::try_parse_from(line).unwrap_err());
        let too_many = "'ties' is a word too many: one scene is rendered at a time";
        assert_eq!(says(&["bothways", "canonical", "ties"]).unwrap(), too_many);
        let late = "'pixel' is a subcommand, so it comes first: bothways pixel, then all else";
        assert_eq!(says(&["bothways", "canonical", "pixel"]).unwrap(), late);
        assert_eq!(says(&["bothways", "--nonsense"]), None);
    }
}
