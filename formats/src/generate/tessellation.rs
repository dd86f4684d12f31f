//! Tessellates parametric surfaces, and joins them to one mesh.

use bothways_common::scene::{Attribute, Mesh};
use glam::{DVec3, Vec2, Vec3};
use std::collections::HashMap;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

/// One point of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub(super) position: DVec3,
    /// Points outward; of any length.
    pub(super) normal: DVec3,
}

/// A mesh under construction. Points at the same position become one vertex, whether they meet at a seam, at a pole or at
/// the border of two surfaces. Normals and texture coordinates stay separate.
#[derive(Debug, Default)]
pub(super) struct Tessellation {
    places: HashMap<[u32; 3], u32>,
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    normals: Attribute<Vec3>,
    texture_coordinates: Attribute<Vec2>,
}

impl Tessellation {
    /// Adds a surface of `divisions[0]` × `divisions[1]` cells, each of two triangles. `at(j, i)` gives its points: `j`
    /// counts to the right and `i` up, as seen from outside. Triangles with two equal vertices are left out.
    pub(super) fn surface(&mut self, divisions: [u32; 2], at: impl Fn(u32, u32) -> Vertex) {
        let [across, up] = divisions;
        let first = index(self.normals.values.len());
        let mut places = Vec::with_capacity((across as usize + 1) * (up as usize + 1));
        for (i, j) in (0..=up).flat_map(|i| (0..=across).map(move |j| (i, j))) {
            let Vertex { position, normal } = at(j, i);
            places.push(self.vertex(position.as_vec3()));
            self.normals.values.push(normal.normalize().as_vec3());
            let texture = [(j, across), (i, up)].map(|(k, n)| fraction(k, n));
            self.texture_coordinates.values.push(Vec2::from(texture));
        }
        let row = across + 1;
        for corner in (0..up).flat_map(|i| (0..across).map(move |j| i * row + j)) {
            let [a, b, c, d] = [corner, corner + 1, corner + row + 1, corner + row];
            self.triangle([a, b, c], &places, first);
            self.triangle([a, c, d], &places, first);
        }
    }

    /// The mesh.
    pub(super) fn finish(self) -> Mesh {
        let mesh = Mesh::new(self.positions, self.triangles)
            .and_then(|mesh| mesh.with_normals(self.normals))
            .and_then(|mesh| mesh.with_texture_coordinates(self.texture_coordinates));
        mesh.expect("a tessellation names only vertices that it made")
    }

    fn vertex(&mut self, position: Vec3) -> u32 {
        // −0 and 0 are the same position.
        let position = position + Vec3::ZERO;
        let next = index(self.positions.len());
        *self.places.entry(position.to_array().map(f32::to_bits)).or_insert_with(|| {
            self.positions.push(position);
            next
        })
    }

    fn triangle(&mut self, corners: [u32; 3], places: &[u32], first: u32) {
        let [a, b, c] = corners.map(|corner| places[corner as usize]);
        if a != b && b != c && c != a {
            let attributes = corners.map(|corner| first + corner);
            self.triangles.push([a, b, c]);
            self.normals.corners.push(attributes);
            self.texture_coordinates.corners.push(attributes);
        }
    }
}

/// The cosine and the sine of `step/count` of a turn: exact at quarter turns, and symmetric to the last bit.
pub(super) fn turn(step: u32, count: u32) -> (f64, f64) {
    let (step, count) = (u64::from(step % count), u64::from(count));
    let (octant, rest) = (8 * step / count, 8 * step % count);
    // Odd octants mirror even ones.
    let rest = if octant % 2 == 0 { rest } else { count - rest };
    #[expect(clippy::cast_precision_loss, reason = "both are below 2^35")]
    let angle = FRAC_PI_4 * (rest as f64 / count as f64);
    let (cos, sin) = if rest == count {
        // At 45 degrees both are √½; computed separately, they might be rounded differently.
        (FRAC_1_SQRT_2, FRAC_1_SQRT_2)
    } else {
        (libm::cos(angle), libm::sin(angle))
    };
    match octant {
        0 => (cos, sin),
        1 => (sin, cos),
        2 => (-sin, cos),
        3 => (-cos, sin),
        4 => (-cos, -sin),
        5 => (-sin, -cos),
        6 => (sin, -cos),
        _ => (cos, -sin),
    }
}

/// The texture coordinate `step/count`.
fn fraction(step: u32, count: u32) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is asked")]
    let part = (f64::from(step) / f64::from(count)) as f32;
    part
}

fn index(number: usize) -> u32 {
    u32::try_from(number).expect("the number of triangles was checked")
}
