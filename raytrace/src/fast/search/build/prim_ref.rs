//! The input of the build: references to primitives, each with its box and id.

use crate::fast::search::tree::Bounds;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdMask, SimdSplit, f32x4, f32x8, mask32x4,
};
use bothways_common::{Mesh, Plane, Scene, Shape, Sphere, Triangle};
use glam::Vec3;
use rayon::prelude::*;

/// A box, as −low x, y, z, a lane without meaning, high x, y, z, and another: the box around several boxes is the
/// maximum of each lane.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
pub(super) struct Box8(pub(super) [f32; 8]);

impl Box8 {
    pub(super) const EMPTY: Box8 = Box8([f32::NEG_INFINITY; 8]);

    #[inline(always)]
    pub(super) fn lanes<S: Simd>(&self, simd: S) -> f32x8<S> {
        f32x8::load_array_ref(simd, &self.0)
    }

    /// The box around this one and another.
    #[inline(always)]
    pub(super) fn union(&self, other: &Box8) -> Box8 {
        Box8(std::array::from_fn(|lane| self.0[lane].max(other.0[lane])))
    }

    pub(super) fn bounds(&self) -> Bounds {
        let [x, y, z, _, high @ .., _] = self.0;
        Bounds { low: -Vec3::new(x, y, z), high: high.into() }
    }

    /// Half of the surface area: proportional to the chance that a ray meets the box. In `f64`, where
    /// no finite box overflows.
    #[inline(always)]
    pub(super) fn half_area(&self) -> f64 {
        let of = |axis: usize| (f64::from(self.0[4 + axis]) + f64::from(self.0[axis])).max(0.0);
        half_area_of_sides([of(0), of(1), of(2)])
    }
}

/// Half of the surface area of a box with these sides.
#[inline(always)]
pub(super) fn half_area_of_sides([x, y, z]: [f64; 3]) -> f64 {
    x * y + y * z + z * x
}

/// A primitive during the build: its box, and the bits of its id in the fourth lane.
#[derive(Clone, Copy)]
pub(super) struct PrimRef(pub(super) Box8);

impl PrimRef {
    pub(super) fn new(bounds: &Bounds, id: u32) -> PrimRef {
        // Adding 0 makes −0 and 0 equal, of which a maximum may be either.
        let ([x, y, z], [u, v, w]) =
            ((-(bounds.low + 0.0)).to_array(), (bounds.high + 0.0).to_array());
        PrimRef(Box8([x, y, z, f32::from_bits(id), u, v, w, 0.0]))
    }

    pub(super) fn id(&self) -> u32 {
        self.0.0[3].to_bits()
    }

    /// The centre of the box, computed from halves, so that it is finite. The lane of the id is left out: most ids
    /// are denormal numbers, and multiplying denormal numbers takes a hundred times as long.
    #[inline(always)]
    pub(super) fn center<S: Simd>(&self, simd: S) -> f32x4<S> {
        let (low, high) = self.0.lanes(simd).split();
        let is_axis = mask32x4::from_bitmask(simd, 0b0111);
        let low = is_axis.select(low, f32x4::splat(simd, 0.0));
        high * 0.5 - low * 0.5
    }
}

/// The primitives of a scene but instances, sorted by kind and by whether a box can bound them.
#[derive(Default)]
pub(super) struct Collected {
    pub(super) triangles: Vec<PrimRef>,
    pub(super) spheres: Vec<PrimRef>,
    pub(super) unbounded: Vec<u32>,
    /// The ids of the spheres, and the extent of each; see [`sphere`].
    pub(super) extents: Vec<(u32, f32)>,
}

pub(super) fn collect(scene: &Scene) -> Collected {
    let mut all = Collected::default();
    let triangles = scene.objects().iter().map(|object| match &object.shape {
        Shape::Triangle(_) => 1,
        Shape::Mesh(mesh) => mesh.triangles().len(),
        Shape::Sphere(_) | Shape::Plane(_) | Shape::Instances(_) => 0,
    });
    all.triangles.reserve_exact(triangles.sum());
    for (index, object) in scene.objects().iter().enumerate() {
        let first_id = scene.first_name(index);
        match &object.shape {
            Shape::Triangle(Triangle { a, b, c }) => {
                all.triangles.push(triangle(first_id, [*a, *b, *c]));
            }
            Shape::Mesh(mesh) => {
                let triangles = mesh.triangles().par_iter().zip(first_id..u32::MAX);
                all.triangles.par_extend(
                    triangles.map(|(corners, id)| triangle(id, mesh_corners(mesh, corners))),
                );
            }
            // These are collected where their hierarchy is built.
            Shape::Instances(_) => {}
            Shape::Sphere(shape) => match sphere(first_id, shape) {
                Some((prim, extent)) => {
                    all.spheres.push(prim);
                    all.extents.push((first_id, extent));
                }
                None => all.unbounded.push(first_id),
            },
            Shape::Plane(Plane { .. }) => all.unbounded.push(first_id),
        }
    }
    all
}

/// The triangles of a mesh that instances share, by their numbers.
pub(super) fn triangles_of(mesh: &Mesh) -> Vec<PrimRef> {
    let triangles = mesh.triangles().par_iter().zip(0..u32::MAX);
    triangles.map(|(corners, number)| triangle(number, mesh_corners(mesh, corners))).collect()
}

pub(super) fn mesh_corners(mesh: &Mesh, corners: &[u32; 3]) -> [Vec3; 3] {
    corners.map(|vertex| mesh.positions()[vertex as usize])
}

/// The bits of the coordinates of a place. Adding 0 makes −0 and 0 equal.
pub(super) fn place_bits(place: Vec3) -> [u32; 3] {
    (place + 0.0).to_array().map(f32::to_bits)
}

pub(super) fn triangle(id: u32, [a, b, c]: [Vec3; 3]) -> PrimRef {
    PrimRef::new(&Bounds { low: a.min(b).min(c), high: a.max(b).max(c) }, id)
}

/// A sphere in its box, and its extent `e = max|center| + radius`; `None` if a corner of the box is
/// not finite.
///
/// A sphere is judged by its rounded offset from the eye, and so is each side of its box: a vertex is
/// a side's coordinate or lies within, and stays within, but `center ± radius` was never stored. The
/// box is therefore wider by 2⁻¹⁸·e. That is more than all roundings of the offsets (and of the box
/// itself) as long as the eye is nearer to the origin than 2³⁰·e: two of at most 2⁻²³·e each, and 2⁻²¹·e.
/// The walk tests spheres without their boxes, too, when the eye is farther.
pub(super) fn sphere(id: u32, &Sphere { center, radius }: &Sphere) -> Option<(PrimRef, f32)> {
    let extent = center.abs().max_element() + radius;
    let half = Vec3::splat(radius + (-18f32).exp2() * extent);
    let bounds = Bounds { low: center - half, high: center + half };
    let finite = bounds.low.is_finite() && bounds.high.is_finite();
    // Below this extent, the margin itself would underflow.
    let representable = extent > (-100f32).exp2();
    (finite && representable).then(|| (PrimRef::new(&bounds, id), extent))
}

/// Finds the corners of triangles; this is fast in the order of the scene.
pub(super) struct CornerReader<'a> {
    source: Source<'a>,
    /// The ids of the triangles that were found last, and where they are.
    ids: std::ops::Range<u32>,
    among: Among<'a>,
}

/// What the triangles of a hierarchy are triangles of.
#[derive(Clone, Copy)]
pub(super) enum Source<'a> {
    /// A scene: ids are those of primitives.
    Scene(&'a Scene),
    /// A mesh: ids are numbers of triangles.
    Mesh(&'a Mesh),
}

enum Among<'a> {
    Mesh(&'a Mesh),
    One([Vec3; 3]),
}

impl<'a> CornerReader<'a> {
    pub(super) fn new(source: Source<'a>) -> Self {
        CornerReader { source, ids: 0..0, among: Among::One([Vec3::ZERO; 3]) }
    }

    #[inline]
    pub(super) fn of(&mut self, id: u32) -> [Vec3; 3] {
        self.find(id);
        match self.among {
            Among::Mesh(mesh) => {
                mesh_corners(mesh, &mesh.triangles()[(id - self.ids.start) as usize])
            }
            Among::One(corners) => corners,
        }
    }

    /// The mesh of which some triangles are all, and the id of its first triangle; `None` if there is no such mesh.
    #[inline]
    pub(super) fn mesh_of(&mut self, prims: &[PrimRef]) -> Option<(&'a Mesh, u32)> {
        self.find(prims[0].id());
        let Among::Mesh(mesh) = self.among else { return None };
        prims.iter().all(|prim| self.ids.contains(&prim.id())).then_some((mesh, self.ids.start))
    }

    /// Finds the triangles around one.
    #[inline]
    fn find(&mut self, id: u32) {
        if !self.ids.contains(&id) {
            (self.ids, self.among) = self.source.around(id);
        }
    }
}

impl<'a> Source<'a> {
    /// The triangles around one, and their ids.
    #[cold]
    fn around(self, id: u32) -> (std::ops::Range<u32>, Among<'a>) {
        let ids = |first: u32, mesh: &Mesh| {
            first..first + u32::try_from(mesh.triangles().len()).expect("ids are u32")
        };
        let scene = match self {
            Source::Scene(scene) => scene,
            Source::Mesh(mesh) => return (ids(0, mesh), Among::Mesh(mesh)),
        };
        let (object, _) = scene.locate_name(id);
        let first = scene.first_name(object);
        match &scene.objects()[object].shape {
            Shape::Mesh(mesh) => (ids(first, mesh), Among::Mesh(mesh)),
            Shape::Triangle(Triangle { a, b, c }) => (id..id + 1, Among::One([*a, *b, *c])),
            Shape::Sphere(_) | Shape::Plane(_) | Shape::Instances(_) => {
                unreachable!("leaves of triangles hold triangles")
            }
        }
    }
}
