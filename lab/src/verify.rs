//! A check of some samples of a picture with the textbook renderer: a cheap test if the textbook would take days for
//! the whole picture.
//!
//! The fast renderers are tested against the textbooks on many scenes, but perhaps not on the present scene. Errors
//! are most likely where decisions are close. So the check first chooses samples there: where the orders disagree, at
//! exact ties, at silhouettes, at edges between primitives; and then samples anywhere.

mod choice;

pub use choice::{Choice, Reason, choose};

use crate::common::{Crop, Frame, Options, View};
use crate::orders::{Order, Rendered};
use crate::wording::{count, grouped};
use crate::{rasterize, raytrace};
use rayon::prelude::*;
use serde::Serialize;

/// The number of wrong pixels that the report names.
const NAMED_PIXELS: usize = 10;

/// The result of the check, counted in samples.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Verified {
    /// The number of samples that the textbook also answered.
    pub samples: u64,
    /// The samples in pixels in which the orders see different primitives.
    pub differing: u64,
    /// The samples in pixels with an exact tie: a sample on an edge of a primitive visible in the pixel or in a
    /// neighbour, or two primitives equally near.
    pub ties: u64,
    /// The samples in uncovered pixels with a covered neighbour, and in covered pixels with an uncovered neighbour.
    pub silhouettes: u64,
    /// The samples in pixels with a neighbour that shows another primitive.
    pub edges: u64,
    /// The samples anywhere else.
    pub at_random: u64,
    /// The comparison of object order with its textbook, if object order was rendered.
    pub object_order: Option<Against>,
    /// The comparison of image order with its textbook, if image order was rendered.
    pub image_order: Option<Against>,
    /// Whether no sample differs.
    #[serde(rename = "match")]
    pub matches: bool,
}

/// The comparison of one order with its textbook.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Against {
    /// The samples at which the order and its textbook see different primitives, or only one of them sees a
    /// primitive.
    pub differing_samples: u64,
    /// The first pixels with such samples, at most 10, as `[i, j]` of the whole image, row by row.
    pub first_differing: Vec<[u32; 2]>,
}

impl Verified {
    /// The verdict in one line.
    pub fn verdict(&self) -> String {
        let samples = count(self.samples, "samples");
        if self.matches {
            return format!("verified: {samples} answered by the textbook as well, none differs");
        }
        let said = |name: &str, against: &Option<Against>| {
            let against = against.as_ref().filter(|against| against.differing_samples > 0)?;
            let first = against.first_differing.first();
            let first = first.map(|[i, j]| format!(", first at ({i}, {j})")).unwrap_or_default();
            Some(format!("{name} in {} of them{first}", grouped(against.differing_samples)))
        };
        let wrong =
            [said("object order", &self.object_order), said("image order", &self.image_order)];
        let wrong: Vec<String> = wrong.into_iter().flatten().collect();
        let wrong = wrong.join("; ");
        format!(
            "not verified: {samples} answered by the textbook as well, which sees otherwise than {wrong}"
        )
    }

    /// The places of the samples, in words.
    pub fn places(&self) -> String {
        let all = [
            (self.differing, "where the orders differ"),
            (self.ties, "at exact ties"),
            (self.silhouettes, "at silhouettes"),
            (self.edges, "at edges"),
            (self.at_random, "at random"),
        ];
        let some = all.iter().filter(|(samples, _)| *samples > 0);
        let some: Vec<String> =
            some.map(|(samples, place)| format!("{} {place}", grouped(*samples))).collect();
        some.join(", ")
    }
}

/// Computes about `samples` samples with the textbook, in whole pixels, and compares.
///
/// This function runs on the current rayon pool. The choice of pixels depends on the pictures alone, and is the same
/// for any number of threads. The function calls `progress` after each pixel.
///
/// # Panics
///
/// If there is no rendered order, or the frames belong to another view.
///
/// ```
/// use bothways_lab::common::{Camera, View};
/// use bothways_lab::orders::{self, Method, Order, RenderOptions};
///
/// let scene = bothways_lab::scenes::load("canonical")?.scene;
/// let camera = Camera::canonical(32, 32);
/// let view = View::new(&scene, &camera);
/// let drawn = orders::render(Order::Object, Method::Fast, &view, &RenderOptions::default())?;
/// let verified = bothways_lab::verify::verify(&view, &[drawn], 100, &|| ());
/// assert!(verified.matches && verified.samples == 100);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn verify(
    view: &View,
    rendered: &[Rendered],
    samples: u64,
    progress: &(dyn Fn() + Sync),
) -> Verified {
    let frames: Vec<&Frame> = rendered.iter().map(|one| &one.frame).collect();
    let a_pixel = u64::from(frames[0].samples()).pow(2);
    let pixels = usize::try_from(pixels(frames[0], samples)).unwrap_or(usize::MAX);
    let choices = choose(view, &frames, pixels);
    let against: Vec<(Order, Against)> =
        rendered.iter().map(|one| (one.order, against(view, one, &choices, progress))).collect();
    let of =
        |order| against.iter().find(|(of, _)| *of == order).map(|(_, against)| against.clone());
    let chosen =
        |reason| a_pixel * choices.iter().filter(|choice| choice.reason == reason).count() as u64;
    Verified {
        samples: a_pixel * choices.len() as u64,
        differing: chosen(Reason::Differs),
        ties: chosen(Reason::Tie),
        silhouettes: chosen(Reason::Silhouette),
        edges: chosen(Reason::Edge),
        at_random: chosen(Reason::Random),
        matches: against.iter().all(|(_, against)| against.differing_samples == 0),
        object_order: of(Order::Object),
        image_order: of(Order::Image),
    }
}

/// The number of pixels to check for this number of samples: enough pixels, or all pixels.
pub fn pixels(frame: &Frame, samples: u64) -> u64 {
    let [width, height] = frame.image().map(u64::from);
    samples.div_ceil(u64::from(frame.samples()).pow(2)).min(width * height)
}

/// Compares the frame of one order with its textbook, in the chosen pixels.
fn against(
    view: &View,
    one: &Rendered,
    choices: &[Choice],
    progress: &(dyn Fn() + Sync),
) -> Against {
    let textbook = |[row, column]: [u32; 2]| {
        let crop = Some(Crop { row, column, height: 1, width: 1 });
        let options = Options { samples: one.frame.samples(), crop };
        let mut frame = Frame::new(view.camera, &options);
        match one.order {
            Order::Object => {
                rasterize::textbook::determine_visibility(view, &options, &mut frame, &mut ());
            }
            Order::Image => {
                raytrace::textbook::determine_visibility(view, &options, &mut frame, &mut ());
            }
        }
        frame
    };
    let wrong = choices.par_iter().map(|choice| {
        let [i, j] = choice.pixel;
        let expected = textbook(choice.pixel);
        let drawn = one.frame.samples_of(i as usize, j as usize);
        let pairs = expected.samples_of(i as usize, j as usize).zip(drawn);
        let differing =
            pairs.filter(|(own, drawn)| expected.ids().get(*own) != one.frame.ids().get(*drawn));
        let differing = differing.count() as u64;
        progress();
        (choice.pixel, differing)
    });
    let mut wrong: Vec<([u32; 2], u64)> = wrong.filter(|(_, differing)| *differing > 0).collect();
    wrong.sort_unstable();
    Against {
        differing_samples: wrong.iter().map(|(_, differing)| differing).sum(),
        first_differing: wrong.iter().map(|(pixel, _)| *pixel).take(NAMED_PIXELS).collect(),
    }
}

#[cfg(test)]
mod tests;
