//! What a difference as a whole looks like: common mistakes of renderers.
//!
//! A hint is given only if its cause alone explains every difference. If several causes do, all hints are given: a
//! symmetric picture that is upside down may look like a picture that is moved.

use super::bands::unfinished;
use super::colors;
use super::placements::placements;
use crate::diff::aspect::Side;
use crate::diff::buffer::{Buffer, Content};
use crate::diff::buffer_pair::BufferPair;
use crate::diff::classes::Classes;
use std::collections::{BTreeMap, BTreeSet};

/// Every cause that alone explains every difference, one sentence each. A reference is right: it lacks nothing, and its
/// encoding is right too.
pub(in crate::diff) fn hints(
    pair: &BufferPair,
    differing: &Classes,
    reference: Option<Side>,
) -> Vec<String> {
    let both = [("A", pair.a), ("B", pair.b)];
    if let Some((name, _)) = both.into_iter().find(|(_, buffer)| is_empty(buffer)) {
        return vec![format!(
            "{name} covers nothing: is all of it culled, cut off, behind the eye, or missed between samples?"
        )];
    }
    let mut hints = placements(pair, differing);
    // The others look at all values, and so at those of ignored pixels, too.
    if pair.a.samples() != pair.b.samples() || !pair.ignored().is_empty() {
        return hints;
    }
    hints.extend(colors::encodings(pair, reference));
    hints.extend(unfinished(pair, differing));
    let named = [("A", pair.a, "B", pair.b), ("B", pair.b, "A", pair.a)];
    if let (Content::Ids(a), Content::Ids(b)) = (pair.a.content(), pair.b.content()) {
        hints.extend(renaming(a, b).map(|renaming| {
            format!(
                "the ids correspond one to one ({renaming}): the same primitives, counted in another \
                 order or from another number, or equally near ones decided otherwise"
            )
        }));
        let by_side = |side| if reference == Some(side) { lacks_rightly } else { lacks };
        hints.extend(lacking(a, b).map(|ids| by_side(Side::B)("B", &ids, "A")));
        hints.extend(lacking(b, a).map(|ids| by_side(Side::A)("A", &ids, "B")));
    }
    let may_be_miswritten = |name: &str| match reference {
        Some(Side::A) => name != "A",
        Some(Side::B) => name != "B",
        None => true,
    };
    for (name, buffer, _, other) in named {
        if may_be_miswritten(name) {
            hints.extend(zero_is_nothing(name, buffer, other));
        }
    }
    if is_inverted(pair) {
        let of_integers = named
            .into_iter()
            .find(|(name, buffer, ..)| may_be_miswritten(name) && has_only_zeros(buffer));
        hints.push(match of_integers {
            Some((name, ..)) => format!(
                "B covers exactly what A does not; if {name} is a mask of integers, its 0 is read as an \
                 id and its 255 as nothing: save it as bool"
            ),
            None => "B covers exactly what A does not".into(),
        });
    }
    hints
}

/// The renaming of ids between A and B, if both cover the same samples, each id has one partner, and some ids differ.
fn renaming(a: &[Option<u64>], b: &[Option<u64>]) -> Option<String> {
    let (mut forth, mut back) = (BTreeMap::new(), BTreeMap::new());
    let mut last = (None, None);
    for (&a, &b) in a.iter().zip(b) {
        // Neighbours mostly show the same.
        if (a, b) == last {
            continue;
        }
        last = (a, b);
        match (a, b) {
            (None, None) => {}
            (Some(a), Some(b)) => {
                if *forth.entry(a).or_insert(b) != b || *back.entry(b).or_insert(a) != a {
                    return None;
                }
            }
            _ => return None,
        }
    }
    let renamed: Vec<String> = forth
        .iter()
        .filter(|(a, b)| a != b)
        .map(|(a, b)| format!("{a} in A is {b} in B"))
        .collect();
    (!renamed.is_empty()).then(|| listed(&renamed))
}

/// The first three of a list.
fn listed(words: &[String]) -> String {
    match words {
        [first, second, third, _, ..] => format!("{first}, {second}, {third}, ..."),
        few => few.join(", "),
    }
}

/// The ids that one file shows and the other file never shows, if the only difference is that the other file shows
/// nothing there, or the primitive behind.
fn lacking(shows: &[Option<u64>], lacks: &[Option<u64>]) -> Option<Vec<u64>> {
    let differing = || shows.iter().zip(lacks).filter(|(one, other)| one != other);
    let lacking: Option<BTreeSet<u64>> = differing().map(|(one, _)| *one).collect();
    let lacking = lacking?;
    let shown: BTreeSet<u64> = runs(shows).copied().flatten().collect();
    // The primitive visible in its place must also be a primitive that the other file knows.
    let explained = |id: &u64| shown.contains(id) && !lacking.contains(id);
    let holds = runs(lacks).flatten().all(explained);
    (holds && !lacking.is_empty()).then(|| lacking.into_iter().collect())
}

/// The values, each run of equal ones once.
fn runs(values: &[Option<u64>]) -> impl Iterator<Item = &Option<u64>> {
    values.chunk_by(PartialEq::eq).map(|run| &run[0])
}

fn lacks(name: &str, ids: &[u64], other: &str) -> String {
    format!(
        "{name} never shows {} of {other}, and agrees elsewhere: culled, cut off, not drawn, or missed between \
         samples?",
        primitives(ids)
    )
}

/// The same of a file that is right.
fn lacks_rightly(name: &str, ids: &[u64], other: &str) -> String {
    format!(
        "{other} shows {}, which {name} never shows, and agrees elsewhere; {name} is right",
        primitives(ids)
    )
}

/// `the primitives 7, 9`.
fn primitives(ids: &[u64]) -> String {
    let things = if ids.len() == 1 { "the primitive" } else { "the primitives" };
    let ids: Vec<String> = ids.iter().map(u64::to_string).collect();
    format!("{things} {}", listed(&ids))
}

/// The meaning of 0 in a buffer that covers everything, if the buffers agree with that meaning and differ otherwise.
fn zero_is_nothing(name: &str, buffer: &Buffer, other: &Buffer) -> Vec<String> {
    let Content::Ids(ids) = buffer.content() else { return Vec::new() };
    if ids.contains(&None) || !ids.contains(&Some(0)) {
        return Vec::new();
    }
    let mut pairs = buffer.all_samples().zip(other.all_samples());
    let coverage = pairs.all(|(own, other_s)| other.covered(other_s) == Some(ids[own] != Some(0)));
    if !coverage {
        return Vec::new();
    }
    let is_mask = ids.iter().flatten().all(|&id| id <= 1);
    let nothing = "write the largest number of the type, or -1";
    let mut meant = Vec::new();
    let mut add = |what: String| meant.push(format!("in {name}, 0 stands for nothing: {what}"));
    match other.content() {
        Content::Ids(expected) => {
            let read = |first: u64| {
                let with = |id: &Option<u64>| id.and_then(|id| id.checked_sub(first));
                ids.iter().zip(expected).all(|(id, expected)| {
                    if *id == Some(0) { expected.is_none() } else { with(id) == *expected }
                })
            };
            if read(0) {
                add(nothing.into());
            }
            if read(1) {
                add(format!("ids count from 0; for nothing, {nothing}"));
            }
        }
        _ if !is_mask => add(nothing.into()),
        _ => {}
    }
    if is_mask {
        add("a mask of integers is read as ids; save it as bool".into());
    }
    meant
}

fn has_only_zeros(buffer: &Buffer) -> bool {
    matches!(buffer.content(), Content::Ids(ids) if ids.iter().flatten().all(|&id| id == 0))
}

fn is_inverted(pair: &BufferPair) -> bool {
    let mut pairs = pair.a.all_samples().zip(pair.b.all_samples());
    pairs.all(|(a, b)| match [pair.a.covered(a), pair.b.covered(b)] {
        [Some(by_a), Some(by_b)] => by_a != by_b,
        _ => false,
    })
}

/// Whether nothing is covered, as far as the buffer tells.
fn is_empty(buffer: &Buffer) -> bool {
    buffer.all_samples().all(|sample| buffer.covered(sample) == Some(false))
}
