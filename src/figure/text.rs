//! Text for figures: the outlines of an embedded typeface, filled.
//!
//! Enough of typography for labels and numbers: kerning, and figures of one width, so that columns
//! of numbers align. The typeface is Inter, under the SIL Open Font License (`assets/inter`).

use std::sync::LazyLock;
use tiny_skia::{Color, FillRule, Paint, Path, PathBuilder, Pixmap, Transform};
use ttf_parser::gpos::{PairAdjustment, PositioningSubtable};
use ttf_parser::gsub::{SingleSubstitution, SubstitutionSubtable};
use ttf_parser::opentype_layout::{LayoutTable, Lookup};
use ttf_parser::{Face, GlyphId, OutlineBuilder, Tag};

/// How heavy the letters are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    SemiBold,
}

/// How a text is set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    pub(super) weight: Weight,
    /// The em, in pixels.
    pub(super) size: f32,
    /// sRGB.
    pub(super) colour: [u8; 3],
}

/// How wide a text is, in pixels.
pub(super) fn width(text: &str, style: Style) -> f32 {
    style.weight.font().set(text).width * style.weight.font().scale(style.size)
}

/// Draws a text from `x` to the right; its letters stand on `baseline`.
pub(super) fn draw(canvas: &mut Pixmap, text: &str, x: f32, baseline: f32, style: Style) {
    let font = style.weight.font();
    let Some(path) = font.outline(&font.set(text)) else {
        return;
    };
    let [red, green, blue] = style.colour;
    let mut paint = Paint::default();
    paint.set_color(Color::from_rgba8(red, green, blue, u8::MAX));
    let scale = font.scale(style.size);
    // In a font, y goes up.
    let place = Transform::from_row(scale, 0.0, 0.0, -scale, x, baseline);
    canvas.fill_path(&path, &paint, FillRule::Winding, place, None);
}

/// The text itself if it is narrow enough, else its beginning and an ellipsis.
pub(super) fn shortened(text: &str, style: Style, limit: f32) -> String {
    if width(text, style) <= limit {
        return text.into();
    }
    let mut beginning: Vec<char> = text.chars().collect();
    loop {
        beginning.pop();
        let shortened = String::from_iter(&beginning).trim_end().to_owned() + "…";
        if beginning.is_empty() || width(&shortened, style) <= limit {
            return shortened;
        }
    }
}

/// One weight of the typeface, and the tables that say how its letters stand beside each other.
struct Font {
    face: Face<'static>,
    tabular: Vec<Lookup<'static>>,
    kerning: Vec<Lookup<'static>>,
}

/// A line of glyphs in font units, each with its distance from the line's beginning.
struct Line {
    glyphs: Vec<(GlyphId, f32)>,
    width: f32,
}

impl Weight {
    fn font(self) -> &'static Font {
        static REGULAR: LazyLock<Font> =
            LazyLock::new(|| Font::new(include_bytes!("../../assets/inter/Inter-Regular.otf")));
        static SEMI_BOLD: LazyLock<Font> =
            LazyLock::new(|| Font::new(include_bytes!("../../assets/inter/Inter-SemiBold.otf")));
        match self {
            Weight::Regular => &REGULAR,
            Weight::SemiBold => &SEMI_BOLD,
        }
    }
}

impl Font {
    fn new(bytes: &'static [u8]) -> Font {
        let face = Face::parse(bytes, 0).expect("the embedded font is sound");
        let tabular = lookups(face.tables().gsub, Tag::from_bytes(b"tnum"));
        let kerning = lookups(face.tables().gpos, Tag::from_bytes(b"kern"));
        Font { face, tabular, kerning }
    }

    /// Pixels in a font unit.
    fn scale(&self, size: f32) -> f32 {
        size / f32::from(self.face.units_per_em())
    }

    fn set(&self, text: &str) -> Line {
        let (mut glyphs, mut width) = (Vec::new(), 0.0);
        let mut previous = None;
        for letter in text.chars() {
            let glyph = self.glyph(letter);
            width += previous.map_or(0.0, |previous| self.kern(previous, glyph));
            glyphs.push((glyph, width));
            width += f32::from(self.face.glyph_hor_advance(glyph).unwrap_or(0));
            previous = Some(glyph);
        }
        Line { glyphs, width }
    }

    /// The glyph of a letter; figures in their tabular form.
    fn glyph(&self, letter: char) -> GlyphId {
        // What the font lacks becomes glyph 0, a box.
        let glyph = self.face.glyph_index(letter).unwrap_or_default();
        if letter.is_ascii_digit() { self.tabular_form(glyph).unwrap_or(glyph) } else { glyph }
    }

    fn tabular_form(&self, glyph: GlyphId) -> Option<GlyphId> {
        let tables = self.tabular.iter().flat_map(|lookup| lookup.subtables.into_iter());
        tables.into_iter().find_map(|table| match table {
            SubstitutionSubtable::Single(SingleSubstitution::Format1 { coverage, delta }) => {
                coverage.get(glyph).map(|_| GlyphId(glyph.0.wrapping_add_signed(delta)))
            }
            SubstitutionSubtable::Single(SingleSubstitution::Format2 { coverage, substitutes }) => {
                substitutes.get(coverage.get(glyph)?)
            }
            _ => None,
        })
    }

    /// How much farther apart than usual two glyphs stand; negative is nearer.
    fn kern(&self, left: GlyphId, right: GlyphId) -> f32 {
        let tables = self.kerning.iter().flat_map(|lookup| lookup.subtables.into_iter());
        let adjustment = tables.into_iter().find_map(|table| match table {
            PositioningSubtable::Pair(PairAdjustment::Format1 { coverage, sets }) => {
                sets.get(coverage.get(left)?)?.get(right)
            }
            PositioningSubtable::Pair(PairAdjustment::Format2 { coverage, classes, matrix }) => {
                coverage.get(left)?;
                matrix.get((classes.0.get(left), classes.1.get(right)))
            }
            _ => None,
        });
        adjustment.map_or(0.0, |(left, _)| f32::from(left.x_advance))
    }

    fn outline(&self, line: &Line) -> Option<Path> {
        let mut pen = Pen { path: PathBuilder::new(), x: 0.0 };
        for &(glyph, x) in &line.glyphs {
            pen.x = x;
            // A space has no outline.
            let _ = self.face.outline_glyph(glyph, &mut pen);
        }
        pen.path.finish()
    }
}

fn lookups(table: Option<LayoutTable<'static>>, feature: Tag) -> Vec<Lookup<'static>> {
    let Some(table) = table else {
        return Vec::new();
    };
    let indices = table.features.find(feature).map(|feature| feature.lookup_indices);
    indices.into_iter().flatten().filter_map(|index| table.lookups.get(index)).collect()
}

/// Draws glyphs one after another into one path.
struct Pen {
    path: PathBuilder,
    x: f32,
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.x + x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.x + x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.quad_to(self.x + x1, y1, self.x + x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.path.cubic_to(self.x + x1, y1, self.x + x2, y2, self.x + x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STYLE: Style = Style { weight: Weight::Regular, size: 24.0, colour: [255; 3] };

    #[test]
    fn all_figures_are_equally_wide() {
        let one = width("1", STYLE);
        assert!(one > 0.0);
        for digit in ["0", "4", "7", "9"] {
            assert_eq!(width(digit, STYLE), one);
        }
        assert_eq!(width("111", STYLE), width("987", STYLE));
    }

    #[test]
    fn letters_are_kerned() {
        let apart = width("A", STYLE) + width("V", STYLE);
        assert!(width("AV", STYLE) < apart - 0.5);
    }

    #[test]
    fn a_long_text_is_shortened_to_fit() {
        let text = "a scene with a name that nobody would give a scene";
        let shortened = shortened(text, STYLE, 200.0);
        assert!(shortened.ends_with('…') && width(&shortened, STYLE) <= 200.0);
        assert!(text.starts_with(shortened.trim_end_matches('…')));
    }

    #[test]
    fn text_leaves_ink_where_it_is_drawn() {
        let mut canvas = Pixmap::new(60, 40).unwrap();
        draw(&mut canvas, "H", 10.0, 30.0, STYLE);
        let inked = |x, y| canvas.pixel(x, y).unwrap().alpha() > 0;
        assert!((10..30).any(|x| inked(x, 29)));
        assert!(!(0..60).any(|x| inked(x, 31) || inked(x, 8)));
    }
}
