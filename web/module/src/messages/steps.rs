//! `steps`: every step of one order's loops, recorded once, so that the page goes to any of them at once.

use crate::answer::{Answer, Buffer};
use crate::camera::Viewpoint;
use crate::progress;
use crate::stage::Stage;
use bothways_lab::common::View;
use bothways_lab::common::frame::NO_PRIMITIVE;
use bothways_lab::film::{self, Run, Steps, StoredChange, Tested, Told};
use bothways_lab::orders::{Method, Order};
use bothways_lab::raytrace::fast::Prepared;
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
    let recorded = Steps::record(record.order(), record.method(), &view, &progress::tell);
    let steps = recorded.map_err(|error| error.to_string())?;
    let pairs = pairs(&view);
    let boxes = steps.runs.iter().filter(|run| matches!(run.tested, Tested::Node(_))).count();
    let answer = Answer::new(json!({
        "count": steps.count,
        "pseudocode": steps.code,
        "kinds": kinds(&view),
        "pairs": pairs,
        "skipped": pairs.saturating_sub(u64::from(steps.count) - boxes as u64),
        "runs": {},
        "told": {},
        "changes": {},
        "outlines": { "primitives": {}, "boxes": {} },
    }));
    let answer = with_runs(answer, &steps.runs).with("marks", Buffer::U32(steps.marks));
    let answer = with_told(answer, &steps.told);
    let answer = with_outlines(answer, &view, (boxes > 0).then_some(&stage.ray_tracer));
    Ok(with_changes(answer, &steps.changes))
}

/// The number of pairs of a primitive and a pixel.
fn pairs(view: &View) -> u64 {
    let pixels: u64 = view.camera.image().map(u64::from).iter().product();
    pixels * view.scene.primitive_count()
}

/// The kind of each primitive in words.
fn kinds(view: &View) -> Vec<&'static str> {
    view.primitives().map(|(_, primitive)| primitive.kind()).collect()
}

fn each<One, T>(all: &[One], value: impl Fn(&One) -> T) -> Vec<T> {
    all.iter().map(value).collect()
}

fn with_runs(answer: Answer, runs: &[Run]) -> Answer {
    let object = |run: &Run| match run.tested {
        Tested::Primitive(id) => id,
        Tested::Node(_) => NO_PRIMITIVE,
    };
    let node = |run: &Run| match run.tested {
        Tested::Primitive(_) => NO_PRIMITIVE,
        Tested::Node(node) => node,
    };
    answer
        .with("runs.first", Buffer::U32(each(runs, |run| run.first)))
        .with("runs.object", Buffer::U32(each(runs, object)))
        .with("runs.node", Buffer::U32(each(runs, node)))
        .with("runs.pixel", Buffer::U32(each(runs, |run| run.pixel)))
}

fn with_told(answer: Answer, told: &[Told]) -> Answer {
    answer
        .with("told.step", Buffer::U32(each(told, |told| told.step)))
        .with("told.result", Buffer::U8(each(told, |told| told.outcome as u8)))
        .with("told.t", Buffer::F32(each(told, |told| told.t.unwrap_or(f32::NAN))))
}

/// The lines that bound each primitive and each box.
fn with_outlines(answer: Answer, view: &View, ray_tracer: Option<&Prepared>) -> Answer {
    let primitives = (0..view.scene.name_count()).map(|id| film::outline(view, id));
    let answer = with_lines(answer, "outlines.primitives", primitives);
    let boxes = ray_tracer.map(Prepared::boxes).unwrap_or_default();
    let lines = boxes.iter().map(|one| film::outline_of_box(view, [one.low, one.high]));
    let answer = with_lines(answer, "outlines.boxes", lines);
    let numbers = boxes.iter().map(|one| one.number).collect();
    answer.with("outlines.boxes.number", Buffer::U32(numbers))
}

/// The most points of all lines: a scene that has more is too full to follow single outlines, and the rest has none.
const MOST_POINTS: usize = 1_000_000;

/// Lines of many things: all points, as columns and rows; the end of each line, counted in points; and of each thing,
/// counted in lines.
fn with_lines(answer: Answer, path: &str, things: impl Iterator<Item = film::Lines>) -> Answer {
    let (mut points, mut lines, mut ends) = (Vec::new(), Vec::new(), Vec::new());
    let number = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
    for thing in things {
        for line in thing {
            if points.len() / 2 + line.len() > MOST_POINTS {
                break;
            }
            #[expect(clippy::cast_possible_truncation, reason = "for a drawing")]
            points.extend(line.iter().flatten().map(|&at| at as f32));
            lines.push(number(points.len() / 2));
        }
        ends.push(number(lines.len()));
    }
    answer
        .with(format!("{path}.points"), Buffer::F32(points))
        .with(format!("{path}.lines"), Buffer::U32(lines))
        .with(format!("{path}.ends"), Buffer::U32(ends))
}

fn with_changes(answer: Answer, changes: &[StoredChange]) -> Answer {
    let colors = changes.iter().flat_map(|change| change.color).collect();
    answer
        .with("changes.step", Buffer::U32(each(changes, |change| change.steps)))
        .with("changes.row", Buffer::U32(each(changes, |change| change.row)))
        .with("changes.column", Buffer::U32(each(changes, |change| change.column)))
        .with("changes.id", Buffer::U32(each(changes, |change| change.id.unwrap_or(NO_PRIMITIVE))))
        .with("changes.rgb", Buffer::U8(colors))
}

#[cfg(test)]
mod tests {
    use crate::answer::{Answer, Buffer};
    use crate::engine::Engine;
    use std::ops::Range;

    fn recorded(scene: &str, order: &str, kind: &str) -> Answer {
        let mut engine = Engine::default();
        engine.call("open", &format!(r#"{{"name": "{scene}"}}"#), None).unwrap();
        let question =
            format!(r#"{{"order": "{order}", "kind": "{kind}", "height": 12, "width": 12}}"#);
        engine.call("steps", &question, None).unwrap()
    }

    fn numbers(answer: &Answer, path: &str) -> Vec<u32> {
        match answer.buffer(path) {
            Some(Buffer::U32(numbers)) => numbers.clone(),
            Some(Buffer::U8(numbers)) => numbers.iter().map(|&number| number.into()).collect(),
            other => panic!("{path}: {other:?}"),
        }
    }

    /// Every step as the page reads it: the object, the box, the row, the column, and what came of it.
    fn steps(answer: &Answer, order: &str) -> Vec<[u32; 5]> {
        let [firsts, objects, nodes, pixels] = ["first", "object", "node", "pixel"]
            .map(|part| numbers(answer, &format!("runs.{part}")));
        let count = u32::try_from(answer.json()["count"].as_u64().unwrap()).unwrap();
        let mut steps = Vec::new();
        for (run, &first) in firsts.iter().enumerate() {
            for along in 0..firsts.get(run + 1).unwrap_or(&count) - first {
                let [on_object, on_pixel] = if order == "object" { [0, along] } else { [along, 0] };
                let pixel = pixels[run] + on_pixel;
                steps.push([objects[run] + on_object, nodes[run], pixel / 12, pixel % 12, 0]);
            }
        }
        let [told, results] = ["told.step", "told.result"].map(|path| numbers(answer, path));
        told.iter().zip(results).for_each(|(&step, result)| steps[step as usize][4] = result);
        steps
    }

    /// The points of all lines of one thing.
    fn points(answer: &Answer, path: &str, place: usize) -> Vec<[f32; 2]> {
        let Some(Buffer::F32(points)) = answer.buffer(&format!("{path}.points")) else {
            panic!("{path}");
        };
        let part = |ends: &[u32], at: usize| -> Range<usize> {
            let begin = if at == 0 { 0 } else { ends[at - 1] };
            begin as usize..ends[at] as usize
        };
        let lines = numbers(answer, &format!("{path}.lines"));
        let ends = numbers(answer, &format!("{path}.ends"));
        let own = part(&ends, place).flat_map(|line| part(&lines, line));
        own.map(|point| [points[2 * point], points[2 * point + 1]]).collect()
    }

    /// Whether the middle of a pixel is within the rectangle around some points, or some hundredths of a pixel beside it.
    fn is_around(points: &[[f32; 2]], [row, column]: [u32; 2]) -> bool {
        [column, row].iter().enumerate().all(|(axis, &at)| {
            let at = at as f32 + 0.5;
            points.iter().any(|point| point[axis] <= at + 0.02)
                && points.iter().any(|point| point[axis] >= at - 0.02)
        })
    }

    #[test]
    fn what_affects_a_pixel_has_its_outline_around_it() {
        for (scene, order, kind) in [
            ("lecture", "object", "boxes"),
            ("canonical", "image", "textbook"),
            ("lecture", "image", "hierarchy"),
        ] {
            let answer = recorded(scene, order, kind);
            let kinds = answer.json()["kinds"].clone();
            let steps = steps(&answer, order);
            let mut count = 0;
            for &[object, _, row, column, _] in steps.iter().filter(|step| matches!(step[4], 1..=3))
            {
                let (id, pixel) = (object as usize, [row, column]);
                // A plane has a horizon, and nothing around it.
                if kinds[id] != "plane" {
                    let points = points(&answer, "outlines.primitives", id);
                    assert!(is_around(&points, pixel), "{scene}: {id} at {pixel:?}: {points:?}");
                    count += 1;
                }
            }
            assert!(count > 10, "{scene}: {count}");
        }
    }

    #[test]
    fn a_ray_that_enters_a_box_has_its_edges_around_it() {
        let answer = recorded("lecture", "image", "hierarchy");
        let boxes = numbers(&answer, "outlines.boxes.number");
        let steps = steps(&answer, "image");
        let mut count = 0;
        for &[_, node, row, column, result] in steps.iter().filter(|step| step[4] >= 4) {
            let place = boxes.iter().position(|&number| number == node).unwrap();
            let points = points(&answer, "outlines.boxes", place);
            assert_eq!(points.len(), 24);
            if result == 5 {
                assert!(is_around(&points, [row, column]), "{place}");
                count += 1;
            }
        }
        assert!(count > 10, "{count}");
    }
}
