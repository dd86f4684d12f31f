//! One case drawn by all four renderers: whether they agree, and how close the calls were.

use super::case::Case;
use super::close_calls::CloseCalls;
use super::dice::Dice;
use super::panics;
use super::renderers::Renderers;
use crate::common::raster::Region;
use crate::common::{Crop, Frame, Options, View};
use crate::orders::{Method, Order};
use serde::Serialize;
use std::fmt;

/// The tests of a primitive at a sample that each textbook may take for one case.
pub(super) const TEXTBOOK_TESTS: u64 = 1 << 16;

/// A renderer as it drew one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Witness {
    /// Its order.
    #[serde(serialize_with = "order_name")]
    pub order: Order,
    /// Its method.
    pub method: Method,
    /// Whether it drew the crop of the textbooks alone and counted its work, rather than the whole picture.
    pub counted: bool,
}

fn order_name<S: serde::Serializer>(order: &Order, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(order.name())
}

impl fmt::Display for Witness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counted = if self.counted { ", counted" } else { "" };
        write!(f, "{} ({}{counted})", self.order.name(), self.method.name())
    }
}

/// How two renderers disagree, or that one failed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Disagreement {
    /// Two renderers see different primitives at a sample, or only one of them sees a primitive.
    Ids {
        /// The two renderers.
        renderers: [Witness; 2],
        /// The first pixel in which they differ, `[i, j]` of the whole image.
        pixel: [u32; 2],
        /// The primitive that each sees at the first such sample of the pixel; `None` for nothing.
        ids: [Option<u64>; 2],
    },
    /// A renderer panicked.
    Panic {
        /// The renderer.
        renderer: Witness,
        /// The message of the panic.
        message: String,
    },
}

impl Disagreement {
    /// Whether the other one is of the same kind: another kind is another fault.
    pub(super) fn is_like(&self, other: &Disagreement) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }

    /// The first differing pixel, `[i, j]` of the whole image.
    pub fn pixel(&self) -> Option<[u32; 2]> {
        match self {
            Disagreement::Ids { pixel, .. } => Some(*pixel),
            Disagreement::Panic { .. } => None,
        }
    }
}

impl fmt::Display for Disagreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Disagreement::Ids { renderers: [first, second], pixel: [i, j], ids } => {
                let [seen, other] =
                    ids.map(|id| id.map_or("nothing".to_owned(), |id| format!("primitive {id}")));
                write!(f, "at pixel ({i}, {j}), {first} sees {seen}, {second} {other}")
            }
            Disagreement::Panic { renderer, message } => {
                write!(f, "{renderer} panicked: {message}")
            }
        }
    }
}

/// What was checked of one case, and the first disagreement.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Checked {
    /// Pixels that both fast renderers drew.
    pub pixels: u64,
    /// Those of them that both textbooks drew, too.
    pub textbook_pixels: u64,
    /// Exact ties that the textbook met there: of edges, and of distances.
    pub exact_ties: u64,
    /// Decisions there that the two fast renderers left to the exact judge.
    pub exact_fallbacks: u64,
    /// The disagreement, if there is one.
    pub disagreement: Option<Disagreement>,
}

/// Draws a case by all four renderers; `None` if scene or camera is refused.
///
/// The fast renderers draw all of the picture. Textbooks draw it too if that takes few tests, else a rectangle of it: one
/// that holds the pixel `focus`, or a border between two primitives.
pub(super) fn check(
    case: &Case,
    renderers: &Renderers,
    focus: Option<[u32; 2]>,
    dice: &mut Dice,
) -> Option<Checked> {
    let (scene, camera) = case.accepted()?;
    let view = View::new(&scene, &camera);
    let pixels = case.pixels();
    let mut checked = Checked {
        pixels: u64::from(pixels.width) * u64::from(pixels.height),
        ..Checked::default()
    };
    let result = compare(case, &view, renderers, focus, dice, &mut checked);
    checked.disagreement = result.err();
    Some(checked)
}

/// A drawn frame and who drew it.
type Drawn = (Witness, Frame);

fn compare(
    case: &Case,
    view: &View,
    renderers: &Renderers,
    focus: Option<[u32; 2]>,
    dice: &mut Dice,
    checked: &mut Checked,
) -> Result<(), Disagreement> {
    let all = case.options();
    let draw = |order, method, options: &Options, close: Option<&mut CloseCalls>| {
        let witness = Witness { order, method, counted: close.is_some() && method == Method::Fast };
        let frame = panics::caught(|| {
            let mut frame = Frame::new(view.camera, options);
            renderers.of(order, method)(view, options, &mut frame, close);
            frame
        });
        frame
            .map(|frame| (witness, frame))
            .map_err(|message| Disagreement::Panic { renderer: witness, message })
    };
    let by_object = draw(Order::Object, Method::Fast, &all, None)?;
    let by_image = draw(Order::Image, Method::Fast, &all, None)?;
    // Where the pair differs, the textbooks tell which of the two is wrong.
    let pair = agree(&by_object, &by_image, by_object.1.region());
    let focus = focus.or(pair.as_ref().err().and_then(Disagreement::pixel));
    let crop = textbook_crop(case, &by_object.1, focus, dice);
    let part = Options { crop: Some(crop), ..all };
    let region = crop.region(case.samples);

    let mut close = CloseCalls::new(view, case.samples);
    let expected = draw(Order::Object, Method::Textbook, &part, Some(&mut close))?;
    checked.exact_ties = close.exact_ties;
    agree(&expected, &draw(Order::Image, Method::Textbook, &part, None)?, &region)?;
    checked.textbook_pixels = u64::from(crop.height) * u64::from(crop.width);
    for (order, whole) in [(Order::Object, &by_object), (Order::Image, &by_image)] {
        agree(whole, &expected, &region)?;
        let mut close = CloseCalls::new(view, case.samples);
        agree(&draw(order, Method::Fast, &part, Some(&mut close))?, &expected, &region)?;
        checked.exact_fallbacks += close.exact_fallbacks();
    }
    pair
}

/// Compares the samples of a region that both frames hold.
fn agree(first: &Drawn, second: &Drawn, region: &Region) -> Result<(), Disagreement> {
    let frames = [&first.1, &second.1];
    if frames[0].region() == frames[1].region() && frames[0].ids() == frames[1].ids() {
        return Ok(());
    }
    let samples = first.1.samples() as usize;
    for row in region.rows.clone() {
        for column in region.columns.clone() {
            let ids = frames.map(|frame| frame.id(row, column));
            if ids[0] != ids[1] {
                let pixel = [row, column].map(|place| number(place / samples));
                let renderers = [first.0, second.0];
                return Err(Disagreement::Ids { renderers, pixel, ids });
            }
        }
    }
    Ok(())
}

/// The rectangle of the picture that the textbooks draw.
fn textbook_crop(case: &Case, frame: &Frame, focus: Option<[u32; 2]>, dice: &mut Dice) -> Crop {
    let all = case.pixels();
    let a_pixel = case.primitives().max(1) * u64::from(case.samples).pow(2);
    let area = (TEXTBOOK_TESTS / a_pixel).max(1);
    if area >= u64::from(all.height) * u64::from(all.width) {
        return all;
    }
    let height = number_of(area.isqrt()).min(all.height);
    let width = number_of(area / u64::from(height)).min(all.width);
    let [i, j] = focus.unwrap_or_else(|| border(frame, dice));
    // The pixel lies in the middle, or as near to it as the border of the picture allows.
    let start = |at: u32, first: u32, count: u32, length: u32| {
        at.saturating_sub(length / 2).clamp(first, first + count - length)
    };
    Crop {
        row: start(i, all.row, all.height, height),
        column: start(j, all.column, all.width, width),
        height,
        width,
    }
}

/// A pixel at a border between two primitives, or between one and nothing, in a random row; any pixel if there is none.
fn border(frame: &Frame, dice: &mut Dice) -> [u32; 2] {
    let Region { rows, columns } = frame.region().clone();
    let row = rows.start + dice.below(rows.len());
    let is_border = |column: &usize| frame.id(row, *column) != frame.id(row, column - 1);
    let borders: Vec<usize> = (columns.start + 1..columns.end).filter(is_border).collect();
    let column = if borders.is_empty() {
        columns.start + dice.below(columns.len())
    } else {
        dice.one_of(&borders)
    };
    let samples = frame.samples() as usize;
    [row, column].map(|place| number(place / samples))
}

fn number(place: usize) -> u32 {
    u32::try_from(place).expect("a side has at most 65,536 samples")
}

fn number_of(count: u64) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::glam::Vec3;
    use crate::common::{CameraDescription, Shape, Sphere};

    fn ball(image: [u32; 2]) -> Case {
        let ball = Sphere { center: Vec3::new(0.0, 0.0, -3.0), radius: 1.0 };
        let camera = CameraDescription { image, viewport: [1.0; 2], ..Default::default() };
        Case { shapes: vec![Shape::Sphere(ball)], camera, samples: 1, crop: None }
    }

    fn checked(case: &Case, renderers: &Renderers) -> Checked {
        check(case, renderers, None, &mut Dice::new(0, 0)).unwrap()
    }

    #[test]
    fn small_pictures_are_drawn_whole_by_the_textbooks_and_large_ones_in_part() {
        let small = checked(&ball([20, 30]), &Renderers::sound());
        assert_eq!((small.pixels, small.textbook_pixels), (600, 600));
        let large = checked(&ball([1000, 70]), &Renderers::sound());
        assert_eq!((large.pixels, large.textbook_pixels), (70_000, 70 * 936));
        assert_eq!((small.disagreement, large.disagreement), (None, None));
    }

    #[test]
    fn a_panic_is_a_disagreement() {
        let broken = Renderers::sound().with(Order::Image, Method::Fast, |_, _, _, _| {
            panic!("the tile is empty");
        });
        let found = checked(&ball([4, 4]), &broken).disagreement.unwrap();
        assert_eq!(found.to_string(), "image order (fast) panicked: the tile is empty");
    }

    #[test]
    fn the_first_differing_pixel_is_named() {
        let broken = Renderers::sound().with(Order::Object, Method::Textbook, |_, _, frame, _| {
            frame.set(2, 3, 7, 1.0);
        });
        let found = checked(&ball([4, 4]), &broken).disagreement.unwrap();
        assert_eq!(
            found.to_string(),
            "at pixel (1, 1), object order (textbook) sees nothing, image order (textbook) primitive 0"
        );
    }
}
