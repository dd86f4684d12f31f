//! The samples of rows in runs of one primitive each, and in groups of one material.

use super::chunk::{MOST_OF_BLOCK, WIDE};
use crate::engine::simd::{Compression, Simd, SimdBase, SimdMask, u32x16};
use crate::scene::material::Material;
use std::ops::Range;

/// Samples of a row, one after another, that show the same primitive.
#[derive(Clone, Copy)]
pub(super) struct Run {
    /// The first sample after them.
    end: u32,
    /// The primitive's place in what is kept, or [`NOTHING`].
    place: u32,
}

/// In the place of a primitive's place.
pub(super) const NOTHING: u32 = u32::MAX;

impl Run {
    /// One that ends before this sample of the chunk, and shows the primitive with this place, or [`NOTHING`].
    #[inline(always)]
    pub(super) fn new(end: u32, place: u32) -> Run {
        Run { end, place }
    }

    /// One in which nothing is seen, from the first sample of the chunk on.
    #[inline(always)]
    pub(super) fn of_nothing(samples: usize) -> Run {
        Run::new(u32::try_from(samples).expect("chunks are short"), NOTHING)
    }

    /// The first sample after it.
    #[inline(always)]
    pub(super) fn end(self) -> usize {
        self.end as usize
    }

    /// The primitive's place in what is kept; `None` where nothing is seen.
    #[inline(always)]
    pub(super) fn place(self) -> Option<usize> {
        (self.place != NOTHING).then_some(self.place as usize)
    }
}

/// The samples of the run with this number, of those of a chunk. Behind the last run, there are none.
#[inline(always)]
pub(super) fn samples_of(runs: &[Run], number: usize) -> Range<usize> {
    let begin = if number == 0 { 0 } else { runs[number - 1].end() };
    begin..runs.get(number).map_or(begin, |run| run.end())
}

/// The runs of the chunks of a block.
pub(super) struct Runs {
    /// No block has more runs than samples.
    runs: Box<[Run; MOST_OF_BLOCK]>,
    count: usize,
    /// The first run after each chunk.
    ends: Vec<usize>,
    /// The runs of the chunk that is looked at.
    chunk: Range<usize>,
}

impl Runs {
    pub(super) fn new() -> Runs {
        let runs = Box::new([Run::new(0, NOTHING); MOST_OF_BLOCK]);
        Runs { runs, count: 0, ends: Vec::new(), chunk: 0..0 }
    }

    pub(super) fn clear(&mut self) {
        self.count = 0;
        self.ends.clear();
    }

    /// Adds so many runs for the next chunk, which are to be filled.
    #[inline(always)]
    pub(super) fn add(&mut self, count: usize) -> &mut [Run] {
        let start = self.count;
        self.count += count;
        self.ends.push(self.count);
        &mut self.runs[start..self.count]
    }

    /// Goes to the chunk with this number.
    pub(super) fn go_to(&mut self, chunk: usize) {
        let start = if chunk == 0 { 0 } else { self.ends[chunk - 1] };
        self.chunk = start..self.ends[chunk];
    }

    /// Those of the chunk that is looked at.
    #[inline(always)]
    pub(super) fn of_chunk(&self) -> &[Run] {
        &self.runs[self.chunk.clone()]
    }
}

/// Samples of a row, one after another, that show one material, or nothing.
#[derive(Clone, Copy)]
pub(super) struct Group<'a> {
    /// The first sample after them.
    pub(super) end: usize,
    /// The material, and whether each sample has a tint.
    pub(super) shown: Option<(&'a Material, bool)>,
}

impl Group<'_> {
    /// Whether it shows this material in the same way, or both show nothing.
    #[inline(always)]
    pub(super) fn shows(&self, shown: Option<(&Material, bool)>) -> bool {
        let [own, other] = [self.shown, shown].map(Option::unzip);
        is_same(own.0, other.0) && own.1 == other.1
    }
}

/// Whether this is one material, not only an equal one, or both times nothing.
#[inline(always)]
pub(super) fn is_same(one: Option<&Material>, other: Option<&Material>) -> bool {
    match (one, other) {
        (None, None) => true,
        (Some(one), Some(other)) => std::ptr::eq(one, other),
        _ => false,
    }
}

/// The groups of a chunk.
#[derive(Default)]
pub(super) struct Groups<'a>(Vec<Group<'a>>);

impl<'a> Groups<'a> {
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Adds samples that end before this one, to the last group or as another one.
    #[inline(always)]
    pub(super) fn add(&mut self, end: usize, shown: Option<(&'a Material, bool)>) {
        match self.0.last_mut() {
            Some(last) if last.shows(shown) => last.end = end,
            _ => self.0.push(Group { end, shown }),
        }
    }

    pub(super) fn all(&self) -> &[Group<'a>] {
        &self.0
    }
}

/// Where the runs of a chunk end, and what they show.
pub(super) struct Ends {
    ids: [u32; WIDE],
    /// For each, the first sample after the run.
    ends: [u32; WIDE],
    count: usize,
}

impl Ends {
    pub(super) fn new() -> Ends {
        Ends { ids: [0; WIDE], ends: [0; WIDE], count: 0 }
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The id that each run shows, and the first sample after it.
    #[inline(always)]
    pub(super) fn iter(&self) -> impl Iterator<Item = (u32, u32)> {
        let (ids, ends) = (&self.ids[..self.count], &self.ends[..self.count]);
        ids.iter().zip(ends).map(|(&id, &end)| (id, end))
    }

    /// Finds the runs of a chunk: one ends where an id differs from the next one. Vectors find sixteen at a time, and no branch
    /// depends on more than whether there are any.
    #[inline(always)]
    pub(super) fn find<S: Simd>(&mut self, simd: S, ids: &[u32]) {
        self.count = 0;
        let (sixteens, rest) = ids.as_chunks();
        let mut ends =
            u32x16::load_array(simd, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]);
        for (number, these) in sixteens.iter().enumerate() {
            let these = u32x16::load_array(simd, *these);
            // The last of the chunk ends a run in any case.
            let next = ids.get(16 * number + 16).copied().unwrap_or(!these[15]);
            let next = these.slide::<1>(u32x16::splat(simd, next));
            let is_end = these.simd_ne(next);
            // Where no instruction compresses, what takes its place takes longer than all the rest.
            if is_end.any_true() {
                let compression = Compression::new(is_end);
                compression.store(these, &mut self.ids[self.count..]);
                compression.store(ends, &mut self.ends[self.count..]);
                self.count += is_end.to_bitmask().count_ones() as usize;
            }
            ends += u32x16::splat(simd, 16);
        }
        for (end, id) in (ends[0]..).zip(rest) {
            (self.ids[self.count], self.ends[self.count]) = (*id, end);
            self.count += usize::from(ids.get(end as usize) != Some(id));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::chunk::CHUNK;
    use super::*;
    use crate::engine::simd::{dispatch, levels};
    use proptest::collection::vec;
    use proptest::prelude::*;

    #[test]
    fn a_group_ends_where_the_material_or_its_tint_is_another() {
        let (one, other) = (Material::default(), Material::default());
        let mut groups = Groups::default();
        let shown = [
            None,
            Some((&one, false)),
            Some((&one, false)),
            Some((&other, false)),
            Some((&other, true)),
            None,
            None,
            Some((&one, false)),
        ];
        for (end, shown) in (1..).zip(shown) {
            groups.add(end, shown);
        }
        let ends: Vec<usize> = groups.all().iter().map(|group| group.end).collect();
        assert_eq!(ends, [1, 3, 4, 5, 7, 8]);
        for group in groups.all() {
            assert!(group.shows(shown[group.end - 1]), "{}", group.end);
        }
        groups.clear();
        assert!(groups.all().is_empty());
    }

    proptest! {
        #[test]
        fn a_run_ends_where_an_id_differs_from_the_next_one(
            runs in vec((prop_oneof![0..3_u32, Just(u32::MAX), any::<u32>()], 1..40_usize), 1..80),
            length in 1..=CHUNK,
        ) {
            let ids = runs.into_iter().flat_map(|(id, times)| std::iter::repeat_n(id, times));
            let ids: Vec<u32> = ids.take(length).collect();
            let mut end = 0;
            let expected: Vec<(u32, u32)> = ids
                .chunk_by(|a, b| a == b)
                .map(|run| {
                    end += u32::try_from(run.len()).unwrap();
                    (run[0], end)
                })
                .collect();
            for level in levels() {
                // What was found before does not matter.
                let mut ends = Ends { ids: [7; WIDE], ends: [7; WIDE], count: 9 };
                dispatch!(level, simd => ends.find(simd, &ids));
                prop_assert_eq!(ends.iter().collect::<Vec<_>>(), &expected[..], "{:?}", level);
                prop_assert_eq!(ends.count(), expected.len());
            }
        }
    }
}
