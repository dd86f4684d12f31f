//! `own`: two triangles that share an edge, and which of them owns each sample, by the exact predicates.

use crate::answer::{Answer, Buffer};
use bothways_lab::common::glam::Vec2;
use bothways_lab::cover::{Containment, Cover, cover};
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

/// The most pixels: enough for any screen on which single samples are told apart.
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
                #[expect(clippy::cast_precision_loss, reason = "at most 2^20, exact with the half")]
                let middle = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
                let at_end = [a, c].contains(&middle);
                ties.push(json!({ "row": row, "column": column, "atEnd": at_end }));
            }
        }
    }
    Ok(Answer::new(json!({ "ties": Value::from(ties) })).with("owners", Buffer::U8(owners)))
}

/// Whether the centre of a pixel lies exactly on an edge.
fn is_tie(cover: &Cover, row: u32, column: u32) -> bool {
    matches!(cover.place(row, column), Containment::OnEdge { .. })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shared_edge_has_one_owner_for_each_sample_between_its_ends() {
        let vertices = [[2.5, 2.5], [7.0, 2.0], [6.5, 6.5], [2.0, 7.0]];
        let answer = answer(&Own { vertices, height: 9, width: 9 }).unwrap();
        let Some(Buffer::U8(owners)) = answer.buffer("owners") else { panic!("no owners") };
        let tie = |at: usize, at_end| json!({ "row": at, "column": at, "atEnd": at_end });
        let ties: Vec<Value> = (2..=6).map(|at| tie(at, [2, 6].contains(&at))).collect();
        assert_eq!(answer.json()["ties"], Value::from(ties));
        assert!((3..6).all(|at| [1, 2].contains(&owners[at * 9 + at])), "{owners:?}");
    }
}
