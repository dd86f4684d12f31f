//! What a renderer answers: for every sample the primitive that is seen, how far it is, and its look.

use crate::camera::{Camera, check_samples};
use glam::{Vec2, Vec3};
use std::ops::Range;

/// How to render, the same for both orders.
///
/// Threads are the caller's: the fast renderers run on the rayon pool that they are called in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Samples along one side of a pixel: `samples`² a pixel, on a regular grid.
    pub samples: u32,
}

impl Default for Options {
    /// One sample, in the middle of the pixel.
    fn default() -> Self {
        Options { samples: 1 }
    }
}

/// The number that an id buffer stores for "no primitive"; [`Frame::id`] says `None`.
pub const NO_PRIMITIVE: u32 = u32::MAX;

/// One rendered picture, in samples: `height·N` rows of `width·N` columns, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    image: [u32; 2],
    samples: u32,
    ids: Vec<u32>,
    t: Vec<f32>,
    normals: Vec<Vec3>,
    colours: Vec<Vec3>,
    /// Empty unless they are asked for.
    texture_coordinates: Vec<Vec2>,
}

/// A rectangle of samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Region {
    /// Rows from the top.
    pub rows: Range<usize>,
    /// Columns from the left.
    pub columns: Range<usize>,
}

impl Region {
    /// How many samples it holds.
    pub fn area(&self) -> usize {
        self.rows.len() * self.columns.len()
    }

    /// Whether it holds no sample.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty() || self.columns.is_empty()
    }

    /// The samples that both hold.
    pub fn intersection(&self, other: &Region) -> Region {
        let overlap = |a: &Range<usize>, b: &Range<usize>| a.start.max(b.start)..a.end.min(b.end);
        Region {
            rows: overlap(&self.rows, &other.rows),
            columns: overlap(&self.columns, &other.columns),
        }
    }
}

/// A part of a frame that one thread may write: ids and distances of a rectangle of samples.
#[derive(Debug)]
pub struct Tile<'a> {
    /// Where it lies in the frame.
    pub region: Region,
    /// Its ids, a slice for each row.
    pub ids: Vec<&'a mut [u32]>,
    /// Its distances, a slice for each row.
    pub t: Vec<&'a mut [f32]>,
}

/// One row of a frame, while its visible surfaces get their look.
#[derive(Debug)]
pub struct ShadingRow<'a> {
    /// The row's number from the top.
    pub row: usize,
    /// What is seen.
    pub ids: &'a [u32],
    /// How far it is.
    pub t: &'a [f32],
    /// Unit normals towards the viewer, zero where nothing is seen.
    pub normals: &'a mut [Vec3],
    /// Linear red, green and blue.
    pub colours: &'a mut [Vec3],
    /// Texture coordinates, zero where there are none; `None` if nobody asked for them.
    pub texture_coordinates: Option<&'a mut [Vec2]>,
}

impl Frame {
    /// A frame in which nothing is seen.
    ///
    /// # Panics
    ///
    /// If [`check_samples`] refuses the size.
    pub fn new(camera: &Camera, options: &Options) -> Frame {
        check_samples(camera.image(), options.samples).expect("the size was checked");
        let [width, height] = camera.image().map(|side| side as usize * options.samples as usize);
        let count = width * height;
        Frame {
            image: camera.image(),
            samples: options.samples,
            ids: vec![NO_PRIMITIVE; count],
            t: vec![f32::INFINITY; count],
            normals: vec![Vec3::ZERO; count],
            colours: vec![Vec3::ZERO; count],
            texture_coordinates: Vec::new(),
        }
    }

    /// The same frame, with room for the texture coordinate of every sample: shading keeps them.
    pub fn with_texture_coordinates(mut self) -> Frame {
        self.texture_coordinates = vec![Vec2::ZERO; self.ids.len()];
        self
    }

    /// Makes the frame fit a camera and options; what it held is no longer of use.
    pub fn fit(&mut self, camera: &Camera, options: &Options) {
        if self.image != camera.image() || self.samples != options.samples {
            let asked = !self.texture_coordinates.is_empty();
            *self = Frame::new(camera, options);
            if asked {
                self.texture_coordinates = vec![Vec2::ZERO; self.ids.len()];
            }
        }
    }

    /// Forgets what was seen.
    pub fn clear(&mut self) {
        self.ids.fill(NO_PRIMITIVE);
        self.t.fill(f32::INFINITY);
    }

    /// The image's width and height in pixels.
    pub fn image(&self) -> [u32; 2] {
        self.image
    }

    /// Samples along one side of a pixel.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Columns of samples.
    pub fn width(&self) -> usize {
        self.image[0] as usize * self.samples as usize
    }

    /// Rows of samples.
    pub fn height(&self) -> usize {
        self.image[1] as usize * self.samples as usize
    }

    /// The primitive that is seen at a sample.
    pub fn id(&self, row: usize, column: usize) -> Option<u32> {
        match self.ids[row * self.width() + column] {
            NO_PRIMITIVE => None,
            id => Some(id),
        }
    }

    /// How far it is, in lengths of the viewing ray's direction.
    pub fn t(&self, row: usize, column: usize) -> Option<f32> {
        let index = row * self.width() + column;
        (self.ids[index] != NO_PRIMITIVE).then(|| self.t[index])
    }

    /// Notes that a primitive is seen at a sample.
    pub fn set(&mut self, row: usize, column: usize, id: u32, t: f64) {
        let index = row * self.width() + column;
        self.ids[index] = id;
        self.t[index] = stored_t(t);
    }

    /// All ids, [`NO_PRIMITIVE`] for nothing.
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// All distances, +∞ for nothing.
    pub fn distances(&self) -> &[f32] {
        &self.t
    }

    /// Unit normals of what is seen, towards the viewer; zero for nothing.
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// Linear red, green and blue of every sample.
    pub fn colours(&self) -> &[Vec3] {
        &self.colours
    }

    /// Texture coordinates of what is seen, zero where there are none; empty unless
    /// [`Frame::with_texture_coordinates`] asked for them.
    pub fn texture_coordinates(&self) -> &[Vec2] {
        &self.texture_coordinates
    }

    /// The indices, in [`Frame::ids`] and its like, of a pixel's samples.
    pub fn samples_of(&self, i: usize, j: usize) -> impl Iterator<Item = usize> + use<> {
        let (n, width) = (self.samples as usize, self.width());
        (0..n * n).map(move |sample| (i * n + sample / n) * width + j * n + sample % n)
    }

    /// Cuts the frame into tiles of at most so many columns and rows of samples, row by row.
    ///
    /// # Panics
    ///
    /// If `columns` or `rows` is 0.
    pub fn tiles_mut(&mut self, columns: usize, rows: usize) -> Vec<Tile<'_>> {
        let (width, height) = (self.width(), self.height());
        let mut tiles: Vec<Tile<'_>> = tile_regions(width, height, columns, rows)
            .map(|region| {
                let height = region.rows.len();
                Tile { region, ids: Vec::with_capacity(height), t: Vec::with_capacity(height) }
            })
            .collect();
        let across = width.div_ceil(columns);
        let lines = self.ids.chunks_mut(width).zip(self.t.chunks_mut(width));
        for (row, (ids, t)) in lines.enumerate() {
            let tiles = &mut tiles[row / rows * across..][..across];
            for (tile, (ids, t)) in
                tiles.iter_mut().zip(ids.chunks_mut(columns).zip(t.chunks_mut(columns)))
            {
                tile.ids.push(ids);
                tile.t.push(t);
            }
        }
        tiles
    }

    /// The frame's rows, for shading.
    pub fn shading_rows(&mut self) -> Vec<ShadingRow<'_>> {
        let width = self.width();
        let seen = self.ids.chunks(width).zip(self.t.chunks(width));
        let look = self.normals.chunks_mut(width).zip(self.colours.chunks_mut(width));
        let mut texture_coordinates = self.texture_coordinates.chunks_mut(width);
        seen.zip(look)
            .enumerate()
            .map(|(row, ((ids, t), (normals, colours)))| ShadingRow {
                row,
                ids,
                t,
                normals,
                colours,
                texture_coordinates: texture_coordinates.next(),
            })
            .collect()
    }
}

/// The tiles of a picture of `width` × `height` samples, row by row, each of at most so many columns and
/// rows.
///
/// # Panics
///
/// If `columns` or `rows` is 0.
pub fn tile_regions(
    width: usize,
    height: usize,
    columns: usize,
    rows: usize,
) -> impl Iterator<Item = Region> {
    let band = |start: usize, side: usize, end: usize| start..end.min(start + side);
    (0..height).step_by(rows).flat_map(move |row| {
        (0..width).step_by(columns).map(move |column| Region {
            rows: band(row, rows, height),
            columns: band(column, columns, width),
        })
    })
}

/// A distance as a frame stores it: the nearest `f32`, but finite and not 0, as `t` of something
/// seen is.
pub fn stored_t(t: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is asked")]
    let rounded = t as f32;
    rounded.clamp(f32::from_bits(1), f32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_sample_once() {
        let camera = Camera::canonical(5, 7);
        let mut frame = Frame::new(&camera, &Options { samples: 2, ..Options::default() });
        let mut area = 0;
        for tile in frame.tiles_mut(4, 3) {
            area += tile.region.area();
            assert_eq!(tile.ids.len(), tile.region.rows.len());
            for row in tile.ids {
                assert_eq!(row.len(), tile.region.columns.len());
                row.iter_mut().for_each(|id| *id = id.wrapping_add(1));
            }
        }
        assert_eq!(area, 140);
        assert!(frame.ids().iter().all(|&id| id == 0));
    }

    #[test]
    fn a_pixel_finds_its_samples() {
        let frame =
            Frame::new(&Camera::canonical(3, 2), &Options { samples: 2, ..Options::default() });
        let samples: Vec<_> = frame.samples_of(1, 2).collect();
        assert_eq!(samples, [16, 17, 22, 23]);
    }

    #[test]
    fn extreme_distances_stay_finite() {
        assert_eq!(stored_t(1e300), f32::MAX);
        assert!(stored_t(1e-300) > 0.0);
        assert_eq!(stored_t(0.1), 0.1_f32);
    }
}
