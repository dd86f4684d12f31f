//! Scenes that cost far more than they show where a renderer looks at what is near instead of at what is covered, each
//! with an ordinary scene of as many triangles that cover as many samples.

use super::support::{Alignment, FULL_HD, on_pixels, scene, squares};
use bothways::common::glam::{Vec2, Vec3};
use bothways::common::{Frame, Mesh, Options, Scene, View, Work};
use bothways::rasterize::fast;

/// What is unusual about the triangles of a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Pathology {
    /// Slivers a third of a pixel wide that cross the picture in all directions.
    Slivers,
    /// A million triangles in one place.
    Coincident,
    /// Triangles of all directions around one centroid.
    Centroids,
    /// Needles along one diagonal, side by side.
    Needles,
    /// A grid of 2-pixel squares, a third of a pixel off the samples.
    Grid,
}

/// A pathological scene, or its ordinary counterpart.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Case {
    Pathological(Pathology),
    Ordinary(Pathology),
}

impl Case {
    pub(crate) const ALL: [Case; 10] = {
        use Case::{Ordinary, Pathological};
        use Pathology::{Centroids, Coincident, Grid, Needles, Slivers};
        [
            Pathological(Slivers),
            Ordinary(Slivers),
            Pathological(Coincident),
            Ordinary(Coincident),
            Pathological(Centroids),
            Ordinary(Centroids),
            Pathological(Needles),
            Ordinary(Needles),
            Pathological(Grid),
            Ordinary(Grid),
        ]
    };

    /// The scene, and how many pairs of a triangle and a sample that it covers there are.
    pub(crate) fn scene(self) -> (Scene, u64) {
        let (Case::Pathological(pathology) | Case::Ordinary(pathology)) = self;
        let pathological = scene([pathology.mesh()]);
        let covered = covered(&pathological);
        match self {
            Case::Pathological(_) => (pathological, covered),
            Case::Ordinary(_) => {
                let count = pathological.name_count();
                let ordinary = scene([scattered(count, covered as f32 / count as f32)]);
                let covered = self::covered(&ordinary);
                (ordinary, covered)
            }
        }
    }
}

/// The fragments of a scene.
fn covered(scene: &Scene) -> u64 {
    let (camera, mut work) = (on_pixels(), Work::default());
    let mut frame = Frame::new(&camera, &Options::default());
    let (view, options) = (View::new(scene, &camera), Options::default());
    fast::determine_visibility(&fast::prepare(scene), &view, &options, &mut frame, &mut work);
    work.fragments
}

impl Pathology {
    fn mesh(self) -> Mesh {
        match self {
            Pathology::Slivers => triangles(4000, |k| {
                let [along, middle] = [turned(part(k, 0.618_034)), place(k)];
                let across = along.perp() * 0.33;
                [middle - along * 2500.0, middle + along * 2500.0, middle + across]
            }),
            Pathology::Coincident => {
                let corners = [Vec2::new(-4.2, -3.7), Vec2::new(4.4, -3.1), Vec2::new(0.3, 4.9)];
                mesh(1_000_000, |_| corners.map(|corner| corner.extend(-1000.0)))
            }
            Pathology::Centroids => triangles(20_000, |k| {
                let radius = 5.0 + 195.0 * part(k, 0.754_877_7);
                [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|third| radius * turned(part(k, 0.618_034) + third))
            }),
            Pathology::Needles => triangles(100_000, |k| {
                let (start, along) = (place(k), Vec2::new(100.0, 100.0));
                [start - along, start + along, start + Vec2::new(0.7, -0.7)]
            }),
            Pathology::Grid => squares(2, Alignment::Shifted),
        }
    }
}

/// Right triangles of this many samples at places that look random.
fn scattered(count: u32, samples: f32) -> Mesh {
    let side = (2.0 * samples).sqrt();
    triangles(count, |k| {
        let corner = place(k);
        [corner, corner + Vec2::new(side, 0.0), corner + Vec2::new(0.0, side)]
    })
}

/// Triangles given in pixels from the middle of the image, each at a depth that looks random.
fn triangles(count: u32, corners: impl Fn(u32) -> [Vec2; 3]) -> Mesh {
    mesh(count, |k| {
        let depth = 1.0 + part(k, 0.569_840_3);
        corners(k).map(|corner| corner.extend(-1000.0) * depth)
    })
}

/// A mesh of triangles without common vertices.
fn mesh(count: u32, corners: impl Fn(u32) -> [Vec3; 3]) -> Mesh {
    let indices = (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Mesh::new((0..count).flat_map(corners).collect(), indices).expect("it is a mesh")
}

/// A place of the image.
fn place(k: u32) -> Vec2 {
    let [width, height] = FULL_HD.map(|side| 0.9 * side as f32);
    Vec2::new(width * (part(k, 0.618_034) - 0.5), height * (part(k, 0.754_877_7) - 0.5))
}

/// A number from 0 to 1 that looks random.
fn part(k: u32, step: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "it looks random")]
    let number = (f64::from(k + 1) * step).fract() as f32;
    number
}

/// A direction, at this part of a full turn.
fn turned(part: f32) -> Vec2 {
    Vec2::from_angle(std::f32::consts::TAU * part)
}
