//! The page to leaf through the slides, and the text beside it.

use super::deck::Deck;
use crate::figure::Theme;
use serde::Serialize;

/// What the page's script needs of a slide.
#[derive(Serialize)]
struct Entry<'a> {
    file: &'a str,
    title: &'a str,
    caption: &'a str,
    notes: &'a str,
}

pub(super) fn page(deck: &Deck) -> String {
    let entries = deck.slides.iter().map(|slide| Entry {
        file: &slide.file,
        title: &slide.title,
        caption: slide.caption,
        notes: slide.notes,
    });
    let entries: Vec<Entry> = entries.collect();
    let data = serde_json::to_string(&entries).expect("texts can be written as JSON");
    // Nothing in the data may end the script.
    let data = data.replace('<', "\\u003c");
    let theme = match deck.theme {
        Theme::Dark => "dark",
        Theme::Light => "light",
    };
    include_str!("page.html").replace("{{theme}}", theme).replace("{{slides}}", &data)
}

pub(super) fn readme(deck: &Deck) -> String {
    let mut text = String::from(
        "# Slides: object order and image order\n\n\
         Open `index.html` in a browser: → and ← leaf, `n` shows the notes, `o` all slides, `f` fills the screen, `?` lists\n\
         the keys. Every picture is drawn from a render by `bothways slides`; the SVG files can be put on slides of your own.\n\n",
    );
    for slide in &deck.slides {
        text += &format!("- [{}]({}): {}\n", slide.title, slide.file, slide.caption);
    }
    text
}
