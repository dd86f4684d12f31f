//! The eye, the axes and the viewport of a renderer in sentences.

use super::stance::of_stance;
use crate::common::{Camera, Orientation, Projection};
use crate::diff::why::convention::{Evidence, Field, Framing, Placement, Pose};
use crate::wording::three_digits;

/// The eye and the axes; the camera tells what measured ones are not.
pub(super) fn of_pose(pose: Pose, placement: Placement, camera: Option<&Camera>) -> String {
    let words = match pose {
        Pose::Measured(stance) => return of_stance(&stance, placement, camera),
        Pose::AsStated => "has the camera's eye and axes",
        Pose::EyeLeftOut => {
            "looks from the origin of the world: begin its rays at the eye, or subtract the eye from each vertex"
        }
        Pose::EyeAdded => "looks from -eye: it adds the eye to each vertex; subtract it",
        Pose::EyeAfterTurn => {
            "turns first, and subtracts the eye then: subtract the eye from each vertex, and then multiply by u, v and w"
        }
        Pose::AxesLeftOut => {
            "does not turn: it has the axes of the world for u, v and w; take those of the camera"
        }
        Pose::AxesExchanged => {
            "turns the other way: rows and columns of its rotation are exchanged (from the world to the camera, u, v \
             and w are its rows; from the camera to the world, its columns)"
        }
        Pose::MatrixNotInverted => {
            "takes the matrix from the camera to the world for that from the world to the camera: invert it"
        }
        Pose::TargetAsDirection => {
            "looks along look_at, as if it were a direction: the direction of view is look_at - eye"
        }
        Pose::DirectionAsTarget => {
            "looks at the direction of view, as if it were a point: do not subtract the eye from it"
        }
        Pose::EyeAndTargetExchanged => {
            "exchanges eye and look_at: it looks from look_at to the eye"
        }
        Pose::UpLeftOut => "takes (0, 1, 0) for up: the camera has another up",
        Pose::UpAsV => "takes up for v: v = w x u is perpendicular to the view, and up need not be",
        Pose::SidesNotNormalized => {
            "does not normalize u: divide u = up x w by its length, and take v = w x u then"
        }
        Pose::BackNotNormalized => {
            "does not normalize w: divide it by its length; otherwise d w is not d long"
        }
        Pose::OnlyRightNormalized => {
            "does not normalize w: divide it by its length before v = w x u and d w, which are too long otherwise"
        }
        Pose::NothingNormalized => {
            "does not normalize w and u: divide w by its length, then u = up x w by its length, and take v = w x u then"
        }
    };
    words.into()
}

/// The viewport, and every other one of the same size, if a camera tells.
pub(super) fn of_fields(field: Field, camera: Option<&Camera>) -> String {
    let others = camera.into_iter().flat_map(|camera| field.of_same_size(camera));
    let all = std::iter::once(field).chain(others);
    all.map(of_field).collect::<Vec<_>>().join("; or it ")
}

fn of_field(field: Field) -> &'static str {
    match field {
        Field::AsStated => "has the camera's viewport",
        Field::VerticalAsHorizontal => {
            "takes vh, or the vertical field of view, for the width: its viewport is vh wide and vh H/W high"
        }
        Field::HorizontalAsVertical => {
            "takes vw, or the horizontal field of view, for the height: its viewport is vw high and vw W/H wide"
        }
        Field::AspectLeftOut => {
            "leaves out the form of the image: its viewport is vh wide as well; multiply x by W/H"
        }
        Field::HeightIsWidth => {
            "leaves out the form of the image: its viewport is vw high as well; multiply y by H/W"
        }
        Field::AspectInverted => {
            "has the form of the image upside down: it multiplies x by H/W for W/H"
        }
        Field::Double => {
            "has a viewport twice as wide and as high: half of vw and vh is missing (x goes from -vw/2 to vw/2, y from -vh/2 to vh/2)"
        }
        Field::Half => "has a viewport half as wide and as high: vw and vh are halved twice",
        Field::TangentOfWholeAngle => {
            "takes the tangent of the whole field of view for that of its half: vh = 2 d tan(fov/2)"
        }
        Field::TangentOfQuarterAngle => {
            "takes the tangent of a quarter of the field of view for that of its half: vh = 2 d tan(fov/2)"
        }
        Field::AngleForTangent => "takes the angle for its tangent: vh = 2 d tan(fov/2), not d fov",
        Field::DegreesAsRadians => {
            "takes the tangent of degrees where radians are meant: multiply the field of view by pi/180"
        }
        Field::VerticalAsDiagonal => {
            "takes the vertical field of view for that between two opposite corners: vh = 2 d tan(fov/2) is the height"
        }
        Field::HalfWidth => "has a viewport half as wide: vw is halved once too often",
        Field::HalfHeight => "has a viewport half as high: vh is halved once too often",
        Field::DoubleWidth => {
            "has a viewport twice as wide: half of vw is missing (x goes from -vw/2 to vw/2)"
        }
        Field::DoubleHeight => {
            "has a viewport twice as high: half of vh is missing (y goes from -vh/2 to vh/2)"
        }
        Field::Exchanged => "exchanges the sides of the viewport: it is vh wide and vw high",
        Field::DistanceLeftOut => {
            "takes 1 for the distance d of the viewport: the direction is x u + y v - d w"
        }
    }
}

/// The size and the place of the whole picture; the camera, where all else is as it states, tells what may be the cause.
pub(super) fn of_framing(
    framing: Framing,
    placement: Placement,
    camera: Option<&Camera>,
) -> String {
    let Framing { scale: [x, y], shift, is_alone, evidence } = framing;
    let by_contour = evidence == Evidence::Contour;
    let [wide, high] = [x, y].map(times);
    let size = match (wide == high, wide == "1", high == "1") {
        (true, true, _) => None,
        (true, false, _) => Some(format!("{wide} times as large")),
        (false, false, true) => Some(format!("{wide} times as wide")),
        (false, true, false) => Some(format!("{high} times as high")),
        (false, ..) => Some(format!("{wide} times as wide and {high} times as high")),
    };
    let moved = of_shift(shift);
    let what = match (&size, &moved) {
        (Some(size), Some(moved)) => format!("{size}, and {moved}"),
        (one, other) => one.as_ref().or(other.as_ref()).cloned().unwrap_or_default(),
    };
    let turned =
        if placement == Placement::Upright { "" } else { " (once the picture is upright)" };
    let beside = if is_alone { ", and nothing around it" } else { "" };
    let by_axes = camera.and_then(|camera| cause_of_axes(framing, camera));
    let cause = camera.and_then(|camera| match (size.is_some(), moved.is_some()) {
        _ if by_axes.is_some() => by_axes,
        (true, _) if is_alone => cause_of_part(framing, camera).map(|part| format!(": {part}?")),
        (true, false) => Some(causes_of_size([x, y], evidence, camera)),
        (false, true) if !is_alone => Some(causes_of_shift(by_contour, camera)),
        (true, true) if by_contour => Some(causes_of_size_and_place(framing, camera)),
        _ => None,
    });
    let all = if is_alone { "the picture" } else { "everything" };
    format!("shows {all} {what}{turned}{beside}{}", cause.unwrap_or_default())
}

/// How many times as large something is; 1 where it is nearly as large.
fn times(scale: f64) -> String {
    /// Less than this is what rounding leaves.
    const LEAST: f64 = 5e-4;
    if (scale - 1.0).abs() < LEAST { "1".into() } else { apart(scale, 1.0)[0].clone() }
}

/// Two numbers with three digits, or as many as tell them apart.
fn apart(one: f64, other: f64) -> [String; 2] {
    let written = |digits: usize| {
        [one, other].map(|number| {
            let short = format!("{number:.*e}", digits - 1).parse::<f64>();
            short.map_or_else(|_| number.to_string(), |short| short.to_string())
        })
    };
    let differ = |digits: &usize| {
        let [one, other] = written(*digits);
        one != other
    };
    written((3..=6).find(differ).unwrap_or(3))
}

/// The mistake in the axes of a rasterizer that shows everything in this size and place: it projects `p` on them, as
/// `d (p·u)/(−p·w)`, so that what is too long there makes the picture too large.
fn cause_of_axes(framing: Framing, camera: &Camera) -> Option<String> {
    /// So far off may scale and shift be, as measured: a part, and pixels.
    const SCALE: f64 = 2e-3;
    const SHIFT: f64 = 0.3;
    let up = match camera.description().orientation {
        Orientation::LookAt { up, .. } | Orientation::Direction { up, .. } => up.as_dvec3(),
        Orientation::Frame { .. } => return None,
    };
    let is = |scale: [f64; 2], down: f64| {
        let off = |axis: usize| (framing.scale[axis] / scale[axis] - 1.0).abs();
        let is_moved_so = framing.shift[0].abs() < SHIFT && (framing.shift[1] - down).abs() < SHIFT;
        off(0) < SCALE && off(1) < SCALE && is_moved_so
    };
    if framing.is_alone || camera.projection() == Projection::Parallel {
        return None;
    }
    let (along_v, along_w) = (up.dot(camera.v()), up.dot(camera.w()));
    let pixels = f64::from(camera.image()[1]) / camera.viewport()[1];
    let length = up.cross(camera.w()).length();
    if is([1.0, along_v], camera.distance() * along_w * pixels) && along_w.abs() > SCALE {
        Some(": does it project on up in place of v? v = w x u is perpendicular to the view, and up is not".into())
    } else if (length - 1.0).abs() > SCALE && is([length; 2], 0.0) {
        let length = three_digits(length);
        Some(format!(
            ": does it project on u and v that are {length} long? Divide u = up x w by its length, and take v = w x u then"
        ))
    } else {
        None
    }
}

/// The image that is so much smaller than the one that is asked for.
fn cause_of_part(framing: Framing, camera: &Camera) -> Option<String> {
    /// By so much, in pixels, it may stick out, as measured.
    const ROUNDING: f64 = 0.6;
    let image @ [width, height] = camera.image();
    let is_inside = (0..2).all(|axis| {
        let free = (1.0 - framing.scale[axis]) * f64::from(image[axis]) / 2.0;
        framing.shift[axis].abs() <= free + ROUNDING
    });
    let [columns, rows] = [0, 1].map(|axis| (framing.scale[axis] * f64::from(image[axis])).round());
    let question =
        format!("does it draw {columns} x {rows} pixels into an image of {width} x {height}");
    is_inside.then_some(question)
}

/// What a contour of another size in another place may come from.
fn causes_of_size_and_place(framing: Framing, camera: &Camera) -> String {
    let part = cause_of_part(framing, camera).map(|part| format!("{part}, "));
    let part = part.unwrap_or_default();
    let [x, y] = framing.scale;
    // From nowhere else, and in no other size, is all wider alone.
    let (eye, other) = if x == y { (" is its eye another,", "size") } else { ("", "shape") };
    format!(
        ": {part}are the size and the middle of its viewport others,{eye} or is all of the scene moved and of another {other}?"
    )
}

fn causes_of_shift(by_contour: bool, camera: &Camera) -> String {
    let axis = "is the middle of its viewport not on the axis of its camera";
    match (camera.projection(), by_contour) {
        (Projection::Perspective, false) => format!(": {axis}?"),
        (Projection::Perspective, true) => {
            format!(
                ": {axis}, its eye or its direction of view another, or all of the scene moved?"
            )
        }
        (Projection::Parallel, false) => format!(": is its eye another, or {axis}?"),
        (Projection::Parallel, true) => {
            format!(": is its eye another, {axis}, or is all of the scene moved?")
        }
    }
}

fn of_shift([right, down]: [f64; 2]) -> Option<String> {
    /// Less than this, in pixels, is what rounding leaves.
    const LEAST: f64 = 0.1;
    let pixels = |by: &str| if by == "1" { "pixel" } else { "pixels" };
    let part = |by: f64, [less, more]: [&str; 2]| {
        let way = if by < 0.0 { less } else { more };
        let far = three_digits(by.abs());
        (by.abs() >= LEAST).then(|| format!("{far} {} too far {way}", pixels(&far)))
    };
    let parts = [part(right, ["to the left", "to the right"]), part(down, ["up", "down"])];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty()).then(|| parts.join(" and "))
}

/// The viewport, the distance, the field of view and the eye that would show everything so large, and the scene, where a contour alone
/// tells the size.
fn causes_of_size([x, y]: [f64; 2], evidence: Evidence, camera: &Camera) -> String {
    let [vw, vh] = camera.viewport();
    let [wide, high] = [(vw, x), (vh, y)].map(|(side, times)| apart(side / times, side));
    let mut causes =
        vec![format!("its viewport {} x {}, not {} x {}", wide[0], high[0], wide[1], high[1])];
    if x == y && camera.projection() == Projection::Perspective {
        let d = camera.distance();
        let angle = |vh: f64| three_digits(2.0 * (vh / 2.0 / d).atan().to_degrees());
        let angles = format!("its field of view {} degrees high, not {}", angle(vh / y), angle(vh));
        causes.insert(0, angles);
        if evidence != Evidence::Distances {
            let [other, stated] = apart(d * x, d);
            causes.push(format!("its d {other}, not {stated}"));
            // Where all lies at one distance, this is the same picture.
            causes.push(format!("its eye {}", if x > 1.0 { "nearer" } else { "farther away" }));
        }
    }
    if evidence == Evidence::Contour {
        let other = if x == y { "size" } else { "shape" };
        causes.push(format!("all of the scene of another {other}"));
    }
    format!(": is {}?", causes.join(", or "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::CameraDescription;

    #[test]
    fn a_framing_is_told_with_what_may_be_the_cause() {
        let camera = Camera::canonical(12, 16);
        let said = |scale, shift, is_alone, placement| {
            let framing = Framing { scale, shift, is_alone, ..Framing::default() };
            of_framing(framing, placement, Some(&camera))
        };
        use Placement::{Upright, UpsideDown};
        assert_eq!(
            said([1.25, 1.25], [0.0, 0.0], false, Upright),
            "shows everything 1.25 times as large: is its field of view 43.6 degrees high, not 53.1, or its viewport \
             0.8 x 0.8, not 1 x 1, or its d 1.25, not 1, or its eye nearer?"
        );
        assert_eq!(
            said([1.25, 1.0], [0.0, 0.0], false, Upright),
            "shows everything 1.25 times as wide: is its viewport 0.8 x 1, not 1 x 1?"
        );
        assert_eq!(
            said([1.0, 1.0], [1.0, -2.5], true, UpsideDown),
            "shows the picture 1 pixel too far to the right and 2.5 pixels too far up (once the picture is upright), and \
             nothing around it"
        );
        assert_eq!(
            said([0.5, 0.5], [-4.0, 3.0], true, Upright),
            "shows the picture 0.5 times as large, and 4 pixels too far to the left and 3 pixels too far down, and nothing \
             around it: does it draw 8 x 6 pixels into an image of 16 x 12?"
        );
        assert_eq!(
            said([0.9998, 1.0], [2.0, 0.02], false, Upright),
            "shows everything 2 pixels too far to the right: is the middle of its viewport not on the axis of its camera?"
        );
    }

    #[test]
    fn a_framing_may_come_from_the_axes_of_a_rasterizer() {
        use crate::common::glam::Vec3;
        let orientation = Orientation::LookAt { target: Vec3::new(0.0, -3.0, -4.0), up: Vec3::Y };
        let description =
            CameraDescription { orientation, image: [10, 10], ..CameraDescription::default() };
        let camera = Camera::new(description).unwrap();
        let said = |scale, shift| {
            let framing = Framing { scale, shift, ..Framing::default() };
            of_framing(framing, Placement::Upright, Some(&camera))
        };
        // w is (0, 0.6, 0.8).
        assert!(said([1.0, 0.8], [0.0, 6.0]).contains("does it project on up in place of v?"));
        assert!(said([0.8, 0.8], [0.0, 0.0]).contains("u and v that are 0.8 long?"));
        for (scale, shift) in [([1.0, 0.8], [0.0, 0.0]), ([0.8, 0.8], [0.0, 6.0])] {
            assert!(!said(scale, shift).contains("project"));
        }
    }

    #[test]
    fn a_framing_is_told_with_what_its_evidence_leaves_open() {
        let camera = Camera::canonical(12, 16);
        let said = |scale, shift, evidence| {
            let framing = Framing { scale, shift, evidence, is_alone: false };
            of_framing(framing, Placement::Upright, Some(&camera))
        };
        let of_mask = |scale, shift| said(scale, shift, Evidence::Contour);
        assert_eq!(
            of_mask([0.8, 0.8], [0.0, 0.0]),
            "shows everything 0.8 times as large: is its field of view 64 degrees high, not 53.1, or its viewport \
             1.25 x 1.25, not 1 x 1, or its d 0.8, not 1, or its eye farther away, or all of the scene of another size?"
        );
        assert_eq!(
            said([0.8, 0.8], [0.0, 0.0], Evidence::Distances),
            "shows everything 0.8 times as large: is its field of view 64 degrees high, not 53.1, or its viewport \
             1.25 x 1.25, not 1 x 1?"
        );
        assert_eq!(
            of_mask([1.0, 1.0], [0.0, 3.0]),
            "shows everything 3 pixels too far down: is the middle of its viewport not on the axis of its camera, its \
             eye or its direction of view another, or all of the scene moved?"
        );
        assert_eq!(
            of_mask([0.8, 0.8], [1.5, 0.0]),
            "shows everything 0.8 times as large, and 1.5 pixels too far to the right: does it draw 13 x 10 pixels into an \
             image of 16 x 12, are the size and the middle of its viewport others, is its eye another, or is all of the scene \
             moved and of another size?"
        );
        // So much smaller, and so far to the right, a part of the picture would lie beside the image.
        assert_eq!(
            of_mask([0.8, 0.8], [3.0, 0.0]),
            "shows everything 0.8 times as large, and 3 pixels too far to the right: are the size and the middle of its \
             viewport others, is its eye another, or is all of the scene moved and of another size?"
        );
        assert_eq!(
            of_mask([1.2, 1.0], [1.0004, 0.0]),
            "shows everything 1.2 times as wide, and 1 pixel too far to the right: are the size and the middle of its \
             viewport others, or is all of the scene moved and of another shape?"
        );
        assert_eq!(
            of_mask([1.004, 1.004], [0.0, 0.0]),
            "shows everything 1.004 times as large: is its field of view 52.9 degrees high, not 53.1, or its viewport \
             0.996 x 0.996, not 1 x 1, or its d 1.004, not 1, or its eye nearer, or all of the scene of another size?"
        );
        assert_eq!(apart(1.0, 1.0), ["1", "1"]);
        assert_eq!(apart(1.3331, 1.3349), ["1.333", "1.335"]);
    }

    #[test]
    fn a_viewport_is_named_with_the_others_of_its_size_and_none_that_is_right() {
        let description =
            CameraDescription { distance: 2.0, image: [8, 8], ..CameraDescription::default() };
        let square =
            Camera::new(CameraDescription { viewport: [1.0, 1.0], ..description }).unwrap();
        let only = of_fields(Field::DistanceLeftOut, Some(&square));
        assert_eq!(only, of_field(Field::DistanceLeftOut));
        let wide = CameraDescription { viewport: [2.0, 1.0], image: [16, 8], ..description };
        let both = of_fields(Field::AspectLeftOut, Some(&Camera::new(wide).unwrap()));
        assert!(both.contains("; or it has a viewport half as wide: vw"), "{both}");
    }
}
