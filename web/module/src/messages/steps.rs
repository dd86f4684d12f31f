//! `steps`: every step of one order's loops, recorded once, so that the page goes to any of them at once.

use crate::answer::{Answer, Buffer};
use crate::camera::Viewpoint;
use crate::stage::Stage;
use bothways_lab::common::View;
use bothways_lab::common::frame::NO_PRIMITIVE;
use bothways_lab::film::{Step, Steps, StoredChange, Tested};
use bothways_lab::orders::{Method, Order};
use serde::Deserialize;
use serde_json::json;

#[derive(Debug, Deserialize)]
pub(crate) struct Record {
    order: OrderName,
    kind: Kind,
    #[serde(flatten)]
    from: Viewpoint,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum OrderName {
    Object,
    Image,
}

/// What the loops skip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    /// Nothing.
    Textbook,
    /// Object order: pixels outside of an object's bounding box; image order skips nothing.
    Boxes,
    /// Both: object order by bounding boxes, image order by a hierarchy of boxes.
    Hierarchy,
}

impl Record {
    fn order(&self) -> Order {
        match self.order {
            OrderName::Object => Order::Object,
            OrderName::Image => Order::Image,
        }
    }

    fn method(&self) -> Method {
        match (self.kind, self.order) {
            (Kind::Textbook, _) | (Kind::Boxes, OrderName::Image) => Method::Textbook,
            (Kind::Boxes, OrderName::Object) | (Kind::Hierarchy, _) => Method::Fast,
        }
    }
}

pub(crate) fn answer(stage: &Stage, record: &Record) -> Result<Answer, String> {
    let camera = record.from.camera(&stage.loaded.camera)?;
    let view = View::new(&stage.loaded.scene, &camera);
    let recorded = Steps::record(record.order(), record.method(), &view);
    let Steps { code, steps, changes, marks } = recorded.map_err(|error| error.to_string())?;
    let pairs = pairs(&view);
    let tests = steps.iter().filter(|step| matches!(step.tested, Tested::Primitive(_))).count();
    let answer = Answer::new(json!({
        "count": steps.len(),
        "pseudocode": code,
        "kinds": kinds(&view),
        "pairs": pairs,
        "skipped": pairs.saturating_sub(tests as u64),
        "changes": {},
    }));
    let has_nodes = steps.iter().any(|step| matches!(step.tested, Tested::Node(_)));
    let answer = with_steps(answer, &steps, has_nodes).with("marks", Buffer::U32(marks));
    Ok(with_changes(answer, &changes))
}

/// The number of pairs of a primitive and a pixel.
fn pairs(view: &View) -> u64 {
    let pixels: u64 = view.camera.image().map(u64::from).iter().product();
    pixels * u64::from(view.scene.primitive_count())
}

/// The kind of each primitive in words.
fn kinds(view: &View) -> Vec<&'static str> {
    view.primitives().map(|(_, primitive)| primitive.kind()).collect()
}

fn with_steps(answer: Answer, steps: &[Step], has_nodes: bool) -> Answer {
    let number = |step: &Step| match step.tested {
        Tested::Primitive(id) => [id, NO_PRIMITIVE],
        Tested::Node(node) => [NO_PRIMITIVE, node],
    };
    fn each<T>(steps: &[Step], value: impl Fn(&Step) -> T) -> Vec<T> {
        steps.iter().map(value).collect()
    }
    let answer = answer
        .with("line", Buffer::U8(each(steps, |step| step.line() as u8)))
        .with("object", Buffer::U32(each(steps, |step| number(step)[0])))
        .with("row", Buffer::U16(each(steps, |step| step.row)))
        .with("column", Buffer::U16(each(steps, |step| step.column)))
        .with("result", Buffer::U8(each(steps, |step| step.outcome as u8)))
        .with("t", Buffer::F32(each(steps, |step| step.t.unwrap_or(f32::NAN))));
    if !has_nodes {
        return answer;
    }
    answer.with("node", Buffer::U32(each(steps, |step| number(step)[1])))
}

fn with_changes(answer: Answer, changes: &[StoredChange]) -> Answer {
    fn each<T>(changes: &[StoredChange], value: impl Fn(&StoredChange) -> T) -> Vec<T> {
        changes.iter().map(value).collect()
    }
    let colors = changes.iter().flat_map(|change| change.color).collect();
    answer
        .with("changes.step", Buffer::U32(each(changes, |change| change.steps)))
        .with("changes.row", Buffer::U16(each(changes, |change| change.row)))
        .with("changes.column", Buffer::U16(each(changes, |change| change.column)))
        .with("changes.id", Buffer::U32(each(changes, |change| change.id.unwrap_or(NO_PRIMITIVE))))
        .with("changes.rgb", Buffer::U8(colors))
}
