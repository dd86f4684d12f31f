//! `bothways vectors`: writes the conformance set.

use super::failure::Failure;
use super::output::{Out, Staging};
use super::{npy, terminal};
use bothways::common::Frame;
use bothways::formats::obj;
use bothways::formats::scene_file::framed_mesh_toml;
use bothways::picture::mask;
use bothways::vectors::{ENDINGS, Entry, Group, Vector, all, expected, index, json, readme};
use bothways::wording::count;
use clap::Args;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

pub(super) const EXAMPLES: &str = "\
Examples:
  bothways vectors                   the whole set, into out/vectors
  bothways vectors -o vectors        somewhere else; README.md there says how to use it
  bothways vectors --json | jq .     the index, for a program to read

Exit codes: 0 the set is written, 2 something went wrong, or the orders disagree: then nothing is.";

const INDEX: &str = "index.json";
const README: &str = "README.md";

/// Where to write the set.
#[derive(Debug, Args)]
pub(super) struct VectorsArgs {
    /// The folder to write into; other files in it are left alone
    #[arg(short = 'o', long = "output", value_name = "DIR", default_value = "out/vectors")]
    folder: PathBuf,
    /// Print the index as JSON instead of a summary
    #[arg(long)]
    json: bool,
}

/// Computes all answers, and writes all files or no file.
pub(super) fn run(args: &VectorsArgs) -> Result<ExitCode, Failure> {
    let vectors = all();
    let answers = vectors.iter().map(expected).collect::<Result<Vec<Frame>, _>>();
    let answers = answers.map_err(|error| Failure::new(error.to_string()))?;
    let entries: Vec<Entry> =
        vectors.iter().zip(&answers).map(|(vector, frame)| Entry::new(vector, frame)).collect();
    let index = index(&entries).map_err(|error| Failure::new(error.to_string()))?;

    let names = entries.iter().flat_map(|entry| entry.files.iter().cloned());
    let names = names.chain([README.to_owned(), INDEX.to_owned()]).collect();
    let mut staging = Staging::begin_with(&args.folder, names)?;
    for (vector, frame) in vectors.iter().zip(&answers) {
        write_vector(&mut staging, vector, frame)?;
    }
    staging.write(INDEX, |out| out.write_all(index.as_bytes()))?;
    staging.write(README, |out| out.write_all(readme(&entries).as_bytes()))?;
    staging.commit()?;

    terminal::print(&if args.json { index } else { summary(&entries, args) })?;
    Ok(ExitCode::SUCCESS)
}

fn write_vector(staging: &mut Staging, vector: &Vector, frame: &Frame) -> Result<(), Failure> {
    let Vector { name, point, mesh, camera, .. } = vector;
    let [toml, mesh_file, all, ids, distances, seen] =
        ENDINGS.map(|ending| format!("{name}{ending}"));
    let scene = format!("# {point}\n\n{}", framed_mesh_toml(camera, false, &mesh_file));
    let json = json(vector, frame).map_err(|error| Failure::new(error.to_string()))?;
    staging.write(&toml, |out| out.write_all(scene.as_bytes()))?;
    staging.write(&mesh_file, |out| obj::write(mesh, out))?;
    staging.write(&all, |out| out.write_all(json.as_bytes()))?;
    staging.write(&ids, |out: &mut Out| npy::write_ids(frame, out))?;
    staging.write(&distances, |out: &mut Out| npy::write_distances(frame, out))?;
    staging.write_grey(&seen, &mask(frame))
}

fn summary(entries: &[Entry], args: &VectorsArgs) -> String {
    let mut text = String::new();
    for group in Group::ALL.map(Group::name) {
        let scenes = entries.iter().filter(|entry| entry.group == group).count() as u64;
        text += &format!("{group:16}{:>10}\n", count(scenes, "scenes"));
    }
    let bold = anstyle::Style::new().bold();
    let dimmed = anstyle::Style::new().dimmed();
    let scenes = count(entries.len() as u64, "scenes");
    text += &format!("\n{bold}{scenes}{bold:#}, on each of which both orders agree\n");
    let folder = args.folder.display();
    text + &format!("{dimmed}written to {folder}; {README} there says how to use it{dimmed:#}\n")
}
