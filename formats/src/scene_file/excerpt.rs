//! The lines around a place in a text, as messages show them: short, and safe to show on a terminal.

use crate::source::quote::push_visible;
use std::ops::Range;

/// The lines around a place in a text, and the place within them.
///
/// Long lines are cut, with `…` at the cuts. Invisible characters are written as escapes, as
/// [`visible`](crate::source::quote::visible) does.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Excerpt {
    /// The lines, separated by line feeds.
    pub text: String,
    /// The bytes of `text` to underline.
    pub span: Range<usize>,
    /// The number of the first line, counted from 1.
    pub first_line: usize,
}

/// The most characters that are shown before the place, if the line is cut.
const BEFORE: usize = 40;
/// The most characters of a line that are shown.
const MOST: usize = 100;
/// The most line feeds in a place. Of a longer place, only the first line is shown.
const MOST_LINES: usize = 6;

impl Excerpt {
    /// The lines of a place, the line before them and the line after them.
    pub(super) fn around(text: &str, span: Range<usize>) -> Excerpt {
        let start = floor(text, span.start);
        let end = floor(text, span.end).max(start);
        let (start, end) = if start == end { at_line_end(text, start) } else { (start, end) };
        let end = match text[start..end].match_indices('\n').nth(MOST_LINES) {
            None => end,
            Some(_) => start + text[start..].find('\n').unwrap_or(0),
        };
        let line_start = |at: usize| text[..at].rfind('\n').map_or(0, |feed| feed + 1);
        let line_end = |at: usize| text[at..].find('\n').map_or(text.len(), |feed| at + feed);
        let (first, last) = (line_start(start), line_end(end));
        let first = if first == 0 { 0 } else { line_start(first - 1) };
        let last = if last == text.len() { last } else { line_end(last + 1) };
        // The line feed at the end of a file does not begin another line.
        let lines = text[first..last].strip_suffix('\n').filter(|_| end < last);
        let lines = lines.unwrap_or(&text[first..last]);

        let mut excerpt = Excerpt { first_line: line_number(text, first), ..Excerpt::default() };
        let mut at = first;
        for line in lines.split('\n') {
            if at > first {
                excerpt.text.push('\n');
            }
            excerpt.add(line, at, start..end);
            at += line.len() + 1;
        }
        excerpt
    }

    /// Adds a line that begins at byte `at` of the whole text; `place` is the place in the whole text.
    fn add(&mut self, line: &str, at: usize, place: Range<usize>) {
        let line = line.strip_suffix('\r').unwrap_or(line);
        let (line, at) = match line.strip_prefix('\u{feff}') {
            Some(rest) if at == 0 => (rest, '\u{feff}'.len_utf8()),
            _ => (line, at),
        };
        let begins_here = (at..=at + line.len()).contains(&place.start);
        let column = if begins_here { line[..place.start - at].chars().count() } else { 0 };
        let from = if line.chars().nth(MOST).is_some() { column.saturating_sub(BEFORE) } else { 0 };
        if from > 0 {
            self.text.push('…');
        }
        let mut characters = line.char_indices().skip(from);
        for (offset, character) in characters.by_ref().take(MOST) {
            self.note(at + offset, &place);
            if character == '\t' {
                self.text.push('\t');
            } else {
                push_visible(&mut self.text, character);
            }
        }
        let next = characters.next();
        self.note(next.map_or(at + line.len(), |(offset, _)| at + offset), &place);
        if next.is_some() {
            self.text.push('…');
        }
    }

    /// Moves the span: the end of the excerpt so far corresponds to byte `at` of the whole text.
    fn note(&mut self, at: usize, place: &Range<usize>) {
        if at <= place.start {
            self.span.start = self.text.len();
        }
        if at <= place.end {
            self.span.end = self.text.len();
        }
    }
}

/// The last visible character before an empty place at the end of a line: without it, there would be nothing to underline.
/// Any other place stays empty.
fn at_line_end(text: &str, at: usize) -> (usize, usize) {
    let line_start = text[..at].rfind('\n').map_or(0, |feed| feed + 1);
    let before = text[line_start..at].trim_end();
    let is_end = text[at..].lines().next().is_none_or(|rest| rest.trim().is_empty());
    match before.char_indices().next_back() {
        Some((last, _)) if is_end => (line_start + last, line_start + before.len()),
        _ => (at, at),
    }
}

/// The last character boundary that is not after `at`.
fn floor(text: &str, at: usize) -> usize {
    let at = at.min(text.len());
    (0..=at).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

/// The number of the line that contains a byte, counted from 1.
fn line_number(text: &str, at: usize) -> usize {
    text.as_bytes()[..at].iter().filter(|&&byte| byte == b'\n').count() + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn around(text: &str, place: &str) -> Excerpt {
        let start = text.find(place).unwrap();
        Excerpt::around(text, start..start + place.len())
    }

    fn underlined(excerpt: &Excerpt) -> &str {
        &excerpt.text[excerpt.span.clone()]
    }

    #[test]
    fn short_lines_are_shown_whole_with_their_neighbours() {
        let excerpt = around("a = 1\nb = 2\r\nc = wrong\nd = 4\ne = 5\n", "wrong");
        assert_eq!((excerpt.text.as_str(), excerpt.first_line), ("b = 2\nc = wrong\nd = 4", 2));
        assert_eq!(underlined(&excerpt), "wrong");
        let excerpt = around("\u{feff}wrong = 1\n", "wrong");
        assert_eq!((excerpt.text.as_str(), underlined(&excerpt)), ("wrong = 1", "wrong"));
        assert_eq!(Excerpt::around("", 0..0), Excerpt { first_line: 1, ..Excerpt::default() });
    }

    #[test]
    fn an_empty_place_at_the_end_of_a_line_underlines_the_character_before_it() {
        let excerpt = Excerpt::around("a = ", 4..4);
        assert_eq!((excerpt.text.as_str(), excerpt.span), ("a = ", 2..3));
        let excerpt = Excerpt::around("a = [1, é\r\nb = 2\n", 10..10);
        assert_eq!((excerpt.text.as_str(), underlined(&excerpt)), ("a = [1, é\nb = 2", "é"));
        for (text, at) in [("", 0), ("\n\n", 1), ("a = 1", 0), ("a = 1", 3)] {
            assert!(Excerpt::around(text, at..at).span.is_empty(), "{at} in {text:?}");
        }
    }

    #[test]
    fn of_a_long_line_there_is_a_window() {
        let text = format!("x = [{}wrong{}]\n", "1, ".repeat(50_000), ", 2".repeat(50_000));
        let excerpt = around(&text, "wrong");
        assert!(excerpt.text.starts_with('…') && excerpt.text.ends_with('…'));
        assert_eq!((excerpt.text.chars().count(), underlined(&excerpt)), (102, "wrong"));
        let excerpt = Excerpt::around(&text, 4..text.len() - 1);
        assert!(excerpt.text.chars().count() == 101 && underlined(&excerpt).starts_with("[1, 1"));
    }

    #[test]
    fn of_many_lines_the_first_is_underlined() {
        let text = format!("x = [\n{}]\n", "1,\n".repeat(100));
        assert_eq!(Excerpt::around(&text, 4..text.len() - 1).text, "x = [\n1,");
    }

    #[test]
    fn what_a_terminal_would_obey_is_written_out() {
        let excerpt = around("a\u{202e} = '\u{9b}2J' # \u{1b}[2J", "'\u{9b}2J'");
        assert_eq!(excerpt.text, r"a\u{202e} = '\u{9b}2J' # \u{1b}[2J");
        assert_eq!(underlined(&excerpt), r"'\u{9b}2J'");
    }

    proptest! {
        #[test]
        fn any_place_of_any_text_has_an_excerpt(
            text in "([a-c\t\r\u{1b}é…\u{feff}]|\n){0,400}", start in 0_usize..900, length in 0_usize..900,
        ) {
            let excerpt = Excerpt::around(&text, start..start + length);
            prop_assert!(excerpt.span.start <= excerpt.span.end);
            prop_assert!(excerpt.text.get(excerpt.span.clone()).is_some());
            prop_assert!(excerpt.text.lines().count() <= MOST_LINES + 3);
            let longest = excerpt.text.lines().map(|line| line.len()).max();
            prop_assert!(longest.unwrap_or(0) <= 10 * MOST);
        }
    }
}
