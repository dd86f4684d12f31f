//! What is seen of a scene: in all rows of a picture, or in some.

use super::convention::Part;
use crate::common::frame::NO_PRIMITIVE;
use std::ops::Range;

/// What is seen of a scene in some rows of a picture.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    pub(super) width: usize,
    /// The row numbers, ascending and equally spaced.
    pub(super) rows: Vec<usize>,
    /// The visible primitive of each pixel, row by row; `NO_PRIMITIVE` for nothing.
    pub(super) ids: Vec<u32>,
    /// Its distance `t`.
    pub(super) t: Vec<f64>,
}

impl Drawn {
    /// Gives every pixel what the first one sees.
    pub(super) fn repeat_first(&mut self) {
        let (Some(&id), Some(&t)) = (self.ids.first(), self.t.first()) else { return };
        self.ids.fill(id);
        self.t.fill(t);
    }

    /// Shows nothing but in these rows and columns.
    pub(super) fn keep_only(&mut self, rows: &Range<usize>, columns: &Range<usize>) {
        for (line, row) in self.rows.iter().enumerate() {
            let kept = if rows.contains(row) { columns.clone() } else { 0..0 };
            let begin = line * self.width;
            for beside in [begin..begin + kept.start, begin + kept.end..begin + self.width] {
                self.ids[beside.clone()].fill(NO_PRIMITIVE);
                self.t[beside].fill(f64::INFINITY);
            }
        }
    }

    /// Shows nothing in a part of the picture.
    pub(super) fn clear(&mut self, part: &Part) {
        let [rows, columns] =
            [part.rows, part.columns].map(|[first, last]| first as usize..=last as usize);
        for (line, _) in self.rows.iter().enumerate().filter(|(_, row)| rows.contains(row)) {
            let (begin, end) =
                (line * self.width + columns.start(), line * self.width + columns.end());
            self.ids[begin..=end].fill(NO_PRIMITIVE);
            self.t[begin..=end].fill(f64::INFINITY);
        }
    }
}

/// The rows of a picture that are drawn: every `step`-th, and the same number of rows above as below.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rows {
    pub(super) step: usize,
}

impl Rows {
    pub(super) const ALL: Rows = Rows { step: 1 };

    pub(super) fn numbers(self, height: usize) -> Vec<usize> {
        let first = (height - 1) % self.step / 2;
        (first..height).step_by(self.step).collect()
    }
}
