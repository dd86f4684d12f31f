//! The size of the pictures in a film.

use crate::orders::Method;

/// The room for a picture in a film 960 pixels wide: its width and height.
const ROOM: [u32; 2] = [444, 264];

/// The size in which a picture of this form is filmed unless another is asked for: each pixel fills a square of 4 × 4 in
/// a film 960 pixels wide, or of 2 × 2 by the fast method. That is the least at which the order of the pixels is seen
/// well, and the textbook ends soon.
///
/// A size that keeps the form exactly is preferred, and of those one with sides that are powers of two: edges that are
/// meant to lie on samples do.
///
/// ```
/// use bothways_lab::film::default_size;
/// use bothways_lab::orders::Method;
///
/// let size = |form| default_size(form, Method::Textbook);
/// assert_eq!(size([640, 480]), [88, 66]);
/// assert_eq!(size([480, 480]), [64, 64]);
/// assert_eq!(size([1920, 1080]), [96, 54]);
/// assert_eq!(size([1000, 1]), [111, 1]);
/// assert_eq!(default_size([640, 480], Method::Fast), [176, 132]);
/// ```
pub fn default_size([width, height]: [u32; 2], method: Method) -> [u32; 2] {
    let factor = match method {
        Method::Textbook => 4,
        Method::Fast => 2,
    };
    let room = ROOM.map(|side| side / factor);
    let [most_wide, most_high] = room.map(u64::from);
    let [width, height] = [width.max(1), height.max(1)].map(u64::from);
    let wide = |high: u64| (2 * width * high + height) / (2 * height);
    let fitting = (1..=most_high).rev().filter(|&high| wide(high) <= most_wide);
    let exact: Vec<u64> =
        fitting.clone().filter(|high| (width * high).is_multiple_of(height)).collect();
    let large = |high: &&u64| 4 * **high >= 3 * fitting.clone().next().unwrap_or(0);
    let even = exact.iter().filter(large).find(|high| high.is_power_of_two());
    let high = even.or(exact.iter().find(large)).copied().or(fitting.clone().next()).unwrap_or(1);
    [wide(high).clamp(1, most_wide), high].map(|side| u32::try_from(side).expect("a small side"))
}
