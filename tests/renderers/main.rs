//! What both orders do beyond ids: looks, counts, crops, distant eyes; and that no number of threads changes a bit.

mod counting;
mod crop;
mod far_eyes;
mod filter;
#[path = "../contract/four_renderers.rs"]
mod four_renderers;
mod from_afar;
mod materials;
mod telescope;
mod textures;
mod threads;
