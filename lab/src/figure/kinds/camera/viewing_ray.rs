//! A viewing ray that is drawn, and where labels and the view from the side stand.

use crate::common::glam::DVec3;
use crate::common::{Options, Ray, View};
use crate::figure::drawing::Drawing;
use crate::figure::sheet::{RIGHT, TOP};
use crate::figure::theme::Theme;
use crate::pixel::{self, SampleReport};

/// The panel of the view from the side.
pub(super) const SIDE: ([f64; 2], [f64; 2]) = ([1204.0, TOP + 44.0], [RIGHT - 1204.0, 330.0]);

/// The viewing ray of a pixel, and what it hits. All points are relative to the eye.
pub(super) struct ViewingRay {
    pub(super) pixel: [u32; 2],
    pub(super) color: [u8; 3],
    pub(super) report: SampleReport,
}

impl ViewingRay {
    pub(super) fn new(view: &View, pixel: [u32; 2], color: [u8; 3]) -> ViewingRay {
        let report = pixel::report(view, &Options::default(), pixel[0], pixel[1]).remove(0);
        ViewingRay { pixel, color, report }
    }

    pub(super) fn ray(&self) -> Ray {
        self.report.ray
    }

    pub(super) fn at(&self, t: f64) -> DVec3 {
        self.ray().origin + t * self.ray().direction
    }

    pub(super) fn t(&self) -> Option<f64> {
        self.report.covering.first().map(|nearest| nearest.t)
    }
}

/// A label beside a point, where it meets no other.
pub(super) fn label_at(
    drawing: &mut Drawing,
    point: [f64; 2],
    prefer: [f64; 2],
    text: &str,
    theme: Theme,
    color: [u8; 3],
) {
    drawing.label(point, prefer, text, theme.label().of(color).semi_bold(), Some(theme.mat()));
}
