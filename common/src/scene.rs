//! What there is to see: objects in an order, what they are made of, and light.

pub mod instances;
pub mod material;
pub mod mesh;
pub mod positions;
pub mod primitive;
pub mod shape;
pub mod texture;

pub use instances::{Instances, InstancesError, Placement};
pub use material::{Checker, Light, Material};
pub use mesh::{Attribute, MaterialSpan, Mesh, MeshError, MeshMaterials, NamedMaterial};
pub use positions::Positions;
pub use primitive::{Primitive, are_same_corners};
pub use shape::{Plane, Shape, Sphere, Triangle};
pub use texture::{Filter, Levels, Pyramid, Sampler, Texture, Wrap};

use glam::Vec3;
use std::ops::Range;

/// One object: a shape and what it is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Its shape, in the world.
    pub shape: Shape,
    /// What it is made of, unless a mesh names a material of its own.
    pub material: Material,
}

impl Object {
    /// The material of one of its primitives, which are counted from 0 within the object.
    #[inline]
    pub fn material_of(&self, primitive: usize) -> &Material {
        match &self.shape {
            Shape::Mesh(mesh) => {
                let own = mesh.materials().and_then(|materials| materials.of(primitive));
                own.unwrap_or(&self.material)
            }
            Shape::Instances(instances) => {
                let materials = instances.mesh().materials();
                let own = materials.and_then(|all| all.of(instances.locate(primitive).1));
                own.unwrap_or(&self.material)
            }
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => &self.material,
        }
    }
}

impl<S: Into<Shape>> From<S> for Object {
    /// An object of the default material.
    fn from(shape: S) -> Self {
        Object { shape: shape.into(), material: Material::default() }
    }
}

/// Everything there is to see, with ids for all primitives.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    objects: Vec<Object>,
    /// The name of each object's first primitive, and behind the last the number of names: see [`Scene::first_name`].
    first_names: Vec<u32>,
    /// The same for ids, in a scene of wide ids; otherwise names are ids, and it is empty.
    first_ids: Vec<u64>,
    /// Where light comes from.
    pub lights: Vec<Light>,
    /// The colour where no primitive is seen, linear red, green and blue.
    pub background: Vec3,
}

/// Why a scene is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// A coordinate is NaN or infinite.
    #[error("object {object}: {what} is not finite; give finite numbers")]
    NotFinite {
        /// The object, counted from 0.
        object: usize,
        /// Which of its properties.
        what: &'static str,
    },
    /// A sphere's radius is not positive, or not finite.
    #[error("object {object}: the radius is {radius}; it must be greater than 0")]
    Radius {
        /// The object, counted from 0.
        object: usize,
        /// As it was given.
        radius: f32,
    },
    /// A plane's normal is zero.
    #[error("object {object}: the plane's normal is zero; give a vector with a length")]
    NoNormal {
        /// The object, counted from 0.
        object: usize,
    },
    /// More triangles and other primitives are stored than can be told apart.
    #[error(
        "the scene stores {stored} primitives, each mesh of instances once; at most {most} can be told apart; leave some \
         of its objects out"
    )]
    TooManyPrimitives {
        /// How many are stored.
        stored: u64,
        /// How many may be.
        most: u64,
    },
    /// There are more instances of meshes than can be told apart.
    #[error(
        "the scene has {instances} instances of meshes; at most {MOST_INSTANCES} can be told apart; give fewer"
    )]
    TooManyInstances {
        /// How many there are.
        instances: u64,
    },
    /// There are more primitives than a machine of 32 bits can count.
    #[error(
        "the scene has {primitives} primitives with all instances; on a machine of 32 bits at most {MOST_NARROW} can be \
         told apart"
    )]
    TooManyHere {
        /// How many there are.
        primitives: u64,
    },
}

/// So many primitives have ids of 32 bits, of which [`NO_PRIMITIVE`](crate::frame::NO_PRIMITIVE) is none.
const MOST_NARROW: u64 = u32::MAX as u64 - 1;
/// Where instances make more primitives than that, so many may be stored: those that are not of instances, and the largest
/// mesh that has some. Then what is seen in a tile always has names of 32 bits: see [`crate::engine::names`].
const MOST_STORED: u64 = 1 << 31;
/// So many instances of meshes can be told apart: a hierarchy refers to each in 29 bits.
const MOST_INSTANCES: u64 = 1 << 29;

/// How many primitives a scene has.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    all: u64,
    /// Those that are not of instances.
    own: u64,
    instances: u64,
    /// The triangles of the largest mesh that has instances.
    largest: u64,
}

impl Counts {
    fn add(&mut self, shape: &Shape) {
        if let Shape::Instances(instances) = shape {
            let (triangles, instances) =
                (instances.mesh().triangles().len() as u64, instances.placements().len() as u64);
            // What is saturated is refused.
            self.instances = self.instances.saturating_add(instances);
            self.all = self.all.saturating_add(triangles.saturating_mul(instances));
            self.largest = self.largest.max(triangles);
        } else {
            let count = shape.primitive_count() as u64;
            self.own += count;
            self.all = self.all.saturating_add(count);
        }
    }

    /// Whether ids do not fit into 32 bits.
    fn are_wide(&self) -> bool {
        self.all > MOST_NARROW
    }

    fn check(&self) -> Result<(), SceneError> {
        let Counts { all, own, instances, largest } = *self;
        let most = if largest == 0 { MOST_NARROW } else { MOST_STORED };
        if self.are_wide() && own + largest > most {
            return Err(SceneError::TooManyPrimitives { stored: own + largest, most });
        }
        if instances > MOST_INSTANCES {
            return Err(SceneError::TooManyInstances { instances });
        }
        if self.are_wide() && usize::BITS < u64::BITS {
            return Err(SceneError::TooManyHere { primitives: all });
        }
        Ok(())
    }
}

impl Scene {
    /// A scene of these objects in this order, lit from the camera, before a dark background. Set [`Scene::lights`] and
    /// [`Scene::background`] for others.
    ///
    /// # Errors
    ///
    /// Numbers that are not finite, a radius that is not positive, a normal of zero, or more primitives or instances than
    /// can be told apart.
    pub fn new(objects: Vec<Object>) -> Result<Scene, SceneError> {
        let mut counts = Counts::default();
        for (index, object) in objects.iter().enumerate() {
            check_shape(index, &object.shape)?;
            counts.add(&object.shape);
        }
        counts.check()?;
        let lights = vec![Light::AtCamera { intensity: 0.9 }, Light::Ambient { intensity: 0.1 }];
        let mut scene = Scene {
            objects,
            first_names: Vec::new(),
            first_ids: Vec::new(),
            lights,
            background: Vec3::splat(0.006),
        };
        scene.number(counts.are_wide());
        Ok(scene)
    }

    /// The same scene with wide ids, whether they are needed or not: for tests.
    #[doc(hidden)]
    #[must_use]
    pub fn with_wide_ids(mut self) -> Scene {
        self.number(true);
        self
    }

    /// Finds the first name and id of each object.
    fn number(&mut self, has_wide_ids: bool) {
        let (mut names, mut ids) = (0_u32, 0);
        self.first_names = vec![names];
        self.first_ids = if has_wide_ids { vec![ids] } else { Vec::new() };
        for object in &self.objects {
            let count = object.shape.primitive_count();
            if has_wide_ids {
                ids += count as u64;
                self.first_ids.push(ids);
            }
            if !(has_wide_ids && matches!(object.shape, Shape::Instances(_))) {
                names += u32::try_from(count).expect("they were counted");
            }
            self.first_names.push(names);
        }
        self.first_names.shrink_to_fit();
    }

    /// The objects, in scene order.
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// The id of an object's first primitive.
    ///
    /// # Panics
    ///
    /// If there is no such object.
    pub fn first_id(&self, object: usize) -> u64 {
        assert!(object < self.objects.len(), "there is no object {object}");
        self.first_ids.get(object).copied().unwrap_or(u64::from(self.first_names[object]))
    }

    /// The ids of an object's primitives.
    ///
    /// # Panics
    ///
    /// If there is no such object.
    pub fn ids_of(&self, object: usize) -> Range<u64> {
        let is_last = object + 1 == self.objects.len();
        let end = if is_last { self.primitive_count() } else { self.first_id(object + 1) };
        self.first_id(object)..end
    }

    /// How many primitives there are; ids are smaller.
    pub fn primitive_count(&self) -> u64 {
        let last = u64::from(self.first_names[self.objects.len()]);
        self.first_ids.last().copied().unwrap_or(last)
    }

    /// Whether ids do not fit into 32 bits: there are more than 2³² − 2 primitives.
    #[inline]
    pub fn has_wide_ids(&self) -> bool {
        !self.first_ids.is_empty()
    }

    /// The object that a primitive belongs to, and the primitive's number within it.
    ///
    /// # Panics
    ///
    /// If there is no primitive of this id.
    #[inline]
    pub fn locate(&self, id: u64) -> (usize, usize) {
        match u32::try_from(id) {
            Ok(name) if self.first_ids.is_empty() => self.locate_name(name),
            _ => self.locate_wide(id),
        }
    }

    fn locate_wide(&self, id: u64) -> (usize, usize) {
        assert!(id < self.primitive_count(), "there is no primitive {id}");
        let object = self.first_ids.partition_point(|&first| first <= id) - 1;
        let local = usize::try_from(id - self.first_ids[object]);
        (object, local.expect("a machine of 32 bits has no wide ids"))
    }

    /// A short name of an object's first primitive: the renderers call primitives by names of 32 bits. Where ids are
    /// no wider, they are names. Otherwise names count the primitives that are not of instances; those of instances get
    /// theirs where they are needed: see [`crate::engine::names`].
    ///
    /// # Panics
    ///
    /// If there is no such object.
    pub fn first_name(&self, object: usize) -> u32 {
        assert!(object < self.objects.len(), "there is no object {object}");
        self.first_names[object]
    }

    /// How many names there are: see [`Scene::first_name`].
    pub fn name_count(&self) -> u32 {
        self.first_names[self.objects.len()]
    }

    /// The object that the primitive of a name belongs to, and the primitive's number within it.
    ///
    /// # Panics
    ///
    /// If there is no primitive of this name.
    #[inline]
    pub fn locate_name(&self, name: u32) -> (usize, usize) {
        assert!(name < self.name_count(), "there is no primitive {name}");
        let object = self.first_names.partition_point(|&first| first <= name) - 1;
        (object, (name - self.first_names[object]) as usize)
    }

    /// The corners of a primitive that is a triangle, in the world; `None` for a sphere or a plane.
    ///
    /// # Panics
    ///
    /// If there is no primitive of this id.
    #[inline]
    pub fn triangle(&self, id: u64) -> Option<[Vec3; 3]> {
        let (object, local) = self.locate(id);
        match &self.objects[object].shape {
            Shape::Triangle(Triangle { a, b, c }) => Some([*a, *b, *c]),
            Shape::Mesh(mesh) => Some(mesh.corners(local)),
            Shape::Instances(instances) => Some(instances.corners(local)),
            Shape::Sphere(_) | Shape::Plane(_) => None,
        }
    }

    /// Whether two primitives are triangles with the same corners, in any order: then they tie wherever
    /// they are seen.
    ///
    /// # Panics
    ///
    /// If there is no primitive of one of the ids.
    pub fn are_same_triangle(&self, first: u64, second: u64) -> bool {
        match (self.triangle(first), self.triangle(second)) {
            (Some(first), Some(second)) => are_same_corners(&first, &second),
            _ => false,
        }
    }
}

fn check_shape(object: usize, shape: &Shape) -> Result<(), SceneError> {
    let finite = |what, vector: Vec3| {
        if vector.is_finite() { Ok(()) } else { Err(SceneError::NotFinite { object, what }) }
    };
    match shape {
        Shape::Triangle(Triangle { a, b, c }) => {
            [*a, *b, *c].into_iter().try_for_each(|corner| finite("a corner", corner))
        }
        Shape::Sphere(Sphere { center, radius }) => {
            finite("the center", *center)?;
            if *radius > 0.0 && radius.is_finite() {
                Ok(())
            } else {
                Err(SceneError::Radius { object, radius: *radius })
            }
        }
        Shape::Plane(Plane { point, normal }) => {
            finite("the point", *point)?;
            finite("the normal", *normal)?;
            if *normal == Vec3::ZERO { Err(SceneError::NoNormal { object }) } else { Ok(()) }
        }
        // They were checked when they were made.
        Shape::Mesh(_) | Shape::Instances(_) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sphere(radius: f32) -> Object {
        Shape::Sphere(Sphere { center: Vec3::ZERO, radius }).into()
    }

    #[test]
    fn ids_run_through_meshes_and_skip_empty_ones() {
        let mesh = |triangles: usize| -> Object {
            Shape::Mesh(Mesh::new(vec![Vec3::ZERO], vec![[0; 3]; triangles]).unwrap()).into()
        };
        let scene = Scene::new(vec![mesh(2), mesh(0), sphere(1.0), mesh(3)]).unwrap();
        assert_eq!(scene.primitive_count(), 6);
        let located: Vec<_> = (0..6).map(|id| scene.locate(id)).collect();
        assert_eq!(located, [(0, 0), (0, 1), (2, 0), (3, 0), (3, 1), (3, 2)]);
    }

    #[test]
    fn impossible_objects_are_refused() {
        for radius in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(matches!(Scene::new(vec![sphere(radius)]), Err(SceneError::Radius { .. })));
        }
        let plane = Shape::Plane(Plane { point: Vec3::ZERO, normal: Vec3::ZERO });
        assert_eq!(Scene::new(vec![plane.into()]), Err(SceneError::NoNormal { object: 0 }));
    }

    #[test]
    fn limits_are_met_exactly() {
        let counts = |own, largest, instances| Counts {
            all: own + largest * instances,
            own,
            instances,
            largest,
        };
        let narrow = MOST_NARROW;
        assert!(counts(narrow, 0, 0).check().is_ok() && !counts(narrow, 0, 0).are_wide());
        let most = MOST_NARROW;
        let refused = Err(SceneError::TooManyPrimitives { stored: narrow + 1, most });
        assert_eq!(counts(narrow + 1, 0, 0).check(), refused);

        assert!(!counts(narrow - 6, 3, 2).are_wide() && counts(narrow - 6, 3, 2).check().is_ok());
        let stored = narrow - 5 + 3;
        let refused = Err(SceneError::TooManyPrimitives { stored, most: MOST_STORED });
        assert_eq!(counts(narrow - 5, 3, 2).check(), refused);
        let wide = counts(5, MOST_STORED - 5, 8);
        assert!(wide.check().is_ok() && wide.are_wide());
        assert!(counts(6, MOST_STORED - 5, 8).check().is_err());

        let largest = counts(0, MOST_STORED, MOST_INSTANCES);
        assert!(largest.check().is_ok() && largest.all == 1 << 60);
        let instances = MOST_INSTANCES + 1;
        let refused = Err(SceneError::TooManyInstances { instances });
        assert_eq!(counts(0, 1, instances).check(), refused);
    }

    #[test]
    fn wide_ids_name_what_is_not_of_instances() {
        let mesh = Mesh::new(vec![Vec3::ZERO], vec![[0; 3]; 3]).unwrap();
        let placements = vec![Placement::IDENTITY; 2];
        let instances: Object =
            Shape::Instances(Instances::new(mesh.clone(), placements).unwrap()).into();
        let objects = vec![instances.clone(), sphere(1.0), Shape::Mesh(mesh).into(), instances];
        let (narrow, wide) =
            (Scene::new(objects.clone()).unwrap(), Scene::new(objects).unwrap().with_wide_ids());
        assert!(!narrow.has_wide_ids() && wide.has_wide_ids());
        for scene in [&narrow, &wide] {
            assert_eq!(scene.primitive_count(), 16);
            assert_eq!([0, 1, 2, 3].map(|object| scene.first_id(object)), [0, 6, 7, 10]);
            assert_eq!([5, 6, 9, 15].map(|id| scene.locate(id)), [(0, 5), (1, 0), (2, 2), (3, 5)]);
        }
        assert_eq!((narrow.name_count(), wide.name_count()), (16, 4));
        assert_eq!([0, 1, 3].map(|name| wide.locate_name(name)), [(1, 0), (2, 0), (2, 2)]);
    }

    #[test]
    fn ids_become_wide_where_they_must() {
        // 65,535·65,537 = 2³² − 1.
        for (triangles, instances, is_wide) in
            [(65_534, 65_536, false), (65_535, 65_537, true), (65_536, 65_536, true)]
        {
            let mesh = Mesh::new(vec![Vec3::ZERO], vec![[0; 3]; triangles]).unwrap();
            let instances = Instances::new(mesh, vec![Placement::IDENTITY; instances]).unwrap();
            let all = instances.primitive_count() as u64;
            let scene = Scene::new(vec![Shape::Instances(instances).into()]).unwrap();
            assert_eq!((scene.has_wide_ids(), scene.primitive_count()), (is_wide, all));
            assert_eq!(scene.locate(all - 1), (0, usize::try_from(all).unwrap() - 1));
        }
    }
}
