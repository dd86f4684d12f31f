//! Shapes that belong together, some of which share a mesh.

use bothways_common::scene::{Instances, Material, Mesh, Shape};
use std::collections::HashMap;
use std::sync::Arc;

/// The shapes with other meshes: those of all shapes, each changed once. Positions stay as they are.
pub fn with_meshes(shapes: Vec<Shape>, change: impl Fn(Mesh) -> Mesh) -> Vec<Shape> {
    // By the address of the mesh before, which lives as long as this list.
    let mut known: HashMap<*const Mesh, [Arc<Mesh>; 2]> = HashMap::new();
    let mut changed = |instances: Instances| {
        let (mesh, placements) = instances.into_parts();
        let [_, changed] = known.entry(Arc::as_ptr(&mesh)).or_insert_with(|| {
            let changed = change(Mesh::clone(&mesh));
            [mesh, Arc::new(changed)]
        });
        Instances::new(Arc::clone(changed), placements).expect("the positions are those of before")
    };
    let shapes = shapes.into_iter().map(|shape| match shape {
        Shape::Mesh(mesh) => Shape::Mesh(change(mesh)),
        Shape::Instances(instances) => Shape::Instances(changed(instances)),
        other => other,
    });
    shapes.collect()
}

/// What shapes are made of unless they or their object say it: white if any has colours of its own, which then show as they
/// are.
pub fn own_material(shapes: &[Shape]) -> Material {
    let colored = shapes.iter().filter_map(Shape::mesh).find(|mesh| !mesh.colors().is_empty());
    colored.map_or_else(Material::default, Mesh::own_material)
}
