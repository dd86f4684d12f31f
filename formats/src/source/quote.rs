//! Prepares text from files, and names of files, for messages.
//!
//! Text of unknown origin may be as long as its file, move the cursor of a terminal, or reverse the direction of the
//! text around it. All messages quote such text with these functions.

use std::borrow::Cow;
use std::fmt::Write;

/// The most characters of a word that a message shows.
pub const LONGEST_WORD: usize = 32;
/// The most names of a list that a message shows.
const MOST_NAMES: usize = 16;

/// Makes every character of a text visible, on one line.
///
/// Characters that move a cursor, change the state of a terminal or change the direction of text are written as
/// escapes, such as `\u{1b}`.
///
/// ```
/// use bothways_formats::source::quote::visible;
///
/// assert_eq!(visible("naïve ✓"), "naïve ✓");
/// assert_eq!(visible("red\u{1b}[31m\u{9b}2J \u{202e}gnp.a\n"), r"red\u{1b}[31m\u{9b}2J \u{202e}gnp.a\u{a}");
/// ```
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        push_visible(&mut shown, character);
    }
    Cow::Owned(shown)
}

/// Appends one character as [`visible`] shows it.
pub(crate) fn push_visible(shown: &mut String, character: char) {
    if is_hidden(character) {
        write!(shown, "{}", character.escape_unicode()).expect("a string takes all");
    } else {
        shown.push(character);
    }
}

/// Makes a word [`visible`], and shortens it if it is long.
///
/// ```
/// use bothways_formats::source::quote::shown;
///
/// assert_eq!(shown("clay"), "clay");
/// assert_eq!(shown(&"long ".repeat(1000)).chars().count(), 33);
/// ```
pub fn shown(word: &str) -> String {
    visible(&shortened(word)).into_owned()
}

/// Makes a word [`visible`] in quotation marks, with `\` before special characters, and shortens it if it is long.
///
/// ```
/// use bothways_formats::source::quote::quoted;
///
/// assert_eq!(quoted("6\" nail\r"), r#""6\" nail\r""#);
/// ```
pub fn quoted(word: &str) -> String {
    // `{:?}` leaves some characters as they are that `visible` escapes.
    visible(&format!("{:?}", shortened(word))).into_owned()
}

/// Lists names, separated by commas; of a long list, the first names and the number of the others.
///
/// ```
/// use bothways_formats::source::quote::listed;
///
/// assert_eq!(listed(["sphere", "plane"]), "sphere, plane");
/// let many = vec!["a"; 20];
/// assert_eq!(listed(many), "a, a, a, a, a, a, a, a, a, a, a, a, a, a, a, a and 4 more");
/// ```
pub fn listed<'n>(names: impl IntoIterator<Item = &'n str>) -> String {
    let mut names = names.into_iter();
    let first: Vec<String> = names.by_ref().take(MOST_NAMES).map(shown).collect();
    match names.count() {
        0 => first.join(", "),
        more => format!("{} and {more} more", first.join(", ")),
    }
}

/// Turns bytes of a file into a word, shortened if it is long, with `�` in place of bytes that are not UTF-8.
///
/// The word is not [`visible`] yet: the message must make it so.
pub(crate) fn quote(bytes: &[u8]) -> String {
    // A character has at most four bytes, so this keeps all that are shown.
    let some = &bytes[..bytes.len().min(4 * LONGEST_WORD + 4)];
    shortened(&String::from_utf8_lossy(some)).into_owned()
}

fn shortened(word: &str) -> Cow<'_, str> {
    match word.char_indices().nth(LONGEST_WORD) {
        None => Cow::Borrowed(word),
        Some((end, _)) => Cow::Owned(format!("{}…", &word[..end])),
    }
}

/// Tells whether a character is a control character, changes the direction of text, ends a line, is a byte order mark
/// or is a tag.
fn is_hidden(character: char) -> bool {
    match character {
        '\u{61c}' | '\u{200e}' | '\u{200f}' => true,
        '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        '\u{feff}' | '\u{e0000}'..='\u{e007f}' => true,
        _ => character.is_control(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The characters with Unicode's property `Bidi_Control`, and all characters of the category Cc.
    #[test]
    fn nothing_that_a_terminal_obeys_is_left() {
        let controls = (0..0x20).chain(0x7f..0xa0);
        let directions = [0x61c, 0x200e, 0x200f].into_iter().chain(0x202a..=0x202e);
        for code in controls.chain(directions).chain(0x2066..=0x2069) {
            let text = format!("a{}b", char::from_u32(code).unwrap());
            assert_eq!(visible(&text), format!("a\\u{{{code:x}}}b"));
            assert!(!quoted(&text).contains(char::from_u32(code).unwrap()), "{code:x}");
        }
    }

    #[test]
    fn letters_of_all_scripts_stay() {
        // The last one is an e and a separate accent, as some file systems write é.
        for text in ["Größe", "模型", "مجسم", "क्ष", "😀", "e\u{301}"] {
            assert_eq!(visible(text), text);
        }
    }

    #[test]
    fn long_words_are_cut_between_characters() {
        assert_eq!(shown(&"é".repeat(33)), "é".repeat(32) + "…");
        assert_eq!(quote("é".repeat(500).as_bytes()), "é".repeat(32) + "…");
        assert_eq!(quote(b"a\xffb"), "a\u{fffd}b");
    }
}
