//! The reasons for which a renderer shows something else at a sample than is true.

use super::convention::Edges;
use crate::common::exact::Side;
use serde::Serialize;

/// Why a renderer shows something else at a sample than is true.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// The sample lies exactly on an edge of a triangle, and the rule for such samples decides.
    EdgeTie {
        /// The triangle.
        primitive: u32,
        /// The side of the triangle on which the edge lies, as seen.
        side: Side,
        /// The rules that decide as the renderer did.
        rules: TieRules,
    },
    /// The sample lies exactly on a corner of a triangle.
    CornerTie {
        /// The triangle.
        primitive: u32,
        /// The rules that decide as the renderer did.
        rules: TieRules,
    },
    /// Two primitives are met at exactly the same distance.
    DistanceTie {
        /// The one that is seen, and the one that is shown.
        primitives: [u32; 2],
    },
    /// The sample lies so close to the outline of a primitive that rounding takes it to the other side.
    Rounding {
        /// The primitive.
        primitive: u32,
        /// The distance from the sample to the outline, in pixels.
        pixels: f64,
    },
    /// Two primitives are met at nearly the same distance.
    DistanceRounding {
        /// The one that is seen, and the one that is shown.
        primitives: [u32; 2],
        /// The difference as a part of the distance.
        relative: f64,
    },
    /// The primitive faces away (or towards the eye), and no such face is shown anywhere, though
    /// others are, and such faces are missing more than a pixel within their outlines.
    Culled {
        /// The triangle.
        primitive: u32,
        /// Whether its corners are clockwise as seen: a back face.
        is_back: bool,
    },
    /// The primitive reaches behind the eye.
    BehindTheEye {
        /// The primitive.
        primitive: u32,
    },
    /// The primitive is met nearer than anything that is shown: a near plane lies between.
    NearPlane {
        /// The primitive.
        primitive: u32,
        /// Its depth along the axis of the camera.
        depth: f64,
    },
    /// The sample lies between the outline of a sphere and that of a mesh in its place.
    Tessellation {
        /// The sphere.
        primitive: u32,
        /// The distance from the sample to the outline, in pixels.
        pixels: f64,
    },
    /// The sample lies within a pixel of the outline of a primitive, or of where it meets another one: the renderer sampled elsewhere in the pixel, or the
    /// primitive lies elsewhere by less than a pixel.
    Elsewhere {
        /// The primitive.
        primitive: u32,
        /// The distance from the sample to that line, in pixels.
        pixels: f64,
    },
    /// The conventions of the renderer as a whole explain the pixel.
    Convention,
    /// Both files agree with the truth within tolerance, and differ from one another by more.
    WithinTolerance,
    /// What the file holds does not tell: colours alone.
    CannotTell,
    /// None of these.
    Unexplained,
}

/// How rules other than the top-left rule decide an exact tie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TieRules {
    /// Whether the top-left rule gives the sample to the triangle.
    pub owns: bool,
    /// The rules that decide otherwise, in the order of [`Edges`].
    pub others: [Option<Edges>; 5],
}

impl TieRules {
    /// Which primitive owns the sample, and by which rules the other does.
    fn sentence(self, primitive: u32) -> String {
        let name = |edges: Edges| match edges {
            Edges::TopLeft => "top-left",
            Edges::BottomLeft => "bottom-left",
            Edges::TopRight => "top-right",
            Edges::BottomRight => "bottom-right",
            Edges::Inclusive => "inclusive",
            Edges::Exclusive => "exclusive",
        };
        let [ours, theirs] =
            if self.owns { ["gives it to", "does not"] } else { ["keeps it from", "gives it"] };
        let others: Vec<&str> = self.others.into_iter().flatten().map(name).collect();
        let others = match &others[..] {
            [] => "no other edge rule decides otherwise".to_owned(),
            [one] => format!("a rule that is {one} {theirs}"),
            [first @ .., last] => format!("a rule that is {} or {last} {theirs}", first.join(", ")),
        };
        format!("the top-left rule {ours} id {primitive}; {others}")
    }
}

/// The kinds of reasons, for counting and for colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ReasonKind {
    /// Exactly on an edge or a corner.
    Tie,
    /// At exactly the same distance.
    DistanceTie,
    /// Rounding of edges.
    Rounding,
    /// Rounding of distances.
    DistanceRounding,
    /// Faces that are culled.
    Culled,
    /// What reaches behind the eye or before a near plane.
    Clipped,
    /// A sphere drawn as a mesh.
    Tessellation,
    /// Less than a pixel from an edge, and farther than rounding reaches.
    Elsewhere,
    /// The conventions of the renderer as a whole.
    Convention,
    /// Both files are right within tolerance.
    WithinTolerance,
    /// The files do not tell.
    CannotTell,
    /// No reason was found.
    Unexplained,
}

impl ReasonKind {
    /// All kinds, in the order of the report.
    pub const ALL: [ReasonKind; 12] = [
        ReasonKind::Tie,
        ReasonKind::DistanceTie,
        ReasonKind::Rounding,
        ReasonKind::DistanceRounding,
        ReasonKind::Culled,
        ReasonKind::Clipped,
        ReasonKind::Tessellation,
        ReasonKind::Elsewhere,
        ReasonKind::Convention,
        ReasonKind::WithinTolerance,
        ReasonKind::CannotTell,
        ReasonKind::Unexplained,
    ];

    /// The kind in a table or a legend.
    pub fn name(self) -> &'static str {
        match self {
            ReasonKind::Tie => "exact tie on an edge or corner",
            ReasonKind::DistanceTie => "exact tie in distance",
            ReasonKind::Rounding => "rounding near an edge",
            ReasonKind::DistanceRounding => "rounding of distances",
            ReasonKind::Culled => "culled face",
            ReasonKind::Clipped => "clipped near or behind the eye",
            ReasonKind::Tessellation => "sphere against its mesh",
            ReasonKind::Elsewhere => "within a pixel of an outline",
            ReasonKind::Convention => "conventions, see below",
            ReasonKind::WithinTolerance => "both right within tolerance",
            ReasonKind::CannotTell => "cannot tell from these files",
            ReasonKind::Unexplained => "unexplained",
        }
    }

    /// The colour of the kind, in sRGB. Readers with any colour vision can distinguish the first seven: Okabe and Ito,
    /// "Color Universal Design", 2008. What is unexplained is white.
    pub fn color(self) -> [u8; 3] {
        match self {
            ReasonKind::Tie => [0x00, 0x9e, 0x73],
            ReasonKind::DistanceTie => [0xf0, 0xe4, 0x42],
            ReasonKind::Rounding => [0xe6, 0x9f, 0x00],
            ReasonKind::DistanceRounding => [0xcc, 0x79, 0xa7],
            ReasonKind::Culled => [0x00, 0x72, 0xb2],
            ReasonKind::Clipped => [0x56, 0xb4, 0xe9],
            ReasonKind::Tessellation => [0xd5, 0x5e, 0x00],
            ReasonKind::Elsewhere => [0xb2, 0x9b, 0xff],
            ReasonKind::Convention => [0xff, 0xd2, 0xb8],
            ReasonKind::WithinTolerance => [0xc8, 0xc8, 0xc8],
            ReasonKind::CannotTell => [0x99, 0x99, 0x99],
            ReasonKind::Unexplained => [0xff, 0xff, 0xff],
        }
    }
}

impl Reason {
    /// The kind of the reason.
    pub fn kind(&self) -> ReasonKind {
        match self {
            Reason::EdgeTie { .. } | Reason::CornerTie { .. } => ReasonKind::Tie,
            Reason::DistanceTie { .. } => ReasonKind::DistanceTie,
            Reason::Rounding { .. } => ReasonKind::Rounding,
            Reason::DistanceRounding { .. } => ReasonKind::DistanceRounding,
            Reason::Culled { .. } => ReasonKind::Culled,
            Reason::BehindTheEye { .. } | Reason::NearPlane { .. } => ReasonKind::Clipped,
            Reason::Tessellation { .. } => ReasonKind::Tessellation,
            Reason::Elsewhere { .. } => ReasonKind::Elsewhere,
            Reason::Convention => ReasonKind::Convention,
            Reason::WithinTolerance => ReasonKind::WithinTolerance,
            Reason::CannotTell => ReasonKind::CannotTell,
            Reason::Unexplained => ReasonKind::Unexplained,
        }
    }

    /// The reason as a sentence about the renderer that is wrong.
    pub fn sentence(&self) -> String {
        match self {
            Reason::EdgeTie { primitive, side, rules } => {
                let (side, decision) = (side.name(), rules.sentence(*primitive));
                format!("the sample lies exactly on a {side} edge of id {primitive}: {decision}")
            }
            Reason::CornerTie { primitive, rules } => {
                let decision = rules.sentence(*primitive);
                format!("the sample lies exactly on a corner of id {primitive}: {decision}")
            }
            Reason::DistanceTie { primitives: [seen, shown] } => format!(
                "ids {seen} and {shown} are met at exactly the same distance: id {seen} is seen by the rule for ties, and \
                 the renderer shows id {shown}"
            ),
            Reason::Rounding { primitive, pixels } => format!(
                "the sample lies {} pixels from the outline of id {primitive}: rounding took it to the other side",
                short(*pixels)
            ),
            Reason::DistanceRounding { primitives: [seen, shown], relative } => format!(
                "ids {seen} and {shown} are met at distances that differ by {} of them: rounding exchanged them",
                short(*relative)
            ),
            Reason::Culled { primitive, is_back } => {
                let (side, turn) =
                    if *is_back { ("back", "clockwise") } else { ("front", "counter-clockwise") };
                format!(
                    "id {primitive} is a {side} face (its corners are {turn} as seen), and no {side} face is shown \
                     anywhere: they are culled"
                )
            }
            Reason::BehindTheEye { primitive } => format!(
                "id {primitive} reaches behind the eye: it was dropped, or clipped away, or projected without \
                 clipping"
            ),
            Reason::NearPlane { primitive, depth } => format!(
                "id {primitive} is met at depth {} along the axis, nearer than anything that is shown: a near plane \
                 clips it",
                short(*depth)
            ),
            Reason::Tessellation { primitive, pixels } => format!(
                "the sample lies {} pixels from the outline of sphere {primitive}: a mesh stands in its place",
                short(*pixels)
            ),
            Reason::Elsewhere { primitive, pixels } => format!(
                "the sample lies {} pixels from where id {primitive} ends or meets another, farther than rounding reaches: the \
                 renderer sampled elsewhere in the pixel, or placed the outline elsewhere",
                short(*pixels)
            ),
            Reason::Convention => {
                "the conventions of the renderer as a whole explain it: see the report of all pixels".into()
            }
            Reason::WithinTolerance => {
                "each lies within tolerance of the true distance, on either side of it".into()
            }
            Reason::CannotTell => {
                "the files hold colours here, which do not tell what was seen".into()
            }
            Reason::Unexplained => "no edge, tie or plane explains it".into(),
        }
    }

    /// The reason that explains two facts at once is the one that asks for more.
    pub(super) fn worse(self, other: Reason) -> Reason {
        let rank = |reason: &Reason| match reason {
            Reason::Rounding { pixels, .. }
            | Reason::Elsewhere { pixels, .. }
            | Reason::Tessellation { pixels, .. } => *pixels,
            Reason::DistanceRounding { relative, .. } => *relative,
            _ => 0.0,
        };
        let order = self.kind().cmp(&other.kind()).then(rank(&self).total_cmp(&rank(&other)));
        if order.is_lt() { other } else { self }
    }
}

/// Three digits of a small number.
fn short(number: f64) -> String {
    if number == 0.0 || (0.001..1e6).contains(&number) {
        let rounded: f64 = format!("{number:.2e}").parse().unwrap_or(number);
        rounded.to_string()
    } else {
        format!("{number:.1e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_two_reasons_the_one_that_asks_for_more_counts() {
        let (tie, near) = (
            Reason::DistanceTie { primitives: [1, 3] },
            Reason::Rounding { primitive: 2, pixels: 0.01 },
        );
        let far = Reason::Rounding { primitive: 3, pixels: 0.03 };
        assert_eq!(tie.worse(near), near);
        assert_eq!(near.worse(tie), near);
        assert_eq!(near.worse(far), far);
        assert_eq!(far.worse(Reason::Unexplained), Reason::Unexplained);
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(short(0.012_345), "0.0123");
        assert_eq!(short(1.234e-7), "1.2e-7");
        assert_eq!(short(0.0), "0");
    }
}
