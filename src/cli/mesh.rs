//! `bothways mesh`: writes a generated mesh as an OBJ, PLY or STL file.

use super::failure::Failure;
use super::output::OutputFile;
use bothways::formats::generate::Kind;
use bothways::formats::mesh_file::Format;
use bothways::formats::{obj, ply, scene_file, stl};
use bothways::wording::{count, grouped};
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub(super) const EXAMPLES: &str = "\
Kinds and what their divisions count:
  sphere     around, from pole to pole       radius 1
  cylinder   around, along                   radius 1, y from -1 to 1, with caps
  cone       around, along                   radius 1 at y = -1, apex at y = 1, with its base
  torus      around, around the tube         radius 1 around the y axis, tube 0.4
  box        along x and z, along y          from -1 to 1
  grid       across, up                      the square from -1 to 1 in the plane z = 0
  teapot     both sides of each patch        Newell's, on y = 0, from its Bezier patches

Normals point outward. Closed surfaces share their vertices by index, also across seams.

Examples:
  bothways mesh teapot -o teapot.obj
  bothways mesh sphere --divisions 512,256 -o ball.obj
  bothways mesh grid --divisions 4 -o grid.ply     PLY or STL: positions and triangles alone
  bothways mesh box -o - | less                    to standard output, as OBJ";

/// Which mesh, and where to.
#[derive(Debug, Args)]
pub(super) struct MeshArgs {
    /// sphere, cylinder, cone, torus, box, grid or teapot
    #[arg(value_parser = kind)]
    kind: Kind,
    /// How finely it is divided, in its two directions; one number stands for both
    #[arg(long, value_name = "N[,M]", value_parser = divisions, allow_hyphen_values = true)]
    divisions: Option<[u32; 2]>,
    /// The file, OBJ, PLY or STL as its name ends; - is standard output
    #[arg(short = 'o', long = "output", value_name = "FILE.obj")]
    file: PathBuf,
}

/// Generates the mesh, writes the file and prints a message.
pub(super) fn run(args: &MeshArgs) -> Result<ExitCode, Failure> {
    let file = OutputFile::find(&args.file)?;
    let format = format(&file)?;
    let divisions = args.divisions.unwrap_or_else(|| args.kind.default_divisions());
    let mesh = args.kind.mesh(divisions).map_err(|error| Failure::new(error.to_string()))?;
    file.write(|out| match format {
        Format::Obj => obj::write(&mesh, out),
        Format::Ply => ply::write(&mesh, out),
        Format::Stl => stl::write(&mesh, out),
        Format::Gltf => unreachable!("the format was chosen among those that are written"),
    })?;
    let vertices = grouped(mesh.positions().len() as u64);
    anstream::eprintln!(
        "wrote {}: {}, {vertices} vertices",
        file.said(),
        count(mesh.triangles().len() as u64, "triangles")
    );
    Ok(ExitCode::SUCCESS)
}

/// The format for the file's name; OBJ if the name has no ending.
fn format(file: &OutputFile) -> Result<Format, Failure> {
    let Some(ending) = file.ending() else { return Ok(Format::Obj) };
    let named = Format::of(Path::new(&format!("mesh.{ending}")));
    named.filter(|&format| format != Format::Gltf).ok_or_else(|| {
        Failure::new(format!(
            "cannot write {}: a mesh is written as OBJ, PLY or STL, and .{ending} is none of them; end \
             the name in .obj, .ply or .stl",
            file.said()
        ))
    })
}

fn kind(name: &str) -> Result<Kind, String> {
    Kind::named(name).ok_or_else(|| {
        let names = Kind::ALL.map(Kind::name);
        let nearest = scene_file::nearest_name(name, names);
        let suggestion = nearest.map_or(String::new(), |near| format!("did you mean {near}? "));
        format!("{suggestion}the kinds are {}", names.join(", "))
    })
}

fn divisions(text: &str) -> Result<[u32; 2], String> {
    let number = |text: &str| {
        let number = text.trim().parse::<u32>();
        number.map_err(|_| format!("'{text}' is not a number of divisions; give N or N,M"))
    };
    let numbers = text.split(',').map(number).collect::<Result<Vec<u32>, String>>()?;
    match numbers[..] {
        [both] => Ok([both; 2]),
        [first, second] => Ok([first, second]),
        _ => Err(format!("it has {}; give N or N,M", count(numbers.len() as u64, "numbers"))),
    }
}
