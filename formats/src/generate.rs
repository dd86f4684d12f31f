//! Generates meshes from formulas: spheres, cylinders, cones, tori, boxes, grids and the teapot.
//!
//! Closed surfaces are watertight by index: neighbours share their vertices, also at seams and caps. The teapot stands
//! on the origin; all others have their centre there. Normals point outward, triangles are counter-clockwise as seen
//! from outside, and all meshes have texture coordinates. Points at quarter turns are exact. Sines and cosines come from
//! one software library, so that a mesh has the same bits on every machine.

mod teapot;
mod tessellation;

use bothways_common::scene::Mesh;
use glam::{DVec2, DVec3};
use tessellation::{Tessellation, Vertex, turn};

/// The kinds of mesh that can be generated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A sphere of radius 1. Divisions: around, from pole to pole.
    Sphere,
    /// A cylinder of radius 1 around the y axis, from y = −1 to 1, with caps. Divisions: around, along.
    Cylinder,
    /// A cone of radius 1 at y = −1, with its apex at y = 1 and its base. Divisions: around, along.
    Cone,
    /// A ring of radius 1 around the y axis, its tube of radius 0.4. Divisions: around, around the
    /// tube.
    Torus,
    /// A cube from −1 to 1 along each axis. Divisions: along x and z, along y.
    Box,
    /// The square from −1 to 1 in the plane z = 0, facing +z. Divisions: across, up.
    Grid,
    /// Newell's teapot, 3.15 high, standing on y = 0, its spout towards +x; an open surface.
    /// Divisions: along both sides of each of its 32 patches.
    Teapot,
}

/// Why a mesh cannot be generated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GenerateError {
    /// There are too few divisions for the shape.
    #[error("a {kind} needs divisions of at least {}, {}; these are {}, {}",
            .least[0], .least[1], .divisions[0], .divisions[1])]
    TooFew {
        /// What was asked for.
        kind: Kind,
        /// As they were given.
        divisions: [u32; 2],
        /// The fewest divisions of this kind.
        least: [u32; 2],
    },
    /// There are too many divisions: the mesh would have more than [`MOST`] triangles.
    #[error("a {kind} with divisions {}, {} would have more than {MOST} triangles; take fewer",
            .divisions[0], .divisions[1])]
    TooMany {
        /// What was asked for.
        kind: Kind,
        /// As they were given.
        divisions: [u32; 2],
    },
}

/// The most triangles of a generated mesh.
pub const MOST: u64 = 100_000_000;

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 7] = [
        Kind::Sphere,
        Kind::Cylinder,
        Kind::Cone,
        Kind::Torus,
        Kind::Box,
        Kind::Grid,
        Kind::Teapot,
    ];

    /// The name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Sphere => "sphere",
            Kind::Cylinder => "cylinder",
            Kind::Cone => "cone",
            Kind::Torus => "torus",
            Kind::Box => "box",
            Kind::Grid => "grid",
            Kind::Teapot => "teapot",
        }
    }

    /// The kind of this name; `None` for any other name.
    pub fn named(name: &str) -> Option<Kind> {
        Kind::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Divisions that look good, for scene files that state none.
    pub fn default_divisions(self) -> [u32; 2] {
        match self {
            Kind::Sphere => [64, 32],
            Kind::Cylinder | Kind::Cone => [64, 1],
            Kind::Torus => [96, 48],
            Kind::Box => [1, 1],
            Kind::Grid => [8, 8],
            Kind::Teapot => [10, 10],
        }
    }

    /// The fewest divisions that give the shape.
    pub fn least_divisions(self) -> [u32; 2] {
        match self {
            Kind::Sphere => [3, 2],
            Kind::Cylinder | Kind::Cone => [3, 1],
            Kind::Torus => [3, 3],
            Kind::Box | Kind::Grid | Kind::Teapot => [1, 1],
        }
    }

    /// Generates the mesh. The variants of [`Kind`] say what the two divisions are.
    ///
    /// # Errors
    ///
    /// There are fewer divisions than [`Kind::least_divisions`], or so many that the mesh would have more than [`MOST`]
    /// triangles.
    ///
    /// ```
    /// use bothways_formats::generate::Kind;
    ///
    /// assert_eq!(Kind::Box.mesh([1, 1])?.triangles().len(), 12);
    /// # Ok::<(), bothways_formats::generate::GenerateError>(())
    /// ```
    pub fn mesh(self, divisions: [u32; 2]) -> Result<Mesh, GenerateError> {
        let least = self.least_divisions();
        if divisions[0] < least[0] || divisions[1] < least[1] {
            return Err(GenerateError::TooFew { kind: self, divisions, least });
        }
        let patches = match self {
            Kind::Teapot => 32,
            Kind::Box => 6,
            Kind::Cylinder | Kind::Cone => 3,
            Kind::Sphere | Kind::Torus | Kind::Grid => 1,
        };
        let cells = u64::from(divisions[0]).saturating_mul(divisions[1].into());
        if cells.saturating_mul(2 * patches) > MOST {
            return Err(GenerateError::TooMany { kind: self, divisions });
        }
        Ok(match self {
            Kind::Sphere => sphere(divisions),
            Kind::Cylinder => cylinder(divisions),
            Kind::Cone => cone(divisions),
            Kind::Torus => torus(divisions),
            Kind::Box => cuboid(divisions),
            Kind::Grid => grid(divisions),
            Kind::Teapot => teapot::teapot(divisions),
        })
    }
}

impl std::fmt::Display for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

fn sphere([around, along]: [u32; 2]) -> Mesh {
    let mut mesh = Tessellation::default();
    mesh.surface([around, along], |j, i| {
        // From the south pole to the north pole.
        let (minus_height, radius) = turn(i, 2 * along);
        let normal = on_circle(turn(j, around), radius, -minus_height);
        Vertex { position: normal, normal }
    });
    mesh.finish()
}

fn cylinder([around, along]: [u32; 2]) -> Mesh {
    let mut mesh = Tessellation::default();
    mesh.surface([around, along], |j, i| {
        let angle = turn(j, around);
        let position = on_circle(angle, 1.0, part(i, along));
        Vertex { position, normal: on_circle(angle, 1.0, 0.0) }
    });
    cap(&mut mesh, around, 1.0);
    cap(&mut mesh, around, -1.0);
    mesh.finish()
}

fn cone([around, along]: [u32; 2]) -> Mesh {
    let mut mesh = Tessellation::default();
    mesh.surface([around, along], |j, i| {
        let (angle, height) = (turn(j, around), part(i, along));
        // The side rises by 2 while its radius shrinks by 1. At the apex each triangle has a normal of its own.
        let radius = 0.5 * (1.0 - height);
        Vertex { position: on_circle(angle, radius, height), normal: on_circle(angle, 2.0, 1.0) }
    });
    cap(&mut mesh, around, -1.0);
    mesh.finish()
}

/// Adds a disc of radius 1 at a height, which faces away from the origin.
fn cap(mesh: &mut Tessellation, around: u32, height: f64) {
    mesh.surface([around, 1], |j, i| {
        // The upper disc runs from the rim to the middle, the lower one from the middle to the rim: both face outward.
        let at_rim = (i == 0) == (height > 0.0);
        let radius = if at_rim { 1.0 } else { 0.0 };
        let position = on_circle(turn(j, around), radius, height);
        Vertex { position, normal: DVec3::new(0.0, height, 0.0) }
    });
}

fn torus([around, tube]: [u32; 2]) -> Mesh {
    const TUBE: f64 = 0.4;
    let mut mesh = Tessellation::default();
    mesh.surface([around, tube], |j, i| {
        let (angle, (outward, up)) = (turn(j, around), turn(i, tube));
        Vertex {
            position: on_circle(angle, 1.0 + TUBE * outward, TUBE * up),
            normal: on_circle(angle, outward, up),
        }
    });
    mesh.finish()
}

fn cuboid(divisions: [u32; 2]) -> Mesh {
    let mut mesh = Tessellation::default();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let others = [(axis + 1) % 3, (axis + 2) % 3];
            let divisions = others.map(|axis| divisions[usize::from(axis == 1)]);
            mesh.surface(divisions, |j, i| {
                // The axes must be right-handed as seen from outside: on the negative side, one is mirrored.
                let mut position = DVec3::ZERO;
                position[axis] = side;
                position[others[0]] = side * part(j, divisions[0]);
                position[others[1]] = part(i, divisions[1]);
                let mut normal = DVec3::ZERO;
                normal[axis] = side;
                Vertex { position, normal }
            });
        }
    }
    mesh.finish()
}

fn grid(divisions: [u32; 2]) -> Mesh {
    let mut mesh = Tessellation::default();
    mesh.surface(divisions, |j, i| {
        let place = DVec2::new(part(j, divisions[0]), part(i, divisions[1]));
        Vertex { position: place.extend(0.0), normal: DVec3::Z }
    });
    mesh.finish()
}

/// The coordinate after `step` of `count` equal steps from −1 to 1: symmetric, and exact for powers of two.
fn part(step: u32, count: u32) -> f64 {
    (2.0 * f64::from(step) - f64::from(count)) / f64::from(count)
}

/// A point of a circle around the y axis. The angle counts from +x towards −z: to the right as seen from outside.
fn on_circle((cos, sin): (f64, f64), radius: f64, height: f64) -> DVec3 {
    DVec3::new(radius * cos, height, -radius * sin)
}

#[cfg(test)]
mod tests;
