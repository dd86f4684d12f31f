//! Reads the files that are compared: which part of each, and as what its numbers are taken.

use super::args::DiffArgs;
use super::inputs::{InputArgs, scene_of_size};
use crate::cli::failure::Failure;
use bothways::common::Camera;
use bothways::diff::foreign::{
    self, Buffer, Content, Depth, ReadBuffer, ReadOptions, ids_of_floats,
};
use bothways::formats::source::quote::visible;
use std::path::{Path, PathBuf};

/// A file that was read.
pub(super) struct ReadFile {
    pub(super) buffer: Buffer<'static>,
    path: PathBuf,
    has_channels: bool,
    /// Which part of the file was read, and how.
    pub(super) notes: Vec<String>,
    /// What makes the content doubtful.
    pub(super) warnings: Vec<String>,
}

impl ReadFile {
    /// What makes the content doubtful, with the name of the file.
    pub(super) fn named_warnings(&self) -> Vec<String> {
        self.warnings.iter().map(|warning| format!("{}: {warning}", self.path.display())).collect()
    }

    /// ` (channel Z; not read: R, G, B)`, or nothing.
    pub(super) fn notes_in_words(&self) -> String {
        match &self.notes[..] {
            [] => String::new(),
            notes => format!(" ({})", visible(&notes.join("; "))),
        }
    }
}

/// Reads both files, with distances as `t`.
pub(super) fn read(args: &DiffArgs) -> Result<[ReadFile; 2], Failure> {
    let files = read_pair(args, &[args.a.clone(), args.b.clone()], None)?;
    let of_neither = |option: &str, does: &str, remedy: &str| {
        let (a, b) = (args.a.display(), args.b.display());
        Err(Failure::new(format!("{option} {does}, and neither {a} nor {b} has any; {remedy}")))
    };
    let InputArgs { channels, depth, .. } = &args.inputs;
    if !channels.is_empty() && files.iter().all(|file| !file.has_channels) {
        return of_neither("--channels", "chooses channels of an EXR", "leave it out");
    }
    let has_distances = |file: &ReadFile| matches!(file.buffer.content(), Content::Distances(_));
    if !depth.is_empty() && !files.iter().any(has_distances) {
        let remedy = "leave it out, or choose a channel of distances with --channels";
        return of_neither("--depth", "says what distances mean", remedy);
    }
    Ok(files)
}

/// Reads two files; `scene` is their scene unless the user names one.
pub(super) fn read_pair(
    args: &DiffArgs,
    paths: &[PathBuf; 2],
    scene: Option<&Path>,
) -> Result<[ReadFile; 2], Failure> {
    let InputArgs { channels, normals, depth } = &args.inputs;
    at_most_two("--channels", channels.len())?;
    at_most_two("--depth", depth.len())?;
    let read = |side: usize| {
        let options = ReadOptions {
            background: args.background,
            channels: of_side(channels, side).cloned().unwrap_or_default(),
            normals: *normals,
        };
        let path = &paths[side];
        let ReadBuffer { buffer, notes, warnings } =
            foreign::read_with(path, &options).map_err(|error| Failure::new(error.to_string()))?;
        let has_channels = !notes.is_empty();
        Ok::<_, Failure>(ReadFile { buffer, path: path.clone(), has_channels, notes, warnings })
    };
    let (a, b) = rayon::join(|| read(0), || read(1));
    let [mut a, mut b] = [a?, b?];
    let camera = if depth.is_empty() {
        None
    } else {
        scene_of_size(&args.scene, scene, Some(a.buffer.size()))?.map(|(_, camera)| camera)
    };
    let files = [(0, &mut a), (1, &mut b)];
    for (side, file) in files {
        match of_side(depth, side) {
            Some(_) if depth.len() == 1 && is_t(&file.path) => {
                file.notes.push("t by its name".into());
            }
            Some(depth) => convert(file, *depth, camera.as_ref())?,
            None => {}
        }
    }
    // Who says what distances mean says that they are distances.
    if depth.is_empty() {
        read_as_ids(&mut a, &b.buffer);
        read_as_ids(&mut b, &a.buffer);
    }
    Ok([a, b])
}

/// Takes floating-point numbers for ids where the other file has ids, and they look like some.
fn read_as_ids(file: &mut ReadFile, other: &Buffer<'static>) {
    let Some(ids) = ids_of_floats(&file.buffer, other) else { return };
    file.buffer = ids;
    file.notes.push("floating-point numbers, read as ids".into());
    file.warnings.push(
        "these numbers look like ids saved as floating-point numbers, and are read as ids; save them as integers \
         (astype('uint32')), or give --depth t if they are distances"
            .into(),
    );
}

/// Makes `t` of a file's distances.
fn convert(file: &mut ReadFile, depth: Depth, camera: Option<&Camera>) -> Result<(), Failure> {
    if depth == Depth::T || !matches!(file.buffer.content(), Content::Distances(_)) {
        return Ok(());
    }
    let path = file.path.display();
    let Some(camera) = camera else {
        return Err(Failure::new(format!(
            "{path}: only with the camera do {} become t; name the scene with --scene SCENE, and change its \
             camera as for render",
            depth.name()
        )));
    };
    // The buffer is replaced whole.
    let nothing = Buffer::new([1, 1], 1, Content::Mask(vec![false].into()));
    let buffer = std::mem::replace(&mut file.buffer, nothing);
    file.buffer =
        depth.to_t(buffer, camera).map_err(|error| Failure::new(format!("{path}: {error}")))?;
    file.notes.push(format!("from {}", depth.name()));
    Ok(())
}

/// The value for a file, of one value for both files or two.
fn of_side<T>(values: &[T], side: usize) -> Option<&T> {
    values.get(side).or(values.first())
}

fn at_most_two(option: &str, given: usize) -> Result<(), Failure> {
    if given <= 2 {
        return Ok(());
    }
    Err(Failure::new(format!(
        "{option} is given {given} times; give it once for both files, or twice, for A and for B"
    )))
}

/// Whether a file is named as those that this program writes.
fn is_t(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(".t.npy"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_value_is_of_both_files() {
        assert_eq!([0, 1].map(|side| of_side(&['a'], side).copied()), [Some('a'); 2]);
        assert_eq!([0, 1].map(|side| of_side(&['a', 'b'], side).copied()), [Some('a'), Some('b')]);
        assert_eq!(of_side::<char>(&[], 0), None);
    }
}
