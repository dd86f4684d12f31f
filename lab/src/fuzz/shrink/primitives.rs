//! Fewer primitives.

use super::shrinker::Shrinker;
use crate::common::{Instances, Mesh, Placement, Shape};
use crate::fuzz::case::Case;
use std::ops::Range;

/// Removes primitives: halves of them, then ever smaller parts, down to single ones. Triangles of meshes become objects of
/// their own, and instances meshes, unless the disagreement needs the mesh or the instances.
pub(super) fn shrink(shrinker: &mut Shrinker) {
    shrinker.try_change(|case| Some(case.without_meshes()));
    shrinker.try_change(|case| Some(with_copies(case)));
    remove_instances(shrinker);
    let count = |shrinker: &Shrinker| {
        usize::try_from(shrinker.case.primitives()).expect("primitives are in memory")
    };
    let mut part = count(shrinker).div_ceil(2);
    while part > 0 {
        let mut first = 0;
        let mut helped = false;
        while first < count(shrinker) && count(shrinker) > 1 {
            let removed = first..first + part;
            if shrinker.try_change(|case| Some(kept(case, |id| !removed.contains(&id)))) {
                helped = true;
            } else {
                first += part;
            }
        }
        part = if helped && part == 1 { 1 } else { part / 2 };
    }
    shrinker.try_change(|case| Some(case.without_meshes()));
}

/// Removes whole instances, which parts of any other size leave as they are.
fn remove_instances(shrinker: &mut Shrinker) {
    let mut last = usize::MAX;
    while let Some(ids) = last_instance(&shrinker.case, last) {
        last = ids.start;
        shrinker.try_change(|case| Some(kept(case, |id| !ids.contains(&id))));
    }
}

/// The ids of the last instance that begins before one of them.
fn last_instance(case: &Case, before: usize) -> Option<Range<usize>> {
    let (mut id, mut found) = (0, None);
    for shape in &case.shapes {
        if let Shape::Instances(instances) = shape {
            let count = instances.mesh().triangles().len();
            let starts = (0..instances.placements().len()).map(|k| id + k * count);
            let start = starts.take_while(|start| *start < before).last();
            found = start.map(|start| start..start + count).or(found);
        }
        id += shape.primitive_count();
    }
    found
}

/// The case with each instance as a mesh of its own.
fn with_copies(case: &Case) -> Case {
    let copies = |shape: &Shape| match shape {
        Shape::Instances(instances) => {
            let all = 0..instances.placements().len();
            all.map(|instance| Shape::Mesh(instances.copied(instance))).collect()
        }
        other => vec![other.clone()],
    };
    Case { shapes: case.shapes.iter().flat_map(copies).collect(), ..case.clone() }
}

/// The case with some of its primitives, chosen by their ids.
fn kept(case: &Case, is_kept: impl Fn(usize) -> bool) -> Case {
    let mut id = 0;
    let mut shapes = Vec::new();
    for shape in &case.shapes {
        let ids = id..id + shape.primitive_count();
        id = ids.end;
        match shape {
            Shape::Mesh(mesh) => shapes.extend(part_of(mesh, |local| is_kept(ids.start + local))),
            Shape::Instances(instances) => {
                let triangles = instances.mesh().triangles().len();
                let first = |instance: usize| ids.start + instance * triangles;
                let placements = instances.placements().iter().enumerate();
                let kept = placements
                    .filter(|(k, _)| (first(*k)..first(k + 1)).any(&is_kept))
                    .map(|(_, placement)| *placement);
                let kept: Vec<Placement> = kept.collect();
                if !kept.is_empty() {
                    let kept = Instances::new(instances.shared_mesh().clone(), kept);
                    shapes.push(Shape::Instances(kept.expect("it is a part of them")));
                }
            }
            other if is_kept(ids.start) => shapes.push(other.clone()),
            _ => {}
        }
    }
    Case { shapes, ..case.clone() }
}

/// A mesh of some of a mesh's triangles and the vertices that they name, in their order; `None` if no triangle is left.
fn part_of(mesh: &Mesh, is_kept: impl Fn(usize) -> bool) -> Option<Shape> {
    let triangles = mesh.triangles().iter().enumerate();
    let triangles: Vec<[u32; 3]> =
        triangles.filter(|(local, _)| is_kept(*local)).map(|(_, corners)| *corners).collect();
    let mut named: Vec<u32> = triangles.iter().flatten().copied().collect();
    named.sort_unstable();
    named.dedup();
    let place = |vertex: u32| {
        let place = named.binary_search(&vertex).expect("it is one of those that are named");
        u32::try_from(place).expect("there are no more than before")
    };
    let positions = named.iter().map(|vertex| mesh.positions()[*vertex as usize]).collect();
    let triangles: Vec<[u32; 3]> =
        triangles.into_iter().map(|corners| corners.map(place)).collect();
    if triangles.is_empty() {
        return None;
    }
    Some(Shape::Mesh(Mesh::new(positions, triangles).expect("it is a part of a mesh")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::generate;

    #[test]
    fn what_is_kept_stays_as_it_is() {
        for scene in 0..50 {
            // Instances are kept as wholes.
            let case = with_copies(&generate(5, scene));
            let (before, _) = case.accepted().unwrap();
            let third = kept(&case, |id| id % 3 == 1);
            let (after, _) = third.accepted().unwrap();
            assert_eq!(after.primitive_count(), (case.primitives() + 1) / 3);
            for id in 0..after.primitive_count() {
                assert_eq!(after.triangle(id), before.triangle(3 * id + 1), "scene {scene}");
            }
        }
    }
}
