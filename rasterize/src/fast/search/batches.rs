//! Consecutive primitives that one thread takes at a time.

use super::clusters::CLUSTER;
use bothways_common::{Scene, Shape};

/// The most primitives that one thread takes at a time.
const MOST_IN_BATCH: u32 = 1 << 15;
/// The fewest primitives that one thread takes at a time, if there are enough.
const LEAST_IN_BATCH: u32 = 1 << 10;
/// The most instances of a mesh in one batch; an instance is never divided.
const INSTANCES_IN_BATCH: u32 = 1 << 10;

/// What one thread takes up at a time.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Batch {
    /// Consecutive primitives that are not of instances, of one object or of several: the first one's name, and how many.
    Primitives { first_name: u32, count: u32 },
    /// Consecutive instances of one object: the first one's number, and how many.
    Instances { object: usize, first: u32, count: u32 },
}

/// A piece of a batch of primitives: those of one object.
pub(crate) struct Piece {
    pub(crate) object: usize,
    /// The first primitive: its number in the object, its name, and its id.
    pub(crate) first: u32,
    pub(crate) first_name: u32,
    pub(crate) first_id: u64,
    pub(crate) count: u32,
}

/// The pieces of a batch of primitives, object by object.
pub(crate) fn pieces(
    scene: &Scene,
    mut first_name: u32,
    count: u32,
) -> impl Iterator<Item = Piece> {
    let end = first_name + count;
    let (mut object, first) = scene.locate_name(first_name);
    let mut first = number(first);
    std::iter::from_fn(move || {
        let shape = &scene.objects().get(object).filter(|_| first_name < end)?.shape;
        let count = (number(shape.primitive_count()) - first).min(end - first_name);
        let first_id = scene.first_id(object) + u64::from(first);
        let piece = Piece { object, first, first_name, first_id, count };
        (object, first, first_name) = (object + 1, 0, first_name + count);
        Some(piece)
    })
}

/// A number of primitives or instances.
fn number(count: usize) -> u32 {
    u32::try_from(count).expect("a scene has fewer that are stored")
}

/// Cuts a scene into batches; a mesh is cut only between clusters, and instances of a mesh only between instances.
pub(crate) fn batches(scene: &Scene) -> Vec<Batch> {
    // Some dozens of batches share well between threads.
    let most = u32::try_from(scene.primitive_count() / 64).unwrap_or(u32::MAX);
    let most = most.clamp(LEAST_IN_BATCH, MOST_IN_BATCH);
    let mut batches = Vec::new();
    let (mut first_name, mut count) = (0, 0);
    for (object, described) in scene.objects().iter().enumerate() {
        if let Shape::Instances(instances) = &described.shape {
            batches.push(Batch::Primitives { first_name, count });
            if instances.primitive_count() > 0 {
                let all = instances.placements().chunks(INSTANCES_IN_BATCH as usize);
                let firsts = (0..).step_by(INSTANCES_IN_BATCH as usize);
                batches.extend(all.zip(firsts).map(|(some, first)| {
                    let count = number(some.len());
                    Batch::Instances { object, first, count }
                }));
            }
            // In scenes of narrow ids, instances have names.
            let next = scene.objects().get(object + 1).map(|_| scene.first_name(object + 1));
            (first_name, count) = (next.unwrap_or(scene.name_count()), 0);
            continue;
        }
        let mut rest = number(described.shape.primitive_count());
        while rest > 0 {
            let room = most - count;
            let taken = if rest <= room { rest } else { room - room % CLUSTER };
            count += taken;
            rest -= taken;
            if rest > 0 {
                batches.push(Batch::Primitives { first_name, count });
                (first_name, count) = (first_name + count, 0);
            }
        }
    }
    batches.push(Batch::Primitives { first_name, count });
    batches.retain(|batch| !matches!(batch, Batch::Primitives { count: 0, .. }));
    batches
}
