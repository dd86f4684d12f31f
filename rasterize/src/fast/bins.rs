//! Which tiles a primitive may affect: every tile gets the list of its primitives, in scene order.

use super::screen::{Screen, ScreenVertex};
use super::{Batch, TILE, depth::DepthPlane};
use bothways_common::fault::Fault;
use bothways_common::frame::Region;
use bothways_common::observe::Observer;
use bothways_common::{Primitive, Shape, View};
use rayon::prelude::*;

/// A primitive and the samples that it may cover.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) id: u32,
    rows: [u16; 2],
    columns: [u16; 2],
}

impl Entry {
    /// # Panics
    ///
    /// If the region is empty.
    fn new(id: u32, region: &Region) -> Entry {
        let index = |index: usize| u16::try_from(index).expect("a side has at most 65,536 samples");
        let ends = |range: &std::ops::Range<usize>| [index(range.start), index(range.end - 1)];
        Entry { id, rows: ends(&region.rows), columns: ends(&region.columns) }
    }

    /// The samples that the primitive may cover.
    pub(super) fn region(&self) -> Region {
        let range = |[first, last]: [u16; 2]| usize::from(first)..usize::from(last) + 1;
        Region { rows: range(self.rows), columns: range(self.columns) }
    }

    /// The numbers of the tiles that the region overlaps.
    fn tiles(&self, across: usize) -> impl Iterator<Item = usize> + use<> {
        let tiles = |[first, last]: [u16; 2]| usize::from(first) / TILE..=usize::from(last) / TILE;
        let columns = tiles(self.columns);
        tiles(self.rows)
            .flat_map(move |row| columns.clone().map(move |column| row * across + column))
    }
}

/// The primitives of every tile.
#[derive(Debug)]
pub(super) struct Bins {
    batches: Vec<BatchBins>,
}

/// The primitives of one batch, sorted by tile.
#[derive(Debug)]
struct BatchBins {
    entries: Vec<Entry>,
    /// Where each tile's entries begin, and behind the last tile where they end.
    starts: Vec<u32>,
}

impl Bins {
    /// Runs the vertex stage and finds the bounding region of every primitive.
    pub(super) fn fill<O: Observer, F: Fault>(
        batches: &[Batch],
        view: &View,
        screen: &Screen,
        observer: &mut O,
    ) -> Bins {
        let vertices: Vec<Vec<ScreenVertex>> = view
            .scene
            .objects()
            .iter()
            .map(|object| match &object.shape {
                Shape::Mesh(mesh) => {
                    let place = |p: &_| screen.vertex(view.offset(*p));
                    mesh.positions().par_iter().with_min_len(1024).map(place).collect()
                }
                Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => Vec::new(),
            })
            .collect();
        let seen: &O = observer;
        let (batches, parts): (Vec<BatchBins>, Vec<O>) = batches
            .par_iter()
            .map(|batch| {
                let mut observer = seen.fork();
                let entries = entries::<O, F>(batch, view, screen, &vertices, &mut observer);
                (BatchBins::sort(&entries, screen), observer)
            })
            .unzip();
        parts.into_iter().for_each(|part| observer.join(part));
        Bins { batches }
    }

    /// The primitives that may affect a tile, in scene order.
    pub(super) fn of_tile(&self, tile: usize) -> impl Iterator<Item = &Entry> {
        self.batches.iter().flat_map(move |batch| {
            &batch.entries[batch.starts[tile] as usize..batch.starts[tile + 1] as usize]
        })
    }
}

impl BatchBins {
    /// A counting sort: it keeps the order of entries within a tile.
    fn sort(entries: &[Entry], screen: &Screen) -> BatchBins {
        let across = screen.grid.width().div_ceil(TILE);
        let tiles = across * screen.grid.height().div_ceil(TILE);
        let mut starts = vec![0_u32; tiles + 1];
        for tile in entries.iter().flat_map(|entry| entry.tiles(across)) {
            starts[tile + 1] += 1;
        }
        for tile in 0..tiles {
            starts[tile + 1] += starts[tile];
        }
        let Some(&first) = entries.first() else {
            return BatchBins { entries: Vec::new(), starts };
        };
        let mut sorted = vec![first; starts[tiles] as usize];
        let mut next = starts.clone();
        for entry in entries {
            for tile in entry.tiles(across) {
                sorted[next[tile] as usize] = *entry;
                next[tile] += 1;
            }
        }
        BatchBins { entries: sorted, starts }
    }
}

/// The primitives of a batch that may cover a sample at all.
fn entries<O: Observer, F: Fault>(
    batch: &Batch,
    view: &View,
    screen: &Screen,
    vertices: &[Vec<ScreenVertex>],
    observer: &mut O,
) -> Vec<Entry> {
    let mut entries = Vec::new();
    let objects = view.scene.objects();
    let (mut object, mut local) = view.scene.locate(batch.first_id);
    for id in batch.first_id..batch.first_id + batch.count {
        while local == objects[object].shape.primitive_count() {
            (object, local) = (object + 1, 0);
        }
        let region = match &objects[object].shape {
            Shape::Mesh(mesh) => {
                let vertices = &vertices[object];
                let corners = mesh.triangles()[local].map(|vertex| vertices[vertex as usize]);
                let offsets = || mesh.corners(local).map(|corner| view.offset(corner));
                screen.triangle_region::<F>(&corners, offsets)
            }
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => {
                region::<F>(&view.primitive(id), screen)
            }
        };
        observer.primitive_begun(id, &region);
        if !region.is_empty() {
            entries.push(Entry::new(id, &region));
        }
        local += 1;
    }
    entries
}

fn region<F: Fault>(primitive: &Primitive, screen: &Screen) -> Region {
    match primitive {
        Primitive::Triangle(corners) => {
            let vertices = corners.map(|corner| screen.vertex(corner));
            screen.triangle_region::<F>(&vertices, || *corners)
        }
        Primitive::Sphere { center, radius } => screen.sphere_region::<F>(*center, *radius),
        Primitive::Plane { point, normal } => {
            screen.plane_region(&DepthPlane::new(screen, *point, *normal, normal.abs()))
        }
    }
}
