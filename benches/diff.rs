//! Times the comparison of two files that are in memory: masks of 3840 × 2160 pixels, beside a comparison of as many
//! bytes for equality; and ids, distances and colours of the same size.
//!
//! The two differ in one pixel of a thousand. Measures and the search for causes are part of each comparison.

use bothways::diff::foreign::{Buffer, Content, Covered, Picture, Pixels, compare};
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

const SIZE: [u32; 2] = [3840, 2160];
const PIXELS: u32 = SIZE[0] * SIZE[1];

/// Whether a pixel lies in the disk that is drawn.
fn is_drawn(pixel: u32) -> bool {
    let (i, j) = (pixel / SIZE[0], pixel % SIZE[0]);
    i.abs_diff(1080).pow(2) + j.abs_diff(1920).pow(2) < 900 * 900
}

/// A value for each pixel; one of a thousand is another one in the second buffer.
fn values<T>(second: bool, value: impl Fn(u32, bool) -> T) -> Vec<T> {
    (0..PIXELS).map(|pixel| value(pixel, second && pixel % 1000 == 0)).collect()
}

fn mask(second: bool) -> Buffer<'static> {
    let mask = values(second, |pixel, other| is_drawn(pixel) != other);
    Buffer::new(SIZE, 1, Content::Mask(mask))
}

fn ids(second: bool) -> Buffer<'static> {
    let id = |pixel, other| is_drawn(pixel).then(|| u64::from(pixel / 16 + u32::from(other)));
    Buffer::new(SIZE, 1, Content::Ids(values(second, id)))
}

fn distances(second: bool) -> Buffer<'static> {
    let t = |pixel, other| match is_drawn(pixel) {
        true => 1.0 + f64::from(pixel) / f64::from(PIXELS) + f64::from(u8::from(other)),
        false => f64::INFINITY,
    };
    Buffer::new(SIZE, 1, Content::Distances(values(second, t)))
}

fn picture(second: bool) -> Buffer<'static> {
    let color = |pixel: u32, other| {
        let [low, high, ..] = pixel.to_le_bytes();
        [low, high, if other { 255 } else { 0 }, 255]
    };
    let pixels = Pixels::Bytes(values(second, color));
    Buffer::new(SIZE, 1, Content::Picture(Picture { pixels, covered: Covered::Unknown }))
}

/// As many bytes as a mask has, for equality: what any comparison takes at least.
#[divan::bench]
fn equal_bytes(bencher: Bencher) {
    let bytes = values(false, |pixel, _| is_drawn(pixel));
    let same = bytes.clone();
    bencher.bench_local(|| black_box(&bytes) == black_box(&same));
}

#[divan::bench]
fn equal_masks(bencher: Bencher) {
    let (a, b) = (mask(false), mask(false));
    bencher.bench_local(|| compare(&a, &b));
}

#[divan::bench]
fn masks(bencher: Bencher) {
    let (a, b) = (mask(false), mask(true));
    bencher.bench_local(|| compare(&a, &b));
}

#[divan::bench]
fn ids_of_files(bencher: Bencher) {
    let (a, b) = (ids(false), ids(true));
    bencher.bench_local(|| compare(&a, &b));
}

#[divan::bench]
fn distances_of_files(bencher: Bencher) {
    let (a, b) = (distances(false), distances(true));
    bencher.bench_local(|| compare(&a, &b));
}

#[divan::bench]
fn pictures(bencher: Bencher) {
    let (a, b) = (picture(false), picture(true));
    bencher.bench_local(|| compare(&a, &b));
}
