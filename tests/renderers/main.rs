//! The results of both orders besides ids: looks, lights, counts, crops, distant eyes; and the same bits for any number of
//! threads.

mod counting;
mod crop;
mod executed;
mod far_eyes;
mod filter;
#[path = "../contract/four_renderers.rs"]
mod four_renderers;
mod from_afar;
mod lights;
mod materials;
mod rules;
mod same_bytes;
mod telescope;
mod textures;
mod threads;
