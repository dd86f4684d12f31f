//! A value for each sample of a raster, for observers of a large picture.

use crate::common::raster::Sample;
use std::collections::HashMap;

/// A value for each sample. Squares of samples are stored only where something happens: each thread sees a small part of
/// the picture.
#[derive(Clone, Debug)]
pub(crate) struct SampleMap<T> {
    /// The value of a sample where nothing has happened.
    nothing: T,
    squares: HashMap<[usize; 2], Vec<T>>,
}

/// The number of samples along a side of a square.
const SQUARE: usize = 16;

impl<T: Copy> SampleMap<T> {
    /// A map in which nothing has happened.
    pub(crate) fn new(nothing: T) -> SampleMap<T> {
        SampleMap { nothing, squares: HashMap::new() }
    }

    /// The square of a sample, and the index of the sample in the square.
    fn place(Sample { row, column }: Sample) -> ([usize; 2], usize) {
        ([row / SQUARE, column / SQUARE], row % SQUARE * SQUARE + column % SQUARE)
    }

    /// The value of a sample.
    pub(crate) fn get(&self, sample: Sample) -> T {
        let (square, place) = Self::place(sample);
        self.squares.get(&square).map_or(self.nothing, |square| square[place])
    }

    /// The value of a sample, to be changed.
    pub(crate) fn get_mut(&mut self, sample: Sample) -> &mut T {
        let (square, place) = Self::place(sample);
        &mut self.square(square)[place]
    }

    fn square(&mut self, square: [usize; 2]) -> &mut [T] {
        self.squares.entry(square).or_insert_with(|| vec![self.nothing; SQUARE * SQUARE])
    }

    /// Joins each value of another part of the work to the value here.
    pub(crate) fn join(&mut self, part: SampleMap<T>, join: impl Fn(&mut T, T)) {
        for (square, more) in part.squares {
            let stored = self.square(square);
            stored.iter_mut().zip(more).for_each(|(stored, value)| join(stored, value));
        }
    }
}
