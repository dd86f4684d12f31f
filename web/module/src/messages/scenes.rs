//! `scenes`: what is built in.

use crate::answer::Answer;
use bothways_lab::scenes::BUILT_IN;
use serde_json::{Value, json};

pub(crate) fn answer() -> Answer {
    let scenes = BUILT_IN.iter();
    let each = scenes.map(|scene| json!({ "name": scene.name, "sentence": scene.about }));
    Answer::new(each.collect::<Vec<Value>>())
}
