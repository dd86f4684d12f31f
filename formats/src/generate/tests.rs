use super::*;
use glam::Vec3;
use std::collections::HashMap;

/// The number of times that each directed edge occurs.
fn directed_edges(mesh: &Mesh) -> HashMap<[u32; 2], u32> {
    let mut edges = HashMap::new();
    for &[a, b, c] in mesh.triangles() {
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    edges
}

/// Vertices − edges + faces.
fn euler_characteristic(mesh: &Mesh) -> i64 {
    let undirected = |[a, b]: &[u32; 2]| [*a.min(b), *a.max(b)];
    let edges: std::collections::HashSet<_> = directed_edges(mesh).keys().map(undirected).collect();
    let count = |n: usize| i64::try_from(n).unwrap();
    count(mesh.positions().len()) - count(edges.len()) + count(mesh.triangles().len())
}

/// The volume that the triangles enclose; positive when they face outward.
fn volume(mesh: &Mesh) -> f64 {
    let triangles = 0..mesh.triangles().len();
    let signed = |k| {
        let [a, b, c] = mesh.corners(k).map(Vec3::as_dvec3);
        a.cross(b).dot(c)
    };
    triangles.map(signed).sum::<f64>() / 6.0
}

fn assert_normals_fit(mesh: &Mesh, kind: Kind) {
    for k in 0..mesh.triangles().len() {
        let [a, b, c] = mesh.corners(k);
        let flat = (b - a).cross(c - a);
        for normal in mesh.normals().of(k).unwrap() {
            assert!((normal.length() - 1.0).abs() < 1e-5);
            assert!(flat.dot(normal) > 0.0, "{kind}, triangle {k}: {flat} against {normal}");
        }
        assert!(mesh.texture_coordinates().of(k).is_some());
    }
}

#[test]
fn closed_surfaces_are_closed_by_index() {
    for (kind, characteristic) in
        [(Kind::Sphere, 2), (Kind::Cylinder, 2), (Kind::Cone, 2), (Kind::Torus, 0), (Kind::Box, 2)]
    {
        for divisions in [kind.least_divisions(), [5, 4], kind.default_divisions()] {
            let mesh = kind.mesh(divisions).unwrap();
            let edges = directed_edges(&mesh);
            let paired =
                edges.iter().all(|([a, b], n)| *n == 1 && edges.get(&[*b, *a]) == Some(&1));
            assert!(
                paired,
                "{kind} {divisions:?}: each edge has two sides, in opposite directions"
            );
            assert_eq!(euler_characteristic(&mesh), characteristic, "{kind} {divisions:?}");
            assert!(volume(&mesh) > 0.0, "{kind} faces outward");
        }
    }
}

#[test]
fn normals_point_outward() {
    for kind in Kind::ALL {
        for divisions in [[8, 8], kind.default_divisions()] {
            assert_normals_fit(&kind.mesh(divisions).unwrap(), kind);
        }
    }
}

#[test]
fn sizes_are_as_stated() {
    let size = |kind: Kind| {
        let mesh = kind.mesh([8, 8]).unwrap();
        let (low, high) =
            mesh.positions().iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), p| {
                (low.min(*p), high.max(*p))
            });
        (low.to_array(), high.to_array())
    };
    let unit = ([-1.0; 3], [1.0; 3]);
    for kind in [Kind::Sphere, Kind::Cylinder, Kind::Cone, Kind::Box] {
        assert_eq!(size(kind), unit, "{kind}");
    }
    assert_eq!(size(Kind::Torus), ([-1.4, -0.4, -1.4], [1.4, 0.4, 1.4]));
    assert_eq!(size(Kind::Grid), ([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]));
    let (low, high) = size(Kind::Teapot);
    assert_eq!((low[1], high[1]), (0.0, 3.15));
    assert!(low[0] < -2.7 && high[0] > 3.2 && (-low[2] - high[2]).abs() < 1e-6);
}

#[test]
fn counts_are_as_expected() {
    let triangles = |kind: Kind, divisions| kind.mesh(divisions).unwrap().triangles().len();
    assert_eq!(triangles(Kind::Sphere, [8, 4]), 2 * 8 * 3);
    assert_eq!(triangles(Kind::Torus, [8, 4]), 2 * 8 * 4);
    assert_eq!(triangles(Kind::Grid, [3, 5]), 30);
    assert_eq!(triangles(Kind::Box, [1, 1]), 12);
    assert_eq!(triangles(Kind::Cylinder, [8, 2]), 2 * 8 * 2 + 2 * 8);
    assert_eq!(triangles(Kind::Cone, [8, 2]), 2 * 8 + 8 + 8);
    // Two triangles in each cell, without those at the poles of lid and bottom that would have two equal vertices.
    assert_eq!(triangles(Kind::Teapot, [10, 10]), 32 * 200 - 2 * 40);
}

#[test]
fn the_teapot_s_parts_are_open_where_newell_left_them_open() {
    let mesh = Kind::Teapot.mesh([6, 6]).unwrap();
    let edges = directed_edges(&mesh);
    assert!(edges.values().all(|&count| count == 1), "no edge is used twice in one direction");
    // The rim, the border of the lid, and both ends of handle and spout.
    let border = edges.keys().filter(|[a, b]| !edges.contains_key(&[*b, *a])).count();
    assert_eq!(border, 4 * 6 + 4 * 6 + 4 * (2 * 6));
}

#[test]
fn quarter_turns_are_exact() {
    for count in [4, 12, 100] {
        let quarters = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
        for (quarter, expected) in (0..).zip(quarters) {
            let (cos, sin) = turn(quarter * count / 4, count);
            assert_eq!((cos, sin), expected);
        }
    }
    for step in 0..40 {
        let ((cos, sin), (c, s)) = (turn(step, 40), turn(40 - step, 40));
        assert_eq!((cos, sin), (c, -s));
    }
}

#[test]
fn too_few_and_too_many_divisions_are_refused() {
    let error = Kind::Torus.mesh([2, 3]).unwrap_err();
    assert_eq!(error.to_string(), "a torus needs divisions of at least 3, 3; these are 2, 3");
    let error = Kind::Grid.mesh([u32::MAX, u32::MAX]).unwrap_err();
    assert!(error.to_string().contains("more than 100000000 triangles"));
}
