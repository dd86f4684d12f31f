//! Names with letters that the typeface lacks: spelled in letters of the typeface.

use deunicode::deunicode_char;

/// The text with every letter that the typeface lacks spelled in Latin letters, as well as that is possible without
/// knowledge of the language: 茶 becomes Cha. A letter without such a spelling becomes its number, as in U+F0000.
pub(super) fn drawable(text: &str, is_drawable: impl Fn(char) -> bool) -> String {
    let mut drawn = String::with_capacity(text.len());
    let mut was_spelled = false;
    for letter in text.chars() {
        if is_drawable(letter) {
            // A spelled word ends in a space. A full stop after the word needs no space.
            if was_spelled && !letter.is_alphanumeric() {
                drawn.truncate(drawn.trim_end().len());
            }
            drawn.push(letter);
            was_spelled = false;
            continue;
        }
        was_spelled = true;
        match deunicode_char(letter) {
            Some(spelled) if !letter.is_control() && spelled.chars().all(&is_drawable) => {
                let begins_a_word = spelled.starts_with(|first: char| first.is_uppercase());
                if begins_a_word && drawn.ends_with(char::is_alphanumeric) {
                    drawn.push(' ');
                }
                drawn += spelled;
            }
            _ => drawn += &format!("U+{:04X} ", u32::from(letter)),
        }
    }
    drawn.trim_end().into()
}

#[cfg(test)]
mod tests {
    use super::super::text::has;
    use super::*;

    #[test]
    fn what_the_typeface_has_stays() {
        for text in ["lecture", "Würfel", "čajník", "чайник", "τσαγιέρα", "ấm trà", "5 × 7 · “x” …"]
        {
            assert_eq!(drawable(text, has), text);
        }
    }

    #[test]
    fn what_it_lacks_is_spelled() {
        assert_eq!(drawable("茶壺", has), "Cha Hu");
        assert_eq!(drawable("茶壺.v2 – 東京", has), "Cha Hu.v2 – Dong Jing");
        assert_eq!(drawable("カメラ", has), "kamera");
        assert_eq!(drawable("茶と茶, 🫖", has), "Cha to Cha, teapot");
        assert_eq!(drawable("주전자", has), "jujeonja");
        for text in ["إبريق", "קומקום", "กาน้ำชา", "चायदानी", "🫖"]
        {
            let drawn = drawable(text, has);
            assert!(drawn.chars().all(has) && drawn.chars().any(char::is_alphabetic), "{drawn}");
        }
    }

    #[test]
    fn what_nobody_can_spell_is_numbered() {
        assert_eq!(drawable("a\u{7}b\u{f0000}c", has), "aU+0007 bU+F0000 c");
    }
}
