//! Both orders' results, for figures that compare them.

use crate::common::Options;
use crate::diff::{Comparison, compare_shown};
use crate::figure::subject::{FigureError, Subject};
use crate::orders::{self, Method, Order, RenderOptions, Rendered};
use crate::picture::picture;
use image::RgbImage;

/// The results of both orders and their comparison.
pub(super) struct Both {
    pub(super) object_order: Rendered,
    pub(super) image_order: Rendered,
    pub(super) pictures: [RgbImage; 2],
    pub(super) comparison: Comparison,
}

/// Renders by both orders, with the subject's rules, one sample a pixel.
pub(super) fn both(subject: &Subject) -> Result<Both, FigureError> {
    both_with(subject, 1)
}

/// The same with several samples a pixel.
pub(super) fn both_with(subject: &Subject, samples: u32) -> Result<Both, FigureError> {
    let options = RenderOptions {
        frame: Options { samples, ..Options::default() },
        rules: subject.rules,
        no_times: true,
        ..RenderOptions::default()
    };
    let render = |order: Order| {
        orders::render(order, Method::Fast, &subject.view, &options)
            .map_err(|error| FigureError::new(error.to_string()))
    };
    let (object_order, image_order) = (render(Order::Object)?, render(Order::Image)?);
    let pictures = [&object_order, &image_order].map(|one| picture(&one.frame));
    let comparison = compare_shown([&object_order.frame, &image_order.frame], pictures.each_ref());
    Ok(Both { object_order, image_order, pictures, comparison })
}
