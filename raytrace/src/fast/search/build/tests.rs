//! The required properties of a hierarchy.

use super::super::leaf::ids_of;
use super::super::tree::{IndexedLeaf, LEAF, LeafCounts, Node, NodeKind, NodeRef};
use super::split::DEEP;
use super::*;
use bothways_common::engine::simd::{SimdBase, best_level, dispatch, levels};
use bothways_common::scene::{Instances, Placement};
use bothways_common::{Mesh, Object, Plane, Shape, Sphere};
use glam::Vec3;

fn mesh(positions: Vec<Vec3>) -> Scene {
    let count = u32::try_from(positions.len()).unwrap();
    let triangles = (0..count / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let object: Object = Shape::Mesh(Mesh::new(positions, triangles).unwrap()).into();
    Scene::new(vec![object]).unwrap()
}

fn built(scene: &Scene) -> Prepared {
    build(scene, 16, best_level())
}

/// The ids of a leaf's triangles.
fn ids_in(prepared: &Prepared, leaf: NodeRef) -> [u32; LEAF] {
    dispatch!(best_level(), simd => ids_of(simd, prepared, leaf).to_array())
}

/// The indices of the vertices of a triangle.
fn indices(leaf: &IndexedLeaf, lane: usize) -> [usize; 3] {
    [0, 4, 8].map(|bit| (leaf.triangles[lane] >> bit & 15) as usize)
}

/// The ids and the corners of a leaf's triangles.
fn triangles(prepared: &Prepared, leaf: NodeRef, count: usize) -> Vec<(u32, [Vec3; 3])> {
    let of_vertices = |indexed: &IndexedLeaf, lane: usize| {
        let vertex = |index: usize| Vec3::from_array(indexed.vertices.map(|row| row[index]));
        indices(indexed, lane).map(vertex)
    };
    let corners = |lane: usize| match leaf.kind() {
        NodeKind::IndexedLeaf => of_vertices(&prepared.indexed_leaves[leaf.index()], lane),
        NodeKind::ScatteredLeaf => {
            of_vertices(&prepared.scattered_leaves[leaf.index()].indexed, lane)
        }
        NodeKind::PlainLeaf => {
            let leaf = &prepared.plain_leaves[leaf.index()];
            let corner =
                |k: usize| Vec3::from_array([0, 1, 2].map(|axis| leaf.corners[3 * k + axis][lane]));
            [0, 1, 2].map(corner)
        }
        kind => panic!("{kind:?} in a scene of triangles"),
    };
    let ids = ids_in(prepared, leaf);
    let triangle = |lane: usize| (ids[lane], corners(lane));
    // Unused lanes repeat the first lane.
    assert!((count..LEAF).all(|lane| triangle(lane) == triangle(0)));
    (0..count).map(triangle).collect()
}

/// The depth of the hierarchy and the ids in it; this function checks that boxes hold the nodes under them, and
/// leaves the triangles of the scene.
fn inspect(prepared: &Prepared, scene: &Scene) -> (usize, Vec<u32>) {
    let (mut deepest, mut ids) = (0, Vec::new());
    let mut open = vec![(prepared.roots[0], prepared.bounds, 0)];
    while let Some((child, bounds, depth)) = open.pop() {
        deepest = deepest.max(depth);
        let holds =
            |low: Vec3, high: Vec3| low.cmpge(bounds.low).all() && high.cmple(bounds.high).all();
        let node = &prepared.nodes[child.index()];
        assert!(node.used > 0);
        for lane in 0..usize::from(node.used) {
            let inner = node.bounds_of(lane);
            assert!(holds(inner.low, inner.high));
            let child = node.children[lane];
            if child.kind() == NodeKind::Node {
                open.push((child, inner, depth + 1));
                continue;
            }
            for (id, corners) in triangles(prepared, child, node.counts[lane].all()) {
                for corner in corners {
                    assert!(corner.cmpge(inner.low).all() && corner.cmple(inner.high).all());
                }
                assert_eq!(corners, CornerReader::new(Source::Scene(scene)).of(id));
                ids.push(id);
            }
        }
    }
    ids.sort_unstable();
    (deepest, ids)
}

#[test]
fn every_primitive_is_in_one_leaf() {
    let corner = |k: u32| Vec3::new((k * 37 % 101) as f32, (k * 53 % 97) as f32, (k % 89) as f32);
    for count in [1, 8, 9, 70, 3000, 4096, 5120, 16_383, 16_384, 16_385, 20_000] {
        let scene = mesh((0..count * 3).map(corner).collect());
        let (depth, ids) = inspect(&built(&scene), &scene);
        assert_eq!(ids, (0..count).collect::<Vec<_>>());
        assert!(depth < 12, "{depth}");
    }
}

/// A scene of three objects with more triangles than one thread sorts, in no order: a height field whose triangles share
/// vertices, the same as triangles of their own vertices, and scattered triangles. Some coordinates are −0.
fn fields() -> Scene {
    let mut random = fastrand::Rng::with_seed(19);
    let height: Vec<f32> = (0..101 * 101).map(|_| random.f32()).collect();
    let vertex = |k: usize| Vec3::new((k % 101) as f32, height[k], -((k / 101) as f32));
    let mut triangles: Vec<[u32; 3]> = (0..100 * 100_u32)
        .map(|k| k / 100 * 101 + k % 100)
        .flat_map(|k| [[k, k + 1, k + 101], [k + 102, k + 101, k + 1]])
        .collect();
    random.shuffle(&mut triangles);
    let shared = Mesh::new((0..101 * 101).map(vertex).collect(), triangles).unwrap();
    let corners = shared.triangles().as_flattened().iter();
    let apart = corners.map(|k| shared.positions()[*k as usize] + 150.0 * Vec3::X).collect();
    let mut place = || Vec3::from_array(std::array::from_fn(|_| 100.0 * random.f32()));
    let scattered = (0..5000).flat_map(|_| {
        let center = place() - 200.0 * Vec3::Y;
        [(); 3].map(|()| center + 0.1 * place())
    });
    let scattered = scattered.collect();
    let of = |positions: Vec<Vec3>| {
        let count = u32::try_from(positions.len()).unwrap();
        Mesh::new(positions, (0..count / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect())
    };
    let meshes = [shared, of(apart).unwrap(), of(scattered).unwrap()];
    Scene::new(meshes.map(|mesh| Object::from(Shape::Mesh(mesh))).into()).unwrap()
}

#[test]
fn threads_and_simd_change_no_bit_of_a_hierarchy() {
    for (name, scene) in [("fields", fields()), ("a crowd", crowd().0)] {
        let shown = |threads: usize, level: Level| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let built = pool.install(|| build(&scene, 16, level));
            let Prepared { nodes, indexed_leaves, scattered_leaves, plain_leaves, .. } = &built;
            let Prepared { roots, bounds, instance_order, meshes, .. } = &built;
            let leaves = format!("{indexed_leaves:?} {scattered_leaves:?} {plain_leaves:?}");
            let leaves = format!("{leaves} {instance_order:?}");
            format!("{nodes:?} {leaves} {roots:?} {bounds:?} {meshes:?}")
        };
        let expected = shown(1, best_level());
        for level in levels() {
            assert!(shown(3, level) == expected, "{name}, at {level:?}");
        }
    }
}

#[test]
fn vertices_are_shared_by_index_or_by_place() {
    let scene = fields();
    let prepared = built(&scene);
    let (depth, ids) = inspect(&prepared, &scene);
    assert_eq!(ids, (0..45_000).collect::<Vec<_>>());
    assert!(depth < 6, "{depth}");
    // A leaf of 2 × 3 cells of the height field has 12 vertices, whether the mesh names each once or six times. Those of
    // scattered triangles are not shared.
    let of = |object: u32| {
        let of_kind = |kind: NodeKind, all: usize| {
            let leaves = (0..all).map(|index| NodeRef::new(kind, index));
            leaves.filter(|leaf| ids_in(&prepared, *leaf)[0] / 20_000 == object).count()
        };
        let (indexed, plain) = (&prepared.indexed_leaves, &prepared.plain_leaves);
        (of_kind(NodeKind::IndexedLeaf, indexed.len()), of_kind(NodeKind::PlainLeaf, plain.len()))
    };
    let ((shared, no), (apart, none), (few, many)) = (of(0), of(1), of(2));
    assert!(shared > 1200 && apart > 1200 && many > 300, "{shared}, {apart} and {many}");
    assert!(no < 400 && none < 400 && few < 10, "{no}, {none} and {few}");
}

#[test]
fn a_vertex_is_known_by_its_index_if_there_are_few() {
    // Places 0 and 3 are the same. Three more vertices than one leaf holds follow.
    let mut places = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ZERO];
    places.extend((4..17).map(|k| Vec3::new(k as f32, (k * k) as f32, 1.0)));
    let corners_of = |triangles: &[[u32; 3]]| {
        let mesh = Mesh::new(places.clone(), triangles.to_vec()).unwrap();
        let scene = Scene::new(vec![Object::from(Shape::Mesh(mesh))]).unwrap();
        let prepared = built(&scene);
        let ids: Vec<u32> = (0..u32::try_from(triangles.len()).unwrap()).collect();
        assert_eq!(inspect(&prepared, &scene), (0, ids));
        let leaf = prepared.indexed_leaves.first()?;
        let used = (0..triangles.len()).flat_map(|lane| indices(leaf, lane));
        used.max().map(|last| last + 1)
    };
    // Index 0 is not taken for a corner that is not used, first or later.
    assert_eq!(corners_of(&[[0, 1, 2], [3, 2, 1]]), Some(4));
    assert_eq!(corners_of(&[[2, 1, 4], [4, 1, 0]]), Some(4));
    // Sixteen by their indices, with index 0 the last.
    let sixteen = [[1, 2, 3], [4, 5, 6], [7, 8, 9], [10, 11, 12], [13, 14, 15], [14, 15, 0]];
    assert_eq!(corners_of(&sixteen), Some(16));
    // Seventeen, which are sixteen by their places; and seventeen of both.
    let seventeen = [[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11], [12, 13, 14], [14, 15, 16]];
    assert_eq!(corners_of(&seventeen), Some(16));
    places[3] = Vec3::Z;
    let mesh = Mesh::new(places.clone(), seventeen.to_vec()).unwrap();
    let scene = Scene::new(vec![Object::from(Shape::Mesh(mesh))]).unwrap();
    assert_eq!(built(&scene).plain_leaves.len(), 1);
}

/// Vertices are numbered in the order of their first corners, those that are not used are the first one, and none is −0.
#[test]
fn vertices_of_a_leaf_have_an_order() {
    let places = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(-0.0, 2.0, -0.0)];
    let vertices_of = |places: Vec<Vec3>, triangles: Vec<[u32; 3]>| {
        let mesh = Mesh::new(places, triangles).unwrap();
        let prepared = built(&Scene::new(vec![Object::from(Shape::Mesh(mesh))]).unwrap());
        let [x, y, z] = prepared.indexed_leaves[0].vertices;
        [0, 1, 2, 3, 4, 5, 15].map(|k| [x[k], y[k], z[k]].map(f32::to_bits))
    };
    let expected =
        |order: [usize; 7]| order.map(|k| (places[k] + 0.0).to_array().map(f32::to_bits));
    let by_index = vertices_of(places.to_vec(), vec![[2, 1, 4], [4, 1, 0]]);
    assert_eq!(by_index, expected([2, 1, 4, 0, 2, 2, 2]));
    // Eighteen by their indices, five by their places.
    let triangles = [[0, 1, 2], [0, 1, 3], [0, 1, 4], [0, 2, 3], [0, 2, 4], [1, 2, 3]];
    let mut apart: Vec<Vec3> = triangles.as_flattened().iter().map(|k| places[*k]).collect();
    apart[3] = -Vec3::ZERO;
    let by_place = vertices_of(apart, (0..6).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect());
    assert_eq!(by_place, expected([0, 1, 2, 3, 4, 0, 0]));
}

#[test]
fn a_leaf_may_hold_triangles_of_two_meshes() {
    let of = |places: [Vec3; 3]| Mesh::new(places.to_vec(), vec![[0, 1, 2]]).unwrap();
    let meshes = [of([Vec3::ZERO, Vec3::X, Vec3::Y]), of([Vec3::Y, Vec3::ONE, Vec3::X])];
    let objects = meshes.map(|mesh| Object::from(Shape::Mesh(mesh)));
    let scene = Scene::new(objects.into()).unwrap();
    let prepared = built(&scene);
    assert_eq!(inspect(&prepared, &scene), (0, vec![0, 1]));
    assert_eq!((prepared.indexed_leaves.len(), prepared.plain_leaves.len()), (1, 0));
}

#[test]
fn a_leaf_may_hold_triangles_whose_ids_are_far_apart() {
    for (before, between) in [(0, 100), (70_000, 100), (0, 600_000), (70_000, 600_000)] {
        let [a, b, c, d] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE];
        let far = |count: usize| [a, b, c].map(|corner| corner + 1000.0 * Vec3::Z).repeat(count);
        let scene = mesh([far(before), vec![a, b, c], far(between), vec![b, d, c]].concat());
        let prepared = built(&scene);
        let [first, last] = [before, before + 1 + between].map(|id| u32::try_from(id).unwrap());
        let of_far = if before == 0 { 1 } else { 0 };
        let mut expected = vec![first, of_far, last];
        expected.sort_unstable();
        assert_eq!(inspect(&prepared, &scene), (0, expected));
        let scattered = usize::from(between > 524_288);
        assert_eq!(prepared.scattered_leaves.len(), scattered);
        assert_eq!(prepared.indexed_leaves.len(), 2 - scattered);
    }
}

/// More instances than have their boxes at hand at one time, in two objects, and the places of all.
fn crowd() -> (Scene, Vec<Placement>) {
    let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]).unwrap();
    let place = |k: u32| Vec3::new((k % 317) as f32, (k * 53 % 97) as f32, (k / 317) as f32);
    let places: Vec<Placement> = (0..90_000).map(|k| Placement::translation(place(k))).collect();
    let object = |places: &[Placement]| -> Object {
        Shape::Instances(Instances::new(mesh.clone(), places.to_vec()).unwrap()).into()
    };
    let (few, many) = places.split_at(10);
    (Scene::new(vec![object(few), object(many)]).unwrap(), places)
}

#[test]
fn every_instance_is_in_one_leaf() {
    let (scene, places) = crowd();
    let prepared = built(&scene);
    let (mut numbers, mut open) = (Vec::new(), vec![(prepared.roots[0], prepared.bounds)]);
    while let Some((node, bounds)) = open.pop() {
        let node = &prepared.nodes[node.index()];
        for lane in 0..usize::from(node.used) {
            let inner = node.bounds_of(lane);
            assert_eq!(bounds.union(&inner), bounds);
            let child = node.children[lane];
            if child.kind() == NodeKind::Node {
                open.push((child, inner));
                continue;
            }
            assert_eq!(child.kind(), NodeKind::Instances);
            let count = node.counts[lane].all();
            for &number in &prepared.instance_order[child.index()..][..count] {
                let [low, high] =
                    places[number as usize].bounds([Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)]);
                assert_eq!(inner.union(&Bounds { low, high }), inner);
                numbers.push(number);
            }
        }
    }
    numbers.sort_unstable();
    assert!(numbers.into_iter().eq(0..90_000));
}

#[test]
fn a_crowd_takes_few_bytes_an_instance() {
    let (scene, places) = crowd();
    let Prepared { nodes, instance_order, .. } = built(&scene);
    let bytes = nodes.capacity() * size_of::<Node>() + instance_order.capacity() * 4;
    assert!(bytes <= 12 * places.len(), "{} bytes an instance", bytes / places.len());
}

#[test]
fn nodes_are_filled() {
    let corner = |k: u32| Vec3::new((k * 37 % 101) as f32, (k * 53 % 97) as f32, (k % 89) as f32);
    for count in [9, 30, 70, 3000, 20_000] {
        let prepared = built(&mesh((0..count * 3).map(corner).collect()));
        let children =
            prepared.nodes.len() - 1 + prepared.indexed_leaves.len() + prepared.plain_leaves.len();
        // If the build splits the largest box until there are sixteen, the leaves are half empty.
        assert!(
            children >= 10 * (prepared.nodes.len() - 1),
            "{count}: {children} in {}",
            prepared.nodes.len()
        );
    }
}

#[test]
fn nodes_are_filled_where_no_box_has_an_area() {
    let corner = |k: u16| Vec3::new(f32::from(k), 0.0, 0.0);
    let prepared = built(&mesh((0..3 * 3000).map(corner).collect()));
    let children =
        prepared.nodes.len() - 1 + prepared.indexed_leaves.len() + prepared.plain_leaves.len();
    assert!(children >= 10 * (prepared.nodes.len() - 1), "{children} in {}", prepared.nodes.len());
}

#[test]
fn of_many_coincident_triangles_the_first_is_kept() {
    for count in [8_000, 100_000] {
        let scene = mesh([Vec3::ZERO, Vec3::X, Vec3::Y].repeat(count));
        assert_eq!(inspect(&built(&scene), &scene), (0, vec![0]));
    }
}

#[test]
fn duplicates_in_a_leaf_come_last() {
    let (a, b, c, d) = (Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z);
    let scene = mesh(vec![a, b, c, c, a, b, a, b, d, b, a, c]);
    let prepared = built(&scene);
    assert_eq!(prepared.nodes[0].counts[0], LeafCounts::new(4, 2));
    assert_eq!(ids_in(&prepared, prepared.nodes[0].children[0])[..2], [0, 2]);
}

#[test]
fn halves_of_a_square_are_no_duplicates_though_they_have_one_box() {
    let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        .map(|[x, y]: [f32; 2]| Vec3::new(x, y, 0.0));
    let e = Vec3::new(2.0, 0.5, 0.0);
    let halves = [[b, c, d], [a, b, d]];
    let [again, once_more] = [[c, d, b * Vec3::new(1.0, -1.0, -1.0)], [d, -a, b]];
    // Each triangle is followed by a duplicate, some of which have −0 in place of 0.
    let all = [halves[0], again, halves[1], once_more, [b, e, c], [c, e, b]];
    let prepared = built(&mesh(all.concat()));
    assert_eq!(prepared.nodes[0].counts[0], LeafCounts::new(6, 3));
    assert_eq!(ids_in(&prepared, prepared.nodes[0].children[0])[..3], [0, 2, 4]);
    // Where triangles here and there take turns, dividing them mixes their order.
    let here_and_there =
        |triangle: [Vec3; 3]| [triangle, triangle.map(|corner| corner + 100.0 * Vec3::X)].concat();
    let prepared = built(&mesh(all.repeat(2).into_iter().flat_map(here_and_there).collect()));
    assert_eq!(prepared.nodes[0].counts[..2], [LeafCounts::new(12, 3); 2]);
}

#[test]
fn triangles_with_one_middle_are_halved() {
    // Nested triangles, each around the origin.
    let scene = mesh(
        (0..3 * 500_u16)
            .map(|k| {
                let size = 1.0 + f32::from(k / 3);
                size * [Vec3::NEG_ONE, Vec3::ONE, Vec3::new(1.0, -1.0, 0.0)][usize::from(k % 3)]
            })
            .collect(),
    );
    let (depth, ids) = inspect(&built(&scene), &scene);
    assert_eq!(ids.len(), 500);
    assert!(depth <= 9, "{depth}");
}

#[test]
fn triangles_ever_smaller_do_not_nest_without_end() {
    let corner = |k: usize| Vec3::splat((-(k as f32)).exp2()) * [Vec3::X, Vec3::Y, Vec3::Z][k % 3];
    let scene = mesh((0..3 * 140).map(|k| corner(k / 3 + k % 3)).collect());
    let (depth, ids) = inspect(&built(&scene), &scene);
    assert_eq!(ids.len(), 140);
    assert!(depth <= DEEP, "{depth}");
}

#[test]
fn a_scene_may_have_nothing_to_bound() {
    let plane = Shape::Plane(Plane { point: Vec3::ZERO, normal: Vec3::Y });
    let huge = Shape::Sphere(Sphere { center: Vec3::splat(3e38), radius: 3e38 });
    let prepared = built(&Scene::new(vec![plane.into(), huge.into()]).unwrap());
    assert!(prepared.nodes.is_empty() && prepared.roots.is_empty());
    assert_eq!(prepared.unbounded, [0, 1]);
    assert!(built(&Scene::new(vec![]).unwrap()).unbounded.is_empty());
}
