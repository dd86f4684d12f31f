//! An eye and axes that were measured, in sentences.

use crate::common::glam::DVec3;
use crate::common::{Camera, Orientation, Projection};
use crate::diff::why::convention::{Moved, Placement, Stance};
use crate::wording::three_digits;

/// What of the eye and the axes is another; the camera tells what it is not.
pub(super) fn of_stance(stance: &Stance, placement: Placement, camera: Option<&Camera>) -> String {
    let Some(camera) = camera else { return "has another eye, or other axes".into() };
    let [eye, stated_eye] = coordinates(stance.eye, camera.eye().as_dvec3());
    let [along, stated_along] = coordinates(-stance.axes[2], -camera.w());
    let orientation = camera.description().orientation;
    let has_words = !matches!(orientation, Orientation::Frame { .. });
    let has_target = matches!(orientation, Orientation::LookAt { .. });
    let shows =
        if placement == Placement::Upright { "shows" } else { "shows, once it is upright," };
    let scene = match stance.told_by {
        Some(object) => format!("object {object}"),
        None => "all of the scene".into(),
    };
    let field = if stance.by_contour { ", its field of view" } else { "" };
    let up = if stance.has_another_up(camera) { " (with another up)" } else { "" };
    match stance.moved {
        Moved::Up => {
            let roll = stance.roll(camera);
            let way = if roll > 0.0 { "clockwise" } else { "counter-clockwise" };
            let cause = if has_words { "is its up another" } else { "are its u and v others" };
            let degrees = three_digits(roll.abs());
            format!(
                "{shows} everything turned {way} by {degrees} degrees: {cause}, or {scene} turned?"
            )
        }
        Moved::Direction => {
            let cause = cause_of_direction(has_target, stance.by_contour, &scene);
            format!("{shows} what is seen along about {along}, not along {stated_along}{cause}")
        }
        Moved::Axes => {
            let picture = if stance.by_contour { ", the picture moved" } else { "" };
            format!(
                "{shows} what is seen along about {along}{up}, not along {stated_along}: are its u, v and w \
                 others{picture}, or {scene} turned?"
            )
        }
        Moved::Eye => format!(
            "{shows} what an eye at about {eye} sees in the same direction, not one at {stated_eye}: is its eye \
             another{field}, or {scene} moved or of another size?"
        ),
        Moved::EyeAroundTarget if camera.projection() == Projection::Parallel => format!(
            "{shows} what is seen along about {along}, not along {stated_along}, with the same point in the middle: is its \
             eye another, or {scene} turned?"
        ),
        Moved::EyeAroundTarget => format!(
            "{shows} what an eye at about {eye} sees that looks at the same point, not one at {stated_eye}: is its eye \
             another{field}, or {scene} turned or of another size?"
        ),
        Moved::All => format!(
            "{shows} what an eye at about {eye} sees along about {along}{up}, not one at {stated_eye} along {stated_along}: \
             are its eye and its direction of view others, or {scene} moved or turned?"
        ),
    }
}

/// What may be the cause that everything is seen in another direction, if anything is worth a word.
fn cause_of_direction(has_target: bool, by_contour: bool, scene: &str) -> String {
    let cause =
        if has_target { "is its look_at another" } else { "is its direction of view another" };
    match (has_target, by_contour) {
        (_, true) => format!(": {cause}, or the picture or {scene} moved?"),
        (true, false) => format!(": {cause}?"),
        (false, false) => String::new(),
    }
}

/// Two points or directions, with as many digits as tell them apart, and at least three of the larger coordinates.
fn coordinates(one: DVec3, other: DVec3) -> [String; 2] {
    // Of the largest three digits, of the difference two.
    let place = |value: f64, digits: i32| {
        if value > 0.0 { digits - 1 - power_of_first_digit(value) } else { 0 }
    };
    let largest = one.abs().max(other.abs()).max_element();
    let difference = (one - other).abs().max_element();
    let decimals = place(largest, 3).max(place(difference, 2)).clamp(0, 9);
    let decimals = usize::try_from(decimals).expect("it is not negative");
    [one, other].map(|point| {
        let [x, y, z] = point.to_array().map(|value| {
            let written = format!("{value:.decimals$}");
            let written = match written.contains('.') {
                true => written.trim_end_matches('0').trim_end_matches('.'),
                false => &written,
            };
            if written == "-0" { "0".to_owned() } else { written.to_owned() }
        });
        format!("({x}, {y}, {z})")
    })
}

/// The power of ten that the first digit counts.
#[expect(clippy::cast_possible_truncation, reason = "at most 308")]
fn power_of_first_digit(value: f64) -> i32 {
    value.log10().floor() as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::CameraDescription;
    use crate::common::glam::Vec3;

    #[test]
    fn a_stance_is_told_beside_what_is_stated() {
        let looking = CameraDescription {
            eye: Vec3::new(0.0, 0.5, 3.0),
            orientation: Orientation::LookAt { target: Vec3::new(0.0, 0.5, 0.0), up: Vec3::Y },
            ..CameraDescription::default()
        };
        let camera = Camera::new(looking).unwrap();
        let said = |moved: Moved, step: &[f64], placement: Placement| {
            let stance = Stance::stated(&camera, moved).after(step, 1.0, &camera).unwrap();
            of_stance(&stance, placement, Some(&camera))
        };
        use Placement::{Upright, UpsideDown};
        assert_eq!(
            said(Moved::Up, &[0.1], Upright),
            "shows everything turned clockwise by 5.73 degrees: is its up another, or all of the scene turned?"
        );
        assert_eq!(
            said(Moved::Direction, &[0.0, -0.1], Upright),
            "shows what is seen along about (0.1, 0, -0.995), not along (0, 0, -1): is its look_at another?"
        );
        assert_eq!(
            said(Moved::Eye, &[0.25, 0.0, -0.5], UpsideDown),
            "shows, once it is upright, what an eye at about (0.25, 0.5, 2.5) sees in the same direction, not one at \
             (0, 0.5, 3): is its eye another, or all of the scene moved or of another size?"
        );
        assert_eq!(
            said(Moved::EyeAroundTarget, &[0.0, 0.0012, 0.0], Upright),
            "shows what an eye at about (0, 0.5012, 3) sees that looks at the same point, not one at (0, 0.5, 3): is its \
             eye another, or all of the scene turned or of another size?"
        );
        let all = "shows what an eye at about (1, 0.5, 3) sees along about (-0.1, 0, -0.995), not one at (0, 0.5, 3) along \
             (0, 0, -1): are its eye and its direction of view others, or all of the scene moved or turned?";
        assert_eq!(said(Moved::All, &[1.0, 0.0, 0.0, 0.0, 0.1, 0.0], Upright), all);
        assert_eq!(
            said(Moved::Axes, &[0.0, -0.1, 0.2], Upright),
            "shows what is seen along about (0.099, 0.01, -0.995) (with another up), not along (0, 0, -1): are its u, v and w \
             others, or all of the scene turned?"
        );
        let rolled = said(Moved::All, &[1.0, 0.0, 0.0, 0.0, 0.1, 0.02], Upright);
        assert!(rolled.contains("-0.995) (with another up), not one at"), "{rolled}");
        let alone = Stance { told_by: Some(2), ..Stance::stated(&camera, Moved::Eye) };
        let said = of_stance(&alone, Upright, Some(&camera));
        assert!(
            said.ends_with("is its eye another, or object 2 moved or of another size?"),
            "{said}"
        );
        let of_mask = |moved: Moved| Stance { by_contour: true, ..Stance::stated(&camera, moved) };
        let said = of_stance(&of_mask(Moved::EyeAroundTarget), Upright, Some(&camera));
        let end =
            "is its eye another, its field of view, or all of the scene turned or of another size?";
        assert!(said.ends_with(end), "{said}");
        let said = of_stance(&of_mask(Moved::Direction), Upright, Some(&camera));
        let end = ": is its look_at another, or the picture or all of the scene moved?";
        assert!(said.ends_with(end), "{said}");
        let said = of_stance(&of_mask(Moved::Axes), Upright, Some(&camera));
        let end = "are its u, v and w others, the picture moved, or all of the scene turned?";
        assert!(said.ends_with(end), "{said}");
        assert_eq!(coordinates(DVec3::splat(1234.0), DVec3::ZERO)[0], "(1234, 1234, 1234)");
    }
}
