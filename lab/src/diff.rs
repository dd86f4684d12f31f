//! Do both orders see the same? Where do two files of any origin differ?
//!
//! One comparison serves both: a [`Frame`](crate::common::Frame) and a file are each a
//! [`Buffer`](foreign::Buffer). Coverage and primitive ids have no tolerance. Of the two orders they alone decide;
//! depth and colour, which each order rounds in its own way, are measured and reported.
//!
//! [`foreign`] reads and compares files of any origin, and [`pairs`] finds those of two folders that
//! belong together.

mod alike;
mod aspect;
mod bits;
mod buffer;
mod buffer_pair;
mod classes;
mod compare;
pub mod foreign;
mod measures;
mod orders;
pub mod page;
pub mod pairs;
mod tolerance;
pub mod why;

pub use classes::{Class, Classes, alike_color};
pub use orders::{
    Color, Comparison, Coverage, Depth, Visible, compare, compare_shown, verdict_of_equal,
};
pub use tolerance::{
    COLOR_TOLERANCE, CompareOptions, DEPTH_TOLERANCE, NORMAL_TOLERANCE, Tolerances,
};

#[cfg(test)]
mod tests;
