//! Faults that tests plant inside the visibility code, to see that the verdict can fail.
//!
//! Not for users: every public renderer runs with [`Sound`], whose branches the compiler removes.

use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Mutex, PoisonError};

/// What is broken on purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Planted {
    /// One tile of the picture is never drawn.
    DroppedTile,
    /// A comparison that must admit equality does not.
    StrictComparison,
    /// A bounding box is too small by the last place of its numbers: in object order a box in the picture, in image
    /// order a box in the world.
    ShrunkBox,
    /// The arithmetic is trusted as if it were exact.
    ZeroErrorBound,
    /// Every error bound of the arithmetic is infinite. Then exact arithmetic decides everything, and no picture may
    /// change.
    InfiniteErrorBound,
    /// Every error bound of where boxes, vertices and leaves are seen is infinite. No picture may change.
    InfiniteMargin,
    /// Of equal primitives the last one wins.
    TiesToLast,
    /// One inner node of the hierarchy is never entered.
    ForgottenNode,
}

/// A renderer's code is generic over whether faults are planted in it.
pub trait Fault: Copy + Send + Sync {
    /// Whether no fault is ever planted.
    const SOUND: bool;

    /// Whether this fault is planted.
    fn is(fault: Planted) -> bool;
}

/// A bound of rounding errors: the bound itself, or what a planted fault makes of it.
#[inline(always)]
pub fn error_bound<F: Fault>(bound: f64) -> f64 {
    if F::is(Planted::ZeroErrorBound) {
        0.0
    } else if F::is(Planted::InfiniteErrorBound) {
        f64::INFINITY
    } else {
        bound
    }
}

/// No fault.
#[derive(Clone, Copy, Debug)]
pub struct Sound;

impl Fault for Sound {
    const SOUND: bool = true;

    fn is(_fault: Planted) -> bool {
        false
    }
}

/// The fault that [`with`] plants: any of them, so that the code is compiled once for all.
#[derive(Clone, Copy, Debug)]
pub struct Faulty;

impl Fault for Faulty {
    const SOUND: bool = false;

    fn is(fault: Planted) -> bool {
        PLANTED.load(Ordering::Relaxed) == fault as u8
    }
}

/// What is planted now; `NONE` for nothing.
static PLANTED: AtomicU8 = AtomicU8::new(NONE);
const NONE: u8 = u8::MAX;

/// Runs something with a fault planted, if any, wherever [`Faulty`] code asks for it. Others wait meanwhile.
pub fn with<R>(fault: Option<Planted>, run: impl FnOnce() -> R) -> R {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _one = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    PLANTED.store(fault.map_or(NONE, |fault| fault as u8), Ordering::Relaxed);
    let result = run();
    PLANTED.store(NONE, Ordering::Relaxed);
    result
}
