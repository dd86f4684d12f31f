//! A set of slides, and one of them.

use super::content::Plan;
use crate::figure::Theme;

/// A set of slides.
#[derive(Debug)]
pub struct Deck<'a> {
    pub(super) theme: Theme,
    pub(super) slides: Vec<Slide<'a>>,
}

/// One slide of a set.
#[derive(Debug)]
pub struct Slide<'a> {
    /// The name of its file.
    pub file: String,
    /// What it shows, in a few words.
    pub title: String,
    /// What to see in it, in a sentence.
    pub caption: &'static str,
    /// What the lecturer may say.
    pub notes: &'static str,
    pub(super) plan: Plan<'a>,
}
