//! Pictures: what is drawn looks as somebody has seen and approved it, and shows what it says it shows.

mod built_in_scenes;
mod golden;
