//! The program for users and scripts: its commands, its texts, its files, and its behaviour at a terminal.

mod arguments;
mod bad_input;
mod camera;
mod check;
mod command_line;
mod cover;
mod crop;
mod diff;
mod diff_folders;
mod diff_hints;
mod diff_page;
mod diff_why;
mod export;
mod exr;
mod film;
mod folder;
mod fuzz;
mod output;
mod pixel;
mod readme;
mod rules;
mod slides;
mod sweep;
mod terminal;
mod texts;
mod verify;
