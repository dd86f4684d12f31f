//! SIMD for both orders: vectors of a fixed number of lanes, and a run-time choice of how the machine
//! computes them.
//!
//! Vectors and masks come from [`fearless_simd`]. Code is written once, generic over [`Simd`], for sixteen lanes of
//! `f32` (eight of `f64`); [`dispatch!`] runs it at a [`Level`]: AVX-512, AVX2, SSE4.2, SSE2, NEON, WebAssembly's
//! SIMD, or plain scalars. (A clone leaves SSE4.2 out, see `.cargo/config.toml`: it takes SSE2 in its place.) The number of lanes never changes, and the code uses only operations that IEEE 754 rounds
//! correctly (no fused multiply-add, no approximate reciprocal), so the level changes no bit of any result.
//!
//! Functions between [`dispatch!`] and the vector operations must be `#[inline(always)]`, or do all that they do with vectors
//! within [`apart!`]; otherwise they are compiled for the wrong level. So that they do not all become one function, which would
//! take minutes to compile, [`apart!`] makes a part of them a function of its own.

mod shuffle;

pub use fearless_simd::prelude::*;
pub use fearless_simd::{
    Level, Simd, dispatch, f32x4, f32x8, f32x16, f64x4, f64x8, i32x4, i32x8, i32x16, mask32x4,
    mask32x8, mask32x16, mask64x8, u8x32, u8x64, u32x8, u32x16,
};

pub use shuffle::{Compression, PackedShuffles, Shuffle, store_three_bytes_each};

/// Asks the machine to load a value into its cache before use. This function changes nothing else.
#[inline(always)]
pub fn prefetch<T>(soon: &T) {
    #[cfg(target_arch = "x86_64")]
    for line in 0..size_of::<T>().div_ceil(64) {
        use core::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        let start = core::ptr::from_ref(soon).cast::<i8>();
        // SAFETY: SSE is part of every x86-64, and the instruction is defined for any address.
        #[expect(unsafe_code, reason = "a hint: nothing is read, whatever the address")]
        unsafe {
            _mm_prefetch::<_MM_HINT_T1>(start.wrapping_add(64 * line));
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = soon;
}

/// [`prefetch`] for all values of a slice.
#[inline(always)]
pub fn prefetch_all<T>(values: &[T]) {
    // One for each line of the cache, if it begins with one; the last line is asked for by its last value.
    const { assert!(1 <= size_of::<T>() && size_of::<T>() <= 64, "no more than a line") };
    values.iter().step_by(64 / size_of::<T>()).chain(values.last()).for_each(prefetch);
}

/// [`prefetch`] for a value of a slice, if there is one at the index.
#[inline(always)]
pub fn prefetch_at<T>(values: &[T], index: usize) {
    if let Some(soon) = values.get(index) {
        prefetch(soon);
    }
}

/// Computes an expression in a function of its own, for the level of `simd`. Without this, [`dispatch!`] makes one function
/// of all that it runs.
///
/// The compiler optimizes a function of its own first, and only then decides whether to make it a part of its caller. That
/// takes far less time than to optimize the same code within a function that is many times as large.
///
/// The expression is compiled once for each set of the generic parameters of the function in which it stands: let event sinks and
/// closures not be among them. If that function is `#[inline(never)]`, all callers share what is compiled; if it is
/// `#[inline(always)]`, each unit of the crate that calls it has its own.
///
/// A call is worth it for a tile, a leaf or some triangles, not for a few operations: arguments and results go through memory,
/// vectors, too, and so does what the caller keeps in registers meanwhile. Where the expression writes to memory, let it call
/// functions, and pass what they need as parameters. The compiler knows that references among the parameters of a function do not
/// overlap; what a closure borrows may overlap for all that it knows, and is read anew after each write.
///
/// ```
/// use bothways_common::engine::simd::{Simd, SimdBase, apart, best_level, dispatch, f32x16};
///
/// #[inline(always)]
/// fn squares<S: Simd>(simd: S, of: &[f32; 16]) -> [f32; 16] {
///     let of = f32x16::load_array_ref(simd, of);
///     (of * of).to_array()
/// }
/// let nine = dispatch!(best_level(), simd => apart!(simd, squares(simd, &[3.0; 16])));
/// assert_eq!(nine, [9.0; 16]);
/// ```
#[macro_export]
macro_rules! apart {
    ($simd:expr, $part:expr) => {
        $crate::engine::simd::Simd::vectorize(
            $simd,
            #[inline(always)]
            || $part,
        )
    };
}

pub use crate::apart;

/// [`dispatch!`] for code that is generic over a [`Fault`](crate::engine::fault::Fault). Code with faults may be
/// slow: it is compiled for one level only, if there are several levels.
#[macro_export]
#[cfg(target_arch = "x86_64")]
macro_rules! dispatch_with {
    ($fault:ty, $level:expr, $simd:pat => $op:expr) => {
        if const { !<$fault as $crate::engine::fault::Fault>::SOUND } {
            let $simd = $crate::engine::simd::least();
            $op
        } else {
            $crate::engine::simd::dispatch!($level, $simd => $op)
        }
    };
}

/// [`dispatch!`] for code that is generic over a [`Fault`](crate::engine::fault::Fault).
#[macro_export]
#[cfg(not(target_arch = "x86_64"))]
macro_rules! dispatch_with {
    ($fault:ty, $level:expr, $simd:pat => $op:expr) => {
        $crate::engine::simd::dispatch!($level, $simd => $op)
    };
}

pub use crate::dispatch_with;

/// The lowest level, which needs no more instructions than the other code of the program.
#[doc(hidden)]
#[cfg(target_arch = "x86_64")]
pub fn least() -> impl Simd {
    Level::baseline().as_sse2().expect("SSE2 is part of every x86-64")
}

/// The best level of this machine.
pub fn best_level() -> Level {
    Level::new()
}

/// Every level of this machine, the best level first: for tests that compare the levels.
pub fn levels() -> Vec<Level> {
    let best = Level::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if best.as_sse2().is_some() {
        let avx2 = best.as_avx2().map(Simd::level);
        let sse4_2 = best.as_sse4_2().map(Simd::level);
        let sse2 = best.as_sse2().map(Simd::level);
        let lesser = [avx2, sse4_2, sse2].into_iter().flatten();
        let name = |level: &Level| format!("{level:?}");
        let lesser = lesser.filter(|level| name(level) != name(&best));
        return [best].into_iter().chain(lesser).collect();
    }
    vec![best]
}

/// Writes sixteen numbers that are not needed again soon: past the caches, if the machine supports this. Call
/// [`finish_streaming`] before other threads read the numbers.
#[inline(always)]
#[cfg_attr(
    target_arch = "x86_64",
    expect(unsafe_code, reason = "the intrinsic takes a pointer; it writes what the array holds")
)]
pub fn stream<T: Copy + Sixteen>(values: [T; 16], to: &mut [T; 16]) {
    #[cfg(target_arch = "x86_64")]
    {
        use core::arch::x86_64::{__m128i, _mm_loadu_si128, _mm_stream_si128};
        let (from, onto) = (values.as_ptr().cast::<__m128i>(), to.as_mut_ptr().cast::<__m128i>());
        if onto.is_aligned() {
            for quarter in 0..4 {
                // SAFETY: both arrays have 64 bytes, any of which may hold any bits; `onto` is
                // aligned; SSE2 is part of every x86-64.
                unsafe {
                    _mm_stream_si128(onto.add(quarter), _mm_loadu_si128(from.add(quarter)));
                }
            }
            return;
        }
    }
    *to = values;
}

/// A four-byte number type in which every bit belongs to the value.
pub trait Sixteen: sealed::Sealed {}
impl Sixteen for f32 {}
impl Sixteen for u32 {}

mod sealed {
    #[expect(unnameable_types, reason = "so that nobody else implements it")]
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for u32 {}
}

/// Makes the writes of [`stream`] visible to other threads in the same way as other writes.
#[inline(always)]
#[cfg_attr(target_arch = "x86_64", expect(unsafe_code, reason = "a fence has no condition"))]
pub fn finish_streaming() {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: SSE is part of every x86-64.
    unsafe {
        core::arch::x86_64::_mm_sfence();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[inline(always)]
    fn quotients<S: Simd>(simd: S) -> [f32; 16] {
        let numerators = f32x16::from_fn(simd, |lane| lane as f32 + 0.1);
        (numerators / f32x16::splat(simd, 3.0)).to_array()
    }

    #[test]
    fn all_levels_compute_the_same() {
        let results: Vec<[f32; 16]> =
            levels().into_iter().map(|level| dispatch!(level, simd => quotients(simd))).collect();
        println!("{} levels", results.len());
        assert!(results.iter().all(|result| *result == results[0]));
    }
}
