//! `report.json`: all results, for programs.

use crate::common::{Executed, Work};
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
    pub primitives: u64,
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
    /// The work of the algorithm for one frame, for every primitive or ray alone; `None` if the options or the rules
    /// leave it out, or there is too much work to count.
    pub work: Option<WorkReport>,
    /// What a timed frame executed, tile by tile; `None` if the method is not fast or has the rules of an ordinary
    /// renderer, or no frame was drawn unobserved.
    pub executed: Option<ExecutedReport>,
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

/// The counts of [`Executed`], under the same names. Counters that an order does not have are absent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[expect(missing_docs, reason = "documented where they are counted, in Executed")]
pub struct ExecutedReport {
    pub tiles: u64,
    pub tiles_skipped: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nodes_opened: Option<u64>,
    pub boxes_tested: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leaves_opened: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub binned: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clusters: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clusters_skipped: Option<u64>,
    pub triangles: u64,
    pub set_ups: u64,
    pub one_by_one: u64,
    pub lane_steps: u64,
    pub blocks: u64,
    pub single_samples: u64,
}

impl Report {
    /// A report on the rendered orders, one or both, and on their comparison.
    ///
    /// # Panics
    ///
    /// If there is no rendered order.
    pub fn new(
        scene: &str,
        primitives: u64,
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
            executed: rendered
                .executed
                .map(|executed| ExecutedReport::new(rendered.order, executed)),
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

impl ExecutedReport {
    fn new(order: Order, executed: Executed) -> ExecutedReport {
        let of = |owner: Order, count: u64| (order == owner).then_some(count);
        ExecutedReport {
            tiles: executed.tiles,
            tiles_skipped: executed.tiles_skipped,
            nodes_opened: of(Order::Image, executed.nodes_opened),
            boxes_tested: executed.boxes_tested,
            leaves_opened: of(Order::Image, executed.leaves_opened),
            binned: of(Order::Object, executed.binned),
            clusters: of(Order::Object, executed.clusters),
            clusters_skipped: of(Order::Object, executed.clusters_skipped),
            triangles: executed.triangles,
            set_ups: executed.set_ups,
            one_by_one: executed.one_by_one,
            lane_steps: executed.lane_steps,
            blocks: executed.blocks,
            single_samples: executed.single_samples,
        }
    }
}
