//! What a renderer answers: for every sample the primitive that is seen, how far it is, and its look.

mod ids;

pub use ids::{IdRows, Ids, NO_PRIMITIVE, NO_WIDE_PRIMITIVE};

use crate::camera::Camera;
use crate::engine::memory::filled;
use crate::raster::{Crop, CropError, Region, SizeError, check_samples};
use crate::view::View;
use glam::{Vec2, Vec3};
use ids::{IdBand, IdPlane, bands, cut};

/// How to render, the same for both orders.
///
/// The caller chooses the threads: the fast renderers run on the rayon pool that they are called in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Samples along one side of a pixel: `samples`² a pixel, on a regular grid.
    pub samples: u32,
    /// The pixels to render; `None` for all of the camera's image.
    pub crop: Option<Crop>,
}

impl Default for Options {
    /// One sample, in the middle of the pixel, and all pixels.
    fn default() -> Self {
        Options { samples: 1, crop: None }
    }
}

impl Options {
    /// The pixels of an image of this width and height that are rendered.
    pub fn pixels(&self, image: [u32; 2]) -> Crop {
        self.crop.unwrap_or(Crop::whole(image))
    }

    /// Whether an image of this width and height can be rendered with these options. What renders with others panics.
    ///
    /// # Errors
    ///
    /// As [`check_samples`] and [`Crop::check`].
    ///
    /// ```
    /// use bothways_common::{Camera, Options};
    ///
    /// let camera = Camera::canonical(480, 640);
    /// let options = Options { samples: 4, ..Options::default() };
    /// assert_eq!(options.check(camera.image()), Ok(()));
    /// assert!(Options { samples: 0, ..options }.check(camera.image()).is_err());
    /// ```
    pub fn check(&self, image: [u32; 2]) -> Result<(), OptionsError> {
        check_samples(image, self.samples)?;
        Ok(self.pixels(image).check(image)?)
    }
}

/// Why an image cannot be rendered with some [`Options`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OptionsError {
    /// It would have no samples, or too many.
    #[error(transparent)]
    Samples(#[from] SizeError),
    /// It has no such crop.
    #[error(transparent)]
    Crop(#[from] CropError),
}

/// What [`Frame::levels`] has where there is no texture coordinate.
pub const NO_LEVEL: f32 = f32::NEG_INFINITY;
/// The width and height in texels of the texture whose levels [`Frame::levels`] has where there is none, once in each unit
/// of the texture coordinate.
pub const LEVELS_OF: [usize; 2] = [256; 2];

/// One rendered picture, in samples: `height·N` rows of `width·N` columns, row by row from the top.
///
/// It may hold a [`Crop`] of the camera's image: then its size is the crop's, while pixels, rows and
/// columns keep their numbers in the whole image.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    camera_image: [u32; 2],
    options: Options,
    /// The samples that it holds, on the raster of the whole image.
    region: Region,
    ids: IdPlane,
    t: Vec<f32>,
    /// sRGB bytes, for each pixel.
    picture: Vec<[u8; 3]>,
    /// Empty unless they are asked for.
    colors: Vec<Vec3>,
    /// Empty unless they are asked for.
    normals: Vec<Vec3>,
    /// Empty unless they are asked for.
    texture_coordinates: Vec<Vec2>,
    /// Empty unless they are asked for.
    levels: Vec<f32>,
}

/// A part of a frame that one thread may write: ids and distances of a rectangle of samples.
#[derive(Debug)]
pub struct Tile<'a> {
    /// Its samples, on the raster of the whole image.
    pub region: Region,
    /// Its ids, a slice for each row.
    pub ids: IdRows<'a>,
    /// Its `t`, a slice for each row; +∞ for nothing.
    pub t: Vec<&'a mut [f32]>,
}

/// Some rows of a frame: a row of tiles.
#[derive(Debug)]
pub struct Band<'a> {
    region: Region,
    ids: IdBand<'a>,
    t: &'a mut [f32],
}

impl<'a> Band<'a> {
    /// Cuts the band into tiles of at most so many columns of samples, from left to right.
    ///
    /// # Panics
    ///
    /// If `columns` is 0.
    pub fn tiles_mut(self, columns: usize) -> Vec<Tile<'a>> {
        let Band { region, ids, t } = self;
        let (ids, t) = (ids.cut(&region, columns), cut(t, &region, columns));
        let regions = region.tiles(usize::MAX, columns);
        regions.zip(ids).zip(t).map(|((region, ids), t)| Tile { region, ids, t }).collect()
    }
}

/// Some rows of a frame's pixels during shading: for each as many rows of samples as a pixel has. All slices hold their rows
/// one after another.
#[derive(Debug)]
pub struct ShadingBand<'a> {
    /// The samples, on the raster of the whole image.
    pub region: Region,
    /// The ids of the primitives that are seen.
    pub ids: Ids<'a>,
    /// Their `t`, in lengths of the viewing ray's direction; +∞ for nothing.
    pub t: &'a [f32],
    /// The sRGB bytes of the pixels, to be written.
    pub picture: &'a mut [[u8; 3]],
    /// Linear red, green and blue; `None` unless the frame keeps them.
    pub colors: Option<&'a mut [Vec3]>,
    /// Unit normals towards the viewer, zero where nothing is seen; `None` unless the frame keeps them.
    pub normals: Option<&'a mut [Vec3]>,
    /// Texture coordinates, zero where there are none; `None` unless the frame keeps them.
    pub texture_coordinates: Option<&'a mut [Vec2]>,
    /// The levels of textures, [`NO_LEVEL`] where there is no texture coordinate; `None` unless the frame keeps them.
    pub levels: Option<&'a mut [f32]>,
}

impl Frame {
    /// A frame in which nothing is seen, and every pixel is black. It has room for ids of 32 bits; [`Frame::fit`] makes room
    /// for wider ones where a scene has them.
    ///
    /// # Panics
    ///
    /// If [`Options::check`] refuses the options for the camera's image.
    pub fn new(camera: &Camera, options: &Options) -> Frame {
        if let Err(error) = options.check(camera.image()) {
            panic!("no frame has these options: {error}");
        }
        let pixels = options.pixels(camera.image());
        let region = pixels.region(options.samples);
        let count = region.area();
        Frame {
            camera_image: camera.image(),
            options: *options,
            region,
            ids: IdPlane::Narrow(filled(NO_PRIMITIVE, count)),
            t: filled(f32::INFINITY, count),
            picture: vec![[0; 3]; pixels.width as usize * pixels.height as usize],
            colors: Vec::new(),
            normals: Vec::new(),
            texture_coordinates: Vec::new(),
            levels: Vec::new(),
        }
    }

    /// The same frame, with room for the linear colour of every sample, which shading then stores.
    pub fn with_colors(mut self) -> Frame {
        self.colors = vec![Vec3::ZERO; self.t.len()];
        self
    }

    /// The same frame, with room for the normal of every sample, which shading then stores.
    pub fn with_normals(mut self) -> Frame {
        self.normals = vec![Vec3::ZERO; self.t.len()];
        self
    }

    /// The same frame, with room for the texture coordinate of every sample, which shading then stores. What it stores is found in `f64`; so the
    /// picture may differ by 1/255 from that of a frame without this room, of which more is found in `f32`. So it may with levels.
    pub fn with_texture_coordinates(mut self) -> Frame {
        self.texture_coordinates = vec![Vec2::ZERO; self.t.len()];
        self
    }

    /// The same frame, with room for the level of every sample, which shading then stores: see [`Frame::levels`].
    pub fn with_levels(mut self) -> Frame {
        self.levels = vec![NO_LEVEL; self.t.len()];
        self
    }

    /// Makes the frame fit a view and options; one that fits already keeps its memory. Its content is meaningless
    /// until it is cleared or drawn anew. Room for colours, normals, texture coordinates and levels stays, if it has any.
    ///
    /// # Panics
    ///
    /// As [`Frame::new`].
    pub fn fit(&mut self, view: &View, options: &Options) {
        let camera = view.camera;
        if self.camera_image != camera.image() || self.options != *options {
            let was = std::mem::replace(self, Frame::new(camera, options));
            let count = self.t.len();
            if !was.colors.is_empty() {
                self.colors = vec![Vec3::ZERO; count];
            }
            if !was.normals.is_empty() {
                self.normals = vec![Vec3::ZERO; count];
            }
            if !was.texture_coordinates.is_empty() {
                self.texture_coordinates = vec![Vec2::ZERO; count];
            }
            if !was.levels.is_empty() {
                self.levels = vec![NO_LEVEL; count];
            }
        }
        self.ids.fit(self.t.len(), view.scene.has_wide_ids());
    }

    /// Clears ids and distances: nothing is seen. Shading writes all the rest anew.
    pub fn clear(&mut self) {
        self.ids.clear();
        self.t.fill(f32::INFINITY);
    }

    /// The options that it was made for.
    pub fn options(&self) -> Options {
        self.options
    }

    /// Its width and height in pixels: the image's, or the crop's.
    pub fn image(&self) -> [u32; 2] {
        let Crop { width, height, .. } = self.options.pixels(self.camera_image);
        [width, height]
    }

    /// The width and height of the camera's image, cropped or not.
    pub fn camera_image(&self) -> [u32; 2] {
        self.camera_image
    }

    /// The crop of the camera's image that it holds, if it does not hold all.
    pub fn crop(&self) -> Option<Crop> {
        self.options.crop
    }

    /// The pixels `[i, j]` that it holds, row by row, as they are numbered in the whole image.
    pub fn pixels(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let Crop { row, column, height, width } = self.options.pixels(self.camera_image);
        (row..row + height).flat_map(move |i| (column..column + width).map(move |j| [i, j]))
    }

    /// The samples that it holds: rows and columns on the raster of the whole image.
    pub fn region(&self) -> &Region {
        &self.region
    }

    /// Samples along one side of a pixel.
    pub fn samples(&self) -> u32 {
        self.options.samples
    }

    /// Columns of samples.
    pub fn width(&self) -> usize {
        self.region.columns.len()
    }

    /// Rows of samples.
    pub fn height(&self) -> usize {
        self.region.rows.len()
    }

    /// Where a sample is kept. Panics if the frame does not hold it: without a look at the column, the answer would be that
    /// of a sample in another row.
    fn index(&self, row: usize, column: usize) -> usize {
        let Region { rows, columns } = &self.region;
        assert!(
            rows.contains(&row) && columns.contains(&column),
            "the frame has no sample ({row}, {column}): it holds rows {rows:?} and columns {columns:?}"
        );
        (row - self.region.rows.start) * self.width() + column - self.region.columns.start
    }

    /// The id of the primitive that is seen at a sample; `None` for nothing.
    ///
    /// Here and in [`Frame::t`] and [`Frame::set`], row and column are those of the whole image's raster, and must lie
    /// in [`Frame::region`].
    ///
    /// # Panics
    ///
    /// If the frame does not hold the sample.
    pub fn id(&self, row: usize, column: usize) -> Option<u64> {
        self.ids().get(self.index(row, column))
    }

    /// The distance `t` of what is seen at a sample, in lengths of the viewing ray's direction; `None` for nothing.
    ///
    /// # Panics
    ///
    /// If the frame does not hold the sample.
    pub fn t(&self, row: usize, column: usize) -> Option<f32> {
        let index = self.index(row, column);
        self.ids().get(index).map(|_| self.t[index])
    }

    /// Stores that a primitive is seen at a sample, at the distance `t`, which is rounded by [`stored_t`].
    ///
    /// # Panics
    ///
    /// If the frame does not hold the sample, or has no room for ids that are so wide.
    pub fn set(&mut self, row: usize, column: usize, id: u64, t: f64) {
        let index = self.index(row, column);
        self.ids.set(index, id);
        self.t[index] = stored_t(t);
    }

    /// The ids of all samples, row by row from the top.
    pub fn ids(&self) -> Ids<'_> {
        self.ids.as_ids()
    }

    /// The distances `t` of all samples, in the order of [`Frame::ids`]; +∞ for nothing.
    pub fn distances(&self) -> &[f32] {
        &self.t
    }

    /// Unit normals of what is seen, towards the viewer; zero for nothing. Empty unless
    /// [`Frame::with_normals`] asked for them.
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// The picture: the sRGB bytes of every pixel, row by row from the top; black before shading. A pixel is the
    /// average of its samples, in linear light.
    pub fn picture(&self) -> &[[u8; 3]] {
        &self.picture
    }

    /// Linear red, green and blue of every sample, in the order of [`Frame::ids`]; black before shading. Empty unless
    /// [`Frame::with_colors`] asked for them.
    pub fn colors(&self) -> &[Vec3] {
        &self.colors
    }

    /// Texture coordinates of what is seen, zero where there are none; empty unless
    /// [`Frame::with_texture_coordinates`] asked for them.
    pub fn texture_coordinates(&self) -> &[Vec2] {
        &self.texture_coordinates
    }

    /// How large each sample is on the texture of what is seen: the logarithm to base 2 of texels from a sample to the next, as
    /// the order that shaded the frame finds it (see [`Texture::level`](crate::scene::Texture::level)). Where a surface has
    /// texture coordinates and no texture, a texture of [`LEVELS_OF`] texels is assumed; [`NO_LEVEL`] elsewhere. Empty unless
    /// [`Frame::with_levels`] asked for them.
    pub fn levels(&self) -> &[f32] {
        &self.levels
    }

    /// The indices of a pixel's samples, in [`Frame::ids`] and the other buffers.
    ///
    /// # Panics
    ///
    /// If the frame does not hold the pixel `(i, j)`.
    pub fn samples_of(&self, i: usize, j: usize) -> impl Iterator<Item = usize> + use<> {
        let (n, width) = (self.samples() as usize, self.width());
        let first = self.index(i * n, j * n);
        (0..n * n).map(move |sample| first + sample / n * width + sample % n)
    }

    /// Cuts the frame into tiles of at most so many rows and columns of samples, row by row. The tiles are those of
    /// the whole image; a frame of a crop gets the parts of them that it holds.
    ///
    /// # Panics
    ///
    /// If `rows` or `columns` is 0.
    pub fn tiles_mut(&mut self, rows: usize, columns: usize) -> Vec<Tile<'_>> {
        self.bands_mut(rows).into_iter().flat_map(|band| band.tiles_mut(columns)).collect()
    }

    /// Cuts the frame into bands of at most so many rows of samples, from above, so that several threads can cut them into
    /// tiles. The bands are those of the whole image, as the tiles of [`Frame::tiles_mut`] are.
    ///
    /// # Panics
    ///
    /// If `rows` is 0.
    pub fn bands_mut(&mut self, rows: usize) -> Vec<Band<'_>> {
        let region = &self.region;
        let (ids, t) = (self.ids.bands(region, rows), bands(&mut self.t, region, rows));
        let regions = region.bands(rows);
        regions.zip(ids).zip(t).map(|((region, ids), t)| Band { region, ids, t }).collect()
    }

    /// Cuts the frame into bands of at most so many rows of pixels, from above, for shading.
    ///
    /// # Panics
    ///
    /// If `rows` is 0.
    pub fn shading_bands(&mut self, rows: usize) -> Vec<ShadingBand<'_>> {
        let samples = self.options.samples as usize;
        let (width, high) = (self.width(), rows * samples);
        let size = width * high;
        let Region { rows: all, columns } = self.region.clone();
        let seen = self.ids.as_ids().chunks(size).zip(self.t.chunks(size));
        let mut colors = self.colors.chunks_mut(size);
        let mut normals = self.normals.chunks_mut(size);
        let mut texture_coordinates = self.texture_coordinates.chunks_mut(size);
        let mut levels = self.levels.chunks_mut(size);
        let end = all.end;
        all.step_by(high)
            .zip(seen.zip(self.picture.chunks_mut(width / samples * rows)))
            .map(|(row, ((ids, t), picture))| ShadingBand {
                region: Region { rows: row..end.min(row + high), columns: columns.clone() },
                ids,
                t,
                picture,
                colors: colors.next(),
                normals: normals.next(),
                texture_coordinates: texture_coordinates.next(),
                levels: levels.next(),
            })
            .collect()
    }
}

/// A distance as a frame stores it: the nearest `f32` that is finite and positive, as every `t` is.
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
        let camera = Camera::canonical(7, 5);
        let mut frame = Frame::new(&camera, &Options { samples: 2, ..Options::default() });
        let mut area = 0;
        for tile in frame.tiles_mut(3, 4) {
            area += tile.region.area();
            assert_eq!(tile.t.len(), tile.region.rows.len());
            for row in tile.ids.narrow() {
                assert_eq!(row.len(), tile.region.columns.len());
                row.iter_mut().for_each(|id| *id = id.wrapping_add(1));
            }
        }
        assert_eq!(area, 140);
        assert!(frame.ids().iter().all(|id| id == Some(0)));
    }

    #[test]
    fn tiles_of_a_crop_end_where_those_of_the_whole_do() {
        let crop = Some(Crop { row: 2, column: 5, height: 5, width: 7 });
        let mut frame = Frame::new(&Camera::canonical(9, 20), &Options { samples: 1, crop });
        let mut cells = 0;
        let regions: Vec<_> = frame
            .tiles_mut(4, 8)
            .iter_mut()
            .map(|tile| {
                assert!(tile.t.iter().all(|t| t.len() == tile.region.columns.len()));
                assert_eq!(tile.t.len(), tile.region.rows.len());
                cells += tile.region.area();
                (tile.region.rows.clone(), tile.region.columns.clone())
            })
            .collect();
        assert_eq!(regions, [(2..4, 5..8), (2..4, 8..12), (4..7, 5..8), (4..7, 8..12)]);
        assert_eq!(cells, frame.ids().len());
    }

    #[test]
    fn a_crop_keeps_the_numbers_of_the_whole() {
        let crop = Some(Crop { row: 1, column: 2, height: 1, width: 2 });
        let mut frame = Frame::new(&Camera::canonical(3, 5), &Options { samples: 2, crop });
        assert_eq!((frame.image(), frame.camera_image()), ([2, 1], [5, 3]));
        assert_eq!(frame.pixels().collect::<Vec<_>>(), [[1, 2], [1, 3]]);
        frame.set(3, 6, 9, 1.0);
        assert_eq!(frame.id(3, 6), Some(9));
        assert_eq!(frame.samples_of(1, 3).collect::<Vec<_>>(), [2, 3, 6, 7]);
        assert_eq!(frame.ids().get(6), Some(9));
        let bands = frame.shading_bands(1);
        assert_eq!((bands.len(), bands[0].picture.len(), bands[0].ids.len()), (1, 2, 8));
        assert_eq!(bands[0].region, Region { rows: 2..4, columns: 4..8 });
        let options = Options { samples: 2, crop: None };
        let mut frame = Frame::new(&Camera::canonical(7, 5), &options);
        let bands = frame.shading_bands(3);
        let rows = bands.iter().map(|band| (band.region.rows.clone(), band.picture.len()));
        assert_eq!(rows.collect::<Vec<_>>(), [(0..6, 15), (6..12, 15), (12..14, 5)]);
        assert_eq!((bands[2].ids.len(), bands[2].t.len()), (20, 20));
    }

    #[test]
    #[should_panic(
        expected = "the frame has no sample (1, 4): it holds rows 0..3 and columns 0..4"
    )]
    fn a_column_too_far_is_not_the_first_of_the_next_row() {
        let frame = Frame::new(&Camera::canonical(3, 4), &Options::default());
        let _ = frame.id(1, 4);
    }

    #[test]
    fn options_are_checked_before_a_frame_is_made() {
        let image = [5, 3];
        assert_eq!(Options::default().check(image), Ok(()));
        let message = |options: Options| options.check(image).unwrap_err().to_string();
        let none = message(Options { samples: 0, crop: None });
        assert_eq!(none, "a pixel has 0x0 samples; give at least 1");
        let many = message(Options { samples: 70_000, crop: None });
        assert!(many.starts_with("the image is 5x3 with 70000x70000 samples a pixel"), "{many}");
        let crop = Some(Crop { row: 2, column: 0, height: 2, width: 5 });
        let outside = message(Options { samples: 1, crop });
        assert!(outside.starts_with("the crop 2,0,2,5 ends at pixel (3, 4)"), "{outside}");
    }

    #[test]
    #[should_panic(
        expected = "no frame has these options: a pixel has 0x0 samples; give at least 1"
    )]
    fn a_frame_without_samples_is_refused_for_what_it_lacks() {
        let _ = Frame::new(&Camera::canonical(3, 5), &Options { samples: 0, crop: None });
    }

    #[test]
    fn a_pixel_finds_its_samples() {
        let frame =
            Frame::new(&Camera::canonical(2, 3), &Options { samples: 2, ..Options::default() });
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
