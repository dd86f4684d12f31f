//! Object order by itself: what guards a change of this package within seconds. The textbook says what is right.
//!
//! Both orders together are tested in the root package: `cargo test --test contract --test renderers`.

mod fast;
mod frames;
mod hostile_scenes;
mod instances;
mod spheres;
