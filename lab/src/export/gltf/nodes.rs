//! The nodes of a file: one for each object, below it one for each of its instances, and the camera's.

use crate::common::Placement;
use crate::export::instances::columns;
use serde::Serialize;

/// A node, with what it states.
#[derive(Debug, Default, Serialize)]
pub(super) struct Node {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) mesh: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) camera: Option<usize>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) children: Vec<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) scale: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) rotation: Option<[f64; 4]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) translation: Option<[f64; 3]>,
    /// Column by column.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) matrix: Option<Box<[f64; 16]>>,
}

impl Node {
    /// A mesh where an instance is, with exactly its numbers: an `f32` is an `f64`, and readers round it to itself.
    pub(super) fn placed(mesh: usize, placement: &Placement) -> Node {
        let mesh = Some(mesh);
        let rows = placement.rows();
        let translation = rows.map(|row| f64::from(row[3]));
        let scale = [0, 1, 2].map(|axis| f64::from(rows[axis][axis]));
        // Without a rotation its parts are exact, too.
        let is_zero = |number: f32| number.to_bits() == 0;
        let is_upright = (0..3).all(|row| {
            (0..3).all(|column| row == column || is_zero(rows[row][column])) && scale[row] > 0.0
        });
        if is_upright {
            let scale = (scale != [1.0; 3]).then_some(scale);
            let translation = (translation != [0.0; 3]).then_some(translation);
            return Node { mesh, scale, translation, ..Node::default() };
        }
        let [x, y, z] = columns(placement).map(|column| column.extend(0.0).to_array());
        let [right, up, back] = translation;
        let columns = [x, y, z, [right, up, back, 1.0]];
        let matrix = std::array::from_fn(|number| columns[number / 4][number % 4]);
        Node { mesh, matrix: Some(Box::new(matrix)), ..Node::default() }
    }
}
