//! The engine room, for the crates of this workspace: vectors of lanes, memory in large pages, the size of caches, planted
//! faults, observers of any type, short names, the constants of rounding errors, and the times of tasks. It computes, and
//! holds no predicate.

pub mod any_observer;
pub mod cache;
pub mod context;
pub mod fault;
pub mod memory;
pub mod names;
pub mod roundoff;
pub mod simd;
pub mod tasks;
