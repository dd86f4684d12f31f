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

impl From<Shape> for Object {
    /// An object of the default material.
    fn from(shape: Shape) -> Self {
        Object { shape, material: Material::default() }
    }
}

/// Everything there is to see, with ids for all primitives.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    objects: Vec<Object>,
    /// The id of each object's first primitive, and behind the last the number of primitives.
    first_ids: Vec<u32>,
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
    /// There are more primitives than ids.
    #[error("the scene has {primitives} primitives; at most {} can be told apart", u32::MAX - 1)]
    TooManyPrimitives {
        /// How many there are.
        primitives: usize,
    },
}

impl Scene {
    /// A scene of these objects in this order, lit from the camera, before a dark background. Set [`Scene::lights`] and
    /// [`Scene::background`] for others.
    ///
    /// # Errors
    ///
    /// Numbers that are not finite, a radius that is not positive, a normal of zero, or more
    /// primitives than ids.
    pub fn new(objects: Vec<Object>) -> Result<Scene, SceneError> {
        let mut first_ids = Vec::with_capacity(objects.len() + 1);
        let mut primitives = 0;
        for (index, object) in objects.iter().enumerate() {
            check_shape(index, &object.shape)?;
            first_ids.push(id(primitives)?);
            primitives = object.shape.primitive_count().saturating_add(primitives);
        }
        first_ids.push(id(primitives)?);
        let lights = vec![Light::AtCamera { intensity: 0.9 }, Light::Ambient { intensity: 0.1 }];
        Ok(Scene { objects, first_ids, lights, background: Vec3::splat(0.006) })
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
    pub fn first_id(&self, object: usize) -> u32 {
        assert!(object < self.objects.len(), "there is no object {object}");
        self.first_ids[object]
    }

    /// How many primitives there are; ids are smaller.
    pub fn primitive_count(&self) -> u32 {
        self.first_ids[self.objects.len()]
    }

    /// The object that a primitive belongs to, and the primitive's number within it.
    ///
    /// # Panics
    ///
    /// If there is no primitive of this id.
    #[inline]
    pub fn locate(&self, id: u32) -> (usize, usize) {
        assert!(id < self.primitive_count(), "there is no primitive {id}");
        let object = self.first_ids.partition_point(|&first| first <= id) - 1;
        (object, (id - self.first_ids[object]) as usize)
    }

    /// The corners of a primitive that is a triangle, in the world; `None` for a sphere or a plane.
    ///
    /// # Panics
    ///
    /// If there is no primitive of this id.
    pub fn triangle(&self, id: u32) -> Option<[Vec3; 3]> {
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
    pub fn are_same_triangle(&self, first: u32, second: u32) -> bool {
        match (self.triangle(first), self.triangle(second)) {
            (Some(first), Some(second)) => are_same_corners(&first, &second),
            _ => false,
        }
    }
}

fn id(primitives: usize) -> Result<u32, SceneError> {
    match u32::try_from(primitives) {
        Ok(id) if id < u32::MAX => Ok(id),
        _ => Err(SceneError::TooManyPrimitives { primitives }),
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
}
