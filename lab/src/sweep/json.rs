//! A sweep for programs.

use super::fit::Crossing;
use super::plan::{Plan, Quantity};
use super::summary::{Curve, Summary};
use crate::orders::Method;
use serde::Serialize;

#[derive(Serialize)]
struct Json {
    size: [u32; 2],
    most_triangles: u64,
    /// Under which conditions times were measured; null for counts alone.
    times: Option<String>,
    charts: Vec<ChartJson>,
}

#[derive(Serialize)]
struct ChartJson {
    axis: &'static str,
    scene: &'static str,
    unit: &'static str,
    quantity: &'static str,
    curves: Vec<CurveJson>,
    fast: CrossingJson,
    textbook: CrossingJson,
}

#[derive(Serialize)]
struct CurveJson {
    order: &'static str,
    method: &'static str,
    slope: Option<f64>,
    slope_error: Option<f64>,
    /// The points that the slope is fitted to.
    slope_points: usize,
    slope_from: Option<f64>,
    points: Vec<PointJson>,
}

#[derive(Serialize)]
struct PointJson {
    x: f64,
    value: f64,
    most: f64,
    source: &'static str,
}

#[derive(Serialize)]
struct CrossingJson {
    says: String,
    crosses_at: Option<f64>,
}

/// Summaries as JSON, with a newline at the end.
///
/// # Errors
///
/// Never for finite numbers.
pub fn json(plan: &Plan, conditions: &str, summaries: &[Summary]) -> serde_json::Result<String> {
    let json = Json {
        size: plan.image,
        most_triangles: plan.most,
        times: (!conditions.is_empty()).then(|| conditions.to_owned()),
        charts: summaries.iter().map(chart).collect(),
    };
    serde_json::to_string_pretty(&json).map(|text| text + "\n")
}

/// The number, rounded to four digits: the last bits of a logarithm differ from machine to machine.
fn rounded(number: f64) -> f64 {
    if number.abs() < 1e-9 { 0.0 } else { format!("{number:.3e}").parse().unwrap_or(number) }
}

fn chart(summary: &Summary) -> ChartJson {
    let crossing = |method, crossing| CrossingJson {
        says: summary.says(method),
        crosses_at: if let Crossing::At { x, .. } = crossing { Some(rounded(x)) } else { None },
    };
    ChartJson {
        axis: summary.axis.name(),
        scene: summary.axis.scene(),
        unit: summary.axis.unit(),
        quantity: Quantity::name(summary.quantity),
        curves: summary.curves.iter().map(curve).collect(),
        fast: crossing(Method::Fast, summary.fast),
        textbook: crossing(Method::Textbook, summary.textbook),
    }
}

fn curve(curve: &Curve) -> CurveJson {
    let slope = curve.slope;
    let point = |point: &super::Point| PointJson {
        x: point.x,
        value: point.value,
        most: point.most,
        source: point.source.name(),
    };
    CurveJson {
        order: curve.order.name(),
        method: curve.method.name(),
        slope: slope.map(|slope| rounded(slope.value)),
        slope_error: slope.map(|slope| rounded(slope.error)),
        slope_points: slope.map_or(0, |slope| slope.points),
        slope_from: slope.map(|slope| slope.from),
        points: curve.points.iter().map(point).collect(),
    }
}
