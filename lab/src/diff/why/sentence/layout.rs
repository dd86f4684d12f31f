//! Where the numbers of a picture lie in a buffer, in a sentence.

use crate::diff::why::layout::Layout;

/// A layout of a buffer, for an image of this width and height.
pub(super) fn of_layout(layout: Layout, [width, height]: [u32; 2]) -> String {
    let (columns, rows) = (width as usize, height as usize);
    match layout {
        Layout::Shifted { by } => {
            let far = by.unsigned_abs();
            let moved = format!("({}, {})", far / columns, far % columns);
            let [belongs, lies] = if by > 0 { ["(0, 0)", &moved] } else { [&moved, "(0, 0)"] };
            let elements = if far == 1 { "element" } else { "elements" };
            format!(
                "is shifted by {far} {elements} of its buffer: what belongs at {belongs} lies at {lies}; is it written, or read, \
                 at an offset, or is something before its pixels?"
            )
        }
        Layout::Stride { stride } => {
            let name = match stride {
                stride if stride == rows => " (H)".to_owned(),
                stride if stride == columns + 1 => " (W + 1)".to_owned(),
                stride if stride + 1 == columns => " (W - 1)".to_owned(),
                _ => String::new(),
            };
            format!(
                "has rows of {stride} elements{name} in its buffer, where the image has {columns} columns: it writes, or reads, \
                 pixel (i, j) at {stride} i + j; take W i + j"
            )
        }
    }
}
