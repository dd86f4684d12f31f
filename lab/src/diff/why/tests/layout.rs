//! Buffers with a wrong offset or a wrong stride.

use super::*;

/// Ids, distances and a mask of a scene, with their elements rearranged: `None` for nothing.
fn files(view: &View, sources: &[Option<usize>]) -> [Buffer<'static>; 3] {
    let truth = draw(view, &Convention::default(), Rows::ALL);
    let id = |&pixel: &Option<usize>| {
        let id = truth.ids[pixel?];
        (id != NO_PRIMITIVE).then_some(u64::from(id))
    };
    let ids: Vec<Option<u64>> = sources.iter().map(id).collect();
    let t = sources.iter().map(|pixel| pixel.map_or(f64::INFINITY, |pixel| truth.t[pixel]));
    let mask: Vec<bool> = ids.iter().map(Option::is_some).collect();
    let contents = [Content::Ids(ids), Content::Distances(t.collect()), Content::Mask(mask.into())];
    contents.map(|content| Buffer::new(view.camera.image(), 1, content))
}

/// The only layout that is named for a file.
fn layout_of(view: &View, file: &Buffer) -> Option<Layout> {
    match find_conventions(view, file).unwrap().finding {
        Finding::Explained(found) if found.len() == 1 => found[0].layout,
        _ => None,
    }
}

#[test]
fn a_buffer_that_is_shifted_is_named() {
    with_scene(&coarse_lecture(), [66, 44], Projection::Perspective, |view| {
        let count = 66 * 44;
        for by in [7_isize, -5, 70] {
            for wraps in [true, false] {
                let source = |element: usize| {
                    let from = element.cast_signed() - by;
                    let inside = usize::try_from(from).ok().filter(|&from| from < count);
                    let again = from.rem_euclid(count.cast_signed()).cast_unsigned();
                    if wraps { Some(again) } else { inside }
                };
                let sources: Vec<Option<usize>> = (0..count).map(source).collect();
                let [ids, t, _] = files(view, &sources);
                for file in [ids, t] {
                    assert_eq!(layout_of(view, &file), Some(Layout::Shifted { by }), "{wraps}");
                }
            }
        }
    });
}

#[test]
fn rows_of_another_length_are_named() {
    with_scene(&coarse_lecture(), [66, 44], Projection::Perspective, |view| {
        let (width, height) = (66, 44);
        for (stride, said) in [(44, "rows of 44 elements (H)"), (67, "(W + 1)"), (65, "(W - 1)")] {
            let mut sources = vec![None; width * height];
            let truth = draw(view, &Convention::default(), Rows::ALL).ids;
            for pixel in (0..width * height).filter(|&pixel| truth[pixel] != NO_PRIMITIVE) {
                let element = pixel / width * stride + pixel % width;
                if let Some(source) = sources.get_mut(element) {
                    *source = Some(pixel);
                }
            }
            // The outline of this mask has too few pixels that tell.
            let [ids, t, _] = files(view, &sources);
            for file in [ids, t] {
                let finding = find_conventions(view, &file).unwrap().finding;
                let Finding::Explained(found) = finding else { panic!("{stride}") };
                assert_eq!(found[0].layout, Some(Layout::Stride { stride }));
                let sentences = found[0].sentences("B", view.camera).join("; ");
                assert!(sentences.contains(said), "{sentences}");
            }
        }
    });
}

#[test]
fn a_picture_of_a_camera_is_no_shifted_buffer() {
    with_scene(&coarse_lecture(), [66, 44], Projection::Perspective, |view| {
        for sampling in [Sampling::PixelBefore, Sampling::PixelAfter, Sampling::OneFewer] {
            let planted = Convention { columns: sampling, ..Convention::default() };
            for of_ids in [true, false] {
                let layout = layout_of(view, &file(view, &planted, of_ids));
                assert_eq!(layout, None, "{sampling:?}");
            }
        }
    });
}
