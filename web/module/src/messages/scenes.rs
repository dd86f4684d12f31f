//! `scenes`: what is built in, and the rules of ordinary renderers.

use crate::answer::Answer;
use bothways_lab::scenes::BUILT_IN;
use serde::Serialize;

#[derive(Serialize)]
struct SceneJson {
    name: &'static str,
    title: String,
    sentence: &'static str,
}

pub(crate) fn answer() -> Answer {
    let scenes: Vec<SceneJson> = BUILT_IN
        .iter()
        .map(|scene| SceneJson {
            name: scene.name,
            title: capitalized(scene.name),
            sentence: scene.about,
        })
        .collect();
    Answer::new(scenes)
}

/// `Lecture`, for a list that people read.
fn capitalized(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
