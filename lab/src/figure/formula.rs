//! Letters of formulas in texts of figures, as the lecture writes them: vectors are bold, and the names of edges stand
//! low beside their functions.
//!
//! A vector is a letter that Unicode has for this, such as 𝐝 (mathematical bold). Unicode has no b and c that stand low;
//! a letter of a subscript is one of its private letters, which nobody else sees: what is read instead of seen has
//! [`plain`] letters.

/// The bold letter of Unicode that stands for a.
const BOLD_A: u32 = 0x1d41a;
/// What is added to the number of an ASCII letter for the same letter as a subscript.
const SUBSCRIPT: u32 = 0xe000;

/// How a letter of a text is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Form {
    pub(super) letter: char,
    /// Whether it is bold, whatever the text is.
    pub(super) is_vector: bool,
    is_subscript: bool,
}

impl Form {
    pub(super) fn of(letter: char) -> Form {
        let number = u32::from(letter);
        let ascii = |number: u32| u8::try_from(number).ok().filter(u8::is_ascii).map(char::from);
        if let Some(place) = number.checked_sub(BOLD_A).filter(|place| *place < 26)
            && let Some(letter) = ascii(u32::from('a') + place)
        {
            return Form { letter, is_vector: true, is_subscript: false };
        }
        match number.checked_sub(SUBSCRIPT).and_then(ascii) {
            Some(letter) => Form { letter, is_vector: false, is_subscript: true },
            None => Form { letter, is_vector: false, is_subscript: false },
        }
    }

    /// How far above the line it stands, in font units, and its size in that of the line.
    pub(super) fn place(self) -> [f32; 2] {
        if self.is_subscript { [-420.0, 0.7] } else { [0.0, 1.0] }
    }
}

/// A text of ASCII letters as a subscript.
pub(crate) fn subscript(text: &str) -> String {
    let low = |letter: char| char::from_u32(SUBSCRIPT + u32::from(letter));
    text.chars().map(|letter| low(letter).filter(|_| letter.is_ascii()).unwrap_or(letter)).collect()
}

/// The text for those who cannot see it: vectors are letters, and a subscript follows a low line.
pub(super) fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut was_subscript = false;
    for letter in text.chars() {
        let form = Form::of(letter);
        if form.is_subscript && !was_subscript {
            plain.push('_');
        }
        plain.push(form.letter);
        was_subscript = form.is_subscript;
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formula_is_read_in_plain_letters() {
        let edge = subscript("ab");
        assert_eq!(
            plain(&format!("E{edge} = det(𝐚 − 𝐩, 𝐛 − 𝐩, 𝐝), 𝐳")),
            "E_ab = det(a − p, b − p, d), z"
        );
        assert_eq!(plain("my_scene, 茶 é"), "my_scene, 茶 é");
    }
}
