//! Reading the command line, and the messages about unexpected words.

use super::command::Cli;
use super::failure::Failure;
use super::shell::quoted;
use super::terminal::{print, tame};
use bothways::formats::scene_file::nearest_name;
use bothways::formats::source::quote::visible;
use bothways::scenes::BUILT_IN;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, Parser};

/// The parsed command line; the parser prints help, version and nearly all errors here, and ends the program.
///
/// # Errors
///
/// A word after the scene, which the parser takes for a subcommand; a subcommand after options; a mistyped
/// subcommand, which the parser takes for the scene.
pub(super) fn parse() -> Result<Cli, Failure> {
    let words: Vec<String> =
        std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
    let cli = Cli::try_parse().map_err(|error| match excess(&error, &words) {
        Some(message) => Failure::new(message),
        None => exit(&error),
    })?;
    match (&cli.command, cli.render.scene.as_str()) {
        (None, word) if is_subcommand(word) => Err(Failure::new(late(word))),
        (None, word) => mistyped(word).map_or(Ok(cli), |message| Err(Failure::new(message))),
        _ => Ok(cli),
    }
}

/// Prints the parser's text, which is help or an error, and ends the program, unless help cannot be printed. The text
/// quotes words of the command line.
fn exit(error: &clap::Error) -> Failure {
    let text = error.render().ansi().to_string();
    if error.use_stderr() {
        anstream::eprint!("{}", tame(&text));
    } else if let Err(failure) = print(&text) {
        return failure;
    }
    std::process::exit(error.exit_code())
}

fn is_subcommand(word: &str) -> bool {
    word == "help" || Cli::command().find_subcommand(word).is_some()
}

fn late(word: &str) -> String {
    format!("'{word}' is a subcommand, so it comes first: bothways {word}, then all else")
}

/// The subcommand that a word may mean, if the word is no file and no scene.
fn meant(word: &str) -> Option<String> {
    let is_scene = BUILT_IN.iter().any(|scene| scene.name == word);
    if is_scene || word.contains(['.', '/', '\\']) {
        return None;
    }
    let root = Cli::command();
    let names = root.get_subcommands().map(clap::Command::get_name).chain(["help"]);
    nearest_name(word, names).map(str::to_owned)
}

/// The message about a word that is neither a scene nor a command, if the word resembles a command.
fn mistyped(word: &str) -> Option<String> {
    let command = meant(word)?;
    let scene = nearest_name(word, BUILT_IN.iter().map(|scene| scene.name));
    let or_scene = scene.map_or(String::new(), |scene| format!(", or the scene '{scene}'"));
    let word = visible(word);
    Some(format!(
        "there is no command and no scene '{word}'; did you mean the command 'bothways {command}'{or_scene}? \
         (bothways help and bothways scenes list them)"
    ))
}

/// The message about a word after the scene.
fn excess(error: &clap::Error, words: &[String]) -> Option<String> {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidSubcommand) else {
        return None;
    };
    if error.kind() != ErrorKind::ArgumentConflict {
        return None;
    }
    if is_subcommand(word) {
        return Some(late(word));
    }
    // The scene is the first word, unless options come before it.
    let (scene, rest) = match words.split_first() {
        Some((scene, rest)) if !scene.starts_with('-') => (Some(scene), rest),
        _ => (None, words),
    };
    let written = |start: &str, words: &[String]| {
        let words = words.iter().map(|word| quoted(word));
        [start.to_owned()].into_iter().chain(words).collect::<Vec<_>>().join(" ")
    };
    if let Some(command) = scene.and_then(|scene| meant(scene)) {
        let scene = scene.map_or(String::new(), |scene| visible(scene).into_owned());
        let command = written(&format!("bothways {command}"), rest);
        return Some(format!("there is no command '{scene}'; did you mean '{command}'?"));
    }
    let is_number = |word: &String| word.bytes().all(|byte| byte.is_ascii_digit());
    let is_buffer = |word: &String| {
        [".png", ".npy", ".bmp", ".pgm", ".ppm", ".pbm", ".pnm"]
            .iter()
            .any(|ending| word.to_lowercase().ends_with(ending))
    };
    let remedy = if rest.len() >= 2 && rest[..2].iter().all(is_number) {
        format!("for one pixel of it, write '{}'", written("bothways pixel", words))
    } else if scene.is_some_and(is_buffer) && is_buffer(word) {
        format!("to compare two files, write '{}'", written("bothways diff", words))
    } else {
        "one scene is rendered at a time; bothways help lists all commands".into()
    };
    Some(format!("'{}' is a word too many: {remedy}", visible(word)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn says(line: &[&str]) -> Option<String> {
        let words: Vec<String> = line[1..].iter().map(|&word| word.to_owned()).collect();
        excess(&Cli::try_parse_from(line).unwrap_err(), &words)
    }

    #[test]
    fn a_word_after_the_scene_is_explained() {
        let too_many = "'ties' is a word too many: one scene is rendered at a time; bothways help lists all \
                        commands";
        assert_eq!(says(&["bothways", "canonical", "ties"]).unwrap(), too_many);
        assert_eq!(says(&["bothways", "--size", "4x4", "canonical", "ties"]).unwrap(), too_many);
        let late = "'pixel' is a subcommand, so it comes first: bothways pixel, then all else";
        assert_eq!(says(&["bothways", "canonical", "pixel"]).unwrap(), late);
        let pixel = "'3' is a word too many: for one pixel of it, write 'bothways pixel ties 3 4'";
        assert_eq!(says(&["bothways", "ties", "3", "4"]).unwrap(), pixel);
        let diff =
            "'b.npy' is a word too many: to compare two files, write 'bothways diff a.PNG b.npy'";
        assert_eq!(says(&["bothways", "a.PNG", "b.npy"]).unwrap(), diff);
        assert_eq!(says(&["bothways", "--nonsense"]), None);
    }

    #[test]
    fn a_mistyped_command_is_recognised() {
        let pixle = "there is no command 'pixle'; did you mean 'bothways pixel ties 3 4'?";
        assert_eq!(says(&["bothways", "pixle", "ties", "3", "4"]).unwrap(), pixle);
        let cover =
            "there is no command 'covr'; did you mean 'bothways cover '1,1 9,2 3,7' --size 9x9'?";
        assert_eq!(says(&["bothways", "covr", "1,1 9,2 3,7", "--size", "9x9"]).unwrap(), cover);
        let vectors = mistyped("vectros").unwrap();
        assert!(vectors.contains("did you mean the command 'bothways vectors'?"), "{vectors}");
        // No scene and no file is mistaken for a command.
        for fine in ["inside", "many", "./pixle", "pixle.toml", "teapot", "lectrue"] {
            assert_eq!(mistyped(fine), None, "{fine}");
        }
        // The name of a scene is as similar as the name of a command.
        let scene = mistyped("tover").unwrap();
        assert!(scene.contains("'bothways cover'"), "{scene}");
    }
}
