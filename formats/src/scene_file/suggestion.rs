//! Suggestions for words that are not known.

use crate::source::quote::{listed, quoted};

/// Suggests the known name that is nearest to a word, or lists the known names, which are called `what`, in the plural.
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

/// Finds the known name that was probably meant by `word`, if one is similar enough.
///
/// ```
/// use bothways_formats::scene_file::nearest_name;
///
/// assert_eq!(nearest_name("spere", ["sphere", "plane"]), Some("sphere"));
/// assert_eq!(nearest_name("cube", ["sphere", "plane"]), None);
/// ```
pub fn nearest_name<'k>(word: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    // One slip is allowed, or one for every three letters of the name. Two neighbours swapped are one slip.
    let near = |name: &str| {
        let slips = strsim::damerau_levenshtein(&word.to_lowercase(), &name.to_lowercase());
        (slips <= 1.max(name.chars().count() / 3)).then_some(slips)
    };
    // The distance takes time quadratic in the length of the word. No name is near a very long one.
    if word.len() > 64 {
        return None;
    }
    let rated = known.into_iter().filter_map(|name| near(name).map(|slips| (slips, name)));
    rated.min_by_key(|(slips, _)| *slips).map(|(_, name)| name)
}
