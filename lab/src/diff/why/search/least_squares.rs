//! Least squares, by their normal equations.

/// A contour tells a way in which a picture is moved if it tells it to within this, a part of the depth, of the picture's size, or an
/// angle, where all of its pieces are off by a pixel. By what pixels round, they are off by less, but neighbours alike.
const MOST_DOUBT: f64 = 0.01;

/// How the place of something moves.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// For each way in which it can be moved, the columns and rows by which it moves.
    pub(super) slopes: Vec<[f64; 2]>,
    /// The columns and rows by which it should.
    pub(super) offset: [f64; 2],
    pub(super) weight: f64,
}

impl Row {
    /// The same, as far as it is a move along a direction, in lengths of which it counts.
    pub(super) fn along(self, direction: [f64; 2]) -> Row {
        let part = |[x, y]: [f64; 2]| [x * direction[0] + y * direction[1], 0.0];
        let Row { slopes, offset, weight } = self;
        Row { slopes: slopes.into_iter().map(part).collect(), offset: part(offset), weight }
    }

    /// How many pixels are left of the offset.
    pub(super) fn left(&self, by: &[f64]) -> f64 {
        let left = [0, 1].map(|axis| {
            let moved: f64 = self.slopes.iter().zip(by).map(|(slope, by)| slope[axis] * by).sum();
            self.offset[axis] - moved
        });
        left[0].hypot(left[1])
    }
}

/// The solution of most rows: without those that are farther off than three times the middle one, and than the least.
pub(super) fn solution_of_most(mut rows: Vec<Row>, freedom: usize, least: f64) -> Option<Vec<f64>> {
    let by = NormalEquations::new(&rows, freedom).solution()?;
    let mut left: Vec<f64> = rows.iter().map(|row| row.left(&by)).collect();
    left.sort_by(f64::total_cmp);
    let most = 3.0 * left.get(left.len() / 2)? + least;
    rows.retain(|row| row.left(&by) <= most);
    NormalEquations::new(&rows, freedom).solution()
}

/// The normal equations of some rows. A way that no place depends on stays as it is.
pub(super) struct NormalEquations {
    matrix: Vec<Vec<f64>>,
    right: Vec<f64>,
}

impl NormalEquations {
    pub(super) fn new(rows: &[Row], freedom: usize) -> NormalEquations {
        let mut matrix = vec![vec![0.0; freedom]; freedom];
        let mut right = vec![0.0; freedom];
        for row in rows {
            for axis in 0..2 {
                let slopes = row.slopes.iter().map(|slope| slope[axis]);
                for ((line, right), own) in matrix.iter_mut().zip(&mut right).zip(slopes.clone()) {
                    let weighted = row.weight * own;
                    line.iter_mut().zip(slopes.clone()).for_each(|(sum, by)| *sum += weighted * by);
                    *right += weighted * row.offset[axis];
                }
            }
        }
        let largest = (0..freedom).map(|way| matrix[way][way]).fold(0.0, f64::max);
        for (way, line) in matrix.iter_mut().enumerate() {
            line[way] += 1e-9 * largest;
        }
        NormalEquations { matrix, right }
    }

    /// By how much each way is moved.
    pub(super) fn solution(&self) -> Option<Vec<f64>> {
        self.solved(&self.right)
    }

    /// Whether they tell each way to within [`MOST_DOUBT`].
    pub(super) fn tell_all_ways(&self) -> bool {
        self.doubts().is_some_and(|doubts| doubts.iter().all(|doubt| *doubt <= MOST_DOUBT))
    }

    /// How far off each way is in the mean where each row of weight 1 is off by a pixel, and none as its neighbours are.
    fn doubts(&self) -> Option<Vec<f64>> {
        let freedom = self.right.len();
        let doubts = (0..freedom).map(|way| {
            let mut unit = vec![0.0; freedom];
            unit[way] = 1.0;
            self.solved(&unit).map(|column| column[way].sqrt())
        });
        doubts.collect()
    }

    /// By Gaussian elimination.
    fn solved(&self, right: &[f64]) -> Option<Vec<f64>> {
        let freedom = right.len();
        let lines = self.matrix.iter().zip(right);
        let mut matrix: Vec<Vec<f64>> =
            lines.map(|(line, right)| line.iter().copied().chain([*right]).collect()).collect();
        for way in 0..freedom {
            let pivot = (way..freedom).max_by(|&one, &other| {
                matrix[one][way].abs().total_cmp(&matrix[other][way].abs())
            })?;
            matrix.swap(way, pivot);
            let (head, rest) = matrix.split_at_mut(way + 1);
            let pivot = &head[way];
            for row in rest {
                let factor = row[way] / pivot[way];
                row.iter_mut().zip(pivot).for_each(|(value, of_pivot)| *value -= factor * of_pivot);
            }
        }
        let mut by = vec![0.0; freedom];
        for way in (0..freedom).rev() {
            let known: f64 = (way + 1..freedom).map(|other| matrix[way][other] * by[other]).sum();
            by[way] = (matrix[way][freedom] - known) / matrix[way][way];
        }
        by.iter().all(|by| by.is_finite()).then_some(by)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_near(one: f64, other: f64) -> bool {
        (one - other).abs() < 1e-6
    }

    fn row(slopes: &[[f64; 2]], offset: [f64; 2], weight: f64) -> Row {
        Row { slopes: slopes.to_vec(), offset, weight }
    }

    #[test]
    fn least_squares_weigh_what_they_are_told_and_leave_what_no_place_tells() {
        let slopes = [[1.0, 0.0], [1.0, 2.0], [0.0, 0.0]];
        let rows = [row(&slopes, [5.0, 4.0], 1.0), row(&slopes, [9.0, 4.0], 3.0)];
        let by = NormalEquations::new(&rows, 3).solution().unwrap();
        // Of 5 and 9, with their weights, 8.
        assert!(is_near(by[0], 6.0) && is_near(by[1], 2.0) && by[2] == 0.0, "{by:?}");
        assert!(is_near(rows[0].left(&by), 3.0) && is_near(rows[1].left(&by), 1.0));
        assert_eq!(NormalEquations::new(&[], 1).solution(), None);
    }

    #[test]
    fn what_is_far_off_is_left_out() {
        let at = |offset: f64| row(&[[1.0, 0.0]], [offset, 0.0], 1.0);
        let rows: Vec<Row> = [2.0, 2.1, 1.9, 2.0, 2.0, 2.0, 30.0].map(at).to_vec();
        assert!(is_near(solution_of_most(rows.clone(), 1, 0.5).unwrap()[0], 2.0));
        assert!(is_near(solution_of_most(rows, 1, 50.0).unwrap()[0], 6.0));
    }

    #[test]
    fn a_row_along_a_direction_tells_nothing_across_it() {
        let along = row(&[[1.0, 0.0], [0.0, 2.0]], [3.0, 5.0], 1.0).along([0.6, 0.8]);
        assert!(is_near(along.offset[0], 5.8) && along.offset[1] == 0.0, "{along:?}");
        // A move across the direction.
        assert!(is_near(along.left(&[0.8, -0.3]), 5.8));
        assert!(is_near(along.left(&[3.0, 2.5]), 0.0));
    }

    #[test]
    fn more_rows_leave_less_doubt_and_none_leave_much() {
        let one = row(&[[10.0, 0.0], [0.0, 0.0]], [0.0; 2], 1.0);
        let doubts = |count| NormalEquations::new(&vec![one.clone(); count], 2).doubts().unwrap();
        assert!(is_near(doubts(1)[0], 0.1) && is_near(doubts(4)[0], 0.05));
        assert!(doubts(4)[1] > 100.0, "{:?}", doubts(4));
        let tell = |slope: f64| NormalEquations::new(&[row(&[[slope, 0.0]], [0.0; 2], 1.0)], 1);
        assert!(tell(101.0).tell_all_ways() && !tell(99.0).tell_all_ways());
    }
}
