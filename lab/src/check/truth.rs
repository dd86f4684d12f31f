//! The exact picture of a scene, as a file holds one.

use crate::common::raster::check_samples;
use crate::common::{Options, View};
use crate::diff::foreign::{Aspect, Buffer, Content};
use crate::orders::{self, Method, Order, RenderOptions};

/// The exact picture of a scene, with the content and the samples of a file.
///
/// # Errors
///
/// If the image has no such samples, or the file has colours alone.
pub(crate) fn truth(view: &View, like: &Buffer) -> Result<Buffer<'static>, String> {
    let samples = like.samples();
    check_samples(view.camera.image(), samples).map_err(|error| error.to_string())?;
    if !like.has_coverage() {
        return Err("the file has colours alone, and colours do not tell what is covered; save a mask, ids or \
                    distances, or name the colour of what is not covered with --background"
            .into());
    }
    let frame = Options { samples, crop: None };
    let options = RenderOptions { frame, no_counts: true, no_times: true, ..Default::default() };
    let rendered = orders::render(Order::Object, Method::Fast, view, &options);
    let frame = rendered.expect("only a stream has errors").frame;
    // A frame stores rows of samples, a file the samples of a pixel together.
    let order = || frame.pixels().flat_map(|[i, j]| frame.samples_of(i as usize, j as usize));
    let ids = || order().map(|sample| frame.ids().get(sample));
    let content = if like.tells(Aspect::Ids) {
        Content::Ids(ids().collect())
    } else if like.tells(Aspect::T) {
        Content::Distances(order().map(|sample| frame.distances()[sample].into()).collect())
    } else {
        let mask: Vec<bool> = ids().map(|id| id.is_some()).collect();
        Content::Mask(mask.into())
    };
    Ok(Buffer::new(view.camera.image(), samples, content))
}
