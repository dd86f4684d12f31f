//! Conventions in sentences that a student can act on.

mod camera;
mod layout;
mod missing;
mod omission;
mod stance;

use super::convention::{
    Change, Convention, Depth, Edges, Faces, Interpolation, Look, Placement, Rays, Sampling,
    Vertices,
};
use super::encoding::{DistanceEncoding, Encoding, INFINITELY_FAR, IdEncoding, NothingEncoding};
use super::finding::Explanation;
use crate::common::{Camera, Projection};
use crate::wording::{readable, three_digits};
use camera::{of_fields, of_framing, of_pose};
use layout::of_layout;
use missing::of_missing;
use omission::{of_far, of_near, of_omission};

impl Explanation {
    /// The explanation in sentences, one for each part; `name` is the name of the file.
    pub fn sentences(&self, name: &str, camera: &Camera) -> Vec<String> {
        let mut parts = of_convention(&self.convention, camera.projection(), Some(camera));
        parts.extend(of_encoding(&self.encoding));
        if !self.missing.is_empty() {
            parts.push(of_missing(&self.missing));
        }
        parts.extend(self.layout.map(|layout| of_layout(layout, camera.image())));
        parts.iter().map(|part| with_name(part, name)).collect()
    }
}

/// The conventions of a renderer in sentences. A change of the rays concerns the cameras of one projection; `encodings`
/// are those of masks, of ids and of distances.
pub(super) fn of_renderer(
    name: &str,
    convention: &Convention,
    rays_of: Option<Projection>,
    encodings: &[Encoding; 3],
) -> Vec<String> {
    let mut parts = of_convention(convention, rays_of.unwrap_or(Projection::Parallel), None);
    for (kind, encoding) in ["masks", "ids", "distances"].into_iter().zip(encodings) {
        let of_kind = of_encoding(encoding);
        parts.extend(of_kind.into_iter().map(|part| format!("{part} (in its {kind})")));
    }
    parts.iter().map(|part| with_name(part, name)).collect()
}

/// Explanations that explain equally much, each a sentence or several, in one line.
pub fn alternatives(explanations: &[Vec<String>]) -> String {
    let one = |sentences: &Vec<String>| sentences.join(", and ");
    explanations.iter().map(one).collect::<Vec<_>>().join("; or: ")
}

fn with_name(sentence: &str, name: &str) -> String {
    format!("{name} {sentence}")
}

/// The camera tells which other viewports are of the same size, if there is one camera.
fn of_convention(
    convention: &Convention,
    projection: Projection,
    camera: Option<&Camera>,
) -> Vec<String> {
    let [columns, rows] = convention.own_sampling();
    let mut changes = Convention { columns, rows, ..*convention }.changes();
    let mut sentences = Vec::new();
    // One mistake on both axes is one mistake.
    if columns == rows
        && let Some(both) = sampling_of_both(columns)
    {
        changes.retain(|change| !matches!(change, Change::Columns(_) | Change::Rows(_)));
        sentences.push(both);
    }
    let placement = convention.placement;
    let is_of_camera = |change: &Change| matches!(change, Change::Field(_) | Change::Pose(_));
    // What may be the cause of a framing follows from the camera as it is stated.
    let has_other_camera = convention.is_framed() && changes.iter().any(is_of_camera);
    let camera = camera.filter(|_| !has_other_camera);
    let parts = changes.into_iter().map(|change| sentence(change, placement, projection, camera));
    parts.chain(sentences).collect()
}

fn sampling_of_both(sampling: Sampling) -> Option<String> {
    let words = match sampling {
        Sampling::Middle => return None,
        Sampling::Corner => {
            "samples pixel corners (top left): in its loop, add 1/2 to i and j (a principal point of W/2 and H/2 with \
             pixel centres at whole numbers is the same picture)"
        }
        Sampling::FarCorner => {
            "samples pixel corners (bottom right): in its loop, subtract 1/2 from i and j (a principal point of the \
             integer grid, (W - 1)/2 and (H - 1)/2, with pixel centres at j + 1/2 and i + 1/2 is the same picture)"
        }
        Sampling::BorderToBorder => {
            "divides by W - 1 and H - 1: its first and last samples lie on the border of the viewport; take \
             (j + 1/2)/W and (i + 1/2)/H"
        }
        Sampling::OneFewer => "divides by W - 1 and H - 1: divide j + 1/2 by W, and i + 1/2 by H",
        Sampling::OneMore => "divides by W + 1 and H + 1: divide j + 1/2 by W, and i + 1/2 by H",
        Sampling::PixelBefore => {
            "is moved by one pixel to the right and down: do its i and j count from 1 where 0 is meant?"
        }
        Sampling::PixelAfter => {
            "is moved by one pixel to the left and up: do its i and j count from 0 where 1 is meant?"
        }
    };
    Some(words.into())
}

/// A change in a sentence; `placement` is that of the file in which it shows.
fn sentence(
    change: Change,
    placement: Placement,
    projection: Projection,
    camera: Option<&Camera>,
) -> String {
    match change {
        Change::Placement(placement) => of_placement(placement).into(),
        Change::Columns(sampling) => {
            of_sampling(sampling, ["j", "W", "cx", "column", "left", "right"])
        }
        Change::Rows(sampling) => of_sampling(sampling, ["i", "H", "cy", "row", "top", "bottom"]),
        Change::Pose(pose) => of_pose(pose, placement, camera),
        Change::Framing(framing) => of_framing(framing, placement, camera),
        Change::Field(field) => of_fields(field, camera),
        Change::Look(Look::Backward | Look::Forward) => {
            "looks along +w, and sees what lies behind the eye: the direction is x u + y v - d w"
                .into()
        }
        Change::Rays(rays) => of_rays(rays, projection).into(),
        Change::Vertices(vertices) => of_vertices(vertices),
        Change::Edges(edges) => of_edges(edges).into(),
        Change::Faces(faces) => of_faces(faces).into(),
        Change::Interpolation(interpolation) => of_interpolation(interpolation).into(),
        Change::Depth(depth) => of_depth(depth).into(),
        Change::Near(plane) => of_near(plane, projection),
        Change::Far(clip) => of_far(clip, projection),
        Change::Omission(omission) => of_omission(omission, placement),
    }
}

fn of_placement(placement: Placement) -> &'static str {
    match placement {
        Placement::Upright => "is upright",
        Placement::UpsideDown => {
            "is upside down: its rows count from the bottom, or its +v points down (y = -vh ((i + 1/2)/H - 1/2), \
             with i from the top)"
        }
        Placement::LeftToRight => {
            "is mirrored left to right: its +u points to the left (u = up x w, of unit length), or its columns \
             count from the right"
        }
        Placement::HalfTurn => {
            "is turned by 180 degrees: its rows count from the bottom and its columns from the right, or both \
             axes of its camera point the other way"
        }
        Placement::Transposed => {
            "has rows and columns exchanged: it is written by columns, or [j][i] for [i][j]"
        }
        Placement::TurnedLeft => "is turned by 90 degrees to the left",
        Placement::TurnedRight => "is turned by 90 degrees to the right",
        Placement::OtherDiagonal => {
            "has rows and columns exchanged, and both count from the other end"
        }
        Placement::ByColumns => {
            "is written by columns: the numbers of its first column come first, then those of the second; write \
             row by row"
        }
    }
}

fn of_sampling(sampling: Sampling, [index, sides, point, thing, first, last]: [&str; 6]) -> String {
    match sampling {
        Sampling::Middle => format!("samples the middle of each {thing}"),
        Sampling::Corner => format!(
            "samples the {first} edge of each pixel, not its middle: in its loop, add 1/2 to {index} (a principal \
             point {point} = {sides}/2 with pixel centres at whole numbers is the same picture)"
        ),
        Sampling::FarCorner => format!(
            "samples the {last} edge of each pixel, not its middle: in its loop, subtract 1/2 from {index} (a \
             principal point of the integer grid, {point} = ({sides} - 1)/2, with pixel centres at {index} + 1/2 is \
             the same picture)"
        ),
        Sampling::BorderToBorder => format!(
            "divides {index} by {sides} - 1, so that the first and the last {thing} lie on the border of the \
             viewport: take ({index} + 1/2)/{sides}"
        ),
        Sampling::OneFewer => format!("divides {index} + 1/2 by {sides} - 1: divide by {sides}"),
        Sampling::OneMore => format!("divides {index} + 1/2 by {sides} + 1: divide by {sides}"),
        Sampling::PixelBefore => {
            format!(
                "shows each {thing} one pixel too far to the {last}: its {index} is 1 too small"
            )
        }
        Sampling::PixelAfter => {
            format!(
                "shows each {thing} one pixel too far to the {first}: its {index} is 1 too large"
            )
        }
    }
}

fn of_rays(rays: Rays, projection: Projection) -> &'static str {
    match (rays, projection) {
        (Rays::AsStated, _) => "has the camera's rays",
        (Rays::OtherProjection, Projection::Parallel) => {
            "draws a perspective picture for a parallel camera: let all rays go along -w, and begin at eye + x u + y v"
        }
        (Rays::OtherProjection, Projection::Perspective) => {
            "draws a parallel picture for a perspective camera: let all rays begin at the eye, and go along x u + y v - d w"
        }
        (Rays::OneOrigin, _) => {
            "lets all parallel rays begin at the eye, so that every pixel sees the same: begin at eye + x u + y v"
        }
    }
}

fn of_vertices(vertices: Vertices) -> String {
    match vertices {
        Vertices::Projected => "leaves vertices where they are projected".into(),
        Vertices::Rounded { bits: 0 } => {
            "rounds vertices to whole pixels: keep the fractions of their raster coordinates, and round nothing before the \
             edge functions"
                .into()
        }
        Vertices::Rounded { bits } => format!(
            "rounds vertices to 1/{} of a pixel, as GPUs do: its edges lie elsewhere by up to 1/{} of a pixel; here nothing \
             is rounded",
            1_u64 << bits,
            // Along the diagonal of a cell.
            (f64::from(bits + 1).exp2() / std::f64::consts::SQRT_2).floor()
        ),
    }
}

fn of_edges(edges: Edges) -> &'static str {
    match edges {
        Edges::TopLeft => "has the top-left rule",
        Edges::BottomLeft => {
            "has a bottom-left rule: level edges own their samples below the inside (a top-left rule in rows that \
             count from the bottom, as OpenGL has it)"
        }
        Edges::TopRight => {
            "has a top-right rule: right edges own their samples, and left ones do not"
        }
        Edges::BottomRight => {
            "has a bottom-right rule: right and bottom edges own their samples, not left and top ones"
        }
        Edges::Inclusive => {
            "covers samples exactly on any edge (>= in all three edge functions): two triangles draw a shared edge \
             twice; the top-left rule gives it one owner"
        }
        Edges::Exclusive => {
            "covers no sample exactly on an edge (> in all three edge functions): a shared edge has holes; the \
             top-left rule gives it one owner"
        }
    }
}

fn of_faces(faces: Faces) -> &'static str {
    match faces {
        Faces::Both => "draws both sides",
        Faces::BackCulled => {
            "culls back faces: triangles with their corners clockwise as seen are missing; both sides are seen here"
        }
        Faces::FrontCulled => {
            "culls front faces: triangles with their corners counter-clockwise as seen are missing; both sides are \
             seen here (or its test has the opposite sign)"
        }
    }
}

fn of_interpolation(interpolation: Interpolation) -> &'static str {
    match interpolation {
        Interpolation::Perspective => "interpolates 1/t",
        Interpolation::Linear => {
            "interpolates the distance itself over a triangle, as if it were linear in the picture: 1/t is; interpolate 1/t \
             (1/z, or 1/w), and invert it in each pixel"
        }
        Interpolation::Mean => {
            "gives all pixels of a triangle one distance, the mean of its corners': interpolate 1/t in each pixel"
        }
        Interpolation::FirstCorner => {
            "gives all pixels of a triangle one distance, that of its first corner: interpolate 1/t in each pixel"
        }
    }
}

fn of_depth(depth: Depth) -> &'static str {
    match depth {
        Depth::Nearest => "shows the nearest",
        Depth::FirstOfEqual => {
            "shows the first drawn of equally near primitives; here, where exactly a silhouette is met, its front face is seen"
        }
        Depth::LastOfEqual => {
            "shows the last drawn of equally near primitives (<= for < in its depth test)"
        }
        Depth::Farthest => "shows the farthest primitive: its depth test has the opposite sign",
        Depth::LastDrawn => "has no depth test: the last drawn primitive is seen",
        Depth::FirstDrawn => {
            "keeps the first drawn primitive, however far it is: its depth test never replaces"
        }
    }
}

fn of_encoding(encoding: &Encoding) -> Vec<String> {
    let mut sentences = Vec::new();
    match encoding.ids {
        IdEncoding::FromZero => {}
        IdEncoding::CountedFrom(first) => {
            sentences.push(format!("counts ids from {first}: subtract {first}"));
        }
        IdEncoding::FromTheEnd => {
            sentences
                .push("counts ids from the end of the scene: the first primitive has id 0".into());
        }
        IdEncoding::OfObjects => {
            sentences.push("writes the number of the object, not of the primitive".into());
        }
        IdEncoding::OneToOne => sentences.push(
            "numbers the primitives in another order: its ids and ours correspond one to one"
                .into(),
        ),
    }
    sentences.extend(of_distances(encoding.distances));
    match encoding.nothing {
        NothingEncoding::Ours => {}
        NothingEncoding::Inverted => {
            sentences.push("is inverted: it covers exactly what is not covered".into());
        }
        NothingEncoding::Number(number) => sentences.push(format!(
            "writes {} for nothing; ids have all ones there (or -1), distances infinity (or NaN)",
            readable(number)
        )),
    }
    sentences
}

fn of_distances(encoding: DistanceEncoding) -> Option<String> {
    use DistanceEncoding as D;
    let words = match encoding {
        D::T => return None,
        D::AlongAxis => "holds depths along the axis, t d; t counts in lengths of the ray's direction: divide by d".into(),
        D::AlongRay => {
            "holds distances along the ray, t |(x, y, -d)|; t counts in lengths of the ray's direction: divide by \
             its length"
                .into()
        }
        D::NegativeT => "holds -t: change the sign".into(),
        D::NegativeAlongAxis => "holds the z of the camera's axes, -t d: change the sign, and divide by d".into(),
        D::NegativeAlongRay => {
            "holds -t |(x, y, -d)|: change the sign, and divide by the length of the ray's direction".into()
        }
        D::Linear { factor, offset } => of_linear(factor, offset),
        D::Window { near, far: INFINITELY_FAR } => format!(
            "holds OpenGL's window depth for a near plane at {} and none far away: t d = {0} / (1 - depth)",
            three_digits(near)
        ),
        D::Window { near, far } => format!(
            "holds OpenGL's window depth for the planes {} and {}: t d = {0} {1} / ({1} - ({1} - {0}) depth)",
            three_digits(near),
            three_digits(far)
        ),
        D::ReversedWindow { near, far: INFINITELY_FAR } => format!(
            "holds {0} / (t d): {0} divided by it is t d (or it is reversed window depth, 1 at the near plane {0} and 0 \
             infinitely far away)",
            three_digits(near)
        ),
        D::ReversedWindow { near, far } => format!(
            "holds reversed window depth (1 at the near plane {}, 0 at the far plane {}): t d = {0} {1} / ({0} + \
             ({1} - {0}) depth)",
            three_digits(near),
            three_digits(far)
        ),
    };
    Some(words)
}

/// A linear function of `t`.
fn of_linear(factor: f64, offset: f64) -> String {
    /// As many digits as an `f32` tells.
    fn digits(number: f64) -> String {
        format!("{number:.5e}").parse::<f64>().unwrap_or(number).to_string()
    }
    let product = match factor.abs() {
        1.0 => "t".to_owned(),
        factor => format!("{} t", digits(factor)),
    };
    let number = digits(offset.abs());
    let sum = match (factor < 0.0, offset) {
        (false, 0.0) => product,
        (true, 0.0) => format!("-{product}"),
        (false, offset) if offset < 0.0 => format!("{product} - {number}"),
        (false, _) => format!("{product} + {number}"),
        (true, offset) if offset < 0.0 => format!("-{product} - {number}"),
        (true, _) => format!("{number} - {product}"),
    };
    let mut cure = match offset {
        0.0 => Vec::new(),
        offset if offset < 0.0 => vec![format!("add {number}")],
        _ => vec![format!("subtract {number}")],
    };
    if factor != 1.0 {
        cure.push(format!("divide by {}", digits(factor)));
    }
    let cure = cure.join(" and ");
    format!("holds {sum}: t counts from the ray's origin, in lengths of its direction; {cure}")
}

#[cfg(test)]
mod tests {
    use super::super::convention::{Between, Clip, NearPlane};
    use super::*;

    /// The sentences of a convention.
    fn sentences(changes: &[Change]) -> Vec<String> {
        let convention = changes.iter().fold(Convention::default(), |all, &one| all.with(one));
        of_convention(&convention, Projection::Perspective, None)
    }

    #[test]
    fn a_principal_point_that_is_off_by_half_a_pixel_is_named_with_the_sampling_that_is_the_same() {
        let point = "a principal point";
        for (sampling, both, columns, rows) in [
            (Sampling::Corner, "of W/2 and H/2", "cx = W/2", "cy = H/2"),
            (
                Sampling::FarCorner,
                "of the integer grid, (W - 1)/2 and (H - 1)/2",
                "of the integer grid, cx = (W - 1)/2",
                "of the integer grid, cy = (H - 1)/2",
            ),
        ] {
            let [of_columns, of_rows] = [Change::Columns(sampling), Change::Rows(sampling)];
            for (changes, named) in [
                (vec![of_columns, of_rows], both),
                (vec![of_columns], columns),
                (vec![of_rows], rows),
            ] {
                let said = sentences(&changes);
                assert!(
                    said.len() == 1 && said[0].contains(&format!("({point} {named}")),
                    "{said:?}"
                );
                assert!(said[0].ends_with("is the same picture)"), "{said:?}");
            }
        }
    }

    #[test]
    fn the_viewport_that_clips_is_told_with_what_may_be_instead() {
        let at = Between { nearer: 0.98, farther: 1.05 };
        let plane = NearPlane { clip: Clip { at, alone: Some(7) }, hides_spheres: false };
        assert_eq!(
            sentences(&[Change::Near(plane)]),
            [
                "shows nothing nearer than t = 0.98 to 1.05: it has a near plane, or a smallest t, there (its depth is t d), or \
              id 7 begins there; the viewport lies at t = 1; here all with t > 0 is seen"
            ]
        );
    }

    #[test]
    fn a_linear_distance_is_told_with_its_cure() {
        for (factor, offset, said) in [
            (
                1.001,
                0.0,
                "holds 1.001 t: t counts from the ray's origin, in lengths of its direction; divide by 1.001",
            ),
            (
                -1.0,
                10.0,
                "holds 10 - t: t counts from the ray's origin, in lengths of its direction; subtract 10 and divide by -1",
            ),
            (
                0.5,
                -3.0,
                "holds 0.5 t - 3: t counts from the ray's origin, in lengths of its direction; add 3 and divide by 0.5",
            ),
        ] {
            assert_eq!(of_linear(factor, offset), said);
        }
    }
}
