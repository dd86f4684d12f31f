//! What a sweep shows: the curves of one axis, their slopes, and where the orders cross, in words.

use super::case::Axis;
use super::fit::{Crossing, Slope, crossing, slope};
use super::plan::Quantity;
use super::point::Point;
use super::table::{Source, Table};
use crate::orders::{Method, Order};

/// The curve of one renderer.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The order.
    pub order: Order,
    /// The method.
    pub method: Method,
    /// By rising x.
    pub points: Vec<Point>,
    /// How it grows; `None` with fewer than three points.
    pub slope: Option<Slope>,
}

/// All curves of one axis and one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// What grows.
    pub axis: Axis,
    /// What it costs.
    pub quantity: Quantity,
    /// Object order and image order, fast; then both textbooks, if they were measured.
    pub curves: Vec<Curve>,
    /// Where the fast methods cross.
    pub fast: Crossing,
    /// Where the textbooks cross.
    pub textbook: Crossing,
}

/// Counts apart by less than this factor tell nothing about which order does more.
const ALIKE_STEPS: f64 = 1.02;
/// Times apart by less than this factor tell nothing about which order is faster.
const ALIKE_TIMES: f64 = 1.1;

impl Summary {
    /// The curves of a table; `None` if it has no point of them.
    pub fn of(table: &Table, axis: Axis, quantity: Quantity) -> Option<Summary> {
        let all = [Method::Fast, Method::Textbook]
            .into_iter()
            .flat_map(|method| Order::ALL.map(|order| (order, method)));
        let curves: Vec<Curve> = all
            .map(|(order, method)| {
                let points = points(table, axis, quantity, order, method);
                Curve { order, method, slope: slope(&points), points }
            })
            .filter(|curve| !curve.points.is_empty())
            .collect();
        let alike = match quantity {
            Quantity::Steps => ALIKE_STEPS,
            Quantity::Milliseconds => ALIKE_TIMES,
        };
        let crossing = |method| {
            let of = |order| {
                let is = |curve: &&Curve| (curve.order, curve.method) == (order, method);
                curves.iter().find(is).map_or(&[][..], |curve| &curve.points)
            };
            crossing(of(Order::Object), of(Order::Image), alike)
        };
        let (fast, textbook) = (crossing(Method::Fast), crossing(Method::Textbook));
        (!curves.is_empty()).then_some(Summary { axis, quantity, curves, fast, textbook })
    }

    /// The crossing of one method in a sentence, with no more than is seen.
    pub fn says(&self, method: Method) -> String {
        let crossing = match method {
            Method::Fast => self.fast,
            Method::Textbook => self.textbook,
        };
        let unit = self.axis.unit();
        let (takes, much) = match self.quantity {
            Quantity::Steps => ("takes fewer steps", "many steps"),
            Quantity::Milliseconds => ("is faster", "long"),
        };
        let order = |first: bool| if first { Order::Object } else { Order::Image }.name();
        match crossing {
            Crossing::Unknown => "not enough points to compare the orders".into(),
            Crossing::Alike => match self.quantity {
                Quantity::Steps => "both orders take the same number of steps, to 2 %".into(),
                Quantity::Milliseconds => {
                    "too close to tell which order is faster, anywhere in this range".into()
                }
            },
            Crossing::None { first, by: [least, most], everywhere } => {
                let by = match (least, most) {
                    _ if most / least < 1.1 => factor(most),
                    (..1.05, _) => format!("up to {}", factor(most)),
                    _ => format!("{} to {}", factor(least), factor(most)),
                };
                let order = order(!first);
                let range = if everywhere {
                    "no crossing in this range"
                } else {
                    "where the orders can be told apart"
                };
                format!("{range}: {order} takes {by} times as {much}")
            }
            Crossing::At { x, first, sharp, .. } => {
                let about = if sharp { "about " } else { "somewhere near " };
                format!("from {about}{} {unit} on, {} {takes}", self.place(x), order(first))
            }
            Crossing::Several { from, to, times } => format!(
                "the curves cross {times} times between {} and {} {unit}: too close to tell there",
                self.place(from),
                self.place(to)
            ),
        }
    }

    /// A place on the axis, with no more digits than are seen. Things are whole.
    fn place(&self, x: f64) -> String {
        let digits = two_digits(x);
        let has_parts = self.axis == Axis::TriangleSize;
        short(if has_parts { digits } else { digits.round().max(1.0) })
    }

    /// By which factor repeated times of one point differ, in the middle of all points; `None` without repetition.
    pub fn spread(&self) -> Option<f64> {
        let points = self.curves.iter().flat_map(|curve| &curve.points);
        let mut factors: Vec<f64> = points
            .filter(|point| point.source == Source::Measured && point.most > point.least)
            .map(|point| point.most / point.least)
            .collect();
        factors.sort_by(f64::total_cmp);
        factors.get(factors.len() / 2).copied()
    }
}

fn points(
    table: &Table,
    axis: Axis,
    quantity: Quantity,
    order: Order,
    method: Method,
) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    for (task, measured) in table.rows() {
        if (task.case.axis, task.quantity, task.order, task.method)
            != (axis, quantity, order, method)
        {
            continue;
        }
        let (x, value) = (task.case.x, measured.value);
        match points.last_mut() {
            Some(point) if point.x.to_bits() == x.to_bits() => {
                point.least = point.least.min(value);
                point.most = point.most.max(value);
                point.value = point.least;
            }
            _ => {
                let source = measured.source;
                points.push(Point { x, value, least: value, most: value, source });
            }
        }
    }
    points
}

fn factor(value: f64) -> String {
    if value < 10.0 { format!("{value:.1}") } else { short(two_digits(value)) }
}

/// The number, rounded to two digits that count.
fn two_digits(value: f64) -> f64 {
    let step = 10_f64.powf(value.log10().floor() - 1.0);
    (value / step).round() * step
}

/// A number as it is written beside an axis: 0.05, 20, 500 k, 2 M.
pub fn short(value: f64) -> String {
    let (part, unit) = match value {
        1e12.. => (value / 1e12, " T"),
        1e9.. => (value / 1e9, " G"),
        1e6.. => (value / 1e6, " M"),
        1e3.. => (value / 1e3, " k"),
        _ => (value, ""),
    };
    // Powers of ten below 1 are not exact in binary.
    format!("{}{unit}", (part * 1e6).round() / 1e6)
}
