//! The rules of ordinary rasterizers.
//!
//! All of them project vertices to the raster, clip what reaches behind the eye, walk the samples of a bounding box, and
//! keep the nearest fragment in a z-buffer. They differ in arithmetic, fill rule, sample point, clipping and depths; each
//! has a file of its own. Spheres and planes, which have no vertices, are quadrics: each sample in reach solves the
//! equation, in the arithmetic of the rule.

mod clip;
mod corner;
mod depth24;
mod draw;
mod exclusive;
mod float32;
mod float_edges;
mod inclusive;
mod near_clip;
mod projection;
mod snapped;

use crate::rule::{About, ParseRuleError, forms, parts};
use crate::samples::{SamplePoint, Samples};
use bothways_common::{Frame, Options, View};
use std::fmt;
use std::str::FromStr;

/// How an ordinary rasterizer decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// Raster coordinates, edge functions and depths in `f32`; top-left rule.
    Float32,
    /// A sample on an edge belongs to both sides.
    Inclusive,
    /// A sample on an edge belongs to no side.
    Exclusive,
    /// Vertices rounded to 1/2^`bits` pixel, then integer edge functions; top-left rule.
    Snapped {
        /// From 0 to [`Rule::MOST_BITS`].
        bits: u8,
    },
    /// Samples at the upper left corners of pixels.
    Corner,
    /// Nothing is drawn that is nearer than a depth along the axis of view.
    NearClip {
        /// In lengths of the world; positive and finite.
        depth: f32,
    },
    /// A depth buffer of 24 bits.
    Depth24,
}

/// All rules, by their names.
pub const ALL: &[About] = &[
    About {
        form: "float32",
        what: "Raster coordinates, edge functions and depths are computed in 32-bit floats; top-left rule.",
        reproduces: "pinholes, doubled pixels and torn edges where triangles are thin, large or far away",
    },
    About {
        form: "inclusive",
        what: "A sample exactly on an edge belongs to the triangles on both sides.",
        reproduces: "shared edges drawn twice, and silhouettes one pixel too wide on two sides",
    },
    About {
        form: "exclusive",
        what: "A sample exactly on an edge belongs to no triangle.",
        reproduces: "pinholes along shared edges, and silhouettes one pixel too narrow on two sides",
    },
    About {
        form: "snapped:B",
        what: "Vertices are rounded to 1/2^B pixel, as GPUs do (B from 0 to 16, 8 if left out); integer edges, top-left.",
        reproduces: "edges that move by up to half a step of that grid, and thin triangles that vanish",
    },
    About {
        form: "corner",
        what: "Pixels are sampled at their upper left corners.",
        reproduces: "a picture that is half a pixel off: no + 0.5 in the loop over pixels",
    },
    About {
        form: "near-clip:Z",
        what: "What is nearer than Z along the axis of view is cut away.",
        reproduces: "holes into whatever comes close to the eye: a near plane too far away",
    },
    About {
        form: "depth24",
        what: "Depths go through a 32-bit float per vertex into a depth buffer of 24 bits.",
        reproduces: "z-fighting: faces in one plane, or close and far away, show through one another",
    },
];

impl Rule {
    /// The most bits of [`Rule::Snapped`].
    pub const MOST_BITS: u8 = 16;

    /// What the rule is, for readers.
    pub fn about(&self) -> &'static About {
        &ALL[match self {
            Rule::Float32 => 0,
            Rule::Inclusive => 1,
            Rule::Exclusive => 2,
            Rule::Snapped { .. } => 3,
            Rule::Corner => 4,
            Rule::NearClip { .. } => 5,
            Rule::Depth24 => 6,
        }]
    }

    fn samples<'a>(self, view: &View<'a>, options: &Options) -> Samples<'a> {
        let place = if self == Rule::Corner { SamplePoint::Corner } else { SamplePoint::Middle };
        Samples::new(view.camera, options.samples, place)
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
            ("float32", number) => plain(Rule::Float32, number),
            ("inclusive", number) => plain(Rule::Inclusive, number),
            ("exclusive", number) => plain(Rule::Exclusive, number),
            ("corner", number) => plain(Rule::Corner, number),
            ("depth24", number) => plain(Rule::Depth24, number),
            ("snapped", None) => Ok(Rule::Snapped { bits: 8 }),
            ("snapped", Some(bits)) => match bits.parse() {
                Ok(bits @ 0..=Rule::MOST_BITS) => Ok(Rule::Snapped { bits }),
                _ => Err(ParseRuleError::Number {
                    name: "snapped:B",
                    expected: "a whole number of bits from 0 to 16",
                    example: "snapped:8",
                }),
            },
            ("near-clip", number) => match number.map(str::parse) {
                Some(Ok(depth)) if depth > 0.0 && f32::is_finite(depth) => {
                    Ok(Rule::NearClip { depth })
                }
                _ => Err(ParseRuleError::Number {
                    name: "near-clip:Z",
                    expected: "a positive depth along the axis of view",
                    example: "near-clip:0.5",
                }),
            },
            _ => Err(ParseRuleError::Unknown { order: "object order", known: forms(ALL) }),
        }
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Rule::Snapped { bits } => write!(f, "snapped:{bits}"),
            Rule::NearClip { depth } => write!(f, "near-clip:{depth}"),
            Rule::Float32 | Rule::Inclusive | Rule::Exclusive | Rule::Corner | Rule::Depth24 => {
                f.write_str(self.about().form)
            }
        }
    }
}

/// Renders a view by a rule: what is seen at every sample, and its look.
pub fn render(view: &View, options: &Options, rule: Rule) -> Frame {
    let mut frame = Frame::new(view.camera, options);
    determine_visibility(view, options, rule, &mut frame);
    shade(view, rule, &mut frame);
    frame
}

/// Finds what is seen at every sample by a rule, and how far it is, on the current rayon pool. The number of threads
/// changes nothing.
///
/// # Panics
///
/// If ids do not fit into 32 bits: see [`Scene::has_wide_ids`](bothways_common::Scene::has_wide_ids).
pub fn determine_visibility(view: &View, options: &Options, rule: Rule, frame: &mut Frame) {
    frame.fit(view, options);
    frame.clear();
    let samples = rule.samples(view, options);
    match rule {
        Rule::Float32 => draw::draw(&float32::rule(samples), view, frame),
        Rule::Inclusive => draw::draw(&inclusive::rule(samples), view, frame),
        Rule::Exclusive => draw::draw(&exclusive::rule(samples), view, frame),
        Rule::Snapped { bits } => draw::draw(&snapped::rule(samples, bits), view, frame),
        Rule::Corner => draw::draw(&corner::rule(samples), view, frame),
        Rule::NearClip { depth } => draw::draw(&near_clip::rule(samples, depth), view, frame),
        Rule::Depth24 => draw::draw(&depth24::rule(samples, view), view, frame),
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
            "float32",
            "inclusive",
            "exclusive",
            "snapped:0",
            "snapped:16",
            "corner",
            "near-clip:0.5",
            "depth24",
        ] {
            assert_eq!(text.parse::<Rule>().unwrap().to_string(), text);
        }
        assert_eq!("snapped".parse(), Ok(Rule::Snapped { bits: 8 }));
        for bad in ["", "Float32", "float32:1", "snapped:17", "snapped:-1", "snapped:x"] {
            assert!(bad.parse::<Rule>().is_err(), "{bad}");
        }
        for bad in ["near-clip", "near-clip:0", "near-clip:-1", "near-clip:NaN", "near-clip:inf"] {
            assert!(bad.parse::<Rule>().is_err(), "{bad}");
        }
    }

    #[test]
    fn every_rule_has_its_description() {
        for about in ALL {
            let text = about.form.replace(":B", ":8").replace(":Z", ":1");
            assert_eq!(text.parse::<Rule>().unwrap().about(), about);
        }
    }
}
