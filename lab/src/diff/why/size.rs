//! What may explain that a file has another size than is expected.

use super::finding::Finding;
use super::search::find_conventions;
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

/// A file that has another size than the picture of its scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the file has {} x {} pixels, and the scene {} x {}{cause}", .file[0], .file[1], .scene[0], .scene[1])]
pub struct OtherSize {
    /// Width and height of the file.
    pub file: [u32; 2],
    /// Width and height of the camera's image.
    pub scene: [u32; 2],
    /// What may be the cause, in words behind the sizes; or empty.
    pub cause: String,
}

/// Checks that a file has the size of the camera's image.
///
/// # Errors
///
/// If it has another one.
pub fn check_size(view: &View, file: &Buffer) -> Result<(), OtherSize> {
    let (size, scene) = (file.size(), view.camera.image());
    if size == scene {
        return Ok(());
    }
    let cause = cause_of_size("it", file, scene, Some(view));
    let cause = cause.map_or(String::new(), |cause| format!("; {cause}"));
    Err(OtherSize { file: size, scene, cause })
}
