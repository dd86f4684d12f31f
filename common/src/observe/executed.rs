//! What the loops of a fast renderer executed for a frame.

use std::iter::Sum;
use std::ops::AddAssign;

/// What the loops of a fast renderer executed for one frame, tile by tile, with all that they shared and skipped.
///
/// The other sort of count is [`Work`](super::Work): what every primitive or ray needs *alone*, which is a property of
/// the algorithm and the scene. These counts belong to the frame as it was drawn. The drawing code itself counts, so
/// that they explain its time.
///
/// They depend on the scene, the camera, the crop and the size of the tiles; neither on the number of threads, as every
/// tile is drawn alone, nor on the SIMD level, as a batch has sixteen lanes (or eight) on every machine. A counter that
/// an order does not have stays 0 in it.
///
/// For an observer, object order draws hidden clusters as well: only a frame with the observer `()` has the counts of a
/// frame that is timed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Executed {
    /// Both orders: tiles of the frame, as far as they are drawn.
    pub tiles: u64,
    /// Both orders: tiles without any set-up or primitive drawn one by one, because binning (object order) or the walk
    /// (image order) found nothing for them.
    pub tiles_skipped: u64,
    /// Image order: nodes of the hierarchy that tiles opened. A node counts once for each tile that opens it.
    pub nodes_opened: u64,
    /// Both orders: boxes that were tested. In object order boxes of clusters against the raster, each once a frame; in
    /// image order all boxes of an opened node against the frustum of the tile.
    pub boxes_tested: u64,
    /// Image order: leaves of triangles that tiles opened. A leaf counts once for each tile that opens it.
    pub leaves_opened: u64,
    /// Object order: primitives that binning entered one by one, because they are in no cluster or in one that spreads
    /// over many tiles.
    pub binned: u64,
    /// Object order: clusters that came to tiles. A cluster counts once for each tile.
    pub clusters: u64,
    /// Object order: those of the clusters that were skipped, because the tile already showed something certainly
    /// nearer wherever they lie.
    pub clusters_skipped: u64,
    /// Both orders: triangles that tiles looked at, each once for each tile. In object order those of clusters that are
    /// not skipped and those of the tile's lists; in image order those of opened leaves, without duplicates.
    pub triangles: u64,
    /// Both orders: those of the triangles that were set up, in lanes: sixteen at a time in object order, eight in image
    /// order, where the test of a leaf finds the fragments of many tiny triangles without that.
    pub set_ups: u64,
    /// Both orders: primitives drawn one by one in `f64`, each once for each tile. Spheres, planes, and triangles whose
    /// set-up in lanes was too uncertain; in object order also those that are large or reach behind the eye.
    pub one_by_one: u64,
    /// Both orders: steps of batches of small triangles. In one step every triangle of a batch (of sixteen in object
    /// order, of eight in image order) is tested at one of its samples. In object order also those of thin triangles: in
    /// one step sixteen rows of a triangle are each tested at one sample.
    pub lane_steps: u64,
    /// Both orders: blocks of sixteen samples at which one triangle, plane or sphere was tested at once.
    pub blocks: u64,
    /// Both orders: samples at which primitives drawn one by one were tested in `f64`, one sample at a time.
    pub single_samples: u64,
}

impl Executed {
    /// What was executed for one tile, as a part of a frame: counts the tile as well.
    #[must_use]
    pub fn of_one_tile(self) -> Executed {
        let is_skipped = self.set_ups + self.one_by_one == 0;
        Executed { tiles: 1, tiles_skipped: u64::from(is_skipped), ..self }
    }
}

impl AddAssign for Executed {
    fn add_assign(&mut self, part: Executed) {
        self.tiles += part.tiles;
        self.tiles_skipped += part.tiles_skipped;
        self.nodes_opened += part.nodes_opened;
        self.boxes_tested += part.boxes_tested;
        self.leaves_opened += part.leaves_opened;
        self.binned += part.binned;
        self.clusters += part.clusters;
        self.clusters_skipped += part.clusters_skipped;
        self.triangles += part.triangles;
        self.set_ups += part.set_ups;
        self.one_by_one += part.one_by_one;
        self.lane_steps += part.lane_steps;
        self.blocks += part.blocks;
        self.single_samples += part.single_samples;
    }
}

impl Sum for Executed {
    fn sum<I: Iterator<Item = Executed>>(parts: I) -> Executed {
        parts.fold(Executed::default(), |mut sum, part| {
            sum += part;
            sum
        })
    }
}
