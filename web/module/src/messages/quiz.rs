//! `quiz`: a renderer with a mistake, chosen by a number; what did it do wrong? `answer`: whether a choice is right.
//! `quizFinder`: what the convention finder says of that renderer.

use super::render::{pixels, rgba};
use super::why::{drawn, sentence_about};
use crate::answer::{Answer, Buffer};
use bothways_lab::common::Projection;
use bothways_lab::common::{Camera, Frame, View};
use bothways_lab::diff;
use bothways_lab::orders::{Order, Rule, Rules};
use bothways_lab::picture::picture;
use bothways_lab::rules::{image_order, object_order};
use bothways_lab::scenes::{self, LoadedScene, with_projection};
use fastrand::Rng;
use serde::Deserialize;
use serde_json::json;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Quiz {
    seed: u64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Choice {
    seed: u64,
    choice: usize,
}

/// A mistake that can be seen, and the scenes that show it.
struct Mistake {
    rule: Rule,
    scenes: &'static [&'static str],
}

/// The height of the pictures; their width follows from the scene.
const HEIGHT: u32 = 72;
/// The choices of a question.
const CHOICES: usize = 4;

/// The mistakes. No two of them look alike.
fn mistakes() -> [Mistake; 8] {
    use image_order::Rule as Image;
    use object_order::Rule as Object;
    let mistake = |rule, scenes| Mistake { rule, scenes };
    [
        mistake(Rule::Image(Image::FlipRows), &["lecture", "canonical", "parallel"]),
        mistake(Rule::Image(Image::Corner), &["canonical", "lecture", "slivers"]),
        mistake(Rule::Image(Image::OneOrigin), &["parallel", "lecture", "canonical"]),
        mistake(Rule::Image(Image::Jittered { seed: 7 }), &["lecture", "canonical", "parallel"]),
        mistake(Rule::Object(Object::Inclusive), &["ties"]),
        mistake(Rule::Object(Object::Exclusive), &["ties"]),
        mistake(Rule::Object(Object::Snapped { bits: 0 }), &["lecture", "slivers", "parallel"]),
        mistake(Rule::Object(Object::NearClip { depth: 6.5 }), &["lecture"]),
    ]
}

/// What a rule does, without what the command line says of its number.
fn words(rule: Rule) -> &'static str {
    match rule {
        Rule::Object(object_order::Rule::Snapped { .. }) => "Vertices are rounded to whole pixels.",
        Rule::Object(object_order::Rule::NearClip { .. }) => {
            "What is nearer than a certain depth is cut away."
        }
        Rule::Image(image_order::Rule::Jittered { .. }) => {
            "Each sample is moved randomly within its pixel."
        }
        rule => rule.about().what,
    }
}

/// A question: a scene, the mistake, and the choices in their order.
struct Question {
    loaded: LoadedScene,
    camera: Camera,
    rule: Rule,
    choices: Vec<Rule>,
}

impl Question {
    /// The question of a number: always the same.
    fn of(seed: u64) -> Result<Question, String> {
        let mut dice = Rng::with_seed(seed);
        let mut mistakes = mistakes();
        dice.shuffle(&mut mistakes);
        let [Mistake { rule, scenes }, ..] = mistakes;
        let scene = scenes[dice.usize(..scenes.len())];
        let loaded = scenes::load(scene).map_err(|error| error.to_string())?;
        let camera = camera(&loaded, rule).map_err(|error| error.to_string())?;
        let mut choices: Vec<Rule> =
            mistakes.iter().take(CHOICES).map(|mistake| mistake.rule).collect();
        dice.shuffle(&mut choices);
        Ok(Question { loaded, camera, rule, choices })
    }
}

/// The scene's camera with a small image; a mistake about parallel rays needs a parallel camera. Ties need a size that is a power of
/// two.
fn camera(loaded: &LoadedScene, rule: Rule) -> Result<Camera, bothways_lab::common::CameraError> {
    let mut camera = loaded.camera;
    let [width, height] = camera.image;
    camera.image = match loaded.name.as_str() {
        "ties" => [64, 64],
        _ => [(width * HEIGHT).div_ceil(height), HEIGHT],
    };
    if rule == Rule::Image(image_order::Rule::OneOrigin) {
        camera = with_projection(&camera, Projection::Parallel, &loaded.scene)?;
    }
    Camera::new(camera)
}

pub(crate) fn quiz(quiz: &Quiz) -> Result<Answer, String> {
    let Question { loaded, camera, rule, choices } = Question::of(quiz.seed)?;
    let view = View::new(&loaded.scene, &camera);
    let [truth, wrong] = both(&view, rule);
    let comparison = diff::compare(&truth, &wrong);
    let difference = comparison.classes().picture(&picture(&truth));
    let [width, height] = camera.image();
    let texts: Vec<&str> = choices.iter().map(|rule| words(*rule)).collect();
    Ok(Answer::new(json!({
        "scene": loaded.name, "width": width, "height": height, "choices": texts,
        "differ": comparison.visible.differing_pixels,
        "truth": {}, "renderer": {}, "difference": {},
    }))
    .with("truth.rgba", Buffer::U8(rgba(truth.picture())))
    .with("renderer.rgba", Buffer::U8(rgba(wrong.picture())))
    .with("difference.rgba", Buffer::U8(rgba(pixels(&difference)))))
}

/// The frame of a rule's order, exact and by the rule.
fn both(view: &View, rule: Rule) -> [Frame; 2] {
    [Rules::default(), rule.into()].map(|rules| drawn(view, rule.order(), rules))
}

pub(crate) fn answer(choice: &Choice) -> Result<Answer, String> {
    let Question { rule, choices, .. } = Question::of(choice.seed)?;
    let right = choices.get(choice.choice) == Some(&rule);
    let order = match rule.order() {
        Order::Object => "rasterizer",
        Order::Image => "ray tracer",
    };
    let sentence = match choices.get(choice.choice) {
        Some(chosen) if *chosen == rule => {
            let (words, gives) = (words(rule), rule.about().reproduces);
            format!("{words} It was a {order} with the rule {rule}, and gives {gives}.")
        }
        // The answer stays open: one can try again.
        Some(chosen) => format!("That would give {}.", chosen.about().reproduces),
        None => "There is no such choice.".into(),
    };
    Ok(Answer::new(json!({ "right": right, "sentence": sentence })))
}

pub(crate) fn finder(quiz: &Quiz) -> Result<Answer, String> {
    let Question { loaded, camera, rule, .. } = Question::of(quiz.seed)?;
    let view = View::new(&loaded.scene, &camera);
    let sentence = sentence_about(&view, &drawn(&view, rule.order(), rule.into()), "the renderer");
    Ok(Answer::new(json!({ "sentence": sentence })))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every mistake can be seen in each of its scenes: otherwise there would be nothing to find.
    #[test]
    fn every_mistake_shows() {
        for Mistake { rule, scenes } in mistakes() {
            for name in scenes {
                let loaded = scenes::load(name).unwrap();
                let camera = camera(&loaded, rule).unwrap();
                let view = View::new(&loaded.scene, &camera);
                let [truth, wrong] = both(&view, rule);
                let differing = diff::compare(&truth, &wrong).visible.differing_pixels;
                assert!(differing >= 8, "{name} {rule}: {differing}");
            }
        }
    }

    #[test]
    fn each_question_has_one_right_choice_among_different_ones() {
        for seed in 0..200 {
            let question = Question::of(seed).unwrap();
            let mut texts: Vec<_> = question.choices.iter().map(|rule| rule.about().what).collect();
            assert_eq!(question.choices.iter().filter(|rule| **rule == question.rule).count(), 1);
            texts.sort_unstable();
            texts.dedup();
            assert_eq!(texts.len(), CHOICES, "{seed}");
        }
    }
}
