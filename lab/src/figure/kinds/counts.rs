//! Counts for each sample of a picture, from the events of a renderer's loops, and how they are drawn.

use crate::common::observe::{Events, Observer};
use crate::common::raster::Sample;
use crate::figure::drawing::{Anchor, Ink, Pen};
use crate::figure::sheet::Sheet;
use crate::figure::theme::ramp;
use crate::sample_map::SampleMap;
use crate::wording::grouped;
use image::{Rgb, RgbImage};

/// What is counted at a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Counted {
    /// Primitives that cover it.
    Fragments,
    /// Primitives that were tested there, and boxes.
    Tests,
}

/// An observer that counts at each sample.
#[derive(Clone, Debug)]
pub(super) struct Counts {
    height: usize,
    width: usize,
    counted: Counted,
    counts: SampleMap<u64>,
}

impl Counts {
    /// Nothing counted yet; the size is that of a camera's image, width and height.
    pub(super) fn new([width, height]: [u32; 2], counted: Counted) -> Counts {
        Counts {
            height: height as usize,
            width: width as usize,
            counted,
            counts: SampleMap::new(0),
        }
    }

    fn add(&mut self, sample: Sample) {
        *self.counts.get_mut(sample) += 1;
    }

    pub(super) fn at(&self, row: usize, column: usize) -> u64 {
        self.counts.get(Sample { row, column })
    }

    /// All counts, row by row.
    pub(super) fn all(&self) -> impl Iterator<Item = u64> {
        (0..self.height)
            .flat_map(move |row| (0..self.width).map(move |column| self.at(row, column)))
    }

    /// Rows and columns.
    pub(super) fn size(&self) -> [usize; 2] {
        [self.height, self.width]
    }
}

impl Observer for Counts {
    fn fork(&self) -> Self {
        Counts { counts: SampleMap::new(0), ..*self }
    }

    fn join(&mut self, part: Self) {
        self.counts.join(part.counts, |count, more| *count += more);
    }
}

impl Events for Counts {
    fn sample_tested(&mut self, sample: Sample, _primitive: u64) {
        if self.counted == Counted::Tests {
            self.add(sample);
        }
    }

    fn node_opened(&mut self, sample: Sample, _node: u32, _entered: bool) {
        if self.counted == Counted::Tests {
            self.add(sample);
        }
    }

    fn fragment(&mut self, sample: Sample, _primitive: u64) {
        if self.counted == Counted::Fragments {
            self.add(sample);
        }
    }
}

/// Draws counts, of so many rows and columns, as a picture in a room; `shade` gives the place on the ramp. Gives the
/// picture's size.
pub(super) fn heat_map(
    sheet: &mut Sheet,
    (size, counts): ([usize; 2], &[u64]),
    corner: [f64; 2],
    room: [f64; 2],
    shade: impl Fn(u64) -> f64,
) -> [f64; 2] {
    let side = |side: usize| u32::try_from(side).expect("an image's side");
    let picture = RgbImage::from_fn(side(size[1]), side(size[0]), |x, y| {
        Rgb(ramp(shade(counts[y as usize * size[1] + x as usize])))
    });
    sheet.picture(picture, corner, room)
}

/// A bar with the colours of the ramp, and numbers below it at equal steps.
pub(super) fn scale_bar(sheet: &mut Sheet, [x, y]: [f64; 2], width: f64, numbers: &[u64]) {
    const PARTS: u32 = 96;
    let theme = sheet.theme;
    let part = width / f64::from(PARTS);
    for step in 0..PARTS {
        let color = ramp((f64::from(step) + 0.5) / f64::from(PARTS));
        // A little wider than a part, so that no gap shows.
        let corner = [x + f64::from(step) * part, y];
        let wide = part + if step + 1 < PARTS { 0.8 } else { 0.0 };
        sheet.drawing.rectangle(corner, [wide, 16.0], Ink::new(color));
    }
    sheet.drawing.frame([x, y], [width, 16.0], Pen::new(theme.hairline(), 1.5));
    let last = numbers.len().saturating_sub(1).max(1) as f64;
    for (place, number) in numbers.iter().enumerate() {
        let anchor = match place {
            0 => Anchor::Left,
            place if place + 1 == numbers.len() => Anchor::Right,
            _ => Anchor::Middle,
        };
        let at = x + width * place as f64 / last;
        sheet.drawing.text([at, y + 42.0], anchor, &grouped(*number), theme.label());
    }
}
