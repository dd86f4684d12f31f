//! One pixel of A beside one of B: who covers it, and how far apart they are.

use super::compare::{Aspect, Unit};
use super::{Buffer, Content, Covered, Picture};
use crate::diff::{COLOR_TOLERANCE, Class, DEPTH_TOLERANCE};
use std::ops::Range;

/// Two buffers of one size.
pub(super) struct Pair<'a> {
    pub(super) a: &'a Buffer,
    pub(super) b: &'a Buffer,
}

/// What a pixel says.
#[derive(Default)]
pub(super) struct Look {
    pub(super) only_a: u64,
    pub(super) only_b: u64,
    pub(super) both: u64,
    pub(super) other_ids: u64,
    /// The largest relative difference of t, and the two.
    pub(super) depth: f64,
    pub(super) t: [f64; 2],
    pub(super) color: f32,
}

impl Look {
    pub(super) fn class(&self) -> Class {
        let differs = self.other_ids > 0
            || self.depth > DEPTH_TOLERANCE
            || self.color > f32::from(COLOR_TOLERANCE);
        match self {
            Look { only_a: 1.., .. } => Class::OnlyObjectOrder,
            Look { only_b: 1.., .. } => Class::OnlyImageOrder,
            _ if differs => Class::OtherPrimitive,
            Look { both: 1.., .. } => Class::Alike,
            _ => Class::Neither,
        }
    }
}

impl Pair<'_> {
    pub(super) fn unit(&self) -> Unit {
        if self.a.samples == self.b.samples { Unit::Samples } else { Unit::Pixels }
    }

    pub(super) fn compares(&self, aspect: Aspect) -> bool {
        let in_both = aspect.is_in(self.a) && aspect.is_in(self.b);
        in_both && (aspect == Aspect::Coverage || self.unit() == Unit::Samples)
    }

    pub(super) fn not_compared(&self) -> Vec<String> {
        let reason = |aspect: Aspect| match (aspect.is_in(self.a), aspect.is_in(self.b)) {
            (true, false) => Some("only A tells".to_owned()),
            (false, true) => Some("only B tells".to_owned()),
            (true, true) if !self.compares(aspect) => {
                let [a, b] = [self.a, self.b].map(|buffer| buffer.samples);
                Some(format!("A has {a} x {a} samples a pixel, B {b} x {b}"))
            }
            _ => None,
        };
        let line = |aspect: Aspect| Some(format!("{}: {}", aspect.name(), reason(aspect)?));
        Aspect::ALL.into_iter().filter_map(line).collect()
    }

    /// Compares a pixel of A with one of B.
    pub(super) fn look(&self, pixel_a: usize, pixel_b: usize) -> Look {
        let mut look = Look::default();
        let [in_a, in_b] = [(self.a, pixel_a), (self.b, pixel_b)].map(|(buffer, pixel)| {
            let per_pixel = (buffer.samples as usize).pow(2);
            pixel * per_pixel..(pixel + 1) * per_pixel
        });
        if self.unit() == Unit::Pixels {
            let any = |buffer: &Buffer, mut samples: Range<usize>| {
                samples.any(|sample| buffer.covered(sample) == Some(true))
            };
            look.cover(any(self.a, in_a), any(self.b, in_b));
            return look;
        }
        for (a, b) in in_a.zip(in_b) {
            self.look_at(a, b, &mut look);
        }
        look
    }

    /// Compares two samples.
    fn look_at(&self, a: usize, b: usize, look: &mut Look) {
        let [covered_a, covered_b] = [self.a.covered(a), self.b.covered(b)];
        if let (Some(covered_a), Some(covered_b)) = (covered_a, covered_b) {
            look.cover(covered_a, covered_b);
        } else {
            // Colours alone: a pixel that agrees is shown, whatever it is.
            look.both += 1;
        }
        if covered_a == Some(false) || covered_b == Some(false) {
            return;
        }
        match (&self.a.content, &self.b.content) {
            (Content::Ids(in_a), Content::Ids(in_b)) => {
                look.other_ids += u64::from(in_a[a] != in_b[b]);
            }
            (Content::Distances(in_a), Content::Distances(in_b)) => {
                let difference = relative_difference(in_a[a], in_b[b]);
                if difference > look.depth {
                    (look.depth, look.t) = (difference, [in_a[a], in_b[b]]);
                }
            }
            (Content::Picture(in_a), Content::Picture(in_b)) => {
                look.color = color_difference(in_a, a, in_b, b);
            }
            _ => {}
        }
    }
}

impl Look {
    fn cover(&mut self, by_a: bool, by_b: bool) {
        self.both += u64::from(by_a && by_b);
        self.only_a += u64::from(by_a && !by_b);
        self.only_b += u64::from(!by_a && by_b);
    }
}

/// The difference as a part of the larger; 0 of two zeros.
fn relative_difference(a: f64, b: f64) -> f64 {
    // Quotients first: the difference of two large numbers may be infinite.
    let larger = a.abs().max(b.abs());
    if a == b { 0.0 } else { (a / larger - b / larger).abs() }
}

fn color_difference(in_a: &Picture, a: usize, in_b: &Picture, b: usize) -> f32 {
    let both_have_alpha = [in_a, in_b].iter().all(|picture| picture.has_alpha());
    let channels = if both_have_alpha { 4 } else { 3 };
    let channels = in_a.pixels.get(a).into_iter().zip(in_b.pixels.get(b)).take(channels);
    channels.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

impl Picture {
    fn has_alpha(&self) -> bool {
        self.covered == Covered::ByAlpha
    }
}
