//! The program as people and scripts meet it: its commands, its texts, its files, and its manners at a terminal.

mod arguments;
mod bad_input;
mod camera;
mod command_line;
mod cover;
mod crop;
mod diff;
mod output;
mod pixel;
mod readme;
mod terminal;
mod texts;
mod verify;
