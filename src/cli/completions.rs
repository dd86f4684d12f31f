//! `bothways completions`: a completion script for a shell, with the names of the built-in scenes.
//!
//! `clap_complete` knows commands and options. It cannot know the values of SCENE: a value is a name or any file, and
//! a list of values would hide the files. This module adds the names to the scripts.

use super::command::Cli;
use bothways::scenes::{BUILT_IN, BuiltIn};
use clap::CommandFactory;
use clap_complete::Shell;
use std::fmt::Write;

/// The subcommands with a scene argument; without a subcommand, `render` runs.
const TAKE_A_SCENE: [&str; 9] =
    ["render", "grade", "figure", "slides", "scenes", "pixel", "film", "camera", "export"];

/// The script.
pub(super) fn script(shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "bothways", &mut script);
    let script = String::from_utf8_lossy(&script);
    match shell {
        Shell::Bash => bash(&script),
        Shell::Zsh => zsh(&script),
        Shell::Fish => fish(&script),
        Shell::PowerShell => {
            blocks(&script, "'bothways", "' {", |BuiltIn { name, about, .. }| {
                let about = about.replace('\'', "''");
                let kind = "[CompletionResultType]::ParameterValue";
                format!(
                    "            [CompletionResult]::new('{name}', '{name}', {kind}, '{about}')\n"
                )
            })
        }
        Shell::Elvish => {
            blocks(&script, "&'bothways", "'= {", |BuiltIn { name, about, .. }| {
                format!("            cand {name} '{}'\n", about.replace('\'', "''"))
            })
        }
        _ => script.into_owned(),
    }
}

fn names() -> String {
    BUILT_IN.iter().map(|scene| scene.name).collect::<Vec<_>>().join(" ")
}

/// The names go into the list of words in each command's branch.
fn bash(script: &str) -> String {
    let mut takes_a_scene = false;
    let mut offered = String::new();
    for line in script.lines() {
        let word = line.trim_start();
        if let Some(label) = word.strip_prefix("bothways").and_then(|rest| rest.strip_suffix(')')) {
            let command = label.strip_prefix("__subcmd__").unwrap_or(label);
            takes_a_scene = label.is_empty() || TAKE_A_SCENE.contains(&command);
        }
        match line.strip_suffix('"') {
            Some(words) if takes_a_scene && word.starts_with("opts=\"") => {
                writeln!(offered, "{words} {}\"", names())
            }
            _ => writeln!(offered, "{line}"),
        }
        .expect("a string takes all");
    }
    offered
}

/// At each scene argument, the names are an alternative to files.
fn zsh(script: &str) -> String {
    let names = names();
    let either = format!(
        "_alternative \"scenes\\:built-in scene\\:({names})\" \"files\\:scene or mesh file\\:_files\""
    );
    let of_line = |line: &str| {
        let asks =
            ["scene -- ", "scenes -- ", "name -- "].iter().any(|argument| line.contains(argument));
        match line.strip_suffix(":_default' \\") {
            Some(start) if asks => format!("{start}:{{{either}}}' \\\n"),
            _ => format!("{line}\n"),
        }
    };
    script.lines().map(of_line).collect()
}

/// Names in addition to the files that fish offers by itself.
fn fish(script: &str) -> String {
    let conditions =
        TAKE_A_SCENE.map(|command| format!("__fish_bothways_using_subcommand {command}"));
    let conditions = conditions.into_iter().chain(["__fish_bothways_needs_command".to_owned()]);
    let mut offered = script.to_owned();
    for (condition, BuiltIn { name, about, .. }) in conditions
        .flat_map(|condition| BUILT_IN.iter().map(move |scene| (condition.clone(), scene)))
    {
        let about = about.replace('\'', "\\'");
        writeln!(offered, "complete -c bothways -n \"{condition}\" -a \"{name}\" -d '{about}'")
            .expect("a string takes all");
    }
    offered
}

/// Adds the names at the beginning of each command's block.
fn blocks(script: &str, open: &str, close: &str, line_of: impl Fn(&BuiltIn) -> String) -> String {
    let names: String = BUILT_IN.iter().map(line_of).collect();
    let takes_a_scene = |line: &str| {
        let command = line.trim_start().strip_prefix(open)?.strip_suffix(close)?;
        let named = command.strip_prefix(';').is_some_and(|name| TAKE_A_SCENE.contains(&name));
        (command.is_empty() || named).then_some(())
    };
    let with_names = |line: &str| match takes_a_scene(line) {
        Some(()) => format!("{line}\n{names}"),
        None => format!("{line}\n"),
    };
    script.lines().map(with_names).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_offered_wherever_one_is_asked_for() {
        // Each name occurs once for each subcommand with a scene, and once without a subcommand; the word alone may
        // occur elsewhere.
        for (shell, offer) in [
            (Shell::Bash, " slivers overlap "),
            (Shell::Zsh, " slivers overlap "),
            (Shell::Fish, "-a \"slivers\""),
            (Shell::PowerShell, "::new('slivers'"),
            (Shell::Elvish, "cand slivers "),
        ] {
            let found = script(shell).matches(offer).count();
            assert_eq!(found, TAKE_A_SCENE.len() + 1, "{shell}");
        }
    }

    #[test]
    fn commands_that_take_a_scene_are_those() {
        let takes = |command: &clap::Command| {
            command
                .get_positionals()
                .any(|word| ["scene", "scenes", "name"].contains(&word.get_id().as_str()))
        };
        let root = Cli::command();
        let taking: Vec<&str> =
            root.get_subcommands().filter(|sub| takes(sub)).map(clap::Command::get_name).collect();
        assert_eq!(taking, TAKE_A_SCENE);
    }
}
