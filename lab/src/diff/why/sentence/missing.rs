//! Primitives that are missing and not counted, in a sentence.

use crate::diff::why::missing::{Missing, Scattered};
use crate::wording::grouped;

/// So many places are named.
const MOST: usize = 3;

/// What is missing, with what may be the cause.
pub(super) fn of_missing(missing: &[Missing]) -> String {
    let named: Vec<String> = missing.iter().take(MOST).map(place).collect();
    let more = if missing.len() > MOST { "; and so on" } else { "" };
    let of_quads = missing.iter().any(|one| one.scattered.is_some());
    let at_ends = missing.iter().any(|one| one.at_an_end);
    let question = match (of_quads, at_ends) {
        (true, _) => {
            "of each quad, does it read the first triangle alone? A polygon of n corners is n - 2 triangles"
        }
        (false, true) => "does it read all faces of a mesh, also the first and the last one?",
        (false, false) => "are they read, and what drops them before they are counted?",
    };
    format!(
        "lacks primitives and does not count them, so that those behind have smaller ids: {}{more}; {question}",
        named.join("; ")
    )
}

fn place(one: &Missing) -> String {
    let Missing { count, among: [first, last], shift, scattered, .. } = *one;
    let all = last - first + 1;
    match scattered {
        Some(Scattered { object, is_every_second: true }) => {
            format!("every second one of object {object} (ids {first} to {last}) is missing")
        }
        Some(Scattered { object, is_every_second: false }) => {
            let [count, all] = [count, all].map(|count| grouped(count.into()));
            format!(
                "about {count} of the {all} of object {object} (ids {first} to {last}) are missing, one here and one there"
            )
        }
        None => {
            let what = match (count == all, first == last) {
                (true, true) => format!("id {first} is missing"),
                (true, false) => format!("ids {first} to {last} are missing"),
                _ if count == 1 => format!("one of ids {first} to {last} is missing"),
                _ => format!("{count} of ids {first} to {last} are missing"),
            };
            format!("from id {} on, its ids are {shift} smaller: {what}", last + 1)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_named_with_the_ids_behind_them() {
        let one = Missing { count: 1, among: [0, 0], shift: 1, scattered: None, at_an_end: true };
        let two =
            Missing { count: 2, among: [40, 47], shift: 3, scattered: None, at_an_end: false };
        assert_eq!(
            of_missing(&[one, two]),
            "lacks primitives and does not count them, so that those behind have smaller ids: from id 1 on, its ids are 1 \
             smaller: id 0 is missing; from id 48 on, its ids are 3 smaller: 2 of ids 40 to 47 are missing; does it read \
             all faces of a mesh, also the first and the last one?"
        );
    }
}
