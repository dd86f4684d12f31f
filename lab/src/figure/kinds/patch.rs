//! A patch of the raster, magnified: where its pixels lie on the canvas.

use crate::figure::drawing::{Drawing, Pen};

/// Some rows and columns of pixels, drawn as squares.
#[derive(Clone, Debug)]
pub(super) struct Patch {
    /// The first row and the first column.
    pub(super) first: [usize; 2],
    /// How many rows and columns.
    pub(super) size: [usize; 2],
    /// The side of a pixel on the canvas.
    pub(super) cell: f64,
    /// The top left corner on the canvas.
    at: [f64; 2],
}

impl Patch {
    /// The patch around a pixel with so many rows and columns, as far as the image (width, height) has them, as large as
    /// it fits into a room: its corner, its width and height.
    pub(super) fn around(
        [i, j]: [u32; 2],
        [width, height]: [u32; 2],
        size: [usize; 2],
        (corner, room): ([f64; 2], [f64; 2]),
    ) -> Patch {
        let image = [height as usize, width as usize];
        let size = [size[0].min(image[0]), size[1].min(image[1])];
        let first = [(i as usize, 0), (j as usize, 1)]
            .map(|(at, axis)| at.saturating_sub(size[axis] / 2).min(image[axis] - size[axis]));
        let cell = (room[1] / size[0] as f64).min(room[0] / size[1] as f64).floor();
        let drawn = [cell * size[1] as f64, cell * size[0] as f64];
        let at = [
            corner[0] + (0.5 * (room[0] - drawn[0])).floor(),
            corner[1] + (0.5 * (room[1] - drawn[1])).floor(),
        ];
        Patch { first, size, cell, at }
    }

    /// All its pixels, row by row.
    pub(super) fn pixels(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let Patch { first, size, .. } = *self;
        (first[0]..first[0] + size[0])
            .flat_map(move |row| (first[1]..first[1] + size[1]).map(move |column| [row, column]))
    }

    /// Its rows and columns in words.
    pub(super) fn name(&self) -> String {
        let [rows, columns] = [0, 1].map(|axis| {
            let first = self.first[axis];
            format!("{first} to {}", first + self.size[axis] - 1)
        });
        format!("rows {rows}, columns {columns}")
    }

    /// The place on the canvas of a place on the raster: column and row, in pixels from the top left of the image.
    pub(super) fn place(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        [
            self.at[0] + (column - self.first[1] as f64) * self.cell,
            self.at[1] + (row - self.first[0] as f64) * self.cell,
        ]
    }

    /// The top left corner of a pixel on the canvas.
    pub(super) fn corner(&self, [row, column]: [usize; 2]) -> [f64; 2] {
        self.place([column as f64, row as f64])
    }

    /// The middle of a pixel on the canvas.
    pub(super) fn middle(&self, [row, column]: [usize; 2]) -> [f64; 2] {
        self.place([column as f64 + 0.5, row as f64 + 0.5])
    }

    /// The patch's corner and size on the canvas.
    pub(super) fn extent(&self) -> ([f64; 2], [f64; 2]) {
        (self.at, [self.cell * self.size[1] as f64, self.cell * self.size[0] as f64])
    }

    /// Draws what follows only within the patch.
    pub(super) fn window(&self, drawing: &mut Drawing) {
        drawing.window(Some(self.extent()));
    }

    /// The lines between pixels.
    pub(super) fn draw_lines(&self, drawing: &mut Drawing, pen: Pen) {
        let ([x, y], [width, height]) = self.extent();
        for row in 0..=self.size[0] {
            let y = y + row as f64 * self.cell;
            drawing.line(&[[x, y], [x + width, y]], pen);
        }
        for column in 0..=self.size[1] {
            let x = x + column as f64 * self.cell;
            drawing.line(&[[x, y], [x, y + height]], pen);
        }
    }

    /// The middle of the part of a line within the patch.
    pub(super) fn middle_within(&self, line: &[[f64; 2]]) -> Option<[f64; 2]> {
        let ([x, y], [width, height]) = self.extent();
        let (from, to) = (*line.first()?, *line.last()?);
        let at = |t: f64| [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])];
        let within = |[a, b]: [f64; 2]| a >= x && a <= x + width && b >= y && b <= y + height;
        let inside: Vec<f64> =
            (0..=200).map(|k| f64::from(k) / 200.0).filter(|t| within(at(*t))).collect();
        inside.get(inside.len() / 2).map(|t| at(*t))
    }
}
