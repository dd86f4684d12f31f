//! What may explain that a file has another size than is expected.

use super::search::{Finding, find_conventions};
use crate::common::View;
use crate::diff::buffer::Buffer;

/// What may explain that a file has another size than `expected` (width and height), in a sentence: a loop that is one
/// too long or too short, or, if the view is known, exchanged rows and columns. `name` is the name of the file.
pub fn cause_of_size(
    name: &str,
    file: &Buffer,
    expected: [u32; 2],
    view: Option<&View>,
) -> Option<String> {
    let [wider, higher] = [0, 1].map(|side| file.size()[side].abs_diff(expected[side]));
    if wider <= 1 && higher <= 1 && wider + higher > 0 {
        let sentence = "a loop that includes its end (<= for <), or leaves it out, makes one row or column too many or \
                        too few";
        return Some(sentence.into());
    }
    let view = view?;
    match find_conventions(view, file).ok()?.finding {
        Finding::Explained(found) if found[0].remaining == 0 => {
            Some(found[0].sentences(name, view.camera).join(", and "))
        }
        _ => None,
    }
}
