//! Stills of a film: one order's loops, and its picture after parts of the work.

use super::error::SlideError;
use crate::common::{Camera, CameraDescription, View};
use crate::figure::{Drawing, Still, StillPage, Subject};
use crate::film::{Film, Length, default_size};
use crate::orders::{Method, Order};
use crate::wording::grouped;

/// The parts of the work after which the picture is shown, in quarters.
const QUARTERS: u32 = 4;

/// Draws the textbook's loops of one order with four stills.
pub(super) fn draw(subject: &Subject, order: Order) -> Result<Drawing, SlideError> {
    let view = &subject.view;
    let description = *view.camera.description();
    let image = default_size(description.image, Method::Textbook);
    let camera = Camera::new(CameraDescription { image, ..description })
        .map_err(|error| SlideError(format!("a smaller camera of {}: {error}", subject.name)))?;
    let small = View::new(view.scene, &camera);
    let length = Length::new(f64::from(QUARTERS), 1, 0.0).expect("four frames are a film");
    let film = Film::record(subject.name, &small, Method::Textbook, length)
        .map_err(|error| SlideError(error.to_string()))?;
    let index = match order {
        Order::Object => 0,
        Order::Image => 1,
    };
    let stills = film.shots(subject.theme.nothing()).map(|shot| {
        let [object_order, image_order] = shot.orders;
        let of_order = if index == 0 { object_order } else { image_order };
        let part = ["1/4 of the", "1/2 of the", "3/4 of the", "all"][(shot.frame - 1) as usize % 4];
        Still { picture: of_order.picture, name: format!("after {part} steps") }
    });
    let [width, height] = image;
    let facts = format!(
        "{} primitives × {} pixels = {} steps",
        grouped(view.scene.primitive_count()),
        grouped(u64::from(width) * u64::from(height)),
        grouped(film.steps()[index])
    );
    Ok(StillPage { subject, order, facts: &facts, stills: stills.collect() }.draw())
}
