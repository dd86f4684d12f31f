//! The options that say which part of each file is read, what its numbers mean, and which scene it shows.

use crate::cli::args::{CameraArgs, FilesArgs};
use crate::cli::camera::{camera, options_given};
use crate::cli::failure::Failure;
use crate::cli::terminal;
use bothways::common::Camera;
use bothways::diff::foreign::Depth;
use bothways::scenes::LoadedScene;
use clap::Args;
use std::path::Path;

/// What the files hold, where they do not say so.
#[derive(Debug, Args)]
#[command(next_help_heading = "What the files hold")]
pub(in crate::cli) struct InputArgs {
    /// The channels of an EXR to read, such as Z or R,G,B: one is distances (floats), ids (integers) or a
    /// mask, three are colours or normals. Given twice: of A, and of B
    #[arg(long, value_name = "NAME[,NAME...]", value_parser = channels)]
    pub(super) channels: Vec<Names>,
    /// Read three floats a pixel as normals (so they are read anyway where some are negative and all
    /// have unit length)
    #[arg(long)]
    pub(super) normals: bool,
    /// What distances mean: t, ray (along the viewing ray), axis (along the axis of the view) or
    /// opengl:NEAR,FAR (window depth from 0 to 1); all but t need --scene. Given once, it does not apply to
    /// files *.t.npy, which hold t; given twice: of A, and of B
    #[arg(long, value_name = "MEANING", value_parser = depth, allow_hyphen_values = true)]
    pub(super) depth: Vec<Depth>,
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
}
