//! Marks for a picture of a scene: how much of it is right, and what the likely mistake is.
//!
//! A file that is right gets 100. Otherwise
//!
//! ```text
//! score = 100 (right + explained / 2^mistakes) / seen
//! ```
//!
//! where `seen` counts the pixels that the scene or the file covers, `right` those of them in which the file shows what
//! the scene does, and `explained` the wrong pixels that have an explanation, if at least half of them have one: by
//! `mistakes` conventions, or by reasons of single pixels (exact ties, rounding, culled or clipped faces, a mesh for a sphere),
//! which together count as one mistake. So one mistake that explains everything
//! gives half of the credit back, two give a quarter; a guess gives nothing. Nor does what is left out (a primitive, an object,
//! what lies beyond a plane), where less than half is right: whatever little a file shows, all else may be left out.
//!
//! ```
//! use bothways_lab::common::{Camera, CameraDescription, View};
//! use bothways_lab::diff::foreign::{Buffer, Content};
//! use bothways_lab::{grade, scenes};
//!
//! let loaded = scenes::load("canonical")?;
//! let camera = Camera::new(CameraDescription { image: [24, 16], ..loaded.camera })?;
//! let view = View::new(&loaded.scene, &camera);
//! let nothing = Buffer::new([24, 16], 1, Content::Mask(vec![false; 24 * 16].into()));
//! let grade = grade::grade(&view, &nothing)?;
//! assert_eq!((grade.right, grade.score()), (0, 0.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::check::truth;
use crate::common::View;
use crate::diff::foreign::{Buffer, BufferComparison, Side, compare_with_reference};
use crate::diff::why::{
    Explanation, Finding, Findings, OtherSize, ReasonKind, alternatives, check_size,
    find_conventions, find_reasons,
};
use crate::wording::count;
use serde::Serialize;

/// The formula of the score, in one line.
pub const FORMULA: &str = "score = 100 (right + explained / 2^mistakes) / seen";

/// What a file is worth.
#[derive(Clone, Debug, PartialEq)]
pub struct Grade {
    /// The pixels that the scene or the file covers.
    pub seen: u64,
    /// Those in which the file shows what the scene does.
    pub right: u64,
    /// The wrong pixels that have an explanation.
    pub explained: u64,
    /// The number of mistakes that explain them; 0 if nothing is explained.
    pub mistakes: u32,
    /// How the file is, in a word.
    pub verdict: Verdict,
    /// The likely mistake, in words; empty if there is none.
    pub likely_mistake: String,
}

/// How a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Every pixel is right.
    Right,
    /// Something is wrong, and every wrong pixel is explained.
    Explained,
    /// At least half of the wrong pixels are explained.
    PartlyExplained,
    /// Less than half of the wrong pixels are explained.
    Unexplained,
}

impl Verdict {
    /// The verdict in a word or two.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Right => "right",
            Verdict::Explained => "explained",
            Verdict::PartlyExplained => "partly explained",
            Verdict::Unexplained => "unexplained",
        }
    }
}

impl Grade {
    /// The score from 0 to 100, in steps of a tenth, rounded down: only a file without a mistake has 100.
    #[expect(clippy::cast_precision_loss, reason = "pixels are fewer than 2^53")]
    pub fn score(&self) -> f64 {
        if self.verdict == Verdict::Right {
            return 100.0;
        }
        let credit = self.explained as f64 / f64::from(self.mistakes).exp2();
        let score = (self.right as f64 + credit) / self.seen as f64;
        (1000.0 * score).floor() / 10.0
    }
}

/// Why there is no grade.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GradeError {
    /// The file has another size than the camera's image.
    #[error(transparent)]
    Size(#[from] OtherSize),
    /// The file cannot be held to the scene.
    #[error("{0}")]
    Content(String),
}

/// Grades a mask, ids or distances of one sample a pixel.
///
/// # Errors
///
/// If the file has another size than the camera's image, several samples a pixel, or colours alone.
pub fn grade(view: &View, file: &Buffer) -> Result<Grade, GradeError> {
    check_size(view, file).map_err(with_advice)?;
    if file.samples() != 1 {
        let samples = file.samples();
        return Err(GradeError::Content(format!(
            "the file has {samples} x {samples} samples a pixel; files of one sample a pixel are graded"
        )));
    }
    let truth = truth(view, file).map_err(GradeError::Content)?;
    let comparison = compare_with_reference(file, &truth, Some(Side::B))
        .map_err(|error| GradeError::Content(error.to_string()))?;
    let wrong = comparison.differing_pixels;
    let coverage = comparison.coverage.expect("the file tells coverage");
    let seen = coverage.both + coverage.only_a + coverage.only_b;
    let mut grade = Grade {
        seen,
        right: seen - wrong,
        explained: 0,
        mistakes: 0,
        verdict: Verdict::Right,
        likely_mistake: String::new(),
    };
    if wrong > 0 {
        explain(&mut grade, view, file, &truth, &comparison);
        grade.verdict = match grade.explained {
            explained if explained == wrong => Verdict::Explained,
            explained if explained * 2 >= wrong => Verdict::PartlyExplained,
            _ => Verdict::Unexplained,
        };
    }
    Ok(grade)
}

/// Another size, with what to do if nothing explains it.
fn with_advice(error: OtherSize) -> OtherSize {
    if !error.cause.is_empty() {
        return error;
    }
    OtherSize { cause: "; give --size as the file has it".into(), ..error }
}

/// Explains the wrong pixels of a file.
fn explain(
    grade: &mut Grade,
    view: &View,
    file: &Buffer,
    truth: &Buffer,
    comparison: &BufferComparison,
) {
    let found = match find_conventions(view, file) {
        Ok(findings) => findings,
        Err(error) => {
            grade.likely_mistake = format!("unexplained: {error}");
            return;
        }
    };
    let differing: Vec<[u32; 2]> =
        comparison.classes().differing().map(|(pixel, _)| pixel).collect();
    let mut reasons = find_reasons(view, file, truth, &differing)
        .expect("what conventions are searched in has reasons");
    let conventions = explanations(&found);
    if let Some(best) = conventions.first() {
        reasons.explained_by(Side::A, best);
    }
    let counts = reasons.counts();
    let explained = reasons.count_of(explains);
    let by_conventions = conventions.first().map_or(0, |best| best.explained);
    let explained = explained.max(by_conventions).min(comparison.differing_pixels);
    let is_evidence = !matches!(found.finding, Finding::NoEvidence(_));
    // Whatever little a file shows, all else may be left out.
    let most_is_missing = conventions.first().is_some_and(|best| best.convention.leaves_out())
        && 2 * grade.right < grade.seen;
    if is_evidence && !most_is_missing && 2 * explained >= comparison.differing_pixels {
        grade.explained = explained;
    }
    let sentences: Vec<Vec<String>> =
        conventions.iter().map(|one| one.sentences("it", view.camera)).collect();
    let parts = sentences.first().map_or(1, Vec::len);
    let parts = if grade.explained > 0 { parts } else { 0 };
    grade.mistakes = u32::try_from(parts).expect("there are few axes");
    grade.likely_mistake = match (&sentences[..], &found.finding) {
        ([_, ..], _) if most_is_missing => {
            format!("no credit, as most is missing: {}", alternatives(&sentences))
        }
        ([_, ..], _) => alternatives(&sentences),
        (_, Finding::NoEvidence(reason)) => format!("no evidence: {reason}"),
        (_, Finding::Explained(guesses)) if grade.explained == 0 => {
            let guesses: Vec<_> =
                guesses.iter().map(|one| one.sentences("it", view.camera)).collect();
            format!("a guess: {}", alternatives(&guesses))
        }
        (_, Finding::Unexplained(Some(place))) => format!("{}; {place}", in_words(&counts)),
        _ => in_words(&counts),
    };
}

/// The conventions that explain at least half of what is wrong; several if they explain equally much.
fn explanations(found: &Findings) -> &[Explanation] {
    match &found.finding {
        Finding::Explained(found_here) if !found_here[0].is_a_guess(found.differing) => found_here,
        _ => &[],
    }
}

/// Whether a kind of reason explains a pixel so that it gives credit back: a sample elsewhere in the pixel may be
/// anything.
fn explains(kind: ReasonKind) -> bool {
    match kind {
        ReasonKind::Tie
        | ReasonKind::DistanceTie
        | ReasonKind::Rounding
        | ReasonKind::DistanceRounding
        | ReasonKind::Culled
        | ReasonKind::Clipped
        | ReasonKind::Tessellation
        | ReasonKind::Convention => true,
        ReasonKind::Elsewhere
        | ReasonKind::WithinTolerance
        | ReasonKind::CannotTell
        | ReasonKind::Unexplained => false,
    }
}

/// `12 pixels: exact tie on an edge or corner; 3 pixels: unexplained`.
fn in_words(counts: &[(ReasonKind, u64)]) -> String {
    let mut counts = counts.to_vec();
    counts.sort_by_key(|&(_, pixels)| std::cmp::Reverse(pixels));
    let one = |(kind, pixels): &(ReasonKind, u64)| {
        format!("{}: {}", count(*pixels, "pixels"), kind.name())
    };
    counts.iter().map(one).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests;
