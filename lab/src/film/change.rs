//! What changes from one frame to the next.

use image::RgbImage;

/// An upright rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rectangle {
    pub(super) left: u32,
    pub(super) top: u32,
    pub(super) width: u32,
    pub(super) height: u32,
}

/// The smallest rectangle around all pixels that differ; a single pixel if none does.
pub(super) fn changed(before: &RgbImage, after: &RgbImage) -> Rectangle {
    let width = 3 * after.width() as usize;
    let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
    let rows = before.chunks_exact(width).zip(after.chunks_exact(width));
    for (row, (old, new)) in rows.enumerate().filter(|(_, (old, new))| old != new) {
        let differs = |at: &usize| old[*at] != new[*at];
        let first = (0..width).find(differs).unwrap_or(0) / 3;
        let last = (0..width).rev().find(differs).unwrap_or(0) / 3;
        low = [low[0].min(row), low[1].min(first)];
        high = [high[0].max(row), high[1].max(last)];
    }
    if low[0] > high[0] {
        return Rectangle { left: 0, top: 0, width: 1, height: 1 };
    }
    let [top, left] = low.map(side);
    let [bottom, right] = high.map(side);
    Rectangle { left, top, width: right - left + 1, height: bottom - top + 1 }
}

fn side(index: usize) -> u32 {
    u32::try_from(index).expect("within a picture")
}

/// The pixels of a rectangle, row by row: `None` for those that stay as they were.
pub(super) fn pixels<'a>(
    before: &'a RgbImage,
    after: &'a RgbImage,
    rectangle: Rectangle,
) -> impl Iterator<Item = Option<[u8; 3]>> + 'a {
    let Rectangle { left, top, width, height } = rectangle;
    (top..top + height).flat_map(move |y| {
        (left..left + width).map(move |x| {
            let (old, new) = (before.get_pixel(x, y), after.get_pixel(x, y));
            (old != new).then_some(new.0)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    #[test]
    fn only_what_changed_is_in_the_rectangle() {
        let before = RgbImage::new(9, 5);
        let mut after = before.clone();
        let single = Rectangle { left: 0, top: 0, width: 1, height: 1 };
        assert_eq!(changed(&before, &after), single);
        after.put_pixel(3, 1, Rgb([0, 0, 1]));
        after.put_pixel(7, 2, Rgb([1, 0, 0]));
        let rectangle = Rectangle { left: 3, top: 1, width: 5, height: 2 };
        assert_eq!(changed(&before, &after), rectangle);
        let pixels: Vec<_> = pixels(&before, &after, rectangle).collect();
        assert_eq!(pixels.len(), 10);
        assert_eq!((pixels[0], pixels[9]), (Some([0, 0, 1]), Some([1, 0, 0])));
        assert!(pixels[1..9].iter().all(Option::is_none));
    }
}
