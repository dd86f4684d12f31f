//! What a renderer leaves out: single primitives and objects, what lies beyond a plane, and a part of the picture.

use super::placement::Placement;
use crate::common::{Primitive, Scene};

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

/// A plane across the axis that clips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// The distances `t` between which it lies.
    pub at: Between,
    /// The only primitive that it clips in the picture, if it is one: it may as well end there.
    pub alone: Option<u32>,
}

/// A plane that clips what lies before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearPlane {
    /// Where it lies.
    pub clip: Clip,
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
    /// A few primitives.
    Several(Several),
    /// All primitives of a shape.
    Shape(ShapeKind),
    /// Everything in a part of the picture.
    Part(Part),
    /// All from some id on.
    From {
        /// The smallest id that may be the first of them: the one behind the last that is shown.
        least: u32,
        /// The largest: the first that is missing where it should be seen.
        first: u32,
    },
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

    /// Whether a primitive is not drawn anywhere.
    pub fn omits(self, id: u32, primitive: &Primitive) -> bool {
        match self {
            Omission::Nothing | Omission::Part(_) => false,
            Omission::Primitive { id: own, .. } => own == id,
            Omission::Object { ids: [first, last], .. } => (first..=last).contains(&id),
            Omission::Several(several) => several.ids().contains(&id),
            Omission::Shape(kind) => kind == ShapeKind::of(primitive),
            Omission::From { first, .. } => id >= first,
        }
    }
}

/// A rectangle of pixels in which nothing is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its first and its last row, from the top.
    pub rows: [u32; 2],
    /// Its first and its last column, from the left.
    pub columns: [u32; 2],
    /// Width and height of the picture.
    pub image: [u32; 2],
    /// The number and the first and the last id of the only object that is lost there, of several in the scene: it alone may be
    /// cut off.
    pub alone: Option<(usize, [u32; 2])>,
}

impl Part {
    /// The same rectangle in the rows and columns of a file; `None` if it is none there.
    #[expect(clippy::cast_possible_wrap, reason = "sides are at most 2^16")]
    pub(in crate::diff::why) fn in_file(self, placement: Placement) -> Option<Part> {
        if placement == Placement::ByColumns {
            return None;
        }
        let [width, height] = self.image;
        let corner = |end: usize| {
            let pixel = [self.rows[end], self.columns[end]].map(|side| side as isize);
            placement.in_file(pixel, [width, height].map(|side| side as isize))
        };
        let [one, other] = [corner(0), corner(1)];
        let ends = |axis: usize| {
            let (one, other) = (one[axis], other[axis]);
            let number = |side: isize| u32::try_from(side).expect("it lies in the file");
            [number(one.min(other)), number(one.max(other))]
        };
        let image = if placement.swaps_sides() { [height, width] } else { self.image };
        Some(Part { rows: ends(0), columns: ends(1), image, ..self })
    }
}

/// The ids of a few primitives, ascending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Several {
    ids: [u32; Several::MOST],
    count: usize,
}

impl Several {
    /// The most of them.
    pub const MOST: usize = 8;

    /// Some ids, which are ascending; `None` if they are fewer than two or more than [`Several::MOST`].
    pub fn new(some: &[u32]) -> Option<Several> {
        let mut ids = [0; Several::MOST];
        let count = some.len();
        ids.get_mut(..count).filter(|_| count > 1)?.copy_from_slice(some);
        Some(Several { ids, count })
    }

    /// All of them.
    pub fn ids(&self) -> &[u32] {
        &self.ids[..self.count]
    }
}

/// What a primitive is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ShapeKind {
    /// A triangle, of a mesh or alone.
    Triangle,
    /// A sphere.
    Sphere,
    /// A plane.
    Plane,
}

impl ShapeKind {
    /// The kind of a primitive.
    pub fn of(primitive: &Primitive) -> ShapeKind {
        match primitive {
            Primitive::Triangle(_) => ShapeKind::Triangle,
            Primitive::Sphere { .. } => ShapeKind::Sphere,
            Primitive::Plane { .. } => ShapeKind::Plane,
        }
    }

    /// The kind in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            ShapeKind::Triangle => "triangle",
            ShapeKind::Sphere => "sphere",
            ShapeKind::Plane => "plane",
        }
    }
}
