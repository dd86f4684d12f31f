//! Rows or columns at an end of a picture that one file leaves in a single colour.

use crate::diff::buffer::{Buffer, Content, Picture, bytes};
use crate::diff::buffer_pair::BufferPair;
use crate::diff::classes::Classes;

/// The last or the first rows, or columns, that one picture leaves in one colour and the other does not, if all differences lie there;
/// as a sentence.
pub(super) fn unfinished(pair: &BufferPair, differing: &Classes) -> Option<String> {
    let [(a, _), (b, _)] = [(pair.a, "A"), (pair.b, "B")];
    let pictures = [picture(a)?, picture(b)?];
    let [width, height] = a.size();
    let sides = [height, width];
    let pixels: Vec<[u32; 2]> = differing.differing().map(|(pixel, _)| pixel).collect();
    [0, 1].into_iter().find_map(|axis| {
        let lines = || pixels.iter().map(|pixel| pixel[axis]);
        let (first, last) = (lines().min()?, lines().max()?);
        let is_at_end = (first == 0) != (last + 1 == sides[axis]);
        let mut band = [[0, height - 1], [0, width - 1]];
        band[axis] = [first, last];
        let [of_a, of_b] = pictures.map(|picture| only_color(picture, width, band));
        let (name, color) = match (of_a, of_b) {
            (Some(color), None) => ("A", color),
            (None, Some(color)) => ("B", color),
            _ => return None,
        };
        is_at_end.then(|| in_words(name, color, ["row", "column"][axis], [first, last]))
    })
}

fn picture<'a>(buffer: &'a Buffer) -> Option<&'a Picture> {
    match buffer.content() {
        Content::Picture(picture) => Some(picture),
        _ => None,
    }
}

/// The colour of all pixels of a rectangle, if they have one.
fn only_color(picture: &Picture, width: u32, [rows, columns]: [[u32; 2]; 2]) -> Option<[u8; 3]> {
    let color = |i: u32, j: u32| {
        let [red, green, blue, _] = picture.pixels.get(i as usize * width as usize + j as usize);
        bytes([red, green, blue])
    };
    let first = color(rows[0], columns[0]);
    let mut all = (rows[0]..=rows[1]).flat_map(|i| (columns[0]..=columns[1]).map(move |j| [i, j]));
    all.all(|[i, j]| color(i, j) == first).then_some(first)
}

fn in_words(
    name: &str,
    [red, green, blue]: [u8; 3],
    axis: &str,
    [first, last]: [u32; 2],
) -> String {
    let lines = match (first == last, first == 0) {
        (true, true) => format!("{axis} {first}, the first one"),
        (true, false) => format!("{axis} {first}, the last one"),
        (false, true) => format!("{axis}s {first} to {last}, the first ones"),
        (false, false) => format!("{axis}s {first} to {last}, the last ones"),
    };
    let what = if first == 0 { "begin too late" } else { "end too early" };
    format!(
        "{name} has one colour, #{red:02x}{green:02x}{blue:02x}, in its {lines}, and agrees elsewhere: does its loop, or its \
         buffer, {what}?"
    )
}

#[cfg(test)]
mod tests {
    use crate::diff::foreign::{Buffer, Content, Covered, Picture, Pixels, compare};

    /// The hints for a picture of 4 x 3 pixels in which some are black.
    fn hints(is_black: impl Fn(u8, u8) -> bool, covered: Covered) -> Vec<String> {
        let picture = |is_black: &dyn Fn(u8, u8) -> bool| {
            let pixels = (0..12_u8).map(|at| match is_black(at / 4, at % 4) {
                true => [0, 0, 0, 255],
                false => [100 + 10 * at, 90, 200 - at, 255],
            });
            let picture = Picture { pixels: Pixels::Bytes(pixels.collect()), covered };
            Buffer::new([4, 3], 1, Content::Picture(picture))
        };
        compare(&picture(&|_, _| false), &picture(&is_black)).unwrap().hints
    }

    #[test]
    fn lines_that_are_left_in_one_colour_are_named() {
        for covered in [Covered::Unknown, Covered::ByBackground([1, 2, 3])] {
            let last = hints(|i, _| i == 2, covered);
            assert_eq!(
                last,
                [
                    "B has one colour, #000000, in its row 2, the last one, and agrees elsewhere: does its loop, or its buffer, end \
                  too early?"
                ]
            );
            let first = hints(|_, j| j < 2, covered);
            assert!(first[0].contains("in its columns 0 to 1, the first ones"), "{first:?}");
            assert!(first[0].ends_with("begin too late?"), "{first:?}");
        }
        assert_eq!(hints(|i, j| i == 2 && j > 0, Covered::Unknown), [""; 0]);
        assert_eq!(hints(|i, _| i == 1, Covered::Unknown), [""; 0]);
    }
}
