//! What a renderer leaves out: single primitives and objects, and what lies beyond a plane.

use crate::common::Scene;
use std::ops::RangeInclusive;

/// Two distances `t`, between which something begins or ends to be seen: the picture tells no more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// The smaller one.
    pub nearer: f64,
    /// The larger one.
    pub farther: f64,
}

impl Between {
    /// The middle of both, which stands for all between them.
    pub fn middle(self) -> f64 {
        f64::midpoint(self.nearer, self.farther)
    }
}

/// A plane that clips what lies before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearPlane {
    /// The distances `t` between which it lies.
    pub at: Between,
    /// Whether a sphere whose first hit lies before it is not seen at all, rather than its other side behind the plane.
    pub hides_spheres: bool,
}

/// What is not drawn at all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Omission {
    /// Nothing: all is drawn.
    #[default]
    Nothing,
    /// One primitive.
    Primitive {
        /// Its id.
        id: u32,
        /// Whether it is the last one of the scene.
        is_last: bool,
    },
    /// All primitives of an object that has several.
    Object {
        /// The number of the object, from 0.
        object: usize,
        /// Its first and its last id.
        ids: [u32; 2],
    },
    /// All from this id on.
    From(u32),
}

impl Omission {
    /// The omission of a primitive.
    pub fn of_primitive(scene: &Scene, id: u32) -> Omission {
        Omission::Primitive { id, is_last: u64::from(id) + 1 == scene.primitive_count() }
    }

    /// The omission of an object; `None` if it has no more than one primitive.
    pub fn of_object(scene: &Scene, object: usize) -> Option<Omission> {
        let ids = scene.ids_of(object);
        let number = |id: u64| u32::try_from(id).ok();
        let [first, last] = [number(ids.start)?, number(ids.end.checked_sub(1)?)?];
        (first < last).then_some(Omission::Object { object, ids: [first, last] })
    }

    /// The ids that are not drawn.
    pub fn ids(self) -> Option<RangeInclusive<u32>> {
        match self {
            Omission::Nothing => None,
            Omission::Primitive { id, .. } => Some(id..=id),
            Omission::Object { ids: [first, last], .. } => Some(first..=last),
            Omission::From(first) => Some(first..=u32::MAX),
        }
    }
}
