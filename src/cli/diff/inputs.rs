//! The files that are compared: which part of each is read, and what its numbers mean.

use super::DiffArgs;
use crate::cli::args::{CameraArgs, FilesArgs};
use crate::cli::camera::{camera, options_given};
use crate::cli::failure::Failure;
use crate::cli::terminal;
use bothways::common::Camera;
use bothways::diff::foreign::{self, Buffer, Content, Depth, ReadBuffer, ReadOptions};
use bothways::formats::source::quote::visible;
use bothways::scenes::LoadedScene;
use clap::Args;
use std::path::{Path, PathBuf};

/// What the files hold, where they do not say so.
#[derive(Debug, Args)]
#[command(next_help_heading = "What the files hold")]
pub(in crate::cli) struct InputArgs {
    /// The channels of an EXR to read, such as Z or R,G,B: one is distances (floats), ids (integers) or a
    /// mask, three are colours or normals. Given twice: of A, and of B
    #[arg(long, value_name = "NAME[,NAME...]", value_parser = channels)]
    channels: Vec<Names>,
    /// Read three floats a pixel as normals (so they are read anyway where some are negative and all
    /// have unit length)
    #[arg(long)]
    normals: bool,
    /// What distances mean: t, ray (along the viewing ray), axis (along the axis of the view) or
    /// opengl:NEAR,FAR (window depth from 0 to 1); all but t need --scene. Given once, it is not said of files
    /// *.t.npy, which are t; given twice: of A, and of B
    #[arg(long, value_name = "MEANING", value_parser = depth, allow_hyphen_values = true)]
    depth: Vec<Depth>,
}

/// The scene that the files show.
#[derive(Debug, Args)]
#[command(next_help_heading = "Scene")]
pub(in crate::cli) struct SceneArgs {
    /// The scene that the files show: a built-in one, a .toml scene file or a mesh file, with the camera
    /// options of render. Its image has the size of the files
    #[arg(long, value_name = "SCENE")]
    pub(in crate::cli) scene: Option<String>,
    #[command(flatten)]
    pub(in crate::cli) files: FilesArgs,
    #[command(flatten)]
    pub(in crate::cli) camera: CameraArgs,
}

/// The names of some channels.
type Names = Vec<String>;

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

/// The scene that the user names, or another one if there is none; without `--size` its image has this size.
pub(in crate::cli) fn scene_of_size(
    args: &SceneArgs,
    otherwise: Option<&Path>,
    size: Option<[u32; 2]>,
) -> Result<Option<(LoadedScene, Camera)>, Failure> {
    let changes = options_given(&args.camera);
    let otherwise = otherwise.filter(|path| path.is_file()).map(|path| path.display().to_string());
    let Some(source) = args.scene.clone().or(otherwise) else {
        return match &changes[..] {
            "" if args.files.allow_outside => Err(Failure::new(
                "--allow-outside: the files of which scene? Name it with --scene SCENE, or leave --allow-outside out",
            )),
            "" => Ok(None),
            changes => Err(Failure::new(format!(
                "{changes}: the camera of which scene? Name it with --scene SCENE, or leave {changes} out"
            ))),
        };
    };
    let camera_args = CameraArgs { size: args.camera.size.or(size), ..args.camera.clone() };
    let loaded = args.files.load_narrow(&source, camera_args.size, "reasons are found among")?;
    terminal::warn(&loaded.warnings);
    // A message names the options that the user gave, and not the size of the files.
    let camera = camera(&loaded, &camera_args)
        .map_err(|error| camera(&loaded, &args.camera).err().unwrap_or(error))?;
    Ok(Some((loaded, camera)))
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
    Ok([a, b])
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

fn channels(text: &str) -> Result<Names, String> {
    let names: Names = text.split(',').map(|name| name.trim().to_owned()).collect();
    match names.iter().any(String::is_empty) {
        true => Err("give names with commas between them, such as R,G,B".into()),
        false => Ok(names),
    }
}

/// A meaning of distances.
fn depth(text: &str) -> Result<Depth, String> {
    const KNOWN: &str = "give t, ray, axis or opengl:NEAR,FAR";
    match text {
        "t" => return Ok(Depth::T),
        "ray" => return Ok(Depth::Ray),
        "axis" => return Ok(Depth::Axis),
        _ => {}
    }
    let planes = text.strip_prefix("opengl:").ok_or(KNOWN)?;
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|plane| *plane > 0.0);
    let planes: Option<Vec<f64>> = planes.split(',').map(number).collect();
    match planes.as_deref() {
        Some(&[near, far]) if near != far => Ok(Depth::OpenGl { near, far }),
        _ => Err("the planes of OpenGL are two distances above 0, such as opengl:0.1,100; inf is \
                  infinitely far, and a far plane before a near one is for reversed depth"
            .into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meanings_of_distances_are_four() {
        assert_eq!(
            ["t", "ray", "axis"].map(depth),
            [Ok(Depth::T), Ok(Depth::Ray), Ok(Depth::Axis)]
        );
        let planes = Depth::OpenGl { near: 0.5, far: f64::INFINITY };
        assert_eq!(depth("opengl:0.5, inf"), Ok(planes));
        assert_eq!(depth("z").unwrap_err(), "give t, ray, axis or opengl:NEAR,FAR");
        for bad in
            ["opengl:", "opengl:1", "opengl:0,1", "opengl:1,1", "opengl:1,nan", "opengl:1,2,3"]
        {
            assert!(depth(bad).unwrap_err().starts_with("the planes of OpenGL are two"), "{bad}");
        }
    }

    #[test]
    fn channels_are_names() {
        assert_eq!(channels("R, G,B").unwrap(), ["R", "G", "B"]);
        assert!(channels("R,,B").is_err() && channels("").is_err());
    }

    #[test]
    fn one_value_is_of_both_files() {
        assert_eq!([0, 1].map(|side| of_side(&['a'], side).copied()), [Some('a'); 2]);
        assert_eq!([0, 1].map(|side| of_side(&['a', 'b'], side).copied()), [Some('a'), Some('b')]);
        assert_eq!(of_side::<char>(&[], 0), None);
    }
}
