//! The engine room, for the two renderers alone: vectors of lanes, memory in large pages, planted faults,
//! observers of any type, short names, and the vocabulary of rounding errors. Nothing in it decides a sign.

pub mod any_observer;
pub mod context;
pub mod fault;
pub mod memory;
pub mod names;
pub mod roundoff;
pub mod simd;
pub mod tasks;
