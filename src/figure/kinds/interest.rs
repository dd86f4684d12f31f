//! Which pixel a figure looks at if nobody chooses one.

use crate::common::{Frame, View};

/// A pixel on the outline of an object, near the middle of the picture; the middle itself if there is no outline.
pub(super) fn outline(view: &View, frame: &Frame) -> [u32; 2] {
    let (height, width) = (frame.height(), frame.width());
    let far = |row: usize, column: usize| {
        (row as f64 - height as f64 / 2.0).hypot(column as f64 - width as f64 / 2.0)
    };
    let object =
        |row: usize, column: usize| frame.id(row, column).map(|id| view.scene.locate(id).0);
    let places = (1..height).flat_map(|row| (1..width).map(move |column| (row, column)));
    let outline = places.filter(|&(row, column)| {
        let here = object(row, column);
        here != object(row, column - 1) || here != object(row - 1, column)
    });
    let nearest = outline.min_by(|a, b| far(a.0, a.1).total_cmp(&far(b.0, b.1)));
    let (row, column) = nearest.unwrap_or((height / 2, width / 2));
    [row, column].map(|part| u32::try_from(part).expect("within the image"))
}
