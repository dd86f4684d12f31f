//! Faults that tests plant inside the visibility code, to see that the verdict can fail.
//!
//! Not for users: every public renderer runs with [`Sound`], whose branches the compiler removes.

/// What is broken on purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Planted {
    /// One tile of the picture is never drawn.
    DroppedTile,
    /// A comparison that must admit equality does not.
    StrictComparison,
    /// A bounding box (object order: in the picture; image order: in the world, where nothing makes up for
    /// it) is too small by the last place of its numbers.
    ShrunkBox,
    /// The arithmetic is trusted as if it were exact.
    ZeroErrorBound,
    /// Of equal primitives the last one wins.
    TiesToLast,
    /// One inner node of the hierarchy is never entered.
    ForgottenNode,
}

/// A renderer's code is generic over the fault in it.
pub trait Fault: Copy + Send + Sync {
    /// The fault, or none.
    const PLANTED: Option<Planted>;

    /// Whether this fault is planted.
    fn is(fault: Planted) -> bool {
        Self::PLANTED == Some(fault)
    }
}

/// No fault.
#[derive(Clone, Copy, Debug)]
pub struct Sound;

impl Fault for Sound {
    const PLANTED: Option<Planted> = None;
}

macro_rules! faults {
    ($($name:ident)*) => {$(
        #[doc = concat!("Plants [`Planted::", stringify!($name), "`].")]
        #[derive(Clone, Copy, Debug)]
        pub struct $name;

        impl Fault for $name {
            const PLANTED: Option<Planted> = Some(Planted::$name);
        }
    )*};
}

faults! { DroppedTile StrictComparison ShrunkBox ZeroErrorBound TiesToLast ForgottenNode }
