//! The shapes of a scene: meshes, and instances of those that many nodes name.

use super::error::GltfFault;
use super::item::Located;
use super::mesh::{Builder, Meshes};
use super::nodes::Placed;
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

/// The shapes of all nodes, in the order of the nodes.
///
/// With `sharing`, a mesh that is large and that several nodes name is stored once: nodes that follow one another and name it
/// become its instances. All others are copied to where their nodes are, into as few meshes as that order allows.
pub(super) fn shapes(
    root: &Root,
    meshes: &mut Meshes,
    placed: &[Placed],
    sharing: bool,
) -> Result<Vec<Shape>, Located> {
    let is_shared = if sharing { shared(root, placed) } else { vec![false; root.meshes.len()] };
    let mut known: BTreeMap<usize, Arc<Mesh>> = BTreeMap::new();
    let (mut shapes, mut copied) = (Vec::new(), Builder::default());
    let mut places = placed.iter().filter(|place| place.node.mesh.is_some()).peekable();
    while let Some(place) = places.next() {
        let shared = mesh_of(place).filter(|&number| is_shared.get(number) == Some(&true));
        let Some(number) = shared else {
            meshes.add(&mut copied, place, &place.world_from_node)?;
            continue;
        };
        let mesh = match known.get(&number) {
            Some(mesh) => Arc::clone(mesh),
            None => {
                let mut builder = Builder::default();
                meshes.add(&mut builder, place, &DMat4::IDENTITY)?;
                Arc::clone(known.entry(number).or_insert(Arc::new(builder.finish())))
            }
        };
        let mut run = vec![place];
        while let Some(next) = places.next_if(|next| mesh_of(next) == Some(number)) {
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

fn mesh_of(place: &Placed) -> Option<usize> {
    place.node.mesh.map(|index| index.value())
}

/// A mesh where these nodes are.
fn instances(mesh: Arc<Mesh>, run: &[&Placed]) -> Result<Instances, Located> {
    let placement =
        |place: &&Placed| Placement::from_affine(&DAffine3::from_mat4(place.world_from_node));
    Instances::new(mesh, run.iter().map(placement).collect()).map_err(|error| {
        let (InstancesError::NotFinite { instance } | InstancesError::OutOfRange { instance }) =
            error;
        run[instance].located(GltfFault::InstanceOutOfRange)
    })
}

/// Which meshes are shared.
fn shared(root: &Root, placed: &[Placed]) -> Vec<bool> {
    let mut nodes = vec![0_u64; root.meshes.len()];
    for number in placed.iter().filter_map(mesh_of) {
        if let Some(nodes) = nodes.get_mut(number) {
            *nodes += 1;
        }
    }
    let is_shared = |(mesh, nodes): (&::gltf::json::Mesh, u64)| {
        let triangles = mesh.primitives.iter().map(|primitive| stated_triangles(root, primitive));
        let triangles = triangles.fold(0, u64::saturating_add);
        nodes > 1 && triangles >= FEWEST && triangles.saturating_mul(nodes) > WORTH_SHARING
    };
    root.meshes.iter().zip(nodes).map(is_shared).collect()
}

/// About how many triangles a primitive has, as it states them: nothing has been checked.
fn stated_triangles(root: &Root, primitive: &Primitive) -> u64 {
    let positions = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
    let accessor = primitive.indices.or(positions.copied());
    let accessor = accessor.and_then(|index| root.accessors.get(index.value()));
    accessor.map_or(0, |accessor| accessor.count.0 / 3)
}
