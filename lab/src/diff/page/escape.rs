//! Texts and facts that end neither a tag nor a script.

use serde::Serialize;
use std::borrow::Cow;

/// A text that stands for itself in HTML, between tags and in quoted attributes.
pub(crate) fn escaped(text: &str) -> Cow<'_, str> {
    if !text.contains(['&', '<', '>', '"', '\'']) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        match character {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\'' => escaped += "&#39;",
            other => escaped.push(other),
        }
    }
    Cow::Owned(escaped)
}

/// JSON that ends no script: there a tag may only begin with the escape of its bracket.
pub(super) fn json(facts: &impl Serialize) -> String {
    let json = serde_json::to_string(facts).expect("facts are plain data");
    json.replace('<', r"\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_stands_for_itself() {
        assert_eq!(escaped("a.png"), "a.png");
        let hostile = r#"<img src=x onerror='alert("1 & 2")'>"#;
        let text = "&lt;img src=x onerror=&#39;alert(&quot;1 &amp; 2&quot;)&#39;&gt;";
        assert_eq!(escaped(hostile), text);
        assert_eq!(json(&["</script><!--"]), r#"["\u003c/script>\u003c!--"]"#);
    }
}
