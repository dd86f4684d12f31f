//! Both pictures and their difference: the slide that `render` writes.

use super::both::both_with;
use crate::figure::Slide;
use crate::figure::drawing::Drawing;
use crate::figure::subject::{FigureError, Subject};

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let both = both_with(subject, subject.samples)?;
    let slide = Slide {
        scene: subject.name,
        about: subject.about,
        primitives: subject.view.scene.primitive_count(),
        threads: 1,
        object_order: &both.object_order,
        image_order: &both.image_order,
        pictures: both.pictures.each_ref(),
        comparison: &both.comparison,
    };
    Ok(slide.draw(subject.theme))
}
