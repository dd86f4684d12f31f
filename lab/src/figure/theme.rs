//! The colours of figures: a dark theme for dim rooms and a light one for paper and bright rooms.
//!
//! Categories have the colours of Okabe and Ito ("Color Universal Design", 2008), which colour-blind people can tell
//! apart; ramps are cividis (Nuñez, Anderton, Renslow, PLOS ONE 2018). Where a colour alone would carry a meaning,
//! figures add a second sign: a letter, a form or hatching.

use super::drawing::Ink;
use super::text::{Figures, Style, Weight};
use image::RgbImage;
use std::str::FromStr;

/// The colours of a figure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Theme {
    /// Light letters on a dark ground.
    #[default]
    Dark,
    /// Dark letters on a white ground.
    Light,
}

impl FromStr for Theme {
    type Err = String;

    fn from_str(name: &str) -> Result<Theme, String> {
        match name {
            "dark" => Ok(Theme::Dark),
            "light" => Ok(Theme::Light),
            _ => Err(format!("'{name}' is no theme; there are dark and light")),
        }
    }
}

/// A meaning that a colour has in all figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// Object order.
    Object,
    /// Image order.
    Image,
    /// What agrees, what is covered, what won.
    Good,
    /// What is wrong.
    Bad,
    /// What is looked at now: the chosen pixel and its ray.
    Focus,
    /// The camera's own: eye, viewport, frame.
    Camera,
}

impl Theme {
    pub(crate) fn background(self) -> [u8; 3] {
        match self {
            Theme::Dark => [0x10, 0x14, 0x18],
            Theme::Light => [0xff, 0xff, 0xff],
        }
    }

    /// The ground of panels and of pictures.
    pub(crate) fn mat(self) -> [u8; 3] {
        match self {
            Theme::Dark => [0x0b, 0x0e, 0x11],
            Theme::Light => [0xf1, 0xf3, 0xf5],
        }
    }

    pub(crate) fn hairline(self) -> [u8; 3] {
        match self {
            Theme::Dark => [0x2a, 0x32, 0x3a],
            Theme::Light => [0xc9, 0xd0, 0xd7],
        }
    }

    /// Text and lines that carry the meaning.
    pub(crate) fn bright(self) -> [u8; 3] {
        match self {
            Theme::Dark => [0xee, 0xf1, 0xf4],
            Theme::Light => [0x16, 0x1b, 0x20],
        }
    }

    /// Text that explains.
    pub(crate) fn quiet(self) -> [u8; 3] {
        match self {
            Theme::Dark => [0xa0, 0xac, 0xb7],
            Theme::Light => [0x51, 0x5c, 0x67],
        }
    }

    /// The colours of pixels that store nothing yet: those of a faint chequerboard.
    pub(crate) fn nothing(self) -> [[u8; 3]; 2] {
        match self {
            Theme::Dark => [self.mat(), [0x1a, 0x20, 0x26]],
            Theme::Light => [self.background(), [0xe3, 0xe7, 0xeb]],
        }
    }

    /// The colour of a meaning. Light ones are darkened on white, so that lines and letters in them stay legible.
    pub(crate) fn of(self, role: Role) -> [u8; 3] {
        match (self, role) {
            (Theme::Dark, Role::Object) => [0xe6, 0x9f, 0x00],
            (Theme::Light, Role::Object) => [0xa8, 0x65, 0x00],
            (Theme::Dark, Role::Image) => [0x56, 0xb4, 0xe9],
            (Theme::Light, Role::Image) => [0x00, 0x72, 0xb2],
            (Theme::Dark, Role::Good) => [0x62, 0xc9, 0xa4],
            (Theme::Light, Role::Good) => [0x00, 0x7a, 0x59],
            (Theme::Dark, Role::Bad) => [0xd5, 0x5e, 0x00],
            (Theme::Light, Role::Bad) => [0xb8, 0x45, 0x00],
            (Theme::Dark, Role::Focus) => [0xf0, 0xe4, 0x42],
            (Theme::Light, Role::Focus) => [0xb0, 0x3a, 0x86],
            (Theme::Dark, Role::Camera) => [0xcc, 0x79, 0xa7],
            (Theme::Light, Role::Camera) => [0x9c, 0x3f, 0x75],
        }
    }

    pub(crate) fn ink(self, role: Role) -> Ink {
        Ink::new(self.of(role))
    }

    /// A title.
    pub(crate) fn title(self) -> Style {
        Style { size: 46.0, weight: Weight::SemiBold, ..self.text() }
    }

    /// The heading of a panel.
    pub(crate) fn heading(self) -> Style {
        Style { size: 29.0, weight: Weight::SemiBold, ..self.text() }
    }

    /// Text in sentences.
    pub(crate) fn text(self) -> Style {
        Style {
            weight: Weight::Regular,
            size: 24.0,
            color: self.bright(),
            figures: Figures::Proportional,
        }
    }

    /// Labels of lines, axes and points.
    pub(crate) fn label(self) -> Style {
        Style { size: 21.0, color: self.quiet(), ..self.text() }
    }
}

impl Style {
    pub(crate) fn of(self, color: [u8; 3]) -> Style {
        Style { color, ..self }
    }

    pub(crate) fn sized(self, size: f32) -> Style {
        Style { size, ..self }
    }

    pub(crate) fn semi_bold(self) -> Style {
        Style { weight: Weight::SemiBold, ..self }
    }

    pub(crate) fn tabular(self) -> Style {
        Style { figures: Figures::Tabular, ..self }
    }
}

/// The colour at a place from 0 to 1 of the ramp cividis: from dark blue to light yellow, evenly for every eye.
pub(crate) fn ramp(place: f64) -> [u8; 3] {
    // Eleven colours of cividis at equal steps; between them a straight line is within a few steps of 255.
    const STEPS: [[u8; 3]; 11] = [
        [0, 34, 78],
        [8, 51, 112],
        [53, 69, 108],
        [79, 87, 108],
        [102, 105, 112],
        [125, 124, 120],
        [148, 142, 119],
        [174, 163, 113],
        [200, 184, 102],
        [229, 207, 82],
        [254, 232, 56],
    ];
    let place = if place.is_nan() { 0.0 } else { place.clamp(0.0, 1.0) } * 10.0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 9")]
    let step = (place.floor() as usize).min(9);
    let part = place - place.floor().min(9.0);
    [0, 1, 2].map(|channel| {
        let (from, to) = (f64::from(STEPS[step][channel]), f64::from(STEPS[step + 1][channel]));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 0 to 255"
        )]
        let mixed = (from + part * (to - from)).round() as u8;
        mixed
    })
}

/// A colour between two others.
pub(crate) fn mixed(from: [u8; 3], to: [u8; 3], part: f64) -> [u8; 3] {
    [0, 1, 2].map(|channel| {
        let value = f64::from(from[channel]) * (1.0 - part) + f64::from(to[channel]) * part;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 0 to 255"
        )]
        let value = value.round() as u8;
        value
    })
}

/// A picture so pale that what is drawn over it stands out: this part of it, the rest is the ground of panels.
pub(crate) fn faded(picture: &RgbImage, theme: Theme, part: f64) -> RgbImage {
    let mut faded = picture.clone();
    for pixel in faded.pixels_mut() {
        pixel.0 = mixed(theme.mat(), pixel.0, part);
    }
    faded
}
