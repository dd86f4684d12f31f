//! The messages: each module answers one, or a few that belong together.

pub(crate) mod observed;
pub(crate) mod open;
pub(crate) mod outside;
pub(crate) mod own;
pub(crate) mod pixel;
pub(crate) mod question;
pub(crate) mod quiz;
pub(crate) mod render;
pub(crate) mod scenes;
pub(crate) mod steps;
pub(crate) mod why;
pub(crate) mod work;
