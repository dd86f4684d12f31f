//! What a drawing consists of.

use super::clip::Rectangle;
use crate::figure::text::{self, Style};
use image::RgbImage;

/// A colour in sRGB and how opaque it is, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ink {
    pub(crate) color: [u8; 3],
    pub(crate) alpha: f64,
}

impl Ink {
    pub(crate) const fn new(color: [u8; 3]) -> Ink {
        Ink { color, alpha: 1.0 }
    }

    pub(crate) const fn alpha(self, alpha: f64) -> Ink {
        Ink { alpha, ..self }
    }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pen {
    pub(crate) ink: Ink,
    /// In units.
    pub(crate) width: f64,
    /// The lengths of a dash and of a gap, in units.
    pub(crate) dash: Option<[f64; 2]>,
}

impl Pen {
    pub(crate) const fn new(color: [u8; 3], width: f64) -> Pen {
        Pen { ink: Ink::new(color), width, dash: None }
    }

    pub(crate) const fn dashed(self, dash: f64, gap: f64) -> Pen {
        Pen { dash: Some([dash, gap]), ..self }
    }

    pub(crate) const fn alpha(self, alpha: f64) -> Pen {
        Pen { ink: self.ink.alpha(alpha), ..self }
    }
}

/// One item of a drawing, clipped, in units from the top left.
#[derive(Clone, Debug)]
pub(super) enum Item {
    Fill { outline: Vec<[f64; 2]>, ink: Ink },
    Line { points: Vec<[f64; 2]>, closed: bool, pen: Pen },
    Disc { center: [f64; 2], radius: f64, ink: Ink },
    Text(Text),
    Picture { picture: RgbImage, corners: Corners, alpha: f64 },
}

/// Where three corners of a picture lie: the top left one, the top right one, the bottom left one.
pub(super) type Corners = [[f64; 2]; 3];

/// A line of text in a drawing.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    pub(crate) text: String,
    /// The left end of the line that the letters stand on.
    pub(crate) left: f64,
    pub(crate) baseline: f64,
    pub(crate) style: Style,
    /// The colour of the line around the letters, where they stand on a picture.
    pub(crate) halo: Option<[u8; 3]>,
}

impl Text {
    /// What the letters may ink: left, top, right and bottom.
    pub(super) fn extent(&self) -> [f64; 4] {
        let (size, width) =
            (f64::from(self.style.size), f64::from(text::width(&self.text, self.style)));
        [self.left, self.baseline - 0.76 * size, self.left + width, self.baseline + 0.2 * size]
    }
}

/// A drawing.
#[derive(Clone, Debug)]
pub struct Drawing {
    pub(super) title: String,
    pub(super) description: String,
    /// The colour of the canvas, in sRGB.
    pub(super) background: [u8; 3],
    pub(super) items: Vec<Item>,
    pub(super) window: Rectangle,
}

/// Which point of a text stands at the given place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Left,
    Middle,
    Right,
}
