//! The result of a run, in numbers and in words.

use super::case::Case;
use super::check::{Checked, Disagreement};
use crate::wording::{count, grouped, pixels_shown};
use serde::Serialize;

/// What a run checked and found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The seed.
    pub seed: u64,
    /// The number of the first scene.
    pub first_scene: u64,
    /// How many scenes were drawn.
    pub scenes: u64,
    /// Pixels in which the two fast renderers were compared.
    pub pixels: u64,
    /// Those of them that both textbooks drew, too.
    pub textbook_pixels: u64,
    /// Exact ties in these, of edges and of distances: each test of a primitive at a sample counts.
    pub exact_ties: u64,
    /// Decisions in these that the two fast renderers left to exact arithmetic.
    pub exact_fallbacks: u64,
    /// Scenes in which two renderers disagree or one panics.
    pub disagreements: u64,
    /// Whether the run was stopped before its limit.
    pub ended_early: bool,
    /// The numbers of scenes that had begun and did not end in time; they are not counted.
    pub unfinished: Vec<u64>,
    /// The first of the disagreements, shrunk, by the numbers of their scenes. Whoever writes them also knows their files.
    #[serde(skip)]
    pub findings: Vec<Finding>,
}

/// One disagreement, shrunk.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The seed of the run.
    pub seed: u64,
    /// The number of the scene.
    pub scene: u64,
    /// How large the scene was.
    pub original: Size,
    /// How large it still is.
    pub shrunk: Size,
    /// The smaller scenes that were tried.
    pub steps: u64,
    /// The disagreement in the shrunk scene.
    pub disagreement: Disagreement,
    /// The shrunk scene.
    #[serde(skip)]
    pub case: Case,
}

/// How large a scene and its picture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Size {
    /// Its primitives.
    pub primitives: u64,
    /// The width and height of the drawn pixels.
    pub pixels: [u32; 2],
    /// Samples along one side of a pixel.
    pub samples: u32,
}

impl Size {
    /// The size of a case.
    pub fn of(case: &Case) -> Size {
        let pixels = case.pixels();
        Size {
            primitives: case.primitives(),
            pixels: [pixels.width, pixels.height],
            samples: case.samples,
        }
    }

    fn words(&self) -> String {
        let primitives = count(self.primitives, "primitives");
        format!("{primitives} and {}", pixels_shown(self.pixels, None, "x"))
    }
}

impl Summary {
    pub(super) fn new(seed: u64, first_scene: u64) -> Summary {
        Summary {
            seed,
            first_scene,
            scenes: 0,
            pixels: 0,
            textbook_pixels: 0,
            exact_ties: 0,
            exact_fallbacks: 0,
            disagreements: 0,
            ended_early: false,
            unfinished: Vec::new(),
            findings: Vec::new(),
        }
    }

    /// Counts one more scene.
    pub(super) fn count(&mut self, checked: &Checked) {
        self.scenes += 1;
        self.pixels += checked.pixels;
        self.textbook_pixels += checked.textbook_pixels;
        self.exact_ties += checked.exact_ties;
        self.exact_fallbacks += checked.exact_fallbacks;
        self.disagreements += u64::from(checked.disagreement.is_some());
    }

    /// Adds a finding in its place.
    pub(super) fn add(&mut self, finding: Finding) {
        self.findings.push(finding);
        self.findings.sort_by_key(|finding| finding.scene);
    }

    /// The result in one line.
    pub fn verdict(&self) -> String {
        let counts = [
            (self.scenes, "scenes"),
            (self.pixels, "pixels"),
            (self.exact_ties, "exact ties"),
            (self.exact_fallbacks, "exact fallbacks"),
            (self.disagreements, "disagreements"),
        ];
        counts.map(|(number, things)| count(number, things)).join(", ")
    }

    /// What the numbers of the verdict mean, in one line.
    pub fn about(&self) -> String {
        format!(
            "both textbooks drew {} of these pixels, where ties and fallbacks were counted; seed {}",
            grouped(self.textbook_pixels),
            self.seed
        )
    }
}

impl Finding {
    /// What was found and how it was shrunk, in two lines.
    pub fn about(&self) -> String {
        format!(
            "scene {} of seed {}: {}\n  shrunk from {} to {}, in {}",
            self.scene,
            self.seed,
            self.disagreement,
            self.original.words(),
            self.shrunk.words(),
            count(self.steps, "steps")
        )
    }
}
