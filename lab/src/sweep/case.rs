//! The axes of a sweep, and the scenes along them.

use crate::common::glam::{DAffine3, DMat3, DVec3, Vec3};
use crate::common::{CameraDescription, Instances, Mesh, Placement, Shape};
use crate::formats::generate::Kind;
use crate::scenes::Framing;
use std::str::FromStr;

/// What grows along a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Axis {
    /// The triangles of a sphere that is seen whole: they get smaller as they become more.
    Triangles,
    /// The pixels of the image, for a sphere of 10 thousand triangles.
    Pixels,
    /// Layers that each cover the whole picture with as many triangles, the farthest first in the scene.
    DepthComplexity,
    /// The area of a triangle in pixels, for one layer that covers the picture: larger ones are fewer.
    TriangleSize,
    /// Instances of one sphere of a thousand triangles, in a cube that is seen whole: they get smaller as they become more.
    Instances,
}

impl Axis {
    /// All axes.
    pub const ALL: [Axis; 5] =
        [Axis::Triangles, Axis::Pixels, Axis::DepthComplexity, Axis::TriangleSize, Axis::Instances];

    /// The name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Axis::Triangles => "triangles",
            Axis::Pixels => "pixels",
            Axis::DepthComplexity => "depth-complexity",
            Axis::TriangleSize => "triangle-size",
            Axis::Instances => "instances",
        }
    }

    /// What a value on the axis counts.
    pub fn unit(self) -> &'static str {
        match self {
            Axis::Triangles => "triangles",
            Axis::Pixels => "pixels",
            Axis::DepthComplexity => "layers",
            Axis::TriangleSize => "pixels a triangle",
            Axis::Instances => "instances of 1,024 triangles",
        }
    }

    /// The scene that is swept, in words.
    pub fn scene(self) -> &'static str {
        match self {
            Axis::Triangles => "a sphere, seen whole",
            Axis::Pixels => "a sphere of 10,000 triangles",
            Axis::DepthComplexity => "opaque layers of 80 triangles, the farthest first",
            Axis::TriangleSize => "one layer over the whole picture",
            Axis::Instances => "a cube of spheres, one mesh of 1,024 triangles",
        }
    }

    /// The scenes along the axis: of at most so many triangles, where they grow; in an image of this size, where it does
    /// not grow.
    pub(super) fn cases(self, most: u64, image: [u32; 2]) -> Vec<Case> {
        let cases: Vec<Case> = match self {
            Axis::Triangles => SPHERES.map(|rings| Case::sphere(self, rings, image)).into(),
            Axis::Pixels => IMAGES.map(|image| Case::sphere(self, FIXED_SPHERE, image)).into(),
            Axis::DepthComplexity => {
                (0..=10).map(|power| Case::layers(self, LAYER, 1 << power, image)).collect()
            }
            Axis::TriangleSize => {
                AREAS.map(|area| Case::layers(self, cells_of(area, image), 1, image)).into()
            }
            Axis::Instances => ALONG_CUBE.map(|along| Case::crowd(along, image)).into(),
        };
        let mut cases: Vec<Case> = cases
            .into_iter()
            .filter(|case| match self {
                Axis::Pixels => true,
                Axis::Instances => case.triangles <= most * INSTANCED,
                _ => case.triangles <= most,
            })
            .collect();
        cases.sort_by(|a, b| a.x.total_cmp(&b.x));
        // In a small image, several sizes may come down to the same cells.
        cases.dedup_by(|a, b| a.x.to_bits() == b.x.to_bits());
        cases
    }
}

impl FromStr for Axis {
    type Err = String;

    fn from_str(name: &str) -> Result<Axis, String> {
        Axis::ALL.into_iter().find(|axis| axis.name() == name).ok_or_else(|| {
            let names = Axis::ALL.map(Axis::name).join(", ");
            format!("there is no axis '{name}'; the axes are {names}")
        })
    }
}

/// The rings of the spheres: a third of a power of ten from one to the next, from 100 triangles to 10 million.
const SPHERES: [u32; 16] = [5, 7, 11, 16, 23, 34, 50, 73, 108, 158, 232, 341, 500, 734, 1077, 1581];
/// The rings of the sphere of 10 thousand triangles.
const FIXED_SPHERE: u32 = 50;
/// Images of the same form, whose pixels double from one to the next, or nearly so.
const IMAGES: [[u32; 2]; 13] = [
    [32, 18],
    [48, 27],
    [64, 36],
    [96, 54],
    [128, 72],
    [192, 108],
    [256, 144],
    [384, 216],
    [512, 288],
    [768, 432],
    [1024, 576],
    [1536, 864],
    [2048, 1152],
];
/// The instances along each side of a cube of them.
const ALONG_CUBE: [u32; 12] = [1, 2, 3, 4, 6, 8, 11, 16, 22, 32, 45, 64];
/// The rings of their sphere.
const CROWD_SPHERE: u32 = 16;
/// How many times as many triangles there may be if they are not stored.
const INSTANCED: u64 = 300;
/// The columns and rows of a layer.
const LAYER: [u32; 2] = [8, 5];
/// The areas of triangles, in pixels.
const AREAS: [f64; 12] = [0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5];

/// One scene of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// What grows.
    pub axis: Axis,
    /// Its value: triangles, pixels, layers, pixels a triangle, or instances.
    pub x: f64,
    /// The triangles of the scene.
    pub triangles: u64,
    /// The image's width and height in pixels.
    pub image: [u32; 2],
    pub(super) form: Form,
}

/// How the scene is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Sphere { rings: u32 },
    Layers { cells: [u32; 2], layers: u32 },
    Crowd { along: u32 },
}

impl Case {
    /// A sphere of `4 · rings²` triangles, in an image of this size.
    pub fn sphere(axis: Axis, rings: u32, image: [u32; 2]) -> Case {
        // Twice as many columns as rings; the two rings at the poles have half the triangles.
        let triangles = 4 * u64::from(rings) * u64::from(rings);
        let x = if axis == Axis::Triangles { triangles as f64 } else { area(image) };
        Case { axis, x, triangles, image, form: Form::Sphere { rings } }
    }

    fn layers(axis: Axis, cells: [u32; 2], layers: u32, image: [u32; 2]) -> Case {
        let in_layer = 2 * u64::from(cells[0]) * u64::from(cells[1]);
        let x = if axis == Axis::DepthComplexity {
            f64::from(layers)
        } else {
            OVERSCAN * OVERSCAN * area(image) / in_layer as f64
        };
        let form = Form::Layers { cells, layers };
        Case { axis, x, triangles: in_layer * u64::from(layers), image, form }
    }

    fn crowd(along: u32, image: [u32; 2]) -> Case {
        let instances = u64::from(along).pow(3);
        let triangles = 4 * u64::from(CROWD_SPHERE).pow(2) * instances;
        let form = Form::Crowd { along };
        Case { axis: Axis::Instances, x: instances as f64, triangles, image, form }
    }

    /// The samples of the image.
    pub fn samples(&self) -> u64 {
        u64::from(self.image[0]) * u64::from(self.image[1])
    }

    /// The scene's only object, and the camera that sees it.
    ///
    /// # Panics
    ///
    /// A sphere has at least two rings.
    pub fn shape(&self) -> (Shape, CameraDescription) {
        match self.form {
            Form::Sphere { rings } => {
                let mesh = ball(rings);
                let framing = Framing { image: self.image, ..Framing::default() };
                let camera = framing.camera(&mesh).expect("a sphere has a size");
                (Shape::Mesh(mesh), camera)
            }
            Form::Layers { cells, layers } => {
                let [width, height] = self.image.map(|side| side as f32);
                let viewport = [width / height, 1.0];
                let image = self.image;
                let camera = CameraDescription { viewport, image, ..CameraDescription::default() };
                (Shape::Mesh(layered(cells, layers, viewport)), camera)
            }
            Form::Crowd { along } => {
                let cube = Kind::Box.mesh([1, 1]).expect("a box has so many divisions");
                let framing = Framing { image: self.image, ..Framing::default() };
                let camera = framing.camera(&cube).expect("a box has a size");
                (Shape::Instances(crowd(along)), camera)
            }
        }
    }
}

fn ball(rings: u32) -> Mesh {
    Kind::Sphere.mesh([2 * rings, rings + 1]).expect("a sphere has so many divisions")
}

/// As many spheres along each side of the cube from −1 to 1, each somewhere in a cell of its own.
fn crowd(along: u32) -> Instances {
    let mut dice = fastrand::Rng::with_seed(u64::from(along));
    let cell = 2.0 / f64::from(along);
    let mut place = |index: u32| {
        let beside = 0.1 * (dice.f64() - 0.5);
        ((f64::from(index) + 0.5 + beside) * cell - 1.0, 0.45 * cell)
    };
    let mut placements = Vec::with_capacity((along * along * along) as usize);
    for x in 0..along {
        for y in 0..along {
            for z in 0..along {
                let [(x, radius), (y, _), (z, _)] = [place(x), place(y), place(z)];
                placements.push(Placement::from_affine(&DAffine3 {
                    matrix3: DMat3::from_diagonal(DVec3::splat(radius)),
                    translation: DVec3::new(x, y, z),
                }));
            }
        }
    }
    Instances::new(ball(CROWD_SPHERE), placements).expect("they are near")
}

/// How much larger than the picture a layer is, on each axis, so that all of the picture is covered.
const OVERSCAN: f64 = 1.02;

/// Layers of equal cells, each of two triangles, one behind the other: each covers the picture of a camera in the origin.
fn layered([columns, rows]: [u32; 2], layers: u32, viewport: [f32; 2]) -> Mesh {
    let corners = (columns as usize + 1) * (rows as usize + 1);
    let mut positions = Vec::with_capacity(corners * layers as usize);
    let mut triangles = Vec::with_capacity(2 * (columns * rows * layers) as usize);
    for layer in 0..layers {
        // The farthest layer comes first.
        let depth = 1.0 + f64::from(layers - layer) / f64::from(layers);
        // No two layers show their edges in the same place, and none shows them exactly on samples.
        let shift = 0.008 * ((f64::from(layer) * 0.618_033_988_749 + 0.37).fract() - 0.5);
        let first = u32::try_from(positions.len()).expect("there are fewer vertices than numbers");
        for row in 0..=rows {
            for column in 0..=columns {
                let part = |at: u32, of: u32| f64::from(at) / f64::from(of) - 0.5 + shift;
                let x = part(column, columns) * OVERSCAN * f64::from(viewport[0]) * depth;
                let y = part(row, rows) * OVERSCAN * f64::from(viewport[1]) * depth;
                #[expect(clippy::cast_possible_truncation, reason = "a mesh's numbers are f32")]
                positions.push(Vec3::new(x as f32, y as f32, -depth as f32));
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let a = first + row * (columns + 1) + column;
                let (b, c) = (a + 1, a + columns + 1);
                triangles.extend([[a, b, c], [b, c + 1, c]]);
            }
        }
    }
    Mesh::new(positions, triangles).expect("positions are finite, and triangles name them")
}

/// The columns and rows of square cells whose triangles have about this area.
fn cells_of(pixels: f64, image: [u32; 2]) -> [u32; 2] {
    let side = (2.0 * pixels).sqrt() / OVERSCAN;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most thousands"
    )]
    image.map(|length| ((f64::from(length) / side).round() as u32).max(1))
}

fn area([width, height]: [u32; 2]) -> f64 {
    f64::from(width) * f64::from(height)
}
