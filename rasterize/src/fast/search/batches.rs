//! Consecutive primitives that one thread takes up at a time.

use super::clusters::CLUSTER;
use bothways_common::{Scene, Shape};

/// How many primitives one thread takes up at a time: at most, and at least if there are enough.
const MOST_IN_BATCH: u32 = 1 << 15;
const LEAST_IN_BATCH: u32 = 1 << 10;
/// How many instances of a mesh, at most: they are taken up as wholes.
const INSTANCES_IN_BATCH: u32 = 1 << 10;

/// Some consecutive primitives, of one object or of several.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Batch {
    /// The id of the batch's first primitive.
    pub(crate) first_id: u32,
    pub(crate) count: u32,
}

/// A piece of a batch: consecutive primitives of one object.
pub(crate) struct Piece {
    pub(crate) object: usize,
    /// The first primitive: its number in the object, and its id.
    pub(crate) first: u32,
    pub(crate) first_id: u32,
    pub(crate) count: u32,
}

impl Batch {
    /// The pieces of a batch, object by object.
    pub(crate) fn pieces(&self, scene: &Scene) -> impl Iterator<Item = Piece> {
        let end = self.first_id + self.count;
        let (mut object, first) = scene.locate(self.first_id);
        let number = |count: usize| u32::try_from(count).expect("ids are u32");
        let (mut first, mut first_id) = (number(first), self.first_id);
        std::iter::from_fn(move || {
            let shape = &scene.objects().get(object).filter(|_| first_id < end)?.shape;
            let count = (number(shape.primitive_count()) - first).min(end - first_id);
            let piece = Piece { object, first, first_id, count };
            (object, first, first_id) = (object + 1, 0, first_id + count);
            Some(piece)
        })
    }
}

/// Cuts a scene into batches; a mesh is cut only between clusters, and instances of a mesh only between instances.
pub(crate) fn batches(scene: &Scene) -> Vec<Batch> {
    // Some dozens of batches share well between threads.
    let most = (scene.primitive_count() / 64).clamp(LEAST_IN_BATCH, MOST_IN_BATCH);
    let mut batches = Vec::new();
    let mut batch = Batch { first_id: 0, count: 0 };
    for object in scene.objects() {
        if let Shape::Instances(instances) = &object.shape {
            let triangles = u32::try_from(instances.mesh().triangles().len()).expect("ids are u32");
            for some in instances.placements().chunks(INSTANCES_IN_BATCH as usize) {
                batches.push(batch);
                let next = batch.first_id + batch.count;
                let some = u32::try_from(some.len()).expect("they are few");
                batch = Batch { first_id: next, count: some * triangles };
            }
            batches.push(batch);
            batch = Batch { first_id: batch.first_id + batch.count, count: 0 };
            continue;
        }
        let mut rest = u32::try_from(object.shape.primitive_count()).expect("ids are u32");
        while rest > 0 {
            let room = most - batch.count;
            let count = if rest <= room { rest } else { room - room % CLUSTER };
            batch.count += count;
            rest -= count;
            if rest > 0 {
                batches.push(batch);
                batch = Batch { first_id: batch.first_id + batch.count, count: 0 };
            }
        }
    }
    batches.push(batch);
    batches.retain(|batch| batch.count > 0);
    batches
}
