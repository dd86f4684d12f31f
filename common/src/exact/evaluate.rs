//! One formula, three arithmetics: rounded with a proved bound, rounded to twice as many digits, and exact.
//!
//! A predicate is written once, over [`Real`](super::real::Real). [`exactly!`] evaluates it in
//! [`Bounded`](super::bounded::Bounded) arithmetic first. Where the bound leaves the sign open, it evaluates the
//! predicate in [`Double`](super::double::Double) numbers, whose bound is about 2⁵³ times smaller. Only where even that
//! is not certain, it evaluates the predicate in [`Dyadic`](super::dyadic::Dyadic) numbers, which have no error (a
//! floating-point filter: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//! Predicates", Discrete & Computational Geometry 18, 1997).

/// Evaluates a predicate in bounded, then in doubled, and where that is not certain in exact arithmetic.
macro_rules! exactly {
    ($predicate:ident ( $($argument:expr),* )) => {
        $predicate::<crate::exact::bounded::Bounded>($($argument),*)
            .or_else(|| $predicate::<crate::exact::double::Double>($($argument),*))
            .or_else(|| $predicate::<crate::exact::dyadic::Dyadic>($($argument),*))
            .expect("exact arithmetic leaves no sign open")
    };
}
pub(super) use exactly;
