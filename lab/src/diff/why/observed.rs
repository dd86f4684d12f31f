//! A file as the search for conventions reads it.

use super::convention::Placement;
use super::encoding::NothingEncoding;
use crate::common::Camera;
use crate::diff::buffer::{Buffer, Content};
use std::collections::HashMap;

/// A file as the search for conventions reads it: one sample a pixel.
#[derive(Clone, Debug)]
pub(super) struct Observed {
    pub(super) size: [usize; 2],
    pub(super) values: Values,
}

/// The values of a file, row by row.
#[derive(Clone, Debug)]
pub(super) enum Values {
    Mask(Vec<bool>),
    Ids(Vec<Option<u64>>),
    Distances(Vec<f64>),
}

impl Observed {
    /// The values of a buffer; `None` for colours alone, and for several samples a pixel.
    pub(super) fn of(buffer: &Buffer) -> Option<Observed> {
        if buffer.samples() != 1 || !buffer.has_coverage() {
            return None;
        }
        let samples = || buffer.all_samples();
        let values = match buffer.content() {
            Content::Ids(_) | Content::Frame(_) => {
                Values::Ids(samples().map(|sample| buffer.id(sample)).collect())
            }
            Content::Distances(t) => Values::Distances(t.clone()),
            Content::Mask(_) | Content::Normals(_) | Content::Picture(_) => {
                let covered = |sample| buffer.covered(sample) == Some(true);
                Values::Mask(samples().map(covered).collect())
            }
        };
        Some(Observed { size: buffer.size().map(|side| side as usize), values })
    }

    #[inline]
    pub(super) fn covered(&self, index: usize, nothing: NothingEncoding) -> bool {
        match &self.values {
            Values::Mask(mask) => nothing.covers(mask[index]),
            Values::Ids(ids) => ids[index].is_some_and(|id| !nothing.matches_id(id)),
            Values::Distances(t) => !nothing.matches_distance(t[index]),
        }
    }

    /// Whether it can be a picture of a camera, placed so.
    pub(super) fn fits(&self, placement: Placement, camera: &Camera) -> bool {
        let image = camera.image();
        let side = |side: usize| u32::try_from(side).expect("at most 2^16");
        placement.fits(self.size.map(side), image)
    }

    /// Whether a file of ids shows three or more of them; another file shows none.
    pub(super) fn shows_several_ids(&self) -> bool {
        let Values::Ids(ids) = &self.values else { return true };
        let mut shown: Vec<u64> = Vec::new();
        for id in ids.iter().copied().flatten() {
            if !shown.contains(&id) {
                shown.push(id);
            }
            if shown.len() > 2 {
                return true;
            }
        }
        false
    }

    /// Whether as many pixels beside one another show different things as lie along a side of the picture.
    pub(super) fn shows_outlines(&self) -> bool {
        let Values::Ids(ids) = &self.values else { return true };
        let [width, height] = self.size;
        let is_outline = |&index: &usize| {
            let right = (index + 1) % width != 0 && ids[index] != ids[index + 1];
            let below = index + width < ids.len() && ids[index] != ids[index + width];
            right || below
        };
        (0..ids.len()).filter(is_outline).count() >= width.min(height)
    }

    /// How many pixels are covered.
    pub(super) fn covered_count(&self, nothing: NothingEncoding) -> u64 {
        let pixels = 0..self.size[0] * self.size[1];
        pixels.filter(|&index| self.covered(index, nothing)).count() as u64
    }

    /// The meanings of nothing that this file of a scene with so many primitives may have: ours, and others where nothing has our
    /// number.
    pub(super) fn meanings_of_nothing(&self, primitives: u64) -> Vec<NothingEncoding> {
        let mut meanings = vec![NothingEncoding::Ours];
        match &self.values {
            Values::Mask(_) => meanings.push(NothingEncoding::Inverted),
            _ if self.has_our_nothing() => {}
            Values::Ids(ids) => {
                if ids.contains(&Some(0)) {
                    meanings.push(NothingEncoding::Number(0.0));
                }
                meanings.extend(large(ids, primitives).map(NothingEncoding::Number));
            }
            Values::Distances(t) => meanings.extend(repeated(t).map(NothingEncoding::Number)),
        }
        meanings
    }

    /// Whether the file has our number of nothing somewhere.
    pub(super) fn has_our_nothing(&self) -> bool {
        (0..self.size[0] * self.size[1]).any(|index| !self.covered(index, NothingEncoding::Ours))
    }
}

/// The largest id, if many pixels have it and no primitive does: 255, 65535, one more than the last id, ….
#[expect(clippy::cast_precision_loss, reason = "an id that is larger than 2^53 is no id of ours")]
fn large(ids: &[Option<u64>], primitives: u64) -> Option<f64> {
    let largest = ids.iter().flatten().max().copied().filter(|&id| id >= primitives)?;
    let count = ids.iter().filter(|&&id| id == Some(largest)).count();
    (count >= 2 && count * 100 >= ids.len()).then_some(largest as f64)
}

/// The number that most of the pixels have, if many have it: 0, −1, 1e30, the far plane, ….
fn repeated(values: &[f64]) -> Option<f64> {
    let mut counts: HashMap<u64, usize> = HashMap::new();
    // Some thousand of them are enough to find a number that fills a part of the picture.
    let step = values.len().div_ceil(1 << 14).max(1);
    let some = values.iter().step_by(step);
    let looked_at = some.len();
    for value in some {
        *counts.entry(value.to_bits()).or_default() += 1;
    }
    let most = counts.into_iter().max_by_key(|&(bits, count)| (count, bits))?;
    (most.1 >= 2 && most.1 * 100 >= looked_at).then(|| f64::from_bits(most.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_nothing_is_the_one_that_is_repeated() {
        let mut t = vec![1e30; 40];
        (0..60_u32).for_each(|i| t.push(f64::from(i) + 0.5));
        assert_eq!(repeated(&t), Some(1e30));
        assert_eq!(repeated(&t[40..]), None);
    }
}
