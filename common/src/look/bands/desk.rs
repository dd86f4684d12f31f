//! What a thread works with while it shades: the samples of a chunk, and the primitives that are seen there.

use super::chunk::{Chunk, MOST_OF_BLOCK, Vectors, WIDE};
use super::found::Found;
use super::local::{LocalVector, MOST_LIGHTS};
use super::runs::{Ends, Groups, NOTHING, Run, Runs};
use super::surfaces::{EightTriangles, Seen, SetUp, Surfaces, Wanted};
use crate::engine::simd::{Simd, apart};
use crate::frame::{Ids, NO_PRIMITIVE, NO_WIDE_PRIMITIVE};
use crate::look::shade::Finish;
use crate::scene::material::Material;
use crate::view::View;
use glam::Vec3;
use std::collections::HashMap;

/// The hashes of ids under which visible primitives are kept: those of a row are mostly seen in the next one, too.
const HASHES: usize = 1 << HASH_BITS;
const HASH_BITS: u32 = 12;
/// With this many primitives kept, a new block begins with none.
const MANY_KEPT: usize = HASHES;

/// The surfaces to set up, and what is needed of them.
pub(super) struct Setting<'a, A> {
    pub(super) view: &'a View<'a>,
    pub(super) surfaces: &'a A,
    pub(super) wanted: Wanted<'a>,
}

/// Short names of wide ids: their numbers among those that are kept.
#[derive(Default)]
struct Names {
    ids: Vec<u64>,
    names: HashMap<u64, u32>,
    /// Those of the samples of a chunk.
    of_chunk: Vec<u32>,
}

/// A name, and its place in what is kept: one number, so that the machine chooses between two of them without a branch.
#[derive(Clone, Copy)]
struct NamedPlace(u64);

impl NamedPlace {
    /// That of no primitive.
    const NONE: NamedPlace = NamedPlace(NO_PRIMITIVE as u64);

    #[inline(always)]
    fn new(name: u32, place: u32) -> NamedPlace {
        NamedPlace(u64::from(place) << 32 | u64::from(name))
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "the lower half")]
    fn name(self) -> u32 {
        self.0 as u32
    }

    #[inline(always)]
    fn place(self) -> u32 {
        (self.0 >> 32) as u32
    }
}

/// The names of primitives that a block shows and that are not kept. Each run adds one at most, and no block has more runs than samples.
struct NewNames {
    names: Box<[u32; MOST_OF_BLOCK]>,
    count: u32,
}

impl NewNames {
    fn new() -> NewNames {
        NewNames { names: Box::new([0; MOST_OF_BLOCK]), count: 0 }
    }

    fn names(&self) -> &[u32] {
        &self.names[..self.count as usize]
    }
}

/// What a thread works with. It decides no bit of the result.
pub(super) struct Desk<'a, A: Surfaces> {
    /// For each hash, the id that came last, and its place in `kept`; of wide ids, their names.
    places: Box<[NamedPlace; HASHES]>,
    names: Names,
    pub(super) kept: Vec<Kept<'a, A::Local>>,
    /// The ways to the points of light from those of them whose look is local.
    pub(super) ways: Vec<LocalVector>,
    /// The surfaces of those whose look is not local.
    pub(super) surfaces: Vec<KeptSurface<A::Surface>>,
    /// Whether the `t` of samples matter to any of these.
    pub(super) looks_at_t: bool,
    /// The names of those that come next in `kept`, and are not set up yet.
    new: NewNames,
    /// Their ids.
    new_ids: Vec<u64>,
    pub(super) chunk: Box<Chunk>,
    /// The ways from the samples of the chunk to each point of light, of any length.
    pub(super) to_lights: Vec<Vectors>,
    ends: Box<Ends>,
    pub(super) runs: Runs,
    /// The samples of the chunk that is looked at, in groups of one material each.
    pub(super) groups: Groups<'a>,
    /// The look of the material that came last.
    pub(super) finish: Option<Finish<'a>>,
    /// Of each pixel of the row, the sum over its samples; none where a pixel has one sample.
    pub(super) sums: Vec<Vec3>,
}

/// A primitive that is set up, in whole lines of the caches.
#[repr(align(64))]
pub(super) struct Kept<'a, L> {
    pub(super) material: &'a Material,
    pub(super) look: KeptLook<L>,
}

pub(super) enum KeptLook<L> {
    /// A triangle of which nothing but its normals and ways to lights is wanted; the place of the first way.
    Local { look: L, ways: u32 },
    /// The place of anything else among the surfaces.
    Surface(u32),
}

pub(super) struct KeptSurface<T> {
    pub(super) surface: T,
    /// Whether its samples have a tint each.
    pub(super) is_tinted: bool,
}

impl<'a, A: Surfaces> Desk<'a, A> {
    /// With room for the sums of so many pixels, and the ways to so many points of light.
    pub(super) fn new(sums: usize, lights: usize) -> Self {
        Desk {
            places: Box::new([NamedPlace::NONE; HASHES]),
            names: Names::default(),
            kept: Vec::new(),
            ways: Vec::new(),
            surfaces: Vec::new(),
            looks_at_t: false,
            new: NewNames::new(),
            new_ids: Vec::new(),
            chunk: Box::new(Chunk::new()),
            to_lights: vec![[[0.0; WIDE]; 3]; lights],
            ends: Box::new(Ends::new()),
            runs: Runs::new(),
            groups: Groups::default(),
            finish: None,
            sums: vec![Vec3::ZERO; sums],
        }
    }

    /// Begins a block of chunks: forgets the runs, and all that is kept if that is much.
    pub(super) fn begin_block(&mut self) {
        if self.kept.len() >= MANY_KEPT {
            self.forget();
        }
        self.runs.clear();
    }

    /// Finds the runs of a chunk. Their primitives are to be set up by [`Desk::set_up_new`], unless they are kept.
    #[inline(always)]
    pub(super) fn find_runs<S: Simd>(&mut self, simd: S, ids: Ids) {
        match ids {
            _ if is_nothing(ids) => self.runs.add(1)[0] = Run::of_nothing(ids.len()),
            Ids::Narrow(ids) => self.find_runs_of(simd, ids),
            Ids::Wide(ids) => self.find_wide_runs(simd, ids),
        }
    }

    #[inline(always)]
    fn find_runs_of<S: Simd>(&mut self, simd: S, ids: &[u32]) {
        self.ends.find(simd, ids);
        let Desk { ends, runs, places, new, .. } = self;
        // Without a branch: whether a primitive is new, the machine would guess wrong for one in a few.
        let (first, mut count) = (number(self.kept.len()), new.count);
        for (run, (name, end)) in runs.add(ends.count()).iter_mut().zip(ends.iter()) {
            let is_nothing = name == NO_PRIMITIVE;
            let kept = places[hash(name)];
            let is_new = !is_nothing & (kept.name() != name);
            let place = if is_new { NamedPlace::new(name, first + count) } else { kept };
            places[hash(name)] = place;
            new.names[count as usize] = name;
            count += u32::from(is_new);
            *run = Run::new(end, if is_nothing { NOTHING } else { place.place() });
        }
        new.count = count;
    }

    /// The runs of wide ids are those of names for them.
    #[inline(always)]
    fn find_wide_runs<S: Simd>(&mut self, simd: S, ids: &[u64]) {
        let named = self.names_of(ids);
        self.find_runs_of(simd, &named);
        // The next chunk uses the same memory.
        self.names.of_chunk = named;
    }

    fn forget(&mut self) {
        self.kept.clear();
        self.ways.clear();
        self.surfaces.clear();
        self.looks_at_t = false;
        self.places.fill(NamedPlace::NONE);
        self.names.ids.clear();
        self.names.names.clear();
    }

    /// Names for the wide ids of a chunk. They are kept with the primitives.
    #[cold]
    fn names_of(&mut self, ids: &[u64]) -> Vec<u32> {
        let Names { ids: known, names, of_chunk } = &mut self.names;
        let mut name_of = |id: u64| {
            *names.entry(id).or_insert_with(|| {
                known.push(id);
                number(known.len() - 1)
            })
        };
        let mut named = std::mem::take(of_chunk);
        named.clear();
        named.extend(ids.iter().map(|&id| match id {
            NO_WIDE_PRIMITIVE => NO_PRIMITIVE,
            id => name_of(id),
        }));
        named
    }

    /// Sets up the primitives that are new: those of one object that follow one another at once.
    #[inline(always)]
    pub(super) fn set_up_new<S: Simd>(&mut self, simd: S, setting: &Setting<'a, A>) {
        let scene = setting.view.scene;
        let mut ids = std::mem::take(&mut self.new_ids);
        ids.clear();
        let known = scene.has_wide_ids().then_some(&self.names.ids);
        ids.extend(
            self.new
                .names()
                .iter()
                .map(|&name| known.map_or(u64::from(name), |known| known[name as usize])),
        );
        let mut rest = &ids[..];
        while let Some(&first) = rest.first() {
            let found = Found::of(scene, first, setting.wanted);
            let count = rest.iter().take_while(|id| found.has(**id)).count();
            let (these, others) = rest.split_at(count);
            self.set_up_found(simd, setting, &found, these);
            rest = others;
        }
        self.new.count = 0;
        self.new_ids = ids;
    }

    /// Sets up some primitives of one object.
    ///
    /// All are set up before the first is used, and the machine is asked for their indices before that, and for the corners of eight
    /// while the eight before them are set up: so the memory that they lie in is fetched for several at once.
    #[inline(always)]
    fn set_up_found<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'a, A>,
        found: &Found<'a>,
        ids: &[u64],
    ) {
        let mut corners = [[[0.0; 8]; 3]; 6];
        ids.iter().for_each(|id| found.prefetch_indices(*id));
        ids.iter().take(8).for_each(|id| found.prefetch_corners(*id));
        for start in (0..ids.len()).step_by(8) {
            let (eight, soon) = ids[start..].split_at(8.min(ids.len() - start));
            soon.iter().take(8).for_each(|id| found.prefetch_corners(*id));
            // Vectors are not worth it for one or two.
            if eight.len() > 2 && found.read(eight, &mut corners) {
                apart!(simd, self.set_up_eight(simd, setting, found, (eight, &corners)));
            } else {
                eight.iter().for_each(|id| self.set_up(setting, found, *id));
            }
        }
    }

    #[inline(always)]
    fn set_up_eight<S: Simd>(
        &mut self,
        simd: S,
        setting: &Setting<'a, A>,
        found: &Found<'a>,
        (ids, corners): (&[u64], &[[[f32; 8]; 3]; 6]),
    ) {
        let triangles = EightTriangles::new(simd, setting.view, corners, ids.len());
        let mut ids = ids.iter();
        setting.surfaces.set_up_eight(&triangles, setting.wanted, |look, ways| {
            let Some(&id) = ids.next() else { return };
            match look {
                Some(look) => {
                    self.keep_local(look, &ways[..setting.wanted.lights.len()], found.material(id));
                }
                None => self.set_up(setting, found, id),
            }
        });
    }

    #[inline(never)]
    fn set_up(&mut self, setting: &Setting<'a, A>, found: &Found<'a>, id: u64) {
        let (object, local, material) = (found.object, found.local(id), found.material(id));
        let primitive = setting.view.primitive_of(&object.shape, local);
        let seen = Seen { id, primitive, object, local, material };
        let mut ways = [LocalVector::default(); MOST_LIGHTS];
        match setting.surfaces.set_up(&seen, setting.wanted, &mut ways) {
            SetUp::Local(look) => {
                self.keep_local(look, &ways[..setting.wanted.lights.len()], material);
            }
            SetUp::Surface(surface) => {
                self.looks_at_t |= setting.surfaces.looks_at_t(&surface);
                let look = KeptLook::Surface(number(self.surfaces.len()));
                self.surfaces.push(KeptSurface { surface, is_tinted: seen.is_tinted() });
                self.kept.push(Kept { material, look });
            }
        }
    }

    #[inline(always)]
    fn keep_local(&mut self, look: A::Local, ways: &[LocalVector], material: &'a Material) {
        let look = KeptLook::Local { look, ways: number(self.ways.len()) };
        self.kept.push(Kept { material, look });
        // Without points of light, nothing is to be done for each triangle.
        if !ways.is_empty() {
            self.ways.extend_from_slice(ways);
        }
    }
}

/// Where the place of a primitive with this name stands.
#[inline(always)]
fn hash(name: u32) -> usize {
    // The golden ratio of 2³² spreads neighbours best (Knuth, "The Art of Computer Programming", 6.4).
    (name.wrapping_mul(0x9e37_79b9) >> (u32::BITS - HASH_BITS)) as usize
}

/// A place among what is kept.
#[inline(always)]
fn number(place: usize) -> u32 {
    u32::try_from(place).expect("few are kept")
}

/// Whether nothing is seen at any of some samples.
#[inline(always)]
fn is_nothing(ids: Ids) -> bool {
    // Without a branch for each sample, vectors compare them.
    match ids {
        Ids::Narrow(ids) => are_all(ids, NO_PRIMITIVE),
        Ids::Wide(ids) => are_all(ids, NO_WIDE_PRIMITIVE),
    }
}

#[inline(always)]
fn are_all<T: Copy + PartialEq>(ids: &[T], one: T) -> bool {
    ids.chunks(64).all(|ids| ids.iter().fold(true, |all, &id| all & (id == one)))
}
