//! One tile of the picture: its z-buffer, and the loops over a primitive's samples in it.

use super::TILE;
use super::bins::Entry;
use super::depth::{DepthKey, DepthPlane, sign_in_front};
use super::edges::TriangleSetup;
use super::round::{self, Covered};
use super::screen::Screen;
use bothways_common::fault::{Fault, Planted};
use bothways_common::frame::{NO_PRIMITIVE, Region, Tile, stored_t};
use bothways_common::observe::{Observer, Question, Sample};
use bothways_common::predicate::Memory;
use bothways_common::{Judge, Primitive, Projection, Sign, View};

/// Regions wider than this are cut to the span of each row.
const WIDE: usize = 16;

/// The samples of one tile: what is seen so far, and in which interval its depth lies.
#[derive(Debug)]
pub(super) struct TileBuffer {
    region: Region,
    ids: Vec<u32>,
    keys: Vec<DepthKey>,
    memory: Memory,
}

/// What stays the same while one primitive is drawn.
struct Brush<'a, O> {
    id: u32,
    primitive: Primitive,
    view: &'a View<'a>,
    screen: &'a Screen<'a>,
    judge: Judge,
    observer: &'a mut O,
}

impl TileBuffer {
    pub(super) fn new(view: &View) -> Self {
        TileBuffer {
            memory: Memory::new(view.judge()),
            region: Region { rows: 0..0, columns: 0..0 },
            ids: vec![NO_PRIMITIVE; TILE * TILE],
            keys: vec![DepthKey::NOTHING; TILE * TILE],
        }
    }

    /// Starts a tile in which nothing is seen.
    pub(super) fn begin(&mut self, region: &Region) {
        self.region = region.clone();
        self.ids.fill(NO_PRIMITIVE);
        self.keys.fill(DepthKey::NOTHING);
    }

    /// Draws what of a primitive lies in this tile.
    pub(super) fn draw<O: Observer, F: Fault>(
        &mut self,
        entry: &Entry,
        view: &View,
        screen: &Screen,
        observer: &mut O,
    ) {
        let region = entry.region();
        let primitive = view.primitive(entry.id);
        let judge = view.judge();
        let mut brush = Brush { id: entry.id, primitive, view, screen, judge, observer };
        match primitive {
            Primitive::Triangle(corners) => {
                let wide = region.columns.len() > WIDE;
                if let Some(setup) = TriangleSetup::new::<F>(screen, &judge, &corners) {
                    self.draw_triangle::<O, F>(&mut brush, &setup, &region, wide);
                }
            }
            Primitive::Sphere { .. } => self.draw_sphere::<O, F>(&mut brush, &region),
            Primitive::Plane { .. } if self.memory.is_edge_on(entry.id, &primitive) => {}
            Primitive::Plane { point, normal } => {
                let mut depth = DepthPlane::new(screen, point, normal, normal.abs());
                if F::is(Planted::ZeroErrorBound) {
                    depth.error = 0.0;
                }
                self.draw_plane::<O, F>(&mut brush, &depth, &region);
            }
        }
    }

    /// Writes ids and distances into the frame.
    pub(super) fn store(&self, view: &View, screen: &Screen, tile: Tile) {
        let projection = screen.projection();
        let judge = view.judge();
        let width = tile.region.columns.len();
        let lines = tile.ids.into_iter().zip(tile.t);
        for ((row, (ids, t)), buffer) in
            tile.region.rows.zip(lines).zip(self.ids.chunks(TILE).zip(self.keys.chunks(TILE)))
        {
            ids.copy_from_slice(&buffer.0[..width]);
            for (index, (t, key)) in t.iter_mut().zip(buffer.1).enumerate() {
                *t = match ids[index] {
                    NO_PRIMITIVE => f32::INFINITY,
                    id => stored_t(key.t(projection).unwrap_or_else(|| {
                        let ray = screen.grid.ray(row, tile.region.columns.start + index);
                        judge.distance(&view.primitive(id), &ray)
                    })),
                };
            }
        }
    }

    fn draw_triangle<O: Observer, F: Fault>(
        &mut self,
        brush: &mut Brush<O>,
        setup: &TriangleSetup,
        region: &Region,
        wide: bool,
    ) {
        let (xs, ys) = (brush.screen.grid.x(), brush.screen.grid.y());
        let [ab, bc, ca] = &setup.edges;
        let here = region.intersection(&self.region);
        for row in here.rows {
            let y = ys[row];
            let on_row = [ab.on_row(y), bc.on_row(y), ca.on_row(y)];
            let depth_on_row = setup.depth.on_row(y);
            let columns = if wide {
                setup.span(brush.screen, y, &here.columns)
            } else {
                here.columns.clone()
            };
            for column in columns {
                let (x, sample) = (xs[column], Sample { row, column });
                let e = [
                    on_row[0] + x * ab.across,
                    on_row[1] + x * bc.across,
                    on_row[2] + x * ca.across,
                ];
                brush.observer.sample_tested(sample, brush.id);
                let out = e[0] < -ab.error || e[1] < -bc.error || e[2] < -ca.error;
                let inside = e[0] > ab.error && e[1] > bc.error && e[2] > ca.error;
                if out || inside {
                    brush.tell_edges(sample, setup, &e);
                }
                if out || (!inside && !brush.judge_covers::<F>(sample)) {
                    continue;
                }
                let key = setup.depth.key(depth_on_row, x);
                // A perspective ray meets what it covers in front of the eye; a parallel one may not.
                let behind = brush.screen.projection() == Projection::Parallel
                    && (key.high < 0.0
                        || (inside && key.low <= 0.0 && !brush.judge_covers::<F>(sample)));
                if !behind {
                    self.fragment::<O, F>(brush, sample, key);
                }
            }
        }
    }

    fn draw_sphere<O: Observer, F: Fault>(&mut self, brush: &mut Brush<O>, region: &Region) {
        let Primitive::Sphere { center, radius } = brush.primitive else { return };
        let projection = brush.screen.projection();
        let here = region.intersection(&self.region);
        for row in here.rows {
            for column in here.columns.clone() {
                let sample = Sample { row, column };
                let ray = brush.screen.grid.ray(row, column);
                brush.observer.sample_tested(sample, brush.id);
                let exact = !F::is(Planted::ZeroErrorBound);
                match round::covered(projection, center, radius, &ray, exact) {
                    Covered::At(key) => self.fragment::<O, F>(brush, sample, key),
                    Covered::No => {}
                    Covered::Unknown => {
                        if brush.judge_covers::<F>(sample) {
                            self.fragment::<O, F>(brush, sample, DepthKey::UNKNOWN);
                        }
                    }
                }
            }
        }
    }

    fn draw_plane<O: Observer, F: Fault>(
        &mut self,
        brush: &mut Brush<O>,
        depth: &DepthPlane,
        region: &Region,
    ) {
        let side = sign_in_front(brush.screen.projection());
        let (xs, ys) = (brush.screen.grid.x(), brush.screen.grid.y());
        let here = region.intersection(&self.region);
        for row in here.rows {
            let on_row = depth.on_row(ys[row]);
            for column in here.columns.clone() {
                let sample = Sample { row, column };
                let key = depth.key(on_row, xs[column]);
                brush.observer.sample_tested(sample, brush.id);
                // In front of the eye the key has this side's sign, behind it the other.
                let [near, far] =
                    if side > 0.0 { [key.low, key.high] } else { [-key.high, -key.low] };
                if near > 0.0 || (far >= 0.0 && brush.judge_covers::<F>(sample)) {
                    self.fragment::<O, F>(brush, sample, key);
                }
            }
        }
    }

    /// The depth test: keeps the nearer of a fragment and what its sample shows so far.
    fn fragment<O: Observer, F: Fault>(
        &mut self,
        brush: &mut Brush<O>,
        sample: Sample,
        key: DepthKey,
    ) {
        let row = sample.row - self.region.rows.start;
        let index = row * TILE + sample.column - self.region.columns.start;
        let holder = self.ids[index];
        brush.observer.fragment(sample, brush.id);
        if holder != NO_PRIMITIVE {
            let held = self.keys[index];
            let nearer = if key.high < held.low {
                true
            } else if key.low > held.high {
                false
            } else {
                brush.judge_nearer::<F>(&mut self.memory, sample, holder)
            };
            brush.observer.depth_test(sample, brush.id, holder, nearer);
            if !nearer {
                return;
            }
        }
        self.ids[index] = brush.id;
        self.keys[index] = key;
    }
}

impl<O: Observer> Brush<'_, O> {
    /// Asks the judge whether the primitive covers a sample that rounding leaves open.
    #[cold]
    fn judge_covers<F: Fault>(&mut self, sample: Sample) -> bool {
        self.observer.judged(sample, Question::Coverage);
        let ray = self.screen.grid.ray(sample.row, sample.column);
        let coverage = self.judge.coverage(&self.primitive, &ray);
        if let Some(edges) = coverage.edges {
            self.observer.edge_signs(sample, self.id, edges.at_sample.map(Some));
        }
        coverage.covers && !F::is(Planted::StrictComparison)
    }

    /// Asks the judge whether the primitive is seen rather than the one that the sample shows.
    #[cold]
    fn judge_nearer<F: Fault>(&mut self, memory: &mut Memory, sample: Sample, holder: u32) -> bool {
        self.observer.judged(sample, Question::Nearest);
        let ray = self.screen.grid.ray(sample.row, sample.column);
        let held = self.view.primitive(holder);
        if F::is(Planted::TiesToLast) {
            let order = memory.compare((self.id, &self.primitive), (holder, &held), &ray);
            return order.decided.is_le();
        }
        memory.nearer((self.id, &self.primitive), (holder, &held), &ray)
    }

    /// Tells the observer the edges' signs as far as they are certain, in the orientation of the
    /// contract.
    fn tell_edges(&mut self, sample: Sample, setup: &TriangleSetup, e: &[f64; 3]) {
        let certain = |k: usize| {
            let edge = &setup.edges[k];
            (e[k].abs() > edge.error).then(|| Sign::of(setup.facing * e[k]))
        };
        self.observer.edge_signs(sample, self.id, [certain(0), certain(1), certain(2)]);
    }
}
