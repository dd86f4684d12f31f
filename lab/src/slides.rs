//! The whole set of slides for a lecture, in its order: figures, films, captions and the lecturer's notes.
//!
//! ```no_run
//! use bothways_lab::figure::Theme;
//! use bothways_lab::scenes;
//! use bothways_lab::slides::Deck;
//!
//! let scenes = vec![scenes::load("lecture")?];
//! let deck = Deck::new(&scenes, Theme::Dark, true)?;
//! for slide in deck.slides() {
//!     println!("{}: {}", slide.file, slide.caption);
//! }
//! std::fs::write("index.html", deck.page())?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod content;
mod deck;
mod error;
mod page;
mod stills;
mod words;

pub use content::Content;
pub use deck::{Deck, Slide};
pub use error::SlideError;

use crate::figure::Theme;
use crate::scenes::LoadedScene;
use content::plans;

impl<'a> Deck<'a> {
    /// The set for some scenes: the whole lecture with the first one, then a chapter for each of the others.
    ///
    /// # Errors
    ///
    /// A built-in scene of the set that cannot be loaded.
    pub fn new(
        scenes: &'a [LoadedScene],
        theme: Theme,
        films: bool,
    ) -> Result<Deck<'a>, SlideError> {
        let plans = plans(scenes, films)?;
        let slides = plans.into_iter().enumerate().map(|(number, planned)| {
            // A scene may have any name; a file that pages and texts link to may not.
            let typed = |letter: char| {
                if letter.is_alphanumeric() || "-_.".contains(letter) { letter } else { '_' }
            };
            let name: String = planned.name.chars().map(typed).collect();
            let file = format!("{:02}-{name}.{}", number + 1, planned.plan.ending());
            let (title, caption, notes) = (planned.title, planned.caption, planned.notes);
            Slide { file, title, caption, notes, plan: planned.plan }
        });
        Ok(Deck { theme, slides: slides.collect() })
    }

    /// The slides in their order.
    pub fn slides(&self) -> &[Slide<'a>] {
        &self.slides
    }

    /// Leaves out the slide with this file: the page and the text beside it do not name it.
    pub fn leave_out(&mut self, file: &str) {
        self.slides.retain(|slide| slide.file != file);
    }

    /// Draws a slide.
    ///
    /// # Errors
    ///
    /// A scene that has nothing of what the slide shows.
    pub fn draw(&self, slide: &Slide) -> Result<Content, SlideError> {
        slide.plan.draw(self.theme)
    }

    /// A page to leaf through the slides by keys. It loads nothing but the files beside it.
    pub fn page(&self) -> String {
        page::page(self)
    }

    /// What is in the folder, as a text.
    pub fn readme(&self) -> String {
        page::readme(self)
    }
}

#[cfg(test)]
mod tests;
