//! A part of the picture that a file leaves blank: its last rows, or a tile.

use super::convention::Part;
use super::differences::Differences;
use crate::common::frame::NO_PRIMITIVE;

/// On a side of a part, so many pixels must show that something visible is cut there.
const FEWEST_CUT: usize = 4;

/// The first and the last row, and the first and the last column.
type Rectangle = [[usize; 2]; 2];

/// The rows, the columns or the rectangle that the file leaves blank, if that is all that it lacks, and a side of it cuts an
/// object that is shown beside it. Where nothing is cut, the file may as well lack an object.
pub(super) fn blank_part(differences: &Differences) -> Option<Part> {
    let image = differences.expected.view.camera.image();
    let [width, height] = image.map(|side| side as usize);
    let lost = || (0..width * height).filter(|&pixel| differences.is_lost(pixel));
    let around = lost().fold(None, |around: Option<Rectangle>, pixel| {
        let at = [pixel / width, pixel % width];
        let [rows, columns] = around.unwrap_or(at.map(|side| [side, side]));
        let with = |[first, last]: [usize; 2], side: usize| [first.min(side), last.max(side)];
        Some([with(rows, at[0]), with(columns, at[1])])
    })?;
    let [rows, columns] = around;
    let whole = [[0, height - 1], [0, width - 1]];
    let blank = |part: &Rectangle| is_blank(differences, width, *part);
    let parts = [[rows, whole[1]], [whole[0], columns], around];
    let (form, mut part) = parts.into_iter().enumerate().find(|(_, part)| blank(part))?;
    if !is_cut(differences, [width, height], around) {
        return None;
    }
    // Beyond these rows or columns, there may be nothing to see.
    if let axis @ (0 | 1) = form {
        let [first, last] = part[axis];
        let with = |ends: [usize; 2]| {
            let mut with = part;
            with[axis] = ends;
            with
        };
        let end = whole[axis][1];
        let is_first = blank(&with([0, first]));
        let is_last = blank(&with([last, end]));
        part[axis] = [if is_first { 0 } else { first }, if is_last { end } else { last }];
    }
    let number = |side: usize| u32::try_from(side).expect("at most 2^16");
    let [rows, columns] = part.map(|ends| ends.map(number));
    Some(Part { rows, columns, image, alone: only_object(differences, lost()) })
}

/// The only object of several that is seen at some pixels: its number, and its first and its last id.
fn only_object(
    differences: &Differences,
    mut pixels: impl Iterator<Item = usize>,
) -> Option<(usize, [u32; 2])> {
    let scene = differences.expected.view.scene;
    let object = |pixel: usize| scene.locate(differences.expected.drawn.ids[pixel].into()).0;
    let first = object(pixels.next()?);
    let is_only = scene.objects().len() > 1 && pixels.all(|pixel| object(pixel) == first);
    let ids = scene.ids_of(first);
    let number = |id: u64| u32::try_from(id).ok();
    is_only.then_some((first, [number(ids.start)?, number(ids.end.checked_sub(1)?)?]))
}

/// Whether the file shows nothing in a part.
fn is_blank(differences: &Differences, width: usize, [rows, columns]: Rectangle) -> bool {
    (rows[0]..=rows[1]).all(|row| {
        let line = row * width;
        !differences.shows[line + columns[0]..=line + columns[1]].contains(&true)
    })
}

/// Whether one side of a part cuts an object: at half of the pixels that are lost along it, the pixel beyond shows the same object.
fn is_cut(
    differences: &Differences,
    [width, height]: [usize; 2],
    [rows, columns]: Rectangle,
) -> bool {
    let scene = differences.expected.view.scene;
    let ids = &differences.expected.drawn.ids;
    let object = |pixel: usize| {
        let id = ids[pixel];
        (id != NO_PRIMITIVE).then(|| scene.locate(id.into()).0)
    };
    // Each pixel of a side, and the one beyond.
    let row = |inner: usize, outer: usize| -> Vec<[usize; 2]> {
        (columns[0]..=columns[1]).map(|j| [inner * width + j, outer * width + j]).collect()
    };
    let column = |inner: usize, outer: usize| -> Vec<[usize; 2]> {
        (rows[0]..=rows[1]).map(|i| [i * width + inner, i * width + outer]).collect()
    };
    let mut sides = Vec::new();
    sides.extend(rows[0].checked_sub(1).map(|outer| row(rows[0], outer)));
    sides.extend((rows[1] + 1 < height).then(|| row(rows[1], rows[1] + 1)));
    sides.extend(columns[0].checked_sub(1).map(|outer| column(columns[0], outer)));
    sides.extend((columns[1] + 1 < width).then(|| column(columns[1], columns[1] + 1)));
    sides.into_iter().any(|side| {
        let lost = || side.iter().filter(|[inner, _]| differences.is_lost(*inner));
        let is_cut = |[inner, outer]: &&[usize; 2]| {
            differences.shows[*outer] && object(*inner) == object(*outer)
        };
        let cut = lost().filter(is_cut).count();
        cut >= FEWEST_CUT && 2 * cut >= lost().count()
    })
}
