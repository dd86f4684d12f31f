//! The same report for programs: the output of `bothways pixel --json`.

use super::lesson::{Lesson, certain};
use super::{Answer, Behind, SampleReport};
use crate::common::Sign;
use crate::common::exact::{EdgeSigns, EdgeValues, Side};
use crate::common::glam::Vec3;
use crate::report::WorkReport;
use crate::wording::plain;
use serde::{Serialize, Serializer};

impl Serialize for Lesson<'_> {
    /// Writes the samples one after another: the text of a million samples takes gigabytes.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let json = PixelJson {
            scene: self.scene,
            pixel: self.pixel,
            size: self.camera.image(),
            samples: self.along,
            eye: (self.camera.eye() + Vec3::ZERO).to_array(),
            agree: self.agrees(),
            at: Samples(self.samples),
        };
        json.serialize(serializer)
    }
}

/// The fields, in this order.
#[derive(Debug, Serialize)]
struct PixelJson<'a> {
    scene: &'a str,
    pixel: [u32; 2],
    size: [u32; 2],
    samples: u32,
    eye: [f32; 3],
    agree: bool,
    at: Samples<'a>,
}

#[derive(Debug)]
struct Samples<'a>(&'a [SampleReport]);

impl Serialize for Samples<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().map(SampleJson::new))
    }
}

#[derive(Debug, Serialize)]
struct SampleJson {
    sample: [usize; 2],
    x: f64,
    y: f64,
    origin_from_eye: [f64; 3],
    direction: [f64; 3],
    covering: Vec<CoveringJson>,
    touching: Vec<TouchingJson>,
    object_order: AnswerJson,
    image_order: AnswerJson,
}

#[derive(Debug, Serialize)]
struct CoveringJson {
    id: u64,
    object: usize,
    kind: &'static str,
    t: f64,
    edges: Option<EdgesJson>,
    behind: Option<&'static str>,
}

#[derive(Debug, Serialize)]
struct TouchingJson {
    id: u64,
    object: usize,
    edges: EdgesJson,
}

/// The signs as -1, 0 and 1, the values, and the kinds of the edges on which the sample lies.
#[derive(Debug, Serialize)]
struct EdgesJson {
    facing: i8,
    at_sample: [i8; 3],
    decided: [i8; 3],
    tie: bool,
    facing_value: f64,
    values: [f64; 3],
    on_edge: [Option<&'static str>; 3],
}

#[derive(Debug, Serialize)]
struct AnswerJson {
    id: Option<u64>,
    t: Option<f32>,
    work: WorkReport,
}

impl SampleJson {
    fn new(report: &SampleReport) -> SampleJson {
        let covering = report.covering.iter().map(|one| CoveringJson {
            id: one.id,
            object: one.object,
            kind: one.kind,
            t: certain(one.t),
            edges: one.edges.as_ref().zip(one.values.as_ref()).map(EdgesJson::new),
            behind: one.behind.map(Behind::words),
        });
        let touching = report.touching.iter().map(|one| TouchingJson {
            id: one.id,
            object: one.object,
            edges: EdgesJson::new((&one.edges, &one.values)),
        });
        SampleJson {
            sample: [report.sample.row, report.sample.column],
            x: report.place[0] + 0.0,
            y: report.place[1] + 0.0,
            origin_from_eye: plain(report.ray.origin),
            direction: plain(report.ray.direction),
            covering: covering.collect(),
            touching: touching.collect(),
            object_order: AnswerJson::new(&report.object_order),
            image_order: AnswerJson::new(&report.image_order),
        }
    }
}

impl EdgesJson {
    fn new((edges, values): (&EdgeSigns, &EdgeValues)) -> EdgesJson {
        let number = |sign| match sign {
            Sign::Negative => -1,
            Sign::Zero => 0,
            Sign::Positive => 1,
        };
        EdgesJson {
            facing: number(edges.facing),
            at_sample: edges.at_sample.map(number),
            decided: edges.decided.map(number),
            tie: edges.at_sample.contains(&Sign::Zero),
            facing_value: values.facing,
            values: values.at_sample,
            on_edge: values.sides.map(|side| side.map(Side::name)),
        }
    }
}

impl AnswerJson {
    fn new(answer: &Answer) -> AnswerJson {
        AnswerJson { id: answer.id, t: answer.t, work: WorkReport::from(answer.work) }
    }
}
