//! The polygons of a mesh that is being read: each is a fan until the positions of all vertices are known.

use super::Cutter;
use crate::attributes::NONE;
use glam::Vec3;
use rayon::prelude::*;

/// Tells which triangles are one polygon, with a bit for each triangle up to the last polygon that is none itself.
#[derive(Debug, Default)]
pub(crate) struct Fans {
    /// Whether a triangle goes on with the fan of the one before it.
    goes_on: Vec<u64>,
}

/// The polygons of a mesh that must not be fans, and their triangles.
pub(crate) struct Recuts {
    parts: Vec<Part>,
}

/// The same of a part of a mesh.
#[derive(Default)]
struct Part {
    fans: Vec<Fan>,
    /// As numbers of the polygon's corners, for one polygon after another.
    cut: Vec<[u32; 3]>,
}

/// Triangles that follow one another.
#[derive(Clone, Copy)]
struct Fan {
    first: usize,
    count: usize,
}

/// So many words of bits are looked at in one go.
const WORDS_AT_ONCE: usize = 1 << 8;

impl Fans {
    /// Notes a polygon of so many corners, at least three, whose fan begins with this triangle.
    #[inline]
    pub(crate) fn add(&mut self, first: usize, corners: usize) {
        for triangle in first + 1..first + corners - 2 {
            let word = triangle / 64;
            if word >= self.goes_on.len() {
                self.goes_on.resize(word + 1, 0);
            }
            self.goes_on[word] |= 1 << (triangle % 64);
        }
    }

    /// Appends the polygons of the next piece of a mesh, which begins with this triangle.
    pub(crate) fn append(&mut self, piece: &Fans, first: usize) {
        if piece.goes_on.is_empty() {
            return;
        }
        let (word, shift) = (first / 64, first % 64);
        let words = word + piece.goes_on.len() + 1;
        self.goes_on.resize(words.max(self.goes_on.len()), 0);
        for (k, &bits) in piece.goes_on.iter().enumerate() {
            self.goes_on[word + k] |= bits << shift;
            if shift > 0 {
                self.goes_on[word + k + 1] |= bits >> (64 - shift);
            }
        }
    }

    /// Finds the polygons that must not be fans. All triangles of the mesh are those of fans.
    pub(crate) fn recuts(&self, positions: &[Vec3], triangles: &[[u32; 3]]) -> Recuts {
        let chunks = self.goes_on.par_chunks(WORDS_AT_ONCE).enumerate();
        let parts = chunks.map(|(chunk, words)| {
            let (mut cutter, mut part) = (Cutter::default(), Part::default());
            for (word, _) in words.iter().enumerate().filter(|&(_, &word)| word != 0) {
                let begin = 64 * (chunk * WORDS_AT_ONCE + word);
                // A polygon belongs to the chunk of its second triangle.
                for second in begin..begin + 64 {
                    if self.goes_on(second) && !self.goes_on(second - 1) {
                        let fan = self.fan(second - 1);
                        let position = |k| positions[fan.corner(triangles, k) as usize];
                        if let Some(cut) = cutter.cut(fan.count + 2, position) {
                            part.fans.push(fan);
                            part.cut.extend_from_slice(cut);
                        }
                    }
                }
            }
            part
        });
        Recuts { parts: parts.collect() }
    }

    fn goes_on(&self, triangle: usize) -> bool {
        self.goes_on.get(triangle / 64).is_some_and(|word| word >> (triangle % 64) & 1 == 1)
    }

    /// The fan that begins with this triangle.
    fn fan(&self, first: usize) -> Fan {
        let count = 1 + (first + 1..).take_while(|&triangle| self.goes_on(triangle)).count();
        Fan { first, count }
    }
}

impl Recuts {
    /// Cuts these polygons anew: `corners` is what the corners of all triangles have, such as their vertices. The last triangles may
    /// lack an entry, if they have nothing.
    pub(crate) fn apply(&self, corners: &mut Vec<[u32; 3]>) {
        let mut of_polygon = Vec::new();
        for Part { fans, cut } in &self.parts {
            let mut cut = cut.iter();
            for fan in fans {
                let cut = cut.by_ref().take(fan.count);
                if fan.first >= corners.len() {
                    continue;
                }
                let end = fan.first + fan.count;
                corners.resize(end.max(corners.len()), [NONE; 3]);
                of_polygon.clear();
                of_polygon.extend((0..fan.count + 2).map(|k| fan.corner(corners, k)));
                for (triangle, of) in corners[fan.first..end].iter_mut().zip(cut) {
                    *triangle = of.map(|k| of_polygon[k as usize]);
                }
            }
        }
    }
}

impl Fan {
    /// What a corner of the polygon has.
    fn corner(self, corners: &[[u32; 3]], corner: usize) -> u32 {
        match corner {
            0 | 1 => corners[self.first][corner],
            _ => corners[self.first + corner - 2][2],
        }
    }
}
