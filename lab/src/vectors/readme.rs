//! The `README.md` of the set.

use super::json::Entry;
use super::vector::Group;
use std::fmt::Write;

/// The description of the files and their use, and a list of all scenes.
pub fn readme(entries: &[Entry]) -> String {
    let without: Vec<String> = entries
        .iter()
        .filter(|entry| !entry.raster)
        .map(|entry| format!("`{}`", entry.name))
        .collect();
    let mut text = include_str!("readme.md")
        .replace("{count}", &entries.len().to_string())
        .replace("{without_raster}", &without.len().to_string())
        .replace("{without_raster_names}", &without.join(", "));
    for group in Group::ALL.map(Group::name) {
        write!(text, "\n### {group}\n\n| scene | point |\n|---|---|\n").expect("a string has room");
        for Entry { name, point, .. } in entries.iter().filter(|entry| entry.group == group) {
            writeln!(text, "| [`{name}`]({name}.json) | {point} |").expect("a string has room");
        }
    }
    text
}
