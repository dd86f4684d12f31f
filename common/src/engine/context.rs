//! What every inner loop of a fast renderer carries along: the vector instructions that it is compiled for, the sink
//! that its events go to, and the faults that tests plant in it.

use super::fault::{Fault, Planted};
use super::simd::Simd;
use crate::observe::EventSink;
use std::fmt;
use std::marker::PhantomData;

/// What a function without vector code needs of a [`Context`]: it is compiled once for all widths of vectors.
pub trait ScalarContext {
    /// Where events go: `()`, or `dyn Events`.
    type Sink: EventSink + ?Sized;
    /// Which faults there may be.
    type Fault: Fault;

    /// Whether events go anywhere. A branch on it costs nothing.
    const WATCHED: bool = <Self::Sink as EventSink>::ENABLED;

    /// Where events go.
    fn sink(&mut self) -> &mut Self::Sink;

    /// Whether this fault is planted. In sound code a branch on it costs nothing.
    #[inline(always)]
    fn has(fault: Planted) -> bool {
        Self::Fault::is(fault)
    }

    /// The same with vector instructions.
    #[inline(always)]
    fn with_simd<S: Simd>(&mut self, simd: S) -> LoopContext<'_, S, Self::Sink, Self::Fault> {
        LoopContext { simd, sink: self.sink(), fault: PhantomData }
    }

    /// The same without vector instructions.
    #[inline(always)]
    fn scalar(&mut self) -> LoopContext<'_, (), Self::Sink, Self::Fault> {
        LoopContext { simd: (), sink: self.sink(), fault: PhantomData }
    }
}

/// One type parameter for the three that a loop is compiled for.
///
/// Functions that take `&mut impl Context` and use [`Context::simd`] are `#[inline(always)]`.
pub trait Context: ScalarContext {
    /// The vector instructions.
    type Simd: Simd;

    /// The vector instructions.
    fn simd(&self) -> Self::Simd;
}

/// The only type that is a [`Context`]: what one loop is compiled for and tells its events to. Without vector instructions,
/// `S` is `()`.
pub struct LoopContext<'a, S, E: ?Sized, F> {
    simd: S,
    sink: &'a mut E,
    fault: PhantomData<F>,
}

impl<'a, S, E: EventSink + ?Sized, F: Fault> LoopContext<'a, S, E, F> {
    /// The context of a loop in `simd` instructions that tells `sink` of its events, with the faults of `F`.
    #[inline(always)]
    pub fn new(simd: S, sink: &'a mut E, _fault: F) -> Self {
        LoopContext::of(simd, sink)
    }

    /// As [`LoopContext::new`], where `F` is known as a type alone.
    #[inline(always)]
    pub fn of(simd: S, sink: &'a mut E) -> Self {
        LoopContext { simd, sink, fault: PhantomData }
    }
}

impl<S, E: EventSink + ?Sized, F: Fault> ScalarContext for LoopContext<'_, S, E, F> {
    type Sink = E;
    type Fault = F;

    #[inline(always)]
    fn sink(&mut self) -> &mut E {
        self.sink
    }
}

impl<S: Simd, E: EventSink + ?Sized, F: Fault> Context for LoopContext<'_, S, E, F> {
    type Simd = S;

    #[inline(always)]
    fn simd(&self) -> S {
        self.simd
    }
}

impl<S, E: ?Sized, F> fmt::Debug for LoopContext<'_, S, E, F> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("LoopContext").finish_non_exhaustive()
    }
}
