//! The rules of ordinary ray tracers.
//!
//! All of them send a ray through each sample, search a hierarchy of boxes, and keep the nearest hit; of equal ones the
//! first in the scene. They differ in the intersection test, or in where rays begin and go; each has a file of its own.

mod corner;
mod double;
mod flip_rows;
mod float32;
mod hierarchy;
mod jittered;
mod moller_trumbore;
mod one_origin;
mod shape;
mod single;
mod trace;
mod watertight;

use crate::rule::{About, ParseRuleError, forms, parts};
use crate::samples::{SamplePoint, Samples};
use bothways_common::{Frame, Options, Scene, View};
use double::Double;
use hierarchy::Hierarchy;
use single::Single;
use std::fmt;
use std::str::FromStr;
use trace::trace;

/// How an ordinary ray tracer decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// The test of Möller and Trumbore, in `f32`.
    MollerTrumbore,
    /// The test of Woop, Benthin and Wald, in `f32`.
    Watertight,
    /// First the plane, then the edges, in `f32`.
    Float32,
    /// Rays through the upper left corners of pixels.
    Corner,
    /// Parallel rays that all start at the eye.
    OneOrigin,
    /// Row 0 is the lowest.
    FlipRows,
    /// Each sample moved randomly within its pixel.
    Jittered {
        /// Chooses the places.
        seed: u64,
    },
}

/// All rules, by their names.
pub const ALL: &[About] = &[
    About {
        form: "moller-trumbore",
        what: "The test of Moller and Trumbore in 32-bit floats: inclusive edges, epsilon 1e-7.",
        reproduces: "small triangles that vanish below a fixed epsilon, leaks and double hits at edges",
    },
    About {
        form: "watertight",
        what: "The test of Woop, Benthin and Wald in 32-bit floats, doubles where an edge is met exactly.",
        reproduces: "no holes, but edges that belong to both sides, and rays rounded before the test",
    },
    About {
        form: "float32",
        what: "The plane of the triangle, then the hit point against its three edges, in 32-bit floats.",
        reproduces: "ragged silhouettes, and cracks between triangles that are seen at a slant",
    },
    About {
        form: "corner",
        what: "Rays go through the upper left corners of pixels.",
        reproduces: "a picture that is half a pixel off: no + 0.5 in the formula of the ray",
    },
    About {
        form: "one-origin",
        what: "All rays of a parallel camera start at the eye instead of side by side.",
        reproduces: "a parallel picture of one colour: only the direction was changed from perspective",
    },
    About {
        form: "flip-rows",
        what: "Row 0 of the picture is the lowest.",
        reproduces: "a picture upside down: y counted upwards, as in OpenGL, in a file that counts downwards",
    },
    About {
        form: "jittered:SEED",
        what: "Each sample is moved randomly within its pixel (a number from 0 chooses how).",
        reproduces: "ragged edges: random sampling compared with samples in the middle",
    },
];

impl Rule {
    /// What the rule is, for readers.
    pub fn about(&self) -> &'static About {
        &ALL[match self {
            Rule::MollerTrumbore => 0,
            Rule::Watertight => 1,
            Rule::Float32 => 2,
            Rule::Corner => 3,
            Rule::OneOrigin => 4,
            Rule::FlipRows => 5,
            Rule::Jittered { .. } => 6,
        }]
    }

    fn samples<'a>(self, view: &View<'a>, options: &Options) -> Samples<'a> {
        let samples = |place| Samples::new(view.camera, options.samples, place);
        match self {
            Rule::MollerTrumbore | Rule::Watertight | Rule::Float32 => samples(SamplePoint::Middle),
            Rule::Corner => corner::samples(samples),
            Rule::OneOrigin => one_origin::samples(samples),
            Rule::FlipRows => flip_rows::samples(samples),
            Rule::Jittered { seed } => jittered::samples(samples, seed),
        }
    }
}

impl FromStr for Rule {
    type Err = ParseRuleError;

    fn from_str(text: &str) -> Result<Rule, ParseRuleError> {
        let plain = |rule: Rule, number: Option<&str>| match number {
            None => Ok(rule),
            Some(_) => Err(ParseRuleError::NoNumber { name: rule.about().form }),
        };
        match parts(text) {
            ("moller-trumbore", number) => plain(Rule::MollerTrumbore, number),
            ("watertight", number) => plain(Rule::Watertight, number),
            ("float32", number) => plain(Rule::Float32, number),
            ("corner", number) => plain(Rule::Corner, number),
            ("one-origin", number) => plain(Rule::OneOrigin, number),
            ("flip-rows", number) => plain(Rule::FlipRows, number),
            ("jittered", seed) => match seed.map(str::parse) {
                Some(Ok(seed)) => Ok(Rule::Jittered { seed }),
                _ => Err(ParseRuleError::Number {
                    name: "jittered:SEED",
                    expected: "a whole number from 0 to 18446744073709551615",
                    example: "jittered:7",
                }),
            },
            _ => Err(ParseRuleError::Unknown { order: "image order", known: forms(ALL) }),
        }
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rule::Jittered { seed } => write!(f, "jittered:{seed}"),
            Rule::MollerTrumbore
            | Rule::Watertight
            | Rule::Float32
            | Rule::Corner
            | Rule::OneOrigin
            | Rule::FlipRows => f.write_str(self.about().form),
        }
    }
}

/// A scene prepared for rays: what a moving camera would not repeat. It serves all rules.
#[derive(Debug)]
pub struct Prepared(Hierarchy);

/// Builds the hierarchy of a scene.
///
/// # Panics
///
/// If ids do not fit into 32 bits: see [`Scene::has_wide_ids`].
pub fn prepare(scene: &Scene) -> Prepared {
    Prepared(Hierarchy::new(scene))
}

/// Renders a view by a rule: what is seen at every sample, and its look.
pub fn render(view: &View, options: &Options, rule: Rule) -> Frame {
    let mut frame = Frame::new(view.camera, options);
    determine_visibility(&prepare(view.scene), view, options, rule, &mut frame);
    shade(view, rule, &mut frame);
    frame
}

/// Finds what is seen at every sample by a rule, and how far it is, on the current rayon pool. The number of threads
/// changes nothing.
pub fn determine_visibility(
    prepared: &Prepared,
    view: &View,
    options: &Options,
    rule: Rule,
    frame: &mut Frame,
) {
    frame.fit(view, options);
    frame.clear();
    let samples = rule.samples(view, options);
    let hierarchy = &prepared.0;
    match rule {
        Rule::MollerTrumbore => {
            trace(&Single::new(&samples, moller_trumbore::hit), hierarchy, &samples, frame);
        }
        Rule::Watertight => {
            trace(&Single::new(&samples, watertight::hit), hierarchy, &samples, frame);
        }
        Rule::Float32 => trace(&Single::new(&samples, float32::hit), hierarchy, &samples, frame),
        Rule::Corner | Rule::OneOrigin | Rule::FlipRows | Rule::Jittered { .. } => {
            trace(&Double::new(view, samples), hierarchy, &samples, frame);
        }
    }
}

/// Gives every sample its colour, in `f64`, at the point that the rule's own ray sees.
///
/// # Panics
///
/// If the frame does not show this view.
pub fn shade(view: &View, rule: Rule, frame: &mut Frame) {
    let options = Options { samples: frame.samples(), crop: frame.crop() };
    crate::shade::shade(view, &rule.samples(view, &options), frame);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_read_as_they_are_written() {
        for text in [
            "moller-trumbore",
            "watertight",
            "float32",
            "corner",
            "one-origin",
            "flip-rows",
            "jittered:0",
            "jittered:18446744073709551615",
        ] {
            assert_eq!(text.parse::<Rule>().unwrap().to_string(), text);
        }
        for bad in ["", "snapped:8", "corner:1", "jittered", "jittered:", "jittered:-1"] {
            assert!(bad.parse::<Rule>().is_err(), "{bad}");
        }
    }

    #[test]
    fn every_rule_has_its_description() {
        for about in ALL {
            let text = about.form.replace("SEED", "7");
            assert_eq!(text.parse::<Rule>().unwrap().about(), about);
        }
    }
}
