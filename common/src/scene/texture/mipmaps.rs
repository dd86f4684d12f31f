//! The smaller pictures of a texture.

use super::level::Level;
use glam::Vec3;
use rayon::prelude::*;

/// A picture, and behind it the smaller ones, down to a single texel.
pub(super) fn levels(picture: Level) -> Vec<Level> {
    let mut levels = vec![picture];
    while let Some(last) = levels.last().filter(|last| last.size() != [1, 1]) {
        levels.push(halved(last));
    }
    levels
}

/// A picture of half the width and half the height, rounded down, but at least 1. Each texel is the average over the
/// rectangle of the larger picture that it covers, so the average of the whole stays the same.
///
/// A sum is made in `f64`, in one order, on whatever thread: every machine gets the same texels.
fn halved(larger: &Level) -> Level {
    let [width, height] = larger.size().map(|side| (side / 2).max(1));
    let [columns, rows] = [(larger.size()[0], width), (larger.size()[1], height)]
        .map(|(from, to)| (0..to).map(|at| Span::new(at, from, to)).collect::<Vec<_>>());
    let mut texels = vec![Vec3::ZERO; width * height];
    texels.par_chunks_mut(width).zip(&rows).for_each(|(line, row)| {
        for (texel, column) in line.iter_mut().zip(&columns) {
            *texel = average(larger, row, column);
        }
    });
    Level { width, texels }
}

/// The texels of a row or a column of the larger picture that one of the smaller picture covers: at most four, with the
/// part that each has of it.
struct Span {
    first: usize,
    parts: [f64; 4],
    count: usize,
}

impl Span {
    /// Texel `at` of `to` covers `from/to` texels.
    fn new(at: usize, from: usize, to: usize) -> Span {
        // In units of 1/to of a larger texel, all borders are whole.
        let (begin, end) = (at * from, (at + 1) * from);
        let (first, last) = (begin / to, end.div_ceil(to));
        let mut parts = [0.0; 4];
        for (part, texel) in parts.iter_mut().zip(first..last) {
            let covered = end.min((texel + 1) * to) - begin.max(texel * to);
            #[expect(clippy::cast_precision_loss, reason = "sides have fewer than 53 bits")]
            let of_all = covered as f64 / from as f64;
            *part = of_all;
        }
        Span { first, parts, count: last - first }
    }

    fn texels(&self) -> impl Iterator<Item = (usize, f64)> {
        (self.first..).zip(self.parts).take(self.count)
    }
}

fn average(larger: &Level, row: &Span, column: &Span) -> Vec3 {
    let mut sum = glam::DVec3::ZERO;
    for (i, down) in row.texels() {
        for (j, across) in column.texels() {
            sum += larger.texel(i, j).as_dvec3() * (down * across);
        }
    }
    sum.as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn picture(height: usize, width: usize) -> Level {
        let value = |k: usize| (k as f32 * 0.618_034).fract();
        let texel = |k| Vec3::new(value(k), value(3 * k + 1), value(7 * k));
        Level { width, texels: (0..width * height).map(texel).collect() }
    }

    fn mean(level: &Level) -> DVec3 {
        let sum: DVec3 = level.texels.iter().map(|texel| texel.as_dvec3()).sum();
        sum / level.texels.len() as f64
    }

    #[test]
    fn every_level_has_the_mean_of_the_picture() {
        for (height, width) in [(16, 16), (7, 13), (9, 1), (2, 31), (3, 3)] {
            let levels = levels(picture(height, width));
            let sizes: Vec<[usize; 2]> = levels.iter().map(Level::size).collect();
            assert_eq!(sizes.last(), Some(&[1, 1]), "{width} × {height}");
            for level in &levels {
                let apart = (mean(level) - mean(&levels[0])).abs().max_element();
                assert!(apart < 1e-6, "{width} × {height} at {:?}: {apart}", level.size());
            }
        }
    }

    #[test]
    fn a_texel_is_the_mean_of_the_four_that_it_covers() {
        let levels = levels(picture(4, 8));
        let (large, small) = (&levels[0], &levels[1]);
        assert_eq!(small.size(), [4, 2]);
        for (i, j) in [(0, 0), (1, 3), (0, 2)] {
            let of = |di, dj| large.texel(2 * i + di, 2 * j + dj).as_dvec3();
            let expected = (of(0, 0) + of(1, 0) + of(0, 1) + of(1, 1)) / 4.0;
            assert!((small.texel(i, j).as_dvec3() - expected).length() < 1e-7);
        }
    }

    /// Three columns become one: each counts a third. Five become two, and the third is halved between them.
    #[test]
    fn odd_sides_are_cut_where_the_smaller_texels_end() {
        let row = |values: &[f32]| Level {
            width: values.len(),
            texels: values.iter().map(|&value| Vec3::splat(value)).collect(),
        };
        assert_eq!(halved(&row(&[0.0, 0.75, 0.0])).texels, [Vec3::splat(0.25)]);
        let two = halved(&row(&[1.0, 1.0, 0.5, 0.0, 0.0])).texels;
        assert_eq!(two, [0.9, 0.1].map(Vec3::splat));
    }
}
