//! Pictures: they agree with approved pictures, and with their descriptions.

mod built_in_scenes;
mod golden;
mod kinds;
