//! Suggestions for words that are not known.

use crate::source::quote::{listed, quoted};

/// Says which of the known names is meant, or which are known; `what` they are, in the plural.
pub(super) fn suggestion<'k>(
    what: &str,
    word: &str,
    known: impl IntoIterator<Item = &'k str> + Clone,
) -> String {
    match nearest_name(word, known.clone()) {
        Some(name) => format!("did you mean {}?", quoted(name)),
        None => format!("the {what} are {}", listed(known)),
    }
}

/// The known name that somebody may have meant who wrote `word`, if one is near enough.
///
/// ```
/// use bothways_formats::scene_file::nearest_name;
///
/// assert_eq!(nearest_name("spere", ["sphere", "plane"]), Some("sphere"));
/// assert_eq!(nearest_name("cube", ["sphere", "plane"]), None);
/// ```
pub fn nearest_name<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    // A slip in about every third letter; a swap of neighbours is one slip.
    let near = |name: &str| {
        let slips = strsim::damerau_levenshtein(&word.to_lowercase(), &name.to_lowercase());
        (slips <= 1.max(name.chars().count() / 3)).then_some(slips)
    };
    // Quadratic in the word's length, so not for words that no name comes near.
    if word.len() > 64 {
        return None;
    }
    let rated = known.into_iter().filter_map(|name| near(name).map(|slips| (slips, name)));
    rated.min_by_key(|(slips, _)| *slips).map(|(_, name)| name)
}
