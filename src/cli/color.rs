//! A colour on the command line.

/// A colour in sRGB.
pub(super) fn color(text: &str) -> Result<[u8; 3], String> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6);
    let bytes = digits
        .filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()))
        .and_then(|digits| u32::from_str_radix(digits, 16).ok())
        .map(u32::to_be_bytes);
    match bytes {
        Some([_, red, green, blue]) => Ok([red, green, blue]),
        None => Err("write a # and six hexadecimal digits, such as '#101418'".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_are_six_digits() {
        assert_eq!(color("#0172fF"), Ok([0x01, 0x72, 0xff]));
        for bad in ["", "#", "101418", "#10141", "#1014188", "#+01418", "#12345é", "black"] {
            assert!(color(bad).is_err(), "{bad}");
        }
    }
}
