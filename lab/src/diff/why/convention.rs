//! The conventions that a renderer chooses: where it samples, how it looks, what covers, what is nearest.
//!
//! Each is an axis of its own, and our choice is the first on every axis. A [`Change`] is another choice on one axis: a
//! hypothesis about a renderer. Hypotheses on different axes combine.

use crate::common::{Camera, Projection};

/// One choice on every axis. The default is ours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Convention {
    /// The place of a pixel in the file.
    pub placement: Placement,
    /// The part of the pixel that is sampled, from left to right.
    pub columns: Sampling,
    /// The part of the pixel that is sampled, from top to bottom.
    pub rows: Sampling,
    /// The size of the viewport.
    pub field: Field,
    /// The direction of view.
    pub look: Look,
    /// The way in which the rays spread.
    pub rays: Rays,
    /// The edges that own their samples.
    pub edges: Edges,
    /// The faces that are drawn.
    pub faces: Faces,
    /// The choice among the primitives at one sample.
    pub depth: Depth,
}

/// The place of a pixel in the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Placement {
    /// Rows from the top, columns from the left.
    #[default]
    Upright,
    /// Rows from the bottom.
    UpsideDown,
    /// Columns from the right.
    LeftToRight,
    /// Rows from the bottom and columns from the right.
    HalfTurn,
    /// Rows are columns.
    Transposed,
    /// A quarter turn to the left.
    TurnedLeft,
    /// A quarter turn to the right.
    TurnedRight,
    /// Rows are columns, both counted from the other end.
    OtherDiagonal,
}

impl Placement {
    /// All placements, ours first.
    pub const ALL: [Placement; 8] = [
        Placement::Upright,
        Placement::UpsideDown,
        Placement::LeftToRight,
        Placement::HalfTurn,
        Placement::Transposed,
        Placement::TurnedLeft,
        Placement::TurnedRight,
        Placement::OtherDiagonal,
    ];

    /// Whether the file has as many rows as the picture has columns.
    pub fn swaps_sides(self) -> bool {
        use Placement::{OtherDiagonal, Transposed, TurnedLeft, TurnedRight};
        matches!(self, Transposed | TurnedLeft | TurnedRight | OtherDiagonal)
    }

    /// The pixel of the picture that lies at `(i, j)` of the file; `[width, height]` is the size of the picture.
    pub fn pixel(self, [i, j]: [usize; 2], [width, height]: [usize; 2]) -> [usize; 2] {
        match self {
            Placement::Upright => [i, j],
            Placement::UpsideDown => [height - 1 - i, j],
            Placement::LeftToRight => [i, width - 1 - j],
            Placement::HalfTurn => [height - 1 - i, width - 1 - j],
            Placement::Transposed => [j, i],
            Placement::TurnedLeft => [j, width - 1 - i],
            Placement::TurnedRight => [height - 1 - j, i],
            Placement::OtherDiagonal => [height - 1 - j, width - 1 - i],
        }
    }
}

/// The coordinate on the viewport of the `j`-th of `n` columns or rows: `((j + offset)/(n − fewer) − ½)` of the side.
///
/// A pinhole camera with a principal point `c` and pixel centres at `j + s` has `(j + s − c)/n`. With `s = 0`, which is the
/// integer grid, the middle is `c = (n − 1)/2`, and `c = n/2` is [`Corner`](Sampling::Corner); with `s = ½` it is
/// `c = n/2`, and `c = (n − 1)/2` is [`FarCorner`](Sampling::FarCorner). No picture tells these from each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sampling {
    /// `(j + ½)/n`: the middle of the pixel.
    #[default]
    Middle,
    /// `j/n`: the left or top edge of the pixel.
    Corner,
    /// `(j + 1)/n`: the right or bottom edge of the pixel.
    FarCorner,
    /// `j/(n − 1)`: the first and the last sample lie on the border of the viewport.
    BorderToBorder,
    /// `(j + ½)/(n − 1)`.
    OneFewer,
    /// `(j − ½)/n`: the middle of the pixel before.
    PixelBefore,
    /// `(j + 3/2)/n`: the middle of the next pixel.
    PixelAfter,
}

impl Sampling {
    /// All ways of sampling, ours first.
    pub const ALL: [Sampling; 7] = [
        Sampling::Middle,
        Sampling::Corner,
        Sampling::FarCorner,
        Sampling::BorderToBorder,
        Sampling::OneFewer,
        Sampling::PixelBefore,
        Sampling::PixelAfter,
    ];

    /// Twice the offset, and the number by which the divisor is smaller than `n`.
    fn numbers(self) -> (i64, i64) {
        match self {
            Sampling::Middle => (1, 0),
            Sampling::Corner => (0, 0),
            Sampling::FarCorner => (2, 0),
            Sampling::BorderToBorder => (0, 1),
            Sampling::OneFewer => (1, 1),
            Sampling::PixelBefore => (-1, 0),
            Sampling::PixelAfter => (3, 0),
        }
    }

    /// Whether `n` columns or rows can be sampled in this way.
    pub fn is_possible(self, n: u32) -> bool {
        i64::from(n) > self.numbers().1
    }

    /// The coordinate of column or row `index` of `n` on a side of length 1, from −½ to ½. For [`Sampling::Middle`]
    /// it has the bits of the contract: `(2j + 1 − n)/(2n)`.
    #[expect(clippy::cast_precision_loss, reason = "whole numbers below 2^18")]
    pub fn coordinate(self, side: f64, index: u32, n: u32) -> f64 {
        let (twice_offset, fewer) = self.numbers();
        let divisor = i64::from(n) - fewer;
        let numerator = 2 * i64::from(index) + twice_offset - divisor;
        side * numerator as f64 / (2 * divisor) as f64
    }
}

/// The size of the viewport.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Field {
    /// The camera's `vw` and `vh`.
    #[default]
    AsStated,
    /// `vh` is taken for the width, and the height follows from the form of the image.
    VerticalAsHorizontal,
    /// `vw` is taken for the height, and the width follows from the form of the image.
    HorizontalAsVertical,
    /// The width is `vh`: the form of the image is left out.
    AspectLeftOut,
    /// The width is `vh·H/W` for `vh·W/H`.
    AspectInverted,
    /// Both sides are twice as long: a half side or half angle is taken for a whole one, or the other way round.
    Double,
    /// Both sides are half as long.
    Half,
}

impl Field {
    /// All fields, ours first.
    pub const ALL: [Field; 7] = [
        Field::AsStated,
        Field::VerticalAsHorizontal,
        Field::HorizontalAsVertical,
        Field::AspectLeftOut,
        Field::AspectInverted,
        Field::Double,
        Field::Half,
    ];

    /// Width and height of the viewport.
    pub fn viewport(self, camera: &Camera) -> [f64; 2] {
        let [vw, vh] = camera.viewport();
        let [width, height] = camera.image().map(f64::from);
        match self {
            Field::AsStated => [vw, vh],
            Field::VerticalAsHorizontal => [vh, vh * height / width],
            Field::HorizontalAsVertical => [vw * width / height, vw],
            Field::AspectLeftOut => [vh, vh],
            Field::AspectInverted => [vh * height / width, vh],
            Field::Double => [2.0 * vw, 2.0 * vh],
            Field::Half => [vw / 2.0, vh / 2.0],
        }
    }
}

/// The direction of view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Look {
    /// Along `−w`.
    #[default]
    Forward,
    /// Along `w`.
    Backward,
}

/// The way in which the rays spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Rays {
    /// As the camera's projection has it.
    #[default]
    AsStated,
    /// Parallel for a perspective camera, perspective for a parallel one.
    OtherProjection,
    /// Parallel rays that all begin at the eye.
    OneOrigin,
}

impl Rays {
    /// The projection of the rays of a camera.
    pub fn projection(self, stated: Projection) -> Projection {
        match (self, stated) {
            (Rays::AsStated, stated) => stated,
            (Rays::OtherProjection, Projection::Parallel) => Projection::Perspective,
            (Rays::OtherProjection, Projection::Perspective) | (Rays::OneOrigin, _) => {
                Projection::Parallel
            }
        }
    }
}

/// The edges that own a sample which lies exactly on them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Edges {
    /// Left edges, and level edges above the inside.
    #[default]
    TopLeft,
    /// Left edges, and level edges below the inside.
    BottomLeft,
    /// Right edges, and level edges above the inside.
    TopRight,
    /// Right edges, and level edges below the inside.
    BottomRight,
    /// All edges.
    Inclusive,
    /// No edge.
    Exclusive,
}

/// The faces that are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Faces {
    /// Both sides.
    #[default]
    Both,
    /// Only faces with their corners counter-clockwise.
    BackCulled,
    /// Only faces with their corners clockwise.
    FrontCulled,
}

/// The choice among the primitives that cover one sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Depth {
    /// The nearest, with ties as the contract has them.
    #[default]
    Nearest,
    /// The nearest; of equal distances the first in the scene.
    FirstOfEqual,
    /// The nearest; of equal distances the last in the scene.
    LastOfEqual,
    /// The farthest.
    Farthest,
    /// The last in the scene.
    LastDrawn,
    /// The first in the scene.
    FirstDrawn,
}

/// Another choice on one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Change {
    /// Another placement.
    Placement(Placement),
    /// Another sampling of the columns.
    Columns(Sampling),
    /// Another sampling of the rows.
    Rows(Sampling),
    /// Another viewport.
    Field(Field),
    /// Another direction of view.
    Look(Look),
    /// Other rays.
    Rays(Rays),
    /// Another fill rule.
    Edges(Edges),
    /// Culled faces.
    Faces(Faces),
    /// Another choice by distance.
    Depth(Depth),
}

impl Change {
    /// All changes that a renderer of this camera can make, and that change its picture, without those of placement.
    pub fn of_rendering(camera: &Camera) -> Vec<Change> {
        let [width, height] = camera.image();
        let sampled = |n: u32, change: fn(Sampling) -> Change| {
            let others = Sampling::ALL.into_iter().skip(1);
            others.filter(move |sampling| sampling.is_possible(n)).map(change)
        };
        let mut changes: Vec<Change> = sampled(width, Change::Columns).collect();
        changes.extend(sampled(height, Change::Rows));
        changes.extend(fields(camera).into_iter().map(Change::Field));
        changes.push(Change::Look(Look::Backward));
        changes.push(Change::Rays(Rays::OtherProjection));
        if camera.projection() == Projection::Parallel {
            changes.push(Change::Rays(Rays::OneOrigin));
        }
        changes.extend([Faces::BackCulled, Faces::FrontCulled].map(Change::Faces));
        changes.extend([Depth::Farthest, Depth::LastDrawn, Depth::FirstDrawn].map(Change::Depth));
        changes.extend([Depth::FirstOfEqual, Depth::LastOfEqual].map(Change::Depth));
        let others = [Edges::BottomLeft, Edges::TopRight, Edges::BottomRight];
        changes.extend(others.map(Change::Edges));
        changes.extend([Edges::Inclusive, Edges::Exclusive].map(Change::Edges));
        changes
    }

    /// The axis of the change: two changes on one axis exclude each other.
    pub fn axis(self) -> usize {
        match self {
            Change::Placement(_) => 0,
            Change::Columns(_) => 1,
            Change::Rows(_) => 2,
            Change::Field(_) => 3,
            Change::Look(_) => 4,
            Change::Rays(_) => 5,
            Change::Edges(_) => 6,
            Change::Faces(_) => 7,
            Change::Depth(_) => 8,
        }
    }

    /// Whether the change moves much of the picture, rather than a few samples that lie exactly on edges or at equal
    /// distances.
    pub fn is_coarse(self) -> bool {
        !matches!(self, Change::Edges(_) | Change::Depth(Depth::FirstOfEqual | Depth::LastOfEqual))
    }
}

/// The fields that differ from the stated viewport, each size once.
fn fields(camera: &Camera) -> Vec<Field> {
    let mut sizes = vec![Field::AsStated.viewport(camera)];
    let mut fields = Vec::new();
    for field in Field::ALL.into_iter().skip(1) {
        let size = field.viewport(camera);
        let same = |other: &[f64; 2]| {
            // A viewport in `f32` that was made for the form of the image.
            other.iter().zip(size).all(|(one, other)| (one / other - 1.0).abs() < 1e-6)
        };
        if !sizes.iter().any(same) {
            sizes.push(size);
            fields.push(field);
        }
    }
    fields
}

impl Convention {
    /// This convention with another choice on one axis.
    pub fn with(self, change: Change) -> Convention {
        match change {
            Change::Placement(placement) => Convention { placement, ..self },
            Change::Columns(columns) => Convention { columns, ..self },
            Change::Rows(rows) => Convention { rows, ..self },
            Change::Field(field) => Convention { field, ..self },
            Change::Look(look) => Convention { look, ..self },
            Change::Rays(rays) => Convention { rays, ..self },
            Change::Edges(edges) => Convention { edges, ..self },
            Change::Faces(faces) => Convention { faces, ..self },
            Change::Depth(depth) => Convention { depth, ..self },
        }
    }

    /// The choices that are not ours, in the order of the axes.
    pub fn changes(&self) -> Vec<Change> {
        let ours = Convention::default();
        let all = [
            Change::Placement(self.placement),
            Change::Columns(self.columns),
            Change::Rows(self.rows),
            Change::Field(self.field),
            Change::Look(self.look),
            Change::Rays(self.rays),
            Change::Edges(self.edges),
            Change::Faces(self.faces),
            Change::Depth(self.depth),
        ];
        all.into_iter().filter(|&change| ours.with(change) != ours).collect()
    }

    /// The convention without one of its changes.
    pub fn without(&self, change: Change) -> Convention {
        let others = self.changes().into_iter().filter(|&other| other != change);
        others.fold(Convention::default(), Convention::with)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn our_sampling_has_the_bits_of_the_camera() {
        let camera = Camera::canonical(3, 37);
        let x: Vec<f64> =
            (0..37).map(|j| Sampling::Middle.coordinate(camera.viewport()[0], j, 37)).collect();
        assert_eq!(x, camera.sample_grid(1).x());
    }

    #[test]
    fn the_ways_of_sampling_are_the_formulas_of_their_names() {
        let at = |sampling: Sampling| [0, 4].map(|j| sampling.coordinate(10.0, j, 5) + 5.0);
        let expected = [[1.0, 9.0], [0.0, 8.0], [2.0, 10.0], [0.0, 10.0], [1.25, 11.25]];
        for (sampling, expected) in Sampling::ALL.into_iter().zip(expected) {
            assert_eq!(at(sampling), expected, "{sampling:?}");
        }
        assert_eq!(at(Sampling::PixelBefore), [-1.0, 7.0]);
        assert_eq!(at(Sampling::PixelAfter), [3.0, 11.0]);
        assert!(!Sampling::BorderToBorder.is_possible(1));
    }

    #[test]
    fn a_principal_point_off_by_half_a_pixel_samples_corners() {
        for n in [1_u32, 4, 7, 640] {
            let (n_real, side) = (f64::from(n), 3.0);
            let [of_grid, of_centres] = [(n_real - 1.0) / 2.0, n_real / 2.0];
            for (sampling, centre, point) in [
                (Sampling::Middle, 0.0, of_grid),
                (Sampling::Corner, 0.0, of_centres),
                (Sampling::Middle, 0.5, of_centres),
                (Sampling::FarCorner, 0.5, of_grid),
            ] {
                for index in 0..n {
                    // All but the quotient is exact.
                    let expected =
                        side * (2.0 * (f64::from(index) + centre - point)) / (2.0 * n_real);
                    assert_eq!(sampling.coordinate(side, index, n), expected, "{sampling:?}");
                }
            }
        }
    }

    #[test]
    fn every_placement_reaches_every_pixel_once() {
        let size @ [width, height] = [3, 2];
        for placement in Placement::ALL {
            let [columns, rows] =
                if placement.swaps_sides() { [height, width] } else { [width, height] };
            let mut seen = vec![0; 6];
            for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
                let [i, j] = placement.pixel([i, j], size);
                seen[i * width + j] += 1;
            }
            assert_eq!(seen, [1; 6], "{placement:?}");
        }
    }

    #[test]
    fn a_square_picture_with_a_square_viewport_has_no_form_to_confuse() {
        let changes = Change::of_rendering(&Camera::canonical(8, 8));
        let fields: Vec<_> = changes.iter().filter(|change| change.axis() == 3).collect();
        assert_eq!(fields, [&Change::Field(Field::Double), &Change::Field(Field::Half)]);
    }

    #[test]
    fn changes_are_found_again_and_taken_back() {
        let flipped = Change::Placement(Placement::UpsideDown);
        let both = Convention::default().with(flipped).with(Change::Edges(Edges::Inclusive));
        assert_eq!(both.changes(), [flipped, Change::Edges(Edges::Inclusive)]);
        assert_eq!(both.without(flipped).changes(), [Change::Edges(Edges::Inclusive)]);
    }
}
