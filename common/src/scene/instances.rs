//! One mesh in many places: the mesh is stored once, and each place is an affine map.

use super::mesh::{Mesh, MeshError};
use crate::engine::simd::{Simd, SimdBase, SimdNarrow, SimdWiden, f32x16, f64x8};
use crate::look::lanes::each;
use glam::{DAffine3, DVec3, Vec3};
use std::sync::Arc;

/// Where an instance is: an affine map from the coordinates of a mesh to those of the world, 48 bytes.
///
/// Its twelve numbers are stored as `f32`, as vertices are. From there on they *are* the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// For x, y and z of the world: what x, y and z of the mesh contribute, and what is added.
    rows: [[f32; 4]; 3],
}

impl Placement {
    /// Leaves a mesh where it is.
    pub const IDENTITY: Placement = Placement::translation(Vec3::ZERO);

    /// Moves a mesh.
    pub const fn translation(by: Vec3) -> Placement {
        let rows = [[1.0, 0.0, 0.0, by.x], [0.0, 1.0, 0.0, by.y], [0.0, 0.0, 1.0, by.z]];
        Placement { rows }
    }

    /// The map with these rows: for x, y and z of the world, the factors of x, y and z of the mesh, and what is added.
    pub const fn from_rows(rows: [[f32; 4]; 3]) -> Placement {
        Placement { rows }
    }

    /// The map with these numbers, each rounded to `f32`.
    pub fn from_affine(world_from_mesh: &DAffine3) -> Placement {
        let [x, y, z] = world_from_mesh.matrix3.transpose().to_cols_array_2d();
        let rows = [
            DVec3::from(x).extend(world_from_mesh.translation.x),
            DVec3::from(y).extend(world_from_mesh.translation.y),
            DVec3::from(z).extend(world_from_mesh.translation.z),
        ];
        Placement { rows: rows.map(|row| row.as_vec4().to_array()) }
    }

    /// The rows of the map, as [`Placement::from_rows`] takes them.
    pub fn rows(&self) -> &[[f32; 4]; 3] {
        &self.rows
    }

    /// A position of the mesh in the world: an instance's vertex. All code computes it by this
    /// function, so it has the same bits everywhere.
    ///
    /// Each coordinate is `m₀·x + m₁·y + m₂·z + m₃`, computed in `f64` from left to right and rounded to `f32` once. The
    /// products are exact: they have 48 bits, and neither over- nor underflow.
    ///
    /// **Monotonic**: rounding is, and so are sums and products with a number of one sign. So for every position in a box
    /// each coordinate lies between those of two of the box's corners, as they are computed here, rounding included.
    #[inline(always)]
    pub fn position(&self, position: Vec3) -> Vec3 {
        let [x, y, z] = self.rows.map(|row| coordinate(row, position.to_array()));
        Vec3::new(x, y, z)
    }

    /// A box in the world around all that lies in a box of the mesh, from its low to its high corner: along each axis every
    /// coordinate of the mesh contributes least at one of the box's sides and most at the other.
    ///
    /// [`Placement::position`] is monotonic, so these contributions, summed up and rounded as it does it, bound every vertex.
    #[inline]
    pub fn bounds(&self, [low, high]: [Vec3; 2]) -> [Vec3; 2] {
        let (low, high) = (low.to_array(), high.to_array());
        let [x, y, z] = each!(row in [&self.rows[0], &self.rows[1], &self.rows[2]] => {
            let [a, b, c] = each!(k in [0, 1, 2] => {
                if row[k] >= 0.0 { [low[k], high[k]] } else { [high[k], low[k]] }
            });
            each!(end in [0, 1] => coordinate(*row, [a[end], b[end], c[end]]))
        });
        [Vec3::new(x[0], y[0], z[0]), Vec3::new(x[1], y[1], z[1])]
    }

    /// [`Placement::position`] of sixteen positions: rows of their x, y and z.
    #[inline(always)]
    pub fn sixteen_positions<S: Simd>(
        &self,
        simd: S,
        positions: &[[f32; 16]; 3],
    ) -> [[f32; 16]; 3] {
        let [x, y, z] = each!(row in [&positions[0], &positions[1], &positions[2]] => {
            f32x16::from_slice(simd, row).widen()
        });
        each!(row in [&self.rows[0], &self.rows[1], &self.rows[2]] => {
            let [m0, m1, m2, m3] = each!(k in [0, 1, 2, 3] => f64x8::splat(simd, f64::from(row[k])));
            let [low, high] = each!(half in [[x.0, y.0, z.0], [x.1, y.1, z.1]] => {
                m0 * half[0] + m1 * half[1] + m2 * half[2] + m3
            });
            low.narrow(high).to_array()
        })
    }

    /// A normal of the mesh in the world, of another length: the cofactors of the map (its inverse transpose times its
    /// determinant) turn it. It stays on its side of the surface, as that is told by the order of a triangle's corners:
    /// the cross product of two sides turns in the same way.
    ///
    /// Zero where the map flattens everything onto a line or a point. It neither over- nor underflows.
    #[inline]
    pub fn normal(&self, normal: Vec3) -> DVec3 {
        turned(self.cofactors(), normal)
    }

    /// The rows of the map's cofactors.
    #[inline(always)]
    fn cofactors(&self) -> [DVec3; 3] {
        let [a, b, c] = each!(row in [&self.rows[0], &self.rows[1], &self.rows[2]] => {
            DVec3::new(row[0].into(), row[1].into(), row[2].into())
        });
        [b.cross(c), c.cross(a), a.cross(b)]
    }

    /// Whether all its numbers are finite.
    fn is_finite(&self) -> bool {
        self.rows.as_flattened().iter().all(|number| number.is_finite())
    }
}

/// [`Placement::normal`], by the cofactors of the map.
#[inline(always)]
fn turned([x, y, z]: [DVec3; 3], normal: Vec3) -> DVec3 {
    let normal = normal.as_dvec3();
    DVec3::new(x.dot(normal), y.dot(normal), z.dot(normal))
}

/// One coordinate of [`Placement::position`].
#[inline(always)]
fn coordinate([m0, m1, m2, m3]: [f32; 4], [x, y, z]: [f32; 3]) -> f32 {
    let product = |factor: f32, coordinate: f32| f64::from(factor) * f64::from(coordinate);
    let sum = product(m0, x) + product(m1, y) + product(m2, z) + f64::from(m3);
    #[expect(clippy::cast_possible_truncation, reason = "this is the one rounding")]
    let rounded = sum as f32;
    rounded
}

/// A mesh in many places, stored once. Each place is an instance.
///
/// Its primitives are the triangles of the first instance, in the mesh's order, then those of the second, and so on.
#[derive(Clone, Debug, PartialEq)]
pub struct Instances {
    mesh: Arc<Mesh>,
    placements: Vec<Placement>,
}

/// Why instances are refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InstancesError {
    /// A number of a placement is NaN or infinite.
    #[error("instance {instance} has a number that is not finite; give finite numbers")]
    NotFinite {
        /// The instance, counted from 0.
        instance: usize,
    },
    /// A corner of the box around the mesh is put beyond the range of `f32`.
    #[error(
        "instance {instance} reaches where no f32 number does; stay between -3.4e38 and 3.4e38"
    )]
    OutOfRange {
        /// The instance, counted from 0.
        instance: usize,
    },
}

impl Instances {
    /// A mesh in these places, in this order. Other instances may share the mesh.
    ///
    /// # Errors
    ///
    /// A placement that is not finite, or that puts a corner of the box around the mesh beyond the range of `f32`.
    ///
    /// ```
    /// use bothways_common::scene::{Instances, Placement};
    /// use bothways_common::{Mesh, glam::Vec3};
    ///
    /// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]])?;
    /// let beside = Placement::translation(Vec3::new(2.0, 0.0, 0.0));
    /// let pair = Instances::new(mesh, vec![Placement::IDENTITY, beside])?;
    /// assert_eq!(pair.primitive_count(), 2);
    /// assert_eq!(pair.corners(1)[1], Vec3::new(3.0, 0.0, 0.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(
        mesh: impl Into<Arc<Mesh>>,
        placements: Vec<Placement>,
    ) -> Result<Instances, InstancesError> {
        let mesh = mesh.into();
        if let Some(instance) = placements.iter().position(|placement| !placement.is_finite()) {
            return Err(InstancesError::NotFinite { instance });
        }
        if let Some([low, high]) = mesh.bounds() {
            let corners: [Vec3; 8] = std::array::from_fn(|k| {
                let [x, y, z] =
                    [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { high } else { low }[axis]);
                Vec3::new(x, y, z)
            });
            // No vertex is beyond these: see [`Placement::position`].
            let is_out = |placement: &Placement| {
                corners.iter().any(|corner| !placement.position(*corner).is_finite())
            };
            if let Some(instance) = placements.iter().position(is_out) {
                return Err(InstancesError::OutOfRange { instance });
            }
        }
        Ok(Instances { mesh, placements })
    }

    /// The mesh, in coordinates of its own.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The mesh, to be shared with other instances.
    pub fn shared_mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// Where the instances are.
    pub fn placements(&self) -> &[Placement] {
        &self.placements
    }

    /// The mesh, and where its instances are, which are not copied.
    pub fn into_parts(self) -> (Arc<Mesh>, Vec<Placement>) {
        (self.mesh, self.placements)
    }

    /// How many primitives there are: the mesh's triangles, times the instances.
    pub fn primitive_count(&self) -> usize {
        self.mesh.triangles().len().saturating_mul(self.placements.len())
    }

    /// The instance that a primitive belongs to, and the primitive's triangle of the mesh.
    ///
    /// # Panics
    ///
    /// If there is no such primitive.
    #[inline]
    pub fn locate(&self, primitive: usize) -> (usize, usize) {
        assert!(primitive < self.primitive_count(), "there is no primitive {primitive}");
        let count = self.mesh.triangles().len();
        (primitive / count, primitive % count)
    }

    /// The corners of a primitive, in the world.
    ///
    /// # Panics
    ///
    /// If there is no such primitive.
    #[inline]
    pub fn corners(&self, primitive: usize) -> [Vec3; 3] {
        let (instance, triangle) = self.locate(primitive);
        let placement = &self.placements[instance];
        self.mesh.corners(triangle).map(|corner| placement.position(corner))
    }

    /// The normals at the corners of a primitive, in the world, of any length; `None` unless all three have one.
    ///
    /// # Panics
    ///
    /// If there is no such primitive.
    #[inline]
    pub fn corner_normals(&self, primitive: usize) -> Option<[DVec3; 3]> {
        let (instance, triangle) = self.locate(primitive);
        let [a, b, c] = self.mesh.normals().of(triangle)?;
        // Three normals are turned by one map.
        let cofactors = self.placements[instance].cofactors();
        Some(each!(normal in [a, b, c] => turned(cofactors, normal)))
    }

    /// An instance as a mesh of its own, with every vertex copied: the same triangles with the same ids.
    ///
    /// # Panics
    ///
    /// If there is no such instance.
    pub fn copied(&self, instance: usize) -> Mesh {
        let placement = &self.placements[instance];
        let turn = |normal| placement.normal(normal).normalize_or_zero().as_vec3();
        let placed: Result<Mesh, MeshError> =
            Mesh::clone(&self.mesh).map(|position| placement.position(position), turn);
        placed.expect("instances are in the range of f32")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::simd::{dispatch, levels};
    use glam::DMat3;

    fn triangle() -> Mesh {
        Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::new(0.1, 1.0, -0.3)], vec![[0, 1, 2]]).unwrap()
    }

    #[test]
    fn a_vertex_is_rounded_once() {
        // 3·(1 + 2⁻²³) − 3 = 3·2⁻²³ needs no rounding; rounded before the sum it would be another number.
        let placement = Placement::from_rows([
            [3.0, 0.0, 0.0, -3.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
        ]);
        let x = 1.0 + f32::EPSILON;
        assert_eq!(
            placement.position(Vec3::new(x, 7.0, 9.0)),
            Vec3::new(3.0 * f32::EPSILON, 7.0, 9.0)
        );
        for level in levels() {
            let sixteen = [[x; 16], [7.0; 16], [9.0; 16]];
            let placed = dispatch!(level, simd => placement.sixteen_positions(simd, &sixteen));
            assert_eq!(placed, [[3.0 * f32::EPSILON; 16], [7.0; 16], [9.0; 16]]);
        }
    }

    #[test]
    fn sixteen_positions_have_the_bits_of_one() {
        let scale = [1e-6_f32, 0.03, 1.0, 7.0, 4e5];
        let number = |k: usize| ((k * 37 % 101) as f32 - 50.3) * scale[k % 5];
        let rows = |first: usize| {
            std::array::from_fn(|row| std::array::from_fn(|k| number(first + 4 * row + k)))
        };
        for first in 0..40 {
            let placement = Placement::from_rows(rows(first));
            let positions: [[f32; 16]; 3] = std::array::from_fn(|axis| {
                std::array::from_fn(|k| number(7 * first + 16 * axis + k))
            });
            for level in levels() {
                let placed =
                    dispatch!(level, simd => placement.sixteen_positions(simd, &positions));
                for lane in 0..16 {
                    let one = placement.position(Vec3::from(positions.map(|row| row[lane])));
                    let placed = placed.map(|row| row[lane].to_bits());
                    assert_eq!(placed, one.to_array().map(f32::to_bits));
                }
            }
        }
        let same = Vec3::new(0.1, -3.4e38, 1e-45);
        assert_eq!(Placement::IDENTITY.position(same), same);
    }

    #[test]
    fn every_corner_is_within_the_bounds() {
        let placement = Placement::from_rows([
            [0.3, -0.7, 0.1, 1e3],
            [-0.0, 0.0, 5.0, -0.1],
            [-0.6, -0.2, -0.9, 1e-3],
        ]);
        let [low, high] = [Vec3::new(-0.1, 0.2, -7.0), Vec3::new(0.7, 0.3, 11.0)];
        let corner = |k: usize| {
            let side = |axis: usize| if k >> axis & 1 == 1 { high[axis] } else { low[axis] };
            placement.position(Vec3::new(side(0), side(1), side(2)))
        };
        let corners: [Vec3; 8] = std::array::from_fn(corner);
        let least = corners.into_iter().reduce(Vec3::min).unwrap();
        let most = corners.into_iter().reduce(Vec3::max).unwrap();
        assert_eq!(placement.bounds([low, high]), [least, most]);
    }

    #[test]
    fn normals_stay_perpendicular_and_follow_the_corners() {
        for scale in [DVec3::new(2.0, 3.0, 5.0), DVec3::new(-1.0, 1.0, 4.0), DVec3::splat(-2.0)] {
            let turn =
                DMat3::from_axis_angle(DVec3::ONE.normalize(), 0.7) * DMat3::from_diagonal(scale);
            let placement = Placement::from_affine(&DAffine3 {
                matrix3: turn,
                translation: DVec3::new(5.0, -4.0, 3.0),
            });
            let pair = Instances::new(triangle(), vec![placement]).unwrap();
            let normal = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a);
            let own = placement.normal(normal(triangle().corners(0))).as_vec3();
            let placed = normal(pair.corners(0));
            assert!(own.normalize().dot(placed.normalize()) > 0.999_999, "{scale}: {own} {placed}");
            assert_eq!(pair.copied(0).corners(0), pair.corners(0));
        }
    }

    #[test]
    fn what_leaves_the_range_is_refused() {
        let far = Placement::translation(Vec3::new(f32::MAX, 0.0, 0.0));
        let stretched = Placement::from_rows([
            [f32::MAX, f32::MAX, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
        ]);
        let not = Placement::translation(Vec3::new(0.0, f32::NAN, 0.0));
        let error = |placement| {
            Instances::new(triangle(), vec![Placement::IDENTITY, placement]).unwrap_err()
        };
        // 1 more is lost in rounding.
        assert!(Instances::new(triangle(), vec![far]).is_ok());
        assert_eq!(error(stretched), InstancesError::OutOfRange { instance: 1 });
        assert_eq!(error(not), InstancesError::NotFinite { instance: 1 });
        assert!(Instances::new(Mesh::default(), vec![stretched]).is_ok());
    }
}
