//! Vertices that are rounded, as GPUs have them.

use super::*;
use crate::common::{Frame, Options};
use crate::rules::object_order::{self, Rule};

/// The picture of a renderer that rounds vertices, written on its own, in the order of llvmpipe's operations.
fn by_rule(view: &View, bits: u8) -> Frame {
    object_order::render(view, &Options::default(), Rule::Snapped { bits })
}

fn numbers(frame: &Frame) -> Vec<Option<u64>> {
    frame.ids().iter().collect()
}

#[test]
fn a_hypothesis_of_rounded_vertices_is_drawn_as_such_a_renderer_draws() {
    for projection in [Projection::Perspective, Projection::Parallel] {
        with_scene(&coarse_lecture(), [160, 120], projection, |view| {
            for bits in [8, 4, 0] {
                let rule = numbers(&by_rule(view, bits));
                let differing = |vertices| {
                    let convention = Convention::default().with(Change::Vertices(vertices));
                    let drawn = draw(view, &convention, Rows::ALL);
                    let ids = drawn.ids.iter().map(|&id| (id != NO_PRIMITIVE).then_some(id.into()));
                    ids.zip(&rule).filter(|(one, other)| one != *other).count()
                };
                let [ours, theirs] =
                    [Vertices::Projected, Vertices::Rounded { bits }].map(differing);
                // The renderer computes in `f32`.
                assert!(ours > 3 && 20 * theirs <= ours, "{bits} bits: {ours}, {theirs}");
            }
        });
    }
}

/// The conventions that explain a file.
fn found(view: &View, file: &Buffer) -> Vec<Convention> {
    match find_conventions(view, file).unwrap().finding {
        Finding::Explained(found) => found.into_iter().map(|one| one.convention).collect(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn vertices_that_are_rounded_are_named_from_ids() {
    with_scene(&coarse_lecture(), [320, 240], Projection::Perspective, |view| {
        for bits in [8, 4, 0] {
            let ids = numbers(&by_rule(view, bits));
            // Rows from the bottom, as OpenGL returns them: of eight bits beside them, too few pixels tell.
            let turned: Vec<Option<u64>> = ids.chunks(320).rev().flatten().copied().collect();
            let files = [(ids, Placement::Upright), (turned, Placement::UpsideDown)];
            for (numbers, placement) in files.into_iter().take(if bits == 8 { 1 } else { 2 }) {
                let file = Buffer::new([320, 240], 1, Content::Ids(numbers));
                let planted = Convention::default()
                    .with(Change::Placement(placement))
                    .with(Change::Vertices(Vertices::Rounded { bits }));
                let found = found(view, &file);
                assert!(found.contains(&planted), "{bits}: {found:?}");
            }
        }
    });
}

#[test]
fn what_rounding_alone_decides_is_called_so_unless_something_else_is_wrong_too() {
    let loaded = scenes::load("slivers").unwrap();
    let [width, height] = [320, 240];
    let camera = CameraDescription { image: [width, height], ..loaded.camera };
    let camera = Camera::new(camera).unwrap();
    let view = View::new(&loaded.scene, &camera);
    let mut ids =
        numbers(&object_order::render(&view, &Options::default(), "float32".parse().unwrap()));
    let finding = |ids: &[Option<u64>]| {
        let file = Buffer::new([width, height], 1, Content::Ids(ids.to_vec()));
        find_conventions(&view, &file).unwrap()
    };
    let Findings { differing, finding: of_rounding, .. } = finding(&ids);
    assert!(differing > 30 && of_rounding == Finding::Rounded, "{differing}");
    let known = ids.iter_mut().find(|id| id.is_some()).unwrap();
    *known = Some(1);
    assert_ne!(finding(&ids).finding, Finding::Rounded);
}
