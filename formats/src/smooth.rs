//! Computes normals for meshes that have none: smooth where faces meet at a small angle, with a crease where they meet at
//! a large angle.

mod facet;
mod normal_tree;

use crate::attributes::NONE;
use crate::shapes::with_meshes;
use bothways_common::scene::{Attribute, Mesh, Shape};
use facet::Facet;
use glam::{DVec3, Vec3};
use normal_tree::NormalTree;
use rayon::prelude::*;
use std::collections::HashMap;

/// The angle between two faces, in degrees, beyond which the edge between them is a visible crease.
pub const CREASE: f64 = 40.0;

/// Gives a mesh a normal at each corner: the weighted mean of the normals of the faces around its vertex.
///
/// All threads of the current rayon pool work on it; their number changes nothing.
///
/// The mean takes the faces whose normals differ from that of the corner's own face by at most `crease` degrees. The
/// weight of a face is its angle at the vertex (Thürmer and Wüthrich, "Computing Vertex Normals from Polygonal Facets",
/// Journal of Graphics Tools 3, 1998).
///
/// Corners of triangles without area get no normal. A mesh that has normals keeps them.
///
/// ```
/// use bothways_formats::{generate::Kind, smooth};
///
/// // The faces of a box meet at 90 degrees: each corner keeps the normal of its own face.
/// let corners = Kind::Box.mesh([1, 1])?;
/// let bare = bothways_common::Mesh::new(corners.positions().to_vec(), corners.triangles().to_vec())?;
/// let creased = smooth::with_normals(bare, smooth::CREASE);
/// assert_eq!(creased.normals().of(0), corners.normals().of(0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn with_normals(mesh: Mesh, crease: f64) -> Mesh {
    if !mesh.normals().corners.is_empty() {
        return mesh;
    }
    let (faces, mut corners): (Vec<DVec3>, _) = rayon::join(
        || (0..mesh.triangles().len()).into_par_iter().map(|k| face_normal(&mesh, k)).collect(),
        || CornersByVertex::new(&mesh),
    );
    let least_cosine = libm::cos(crease.to_radians());
    // A normal belongs to one vertex alone, so all vertices are smoothed at once.
    let values: Vec<Vec<Vec3>> = corners
        .by_vertices(VERTICES_AT_ONCE)
        .into_par_iter()
        .map(|vertices| smooth_vertices(&mesh, &faces, vertices, least_cosine))
        .collect();
    let normals = corners.attribute(values);
    mesh.with_normals(normals).expect("each corner names a normal that was made")
}

/// Gives the meshes of shapes normals, as [`with_normals`] does; one that several instances share stays shared.
pub fn shapes_with_normals(shapes: Vec<Shape>, crease: f64) -> Vec<Shape> {
    with_meshes(shapes, |mesh| with_normals(mesh, crease))
}

/// How many vertices one thread smooths in one go. The normals and their order do not depend on it.
const VERTICES_AT_ONCE: usize = 1 << 12;

/// Computes the normals around some vertices, and puts their indices, from 0 on, in the place of the corners' triangles.
fn smooth_vertices(
    mesh: &Mesh,
    faces: &[DVec3],
    vertices: SomeVertices,
    least_cosine: f64,
) -> Vec<Vec3> {
    let SomeVertices { starts, corners } = vertices;
    let (mut facets, mut values) = (Vec::new(), Vec::new());
    for ends in starts.windows(2) {
        let [begin, end] = [0, 1].map(|k| (ends[k] - starts[0]) as usize);
        let around = &mut corners[begin..end];
        facets.clear();
        facets.extend(around.iter().map(|&(triangle, corner)| {
            let normal = faces[triangle as usize];
            let angle = angle_at(mesh, triangle as usize, corner as usize);
            Facet { normal, weighted: normal * angle, triangle }
        }));
        smooth_vertex(&facets, least_cosine, &mut values, around);
    }
    values
}

/// The number of triangles around a vertex from which a tree is faster than a comparison of all pairs.
const MANY: usize = 64;

/// Computes the normals of the corners around one vertex, and puts their indices in the place of the corners' triangles.
fn smooth_vertex(
    facets: &[Facet],
    least_cosine: f64,
    values: &mut Vec<Vec3>,
    around: &mut [(u32, u8)],
) {
    let tree = (facets.len() >= MANY).then(|| NormalTree::new(facets));
    // Corners of one smooth surface share a normal: few values for many corners.
    let first = values.len();
    let mut known = HashMap::new();
    for (facet, (place, _)) in facets.iter().zip(around) {
        if facet.normal == DVec3::ZERO {
            *place = NONE;
            continue;
        }
        let sum = match &tree {
            Some(tree) => tree.sum(facet.normal, least_cosine),
            None => sum_one_by_one(facets, facet, least_cosine),
        };
        let normal = sum.normalize_or(facet.normal).as_vec3();
        let next = values.len();
        let index = if tree.is_some() {
            // 0 and −0 are two keys for equal normals: this only stores one more value.
            *known.entry(normal.to_array().map(f32::to_bits)).or_insert(next)
        } else {
            let equal = values[first..].iter().position(|value| *value == normal);
            equal.map_or(next, |place| first + place)
        };
        if index == next {
            values.push(normal);
        }
        *place = u32::try_from(index).unwrap_or(NONE);
    }
}

/// The sum of the weighted normals of the faces whose normals differ from that of `one` by at most the crease.
fn sum_one_by_one(facets: &[Facet], one: &Facet, least_cosine: f64) -> DVec3 {
    let gentle = facets.iter().filter(|other| {
        one.normal.dot(other.normal) >= least_cosine || other.triangle == one.triangle
    });
    gentle.map(|other| other.weighted).sum()
}

/// The corners at each vertex: their triangles, and their numbers in the triangles.
struct CornersByVertex {
    /// The corners at vertex `v` are those from `starts[v]` up to `starts[v + 1]`.
    starts: Vec<u32>,
    corners: Vec<(u32, u8)>,
    /// The place of each triangle's corners among `corners`.
    places: Vec<[u32; 3]>,
}

/// Some vertices in a row, with their corners.
struct SomeVertices<'a> {
    /// As in [`CornersByVertex`], with one more at the end.
    starts: &'a [u32],
    corners: &'a mut [(u32, u8)],
}

impl CornersByVertex {
    /// Sorts all corners by vertex, with a counting sort.
    fn new(mesh: &Mesh) -> CornersByVertex {
        let mut starts = vec![0_u32; mesh.positions().len() + 1];
        for vertex in mesh.triangles().iter().flatten() {
            starts[*vertex as usize + 1] += 1;
        }
        for vertex in 1..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        let mut next = starts.clone();
        let mut corners = vec![(0, 0); 3 * mesh.triangles().len()];
        let mut places = mesh.triangles().to_vec();
        for (triangle, places) in (0..).zip(&mut places) {
            for (corner, place) in (0..).zip(places) {
                let next = &mut next[*place as usize];
                corners[*next as usize] = (triangle, corner);
                *place = *next;
                *next += 1;
            }
        }
        CornersByVertex { starts, corners, places }
    }

    /// All vertices, so many at a time.
    fn by_vertices(&mut self, many: usize) -> Vec<SomeVertices<'_>> {
        let mut rest = &mut self.corners[..];
        let vertices = self.starts.len() - 1;
        let begins = (0..vertices).step_by(many);
        let some = begins.map(|begin| {
            let starts = &self.starts[begin..=(begin + many).min(vertices)];
            let count = starts[starts.len() - 1] - starts[0];
            let corners =
                rest.split_off_mut(..count as usize).expect("the corners of all vertices");
            SomeVertices { starts, corners }
        });
        some.collect()
    }

    /// The attribute of these normals, in lists of [`VERTICES_AT_ONCE`] vertices each, whose indices stand in the place of the
    /// corners' triangles.
    fn attribute(mut self, values: Vec<Vec<Vec3>>) -> Attribute<Vec3> {
        let first = |before: &mut u32, values: &Vec<Vec3>| {
            let count = u32::try_from(values.len()).expect("no more normals than corners");
            Some(std::mem::replace(before, *before + count))
        };
        let firsts: Vec<u32> = values.iter().scan(0, first).collect();
        self.by_vertices(VERTICES_AT_ONCE).into_par_iter().zip(firsts).for_each(|(some, first)| {
            for (index, _) in some.corners.iter_mut().filter(|(index, _)| *index != NONE) {
                *index += first;
            }
        });
        let CornersByVertex { corners: sorted, places: mut corners, .. } = self;
        corners
            .par_iter_mut()
            .for_each(|corners| *corners = corners.map(|place| sorted[place as usize].0));
        Attribute { values: values.concat(), corners }
    }
}

/// The unit normal of a triangle; zero if the triangle has no area.
fn face_normal(mesh: &Mesh, triangle: usize) -> DVec3 {
    let [a, b, c] = mesh.corners(triangle).map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero()
}

/// The angle of a triangle at one of its corners, in radians.
fn angle_at(mesh: &Mesh, triangle: usize, corner: usize) -> f64 {
    let corners = mesh.corners(triangle).map(Vec3::as_dvec3);
    let [here, next, last] = [0, 1, 2].map(|k| corners[(corner + k) % 3]);
    let (p, q) = (next - here, last - here);
    libm::atan2(p.cross(q).length(), p.dot(q))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::Kind;

    fn bare(kind: Kind, divisions: [u32; 2]) -> (Mesh, Mesh) {
        let mesh = kind.mesh(divisions).unwrap();
        let bare = Mesh::new(mesh.positions().to_vec(), mesh.triangles().to_vec()).unwrap();
        (mesh, bare)
    }

    /// The largest angle, in degrees, between the normals of two meshes.
    fn farthest(mesh: &Mesh, other: &Mesh) -> f32 {
        let pairs = (0..mesh.triangles().len()).flat_map(|k| {
            let (a, b) = (mesh.normals().of(k).unwrap(), other.normals().of(k).unwrap());
            [0, 1, 2].map(|corner| a[corner].angle_between(b[corner]).to_degrees())
        });
        pairs.fold(0.0, f32::max)
    }

    #[test]
    fn a_sphere_becomes_smooth_again() {
        // The second is smoothed in parts.
        for divisions in [[48, 24], [150, 75]] {
            let (sphere, bare) = bare(Kind::Sphere, divisions);
            let smooth = with_normals(bare, CREASE);
            assert!(farthest(&sphere, &smooth) < 2.0, "{}", farthest(&sphere, &smooth));
            let [normals, vertices] =
                [&smooth.normals().values[..], sphere.positions()].map(<[Vec3]>::len);
            assert_eq!(normals, vertices, "one for each vertex");
        }
    }

    #[test]
    fn a_cylinder_keeps_the_edge_of_its_caps() {
        let (cylinder, bare) = bare(Kind::Cylinder, [64, 4]);
        let smooth = with_normals(bare, CREASE);
        assert!(farthest(&cylinder, &smooth) < 3.0, "{}", farthest(&cylinder, &smooth));
    }

    #[test]
    fn triangles_without_area_get_no_normal_and_spoil_none() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, 2.0 * Vec3::X];
        let mesh = Mesh::new(positions, vec![[0, 1, 2], [0, 1, 3], [1, 1, 2]]).unwrap();
        let smooth = with_normals(mesh, CREASE);
        assert_eq!(smooth.normals().of(0), Some([Vec3::Z; 3]));
        assert_eq!((smooth.normals().of(1), smooth.normals().of(2)), (None, None));
    }

    #[test]
    fn normals_that_are_there_stay() {
        let (torus, _) = bare(Kind::Torus, [8, 8]);
        assert_eq!(with_normals(torus.clone(), CREASE), torus);
    }

    impl CornersByVertex {
        fn of(&self, vertex: usize) -> &[(u32, u8)] {
            &self.corners[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
        }
    }

    /// A cone of so many sides, with fine wrinkles and a crease at every seventh side. Its base is one polygon, cut into a
    /// fan.
    fn cone(sides: u32) -> Mesh {
        let rim = (0..sides).map(|k| {
            let turn = std::f64::consts::TAU * f64::from(k) / f64::from(sides);
            let height = if k % 7 == 0 { 0.9 } else { 0.01 * f64::from(k % 3) };
            DVec3::new(libm::cos(turn), height, libm::sin(turn)).as_vec3()
        });
        let positions = [Vec3::Y].into_iter().chain(rim).collect();
        let side = |k: u32| [0, 1 + k, 1 + (k + 1) % sides];
        let fan = |k: u32| [1, 1 + k, 2 + k];
        let triangles = (0..sides).map(side).chain((1..sides - 1).map(fan)).collect();
        Mesh::new(positions, triangles).unwrap()
    }

    #[test]
    fn many_faces_around_a_vertex_are_smoothed_as_few_are() {
        let mesh = cone(500);
        let faces: Vec<_> = (0..mesh.triangles().len()).map(|k| face_normal(&mesh, k)).collect();
        let sorted = CornersByVertex::new(&mesh);
        for crease in [0.0, 1.0, CREASE, 90.0, 180.0] {
            let smooth = with_normals(mesh.clone(), crease);
            let least = libm::cos(crease.to_radians());
            // The definition, corner by corner.
            for (triangle, vertices) in mesh.triangles().iter().enumerate() {
                for (corner, vertex) in vertices.iter().enumerate() {
                    let mut sum = DVec3::ZERO;
                    for &(other, there) in sorted.of(*vertex as usize) {
                        let (own, face) = (faces[triangle], faces[other as usize]);
                        if own.dot(face) >= least || other as usize == triangle {
                            sum += face * angle_at(&mesh, other as usize, there.into());
                        }
                    }
                    let normal = smooth.normals().of(triangle).unwrap()[corner].as_dvec3();
                    assert!(normal.distance(sum.normalize()) < 1e-6, "{crease}: {triangle}");
                }
            }
        }
    }

    #[test]
    fn a_polygon_of_many_corners_does_not_take_quadratic_time() {
        // A comparison of all pairs would take 10¹⁰ products: a minute and a half.
        let mesh = cone(100_000);
        let begun = std::time::Instant::now();
        let smooth = with_normals(mesh, CREASE);
        assert!(smooth.normals().of(0).is_some());
        assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
    }
}
