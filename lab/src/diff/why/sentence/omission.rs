//! What a renderer leaves out, in sentences.

use crate::common::Projection;
use crate::diff::why::convention::{Between, Clip, NearPlane, Omission, Part, Placement};
use crate::wording::three_digits;

/// A near plane.
pub(super) fn of_near(
    NearPlane { clip, hides_spheres }: NearPlane,
    projection: Projection,
) -> String {
    /// What lies between distances that differ by more is not certain enough to be named.
    const NARROW: f64 = 1.2;
    let Clip { at, alone } = clip;
    let at_viewport = projection == Projection::Perspective
        && (at.nearer..=at.farther).contains(&1.0)
        && at.farther <= NARROW * at.nearer;
    let viewport = if at_viewport { "; the viewport lies at t = 1" } else { "" };
    let spheres = match hides_spheres {
        true => ", nor the other side of a sphere whose first hit is nearer",
        false => "",
    };
    format!(
        "shows nothing nearer than t = {}{spheres}: it has a near plane, or a smallest t, there{}{}{viewport}; here all \
         with t > 0 is seen",
        of_between(at),
        depth_of_t(projection),
        of_alone(alone, "begins")
    )
}

/// A far plane.
pub(super) fn of_far(Clip { at, alone }: Clip, projection: Projection) -> String {
    format!(
        "shows nothing beyond t = {}: it has a far plane, or a largest t, there{}{}; here nothing is too far to be seen",
        of_between(at),
        depth_of_t(projection),
        of_alone(alone, "ends")
    )
}

/// What one primitive may do where it alone is clipped.
fn of_alone(alone: Option<u32>, ends: &str) -> String {
    alone.map_or(String::new(), |id| format!(", or id {id} {ends} there"))
}

/// The depth along the axis, where `t` is another number.
fn depth_of_t(projection: Projection) -> &'static str {
    match projection {
        Projection::Perspective => " (its depth is t d)",
        Projection::Parallel => "",
    }
}

/// `0.7`, or `0.7 to 0.9` where the picture tells no more.
fn of_between(between: Between) -> String {
    let [nearer, farther] = [between.nearer, between.farther].map(three_digits);
    if nearer == farther { nearer } else { format!("{nearer} to {farther}") }
}

/// What is not drawn at all.
pub(super) fn of_omission(omission: Omission, placement: Placement) -> String {
    match omission {
        Omission::Nothing => "draws all".into(),
        Omission::Primitive { id: 0, .. } => {
            "leaves out id 0, the first primitive: does its loop begin at 1, or is 0 taken for nothing?".into()
        }
        Omission::Primitive { id, is_last: true } => {
            format!("leaves out id {id}, the last primitive: does its loop end one too early?")
        }
        Omission::Primitive { id, .. } => {
            format!("leaves out id {id}: is it read, and what drops it?")
        }
        Omission::Several(several) => {
            let ids: Vec<String> = several.ids().iter().map(u32::to_string).collect();
            format!("leaves out ids {}: are they read, and what drops them?", ids.join(", "))
        }
        Omission::Shape(shape) => format!("draws no {}", shape.name()),
        Omission::Part(part) => of_part(part, placement),
        Omission::From { least, first } => {
            let from = match least == first {
                true => format!("id {first}"),
                false => format!("some id between {least} and {first}"),
            };
            format!("leaves out all from {from} on: does its loop, or a buffer, end too early?")
        }
        Omission::Object { object, ids: [first, last] } => {
            format!("leaves out object {object} (ids {first} to {last}): is it read, and what drops it?")
        }
    }
}

/// A blank part, in the rows and columns of the file.
fn of_part(part: Part, placement: Placement) -> String {
    let Some(Part { rows, columns, image: [width, height], alone }) = part.in_file(placement)
    else {
        let [width, height] = part.image;
        let [rows, columns] = [range("row", part.rows), range("column", part.columns)];
        let what = match (part.rows, part.columns) {
            (_, [0, last]) if last + 1 == width => rows,
            ([0, last], _) if last + 1 == height => columns,
            _ => format!("{rows} of {columns}"),
        };
        return format!("shows nothing where the upright picture has {what}");
    };
    let (what, question) = match (rows, columns) {
        (rows, [0, last]) if last + 1 == width => along("row", rows, height),
        ([0, last], columns) if last + 1 == height => along("column", columns, width),
        _ => {
            let what = format!("{} of {}", range("row", rows), range("column", columns));
            (what, "is a tile not drawn, or not written")
        }
    };
    let alone = alone.map_or(String::new(), |(object, [first, last])| match first == last {
        true => format!(", or is id {first} alone cut off there"),
        false => format!(", or is object {object} (ids {first} to {last}) alone cut off there"),
    });
    format!("shows nothing in its {what}: {question}{alone}?")
}

/// Whole rows or columns, and the question about them.
fn along(axis: &str, [first, last]: [u32; 2], count: u32) -> (String, &'static str) {
    let range = range(axis, [first, last]);
    match (first, last + 1 == count) {
        (_, true) if first == last => {
            (format!("{range}, the last one"), "does its loop end one too early")
        }
        (0, false) if last == 0 => (format!("{range}, the first one"), "does its loop begin at 1"),
        (_, true) => (
            format!("{range}, the last ones"),
            "do its loop, its tiles or its buffer end too early",
        ),
        (0, false) => (format!("{range}, the first ones"), "does its loop begin too late"),
        _ => (range, "is this part of the picture not drawn, or not written"),
    }
}

/// `row 7`, or `rows 7 to 9`.
fn range(axis: &str, [first, last]: [u32; 2]) -> String {
    if first == last { format!("{axis} {first}") } else { format!("{axis}s {first} to {last}") }
}
