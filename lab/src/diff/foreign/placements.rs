//! Turns and moves after which one picture agrees with another.

use crate::diff::aspect::Aspect;
use crate::diff::buffer::Buffer;
use crate::diff::buffer_pair::{BufferPair, Decides};
use crate::diff::classes::{Class, Classes, pixels};
use crate::wording::count;

/// All turns of B and all moves of B by one pixel after which B agrees with A; where there are none, the shortest moves
/// by more.
pub(super) fn placements(pair: &BufferPair, classes: &Classes) -> Vec<String> {
    if pair.a.samples() != 1 || pair.b.samples() != 1 {
        return Vec::new();
    }
    // What explains every difference explains the first ones: most placements are refuted by a few pixels.
    let first: Vec<[u32; 2]> = classes.differing().map(|(pixel, _)| pixel).take(REFUTING).collect();
    let turned = turns(pair.a.size())
        .into_iter()
        .filter(|(_, place)| first.iter().all(|&in_a| !class(pair, in_a, place(in_a)).differs()))
        .filter(|(_, place)| agree(pair, place.as_ref()));
    let mut found: Vec<String> = turned.map(|(name, _)| agrees_once(name)).collect();
    let moves = |by: u32| {
        let agreeing = ring(by).into_iter().filter(|&by| agree_moved(pair, by, &first));
        agreeing.map(moved).collect::<Vec<_>>()
    };
    found.extend(moves(1));
    if found.is_empty() {
        let farther = (2..=FARTHEST).map(moves).find(|moves| !moves.is_empty());
        found.extend(farther.into_iter().flatten());
    }
    found
}

/// The turns after which B agrees with A, if B has as many rows as A has columns and as many columns as A has rows: where
/// the picture is not square, the two cannot be compared otherwise.
///
/// ```
/// use bothways_lab::diff::foreign::{Buffer, Content, exchanged_sides};
///
/// let mask = |size, mask: [bool; 2]| Buffer::new(size, 1, Content::Mask(mask.to_vec().into()));
/// let (level, upright) = (mask([2, 1], [true, false]), mask([1, 2], [true, false]));
/// let expected = "B agrees with A once it is transposed (its rows are A's columns)";
/// assert_eq!(exchanged_sides(&level, &upright)[0], expected);
/// ```
pub fn exchanged_sides(a: &Buffer, b: &Buffer) -> Vec<String> {
    let ([width, height], pair) = (a.size(), BufferPair::new(a, b, Decides::Everything));
    if b.size() != [height, width] || [a, b].iter().any(|buffer| buffer.samples() != 1) {
        return Vec::new();
    }
    let turned = diagonals([width, height]).into_iter();
    turned
        .filter(|(_, place)| agree(&pair, place.as_ref()))
        .map(|(name, _)| agrees_once(name))
        .collect()
}

fn agrees_once(how: &str) -> String {
    format!("B agrees with A once it is {how}")
}

/// The differing pixels that are looked at first.
const REFUTING: usize = 256;
/// The farthest moves that are tried, in pixels.
const FARTHEST: u32 = 16;

/// The place in B of a pixel of A.
type Placement = Box<dyn Fn([u32; 2]) -> [u32; 2]>;

/// The turns that map a picture onto itself, and the words for turning B back.
fn turns(size @ [width, height]: [u32; 2]) -> Vec<(&'static str, Placement)> {
    let (last_i, last_j) = (height - 1, width - 1);
    let mut turns: Vec<(&str, Placement)> = vec![
        ("turned upside down", Box::new(move |[i, j]| [last_i - i, j])),
        ("turned left to right", Box::new(move |[i, j]| [i, last_j - j])),
        ("turned by 180 degrees", Box::new(move |[i, j]| [last_i - i, last_j - j])),
    ];
    if width == height {
        turns.extend(diagonals(size));
    }
    turns
}

/// The turns that make columns of the rows of A.
fn diagonals([width, height]: [u32; 2]) -> [(&'static str, Placement); 4] {
    let (last_i, last_j) = (height - 1, width - 1);
    let other_diagonal = "mirrored at the diagonal from the bottom left to the top right";
    [
        ("transposed (its rows are A's columns)", Box::new(|[i, j]| [j, i])),
        (other_diagonal, Box::new(move |[i, j]| [last_j - j, last_i - i])),
        ("turned by 90 degrees to the left", Box::new(move |[i, j]| [j, last_i - i])),
        ("turned by 90 degrees to the right", Box::new(move |[i, j]| [last_j - j, i])),
    ]
}

/// The moves by so many rows, so many columns or both, and by no more: those down first, then those to the right.
fn ring(by: u32) -> Vec<[i32; 2]> {
    let by = by.cast_signed();
    let mut steps: Vec<i32> = (1..=by).flat_map(|step| [step, -step]).collect();
    steps.insert(0, 0);
    let both = |&rows: &i32| steps.iter().map(move |&columns| [rows, columns]);
    let all = steps.iter().flat_map(both);
    all.filter(|[rows, columns]| rows.abs().max(columns.abs()) == by).collect()
}

/// The move of B back to A in words.
fn moved([rows, columns]: [i32; 2]) -> String {
    let half = match rows.abs().max(columns.abs()) {
        1 => "; where edges lie on samples, half a pixel does that",
        _ => "",
    };
    agrees_once(&format!("moved {}{half}", steps_in_words([-rows, -columns])))
}

fn class(pair: &BufferPair, in_a: [u32; 2], in_b: [u32; 2]) -> Class {
    pair.compare_pixels(in_a, in_b).class()
}

/// Whether each pixel of A agrees with the pixel of B at its other place, and at least one of these pixels shows
/// something.
fn agree(pair: &BufferPair, place: &dyn Fn([u32; 2]) -> [u32; 2]) -> bool {
    let mut seen = false;
    for in_a in pixels(pair.a.size()) {
        let class = class(pair, in_a, place(in_a));
        if class.differs() {
            return false;
        }
        seen |= class == Class::Alike;
    }
    seen
}

/// The same for a picture B that lies `rows` and `columns` farther. A pixel that leaves or enters the picture has no
/// partner; unless that pixel is empty, the move does not explain its difference. Where a move is by more than a pixel, what
/// leaves or enters must be empty even if it does not differ, as far as coverage is known: a half that is missing would
/// look like the other half, moved.
fn agree_moved(pair: &BufferPair, [rows, columns]: [i32; 2], first: &[[u32; 2]]) -> bool {
    let [width, height] = pair.a.size();
    let moved = |[i, j]: [u32; 2], sign: i32| {
        let i = i.checked_add_signed(sign * rows).filter(|&i| i < height)?;
        Some([i, j.checked_add_signed(sign * columns).filter(|&j| j < width)?])
    };
    let empty = |buffer: &Buffer, pixel| {
        buffer.samples_of(pixel).all(|sample| buffer.covered(sample) == Some(false))
    };
    // A differing pixel refutes a move by its value in A, or by that in B.
    let is_refuted = |&pixel: &[u32; 2]| {
        moved(pixel, 1).is_some_and(|in_b| class(pair, pixel, in_b).differs())
            || moved(pixel, -1).is_some_and(|in_a| class(pair, in_a, pixel).differs())
    };
    if first.iter().any(is_refuted) {
        return false;
    }
    let is_strict = rows.abs().max(columns.abs()) > 1 && pair.compares(Aspect::Coverage);
    let mut seen = false;
    for pixel in pixels(pair.a.size()) {
        if let Some(in_b) = moved(pixel, 1) {
            let class = class(pair, pixel, in_b);
            if class.differs() {
                return false;
            }
            seen |= class == Class::Alike;
        }
        let explained = (moved(pixel, 1).is_some() || empty(pair.a, pixel))
            && (moved(pixel, -1).is_some() || empty(pair.b, pixel));
        if !explained && (is_strict || class(pair, pixel, pixel).differs()) {
            return false;
        }
    }
    seen
}

/// `1 row up and 1 column to the left`.
fn steps_in_words([rows, columns]: [i32; 2]) -> String {
    let words = |steps: i32, things: &str, [back, forth]: [&str; 2]| {
        let direction = if steps < 0 { back } else { forth };
        let number = count(steps.unsigned_abs().into(), things);
        (steps != 0).then(|| format!("{number} {direction}"))
    };
    let rows = words(rows, "rows", ["up", "down"]);
    let columns = words(columns, "columns", ["to the left", "to the right"]);
    rows.into_iter().chain(columns).collect::<Vec<_>>().join(" and ")
}
