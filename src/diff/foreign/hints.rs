//! What a difference as a whole looks like: mistakes that every renderer makes once.

use super::compare::Pair;
use super::{Buffer, Content};
use std::collections::BTreeMap;

/// What may be the cause, each in a sentence.
pub(super) fn hints(pair: &Pair) -> Vec<String> {
    let mut hints = Vec::new();
    if let Some(turned) = turned(pair) {
        hints.push(format!("B agrees with A once it is turned {turned}"));
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

/// How B must be turned to agree with A everywhere.
fn turned(pair: &Pair) -> Option<&'static str> {
    if pair.a.samples != 1 || pair.b.samples != 1 {
        return None;
    }
    let [width, height] = pair.a.size.map(|side| side as usize);
    let ways: [(&str, bool, bool); 3] = [
        ("upside down", true, false),
        ("left to right", false, true),
        ("by 180 degrees", true, true),
    ];
    let agrees = |&(_, rows, columns): &(&str, bool, bool)| {
        (0..width * height).all(|pixel| {
            let (i, j) = (pixel / width, pixel % width);
            let i = if rows { height - 1 - i } else { i };
            let j = if columns { width - 1 - j } else { j };
            !pair.look(pixel, i * width + j).class().differs()
        })
    };
    ways.iter().find(|way| agrees(way)).map(|(name, ..)| *name)
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
