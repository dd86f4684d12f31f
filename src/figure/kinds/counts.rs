//! Counts for each sample of a picture, from the events of a renderer's loops, and how they are drawn.

use crate::common::observe::{Events, Observer};
use crate::common::raster::Sample;
use crate::figure::drawing::{Anchor, Ink, Pen};
use crate::figure::resize::{fitted, resized};
use crate::figure::sheet::Sheet;
use crate::figure::theme::ramp;
use crate::wording::grouped;
use image::{Rgb, RgbImage};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// What is counted at a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Counted {
    /// Primitives that cover it.
    Fragments,
    /// Primitives that were tested there, and boxes.
    Tests,
}

/// The side of a square of samples that are stored together.
const SQUARE: usize = 16;

/// An observer that counts at each sample. Squares of samples are stored only where something happens: each thread
/// sees a small part of the picture.
#[derive(Clone, Debug)]
pub(super) struct Counts {
    height: usize,
    width: usize,
    counted: Counted,
    squares: HashMap<[usize; 2], Vec<u64>>,
}

impl Counts {
    /// Nothing counted yet; the size is that of a camera's image, width and height.
    pub(super) fn new([width, height]: [u32; 2], counted: Counted) -> Counts {
        Counts { height: height as usize, width: width as usize, counted, squares: HashMap::new() }
    }

    fn add(&mut self, Sample { row, column }: Sample) {
        let square = self.squares.entry([row / SQUARE, column / SQUARE]);
        square.or_insert_with(|| vec![0; SQUARE * SQUARE])
            [row % SQUARE * SQUARE + column % SQUARE] += 1;
    }

    pub(super) fn at(&self, row: usize, column: usize) -> u64 {
        let square = self.squares.get(&[row / SQUARE, column / SQUARE]);
        square.map_or(0, |square| square[row % SQUARE * SQUARE + column % SQUARE])
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
        Counts { squares: HashMap::new(), ..*self }
    }

    fn join(&mut self, part: Self) {
        for (square, more) in part.squares {
            match self.squares.entry(square) {
                Entry::Vacant(place) => {
                    place.insert(more);
                }
                Entry::Occupied(counts) => {
                    counts.into_mut().iter_mut().zip(more).for_each(|(count, more)| *count += more);
                }
            }
        }
    }
}

impl Events for Counts {
    fn sample_tested(&mut self, sample: Sample, _primitive: u32) {
        if self.counted == Counted::Tests {
            self.add(sample);
        }
    }

    fn node_opened(&mut self, sample: Sample, _node: u32, _entered: bool) {
        if self.counted == Counted::Tests {
            self.add(sample);
        }
    }

    fn fragment(&mut self, sample: Sample, _primitive: u32) {
        if self.counted == Counted::Fragments {
            self.add(sample);
        }
    }
}

/// Draws counts, of so many rows and columns, as a picture in a room; `shade` gives the place on the ramp. Gives the picture's corner and size.
pub(super) fn heat_map(
    sheet: &mut Sheet,
    (size, counts): ([usize; 2], &[u64]),
    corner: [f64; 2],
    room: [f64; 2],
    shade: impl Fn(u64) -> f64,
) -> ([f64; 2], [f64; 2]) {
    let side = |side: usize| u32::try_from(side).expect("an image's side");
    let picture = RgbImage::from_fn(side(size[1]), side(size[0]), |x, y| {
        Rgb(ramp(shade(counts[y as usize * size[1] + x as usize])))
    });
    fit(sheet, picture, corner, room)
}

/// Draws a picture as large as it fits into a room, and gives its corner and size.
pub(super) fn fit(
    sheet: &mut Sheet,
    picture: RgbImage,
    corner: [f64; 2],
    room: [f64; 2],
) -> ([f64; 2], [f64; 2]) {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a size on the canvas"
    )]
    let most = room.map(|side| side as u32);
    let drawn = fitted([picture.width(), picture.height()], most);
    let size = drawn.map(f64::from);
    // More than two pixels for each unit are more than any screen shows, and make large files.
    let finest = drawn.map(|side| 2 * side);
    let picture = if picture.width() > finest[0] || picture.height() > finest[1] {
        resized(&picture, finest)
    } else {
        picture
    };
    sheet.drawing.picture(picture, corner, size);
    sheet.border(corner, size);
    (corner, size)
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
