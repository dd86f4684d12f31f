//! The open scene, and the list of all messages.

use crate::answer::Answer;
use crate::messages::{
    observed, open, outside, own, pixel, question, quiz, render, scenes, steps, why, work,
};
use crate::stage::Stage;
use serde::de::DeserializeOwned;

/// Answers messages, one after another. It keeps the scene that was opened last.
#[derive(Debug, Default)]
pub struct Engine {
    stage: Option<Stage>,
}

impl Engine {
    /// Answers a message: its name, its arguments as a JSON object, and the bytes of the files that it comes with.
    ///
    /// # Errors
    ///
    /// A text for the reader of the page, in the words of the command line: what is wrong, and what to do.
    pub fn call(
        &mut self,
        name: &str,
        arguments: &str,
        bytes: Option<&[u8]>,
    ) -> Result<Answer, String> {
        match name {
            "scenes" => Ok(scenes::answer()),
            "open" => open::answer(&mut self.stage, &parsed(name, arguments)?, bytes),
            "camera" => open::camera(self.stage()?, &parsed(name, arguments)?),
            "render" => render::answer(self.stage()?, &parsed(name, arguments)?),
            "ids" => Ok(render::ids(self.stage()?)),
            "steps" => steps::answer(self.stage()?, &parsed(name, arguments)?),
            "pixel" => pixel::answer(self.stage()?, &parsed(name, arguments)?),
            "neighbourhood" => pixel::neighbourhood(self.stage()?, &parsed(name, arguments)?),
            "own" => own::answer(&parsed(name, arguments)?),
            "outside" => match question::of_picture(arguments) {
                Some(question) => Ok(question?.outside()),
                None => outside::answer(self.stage()?, &parsed(name, arguments)?),
            },
            "observed" => observed::answer(self.stage()?, &parsed(name, arguments)?),
            "rays" => match question::of_picture(arguments) {
                Some(question) => question?.rays(),
                None => outside::rays(self.stage()?, &parsed(name, arguments)?),
            },
            "rules" => Ok(why::rules()),
            "why" => why::answer(self.stage()?, &parsed(name, arguments)?),
            "reason" => why::reason(self.stage()?, &parsed(name, arguments)?),
            "finder" => why::finder(self.stage()?, &parsed(name, arguments)?),
            "quizFinder" => quiz::finder(&parsed(name, arguments)?),
            "quiz" => quiz::quiz(&parsed(name, arguments)?),
            "answer" => quiz::answer(&parsed(name, arguments)?),
            "question" => question::question(&parsed(name, arguments)?),
            "check" => question::check(&parsed(name, arguments)?),
            "work" => work::answer(&parsed(name, arguments)?),
            _ => Err(format!("the page sent the message {name:?}, which the module does not know")),
        }
    }

    /// The open scene.
    fn stage(&mut self) -> Result<&mut Stage, String> {
        self.stage.as_mut().ok_or_else(|| "no scene is open; open one first".into())
    }
}

/// The arguments of a message.
fn parsed<T: DeserializeOwned>(name: &str, arguments: &str) -> Result<T, String> {
    serde_json::from_str(arguments).map_err(|error| {
        format!("the page sent the message {name:?} with wrong arguments: {error}")
    })
}
