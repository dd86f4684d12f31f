//! Words for a shell, in commands that messages propose.

use bothways::formats::source::quote::visible;

/// A word as a shell takes it: in quotes where it needs them.
pub(super) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=+:".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", visible(word).replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_that_a_shell_would_take_apart_stands_in_quotes() {
        for (word, taken) in [
            ("bunny.obj", "bunny.obj"),
            ("my mesh.obj", "'my mesh.obj'"),
            ("room.glb#left eye", "'room.glb#left eye'"),
            ("it's.obj", r"'it'\''s.obj'"),
            ("", "''"),
        ] {
            assert_eq!(quoted(word), taken);
        }
    }
}
