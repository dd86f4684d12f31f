//! `report.json`: all results, for programs.

use crate::common::Work;
use crate::diff::{Color, Comparison, Coverage, Depth, Visible};
use crate::orders::{Method, Order, Rendered, Rule, Spread};
use crate::verify::Verified;
use serde::Serialize;

/// The report; its fields are written in this order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The scene's name.
    pub scene: String,
    /// Width and height of the camera's image in pixels.
    pub size: [u32; 2],
    /// Row, column, height and width of the rendered part of the image, if the run rendered a part. Pixels have the
    /// same numbers as in the whole image.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crop: Option<[u32; 4]>,
    /// Samples along one side of a pixel.
    pub samples: u32,
    /// The number of rendering threads.
    pub threads: usize,
    /// The number of primitives in the scene.
    pub primitives: u32,
    /// The comparison of covered samples; like the other parts of the comparison, `None` unless both orders were
    /// rendered.
    pub coverage: Option<Coverage>,
    /// The comparison of visible primitives.
    pub visible: Option<Visible>,
    /// The comparison of depths.
    pub depth: Option<Depth>,
    /// The comparison of colours.
    #[serde(rename = "colour")]
    pub color: Option<Color>,
    /// The textbook's check of some samples, if the run includes it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verified: Option<Verified>,
    /// The work and times of object order, if it was rendered.
    pub object_order: Option<OrderReport>,
    /// The work and times of image order, if it was rendered.
    pub image_order: Option<OrderReport>,
}

/// The work and times of one order.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OrderReport {
    /// The method.
    pub method: Method,
    /// The rule of an ordinary renderer that decided, as on the command line; absent if it is exact.
    #[serde(rename = "rules", skip_serializing_if = "Option::is_none")]
    pub rule: Option<Rule>,
    /// The time of the work on the scene alone; times are `None` if the options leave them out.
    pub prepare_ms: Option<Spread>,
    /// The time for finding the visible primitives, per frame.
    pub visibility_ms: Option<Spread>,
    /// The time for normals and colours, per frame.
    pub shading_ms: Option<Spread>,
    /// The work for one frame; `None` if the options or the rules leave it out, or there is too much work to count.
    pub work: Option<WorkReport>,
}

/// The counts of [`Work`], under the same names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[expect(missing_docs, reason = "documented where they are counted, in Work")]
pub struct WorkReport {
    pub primitives: u64,
    pub rays: u64,
    pub nodes: u64,
    pub tests: u64,
    pub fragments: u64,
    pub depth_tests: u64,
    pub judged_coverage: u64,
    pub judged_nearest: u64,
}

impl Report {
    /// A report on the rendered orders, one or both, and on their comparison.
    ///
    /// # Panics
    ///
    /// If there is no rendered order.
    pub fn new(
        scene: &str,
        primitives: u32,
        threads: usize,
        rendered: &[Rendered],
        comparison: Option<&Comparison>,
    ) -> Report {
        let frame = &rendered.first().expect("an order was rendered").frame;
        let section = |order| rendered.iter().find(|one| one.order == order).map(OrderReport::new);
        Report {
            scene: scene.into(),
            size: frame.camera_image(),
            crop: frame.crop().map(|crop| crop.to_array()),
            samples: frame.samples(),
            threads,
            primitives,
            coverage: comparison.map(|comparison| comparison.coverage),
            visible: comparison.map(|comparison| comparison.visible.clone()),
            depth: comparison.map(|comparison| comparison.depth),
            color: comparison.map(|comparison| comparison.color),
            verified: None,
            object_order: section(Order::Object),
            image_order: section(Order::Image),
        }
    }

    /// The report as JSON, with a newline at its end.
    ///
    /// # Errors
    ///
    /// No error for a report from [`Report::new`]; the type comes from `serde_json`.
    pub fn to_json(&self) -> serde_json::Result<String> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}

impl OrderReport {
    fn new(rendered: &Rendered) -> OrderReport {
        let times = rendered.times;
        OrderReport {
            method: rendered.method,
            rule: rendered.rule,
            prepare_ms: times.map(|times| times.prepare),
            visibility_ms: times.map(|times| times.visibility),
            shading_ms: times.map(|times| times.shading),
            work: rendered.work().copied().map(WorkReport::from),
        }
    }
}

impl From<Work> for WorkReport {
    fn from(work: Work) -> Self {
        WorkReport {
            primitives: work.primitives,
            rays: work.rays,
            nodes: work.nodes,
            tests: work.tests,
            fragments: work.fragments,
            depth_tests: work.depth_tests,
            judged_coverage: work.judged_coverage,
            judged_nearest: work.judged_nearest,
        }
    }
}
