//! Comparisons of frames, and crops to render.

use bothways_common::{Crop, Frame};

/// Asserts that ids are equal, and distances are within the contract's 10⁻⁵.
pub fn assert_same_visibility(expected: &Frame, frame: &Frame, what: &str) {
    let width = expected.width();
    let place = |index: usize| (index / width, index % width);
    for (index, (id, other)) in expected.ids().iter().zip(frame.ids().iter()).enumerate() {
        assert_eq!(id, other, "{what}: sample {:?}", place(index));
    }
    for (index, (t, other)) in expected.distances().iter().zip(frame.distances()).enumerate() {
        let close = t == other || (t - other).abs() <= 1e-5 * t;
        assert!(close, "{what}: t {t} and {other} at sample {:?}", place(index));
    }
}

/// Asserts that a crop equals this part of the whole frame, to the last bit.
pub fn assert_is_part(whole: &Frame, part: &Frame, what: &str) {
    let crop = part.crop().expect("it is a crop");
    let ([width, height], n) = (part.image(), part.samples());
    assert_eq!([width, height], [crop.width, crop.height], "{what}");
    assert_eq!(part.ids().len(), (width * height * n * n) as usize, "{what}");
    let bits = |frame: &Frame, sample: usize| {
        let (t, texture) = (frame.distances()[sample], frame.texture_coordinates().get(sample));
        let normal = frame.normals().get(sample).map(|normal| normal.to_array().map(f32::to_bits));
        let color = frame.colors().get(sample).map(|color| color.to_array().map(f32::to_bits));
        let texture = texture.map(|texture| texture.to_array().map(f32::to_bits));
        (frame.ids().get(sample), t.to_bits(), normal, color, texture)
    };
    let mut pixels = part.picture().iter();
    for [i, j] in part.pixels().map(|pixel| pixel.map(|place| place as usize)) {
        let in_whole = i * whole.image()[0] as usize + j;
        assert_eq!(pixels.next(), whole.picture().get(in_whole), "{what}: {crop}, ({i}, {j})");
        for (here, there) in part.samples_of(i, j).zip(whole.samples_of(i, j)) {
            assert_eq!(
                bits(part, here),
                bits(whole, there),
                "{what}: crop {crop}, pixel ({i}, {j})"
            );
        }
    }
}

/// Crops of an image in places that look random, the same for the same seed.
pub fn some_crops([width, height]: [u32; 2], seed: u64) -> impl Iterator<Item = Crop> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d;
    let mut below = move |end: u32| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from((state >> 33) % u64::from(end)).expect("it is below the end")
    };
    std::iter::repeat_with(move || {
        let (row, column) = (below(height), below(width));
        let (height, width) = (1 + below(height - row), 1 + below(width - column));
        Crop { row, column, height, width }
    })
}
