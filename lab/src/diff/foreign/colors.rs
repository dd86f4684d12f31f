//! Encodings of colours under which one picture agrees with another.

use crate::common::look::color::linear_from_encoded;
use crate::diff::aspect::Side;
use crate::diff::buffer::{Buffer, Content, Covered, bytes};
use crate::diff::buffer_pair::BufferPair;

/// Every mistake in writing colours that alone explains every difference, one sentence each. A reference is right.
pub(super) fn encodings(pair: &BufferPair, reference: Option<Side>) -> Vec<String> {
    let (a, b) = (pair.a, pair.b);
    if ![a, b].iter().all(|one| matches!(one.content(), Content::Picture(_))) {
        return Vec::new();
    }
    let tolerance = f64::from(pair.tolerances().color);
    let mut found = Vec::new();
    if are_exchanged(a, b, tolerance) {
        let who = match reference {
            Some(Side::A) => "B",
            Some(Side::B) => "A",
            None => "one of the files",
        };
        found.push(format!("red and blue are exchanged: {who} holds BGR, not RGB"));
    }
    for (one, name, side, other, of) in [(a, "A", Side::A, b, "B"), (b, "B", Side::B, a, "A")] {
        let agrees = |map: fn(f64) -> f64| Map::of_bytes(map).takes(other, one, tolerance);
        if agrees(linear) {
            let cause = match reference {
                Some(right) if right == side => format!("{of} has the encoding as sRGB twice"),
                Some(_) => format!("{name} lacks the encoding as sRGB"),
                None => format!("{name} lacks the encoding as sRGB, or {of} has it twice"),
            };
            found.push(format!("{name} holds the linear values of {of}'s colours: {cause}"));
        }
        if agrees(by_a_power) {
            found.push(format!(
                "{name} encodes linear values by a power of 1/2.2, and {of} as sRGB does, which is linear near black"
            ));
        }
    }
    found
}

/// The linear value of an sRGB one, both from 0 to 255.
fn linear(encoded: f64) -> f64 {
    255.0 * decoded(encoded)
}

/// What a power of 1/2.2 writes for the linear value of an sRGB one.
fn by_a_power(encoded: f64) -> f64 {
    255.0 * decoded(encoded).powf(1.0 / 2.2)
}

/// The linear value in 0 … 1 of an sRGB value in 0 … 255.
fn decoded(encoded: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "a value of 8 bits, or between two")]
    let encoded = (encoded / 255.0).clamp(0.0, 1.0) as f32;
    linear_from_encoded(encoded).into()
}

/// The least and the largest number that a map takes each byte to, rounded before and after it.
struct Map([[f64; 2]; 256]);

/// So many steps of 255 a colour must move before it tells a map from other causes of small differences, and so bright it must
/// be behind it: all that is dark becomes black by much.
const TELLING: f64 = 6.0;

impl Map {
    fn of_bytes(map: fn(f64) -> f64) -> Map {
        let mut ends = [[0.0; 2]; 256];
        for (byte, ends) in (0..=u8::MAX).zip(&mut ends) {
            let byte = f64::from(byte);
            *ends = [map(byte - 0.5) - 0.5, map(byte + 0.5) + 0.5];
        }
        Map(ends)
    }

    /// Whether it takes every colour of one picture to that of another, and some of them tell it from other maps.
    fn takes(&self, from: &Buffer, to: &Buffer, tolerance: f64) -> bool {
        let mut tells = false;
        let fits = every_color(from, to, |from, to| {
            from.into_iter().zip(to).all(|(from, to)| {
                let [least, most] = self.0[usize::from(from)];
                let (from, to) = (f64::from(from), f64::from(to));
                tells |= to >= TELLING && (to - from).abs() >= TELLING;
                (least - tolerance..=most + tolerance).contains(&to)
            })
        });
        fits && tells
    }
}

/// Whether the red of each pixel is the blue of the other picture, and so the other way round, and not all are grey.
fn are_exchanged(a: &Buffer, b: &Buffer, tolerance: f64) -> bool {
    let close = |one: u8, other: u8| f64::from(one.abs_diff(other)) <= tolerance;
    let mut is_coloured = false;
    let fits = every_color(a, b, |[red, green, blue], other| {
        is_coloured |= !close(red, blue);
        close(red, other[2]) && close(green, other[1]) && close(blue, other[0])
    });
    fits && is_coloured
}

/// Whether something holds of the colours of every pixel; and both pictures have a colour in the same pixels.
fn every_color(a: &Buffer, b: &Buffer, mut holds: impl FnMut([u8; 3], [u8; 3]) -> bool) -> bool {
    let [width, height] = a.size();
    let color = |buffer: &Buffer, pixel: [u32; 2]| {
        written(buffer, pixel).map(|[red, green, blue, _]| bytes([red, green, blue]))
    };
    let mut pixels = (0..height).flat_map(move |i| (0..width).map(move |j| [i, j]));
    pixels.all(|pixel| match [a, b].map(|buffer| color(buffer, pixel)) {
        [Some(a), Some(b)] => holds(a, b),
        [None, None] => true,
        _ => false,
    })
}

/// The colour of a pixel, also that of the background: a mistake in writing colours changes both. None where alpha, or black, says
/// that there is nothing.
fn written(buffer: &Buffer, pixel: [u32; 2]) -> Option<[f32; 4]> {
    match buffer.content() {
        Content::Picture(picture) if matches!(picture.covered, Covered::ByBackground(_)) => {
            Some(picture.pixels.get(buffer.pixel(pixel)))
        }
        _ => buffer.color(pixel).map(|(color, _)| color),
    }
}

#[cfg(test)]
mod tests {
    use crate::common::look::color::srgb_from_linear;
    use crate::diff::foreign::{Buffer, Content, Covered, Picture, Pixels, compare};

    fn picture(pixels: Vec<[u8; 3]>) -> Buffer<'static> {
        let size = [u32::try_from(pixels.len()).unwrap(), 1];
        let pixels = pixels.into_iter().map(|[r, g, b]| [r, g, b, 255]).collect();
        let picture = Picture { pixels: Pixels::Bytes(pixels), covered: Covered::Unknown };
        Buffer::new(size, 1, Content::Picture(picture))
    }

    /// What the hints say of linear colours written in two ways.
    fn hints(a: impl Fn(f32) -> u8, b: impl Fn(f32) -> u8) -> Vec<String> {
        let colors = (0..=300_u16).map(|k| [k, k / 2, 300 - k].map(|k| f32::from(k) / 300.0));
        let written = |write: &dyn Fn(f32) -> u8| {
            picture(colors.clone().map(|color| color.map(write)).collect())
        };
        compare(&written(&a), &written(&b)).unwrap().hints
    }

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    fn byte(value: f32) -> u8 {
        (255.0 * value).round() as u8
    }

    #[test]
    fn a_missing_or_another_encoding_is_named_with_the_file_that_has_it() {
        let linear = hints(srgb_from_linear, byte);
        assert_eq!(linear.len(), 1, "{linear:?}");
        assert!(
            linear[0].starts_with("B holds the linear values of A's colours: B lacks"),
            "{linear:?}"
        );
        let twice = hints(
            |value| srgb_from_linear(f32::from(srgb_from_linear(value)) / 255.0),
            srgb_from_linear,
        );
        assert!(twice.len() == 1 && twice[0].ends_with("or A has it twice"), "{twice:?}");
        let power = hints(|value| byte(value.powf(1.0 / 2.2)), srgb_from_linear);
        assert!(
            power.len() == 1 && power[0].starts_with("A encodes linear values by a power"),
            "{power:?}"
        );
    }

    #[test]
    fn exchanged_channels_are_named_unless_all_is_grey() {
        let colors: Vec<[u8; 3]> = (0..=255).map(|k| [k, 255 - k, k / 2]).collect();
        let exchanged = colors.iter().map(|&[r, g, b]| [b, g, r]).collect();
        let found = compare(&picture(colors), &picture(exchanged)).unwrap().hints;
        assert!(found.iter().any(|one| one.starts_with("red and blue are exchanged")), "{found:?}");
        let greys = |from: u8| picture((from..from + 50).map(|k| [k; 3]).collect());
        let found = compare(&greys(0), &greys(20)).unwrap().hints;
        assert!(!found.iter().any(|one| one.contains("red")), "{found:?}");
    }

    #[test]
    fn exchanged_channels_are_named_beside_a_background_that_is_exchanged_too() {
        let colors: Vec<[u8; 3]> = (0..60).map(|k| [k, 200 - k, k / 2]).collect();
        let with_background = |background: [u8; 3], exchange: bool| {
            let with = |[r, g, b]: [u8; 3]| if exchange { [b, g, r, 255] } else { [r, g, b, 255] };
            let pixels = colors.iter().chain([&background; 4]).map(|&color| with(color)).collect();
            let covered = Covered::ByBackground(background);
            let picture = Picture { pixels: Pixels::Bytes(pixels), covered };
            Buffer::new([64, 1], 1, Content::Picture(picture))
        };
        let background = [16, 20, 24];
        let [one, other] = [false, true].map(|exchange| with_background(background, exchange));
        let found = compare(&one, &other).unwrap().hints;
        assert!(found.iter().any(|one| one.starts_with("red and blue are exchanged")), "{found:?}");
    }

    #[test]
    fn colors_that_fit_no_encoding_have_no_hint_of_one() {
        let found = hints(srgb_from_linear, |value| srgb_from_linear(value / 2.0));
        assert_eq!(found, [""; 0]);
        // A little darker, or so dark that nothing is left.
        for (colors, darker) in [(100..=255, 3), (3..=25, 25)] {
            let colors = colors.map(|k: u8| [k; 3]);
            let dark = colors.clone().map(|color| color.map(|k| k.saturating_sub(darker)));
            let found =
                compare(&picture(colors.collect()), &picture(dark.collect())).unwrap().hints;
            assert_eq!(found, [""; 0]);
        }
    }
}
