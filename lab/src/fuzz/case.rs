//! One scene of the fuzzer, as plain data that can be changed and tried again.

use crate::common::{
    Camera, CameraDescription, Crop, Mesh, Object, Options, Scene, Shape, Triangle,
};

/// A scene, a camera, and how to draw: everything that a renderer is given.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The objects in scene order, without materials.
    pub shapes: Vec<Shape>,
    /// The camera.
    pub camera: CameraDescription,
    /// Samples along one side of a pixel.
    pub samples: u32,
    /// The pixels to draw; `None` for all.
    pub crop: Option<Crop>,
}

impl Case {
    /// The scene and the camera; `None` if one of them is refused, or the image has no such samples or crop.
    pub fn accepted(&self) -> Option<(Scene, Camera)> {
        let image = self.camera.image;
        crate::common::raster::check_samples(image, self.samples).ok()?;
        self.pixels().check(image).ok()?;
        let scene = Scene::new(self.shapes.iter().cloned().map(Object::from).collect()).ok()?;
        Some((scene, Camera::new(self.camera).ok()?))
    }

    /// How a renderer draws the case.
    pub fn options(&self) -> Options {
        Options { samples: self.samples, crop: self.crop }
    }

    /// The pixels that are drawn.
    pub fn pixels(&self) -> Crop {
        self.options().pixels(self.camera.image)
    }

    /// The number of primitives.
    pub fn primitives(&self) -> u64 {
        self.shapes.iter().map(|shape| shape.primitive_count() as u64).sum()
    }

    /// The same case with every triangle of a mesh as an object of its own. Ids stay the same.
    #[must_use]
    pub fn without_meshes(&self) -> Case {
        let shapes = self.shapes.iter().flat_map(|shape| match shape {
            Shape::Mesh(mesh) => triangles(mesh),
            Shape::Instances(instances) => (0..instances.placements().len())
                .flat_map(|k| triangles(&instances.copied(k)))
                .collect(),
            other => vec![other.clone()],
        });
        Case { shapes: shapes.collect(), ..self.clone() }
    }
}

fn triangles(mesh: &Mesh) -> Vec<Shape> {
    let corners = (0..mesh.triangles().len()).map(|triangle| mesh.corners(triangle));
    corners.map(|[a, b, c]| Shape::Triangle(Triangle { a, b, c })).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::glam::Vec3;

    #[test]
    fn triangles_of_meshes_keep_their_ids() {
        let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2], [2, 1, 0]]);
        let mesh = Shape::Mesh(mesh.unwrap());
        let camera = CameraDescription::default();
        let case = Case { shapes: vec![mesh.clone(), mesh], camera, samples: 1, crop: None };
        let apart = case.without_meshes();
        assert_eq!((case.primitives(), apart.primitives(), apart.shapes.len()), (4, 4, 4));
        let corners = |case: &Case| {
            let (scene, _) = case.accepted().unwrap();
            (0..4).map(|id| scene.triangle(id)).collect::<Vec<_>>()
        };
        assert_eq!(corners(&case), corners(&apart));
    }

    #[test]
    fn a_crop_beyond_the_image_is_refused() {
        let crop = Some(Crop { row: 0, column: 640, height: 1, width: 1 });
        let camera = CameraDescription::default();
        let case = Case { shapes: Vec::new(), camera, samples: 1, crop };
        assert!(case.accepted().is_none());
        assert!(Case { crop: None, ..case }.accepted().is_some());
    }
}
