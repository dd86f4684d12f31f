//! The contract: every renderer sees the same, and what exact arithmetic says.
//!
//! Four renderers are held against one another, against rasterizers that share nothing with them, and against faults
//! planted on purpose. `BOTHWAYS_LONG=1` tries fifty times as many random scenes, and other ones in every run.

mod covered_triangles;
mod four_renderers;
mod hostile_scenes;
mod orders_agree;
mod planted_faults;
mod public_cases;
mod tilted_frames;
mod vectors;
mod watertight;
