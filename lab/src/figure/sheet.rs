//! What all figures have in common: a title, a line of facts, panels with headings, a line that says what to see.

use super::drawing::{Anchor, CANVAS, Drawing, Ink, Pen};
use super::fallback::drawable;
use super::resize::{fitted, resized};
use super::subject::Subject;
use super::text::{self, Style, has};
use super::theme::Theme;
use image::RgbImage;

/// The margin at the left and at the right.
pub(crate) const MARGIN: f64 = 72.0;
/// Where the panels begin, and where they end.
pub(crate) const TOP: f64 = 178.0;
pub(crate) const BOTTOM: f64 = 980.0;
pub(crate) const RIGHT: f64 = CANVAS[0] - MARGIN;

/// A figure during drawing.
#[derive(Debug)]
pub(crate) struct Sheet {
    pub(crate) drawing: Drawing,
    pub(crate) theme: Theme,
}

impl Sheet {
    /// An empty figure: its title, the facts of its scene, and at the foot the sentence that says what to see.
    pub(crate) fn new(subject: &Subject, title: &str, point: &str) -> Sheet {
        Sheet::titled(subject.theme, title, &subject.facts(), point)
    }

    /// The same for a figure that is not of a scene.
    pub(crate) fn titled(theme: Theme, title: &str, facts: &str, point: &str) -> Sheet {
        let description = format!("{facts}. {point}");
        let mut drawing = Drawing::new(title, &description, theme.background());
        let room = RIGHT - MARGIN;
        drawing.fitting([MARGIN, 82.0], Anchor::Left, title, theme.title(), room);
        let facts = drawable(facts, has);
        drawing.fitting(
            [MARGIN, 126.0],
            Anchor::Left,
            &facts,
            theme.text().of(theme.quiet()),
            room,
        );
        drawing.rectangle([MARGIN, 1006.0], [room, 1.0], Ink::new(theme.hairline()));
        drawing.fitting([MARGIN, 1046.0], Anchor::Left, point, theme.text().sized(26.0), room);
        Sheet { drawing, theme }
    }

    /// A heading above a panel that begins at `top`, and a quiet note behind it.
    pub(crate) fn heading(&mut self, [left, top]: [f64; 2], width: f64, name: &str, note: &str) {
        let style = self.theme.heading();
        let taken = self.drawing.fitting([left, top - 14.0], Anchor::Left, name, style, width);
        let room = width - taken - 18.0;
        if room > 40.0 && !note.is_empty() {
            let style = self.theme.label();
            self.drawing.fitting([left + width, top - 14.0], Anchor::Right, note, style, room);
        }
    }

    /// The ground of a panel.
    pub(crate) fn mat(&mut self, corner: [f64; 2], size: [f64; 2]) {
        self.drawing.rectangle(corner, size, Ink::new(self.theme.mat()));
    }

    pub(crate) fn border(&mut self, corner: [f64; 2], size: [f64; 2]) {
        self.drawing.frame(corner, size, Pen::new(self.theme.hairline(), 2.0));
    }

    /// Draws a picture as large as it fits into a room, and gives its size.
    pub(crate) fn picture(
        &mut self,
        picture: RgbImage,
        corner: [f64; 2],
        room: [f64; 2],
    ) -> [f64; 2] {
        let size = drawn_size([picture.width(), picture.height()], room);
        // More than two pixels for each unit are more than any screen shows, and make large files.
        let finest = size.map(|side| 2 * side);
        let picture = if picture.width() > finest[0] || picture.height() > finest[1] {
            resized(&picture, finest).into_owned()
        } else {
            picture
        };
        let size = size.map(f64::from);
        self.drawing.picture(picture, corner, size);
        self.border(corner, size);
        size
    }

    /// Writes lines of text one below the other, and gives the baseline of the line after them.
    pub(crate) fn lines(
        &mut self,
        [left, baseline]: [f64; 2],
        width: f64,
        step: f64,
        lines: &[(&str, Style)],
    ) -> f64 {
        let mut baseline = baseline;
        for (line, style) in lines {
            self.drawing.fitting([left, baseline], Anchor::Left, line, *style, width);
            baseline += step;
        }
        baseline
    }

    /// Writes a text in as many lines as it needs, and gives the baseline of the line after them.
    pub(crate) fn paragraph(
        &mut self,
        [left, baseline]: [f64; 2],
        width: f64,
        step: f64,
        text: &str,
        style: Style,
    ) -> f64 {
        let mut baseline = baseline;
        for line in wrapped(text, style, width) {
            self.drawing.fitting([left, baseline], Anchor::Left, &line, style, width);
            baseline += step;
        }
        baseline
    }
}

/// The size in units with which [`Sheet::picture`] draws an image of this width and height into a room.
pub(crate) fn drawn_size(image: [u32; 2], room: [f64; 2]) -> [u32; 2] {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a size on the canvas"
    )]
    fitted(image, room.map(|side| side as u32))
}

/// A text in lines that are at most so wide.
fn wrapped(text: &str, style: Style, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if f64::from(text::width(&format!("{line} {word}"), style)) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines
}

/// A number with so many digits that count, as people write it: a real minus, no zeros at the end.
pub(crate) fn number(value: f64, digits: i32) -> String {
    if value == 0.0 {
        return "0".into();
    }
    #[expect(clippy::cast_possible_truncation, reason = "the exponent of a double")]
    let exponent = value.abs().log10().floor() as i32;
    let text = if (-4..7).contains(&exponent) {
        let decimals = usize::try_from((digits - 1 - exponent).max(0)).expect("not negative");
        let text = format!("{value:.decimals$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').into()
        } else {
            text
        }
    } else {
        let decimals = usize::try_from((digits - 1).max(0)).expect("not negative");
        let text = format!("{value:.decimals$e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let mantissa = if mantissa.contains('.') {
            mantissa.trim_end_matches('0').trim_end_matches('.')
        } else {
            mantissa
        };
        format!("{mantissa}e{exponent}")
    };
    let text = if text == "-0" { "0".into() } else { text };
    text.replace('-', "−")
}
