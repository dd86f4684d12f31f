//! The two pictures that stand on the page before any script has run: the first scene in both orders.

use crate::failure::Failure;
use bothways_lab::common::{Camera, CameraDescription, Options, View};
use bothways_lab::picture::picture;
use bothways_lab::{rasterize, raytrace, scenes};
use image::{ImageFormat, RgbImage};
use std::io::Cursor;

/// Width and height.
const SIZE: [u32; 2] = [320, 240];

/// PNG files.
#[derive(Debug)]
pub(crate) struct Stills {
    pub(crate) object_order: Vec<u8>,
    pub(crate) image_order: Vec<u8>,
}

/// Draws both.
pub(crate) fn draw() -> Result<Stills, Failure> {
    let failed = |reason: &dyn std::fmt::Display| Failure::Still { reason: reason.to_string() };
    let loaded = scenes::load(scenes::DEFAULT).map_err(|error| failed(&error))?;
    let camera = Camera::new(CameraDescription { image: SIZE, ..loaded.camera });
    let camera = camera.map_err(|error| failed(&error))?;
    let view = View::new(&loaded.scene, &camera);
    let object_order = rasterize::fast::prepare(view.scene);
    let image_order = raytrace::fast::prepare(view.scene);
    let options = Options::default();
    let png = |picture: RgbImage| {
        let mut bytes = Cursor::new(Vec::new());
        let written = picture.write_to(&mut bytes, ImageFormat::Png);
        written.map_err(|error| failed(&error)).map(|()| bytes.into_inner())
    };
    Ok(Stills {
        object_order: png(picture(&rasterize::fast::render(&object_order, &view, &options)))?,
        image_order: png(picture(&raytrace::fast::render(&image_order, &view, &options)))?,
    })
}
