//! Instances of meshes, as the build sorts them. There may be very many, so only their numbers are sorted: their boxes are
//! computed wherever they are asked for, from the scene's maps, and are at hand for some thousand instances at a time.

use super::prim_ref::{PrimRef, Source};
use super::primitives::Primitives;
use crate::fast::prepared::Instanced;
use crate::fast::search::tree::Bounds;
use bothways_common::{Placement, Scene, Shape};
use glam::Vec3;
use rayon::prelude::*;

/// The boxes of all instances of a scene, by the numbers of the instances.
pub(super) struct InstanceBoxes<'a> {
    /// For each object that is instances the number of its first, where they are, and the box of the mesh.
    objects: Vec<(u32, &'a [Placement], [Vec3; 2])>,
    count: u32,
}

impl<'a> InstanceBoxes<'a> {
    pub(super) fn new(scene: &'a Scene, instanced: &[Instanced]) -> InstanceBoxes<'a> {
        let mut boxes = InstanceBoxes { objects: Vec::new(), count: 0 };
        for &Instanced { object, first_number, .. } in instanced {
            let Shape::Instances(instances) = &scene.objects()[object].shape else { continue };
            let Some(of_mesh) = instances.mesh().bounds() else { continue };
            let placements = instances.placements();
            boxes.objects.push((first_number, placements, of_mesh));
            boxes.count =
                first_number + u32::try_from(placements.len()).expect("they are fewer than ids");
        }
        boxes
    }

    /// The numbers of all, in ascending order.
    pub(super) fn numbers(&self) -> Vec<u32> {
        (0..self.count).collect()
    }

    #[inline]
    fn of(&self, number: u32) -> PrimRef {
        let after = self.objects.partition_point(|(first, ..)| *first <= number);
        let (first, placements, of_mesh) = &self.objects[after - 1];
        let [low, high] = placements[(number - first) as usize].bounds(*of_mesh);
        PrimRef::new(&Bounds { low, high }, number)
    }
}

/// Some instances, by their numbers.
pub(super) struct Numbered<'a> {
    pub(super) numbers: &'a mut [u32],
    pub(super) boxes: &'a InstanceBoxes<'a>,
}

impl<'a> Primitives for Numbered<'a> {
    /// 2 MB of boxes. They are divided among all threads.
    const AT_HAND: usize = 1 << 16;
    /// More at a time would be more boxes at hand, and more nodes that wait.
    const TOGETHER: usize = 1;

    type Item = u32;

    fn items(&self) -> &[u32] {
        self.numbers
    }

    fn items_mut(&mut self) -> &mut [u32] {
        self.numbers
    }

    fn boxes(&self) -> impl Fn(&u32) -> PrimRef + Copy + Send + Sync + use<'a> {
        let boxes = self.boxes;
        |number: &u32| boxes.of(*number)
    }

    fn split_at(self, index: usize) -> [Self; 2] {
        let (left, right) = self.numbers.split_at_mut(index);
        [left, right].map(|numbers| Numbered { numbers, boxes: self.boxes })
    }

    fn at_hand<R>(self, build: impl FnOnce(&mut [PrimRef]) -> R) -> R {
        let mut prims: Vec<PrimRef> =
            self.numbers.par_iter().map(|number| self.boxes.of(*number)).collect();
        let built = build(&mut prims);
        for (number, prim) in self.numbers.iter_mut().zip(&prims) {
            *number = prim.id();
        }
        built
    }

    fn distinct(self, _: Source) -> Self {
        self
    }
}
