//! The figures below the picture of an order, in groups: the work of the algorithm, and what the frame executed with
//! the time that it took. Where there is only one of the two sorts of counts, there is one group.

use crate::common::{Executed, Work};
use crate::orders::{Counts, Order, Rendered};
use crate::wording::{count, grouped, milliseconds};

/// A label and a figure.
pub(super) type Row = (&'static str, String);

/// Rows that belong together.
pub(super) struct Group {
    /// What the rows count; none for times alone.
    pub(super) heading: Option<String>,
    pub(super) rows: Vec<Row>,
}

/// The figures of one order, without empty groups.
pub(super) fn figures(rendered: &Rendered) -> Vec<Group> {
    let times = times(rendered);
    let algorithm = Group { heading: heading_of_work(rendered), rows: work(rendered) };
    let groups = match rendered.executed {
        Some(executed) => {
            let heading = Some(format!("executed in {}", count(executed.tiles, "tiles")));
            let rows = [of_executed(rendered.order, &executed), times].concat();
            vec![algorithm, Group { heading, rows }]
        }
        None => vec![Group { rows: [algorithm.rows, times].concat(), ..algorithm }],
    };
    groups.into_iter().filter(|group| !group.rows.is_empty()).collect()
}

fn heading_of_work(rendered: &Rendered) -> Option<String> {
    let alone = match rendered.order {
        Order::Object => "work for each primitive alone",
        Order::Image => "work for each ray alone",
    };
    rendered.work().map(|_| alone.into())
}

/// The work of the algorithm.
fn work(rendered: &Rendered) -> Vec<Row> {
    match rendered.work {
        Counts::Counted(work) => of_work(rendered.order, &work),
        Counts::TooMany { most } => vec![
            ("work for a frame", "not counted".into()),
            ("it is more than", format!("{} steps", grouped(most))),
        ],
        Counts::LeftOut => vec![],
    }
}

fn of_work(order: Order, work: &Work) -> Vec<Row> {
    let Work { primitives, rays, nodes, tests, fragments, depth_tests, .. } = *work;
    let judged = work.judged_coverage + work.judged_nearest;
    let (outer, boxes) = match order {
        Order::Object => (("primitives", primitives), None),
        Order::Image => (("rays", rays), Some(nodes)),
    };
    vec![
        (outer.0, grouped(outer.1)),
        ("boxes tested", boxes.map_or("–".into(), grouped)),
        ("primitive × sample", grouped(tests)),
        ("of these, covered", grouped(fragments)),
        ("depth comparisons", grouped(depth_tests)),
        ("left to the exact judge", grouped(judged)),
    ]
}

/// A batch is up to sixteen pairs of a primitive and a sample, tested at once.
fn of_executed(order: Order, executed: &Executed) -> Vec<Row> {
    let search = match order {
        Order::Object => ("clusters skipped", executed.clusters_skipped),
        Order::Image => ("nodes opened", executed.nodes_opened),
    };
    let rows = [
        search,
        ("boxes tested", executed.boxes_tested),
        ("triangles set up", executed.set_ups),
        ("batches tested", executed.blocks + executed.lane_steps),
        ("single samples", executed.single_samples),
    ];
    rows.map(|(label, count)| (label, grouped(count))).to_vec()
}

/// The times. The time for shading is left out: shading is the same task in both orders, and would hide the others.
fn times(rendered: &Rendered) -> Vec<Row> {
    rendered.times.map_or(vec![], |times| {
        vec![
            ("time to prepare", milliseconds(times.prepare.median)),
            ("time for visibility", milliseconds(times.visibility.median)),
        ]
    })
}
