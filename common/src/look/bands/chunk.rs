//! Numbers of some samples of a row, and how vectors are read from them and written to them; how many samples are shaded together.

use crate::engine::simd::{Simd, SimdBase, f32x16, f64x8};
use crate::look::color::{places_of_sixteen, store_srgb_of_sixteen};
use crate::look::lanes::{Lanes, Vec3x16, each};

/// The most samples of a row that are shaded together: what is kept of them stays in the innermost cache.
pub(super) const CHUNK: usize = 256;
/// What vectors may write beyond the last sample.
const BEYOND: usize = 16;
pub(super) const WIDE: usize = CHUNK + BEYOND;

/// Rows and columns of samples that are shaded together, where a pixel has one sample: so triangles which several rows show,
/// and the vertices of their neighbours, are still in the nearest caches. With fewer columns, the machine fetches ids and `t` late.
pub(super) const TOGETHER: [usize; 2] = [16, 2 * CHUNK];
/// Of these rows, so many have their primitives set up together: mostly enough for eight at a time, and few enough to be kept.
pub(super) const SET_UP_TOGETHER: usize = 4;
/// The most samples of a block of these.
pub(super) const MOST_OF_BLOCK: usize = SET_UP_TOGETHER * TOGETHER[1];

/// A vector for each sample of a chunk.
pub(super) type Vectors = [[f32; WIDE]; 3];

/// The red, green and blue of each sample of a chunk, and room for what vectors write beyond the last one.
pub(super) type Bytes = [[u8; 3]; WIDE + 2];

/// Numbers of the samples of a chunk.
#[derive(Debug)]
pub(super) struct Chunk {
    pub(super) x: [f64; WIDE],
    pub(super) t: [f64; WIDE],
    pub(super) normal: [[f32; WIDE]; 3],
    pub(super) coordinate: [[f64; WIDE]; 2],
    pub(super) footprint: [[f32; WIDE]; 2],
    pub(super) fraction: [f32; WIDE],
    /// Linear red, green and blue that materials are multiplied by, where they have a tint.
    pub(super) tint: [[f32; WIDE]; 3],
    /// How the texture coordinates of the last sixteen samples move: across and up, to the next sample across, and to the
    /// next one down.
    pub(super) steps: [[f32; 16]; 4],
    pub(super) color: [[f32; WIDE]; 3],
    /// Where the colours stand in the encoding as sRGB.
    pub(super) places: [[u32; WIDE]; 3],
    /// The sRGB bytes of pictures.
    pub(super) bytes: Bytes,
}

impl Chunk {
    /// Zeros.
    pub(super) fn new() -> Chunk {
        Chunk {
            x: [0.0; WIDE],
            t: [0.0; WIDE],
            normal: [[0.0; WIDE]; 3],
            coordinate: [[0.0; WIDE]; 2],
            footprint: [[0.0; WIDE]; 2],
            fraction: [0.0; WIDE],
            tint: [[0.0; WIDE]; 3],
            steps: [[0.0; 16]; 4],
            color: [[0.0; WIDE]; 3],
            places: [[0; WIDE]; 3],
            bytes: [[0; 3]; WIDE + 2],
        }
    }
}

/// The next eight numbers.
#[inline(always)]
pub(super) fn eight<S: Simd>(simd: S, numbers: &[f64], at: usize) -> f64x8<S> {
    f64x8::from_slice(simd, &numbers[at..at + 8])
}

/// The next sixteen numbers.
#[inline(always)]
pub(super) fn sixteen<S: Simd>(simd: S, numbers: &[f32], at: usize) -> f32x16<S> {
    f32x16::from_slice(simd, &numbers[at..at + 16])
}

/// The next sixteen vectors.
#[inline(always)]
pub(super) fn sixteen_vectors<S: Simd>(
    simd: S,
    [x, y, z]: &[[f32; WIDE]; 3],
    at: usize,
) -> Vec3x16<S> {
    Lanes { x: sixteen(simd, x, at), y: sixteen(simd, y, at), z: sixteen(simd, z, at) }
}

/// Writes a vector for each lane, one sample after the other.
#[inline(always)]
pub(super) fn store_vectors<S: Simd, V: SimdBase<S, Element = f32>>(
    vectors: &Lanes<V>,
    to: &mut Vectors,
    at: usize,
) {
    let [to_x, to_y, to_z] = to;
    vectors.x.store_slice(&mut to_x[at..at + V::LEN]);
    vectors.y.store_slice(&mut to_y[at..at + V::LEN]);
    vectors.z.store_slice(&mut to_z[at..at + V::LEN]);
}

/// Writes where the next sixteen colours stand in the encoding as sRGB.
#[inline(always)]
pub(super) fn store_sixteen_places<S: Simd>(
    simd: S,
    colors: [f32x16<S>; 3],
    [red, green, blue]: &mut [[u32; WIDE]; 3],
    at: usize,
) {
    places_of_sixteen(simd, colors[0]).store_slice(&mut red[at..at + 16]);
    places_of_sixteen(simd, colors[1]).store_slice(&mut green[at..at + 16]);
    places_of_sixteen(simd, colors[2]).store_slice(&mut blue[at..at + 16]);
}

/// Writes the sRGB bytes of the next sixteen colours, from their places in the encoding.
#[inline(always)]
pub(super) fn store_sixteen_bytes<S: Simd>(
    simd: S,
    places: &[[u32; WIDE]; 3],
    to: &mut Bytes,
    at: usize,
) {
    let places = each!(k in [0, 1, 2] => places[k][at..].first_chunk().expect("vectors have room"));
    let to = to.as_flattened_mut()[3 * at..].first_chunk_mut();
    store_srgb_of_sixteen(simd, places, to.expect("vectors have room"));
}
