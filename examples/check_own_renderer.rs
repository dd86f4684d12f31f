//! Checks a renderer against the trusted answer, pixel by pixel, and says why pixels differ.
//!
//! The renderer under test is wrong on purpose: its triangles own all of their edges (`>= 0`), and the
//! last one drawn wins. `cargo run --example check_own_renderer`

use bothways::common::{Camera, Options, Scene, Triangle, View, glam::Vec3};
use bothways::rasterize;

/// A square of two triangles whose edges run through samples, in pixels: x right, y down.
const TRIANGLES: [[[f32; 2]; 3]; 2] =
    [[[3.5, 3.5], [11.5, 3.5], [11.5, 11.5]], [[3.5, 3.5], [11.5, 11.5], [3.5, 11.5]]];

/// The rasterizer under test: the last triangle that covers the centre of a pixel, edges included.
fn own_renderer(row: u16, column: u16) -> Option<u32> {
    let [x, y] = [column, row].map(|index| f32::from(index) + 0.5);
    let covers = |[a, b, c]: [[f32; 2]; 3]| {
        [(a, b), (b, c), (c, a)]
            .iter()
            .all(|([px, py], [qx, qy])| (qx - px) * (y - py) - (qy - py) * (x - px) >= 0.0)
    };
    (0..).zip(TRIANGLES).filter(|&(_, triangle)| covers(triangle)).map(|(id, _)| id).last()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // At depth 16 one unit is one pixel. 16 is a power of two, so that the position of every sample is exact.
    let camera = Camera::canonical(16, 16);
    let in_world = |[x, y]: [f32; 2]| Vec3::new(x - 8.0, 8.0 - y, -16.0);
    let objects = TRIANGLES.map(|corners| {
        let [a, b, c] = corners.map(in_world);
        Triangle { a, b, c }.into()
    });
    let scene = Scene::new(objects.to_vec())?;
    let trusted = rasterize::textbook::render(&View::new(&scene, &camera), &Options::default());

    let mut picture = String::new();
    for row in 0..16 {
        for column in 0..16 {
            let pixel = match (own_renderer(row, column), trusted.id(row.into(), column.into())) {
                (None, None) => '.',
                (Some(0), Some(0)) => 'a',
                (Some(1), Some(1)) => 'b',
                (Some(_), None) => '+',
                (Some(_), Some(_)) => '!',
                (None, Some(_)) => '-',
            };
            picture.extend([pixel, ' ']);
        }
        picture.push('\n');
    }
    let [extra, other, missing] = ['+', '!', '-'].map(|mark| picture.matches(mark).count());
    assert_eq!([extra, other, missing], [17, 8, 0]);
    println!("{picture}\n{} of 256 pixels differ:", extra + other + missing);
    println!("+ {extra:2} drawn, though right and bottom edges do not own their samples");
    println!("! {other:2} of the wrong triangle: both own the shared edge, and the last one wins");
    println!("- {missing:2} missing");
    Ok(())
}
