//! Short names of primitives: 32 bits for what a renderer stores and moves at every sample, however many ids a scene has.
//!
//! Where ids fit into 32 bits, a name is an id. Otherwise, the primitives that are not of instances have names for good
//! ([`Scene::first_name`]), and instances get theirs where they are drawn: the triangles of one have names one after another.
//! A tile shows few primitives, so names that are no longer seen are given anew. So the loops over samples are the same
//! for all scenes; only ties, the judge and the finished tile ask which id a name stands for.

use crate::scene::{Primitive, Scene, Shape};
use crate::view::View;

/// So many more instances may get names before names are given anew.
const MANY: usize = 1 << 14;

/// The names that one thread uses for the primitives of a scene.
#[derive(Clone, Debug)]
pub struct Names {
    /// Names below this one are the scene's own; all, if they are ids.
    own: u32,
    /// Names one after another that stand for ids one after another, in ascending order: the first name, and its id. Those of
    /// the scene come first, then a range for each instance that has names. Empty if names are ids.
    ranges: Vec<(u32, u64)>,
    own_ranges: usize,
    /// The next name that may be given.
    next: u32,
    /// When that is beyond this one, or there are so many ranges, names must be given anew.
    last_next: u32,
    most_ranges: usize,
}

impl Names {
    /// Names for a scene. No instance has names yet.
    pub fn new(scene: &Scene) -> Names {
        if !scene.has_wide_ids() {
            let [own, last_next] = [u32::MAX; 2];
            let (ranges, next, most_ranges) = (Vec::new(), 0, usize::MAX);
            return Names { own, ranges, own_ranges: 0, next, last_next, most_ranges };
        }
        let triangles = scene.objects().iter().map(|object| match &object.shape {
            Shape::Instances(instances) => instances.mesh().triangles().len(),
            _ => 0,
        });
        let largest = triangles.max().unwrap_or(0);
        // The last number is that of no primitive.
        let last_next =
            u32::try_from(u32::MAX as usize - 1 - largest).expect("scenes have a limit");
        let ranges = own_ranges(scene);
        let (own, own_ranges) = (scene.name_count(), ranges.len());
        let most_ranges = own_ranges + MANY;
        Names { own, ranges, own_ranges, next: own, last_next, most_ranges }
    }

    /// The first name of the triangles of an instance, of which there are so many; `first_id` is the first one's id.
    ///
    /// Unless names are ids, [`Names::are_used_up`] is to be asked before.
    #[inline]
    pub fn of_instance(&mut self, first_id: u64, triangles: u32) -> u32 {
        if self.own == u32::MAX {
            return u32::try_from(first_id).expect("names are ids");
        }
        let first_name = self.next;
        self.ranges.push((first_name, first_id));
        self.next += triangles;
        first_name
    }

    /// Whether [`Names::give_anew`] must come before the next instance gets names.
    #[inline(always)]
    pub fn are_used_up(&self) -> bool {
        self.next > self.last_next || self.ranges.len() >= self.most_ranges
    }

    /// Gives new names to what is seen: the names that are stored in `names` wherever `is_seen` says so. All other names
    /// of instances stand for nothing from here on.
    #[cold]
    pub fn give_anew(&mut self, names: &mut [u32], is_seen: impl Fn(usize) -> bool) {
        let own = self.own;
        let is_given = |index: usize, name: u32| name >= own && is_seen(index);
        let seen = names.iter().enumerate().filter(|(index, name)| is_given(*index, **name));
        let mut ids: Vec<u64> = seen.map(|(_, name)| self.wide_id(*name)).collect();
        ids.sort_unstable();
        ids.dedup();
        for (index, name) in names.iter_mut().enumerate() {
            if is_given(index, *name) {
                let id = self.wide_id(*name);
                let place = ids.partition_point(|seen| *seen < id);
                *name = own + u32::try_from(place).expect("a tile has few samples");
            }
        }
        self.next = own + u32::try_from(ids.len()).expect("a tile has few samples");
        self.ranges.truncate(self.own_ranges);
        self.ranges.extend((own..).zip(ids));
        self.most_ranges = self.ranges.len() + MANY;
    }

    /// Forgets all names of instances.
    pub fn forget(&mut self) {
        self.give_anew(&mut [], |_| false);
    }

    /// The id of a name.
    #[inline(always)]
    pub fn id(&self, name: u32) -> u64 {
        if self.own == u32::MAX { u64::from(name) } else { self.wide_id(name) }
    }

    #[cold]
    fn wide_id(&self, name: u32) -> u64 {
        let after = self.ranges.partition_point(|(first, _)| *first <= name);
        let (first, id) = self.ranges[after - 1];
        id + u64::from(name - first)
    }

    /// The primitive of a name, relative to the eye.
    #[inline(always)]
    pub fn primitive(&self, view: &View, name: u32) -> Primitive {
        if name < self.own { view.named(name) } else { self.given_primitive(view, name) }
    }

    #[cold]
    fn given_primitive(&self, view: &View, name: u32) -> Primitive {
        view.primitive(self.wide_id(name))
    }

    /// Whether a primitive comes before another one in the scene.
    #[inline(always)]
    pub fn precedes(&self, name: u32, other: u32) -> bool {
        if name.max(other) < self.own {
            name < other
        } else {
            self.wide_id(name) < self.wide_id(other)
        }
    }
}

/// The names of a scene's own in ranges: they break off where instances have ids.
fn own_ranges(scene: &Scene) -> Vec<(u32, u64)> {
    let mut ranges: Vec<(u32, u64)> = Vec::new();
    for object in 0..scene.objects().len() {
        let range = (scene.first_name(object), scene.first_id(object));
        match ranges.last_mut() {
            // An object of instances has ids, but no names.
            Some(last) if last.0 == range.0 => *last = range,
            Some(last) if range.1 - last.1 == u64::from(range.0 - last.0) => {}
            _ => ranges.push(range),
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Instances, Mesh, Object, Placement, Sphere};
    use glam::Vec3;

    fn scene() -> Scene {
        let mesh = Mesh::new(vec![Vec3::ZERO], vec![[0; 3]; 5]).unwrap();
        let instances = Instances::new(mesh, vec![Placement::IDENTITY; 4]).unwrap();
        let instances: Object = Shape::from(instances).into();
        let sphere: Object = Shape::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 }).into();
        Scene::new(vec![instances.clone(), sphere.clone(), instances, sphere]).unwrap()
    }

    #[test]
    fn narrow_names_are_ids() {
        let scene = scene();
        let mut names = Names::new(&scene);
        assert_eq!(names.of_instance(26, 5), 26);
        assert!(!names.are_used_up() && names.precedes(3, 4));
        assert_eq!(names.id(30), 30);
    }

    #[test]
    fn wide_names_stand_for_ids_and_keep_their_order() {
        let scene = scene().with_wide_ids();
        let mut names = Names::new(&scene);
        // Ids: 0–19 and 21–40 of instances, 20 and 41 of spheres. The later instance gets its names first.
        let [later, earlier] = [36, 5].map(|id| names.of_instance(id, 5));
        assert_eq!([later, earlier], [2, 7]);
        let id = |names: &Names, name| names.id(name);
        assert_eq!([0, 1, later + 4, earlier].map(|name| id(&names, name)), [20, 41, 40, 5]);
        assert!(names.precedes(earlier + 4, later) && !names.precedes(1, later));
        assert!(names.precedes(earlier, 0) && names.precedes(0, later));

        let mut stored = [later + 3, u32::MAX, 1, earlier + 1, later + 3];
        names.give_anew(&mut stored, |index| index != 1);
        assert_eq!(
            stored.map(|name| if name < 9 { id(&names, name) } else { 0 }),
            [39, 0, 41, 6, 39]
        );
        let next = names.of_instance(10, 5);
        assert_eq!((next, id(&names, next + 4), id(&names, next - 1)), (4, 14, 39));
        names.forget();
        assert_eq!(names.of_instance(10, 5), 2);
    }

    #[test]
    fn many_instances_use_names_up() {
        let scene = scene().with_wide_ids();
        let mut names = Names::new(&scene);
        let count = (0..).find(|_| {
            let _ = names.of_instance(0, 5);
            names.are_used_up()
        });
        assert_eq!(count, Some(MANY - 1));
        names.forget();
        names.last_next = u32::MAX - 1 - (1 << 31);
        names.of_instance(0, 1 << 30);
        assert!(!names.are_used_up());
        names.of_instance(0, 1 << 31);
        assert!(names.are_used_up());
    }
}
