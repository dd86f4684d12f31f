//! A renderer's pictures of a conformance set: which scenes it gets wrong, and why.
//!
//! [`check`] reads a folder of masks, ids or distances whose names begin with those of the set's scenes, holds each to the
//! exact picture of its scene, and looks for the causes: conventions that explain many scenes at once
//! ([`find_common_conventions`](crate::diff::why::find_common_conventions)), then the reasons of the pixels of each scene
//! ([`find_reasons`](crate::diff::why::find_reasons)).
//!
//! ```no_run
//! use bothways_lab::check::{self, ConformanceSet};
//! use std::path::Path;
//!
//! let checked = check::check(Path::new("mine"), &ConformanceSet::BuiltIn, None)?;
//! println!("{}", checked.verdict());
//! # Ok::<(), bothways_lab::check::CheckError>(())
//! ```

mod causes;
mod found;
mod page;
mod set;
mod truth;

pub use found::{Cause, Certainty, Check, CheckedFile, Compared, NotCompared};
pub use set::{ConformanceSet, SetError};
pub(crate) use truth::truth;

use crate::common::{Camera, Scene, View};
use crate::diff::foreign::{CompareOptions, ReadOptions, compare_with, read_with};
use crate::diff::pairs::{PairsError, files_of_set};
use crate::diff::why::{alternatives, check_size};
use crate::wording::{count, grouped};
use std::path::Path;

/// The reason why a folder cannot be checked.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// The folder cannot be listed, or has no files of the set's scenes.
    #[error(transparent)]
    Pairs(#[from] PairsError),
    /// The set cannot be read.
    #[error(transparent)]
    Set(#[from] SetError),
}

/// Checks a folder of pictures. `background` (in sRGB) is the colour of what is not covered in pictures that have no
/// alpha.
///
/// # Errors
///
/// If the folder or the set cannot be read, or the folder has no file of any scene. A file that cannot be read or
/// compared is a row of the result.
pub fn check(
    theirs: &Path,
    set: &ConformanceSet,
    background: Option<[u8; 3]>,
) -> Result<Check, CheckError> {
    let scenes = set.scenes()?;
    let found = files_of_set(theirs, &scenes)?;
    let mut files = Vec::new();
    let mut loaded: Vec<(Scene, Camera)> = Vec::new();
    for pair in found.pairs {
        let point = pair.point.unwrap_or_default();
        let scene = pair.name.split('.').next().unwrap_or_default().to_owned();
        let (content, camera) = set.load(&scene)?;
        let compared = compared(&theirs.join(&pair.a), &content, &camera, background);
        files.push(CheckedFile { scene, file: pair.a, point, compared });
        loaded.push((content, camera));
    }
    let causes = causes::find(&files, &loaded);
    Ok(Check { files, missing: found.missing_in_a, ignored: found.ignored, causes })
}

/// Compares a file with the exact picture of its scene.
fn compared(
    path: &Path,
    scene: &Scene,
    camera: &Camera,
    background: Option<[u8; 3]>,
) -> Result<Compared, NotCompared> {
    let options = ReadOptions { background, ..ReadOptions::default() };
    let theirs = read_with(path, &options).map_err(|error| error.to_string())?.buffer;
    let view = View::new(scene, camera);
    if let Err(error) = check_size(&view, &theirs) {
        let [width, height] = camera.image();
        let exchanged = (theirs.size() == [height, width]).then_some(theirs);
        return Err(NotCompared { reason: error.to_string(), exchanged });
    }
    let truth = truth(&view, &theirs)?;
    let options = CompareOptions { only_compares: true, ..CompareOptions::default() };
    let comparison = compare_with(&theirs, &truth, &options).map_err(|error| error.to_string())?;
    Ok(Compared { theirs, truth, comparison })
}

impl Check {
    /// Whether the file of each scene is there, and right.
    pub fn passes(&self) -> bool {
        self.missing.is_empty() && self.files.iter().all(CheckedFile::is_right)
    }

    /// The number of files that are right.
    pub fn right(&self) -> usize {
        self.files.iter().filter(|file| file.is_right()).count()
    }

    /// The number of files that cannot be compared, and that no cause explains.
    pub fn unreadable(&self) -> usize {
        let files = self.files.iter().enumerate();
        files.filter(|(at, file)| file.compared.is_err() && self.cause_of(*at).is_none()).count()
    }

    /// The place of the cause of a file among all causes, if it has one.
    pub fn cause_of(&self, file: usize) -> Option<usize> {
        self.causes.iter().position(|cause| cause.files.contains(&file))
    }

    /// The result in one sentence, about the files that are there, and behind it the number of scenes without a file:
    /// `62 of 74 fail, 60 of them: it samples pixel corners …; 1 other cause (2); 3 scenes are missing`.
    pub fn verdict(&self) -> String {
        let (all, failing) = (self.files.len(), self.files.len() - self.right());
        let mut parts = match failing {
            0 => vec![format!("all {all} files are right")],
            _ => self.failures(failing),
        };
        match self.missing.len() {
            0 => {}
            1 => parts.push("1 scene is missing".into()),
            missing => parts.push(format!("{missing} scenes are missing")),
        }
        parts.join("; ")
    }

    /// How many files fail, and why: each cause with the number of its files, unless it has them all.
    fn failures(&self, failing: usize) -> Vec<String> {
        let (all, cannot) = (self.files.len(), self.unreadable());
        if cannot == failing {
            return vec![format!("{cannot} of {all} cannot be compared")];
        }
        let fail = if failing == 1 { "fails" } else { "fail" };
        let Some((first, others)) = self.causes.split_first() else {
            return vec![format!("{failing} of {all} {fail}")];
        };
        let share = match first.files.len() {
            some if some == failing => String::new(),
            some => format!(", {some} of them"),
        };
        let mut parts = vec![format!("{failing} of {all} {fail}{share}: {}", first.short())];
        if !others.is_empty() {
            let files: usize = others.iter().map(|cause| cause.files.len()).sum();
            parts.push(format!("{} ({files})", count(others.len() as u64, "other causes")));
        }
        parts.extend((cannot > 0).then(|| format!("{cannot} cannot be compared")));
        parts
    }
}

impl CheckedFile {
    /// Whether the file shows what is true of its scene.
    pub fn is_right(&self) -> bool {
        self.compared.as_ref().is_ok_and(|compared| compared.comparison.equal)
    }
}

impl Compared {
    /// How many pixels differ, and the first: `16 pixels of 64 differ, first (1, 3)`.
    pub fn words(&self) -> String {
        let pixels = count(self.comparison.differing_pixels, "pixels");
        let all = grouped(self.comparison.size.map(u64::from).iter().product());
        let first = self.comparison.first_differing.first();
        let first = first.map_or(String::new(), |[i, j]| format!(", first ({i}, {j})"));
        format!("{pixels} of {all} differ{first}")
    }
}

impl Cause {
    /// The cause in one line.
    pub fn short(&self) -> String {
        let all = alternatives(&self.alternatives);
        match self.certainty {
            Certainty::Guess => format!("a guess: {all}"),
            Certainty::Convention | Certainty::Reason | Certainty::Unknown => all,
        }
    }
}

#[cfg(test)]
mod tests;
