//! Draws two triangles that share an edge exactly through samples, and shows which triangle owns each sample.
//!
//! The border of their square runs through samples, too. Every sample has one owner. Left and top edges own
//! their samples, right and bottom edges do not: adjacent tiles have neither gaps nor overlaps.
//!
//! `cargo run --example shared_edge`

use bothways::common::exact::{EdgeSigns, Sign};
use bothways::common::glam::Vec3;
use bothways::common::{Camera, Frame, Object, Options, Scene, Triangle, View, Work};
use bothways::raytrace;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // At depth 16 one unit is one pixel. 16 is a power of two, so that the position of every sample is exact.
    let camera = Camera::canonical(16, 16);
    let square = [[3.5, 3.5], [11.5, 3.5], [11.5, 11.5], [3.5, 11.5]];
    let [a, b, c, d] = square.map(|[x, y]| Vec3::new(x - 8.0, 8.0 - y, -16.0));
    let halves = [Triangle { a, b, c }, Triangle { a, b: c, c: d }];
    let scene = Scene::new(halves.map(Object::from).to_vec())?;
    let view = View::new(&scene, &camera);

    // The loops tell an observer what they do. `Work` is an observer that counts.
    let (mut frame, mut work) = (Frame::new(&camera, &Options::default()), Work::default());
    raytrace::textbook::determine_visibility(&view, &Options::default(), &mut frame, &mut work);

    // A sample is exactly on the border of a half if an edge function is zero and no other one has the wrong sign.
    let grid = camera.sample_grid(1);
    let on_an_edge = |i, j| {
        view.primitives().any(|(_, half)| {
            let edges = view.judge().coverage(&half, &grid.ray(i, j)).edges;
            edges.is_some_and(|EdgeSigns { at_sample, facing, .. }| {
                at_sample.contains(&Sign::Zero) && !at_sample.contains(&-facing)
            })
        })
    };
    for i in 0..frame.height() {
        for j in 0..frame.width() {
            let (owner, tie) = (frame.id(i, j), on_an_edge(i, j));
            let pixel = match (owner, tie) {
                (Some(0), true) => 'A',
                (Some(0), false) => 'a',
                (Some(_), true) => 'B',
                (Some(_), false) => 'b',
                (None, true) => 'o',
                (None, false) => '.',
            };
            print!("{pixel} ");
        }
        println!();
    }
    let owned = frame.ids().covered();
    println!(
        "\na, b: the two halves; A, B: owned although exactly on an edge; o: on one, not owned"
    );
    assert_eq!(owned as u64, work.fragments);
    println!("{owned} samples are owned, {} times in all: each exactly once", work.fragments);
    Ok(())
}
