//! Where the nodes of a scene have their meshes: each at one place, or at those of `EXT_mesh_gpu_instancing`.

use super::accessor::{Elements, Role};
use super::buffers::Buffers;
use super::error::GltfFault;
use super::item::{INSTANCING, Located};
use super::nodes::{Placed, composed};
use ::gltf::json::{Index, Root};
use glam::DMat4;
use serde_json::{Map, Value};

/// The most instances of the extension: some 800 MB of memory. Many nodes may name the same accessors, so the file may be small.
const MOST: usize = 1 << 24;

/// A node that has a mesh, and the places of that mesh.
pub(super) struct Places<'a> {
    pub(super) of: &'a Placed<'a>,
    /// Without them, the mesh is there once, where the node is.
    instances: Option<Transforms<'a>>,
}

/// Transformations of instances in the coordinates of their node, as lists of equal length. What has no list is the same for
/// all instances, and changes nothing.
struct Transforms<'a> {
    count: usize,
    scales: Option<Elements<'a>>,
    rotations: Option<Elements<'a>>,
    translations: Option<Elements<'a>>,
}

/// The places of all meshes, in the order of the nodes.
pub(super) fn places<'a>(
    root: &'a Root,
    buffers: &'a Buffers,
    placed: &'a [Placed],
) -> Result<Vec<Places<'a>>, Located> {
    let mut all = Vec::new();
    let mut total = 0;
    for of in placed.iter().filter(|of| of.node.mesh.is_some()) {
        let instances = instancing(of).map(|stated| transforms(root, buffers, stated)).transpose();
        let instances = instances.map_err(|(place, fault)| {
            let (node, fault) = of.located(fault);
            (if place.is_empty() { node } else { format!("{node}, {place}") }, fault)
        })?;
        total += instances.as_ref().map_or(0, |instances| instances.count);
        if total > MOST {
            return Err(of.located(GltfFault::TooManyInstances { count: total, most: MOST }));
        }
        all.push(Places { of, instances });
    }
    Ok(all)
}

impl Places<'_> {
    /// The number of the mesh, which need not exist.
    pub(super) fn mesh(&self) -> Option<usize> {
        self.of.node.mesh.map(|index| index.value())
    }

    /// How many places there are.
    pub(super) fn count(&self) -> usize {
        self.instances.as_ref().map_or(1, |instances| instances.count)
    }

    /// The maps that put the mesh at its places, in the order of the file.
    pub(super) fn world_from_mesh(&self) -> impl Iterator<Item = DMat4> {
        let lists = self.instances.as_ref().map(|instances| {
            let vectors = |list: &Option<Elements>| list.as_ref().map(Elements::vectors::<3>);
            let rotations = instances.rotations.as_ref().map(Elements::vectors::<4>);
            (vectors(&instances.scales), rotations, vectors(&instances.translations))
        });
        let world_from_node = self.of.world_from_node;
        (0..self.count()).map(move |k| match &lists {
            Some((scales, rotations, translations)) => {
                let [scale, translation] =
                    [scales, translations].map(|list| list.as_ref().map(|list| list[k]));
                let rotation = rotations.as_ref().map(|list| list[k]);
                world_from_node * composed(scale, rotation, translation)
            }
            None => world_from_node,
        })
    }

    /// A fault of one of the places, as one of this node and of its instance, if there are several.
    pub(super) fn located(&self, instance: usize, fault: GltfFault) -> Located {
        let (node, fault) = self.of.located(fault);
        match self.instances {
            Some(_) => (format!("{node}, instance {instance}"), fault),
            None => (node, fault),
        }
    }
}

/// What a node states for the extension, if it does.
fn instancing<'a>(of: &Placed<'a>) -> Option<&'a Value> {
    of.node.extensions.as_ref()?.others.get(INSTANCING)
}

/// Checks the accessors that the extension names (Khronos, "`EXT_mesh_gpu_instancing`", in the registry of 2022).
fn transforms<'a>(
    root: &Root,
    buffers: &'a Buffers,
    stated: &Value,
) -> Result<Transforms<'a>, Located> {
    let own = |fault| (String::new(), fault);
    let attributes = stated.get("attributes").and_then(Value::as_object);
    let attributes = attributes.ok_or_else(|| own(GltfFault::InstanceAttributes))?;
    let list = |name: &'static str, role: Role| -> Result<_, Located> {
        let Some(index) = index(attributes, name).map_err(own)? else { return Ok(None) };
        Elements::new(root, buffers, index, role).map(Some)
    };
    let scales = list("SCALE", Role::Vectors)?;
    let rotations = list("ROTATION", Role::Quaternions)?;
    let translations = list("TRANSLATION", Role::Vectors)?;
    let lists = [("TRANSLATION", &translations), ("ROTATION", &rotations), ("SCALE", &scales)];
    let counts = lists.map(|(name, list)| list.as_ref().map(|list| (name, list.count)));
    let mut counts = counts.into_iter().flatten();
    let (other, other_count) = counts.next().ok_or_else(|| own(GltfFault::NoInstances))?;
    match counts.find(|&(_, count)| count != other_count) {
        Some((attribute, count)) => {
            Err(own(GltfFault::InstanceCount { attribute, count, other, other_count }))
        }
        None => Ok(Transforms { count: other_count, scales, rotations, translations }),
    }
}

/// The accessor that an attribute names, if it is there.
fn index(
    attributes: &Map<String, Value>,
    name: &str,
) -> Result<Option<Index<::gltf::json::Accessor>>, GltfFault> {
    let Some(stated) = attributes.get(name) else { return Ok(None) };
    let number = stated.as_u64().and_then(|number| u32::try_from(number).ok());
    number.map(|number| Some(Index::new(number))).ok_or(GltfFault::InstanceAttributes)
}
