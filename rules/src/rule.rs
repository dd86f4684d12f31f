//! What both lists of rules have in common: how a rule is described, and how its text is read.

/// A rule for readers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct About {
    /// How it is written on the command line, with a letter for its number: `snapped:B`.
    pub form: &'static str,
    /// What it does, in one sentence.
    pub what: &'static str,
    /// The sort of bug that it reproduces.
    pub reproduces: &'static str,
}

/// Why a text is no rule.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ParseRuleError {
    /// There is no rule of this name.
    #[error(
        "there is no such rule of {order}; choose exact or one of {known} ('bothways rules' explains them)"
    )]
    Unknown {
        /// The order that was to have the rule.
        order: &'static str,
        /// All rules of the order.
        known: String,
    },
    /// The rule has no number.
    #[error("{name} takes no number; write it as {name}")]
    NoNumber {
        /// The rule.
        name: &'static str,
    },
    /// The rule's number is missing or impossible.
    #[error("{name} takes {expected}, such as {example}")]
    Number {
        /// The rule.
        name: &'static str,
        /// What is asked for.
        expected: &'static str,
        /// A right text.
        example: &'static str,
    },
}

/// Cuts a text like `snapped:8` into the name and the number.
pub(crate) fn parts(text: &str) -> (&str, Option<&str>) {
    match text.split_once(':') {
        Some((name, number)) => (name, Some(number)),
        None => (text, None),
    }
}

/// The forms of all rules, for the message about an unknown one.
pub(crate) fn forms(rules: &[About]) -> String {
    rules.iter().map(|about| about.form).collect::<Vec<_>>().join(", ")
}
