//! What a difference as a whole looks like: mistakes that every renderer makes once.

use super::look::Pair;
use super::{Buffer, Content};
use crate::diff::{Class, pixels};
use std::collections::BTreeMap;

/// What may be the cause, each in a sentence.
pub(super) fn hints(pair: &Pair) -> Vec<String> {
    let mut hints = Vec::new();
    if let Some(moved) = moved(pair) {
        hints.push(format!("B agrees with A once it is {moved}"));
    }
    if let (Content::Ids(a), Content::Ids(b)) = (&pair.a.content, &pair.b.content)
        && pair.a.samples == pair.b.samples
        && let Some(renaming) = renaming(a, b)
    {
        hints.push(format!(
            "where both cover, the ids correspond one to one ({renaming}): \
             the same primitives, counted in another order or from another number"
        ));
    }
    for (name, buffer, other) in [("A", pair.a, pair.b), ("B", pair.b, pair.a)] {
        if covers_all_with_zero(buffer) && leaves_something_out(other) {
            hints.push(format!(
                "{name} covers every pixel and has the id 0: ids count from 0, and nothing is the \
                 largest number of the type, or -1; a mask is saved as bool"
            ));
        }
    }
    if is_inverted(pair) {
        hints.push(
            "B covers exactly what A does not; a mask of integers is read as ids, save it as bool"
                .into(),
        );
    }
    hints
}

/// How B must be turned or moved to agree with A.
fn moved(pair: &Pair) -> Option<String> {
    if pair.a.samples != 1 || pair.b.samples != 1 {
        return None;
    }
    let [width, height] = pair.a.size;
    let turned = [("upside down", true, false), ("left to right", false, true)];
    for (name, rows, columns) in turned.into_iter().chain([("by 180 degrees", true, true)]) {
        let mirrored =
            |side: u32, index: u32, mirror| if mirror { side - 1 - index } else { index };
        let place =
            |[i, j]: [u32; 2]| Some([mirrored(height, i, rows), mirrored(width, j, columns)]);
        if agree(pair, place) {
            return Some(format!("turned {name}"));
        }
    }
    let steps = [0, 1, -1];
    let moves = steps.into_iter().flat_map(|rows| steps.map(|columns| [rows, columns]));
    for [rows, columns] in moves.skip(1) {
        let place = |[i, j]: [u32; 2]| {
            let i = i.checked_add_signed(rows).filter(|&i| i < height)?;
            Some([i, j.checked_add_signed(columns).filter(|&j| j < width)?])
        };
        if agree(pair, place) {
            return Some(format!("moved by {} rows and {} columns", -rows, -columns));
        }
    }
    None
}

/// Whether each pixel of A agrees with the one of B at another place, if there is one, and
/// something is seen in any of them.
fn agree(pair: &Pair, place: impl Fn([u32; 2]) -> Option<[u32; 2]>) -> bool {
    let index = |[i, j]: [u32; 2]| i as usize * pair.a.size[0] as usize + j as usize;
    let mut seen = false;
    for in_a in pixels(pair.a.size) {
        let Some(in_b) = place(in_a) else { continue };
        let class = pair.look(index(in_a), index(in_b)).class();
        if class.differs() {
            return false;
        }
        seen |= class == Class::Alike;
    }
    seen
}

/// The ids of A and B side by side, if each has one partner and they are not the same.
fn renaming(a: &[Option<u64>], b: &[Option<u64>]) -> Option<String> {
    let (mut forth, mut back) = (BTreeMap::new(), BTreeMap::new());
    for (&a, &b) in a.iter().zip(b) {
        if let (Some(a), Some(b)) = (a, b)
            && (*forth.entry(a).or_insert(b) != b || *back.entry(b).or_insert(a) != a)
        {
            return None;
        }
    }
    let renamed: Vec<String> = forth
        .iter()
        .filter(|(a, b)| a != b)
        .map(|(a, b)| format!("{a} in A is {b} in B"))
        .collect();
    match renamed.len() {
        0 => None,
        1..=3 => Some(renamed.join(", ")),
        _ => Some(renamed[..3].join(", ") + ", ..."),
    }
}

/// Whether all is covered, and id 0 among it: a sign that 0 was meant as nothing.
fn covers_all_with_zero(buffer: &Buffer) -> bool {
    matches!(&buffer.content, Content::Ids(ids) if ids.contains(&Some(0)) && !ids.contains(&None))
}

fn leaves_something_out(buffer: &Buffer) -> bool {
    (0..samples(buffer)).any(|sample| buffer.covered(sample) == Some(false))
}

fn is_inverted(pair: &Pair) -> bool {
    let differs = |sample| match [pair.a, pair.b].map(|buffer| buffer.covered(sample)) {
        [Some(by_a), Some(by_b)] => by_a != by_b,
        _ => false,
    };
    pair.a.samples == pair.b.samples && (0..samples(pair.a)).all(differs)
}

fn samples(buffer: &Buffer) -> usize {
    let pixels: usize = buffer.size.iter().map(|&side| side as usize).product();
    pixels * (buffer.samples as usize).pow(2)
}
