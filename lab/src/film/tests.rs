//! Films show what is rendered and counted.

use super::*;
use crate::common::raster::Sample;
use crate::common::{Camera, Events, Observer, Options, Projection};
use crate::orders::{RenderOptions, Rendered, render};
use crate::picture::picture;
use crate::scenes;
use image::Rgb;

const BOTH: [Method; 2] = [Method::Textbook, Method::Fast];

/// Calls a test with the view of a built-in scene.
fn with_view(scene: &str, image: [u32; 2], projection: Projection, test: impl FnOnce(&View)) {
    let loaded = scenes::load(scene).unwrap();
    let mut description = loaded.camera;
    (description.image, description.projection) = (image, projection);
    let camera = Camera::new(description).unwrap();
    test(&View::new(&loaded.scene, &camera));
}

fn length(frames: u32) -> Length {
    Length::new(f64::from(frames) / 25.0, 25, 0.2).unwrap()
}

fn rendered(order: Order, method: Method, view: &View) -> Rendered {
    render(order, method, view, &RenderOptions { no_times: true, ..Default::default() }).unwrap()
}

#[test]
fn the_last_frame_shows_the_rendered_pictures_and_the_counts_are_those_of_the_report() {
    for (scene, image, projection) in [
        ("canonical", [24, 18], Projection::Perspective),
        ("overlap", [20, 20], Projection::Perspective),
        ("slivers", [16, 24], Projection::Parallel),
        ("behind", [24, 16], Projection::Perspective),
        ("ties", [16, 16], Projection::Parallel),
    ] {
        with_view(scene, image, projection, |view| {
            for method in BOTH {
                let film = Film::record(scene, view, method, length(30)).unwrap();
                let shots: Vec<Shot> = film.shots([[1, 2, 3], [4, 5, 6]]).collect();
                assert_eq!(shots.len(), 30);
                for (k, order) in [Order::Object, Order::Image].into_iter().enumerate() {
                    let rendered = rendered(order, method, view);
                    let work = rendered.work().unwrap();
                    let about = format!("{scene}, {}, {}", method.name(), order.name());
                    assert_eq!(film.steps()[k], work.tests + work.nodes, "{about}");
                    let last = &shots[29].orders[k];
                    assert_eq!(last.picture, picture(&rendered.frame), "{about}");
                    assert_eq!((last.steps, last.done), (film.steps()[k], true), "{about}");
                    assert_eq!(last.finished, u64::from(image[0] * image[1]), "{about}");
                    // Every pixel has come to stay before, but for those that show nothing in object order.
                    let stays = film.tracks[k].changes.iter().filter(|change| change.stays).count();
                    let expected = match order {
                        Order::Object => rendered.covered(),
                        Order::Image => last.finished,
                    };
                    assert_eq!(stays as u64, expected, "{about}");
                }
                assert!(film.comparison().matches());
            }
        });
    }
}

#[test]
fn the_clock_goes_on_and_nothing_finished_is_undone() {
    with_view("lecture", [12, 9], Projection::Perspective, |view| {
        for method in BOTH {
            let film = Film::record("lecture", view, method, length(40)).unwrap();
            let longest = film.steps().into_iter().max().unwrap();
            let shots: Vec<Shot> = film.shots([[0; 3]; 2]).collect();
            for (k, shot) in (1..).zip(&shots) {
                assert_eq!((shot.frame, shot.clock), (k, longest * u64::from(k) / 40));
                for (order, all) in shot.orders.iter().zip(film.steps()) {
                    assert_eq!(order.steps, shot.clock.min(all));
                    assert_eq!(order.done, shot.clock >= all);
                    assert_eq!(order.done, order.position.line == Line::Done);
                }
            }
            for pair in shots.windows(2) {
                for (before, after) in pair[0].orders.iter().zip(&pair[1].orders) {
                    assert!(before.finished <= after.finished);
                    let changed = before.picture.enumerate_pixels().filter(|(x, y, old)| {
                        after.picture.get_pixel(*x, *y) != *old && !after.fresh.contains(&[*y, *x])
                    });
                    assert!(after.done || changed.count() == 0, "only fresh pixels change");
                }
            }
        }
    });
}

/// Every step of the loops in their order, and the pixels that were finished after it.
#[derive(Default)]
struct Log(Vec<(Sample, Option<u32>)>);

impl Observer for Log {
    fn fork(&self) -> Self {
        Log::default()
    }

    fn join(&mut self, part: Self) {
        self.0.extend(part.0);
    }
}

impl Events for Log {
    fn node_opened(&mut self, sample: Sample, _node: u32, _entered: bool) {
        self.0.push((sample, None));
    }

    fn sample_tested(&mut self, sample: Sample, primitive: u64) {
        self.0.push((sample, Some(u32::try_from(primitive).unwrap())));
    }
}

/// The picture has several tiles in both fast renderers, so that parts of it count on their own.
#[test]
fn each_frame_shows_the_step_of_its_clock() {
    with_view("behind", [40, 300], Projection::Perspective, |view| {
        let film = Film::record("behind", view, Method::Fast, length(97)).unwrap();
        let options = Options::default();
        let mut frame = crate::common::Frame::new(view.camera, &options);
        let mut logs = [Log::default(), Log::default()];
        let prepared = crate::rasterize::fast::prepare(view.scene);
        crate::rasterize::fast::determine_visibility(
            &prepared,
            view,
            &options,
            &mut frame,
            &mut logs[0],
        );
        let prepared = crate::raytrace::fast::prepare(view.scene);
        crate::raytrace::fast::determine_visibility(
            &prepared,
            view,
            &options,
            &mut frame,
            &mut logs[1],
        );
        for shot in film.shots([[0; 3]; 2]) {
            for (order, log) in shot.orders.iter().zip(&logs) {
                if order.done {
                    assert_eq!(order.steps, log.0.len() as u64);
                    continue;
                }
                let (sample, primitive) = log.0[usize::try_from(shot.clock).unwrap() - 1];
                let Position { line, node, .. } = order.position;
                let expected = (Some(sample), primitive.is_none());
                // The outer loop has taken its next value, or a fragment of several tests was told after all of them.
                if [Line::Test, Line::Inner].contains(&line) {
                    let at = (order.position.sample, node.is_some());
                    assert_eq!(at, expected, "{shot:?}", shot = order.position);
                    assert_eq!(order.position.primitive, primitive);
                }
            }
        }
    });
}

#[test]
fn what_is_hidden_later_has_its_own_look_until_then() {
    // In the scene `overlap` earlier fragments are replaced.
    with_view("overlap", [24, 24], Projection::Perspective, |view| {
        let film = Film::record("overlap", view, Method::Textbook, length(10)).unwrap();
        let [object_order, image_order] = &film.tracks;
        let hidden: Vec<_> = object_order.changes.iter().filter(|change| !change.stays).collect();
        assert!(!hidden.is_empty());
        assert!(hidden.iter().any(|change| {
            change.color != *object_order.picture.get_pixel(change.column, change.row)
        }));
        assert!(image_order.changes.iter().all(|change| change.stays), "a ray writes once");
    });
}

#[test]
fn too_much_is_refused_with_advice() {
    with_view("many", [640, 480], Projection::Perspective, |view| {
        let problem = Film::record("many", view, Method::Textbook, length(1)).unwrap_err();
        let text = problem.to_string();
        assert!(text.starts_with("the textbook would take 3"), "{text}");
        assert!(text.contains("take --method fast, or a --size of at most 1"), "{text}");
    });
    with_view("canonical", [4000, 4000], Projection::Perspective, |view| {
        let problem = Film::record("canonical", view, Method::Fast, length(1)).unwrap_err();
        assert_eq!(
            problem.to_string(),
            "a film shows pictures of at most 2,097,152 pixels, and 4000x4000 has 16,000,000; take a smaller --size"
        );
    });
}

/// The pictures of a GIF, one over the other, and their times.
fn gif_frames(bytes: &[u8]) -> Vec<(RgbImage, u16)> {
    let mut options = ::gif::DecodeOptions::new();
    options.set_color_output(::gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).unwrap();
    let mut canvas = RgbImage::new(decoder.width().into(), decoder.height().into());
    let mut frames = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        let width = usize::from(frame.width);
        for (k, pixel) in frame.buffer.chunks_exact(4).enumerate() {
            if pixel[3] > 0 {
                let x = u32::try_from(k % width).unwrap() + u32::from(frame.left);
                let y = u32::try_from(k / width).unwrap() + u32::from(frame.top);
                canvas.put_pixel(x, y, Rgb([pixel[0], pixel[1], pixel[2]]));
            }
        }
        frames.push((canvas.clone(), frame.delay));
    }
    frames
}

#[test]
fn a_gif_has_all_frames_and_nearly_their_colors() {
    with_view("canonical", [16, 12], Projection::Perspective, |view| {
        for (method, theme) in BOTH.into_iter().zip([Theme::Dark, Theme::Light]) {
            let film = Film::record("canonical", view, method, length(12)).unwrap();
            let write = || film.write_gif(Vec::new(), theme, 480, &mut |_| {}).unwrap();
            let bytes = write();
            assert_eq!(bytes, write(), "the same film has the same bytes");
            let decoded = gif_frames(&bytes);
            assert_eq!(decoded.len(), 12);
            for (k, ((shown, delay), drawn)) in
                decoded.iter().zip(film.frames(theme, 480)).enumerate()
            {
                assert_eq!(*delay, if k == 11 { 4 * 6 } else { 4 });
                let pairs = shown.iter().zip(drawn.iter());
                let far = pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap();
                assert!(far <= 40, "{far} in frame {k}");
            }
        }
    });
}

#[test]
fn an_animated_png_has_all_frames_exactly_and_shows_the_last_one_first() {
    with_view("canonical", [16, 12], Projection::Perspective, |view| {
        let film = Film::record("canonical", view, Method::Textbook, length(12)).unwrap();
        let mut bytes = Vec::new();
        film.write_apng(&mut bytes, Theme::Dark, 480, &mut |_| {}).unwrap();
        let drawn: Vec<RgbImage> = film.frames(Theme::Dark, 480).collect();
        let plain = image::load_from_memory(&bytes).unwrap().into_rgb8();
        assert_eq!(plain, drawn[11]);

        let mut reader = png::Decoder::new(io::Cursor::new(&bytes)).read_info().unwrap();
        assert_eq!(reader.info().animation_control.unwrap().num_frames, 12);
        let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut buffer).unwrap();
        let mut canvas = RgbImage::new(480, 270);
        for (k, drawn) in drawn.iter().enumerate() {
            reader.next_frame(&mut buffer).unwrap();
            let control = reader.info().frame_control.unwrap();
            let delay = if k == 11 { 24 } else { 4 };
            assert_eq!((control.delay_num, control.delay_den), (delay, 100));
            for (at, pixel) in (0..control.width * control.height).zip(buffer.chunks_exact(4)) {
                let (x, y) = (at % control.width, at / control.width);
                if pixel[3] > 0 {
                    let color = Rgb([pixel[0], pixel[1], pixel[2]]);
                    canvas.put_pixel(control.x_offset + x, control.y_offset + y, color);
                }
            }
            assert_eq!(&canvas, drawn, "frame {k}");
        }
    });
}

#[test]
fn no_text_of_a_page_leaves_it_or_overlaps_another() {
    for (scene, image) in [("lecture", [8, 6]), ("canonical", [5, 40]), ("many", [1, 1])] {
        with_view(scene, image, Projection::Perspective, |view| {
            for method in BOTH {
                let film = Film::record(scene, view, method, length(9)).unwrap();
                for shot in film.shots([[0; 3]; 2]) {
                    let drawing = code::page(&film, &shot).draw(Theme::Dark, 960);
                    assert_eq!(drawing.faults(), Vec::<String>::new(), "{scene}");
                }
            }
        });
    }
}
