//! Fragments that the tests of leaves found, each of a tiny triangle that has no other.

use super::leaf_tests::FoundFragments;
use super::tree::LEAF;
use crate::fast::camera_map::CameraMap;
use crate::fast::one_primitive::settle;
use crate::fast::tile::{LARGEST_SIDE, TileBuffer, index};
use bothways_common::engine::context::Context;
use bothways_common::engine::simd::{
    Compression, Simd, SimdFloat, SimdMask, i32x16, mask32x16, u32x16,
};

/// At most this many leaves wait, and are tested before their fragments are.
pub(super) const LEAVES: usize = 8;
/// As many fragments as these have triangles.
const MOST: usize = LEAVES * LEAF;

/// Certain fragments that wait for their depth test.
#[derive(Debug)]
pub(super) struct LeafFragments {
    /// The places of their samples: the row in the tile times its largest side, and the column. Each array has room for sixteen more
    /// behind the last fragment.
    places: [i32; MOST + LEAF],
    /// The ends of their keys.
    low: [f32; MOST + LEAF],
    high: [f32; MOST + LEAF],
    /// The names of their triangles.
    ids: [u32; MOST + LEAF],
    count: usize,
}

impl LeafFragments {
    pub(super) const fn new() -> Self {
        LeafFragments {
            places: [0; MOST + LEAF],
            low: [0.0; MOST + LEAF],
            high: [0.0; MOST + LEAF],
            ids: [0; MOST + LEAF],
            count: 0,
        }
    }

    /// Whether none wait.
    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Adds those fragments of a leaf that were found and whose triangles are `used`.
    #[inline(always)]
    pub(super) fn add<S: Simd>(
        &mut self,
        found: &FoundFragments<S>,
        ids: u32x16<S>,
        used: mask32x16<S>,
    ) {
        let FoundFragments { which, place: [row, column], keys: [low, high] } = *found;
        let which = which & used;
        debug_assert!(self.count <= MOST, "fragments would be lost");
        let from = self.count.min(MOST);
        // Whole numbers that `f32` holds, where there is a fragment.
        let place = (row * LARGEST_SIDE as f32 + column).to_int::<i32x16<S>>();
        let compression = Compression::new(which);
        compression.store(place, &mut self.places[from..from + LEAF]);
        compression.store(low, &mut self.low[from..from + LEAF]);
        compression.store(high, &mut self.high[from..from + LEAF]);
        compression.store(ids, &mut self.ids[from..from + LEAF]);
        self.count = from + which.to_bitmask().count_ones() as usize;
    }

    /// Tests the depth of all fragments, and forgets them.
    #[inline(always)]
    pub(super) fn test_depth<C: Context>(
        &mut self,
        context: &mut C,
        map: &CameraMap,
        tile: &mut TileBuffer,
    ) {
        let count = std::mem::take(&mut self.count).min(MOST);
        let keys = self.low[..count].iter().zip(&self.high[..count]);
        let fragments = self.places[..count].iter().zip(&self.ids[..count]).zip(keys);
        for ((&place, &id), (&low, &high)) in fragments {
            let place = place.cast_unsigned() as usize;
            let at = index(place / LARGEST_SIDE, place);
            tile.fragment(context, at, (0, id), true, [low, high]);
            if tile.has_open() {
                let primitive = tile.names.primitive(&map.view, id);
                settle(&mut context.scalar(), map, &[(id, primitive); 8], tile);
            }
        }
        tile.renew(context.simd());
    }
}

#[cfg(test)]
mod tests {
    use crate::fast::camera_map::CameraMap;
    use crate::fast::one_primitive::unbounded::Unbounded;
    use crate::fast::prepare;
    use crate::fast::search::tile_frustum::FrustumTemplate;
    use crate::fast::search::walk::Walker;
    use crate::fast::tile::TileBuffer;
    use crate::fast::trace::trace_tiles;
    use crate::textbook;
    use bothways_common::engine::fault::Sound;
    use bothways_common::engine::simd::{best_level, levels};
    use bothways_common::glam::Vec3;
    use bothways_common::raster::Region;
    use bothways_common::{Camera, CameraDescription, Frame, Mesh, Options, Scene, Shape, View};

    /// Rows and columns of the picture: those of a tile, and a part of another.
    const ROWS: u32 = 32;
    const COLUMNS: u32 = 48;

    /// A camera that looks along −z at a square of two lengths and something beside it, from this far in front of it.
    fn camera(distance: f32) -> Camera {
        Camera::new(CameraDescription {
            eye: Vec3::new(0.0, 0.0, distance),
            viewport: [3.0, 2.0],
            distance,
            image: [COLUMNS, ROWS],
            ..CameraDescription::default()
        })
        .unwrap()
    }

    /// A surface of this many squares along each side, two triangles each, in the square that the camera looks at, as high as
    /// `height` says, sheared by `shear` and made `times` as large.
    fn surface(squares: u32, [times, shear]: [f32; 2], height: impl Fn(f32, f32) -> f32) -> Mesh {
        let side = squares + 1;
        let along = |k: u32| 2.0 * (k as f32 / squares as f32) - 1.0;
        let places = (0..side * side).map(|k| {
            let (x, y) = (along(k % side), along(k / side));
            Vec3::new(times * (x + shear * y), times * y, height(x, y))
        });
        let of = |k: u32| {
            let a = k / squares * side + k % squares;
            [[a, a + 1, a + side], [a + 1, a + side + 1, a + side]]
        };
        Mesh::new(places.collect(), (0..squares * squares).flat_map(of).collect()).unwrap()
    }

    /// Renders a mesh at all levels of SIMD. Holds every key against that of the judge's distance, which must lie in its
    /// interval, and what is seen against the textbook. Returns how many more samples see something than triangles were set up, at least.
    fn seen_without_set_up(mesh: Mesh, camera: &Camera) -> i64 {
        let scene = Scene::new(vec![Shape::Mesh(mesh).into()]).unwrap();
        let view = View::new(&scene, camera);
        let options = Options::default();
        let mut expected = Frame::new(camera, &options);
        textbook::determine_visibility(&view, &options, &mut expected, &mut ());
        let mut least = i64::MAX;
        for (level, side) in
            levels().into_iter().map(|level| (level, 32)).chain([(best_level(), 16)])
        {
            let prepared = prepare(&scene).drawn_with(level, side);
            let map = CameraMap::new(&view, 1, &prepared.bounds);
            let unbounded = Unbounded::for_tiles(&prepared, &map);
            let mut walker = Walker::new(&prepared, &map, &unbounded);
            let template = FrustumTemplate::new(&map, side);
            let region = Region { rows: 0..ROWS as usize, columns: 0..COLUMNS as usize };
            let mut rows = vec![[0; COLUMNS as usize]; ROWS as usize];
            let mut names: Vec<&mut [u32]> = rows.iter_mut().map(|row| &mut row[..]).collect();
            let mut distances = vec![[0.0; COLUMNS as usize]; ROWS as usize];
            let mut t: Vec<&mut [f32]> = distances.iter_mut().map(|row| &mut row[..]).collect();
            let mut seen = 0;
            let mut check = |tile: &TileBuffer, _: &[&mut [u32]], _: &Region| {
                seen += check_keys(&map, tile, &expected);
            };
            let executed = trace_tiles::<Sound>(
                &mut walker,
                &template,
                &region,
                (&mut names, &mut t),
                &mut check,
            );
            least = least.min(seen - i64::try_from(executed.set_ups).unwrap());
        }
        least
    }

    /// How many samples see something; all see what is expected, with its key in the interval that is stored.
    fn check_keys(map: &CameraMap, tile: &TileBuffer, expected: &Frame) -> i64 {
        let mut seen = 0;
        for at in 0..tile.side() * tile.side() {
            let Some(sample) = tile.sample(at) else { continue };
            let id = (!tile.is_empty_at(at)).then(|| u64::from(tile.ids[at]));
            assert_eq!(id, expected.id(sample.row, sample.column), "{sample:?}");
            let Some(id) = id else { continue };
            let (ray, primitive) =
                (map.grid.ray(sample.row, sample.column), map.view.primitive(id));
            let key = 1.0 / (map.view.judge().distance(&primitive, &ray) * map.depth.scale);
            let [low, high] = [tile.low[at], tile.high[at]].map(f64::from);
            let off = key * 1e-9;
            assert!(low - off <= key && key <= high + off, "{sample:?}: {low} {key} {high}");
            seen += 1;
        }
        seen
    }

    #[test]
    fn fragments_of_tiny_triangles_are_certain() {
        let gentle = |x: f32, y: f32| 0.006 * (7.0 * x).sin() * (5.0 * y).cos();
        let waves = |x: f32, y: f32| 0.3 * (7.0 * x).sin() * (5.0 * y).cos() - 0.5;
        let steep = |x: f32, y: f32| 3.0 * x - 2.0 * y + 0.1 * (40.0 * x).sin() - 8.0;
        for (squares, distance, height, least) in [
            (120, 2.0, gentle as fn(f32, f32) -> f32, 800),
            // Keys change so much from sample to sample that they are not known well enough.
            (120, 2.0, waves, -100),
            (120, 2.0, steep, -100),
            (120, 30.0, waves, 400),
            (120, 4000.0, waves, 700),
            (120, 4000.0, steep, 700),
            // Two samples lie between the corners of some, and one of them in another tile.
            (29, 4000.0, waves, 0),
            (31, 2.0, gentle, 0),
        ] {
            let found =
                seen_without_set_up(surface(squares, [1.0, 0.3], height), &camera(distance));
            assert!(found > least, "{found} of {squares} at {distance}");
        }
    }

    #[test]
    fn nothing_is_certain_at_samples_on_edges_and_corners() {
        // So many times as far as the viewport, and as large. Samples lie at the middles of pixels, which are corners of some of these
        // squares, or on their diagonals; roundings put them to either side.
        for times in [1.0, 3.0, 7.0, 49.0] {
            for squares in [64, 128] {
                let surface = surface(squares, [times, 0.0], |_, _| 2.0 - 2.0 * times);
                let found = seen_without_set_up(surface, &camera(2.0));
                assert!(squares != 64 || found < 0, "{found} corners are inside of triangles");
            }
        }
    }

    #[test]
    fn slivers_and_layers_are_as_in_the_textbook() {
        let mut random = fastrand::Rng::with_seed(22);
        for round in 0..6 {
            let length = [0.05, 0.01, 0.2][round % 3];
            let mut places = Vec::new();
            for _ in 0..6000 {
                let mut number = |size: f32| size * (2.0 * random.f32() - 1.0);
                let middle = Vec3::new(number(1.0), number(1.0), number(0.01));
                let along = Vec3::new(number(length), number(length), number(length));
                let across = along.cross(Vec3::new(number(1.0), number(1.0), number(1.0)));
                places.extend([middle, middle + along, middle + across * (0.1 + number(0.1))]);
            }
            // Some are there twice.
            let triangles =
                (0..6000_u32).chain(0..200).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            let mesh = Mesh::new(places, triangles).unwrap();
            seen_without_set_up(mesh, &camera(3.0));
        }
    }
}
