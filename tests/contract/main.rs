//! The contract: all renderers see the same primitives, and agree with exact arithmetic.
//!
//! Four renderers are compared with one another, with rasterizers that share no code with them, and with deliberate
//! faults. `BOTHWAYS_LONG=1` tests fifty times as many random scenes, and different scenes in every run.

mod covered_triangles;
mod four_renderers;
mod fuzzing;
mod hostile_scenes;
mod instances;
mod orders_agree;
mod planted_faults;
mod public_cases;
mod tilted_frames;
mod vectors;
mod watertight;
