use super::*;
use crate::figure::theme::Theme;

const INK: Ink = Ink::new([200, 40, 10]);

fn drawing() -> Drawing {
    Drawing::new("a <title>", "a \"description\" & more\u{7}", [255; 3])
}

/// The part of a small picture that is not the background, as left, top, right and bottom in units.
fn inked(drawing: &Drawing) -> Option<[f64; 4]> {
    let picture = drawing.pixels(480);
    let inked = picture.enumerate_pixels().filter(|(_, _, pixel)| pixel.0 != [255; 3]);
    inked.map(|(x, y, _)| [4.0 * f64::from(x), 4.0 * f64::from(y)]).fold(None, |extent, [x, y]| {
        let [left, top, right, bottom] = extent.unwrap_or([x, y, x, y]);
        Some([left.min(x), top.min(y), right.max(x + 4.0), bottom.max(y + 4.0)])
    })
}

#[test]
fn extreme_coordinates_are_clipped_before_anything_draws_them() {
    for far in [1e4, 1e9, 1e30, 1e149, 1e200, f64::MAX, f64::INFINITY, f64::NAN] {
        let mut drawing = drawing();
        let pen = Pen::new([0; 3], 3.0);
        let corners = [[-far, -far], [far, -far], [far, far], [-far, far]];
        drawing.polygon(&corners, INK);
        drawing.line(&corners, pen.dashed(5.0, 9.0));
        drawing.closed_line(&[[100.0, 100.0], [far, 200.0], [300.0, -far]], pen);
        drawing.disc([far, 0.0], 10.0, INK);
        drawing.disc([500.0, 500.0], far, INK);
        drawing.ring([far, far], far, pen);
        drawing.arrow([0.0, 0.0], [far, far], pen);
        drawing.tilted_picture(RgbImage::new(2, 2), [[far, 0.0], [0.0, far], [0.0, 0.0]], 1.0);
        drawing.pixels(64);
        assert!(!drawing.svg().contains("inf") && !drawing.svg().contains("NaN"));
    }
}

#[test]
fn what_is_drawn_in_a_window_stays_in_it() {
    let mut drawing = drawing();
    drawing.window(Some(([400.0, 200.0], [800.0, 400.0])));
    drawing.disc([400.0, 200.0], 300.0, INK);
    drawing.polygon(&[[300.0, 300.0], [2000.0, 320.0], [900.0, 900.0]], INK);
    drawing.hatch([0.0, 0.0], CANVAS, 40.0, Pen::new([0; 3], 1.0));
    let [left, top, right, bottom] = inked(&drawing).expect("something is drawn");
    assert!(left >= 396.0 && top >= 196.0 && right <= 1204.0 && bottom <= 604.0);
    assert!(left <= 404.0 && top <= 204.0 && right >= 1190.0 && bottom >= 590.0);
}

#[test]
fn a_line_that_leaves_the_window_and_comes_back_has_parts() {
    let window = Rectangle::new([0.0, 0.0], [10.0, 10.0]);
    let parts = window.parts(&[[1.0, 5.0], [20.0, 5.0], [20.0, 7.0], [2.0, 7.0], [2.0, 8.0]]);
    assert_eq!(parts, [vec![[1.0, 5.0], [10.0, 5.0]], vec![[10.0, 7.0], [2.0, 7.0], [2.0, 8.0]]]);
    assert!(window.parts(&[[-5.0, 20.0], [20.0, 12.0]]).is_empty());
    assert_eq!(window.clipped(&[[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]]).len(), 4);
}

#[test]
fn texts_that_overlap_or_leave_the_canvas_are_found() {
    let style = Theme::Light.text();
    let mut drawing = drawing();
    drawing.text([100.0, 100.0], Anchor::Left, "first", style);
    drawing.text([100.0, 140.0], Anchor::Left, "second", style);
    assert!(drawing.faults().is_empty());
    drawing.text([120.0, 110.0], Anchor::Left, "third", style);
    drawing.text([1900.0, 500.0], Anchor::Left, "fourth", style);
    assert_eq!(drawing.faults(), ["'third' overlaps 'first'", "'fourth' leaves the canvas"]);
}

#[test]
fn an_svg_file_escapes_what_people_write_and_defines_each_letter_once() {
    let mut drawing = drawing();
    drawing.text([100.0, 100.0], Anchor::Left, "a<b & \"aa\"", Theme::Light.text());
    let svg = drawing.svg();
    assert!(svg.contains("<title id=\"title\">a &lt;title&gt;</title>"));
    assert!(svg.contains("a &quot;description&quot; &amp; more</desc>"));
    assert!(svg.contains("aria-label=\"a&lt;b &amp; &quot;aa&quot;\""));
    assert_eq!(svg.matches("<path id=\"r").count(), 5);
    assert_eq!(svg.matches("<use ").count(), 8);
}

#[test]
fn enlarged_pixels_are_squares_in_the_picture_of_pixels() {
    let mut drawing = drawing();
    let picture =
        RgbImage::from_fn(2, 1, |x, _| image::Rgb(if x == 0 { [255, 0, 0] } else { [0, 0, 255] }));
    drawing.picture(picture, [200.0, 200.0], [400.0, 200.0]);
    let pixels = drawing.pixels(1920);
    assert_eq!(pixels.get_pixel(399, 300).0, [255, 0, 0]);
    assert_eq!(pixels.get_pixel(400, 300).0, [0, 0, 255]);
}
