//! The conventions that a renderer chooses: where it samples, how it looks, what covers, what is nearest.
//!
//! Each is an axis of its own, and our choice is the first on every axis. A [`Change`] is another choice on one axis: a
//! hypothesis about a renderer. Hypotheses on different axes combine.

mod field;
mod framing;
mod interpolation;
mod omission;
mod placement;
mod pose;
mod sampling;
mod stance;
mod vertices;

pub use field::Field;
pub use framing::{Evidence, Framing};
pub use interpolation::Interpolation;
pub use omission::{Between, Clip, NearPlane, Omission, Part, Several, ShapeKind};
pub use placement::Placement;
pub use pose::Pose;
pub use sampling::Sampling;
pub use stance::{Moved, Stance};
pub use vertices::Vertices;

use crate::common::exact::Side;
use crate::common::{Camera, Projection};
use field::fields;
use pose::poses;

/// One choice on every axis. The default is ours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Convention {
    /// The place of a pixel in the file.
    pub placement: Placement,
    /// The part of the pixel that is sampled, from left to right.
    pub columns: Sampling,
    /// The part of the pixel that is sampled, from top to bottom.
    pub rows: Sampling,
    /// Where the eye is, and how the axes of the camera lie.
    pub pose: Pose,
    /// The size of the viewport.
    pub field: Field,
    /// The size and the place of the whole picture.
    pub framing: Framing,
    /// The direction of view.
    pub look: Look,
    /// The way in which the rays spread.
    pub rays: Rays,
    /// Where the corners of triangles lie on the raster.
    pub vertices: Vertices,
    /// The edges that own their samples.
    pub edges: Edges,
    /// The faces that are drawn.
    pub faces: Faces,
    /// How the distance of a triangle follows from those of its corners.
    pub interpolation: Interpolation,
    /// The choice among the primitives at one sample.
    pub depth: Depth,
    /// Where a near plane clips; `None` for all before the eye.
    pub near: Option<NearPlane>,
    /// Where a far plane clips; `None` for no end.
    pub far: Option<Clip>,
    /// What is not drawn at all.
    pub omission: Omission,
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

impl Edges {
    /// Whether an edge on this side of a triangle owns the samples that lie exactly on it.
    pub(super) fn own(self, side: Side) -> bool {
        match self {
            Edges::TopLeft => matches!(side, Side::Left | Side::Top),
            Edges::BottomLeft => matches!(side, Side::Left | Side::Bottom),
            Edges::TopRight => matches!(side, Side::Right | Side::Top),
            Edges::BottomRight => matches!(side, Side::Right | Side::Bottom),
            Edges::Inclusive => true,
            Edges::Exclusive => false,
        }
    }
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// Another placement.
    Placement(Placement),
    /// Another sampling of the columns.
    Columns(Sampling),
    /// Another sampling of the rows.
    Rows(Sampling),
    /// Another eye or other axes.
    Pose(Pose),
    /// Another viewport.
    Field(Field),
    /// Another size and place of the picture, for which no other reason is known.
    Framing(Framing),
    /// Another direction of view.
    Look(Look),
    /// Other rays.
    Rays(Rays),
    /// Other places of vertices.
    Vertices(Vertices),
    /// Another fill rule.
    Edges(Edges),
    /// Culled faces.
    Faces(Faces),
    /// Another distance within triangles.
    Interpolation(Interpolation),
    /// Another choice by distance.
    Depth(Depth),
    /// A near plane.
    Near(NearPlane),
    /// A far plane.
    Far(Clip),
    /// Something that is not drawn.
    Omission(Omission),
}

impl Change {
    /// All changes that a renderer of this camera can make, and that change its picture, without those of placement and
    /// those that only a picture suggests: planes and omissions.
    pub fn of_rendering(camera: &Camera) -> Vec<Change> {
        let [width, height] = camera.image();
        let sampled = |n: u32, change: fn(Sampling) -> Change| {
            let others = Sampling::ALL.into_iter().skip(1);
            others.filter(move |sampling| sampling.is_possible(n)).map(change)
        };
        let mut changes: Vec<Change> = sampled(width, Change::Columns).collect();
        changes.extend(sampled(height, Change::Rows));
        changes.extend(fields(camera).into_iter().map(Change::Field));
        changes.extend(poses(camera).into_iter().map(Change::Pose));
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
        changes.extend(Vertices::OTHERS.map(Change::Vertices));
        // Parallel rays meet a triangle at distances that are linear in the picture.
        if camera.projection() == Projection::Perspective {
            changes.extend(Interpolation::OTHERS.map(Change::Interpolation));
        }
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
            Change::Near(_) => 9,
            Change::Far(_) => 10,
            Change::Omission(_) => 11,
            Change::Pose(_) => 12,
            Change::Framing(_) => 13,
            Change::Vertices(_) => 14,
            Change::Interpolation(_) => 15,
        }
    }

    /// Whether both are tried together from the start: they lie on different axes, and neither is so rare that it is only tried
    /// alone, or beside what explains much.
    pub fn is_paired_with(self, other: Change) -> bool {
        let is_rare = |change: Change| match change {
            Change::Pose(_) => true,
            Change::Field(field) => field.is_rare(),
            Change::Columns(sampling) | Change::Rows(sampling) => sampling == Sampling::OneMore,
            Change::Vertices(vertices) => vertices.is_nearly_exact(),
            Change::Interpolation(_) => true,
            _ => false,
        };
        self.axis() != other.axis() && !is_rare(self) && !is_rare(other)
    }

    /// Whether it leaves something out, by a number that only a picture suggests: it fits a part of any picture.
    pub(super) fn has_own_number(self) -> bool {
        matches!(self, Change::Near(_) | Change::Far(_) | Change::Omission(_))
    }

    /// Whether the change moves much of the picture, rather than a few samples that lie on edges, or nearly so, or at equal
    /// distances, or distances alone.
    pub fn is_coarse(self) -> bool {
        let moves_few = match self {
            Change::Vertices(vertices) => vertices.is_nearly_exact(),
            Change::Interpolation(_) => true,
            _ => false,
        };
        !self.is_rule_for_ties() && !moves_few
    }

    /// Whether it decides about samples exactly on edges, or at exactly equal distances, alone.
    pub(super) fn is_rule_for_ties(self) -> bool {
        matches!(self, Change::Edges(_) | Change::Depth(Depth::FirstOfEqual | Depth::LastOfEqual))
    }
}

impl Convention {
    /// This convention with another choice on one axis.
    pub fn with(self, change: Change) -> Convention {
        match change {
            Change::Placement(placement) => Convention { placement, ..self },
            Change::Columns(columns) => Convention { columns, ..self },
            Change::Rows(rows) => Convention { rows, ..self },
            Change::Pose(pose) => Convention { pose, ..self },
            Change::Field(field) => Convention { field, ..self },
            Change::Framing(framing) => Convention { framing, ..self },
            Change::Look(look) => Convention { look, ..self },
            Change::Rays(rays) => Convention { rays, ..self },
            Change::Vertices(vertices) => Convention { vertices, ..self },
            Change::Edges(edges) => Convention { edges, ..self },
            Change::Faces(faces) => Convention { faces, ..self },
            Change::Interpolation(interpolation) => Convention { interpolation, ..self },
            Change::Depth(depth) => Convention { depth, ..self },
            Change::Near(plane) => Convention { near: Some(plane), ..self },
            Change::Far(clip) => Convention { far: Some(clip), ..self },
            Change::Omission(omission) => Convention { omission, ..self },
        }
    }

    /// The choices that are not ours, in the order of the axes.
    pub fn changes(&self) -> Vec<Change> {
        self.each_change().collect()
    }

    fn each_change(self) -> impl Iterator<Item = Change> {
        let ours = Convention::default();
        let all = [
            (self.placement != ours.placement).then_some(Change::Placement(self.placement)),
            (self.columns != ours.columns).then_some(Change::Columns(self.columns)),
            (self.rows != ours.rows).then_some(Change::Rows(self.rows)),
            (self.pose != ours.pose).then_some(Change::Pose(self.pose)),
            (self.field != ours.field).then_some(Change::Field(self.field)),
            (self.framing != ours.framing).then_some(Change::Framing(self.framing)),
            (self.look != ours.look).then_some(Change::Look(self.look)),
            (self.rays != ours.rays).then_some(Change::Rays(self.rays)),
            (self.vertices != ours.vertices).then_some(Change::Vertices(self.vertices)),
            (self.edges != ours.edges).then_some(Change::Edges(self.edges)),
            (self.faces != ours.faces).then_some(Change::Faces(self.faces)),
            (self.interpolation != ours.interpolation)
                .then_some(Change::Interpolation(self.interpolation)),
            (self.depth != ours.depth).then_some(Change::Depth(self.depth)),
            self.near.map(Change::Near),
            self.far.map(Change::Far),
            (self.omission != ours.omission).then_some(Change::Omission(self.omission)),
        ];
        all.into_iter().flatten()
    }

    /// Where the renderer's own loops sample columns and rows. In a file that is upside down, or mirrored, far edges of pixels
    /// are near ones: a half that was forgotten and a half too much are the same picture there, and the former is likelier.
    pub(super) fn own_sampling(&self) -> [Sampling; 2] {
        let (mirrored, upside_down) = match self.placement {
            Placement::LeftToRight => (true, false),
            Placement::UpsideDown => (false, true),
            Placement::HalfTurn => (true, true),
            _ => (false, false),
        };
        [(self.columns, mirrored), (self.rows, upside_down)].map(|(sampling, turned)| {
            if turned && sampling == Sampling::FarCorner { Sampling::Corner } else { sampling }
        })
    }

    /// How many mistakes it takes: the same sampling of columns and rows is one.
    pub(super) fn mistakes(&self) -> usize {
        let [columns, rows] = self.own_sampling();
        let is_one = columns == rows && columns != Sampling::default();
        self.each_change().count() - usize::from(is_one)
    }

    /// The camera as a renderer with these conventions has it; the stated one where it cannot have the pose.
    pub(super) fn camera(&self, stated: &Camera) -> Camera {
        self.pose.camera(stated).unwrap_or(*stated)
    }

    /// Whether the whole picture has another size or place.
    pub(super) fn is_framed(&self) -> bool {
        self.framing != Framing::default()
    }

    /// Whether its eye and its axes are known from the file alone.
    pub(super) fn is_posed(&self) -> bool {
        matches!(self.pose, Pose::Measured(_))
    }

    /// Whether the contour of a mask alone tells its framing, or its eye and its axes.
    pub(super) fn is_measured_by_contour(&self) -> bool {
        self.framing.evidence == Evidence::Contour
            || matches!(self.pose, Pose::Measured(Stance { by_contour: true, .. }))
    }

    /// Whether its eye and all of its axes are known from the file alone.
    pub(super) fn is_freely_posed(&self) -> bool {
        matches!(self.pose, Pose::Measured(Stance { moved: Moved::All, .. }))
    }

    /// Whether something is not drawn: a primitive, an object, or what lies beyond a plane.
    pub fn leaves_out(&self) -> bool {
        self.each_change().any(Change::has_own_number)
    }

    /// Whether a part of the picture is blank.
    pub(super) fn leaves_part_blank(&self) -> bool {
        matches!(self.omission, Omission::Part(_))
    }

    /// Whether a plane clips what is drawn.
    pub(super) fn clips(&self) -> bool {
        self.near.is_some() || self.far.is_some()
    }

    /// Whether it has a change on this axis.
    pub(super) fn has(&self, axis: usize) -> bool {
        self.each_change().any(|change| change.axis() == axis)
    }

    /// The convention without one of its changes.
    pub fn without(&self, change: Change) -> Convention {
        let others = self.each_change().filter(|&other| other != change);
        others.fold(Convention::default(), Convention::with)
    }
}

/// A camera that looks at a point, with an `up` that is tilted and not of unit length.
#[cfg(test)]
fn tilted_camera(projection: Projection) -> Camera {
    use crate::common::glam::Vec3;
    use crate::common::{CameraDescription, Orientation};
    let description = CameraDescription {
        projection,
        eye: Vec3::new(1.0, 2.0, 6.5),
        orientation: Orientation::LookAt {
            target: Vec3::new(0.5, 0.75, -1.0),
            up: Vec3::new(0.25, 2.0, 0.5),
        },
        distance: 1.5,
        viewport: [2.0, 1.5],
        image: [8, 6],
    };
    Camera::new(description).unwrap()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::CameraDescription;

    #[test]
    fn a_square_picture_with_a_square_viewport_has_no_form_to_confuse() {
        use Field::{Double, DoubleHeight, DoubleWidth, Half, HalfHeight, HalfWidth};
        let sides = [HalfWidth, HalfHeight, DoubleWidth, DoubleHeight];
        let angles = [
            Field::TangentOfWholeAngle,
            Field::TangentOfQuarterAngle,
            Field::AngleForTangent,
            Field::DegreesAsRadians,
            Field::VerticalAsDiagonal,
        ];
        let square = *Camera::canonical(8, 8).description();
        for projection in [Projection::Perspective, Projection::Parallel] {
            let camera = Camera::new(CameraDescription { projection, ..square }).unwrap();
            let changes = Change::of_rendering(&camera).into_iter();
            let fields = changes.filter_map(|change| match change {
                Change::Field(field) => Some(field),
                _ => None,
            });
            // Parallel rays have no field of view.
            let of_angle = if projection == Projection::Parallel { &[][..] } else { &angles };
            let expected = [&[Double, Half], of_angle, &sides].concat();
            assert_eq!(fields.collect::<Vec<_>>(), expected);
        }
    }

    #[test]
    fn changes_are_found_again_and_taken_back() {
        let flipped = Change::Placement(Placement::UpsideDown);
        let both = Convention::default().with(flipped).with(Change::Edges(Edges::Inclusive));
        assert_eq!(both.changes(), [flipped, Change::Edges(Edges::Inclusive)]);
        assert_eq!(both.without(flipped).changes(), [Change::Edges(Edges::Inclusive)]);
    }
}
