//! How a curve grows, and where two curves cross, on logarithmic axes.

use super::point::Point;

/// The slope of a curve on logarithmic axes: 1 is linear, 0 is constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// The slope of the straight line with the least squares.
    pub value: f64,
    /// Its standard error, which says how well a straight line fits.
    pub error: f64,
    /// The least x of the points that count: the upper part of the curve, where constant costs matter least.
    pub from: f64,
    /// How many points count.
    pub points: usize,
}

/// The fewest points of a slope: through two, any line fits.
const FEWEST: usize = 3;

/// The slope of the upper half of a curve, or of its last three points; `None` if there are fewer.
pub(super) fn slope(points: &[Point]) -> Option<Slope> {
    let (first, last) = (points.first()?, points.last()?);
    let middle = (first.x * last.x).sqrt();
    let upper = points.iter().position(|point| point.x >= middle)?;
    let upper = &points[upper.min(points.len().checked_sub(FEWEST)?)..];
    let logs: Vec<[f64; 2]> = upper.iter().map(|point| [point.x.ln(), point.value.ln()]).collect();
    let count = logs.len() as f64;
    let mean = |k: usize| logs.iter().map(|log| log[k]).sum::<f64>() / count;
    let [x, y] = [mean(0), mean(1)];
    let spread: f64 = logs.iter().map(|log| (log[0] - x).powi(2)).sum();
    let both: f64 = logs.iter().map(|log| (log[0] - x) * (log[1] - y)).sum();
    let value = both / spread;
    let rest: f64 = logs.iter().map(|log| (log[1] - y - value * (log[0] - x)).powi(2)).sum();
    let error = (rest / (count - 2.0) / spread).sqrt();
    Some(Slope { value, error, from: upper[0].x, points: logs.len() })
}

/// Which of two curves is lower, along their common part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crossing {
    /// The curves have fewer than two points in common.
    Unknown,
    /// Nowhere are they apart by more than what tells nothing.
    Alike,
    /// One is lower wherever they are apart: the first one, or not; and by which factor at least and at most.
    None {
        /// Whether it is the first one.
        first: bool,
        /// The factors where they are apart.
        by: [f64; 2],
        /// Whether they are apart at every point.
        everywhere: bool,
    },
    /// They cross once.
    At {
        /// Where, between two points.
        x: f64,
        /// The value there.
        value: f64,
        /// Whether the first one is lower beyond.
        first: bool,
        /// Whether they are apart at the very next points on both sides, so that the place is certain to one step.
        sharp: bool,
    },
    /// They cross several times: between these points nobody can tell.
    Several {
        /// From here.
        from: f64,
        /// To here.
        to: f64,
        /// How often.
        times: usize,
    },
}

/// Looks where two curves with the same x cross. Values that are apart by less than a factor of `alike`, or whose
/// repetitions overlap, tell nothing.
pub(super) fn crossing(first: &[Point], second: &[Point], alike: f64) -> Crossing {
    let pairs: Vec<[Point; 2]> = first
        .iter()
        .filter_map(|a| {
            let b = second.iter().find(|b| b.x.to_bits() == a.x.to_bits())?;
            Some([*a, *b])
        })
        .collect();
    if pairs.len() < 2 {
        return Crossing::Unknown;
    }
    let is_apart = |[a, b]: &[Point; 2]| {
        let factor = (a.value / b.value).max(b.value / a.value);
        factor > alike && (a.most < b.least || b.most < a.least)
    };
    let apart: Vec<usize> = (0..pairs.len()).filter(|&at| is_apart(&pairs[at])).collect();
    let is_first = |at: usize| pairs[at][0].value < pairs[at][1].value;
    let changes: Vec<[usize; 2]> = apart
        .windows(2)
        .map(|two| [two[0], two[1]])
        .filter(|&[a, b]| is_first(a) != is_first(b))
        .collect();
    match (changes.as_slice(), apart.first()) {
        (_, None) => Crossing::Alike,
        ([], Some(&at)) => {
            let factors = apart.iter().map(|&at| {
                let [a, b] = pairs[at];
                (a.value / b.value).max(b.value / a.value)
            });
            let by = factors.fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], factor| {
                [least.min(factor), most.max(factor)]
            });
            Crossing::None { first: is_first(at), by, everywhere: apart.len() == pairs.len() }
        }
        (&[[before, after]], Some(_)) => {
            let (x, value) = meeting(&pairs[before..=after]);
            Crossing::At { x, value, first: is_first(after), sharp: after == before + 1 }
        }
        (several, Some(_)) => Crossing::Several {
            from: pairs[several[0][0]][0].x,
            to: pairs[several[several.len() - 1][1]][0].x,
            times: several.len(),
        },
    }
}

/// Where two curves meet between points whose ends lie on different sides: on the straight lines from point to point,
/// in the middle of all meetings.
fn meeting(pairs: &[[Point; 2]]) -> (f64, f64) {
    let gap = |[a, b]: &[Point; 2]| a.value.ln() - b.value.ln();
    let mut meetings = Vec::new();
    for two in pairs.windows(2) {
        let (before, after) = (gap(&two[0]), gap(&two[1]));
        if (before < 0.0) == (after < 0.0) {
            continue;
        }
        let part = before / (before - after);
        let between = |from: f64, to: f64| (from.ln() + part * (to.ln() - from.ln())).exp();
        meetings
            .push((between(two[0][0].x, two[1][0].x), between(two[0][0].value, two[1][0].value)));
    }
    meetings[meetings.len() / 2]
}
