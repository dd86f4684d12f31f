//! Text for figures: the outlines of an embedded typeface, filled.
//!
//! This is enough typography for labels and numbers: kerning, and figures of equal width for columns of numbers. The
//! typeface is Inter, under the SIL Open Font License (`assets/inter`).

use super::formula::Form;
use skrifa::charmap::Charmap;
use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlinePen};
use skrifa::raw::tables::gpos::{PairPos, PositionSubtables};
use skrifa::raw::tables::gsub::{SingleSubst, SubstitutionSubtables};
use skrifa::raw::tables::layout::{ClassDef, FeatureList};
use skrifa::raw::{ReadError, TableProvider};
use skrifa::{FontRef, GlyphId16, MetadataProvider, Tag};
use std::collections::HashMap;
use std::fmt::Write;
use std::hash::Hash;
use std::sync::{LazyLock, PoisonError, RwLock};
use tiny_skia::{Color, FillRule, Paint, Path, PathBuilder, Pixmap, Transform};

/// The weight of the letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Weight {
    Regular,
    SemiBold,
}

/// The style of a text.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    pub(crate) weight: Weight,
    /// The em, in pixels.
    pub(crate) size: f32,
    /// The colour in sRGB.
    pub(crate) color: [u8; 3],
    pub(crate) figures: Figures,
}

/// The widths of figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Figures {
    /// All figures have equal width, for columns of numbers.
    Tabular,
    /// Each figure has its own width, for figures in a sentence.
    Proportional,
}

/// Whether the typeface has this letter.
pub(super) fn has(letter: char) -> bool {
    Weight::Regular.font().letters.map(letter).is_some()
}

/// The width of a text, in pixels.
pub(super) fn width(text: &str, style: Style) -> f32 {
    set(text, style).width * scale(style)
}

/// Draws a text from `x` to the right; its letters stand on `baseline`.
pub(super) fn draw(canvas: &mut Pixmap, text: &str, x: f32, baseline: f32, style: Style) {
    let Some(path) = path(text, style) else { return };
    let [red, green, blue] = style.color;
    let mut paint = Paint::default();
    paint.set_color(Color::from_rgba8(red, green, blue, u8::MAX));
    let scale = scale(style);
    // In a font, y points up.
    let place = Transform::from_row(scale, 0.0, 0.0, -scale, x, baseline);
    canvas.fill_path(&path, &paint, FillRule::Winding, place, None);
}

/// The number of pixels in a unit of the font.
pub(super) fn scale(style: Style) -> f32 {
    style.weight.font().scale(style.size)
}

/// The outlines of a text in units of the font; `y` points up. `None` if there is nothing to see.
pub(super) fn path(text: &str, style: Style) -> Option<Path> {
    let mut pen = Pen { path: PathBuilder::new(), origin: [0.0; 2], size: 1.0 };
    for Glyph { weight, number, x, y, size } in glyphs(text, style) {
        pen = Pen { origin: [x, y], size, ..pen };
        weight.font().draw_glyph(GlyphId16::new(number), &mut pen);
    }
    pen.path.finish()
}

/// The glyphs of a text, from left to right.
pub(super) fn glyphs(text: &str, style: Style) -> Vec<Glyph> {
    set(text, style).glyphs
}

/// The outline of a glyph in units of the font, as SVG writes a path; empty if there is nothing to see.
pub(super) fn outline(weight: Weight, glyph: u16) -> String {
    let mut pen = SvgPen(String::new());
    weight.font().draw_glyph(GlyphId16::new(glyph), &mut pen);
    pen.0
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

/// One weight of the typeface, and the tables with the distances between its letters.
struct Font {
    units_per_em: u16,
    letters: Charmap<'static>,
    metrics: GlyphMetrics<'static>,
    outlines: OutlineGlyphCollection<'static>,
    tabular: Vec<SingleSubst<'static>>,
    kerning: Vec<PairPos<'static>>,
    /// What was once found: the same few letters come again and again, and the tables of a font are slow to search.
    found_glyphs: Found<(char, Figures), (GlyphId16, f32)>,
    found_kerning: Found<[GlyphId16; 2], f32>,
}

/// Answers that are looked up once.
struct Found<K, V>(RwLock<HashMap<K, V>>);

impl<K: Copy + Eq + Hash, V: Copy> Found<K, V> {
    fn new() -> Self {
        Found(RwLock::default())
    }

    fn get(&self, key: K, look_up: impl FnOnce() -> V) -> V {
        // A thread that panicked between two insertions left the answers whole.
        let known = self.0.read().unwrap_or_else(PoisonError::into_inner).get(&key).copied();
        known.unwrap_or_else(|| {
            let answer = look_up();
            self.0.write().unwrap_or_else(PoisonError::into_inner).insert(key, answer);
            answer
        })
    }
}

/// A glyph of a line, in font units; `y` points up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Glyph {
    pub(super) weight: Weight,
    pub(super) number: u16,
    /// The distance from the beginning of the line, and above it.
    pub(super) x: f32,
    pub(super) y: f32,
    /// Its size, in that of the line.
    pub(super) size: f32,
}

/// A line of glyphs in font units.
struct Line {
    glyphs: Vec<Glyph>,
    width: f32,
}

/// Sets a text in a line.
fn set(text: &str, style: Style) -> Line {
    let (mut glyphs, mut width) = (Vec::new(), 0.0);
    let mut previous = None;
    for letter in text.chars() {
        let form = Form::of(letter);
        let weight = if form.is_vector { Weight::SemiBold } else { style.weight };
        let (font, [y, size]) = (weight.font(), form.place());
        let (glyph, advance) = font.advance(form.letter, style.figures);
        // Letters of two weights, or sizes, keep their own distance.
        if let Some((_, before)) = previous.filter(|(like, _)| *like == (weight, size)) {
            width += size * font.kern([before, glyph]);
        }
        glyphs.push(Glyph { weight, number: glyph.to_u16(), x: width, y, size });
        width += size * advance;
        previous = Some(((weight, size), glyph));
    }
    Line { glyphs, width }
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
        let read = |bytes| -> Result<Font, ReadError> {
            let font = FontRef::new(bytes)?;
            let (size, place) = (Size::unscaled(), LocationRef::default());
            Ok(Font {
                units_per_em: font.head()?.units_per_em(),
                letters: font.charmap(),
                metrics: font.glyph_metrics(size, place),
                outlines: font.outline_glyphs(),
                tabular: tabular(&font)?,
                kerning: kerning(&font)?,
                found_glyphs: Found::new(),
                found_kerning: Found::new(),
            })
        };
        read(bytes).expect("the embedded font is sound")
    }

    /// The number of pixels in a font unit.
    fn scale(&self, size: f32) -> f32 {
        size / f32::from(self.units_per_em)
    }

    /// The glyph of a letter, and its width.
    fn advance(&self, letter: char, figures: Figures) -> (GlyphId16, f32) {
        self.found_glyphs.get((letter, figures), || {
            let glyph = self.glyph(letter, figures);
            (glyph, self.metrics.advance_width(glyph.into()).unwrap_or(0.0))
        })
    }

    /// The glyph of a letter, or of a figure in the requested form.
    fn glyph(&self, letter: char, figures: Figures) -> GlyphId16 {
        // A letter that the font lacks becomes glyph 0, a box.
        let glyph = self.letters.map(letter).and_then(|glyph| glyph.try_into().ok());
        let glyph = glyph.unwrap_or(GlyphId16::NOTDEF);
        let tabular = figures == Figures::Tabular && letter.is_ascii_digit();
        if tabular { self.tabular_form(glyph).unwrap_or(glyph) } else { glyph }
    }

    fn tabular_form(&self, glyph: GlyphId16) -> Option<GlyphId16> {
        self.tabular.iter().find_map(|table| match table {
            SingleSubst::Format1(table) => {
                table.coverage().ok()?.get(glyph)?;
                let form = glyph.to_u16().wrapping_add_signed(table.delta_glyph_id());
                Some(GlyphId16::new(form))
            }
            SingleSubst::Format2(table) => {
                let place = table.coverage().ok()?.get(glyph)?;
                table.substitute_glyph_ids().get(place as usize).map(|form| form.get())
            }
            _ => None,
        })
    }

    /// The extra distance between two glyphs; a negative distance moves the glyphs nearer.
    fn kern(&self, pair: [GlyphId16; 2]) -> f32 {
        self.found_kerning.get(pair, || self.find_kerning(pair))
    }

    fn find_kerning(&self, [left, right]: [GlyphId16; 2]) -> f32 {
        let adjustment = self.kerning.iter().find_map(|table| match table {
            PairPos::Format1(table) => {
                let place = table.coverage().ok()?.get(left)?;
                let pairs = table.pair_sets().get(place as usize).ok()?;
                pairs.find_pair_value_record(right)?.value_record1().x_advance()
            }
            PairPos::Format2(table) => {
                table.coverage().ok()?.get(left)?;
                let class = |glyph, classes: ClassDef| u16::try_from(classes.get(glyph)).ok();
                let left = class(left, table.class_def1().ok()?)?;
                let right = class(right, table.class_def2().ok()?)?;
                table.value_record_refs(left, right)?[0].x_advance()
            }
            _ => None,
        });
        adjustment.map_or(0.0, f32::from)
    }

    fn draw_glyph(&self, glyph: GlyphId16, pen: &mut impl OutlinePen) {
        let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        if let Some(outline) = self.outlines.get(glyph.into()) {
            outline.draw(settings, pen).expect("the embedded font is sound");
        }
    }
}

/// The tables that map each figure to its form of equal width.
fn tabular(font: &FontRef<'static>) -> Result<Vec<SingleSubst<'static>>, ReadError> {
    let table = font.gsub()?;
    let lookups = table.lookup_list()?.lookups();
    let mut tables = Vec::new();
    for index in lookup_indices(&table.feature_list()?, Tag::new(b"tnum"))? {
        if let SubstitutionSubtables::Single(single) = lookups.get(index)?.subtables()? {
            tables.extend(single.iter().collect::<Result<Vec<_>, _>>()?);
        }
    }
    Ok(tables)
}

/// The tables with the distances between letters.
fn kerning(font: &FontRef<'static>) -> Result<Vec<PairPos<'static>>, ReadError> {
    let table = font.gpos()?;
    let lookups = table.lookup_list()?.lookups();
    let mut tables = Vec::new();
    for index in lookup_indices(&table.feature_list()?, Tag::new(b"kern"))? {
        if let PositionSubtables::Pair(pairs) = lookups.get(index)?.subtables()? {
            tables.extend(pairs.iter().collect::<Result<Vec<_>, _>>()?);
        }
    }
    Ok(tables)
}

/// The lookups of a feature. Scripts with a feature of their own are not drawn.
fn lookup_indices(features: &FeatureList, name: Tag) -> Result<Vec<usize>, ReadError> {
    let found = features.feature_records().iter().find(|record| record.feature_tag() == name);
    let Some(found) = found else { return Ok(Vec::new()) };
    let feature = found.feature(features.offset_data())?;
    Ok(feature.lookup_list_indices().iter().map(|index| index.get().into()).collect())
}

/// Draws glyphs one after another into one path.
struct Pen {
    path: PathBuilder,
    /// Where the glyph stands, and its size.
    origin: [f32; 2],
    size: f32,
}

impl Pen {
    fn at(&self, x: f32, y: f32) -> [f32; 2] {
        [self.origin[0] + self.size * x, self.origin[1] + self.size * y]
    }
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let [x, y] = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let [x, y] = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ([x1, y1], [x, y]) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ([x1, y1], [x2, y2], [x, y]) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

/// Writes the outline of a glyph as SVG does.
struct SvgPen(String);

impl SvgPen {
    fn write(&mut self, letter: char, numbers: &[f32]) {
        self.0.push(letter);
        for (place, number) in numbers.iter().enumerate() {
            // The font's coordinates are whole numbers.
            let space = if place == 0 { "" } else { " " };
            let _ = write!(self.0, "{space}{number:.0}");
        }
    }
}

impl OutlinePen for SvgPen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.write('M', &[x, y]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.write('L', &[x, y]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.write('Q', &[x1, y1, x, y]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.write('C', &[x1, y1, x2, y2, x, y]);
    }

    fn close(&mut self) {
        self.0.push('Z');
    }
}

#[cfg(test)]
mod tests {
    use super::super::formula::subscript;
    use super::*;

    const STYLE: Style =
        Style { weight: Weight::Regular, size: 24.0, color: [255; 3], figures: Figures::Tabular };

    #[test]
    fn all_figures_of_a_column_are_equally_wide() {
        let one = width("1", STYLE);
        assert!(one > 0.0);
        for digit in ["0", "4", "7", "9"] {
            assert_eq!(width(digit, STYLE), one);
        }
        assert_eq!(width("111", STYLE), width("987", STYLE));
    }

    #[test]
    fn a_one_in_a_sentence_is_narrow() {
        for weight in [Weight::Regular, Weight::SemiBold] {
            let style = Style { weight, figures: Figures::Proportional, ..STYLE };
            assert!(width("1", style) < 0.85 * width("0", style));
            assert!(width("274,561", style) < width("274,561", Style { weight, ..STYLE }));
        }
    }

    #[test]
    fn a_vector_is_bold_and_a_subscript_small_and_low() {
        let style = Style { weight: Weight::SemiBold, ..STYLE };
        assert_eq!(width("𝐝", STYLE), width("d", style));
        assert_eq!(width("𝐝", style), width("d", style));
        let name = format!("E{}", subscript("ab"));
        let [first, below, last] = glyphs(&name, STYLE).try_into().unwrap();
        assert!(first.y == 0.0 && first.size == 1.0);
        assert!(below.y < 0.0 && below.size < 1.0 && last.x > below.x);
        assert!(width(&name, STYLE) < width("Eab", STYLE));
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
