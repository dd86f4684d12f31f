//! `rules`: the rules of ordinary renderers. `why`: where and why the orders disagree under some of them. `reason`: the same
//! for one pixel, in a sentence. `finder`: what the convention finder says, which takes its time.

use super::render::RuleNames;
use crate::answer::{Answer, Buffer};
use crate::camera::{Pixel, Viewpoint};
use crate::stage::Stage;
use bothways_lab::common::{Camera, CameraDescription, Frame, View};
use bothways_lab::diff;
use bothways_lab::diff::foreign::Buffer as Known;
use bothways_lab::diff::why::{
    Finding, PixelReason, ReasonKind, Reasons, Wrong, alternatives, find_conventions, find_reasons,
};
use bothways_lab::orders::{self, Method, Order, RenderOptions, Rule, Rules};
use bothways_lab::picture::picture;
use serde::Deserialize;
use serde_json::{Value, json};

#[derive(Debug, Deserialize)]
pub(crate) struct Why {
    #[serde(flatten)]
    from: Viewpoint,
    #[serde(flatten)]
    rules: RuleNames,
}

#[derive(Debug, Deserialize)]
pub(crate) struct OfPixel {
    #[serde(flatten)]
    pixel: Pixel,
}

/// The convention finder draws the scene under hundreds of hypotheses: in a picture of at most so many pixels, it answers while
/// one waits.
const MOST_FINDER_PIXELS: f64 = 2500.0;
/// It leaves out scenes of more primitives than this, for the same reason.
const MOST_FINDER_PRIMITIVES: u64 = 20_000;

pub(crate) fn rules() -> Answer {
    let of = |order: Order| -> Vec<Value> {
        let examples = Rule::examples().into_iter().filter(|rule| rule.order() == order);
        let entry = |rule: Rule| {
            let about = rule.about();
            json!({
                "name": rule, "form": about.form, "what": about.what,
                "reproduces": about.reproduces, "scene": rule.scene(),
            })
        };
        examples.map(entry).collect()
    };
    Answer::new(json!({ "object": of(Order::Object), "image": of(Order::Image) }))
}

pub(crate) fn answer(stage: &mut Stage, why: &Why) -> Result<Answer, String> {
    let rules = why.rules.parsed()?;
    stage.camera = why.from.camera(&stage.loaded.camera)?;
    for (order, rule) in Order::ALL.into_iter().zip(rules) {
        stage.determine_visibility(order, rule, &mut ());
    }
    let view = stage.view();
    let frames = &stage.frames;
    let pictures = frames.each_ref().map(picture);
    let comparison = diff::compare_shown([&frames[0], &frames[1]], pictures.each_ref());
    let differing: Vec<[u32; 2]> =
        comparison.classes().differing().map(|(pixel, _)| pixel).collect();
    let [a, b] = [0, 1].map(|side: usize| Known::of_frame(&frames[side], &pictures[side]));
    let reasons = find_reasons(&view, &a, &b, &differing).map_err(|error| error.to_string())?;
    let answer = with_reasons(&reasons, view.camera);
    stage.reasons = reasons.pixels;
    Ok(answer)
}

/// The counts of reasons, and for each pixel the place of its reason among them, from 1; 0 where the orders agree.
fn with_reasons(reasons: &Reasons, camera: &Camera) -> Answer {
    let counts = reasons.counts();
    let [width, height] = camera.image();
    let mut index = vec![0_u8; width as usize * height as usize];
    let place = |kind: ReasonKind| {
        let at = counts.iter().position(|(known, _)| *known == kind).map_or(0, |at| at + 1);
        u8::try_from(at).unwrap_or(u8::MAX)
    };
    for PixelReason { pixel: [row, column], reason, .. } in &reasons.pixels {
        index[*row as usize * width as usize + *column as usize] = place(reason.kind());
    }
    let entry = |(kind, count): &(ReasonKind, u64)| json!({ "reason": kind.name(), "count": count, "colour": kind.color() });
    Answer::new(json!({
        "counts": counts.iter().map(entry).collect::<Vec<Value>>(),
        "differing": reasons.differing,
        "partial": reasons.is_partial(),
    }))
    .with("index", Buffer::U8(index))
}

/// What the convention finder says of each order that has a rule.
pub(crate) fn finder(stage: &Stage, why: &Why) -> Result<Answer, String> {
    let rules = why.rules.parsed()?;
    let camera = why.from.camera(&stage.loaded.camera)?;
    let view = View::new(&stage.loaded.scene, &camera);
    let each = Order::ALL.into_iter().zip(rules);
    let sentences: Vec<String> =
        each.filter_map(|(order, rule)| Some(about_order(&view, order, rule?))).collect();
    Ok(Answer::new(json!({ "sentence": sentences.join(" ") })))
}

/// What the convention finder says of a renderer with a rule, in a small picture from the same camera.
fn about_order(view: &View, order: Order, rule: Rule) -> String {
    let name = order.name();
    if view.scene.primitive_count() > MOST_FINDER_PRIMITIVES {
        return format!(
            "The convention finder takes its time for a scene as large as this; for {name}, ask \
             'bothways diff --scene' on the command line."
        );
    }
    let Ok(camera) = Camera::new(reduced(view.camera.description())) else {
        return String::new();
    };
    let view = View::new(view.scene, &camera);
    sentence_about(&view, &drawn(&view, order, rule.into()), name)
}

/// The same camera with a smaller image of the same form.
fn reduced(camera: &CameraDescription) -> CameraDescription {
    let [width, height] = camera.image.map(f64::from);
    let scale = (MOST_FINDER_PIXELS / (width * height)).sqrt().min(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "smaller than u32")]
    let side = |side: f64| ((side * scale) as u32).max(1);
    CameraDescription { image: [side(width), side(height)], ..*camera }
}

/// A frame of one order, by such rules.
pub(crate) fn drawn(view: &View, order: Order, rules: Rules) -> Frame {
    let options =
        RenderOptions { rules, no_times: true, no_counts: true, ..RenderOptions::default() };
    let rendered = orders::render(order, Method::Fast, view, &options);
    rendered.expect("only streams of meshes fail").frame
}

/// What the convention finder says of a frame.
pub(crate) fn sentence_about(view: &View, frame: &Frame, name: &str) -> String {
    let picture = picture(frame);
    let found = match find_conventions(view, &Known::of_frame(frame, &picture)) {
        Ok(found) => found,
        Err(error) => return format!("The convention finder cannot tell: {error}."),
    };
    match found.finding {
        Finding::True => {
            format!(
                "In a picture of the size that the convention finder looks at, {name} shows what is true."
            )
        }
        Finding::NoEvidence(reason) => format!("The convention finder cannot tell: {reason}."),
        Finding::Rounded => format!(
            "The convention finder says: {name} has the conventions of the scene, and is wrong by rounding alone."
        ),
        Finding::Unexplained(_) => format!(
            "The convention finder knows no convention under which {name} would be right: the reasons of single pixels \
             tell more."
        ),
        Finding::Explained(explanations) => {
            let sentences: Vec<Vec<String>> =
                explanations.iter().map(|one| one.sentences(name, view.camera)).collect();
            let guess = explanations.first().is_some_and(|one| one.is_a_guess(found.differing));
            let says = if guess { "guesses" } else { "says" };
            format!("The convention finder {says}: {}.", alternatives(&sentences))
        }
    }
}

pub(crate) fn reason(stage: &Stage, of: &OfPixel) -> Result<Answer, String> {
    let Pixel { row, column } = of.pixel;
    let found = stage.reasons.iter().find(|one| one.pixel == [row, column]);
    let found = found.ok_or_else(|| format!("the orders agree in pixel ({row}, {column})"))?;
    let who = match found.wrong {
        Wrong::A => "Object order is wrong here: ",
        Wrong::B => "Image order is wrong here: ",
        Wrong::Both => "Both are wrong here: ",
        Wrong::Neither => "",
    };
    let sentence = found.reason.sentence();
    Ok(Answer::new(json!({ "sentence": format!("{who}{sentence}."), "truth": found.truth })))
}
