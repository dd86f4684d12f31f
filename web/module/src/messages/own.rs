//! `own`: two triangles that share an edge, and which of them owns each sample, by the exact predicates.

use crate::answer::{Answer, Buffer};
use bothways_lab::common::glam::Vec2;
use bothways_lab::cover::{Cover, Place, cover};
use serde::Deserialize;
use serde_json::{Value, json};

/// The corners 0, 1, 2, 3 in raster coordinates: the triangles 0, 1, 2 and 0, 2, 3 share the edge from 0 to 2.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Own {
    vertices: [[f32; 2]; 4],
    height: u32,
    width: u32,
}

/// The most pixels: each is a button to the eye, so there are few.
const MOST_PIXELS: u64 = 1 << 20;

pub(crate) fn answer(own: &Own) -> Result<Answer, String> {
    let (image, [a, b, c, d]) = ([own.width, own.height], own.vertices.map(Vec2::from_array));
    if u64::from(own.width) * u64::from(own.height) > MOST_PIXELS {
        return Err(format!("at most {MOST_PIXELS} pixels are shown here; choose fewer"));
    }
    let covered = |corners| cover(corners, image).map_err(|error| error.to_string());
    let covers = [covered([a, b, c])?, covered([a, c, d])?];
    let (mut owners, mut ties) = (Vec::new(), Vec::new());
    for row in 0..own.height {
        for column in 0..own.width {
            let [first, second] = covers.each_ref().map(|cover| cover.covers(row, column));
            let owner = u8::from(first) + 2 * u8::from(second);
            owners.push(owner);
            if covers.iter().all(|cover| is_tie(cover, row, column)) {
                let name = ["neither", "the first", "the second", "both"][usize::from(owner)];
                ties.push(json!([row, column, "shared edge", name]));
            }
        }
    }
    Ok(Answer::new(json!({ "ties": Value::from(ties) })).with("owners", Buffer::U8(owners)))
}

/// Whether the centre of a pixel lies exactly on an edge.
fn is_tie(cover: &Cover, row: u32, column: u32) -> bool {
    matches!(cover.place(row, column), Place::OnEdge { .. })
}
