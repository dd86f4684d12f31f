//! The messages: each module answers one, or a few that belong together.

pub(crate) mod open;
pub(crate) mod render;
pub(crate) mod scenes;
