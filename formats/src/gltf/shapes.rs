//! The shapes of a scene: meshes, and instances of those that are at many places.

use super::error::GltfFault;
use super::item::Located;
use super::mesh::{Builder, Meshes};
use super::places::Places;
use ::gltf::json::Root;
use ::gltf::json::mesh::{Primitive, Semantic};
use ::gltf::json::validation::Checked;
use bothways_common::scene::{Instances, InstancesError, Mesh, Placement, Shape};
use glam::{DAffine3, DMat4};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A mesh of fewer triangles is copied: an instance takes about the memory of so many.
const FEWEST: u64 = 64;
/// Meshes whose copies have fewer triangles together are copied: that takes some megabytes.
const WORTH_SHARING: u64 = 1 << 16;

/// The shapes of all nodes, in the order of the nodes, and of the places that each has.
///
/// With `sharing`, a mesh that is large and that is at several places is stored once: nodes that follow one another and name it
/// become its instances. All others are copied to their places, into as few meshes as that order allows.
pub(super) fn shapes(
    root: &Root,
    meshes: &mut Meshes,
    places: &[Places],
    sharing: bool,
) -> Result<Vec<Shape>, Located> {
    let is_shared = if sharing { shared(root, places) } else { vec![false; root.meshes.len()] };
    let mut known: BTreeMap<usize, Arc<Mesh>> = BTreeMap::new();
    let (mut shapes, mut copied) = (Vec::new(), Builder::default());
    let mut waiting = places.iter().peekable();
    while let Some(places) = waiting.next() {
        let shared = places.mesh().filter(|&number| is_shared.get(number) == Some(&true));
        let Some(number) = shared else {
            copy(meshes, &mut copied, places)?;
            continue;
        };
        let mesh = match known.get(&number) {
            Some(mesh) => Arc::clone(mesh),
            None => {
                let mut builder = Builder::default();
                meshes.add(&mut builder, places.of, &DMat4::IDENTITY)?;
                Arc::clone(known.entry(number).or_insert(Arc::new(builder.finish())))
            }
        };
        let mut run = vec![places];
        while let Some(next) = waiting.next_if(|next| next.mesh() == Some(number)) {
            run.push(next);
        }
        if !mesh.triangles().is_empty() {
            shapes.extend(taken(&mut copied));
            shapes.push(Shape::Instances(instances(mesh, &run)?));
        }
    }
    shapes.extend(taken(&mut copied));
    if shapes.is_empty() { Err((String::new(), GltfFault::NoTriangles)) } else { Ok(shapes) }
}

/// The mesh that has been built, if it has triangles.
fn taken(builder: &mut Builder) -> Option<Shape> {
    (!builder.is_empty()).then(|| Shape::Mesh(std::mem::take(builder).finish()))
}

/// Copies a mesh to all of its places.
fn copy(meshes: &mut Meshes, copied: &mut Builder, places: &Places) -> Result<(), Located> {
    for (k, world_from_mesh) in places.world_from_mesh().enumerate() {
        let added = meshes.add(copied, places.of, &world_from_mesh);
        added.map_err(|(place, fault)| match fault {
            GltfFault::OutOfRange { .. } => places.located(k, fault),
            _ => (place, fault),
        })?;
    }
    Ok(())
}

/// A mesh at the places of these nodes.
fn instances(mesh: Arc<Mesh>, run: &[&Places]) -> Result<Instances, Located> {
    let maps = run.iter().flat_map(|places| places.world_from_mesh());
    let placements = maps.map(|map| Placement::from_affine(&DAffine3::from_mat4(map))).collect();
    Instances::new(mesh, placements).map_err(|error| {
        let (InstancesError::NotFinite { instance } | InstancesError::OutOfRange { instance }) =
            error;
        let mut of_all =
            run.iter().flat_map(|places| (0..places.count()).map(move |k| (places, k)));
        let (places, k) = of_all.nth(instance).expect("it is one of them");
        places.located(k, GltfFault::InstanceOutOfRange)
    })
}

/// Which meshes are shared.
fn shared(root: &Root, places: &[Places]) -> Vec<bool> {
    let mut counts = vec![0_u64; root.meshes.len()];
    for places in places {
        let count = places.mesh().and_then(|number| counts.get_mut(number));
        if let Some(count) = count {
            *count += places.count() as u64;
        }
    }
    let is_shared = |(mesh, count): (&::gltf::json::Mesh, u64)| {
        let triangles = mesh.primitives.iter().map(|primitive| stated_triangles(root, primitive));
        let triangles = triangles.fold(0, u64::saturating_add);
        count > 1 && triangles >= FEWEST && triangles.saturating_mul(count) > WORTH_SHARING
    };
    root.meshes.iter().zip(counts).map(is_shared).collect()
}

/// About how many triangles a primitive has, as it states them: nothing has been checked.
fn stated_triangles(root: &Root, primitive: &Primitive) -> u64 {
    let positions = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
    let accessor = primitive.indices.or(positions.copied());
    let accessor = accessor.and_then(|index| root.accessors.get(index.value()));
    accessor.map_or(0, |accessor| accessor.count.0 / 3)
}
