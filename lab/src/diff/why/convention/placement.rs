//! The place of a pixel in a file.

/// The place of a pixel in the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Placement {
    /// Rows from the top, columns from the left.
    #[default]
    Upright,
    /// Rows from the bottom.
    UpsideDown,
    /// Columns from the right.
    LeftToRight,
    /// Rows from the bottom and columns from the right.
    HalfTurn,
    /// Rows are columns.
    Transposed,
    /// A quarter turn to the left.
    TurnedLeft,
    /// A quarter turn to the right.
    TurnedRight,
    /// Rows are columns, both counted from the other end.
    OtherDiagonal,
    /// The pixels of the first column, from top to bottom, then those of the next, in a file of as many rows and columns as
    /// the picture. In a square picture that is [`Placement::Transposed`].
    ByColumns,
}

impl Placement {
    /// All placements, ours first.
    pub const ALL: [Placement; 9] = [
        Placement::Upright,
        Placement::UpsideDown,
        Placement::LeftToRight,
        Placement::HalfTurn,
        Placement::Transposed,
        Placement::TurnedLeft,
        Placement::TurnedRight,
        Placement::OtherDiagonal,
        Placement::ByColumns,
    ];

    /// The placements that pictures of these sizes tell from each other: in a square one, [`Placement::ByColumns`] is
    /// [`Placement::Transposed`].
    pub(in crate::diff::why) fn distinct(
        mut images: impl Iterator<Item = [u32; 2]>,
    ) -> impl Iterator<Item = Placement> {
        let are_square = images.all(|[width, height]| width == height);
        let all = Placement::ALL.into_iter();
        all.filter(move |&placement| placement != Placement::ByColumns || !are_square)
    }

    /// Whether the file has as many rows as the picture has columns.
    pub fn swaps_sides(self) -> bool {
        use Placement::{OtherDiagonal, Transposed, TurnedLeft, TurnedRight};
        matches!(self, Transposed | TurnedLeft | TurnedRight | OtherDiagonal)
    }

    /// Whether a file of this size may show a picture of that size so. Both are width and height.
    pub fn fits(self, file: [u32; 2], [width, height]: [u32; 2]) -> bool {
        file == if self.swaps_sides() { [height, width] } else { [width, height] }
    }

    /// Where the pixel `(i, j)` of a picture of this width and height lies in the file: its row and its column. For whole numbers
    /// beside the picture, too, unless the file is written by columns.
    pub(in crate::diff::why) fn in_file(
        self,
        [i, j]: [isize; 2],
        [width, height]: [isize; 2],
    ) -> [isize; 2] {
        match self {
            Placement::Upright => [i, j],
            Placement::UpsideDown => [height - 1 - i, j],
            Placement::LeftToRight => [i, width - 1 - j],
            Placement::HalfTurn => [height - 1 - i, width - 1 - j],
            Placement::Transposed => [j, i],
            Placement::TurnedLeft => [width - 1 - j, i],
            Placement::TurnedRight => [j, height - 1 - i],
            Placement::OtherDiagonal => [width - 1 - j, height - 1 - i],
            Placement::ByColumns => {
                let number = j * height + i;
                [number / width, number % width]
            }
        }
    }

    /// The pixel of the picture that lies at `(i, j)` of the file; `[width, height]` is the size of the picture.
    pub fn pixel(self, [i, j]: [usize; 2], [width, height]: [usize; 2]) -> [usize; 2] {
        match self {
            Placement::Upright => [i, j],
            Placement::UpsideDown => [height - 1 - i, j],
            Placement::LeftToRight => [i, width - 1 - j],
            Placement::HalfTurn => [height - 1 - i, width - 1 - j],
            Placement::Transposed => [j, i],
            Placement::TurnedLeft => [j, width - 1 - i],
            Placement::TurnedRight => [height - 1 - j, i],
            Placement::OtherDiagonal => [height - 1 - j, width - 1 - i],
            Placement::ByColumns => {
                let number = i * width + j;
                [number % height, number / height]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_placement_reaches_every_pixel_once() {
        let size @ [width, height] = [3, 2];
        for placement in Placement::ALL {
            let [columns, rows] =
                if placement.swaps_sides() { [height, width] } else { [width, height] };
            let mut seen = vec![0; 6];
            for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
                let [i, j] = placement.pixel([i, j], size);
                seen[i * width + j] += 1;
            }
            assert_eq!(seen, [1; 6], "{placement:?}");
        }
    }
}
