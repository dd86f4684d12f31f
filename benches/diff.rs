//! Times the comparison of two buffers that are in memory: masks of 3840 × 2160 pixels, beside a comparison of as many
//! bytes for equality; ids, distances and colours of the same size; and two frames, which hold all three.
//!
//! The two differ in one pixel of a thousand, or in none (`equal`). `compared` counts and classifies every pixel;
//! `measured` also measures (the distance of masks, SSIM and PSNR of colours) and searches for causes, as `diff` does.
//! `RAYON_NUM_THREADS=1` shows one core.

use bothways::common::{Camera, CameraDescription, Frame, View};
use bothways::diff::foreign::{
    Buffer, CompareOptions, Content, Covered, Picture, Pixels, compare_with,
};
use bothways::orders::{self, Method, Order, RenderOptions};
use bothways::{picture, scenes};
use divan::{Bencher, black_box};
use image::RgbImage;

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
    Buffer::new(SIZE, 1, Content::Mask(mask.into()))
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

fn colors(second: bool) -> Buffer<'static> {
    let color = |pixel: u32, other| {
        let [low, high, ..] = pixel.to_le_bytes();
        [low, high, if other { 255 } else { 0 }, 255]
    };
    let pixels = Pixels::Bytes(values(second, color));
    Buffer::new(SIZE, 1, Content::Picture(Picture { pixels, covered: Covered::Unknown }))
}

/// Two frames of the scene `many`, one in object order and one in image order, with their pictures.
fn frames() -> [(Frame, RgbImage); 2] {
    let loaded = scenes::load("many").expect("it is built in");
    let camera = CameraDescription { image: SIZE, ..loaded.camera };
    let camera = Camera::new(camera).expect("its camera is one");
    let view = View::new(&loaded.scene, &camera);
    let options = RenderOptions { no_counts: true, no_times: true, ..RenderOptions::default() };
    [Order::Object, Order::Image].map(|order| {
        let rendered = orders::render(order, Method::Fast, &view, &options);
        let frame = rendered.expect("only a stream has errors").frame;
        let picture = picture::picture(&frame);
        (frame, picture)
    })
}

/// As many bytes as a mask has, for equality: what any comparison takes at least.
#[divan::bench]
fn equal_bytes(bencher: Bencher) {
    let bytes = values(false, |pixel, _| is_drawn(pixel));
    let same = bytes.clone();
    bencher.bench_local(|| black_box(&bytes) == black_box(&same));
}

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    EqualMasks,
    Masks,
    Ids,
    Distances,
    Pictures,
    /// Ids, distances and colours.
    Frames,
}

const KINDS: [Kind; 6] =
    [Kind::EqualMasks, Kind::Masks, Kind::Ids, Kind::Distances, Kind::Pictures, Kind::Frames];

/// Times a comparison of two buffers that are made once.
fn bench(bencher: Bencher, kind: Kind, only_compares: bool) {
    let frames = (kind == Kind::Frames).then(frames);
    let [a, b] = match kind {
        Kind::EqualMasks => [mask(false), mask(false)],
        Kind::Masks => [false, true].map(mask),
        Kind::Ids => [false, true].map(ids),
        Kind::Distances => [false, true].map(distances),
        Kind::Pictures => [false, true].map(colors),
        Kind::Frames => {
            let frames = frames.as_ref().expect("they were drawn");
            frames.each_ref().map(|(frame, picture)| Buffer::of_frame(frame, picture))
        }
    };
    let options = CompareOptions { only_compares, ..CompareOptions::default() };
    bencher.bench_local(|| compare_with(&a, &b, &options));
}

#[divan::bench(args = KINDS)]
fn compared(bencher: Bencher, kind: Kind) {
    bench(bencher, kind, true);
}

#[divan::bench(args = KINDS)]
fn measured(bencher: Bencher, kind: Kind) {
    bench(bencher, kind, false);
}
