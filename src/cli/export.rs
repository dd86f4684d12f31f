//! `bothways export`: a whole scene for another program.

use super::args::{CameraArgs, FilesArgs};
use super::camera::camera;
use super::failure::Failure;
use super::output::Staging;
use super::terminal;
use bothways::common::View;
use bothways::export::{Export, Target, export};
use bothways::scenes::DEFAULT;
use bothways::wording::count;
use clap::{Args, ValueEnum};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub(super) const EXAMPLES: &str = "\
Examples:
  bothways export lecture --as gltf                  into out/lecture-gltf: lecture.glb
  bothways export lecture --as mitsuba -o there      lecture.xml, and a file for each mesh
  bothways export scene.toml --as pbrt --size 64x64  with another camera
  bothways export bunny.obj --as ply                 from one mesh format to another

Triangles go over exactly and in their order, so the ids of a scene of triangles stay. What becomes
something else is said as a warning: spheres are triangles in glTF, OBJ and PLY, planes end, and
lights are in physical units. Instances stay instances but in OBJ and PLY, which copy their mesh.
Pictures are PNG files beside the scene, in glTF within it.

Exit codes: 0 the files are written, 2 something went wrong: then none is.";

/// Which scene, and for what.
#[derive(Debug, Args)]
pub(super) struct ExportArgs {
    /// A built-in scene, a .toml scene file, or a mesh file (framed automatically)
    #[arg(default_value = DEFAULT)]
    scene: String,
    /// The program or the format
    #[arg(long = "as", value_name = "SYSTEM", value_enum)]
    target: TargetArg,
    /// The folder to write into; other files in it are left alone [default: out/SCENE-SYSTEM]
    #[arg(short = 'o', long = "output", value_name = "DIR")]
    folder: Option<PathBuf>,
    #[command(flatten)]
    files: FilesArgs,
    #[command(flatten)]
    camera: CameraArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum TargetArg {
    /// A scene of pbrt-v4, with camera and lights
    Pbrt,
    /// A scene of Mitsuba 3 in XML with its meshes, with camera and lights
    Mitsuba,
    /// Binary glTF 2.0, with camera, colours and pictures
    Gltf,
    /// Triangles with normals and texture coordinates, a file of materials, and pictures
    Obj,
    /// Triangles and the colours of their vertices
    Ply,
}

impl TargetArg {
    fn target(self) -> Target {
        match self {
            TargetArg::Pbrt => Target::Pbrt,
            TargetArg::Mitsuba => Target::Mitsuba,
            TargetArg::Gltf => Target::Gltf,
            TargetArg::Obj => Target::Obj,
            TargetArg::Ply => Target::Ply,
        }
    }
}

/// Refuses a folder that is called like a file of an export, as whoever writes `-o scene.glb` means a file. A folder of
/// this name that exists, or has a `/` behind its name, is meant.
fn check_folder(folder: &Path) -> Result<(), Failure> {
    let ending = folder.extension().unwrap_or_default().to_ascii_lowercase();
    let of_file = |target: &Target| ending == target.ending();
    let is_meant = folder.is_dir() || folder.as_os_str().as_encoded_bytes().ends_with(b"/");
    if is_meant || !(Target::ALL.iter().any(of_file) || ending == "gltf") {
        return Ok(());
    }
    let name = folder.display();
    Err(Failure::new(format!(
        "cannot write into the folder {name}: -o names a folder, and this is the name of a file, which is called after \
         the scene; choose another one with -o (one that is called so as {name}/)"
    )))
}

/// Writes all files or no file, and says what is not as in the scene.
pub(super) fn run(args: &ExportArgs) -> Result<ExitCode, Failure> {
    args.folder.as_deref().map_or(Ok(()), check_folder)?;
    let loaded = args.files.load_narrow(&args.scene, args.camera.size, "an export writes")?;
    let camera = camera(&loaded, &args.camera)?;
    let target = args.target.target();
    let view = View::new(&loaded.scene, &camera);
    let Export { files, notes } = export(&view, &loaded.name, target)
        .map_err(|error| Failure::new(format!("cannot export '{}': {error}", loaded.name)))?;
    let folder = args.folder.clone().unwrap_or_else(|| {
        let system = target.name().to_lowercase();
        Path::new("out").join(format!("{}-{system}", loaded.name))
    });
    // The presence of the last file shows that all are complete: the one that is to be opened.
    let names = files.iter().rev().map(|(name, _)| name.clone()).collect();
    let mut staging = Staging::begin_with(&folder, names)?;
    for (name, bytes) in files.iter().rev() {
        staging.write(name, |out| out.write_all(bytes))?;
    }
    staging.commit()?;
    terminal::warn(&loaded.warnings);
    terminal::warn(&notes);
    let (first, others) = (&files[0].0, files.len() - 1);
    let others = match others {
        0 => String::new(),
        _ => format!(", and {} beside it", count(others as u64, "files")),
    };
    anstream::eprintln!("wrote {}{others}", folder.join(first).display());
    Ok(ExitCode::SUCCESS)
}
