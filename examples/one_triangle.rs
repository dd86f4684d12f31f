//! Draws one triangle in both orders: the same two loops, swapped, give the same pixels.
//!
//! `cargo run --example one_triangle`

use bothways::common::glam::Vec3;
use bothways::common::{Camera, Frame, Options, Scene, Triangle, View};
use bothways::orders::Order;
use bothways::{diff, rasterize, raytrace};

const SIDE: u16 = 16;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The lecture's first camera. At depth SIDE the viewport is SIDE x SIDE: one unit is one pixel.
    let camera = Camera::canonical(SIDE.into(), SIDE.into());
    let depth = -f32::from(SIDE);
    let [a, b, c] = [[-7.0, -6.0], [7.0, -3.0], [-1.0, 7.0]].map(|[x, y]| Vec3::new(x, y, depth));
    let scene = Scene::new(vec![Triangle { a, b, c }.into()])?;
    let view = View::new(&scene, &camera);

    let object_order = rasterize::textbook::render(&view, &Options::default());
    let image_order = raytrace::textbook::render(&view, &Options::default());

    let line = |left: &str, right: &str| println!("{left:34}{right}");
    line(Order::Object.name(), Order::Image.name());
    let ([outer, inner], [other_outer, other_inner]) =
        (Order::Object.loops(), Order::Image.loops());
    line(outer, other_outer);
    line(&format!("  {inner}"), &format!("  {other_inner}\n"));
    for row in 0..object_order.height() {
        line(&drawn(&object_order, row), &drawn(&image_order, row));
    }
    println!("\n{}", diff::compare(&object_order, &image_order).verdict());
    Ok(())
}

/// One row of a frame, with two characters for each pixel, so that pixels look square.
fn drawn(frame: &Frame, row: usize) -> String {
    let pixel = |column| if frame.id(row, column).is_some() { "# " } else { ". " };
    (0..frame.width()).map(pixel).collect()
}
