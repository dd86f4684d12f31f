//! `render`: both orders from one camera, their difference, and the verdict.

use crate::answer::{Answer, Buffer};
use crate::camera::{CameraJson, FrameJson, Viewpoint};
use crate::clock::timed;
use crate::stage::Stage;
use bothways_lab::common::{Frame, Work};
use bothways_lab::diff::{self, Class, Comparison, alike_color};
use bothways_lab::orders::{Order, Rule};
use bothways_lab::picture::{color_of_id, picture};
use bothways_lab::report::WorkReport;
use image::RgbImage;
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// The rules of both orders.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct RuleNames {
    /// The rule of an ordinary renderer, as on the command line; exact without it.
    #[serde(default)]
    object_rule: Option<String>,
    #[serde(default)]
    image_rule: Option<String>,
}

/// How to render.
#[derive(Debug, Deserialize)]
pub(crate) struct Render {
    #[serde(flatten)]
    from: Viewpoint,
    #[serde(flatten)]
    rules: RuleNames,
    #[serde(default)]
    look: Look,
    /// Whether the work is counted, in a separate frame.
    #[serde(default)]
    counts: bool,
    /// Whether the answer has the distances, too.
    #[serde(default)]
    distances: bool,
    /// Whether the answer leaves the ids out: while a camera moves nobody reads them, and [`ids`] gives them afterwards.
    #[serde(default, rename = "withoutIds")]
    without_ids: bool,
}

/// What the pictures show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Look {
    /// Light and material.
    #[default]
    Shaded,
    /// A colour for each primitive.
    Ids,
}

/// The JSON of the answer.
#[derive(Serialize)]
struct Rendered<'a> {
    camera: CameraJson,
    frame: FrameJson,
    object: Drawn,
    image: Drawn,
    difference: Difference,
    verdict: &'a Verdict,
}

/// What one order took.
#[derive(Clone, Copy, Default, Serialize)]
struct Drawn {
    ms: Times,
    work: Option<WorkReport>,
}

/// Milliseconds.
#[derive(Clone, Copy, Default, Serialize)]
struct Times {
    visibility: f64,
    shading: f64,
}

#[derive(Serialize)]
struct Difference {
    ms: f64,
}

#[derive(Serialize)]
struct Verdict {
    text: String,
    equal: bool,
    #[serde(rename = "coverageEqual")]
    coverage_equal: bool,
    #[serde(rename = "idsEqual")]
    ids_equal: bool,
    pixels: u64,
    covered: [u64; 2],
    differ: u64,
    #[serde(rename = "onlyObject")]
    only_object: u64,
    #[serde(rename = "onlyImage")]
    only_image: u64,
    #[serde(rename = "firstDiffering")]
    first_differing: Vec<[u32; 2]>,
    #[serde(rename = "colourDifference")]
    colour_difference: Option<u8>,
    #[serde(rename = "depthDifference")]
    depth_difference: Option<f64>,
}

pub(crate) fn answer(stage: &mut Stage, render: &Render) -> Result<Answer, String> {
    stage.camera = render.from.camera(&stage.loaded.camera)?;
    let rules = render.rules.parsed()?;
    let mut drawn = [Drawn::default(); 2];
    for (drawn, (order, rule)) in drawn.iter_mut().zip(Order::ALL.into_iter().zip(rules)) {
        let ((), visibility) = timed(|| stage.determine_visibility(order, rule, &mut ()));
        let ((), shading) = timed(|| stage.shade(order, rule));
        drawn.ms = Times { visibility, shading };
        drawn.work = (render.counts && rule.is_none()).then(|| counted(stage, order));
    }
    let (compared, ms) = timed(|| Compared::new(&stage.frames, render.counts));
    let [object, image] = drawn;
    let mut answer = Answer::new(Rendered {
        camera: CameraJson::new(stage.camera.description()),
        frame: FrameJson::new(&stage.camera),
        object,
        image,
        difference: Difference { ms },
        verdict: &compared.verdict,
    });
    for (order, frame) in Order::ALL.into_iter().zip(&stage.frames) {
        let at = |what: &str| format!("{}.{what}", key(order));
        answer = answer.with(at("rgba"), Buffer::U8(shown(frame, render.look)));
        if !render.without_ids {
            answer = answer.with(at("ids"), Buffer::U32(narrow_ids(frame)));
        }
        if render.distances {
            answer = answer.with(at("t"), Buffer::F32(frame.distances().to_vec()));
        }
    }
    Ok(answer.with("difference.rgba", Buffer::U8(rgba(&compared.difference))))
}

/// The page runs where addresses have 32 bits, so ids have no more.
fn narrow_ids(frame: &Frame) -> Vec<u32> {
    frame.ids().narrow().expect("scenes of wide ids are refused").to_vec()
}

/// `ids`: what both orders see in the last frames.
pub(crate) fn ids(stage: &Stage) -> Answer {
    let none = Answer::new(serde_json::json!({}));
    Order::ALL.into_iter().zip(&stage.frames).fold(none, |answer, (order, frame)| {
        answer.with(key(order), Buffer::U32(narrow_ids(frame)))
    })
}

/// The name of an order in messages.
pub(crate) fn key(order: Order) -> &'static str {
    match order {
        Order::Object => "object",
        Order::Image => "image",
    }
}

impl RuleNames {
    /// The rules of object order and of image order; `None` is exact.
    ///
    /// # Errors
    ///
    /// An unknown rule, in the words of the command line.
    pub(crate) fn parsed(&self) -> Result<[Option<Rule>; 2], String> {
        fn parsed<T: FromStr<Err: ToString>>(text: Option<&String>) -> Result<Option<T>, String> {
            let given = text.filter(|text| *text != "exact" && !text.is_empty());
            given.map(|text| text.parse().map_err(|error: T::Err| error.to_string())).transpose()
        }
        let object_order = parsed(self.object_rule.as_ref())?.map(Rule::Object);
        let image_order = parsed(self.image_rule.as_ref())?.map(Rule::Image);
        Ok([object_order, image_order])
    }
}

/// The counted work of a separate frame.
fn counted(stage: &mut Stage, order: Order) -> WorkReport {
    let mut work = Work::default();
    stage.determine_visibility(order, None, &mut work);
    work.into()
}

/// The picture of a frame with four bytes for each pixel.
fn shown(frame: &Frame, look: Look) -> Vec<u8> {
    match look {
        Look::Shaded => rgba(frame.picture()),
        Look::Ids => {
            let colors: Vec<_> = frame.ids().iter().map(color_of_id).collect();
            rgba(&colors)
        }
    }
}

/// The pixels of an image.
pub(crate) fn pixels(image: &RgbImage) -> &[[u8; 3]] {
    image.as_raw().as_chunks().0
}

/// Opaque pixels of four bytes each, as a canvas takes them.
pub(crate) fn rgba(colors: &[[u8; 3]]) -> Vec<u8> {
    const OPAQUE: u32 = u32::from_le_bytes([0, 0, 0, u8::MAX]);
    // Four pixels are three words of the one form and four of the other.
    let (fours, rest) = colors.as_flattened().as_chunks::<12>();
    let mut bytes = Vec::with_capacity(4 * colors.len());
    for four in fours {
        let [a, b, c] = [0, 4, 8]
            .map(|at| u32::from_le_bytes([four[at], four[at + 1], four[at + 2], four[at + 3]]));
        let pixels = [a, a >> 24 | b << 8, b >> 16 | c << 16, c >> 8];
        let words = pixels.map(|pixel| (pixel | OPAQUE).to_le_bytes());
        bytes.extend_from_slice(words.as_flattened());
    }
    for color in rest.as_chunks::<3>().0 {
        bytes.extend_from_slice(&[color[0], color[1], color[2], u8::MAX]);
    }
    bytes
}

/// The verdict, and the difference image.
struct Compared {
    verdict: Verdict,
    difference: Vec<[u8; 3]>,
}

impl Compared {
    /// Compares the frames of both orders. Where they have the same ids, and the page is not at rest to count, nothing else is
    /// asked: then distances and colours are not compared.
    fn new(frames: &[Frame; 2], completely: bool) -> Compared {
        let [object_order, image_order] = frames;
        if !completely && object_order.ids() == image_order.ids() {
            return Compared::of_equal(object_order);
        }
        let pictures = frames.each_ref().map(picture);
        let comparison = diff::compare_shown([object_order, image_order], pictures.each_ref());
        let difference = comparison.classes().picture(&pictures[0]);
        Compared { verdict: Verdict::new(&comparison), difference: pixels(&difference).to_vec() }
    }

    /// The comparison of frames with the same ids.
    fn of_equal(frame: &Frame) -> Compared {
        let covered = frame.ids().covered() as u64;
        let pixels = frame.ids().iter().zip(frame.picture());
        let color = |(id, &light): (Option<u64>, &[u8; 3])| match id {
            Some(_) => alike_color(light),
            None => Class::Neither.color(),
        };
        Compared {
            verdict: Verdict {
                text: diff::verdict_of_equal(covered),
                equal: true,
                coverage_equal: true,
                ids_equal: true,
                pixels: frame.ids().len() as u64,
                covered: [covered; 2],
                differ: 0,
                only_object: 0,
                only_image: 0,
                first_differing: Vec::new(),
                colour_difference: None,
                depth_difference: None,
            },
            difference: pixels.map(color).collect(),
        }
    }
}

impl Verdict {
    fn new(comparison: &Comparison) -> Verdict {
        let coverage = comparison.coverage;
        let [width, height] = comparison.classes().image().map(u64::from);
        Verdict {
            text: comparison.verdict(),
            equal: comparison.matches(),
            coverage_equal: coverage.matches,
            ids_equal: comparison.visible.differing_pixels == 0,
            pixels: width * height,
            covered: [coverage.object_order, coverage.image_order],
            differ: comparison.visible.differing_pixels,
            only_object: coverage.only_object_order,
            only_image: coverage.only_image_order,
            first_differing: comparison.visible.first_differing.clone(),
            colour_difference: Some(comparison.color.max_difference),
            depth_difference: Some(comparison.depth.max_relative_difference),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::rgba;

    #[test]
    fn pixels_become_opaque_one_by_one() {
        let colors: Vec<[u8; 3]> = (0..11_u8).map(|at| [at, 100 + at, 255 - at]).collect();
        for count in 0..colors.len() {
            let expected: Vec<u8> = colors[..count]
                .iter()
                .flat_map(|&[red, green, blue]| [red, green, blue, 255])
                .collect();
            assert_eq!(rgba(&colors[..count]), expected, "{count} pixels");
        }
    }
}
