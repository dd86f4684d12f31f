//! One scene as one camera sees it: positions become offsets from the eye.

use crate::camera::Camera;
use crate::exact::Judge;
use crate::scene::{Plane, Primitive, Scene, Shape, Sphere, Triangle};
use glam::{DVec3, Vec3};

/// A scene and a camera. A view copies nothing: [`View::offset`] computes a vertex when it is needed.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// What there is to see.
    pub scene: &'a Scene,
    /// The camera that sees it.
    pub camera: &'a Camera,
}

impl<'a> View<'a> {
    /// This scene, seen by this camera.
    pub fn new(scene: &'a Scene, camera: &'a Camera) -> Self {
        View { scene, camera }
    }

    /// A position of the world relative to the eye: one subtraction a coordinate, which *is* the
    /// vertex from here on.
    #[inline]
    pub fn offset(&self, position: Vec3) -> DVec3 {
        position.as_dvec3() - self.camera.eye().as_dvec3()
    }

    /// A primitive relative to the eye.
    ///
    /// # Panics
    ///
    /// If there is no primitive of this id.
    #[inline]
    pub fn primitive(&self, id: u64) -> Primitive {
        let (object, local) = self.scene.locate(id);
        self.primitive_of(&self.scene.objects()[object].shape, local)
    }

    /// The primitive of a name, relative to the eye: see [`Scene::first_name`].
    ///
    /// # Panics
    ///
    /// If there is no primitive of this name.
    #[inline]
    pub fn named(&self, name: u32) -> Primitive {
        let (object, local) = self.scene.locate_name(name);
        self.primitive_of(&self.scene.objects()[object].shape, local)
    }

    /// All primitives with their ids, in scene order.
    pub fn primitives(&self) -> impl Iterator<Item = (u64, Primitive)> {
        let shapes = self.scene.objects().iter().map(|object| &object.shape);
        let all = shapes.flat_map(move |shape| {
            (0..shape.primitive_count()).map(move |local| self.primitive_of(shape, local))
        });
        (0..).zip(all)
    }

    /// The judge that decides what is true of a sample of this view.
    pub fn judge(&self) -> Judge {
        Judge::new(self.camera)
    }

    /// A primitive of a shape of the scene, relative to the eye; `local` counts the shape's primitives from 0.
    #[inline]
    pub(crate) fn primitive_of(&self, shape: &Shape, local: usize) -> Primitive {
        match shape {
            Shape::Triangle(Triangle { a, b, c }) => {
                Primitive::Triangle([*a, *b, *c].map(|corner| self.offset(corner)))
            }
            Shape::Mesh(mesh) => {
                Primitive::Triangle(mesh.corners(local).map(|corner| self.offset(corner)))
            }
            Shape::Instances(instances) => {
                Primitive::Triangle(instances.corners(local).map(|corner| self.offset(corner)))
            }
            Shape::Sphere(Sphere { center, radius }) => {
                Primitive::Sphere { center: self.offset(*center), radius: f64::from(*radius) }
            }
            Shape::Plane(Plane { point, normal }) => {
                Primitive::Plane { point: self.offset(*point), normal: normal.as_dvec3() }
            }
        }
    }
}
