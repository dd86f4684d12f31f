//! What no box bounds: planes, and spheres that are huge or far from the eye. Every tile looks at all of them.

use super::flat::FlatFunctions;
use crate::fast::answer::Trust;
use crate::fast::camera_map::CameraMap;
use crate::fast::prepared::Prepared;
use crate::fast::search::tile_frustum::TileFrustum;
use crate::fast::viewport_affine::{ROUNDINGS, TileViewport, ViewportAffine};
use bothways_common::Primitive;
use bothways_common::engine::context::Context;
use bothways_common::engine::simd::{Select, Simd, SimdBase, SimdMask, f64x8};

/// The primitives of a scene that are tested without a box, for the rays of one picture.
#[derive(Clone, Debug)]
pub(crate) struct Unbounded {
    /// All of them, with their names, in the order of the scene: planes before spheres.
    pub(crate) primitives: Vec<(u32, Primitive)>,
    /// The planes that can be seen, as indices into the primitives.
    pub(crate) planes: Vec<(usize, FlatFunctions)>,
    /// What else can be seen: spheres, and planes of which the vector path knows nothing.
    pub(crate) others: Vec<usize>,
    keys: Vec<EightKeys>,
}

/// The keys of eight planes, as affine functions of the viewport: at its centre, across, up; and their errors.
#[derive(Clone, Debug, Default)]
struct EightKeys {
    coefficients: [[f64; 8]; 3],
    errors: [[f64; 8]; 3],
    used: u32,
}

/// The least and the greatest key of eight planes in a tile.
struct KeyRanges<S: Simd> {
    least: f64x8<S>,
    greatest: f64x8<S>,
}

impl Unbounded {
    /// Planes, spheres that no box bounds, and those that are so far from the eye that no box can be trusted to hold
    /// them (those are in boxes, too): for rays that are traced alone.
    pub(crate) fn for_rays(prepared: &Prepared, map: &CameraMap) -> Unbounded {
        let eye = map.view.camera.eye().as_dvec3();
        let room = |extent: f32| f64::from(extent) * 30f64.exp2();
        let spheres = prepared.extents.iter();
        let loose = spheres.filter(|(_, extent)| eye.abs().max_element() > room(*extent));
        let ids = prepared.unbounded.iter().chain(loose.map(|(id, _)| id));
        Unbounded {
            primitives: ids.map(|&id| (id, map.view.named(id))).collect(),
            planes: Vec::new(),
            others: Vec::new(),
            keys: Vec::new(),
        }
    }

    /// The same for tiles, too.
    pub(crate) fn for_tiles(prepared: &Prepared, map: &CameraMap) -> Unbounded {
        let mut unbounded = Unbounded::for_rays(prepared, map);
        for (index, (_, primitive)) in unbounded.primitives.iter().enumerate() {
            match FlatFunctions::new(map, primitive) {
                Some(functions) => unbounded.planes.push((index, functions)),
                None if map.view.judge().is_edge_on(primitive) => {}
                None => unbounded.others.push(index),
            }
        }
        unbounded.keys = unbounded.planes.chunks(8).map(EightKeys::new).collect();
        unbounded
    }

    /// How many times eight planes there are.
    pub(crate) fn groups(&self) -> usize {
        self.keys.len()
    }

    /// A key below which nothing is seen in a tile: that of the nearest of all planes that cover all of it, or `far`.
    #[inline(always)]
    pub(crate) fn farthest_key<C: Context>(
        &self,
        context: &C,
        frustum: &TileFrustum,
        far: f32,
    ) -> f64 {
        let (simd, tile) = (context.simd(), TileViewport::new(frustum));
        let (trust, zero) = (Trust::new::<C::Fault>(), f64x8::splat(simd, 0.0));
        let mut farthest = f64x8::splat(simd, f64::from(far));
        for eight in &self.keys {
            let KeyRanges { least, greatest } = eight.on(simd, &tile, trust);
            // In front of the eye keys of a perspective camera are positive, those of a parallel one negative.
            let everywhere = if frustum.template.parallel {
                greatest.simd_lt(zero)
            } else {
                least.simd_gt(zero)
            };
            let nearer = everywhere & least.simd_gt(farthest);
            farthest = nearer.select(least, farthest);
        }
        farthest.to_array().into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Which of eight planes may be seen in a tile, one to a bit: those that are neither behind the eye there, nor have
    /// a key below `farthest`.
    #[inline(always)]
    pub(crate) fn visible<C: Context>(
        &self,
        context: &C,
        frustum: &TileFrustum,
        group: usize,
        farthest: f64,
    ) -> u64 {
        let (simd, tile) = (context.simd(), TileViewport::new(frustum));
        let (eight, zero) = (&self.keys[group], f64x8::splat(simd, 0.0));
        let KeyRanges { least, greatest } = eight.on(simd, &tile, Trust::new::<C::Fault>());
        let behind =
            if frustum.template.parallel { least.simd_gt(zero) } else { greatest.simd_lt(zero) };
        // False for NaN, which lets pass.
        let unseen = behind | greatest.simd_lt(f64x8::splat(simd, farthest));
        !unseen.to_bitmask() & ((1 << eight.used) - 1)
    }
}

impl EightKeys {
    fn new(planes: &[(usize, FlatFunctions)]) -> EightKeys {
        let mut eight = EightKeys::default();
        for (lane, (_, functions)) in planes.iter().enumerate() {
            let ViewportAffine { at_center, across, up, error } = functions.key;
            for (k, coefficient) in [at_center, across, up].into_iter().enumerate() {
                eight.coefficients[k][lane] = coefficient;
                eight.errors[k][lane] = error[k];
            }
            eight.used += 1;
        }
        eight
    }

    /// Their ranges in a tile; [`ViewportAffine::on`] says which bound holds.
    #[inline(always)]
    fn on<S: Simd>(&self, simd: S, tile: &TileViewport, trust: Trust) -> KeyRanges<S> {
        let [at_center, across, up] = self.coefficients.map(|row| f64x8::load_array(simd, row));
        let [of_center, of_x, of_y] = self.errors.map(|row| f64x8::load_array(simd, row));
        let ([x, y], [most_x, most_y], [step_x, step_y]) = (tile.middle, tile.most, tile.step);
        let at_middle = at_center + across * x + up * y;
        let spread = ((across * step_x).abs() + (up * step_y).abs()) * tile.half;
        let error = of_center + of_x * most_x + of_y * most_y;
        let error = error + (at_middle.abs() + spread) * ROUNDINGS;
        let error = match trust {
            Trust::Sound => error,
            Trust::Blind | Trust::None => f64x8::splat(simd, trust.of(0.0)),
        };
        KeyRanges { least: at_middle - spread - error, greatest: at_middle + spread + error }
    }
}
