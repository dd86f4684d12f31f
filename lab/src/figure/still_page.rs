//! One order's two loops in the lecture's words, with stills of its picture.

use super::drawing::{Anchor, Drawing};
use super::sheet::{MARGIN, Sheet, TOP};
use super::subject::Subject;
use super::theme::Role;
use crate::orders::Order;
use image::RgbImage;

/// A picture after a part of the work.
#[derive(Clone, Debug)]
pub(crate) struct Still {
    pub(crate) picture: RgbImage,
    /// What it shows, in words.
    pub(crate) name: String,
}

/// The page: the loops on the left, four stills on the right.
#[derive(Debug)]
pub(crate) struct StillPage<'a> {
    pub(crate) subject: &'a Subject<'a>,
    pub(crate) order: Order,
    pub(crate) facts: &'a str,
    pub(crate) stills: Vec<Still>,
}

/// The room of a still, and where the stills begin.
const STILL: [f64; 2] = [520.0, 340.0];
const LEFT: f64 = 760.0;

impl StillPage<'_> {
    /// Draws the page.
    pub(crate) fn draw(&self) -> Drawing {
        let (title, point) = match self.order {
            Order::Object => (
                "Object order: for each object, for each pixel",
                "The picture grows object by object: a pixel may be painted again, and is sure only at the end.",
            ),
            Order::Image => (
                "Image order: for each pixel, for each object",
                "The picture grows pixel by pixel: each is finished before the next one begins.",
            ),
        };
        let mut sheet = Sheet::new(self.subject, title, point);
        self.code(&mut sheet);
        for (number, still) in self.stills.iter().take(4).enumerate() {
            let corner =
                [LEFT + (number % 2) as f64 * 560.0, TOP + 44.0 + (number / 2) as f64 * 402.0];
            sheet.heading(corner, STILL[0], &still.name, "");
            sheet.picture(still.picture.clone(), corner, STILL);
        }
        sheet.drawing
    }

    /// The lecture's loops.
    fn code(&self, sheet: &mut Sheet) {
        let theme = sheet.theme;
        let [outer, inner] = match self.order {
            Order::Object => ["for each object in the scene {", "for each pixel in the image {"],
            Order::Image => ["for each pixel in the image {", "for each object in the scene {"],
        };
        let role = Role::from(self.order);
        let lines = [
            (0.0, outer),
            (1.0, inner),
            (2.0, "if (object affects pixel) {"),
            (3.0, "do something"),
            (2.0, "}"),
            (1.0, "}"),
            (0.0, "}"),
        ];
        let top = TOP + 60.0;
        sheet.drawing.rectangle([MARGIN, top - 30.0], [6.0, 400.0], theme.ink(role));
        for (number, (indent, line)) in lines.into_iter().enumerate() {
            let baseline = top + 16.0 + 56.0 * number as f64;
            let style = theme.text().sized(32.0);
            let style = if number == 0 { style.semi_bold().of(theme.of(role)) } else { style };
            let x = MARGIN + 36.0 + 44.0 * indent;
            sheet.drawing.fitting([x, baseline], Anchor::Left, line, style, LEFT - 40.0 - x);
        }
        let width = LEFT - 60.0 - MARGIN;
        let y = sheet.lines(
            [MARGIN, top + 440.0],
            width,
            44.0,
            &[(&*format!("It is also called {}.", self.order.common_name()), theme.text())],
        );
        let y = sheet.lines([MARGIN, y], width, 44.0, &[(self.facts, theme.text())]);
        let nothing = "Chequered: nothing is stored there yet.";
        sheet.lines([MARGIN, y], width, 44.0, &[(nothing, theme.label())]);
    }
}
