//! Slides of extreme pictures: the size never changes, and no text runs into another.

use super::*;
use crate::common::{Camera, Executed, Frame, Options, Work};
use crate::diff::compare;
use crate::orders::{Counts, Method, Order, Spread, Times};
use crate::picture::picture;

fn rendered(order: Order, [width, height]: [u32; 2], count: u64, seen: bool) -> Rendered {
    let mut frame = Frame::new(&Camera::canonical(height, width), &Options::default());
    if seen {
        frame.set(frame.height() - 1, frame.width() / 2, 0, 1.0);
    }
    let work = Work {
        primitives: count,
        rays: count,
        nodes: count,
        tests: count,
        fragments: count,
        depth_tests: count,
        judged_coverage: count / 2,
        judged_nearest: count / 2,
    };
    let spread = Spread { median: 12_345.0, min: 1.0, max: 99_999.0 };
    let times = Some(Times { prepare: spread, visibility: spread, shading: spread });
    let executed = Executed {
        tiles: count,
        nodes_opened: count,
        boxes_tested: count,
        clusters_skipped: count,
        set_ups: count,
        blocks: count / 2,
        lane_steps: count / 2,
        single_samples: count,
        ..Executed::default()
    };
    let (work, executed) = (Counts::Counted(work), Some(executed));
    Rendered { order, method: Method::Fast, rule: None, frame, work, executed, times }
}

fn slide(scene: &str, size: [u32; 2], count: u64, match_: bool) -> RgbImage {
    let object_order = rendered(Order::Object, size, count, true);
    let image_order = rendered(Order::Image, size, count, match_);
    let comparison = compare(&object_order.frame, &image_order.frame);
    let pictures = [&object_order, &image_order].map(|one| picture(&one.frame));
    let slide = Slide {
        scene,
        about: Some(scene),
        primitives: u64::MAX - 1,
        threads: 128,
        object_order: &object_order,
        image_order: &image_order,
        pictures: pictures.each_ref(),
        comparison: &comparison,
    };
    let drawing = slide.draw(Theme::Dark);
    let whole = drawing.pixels(1920);
    let bands: Vec<RgbImage> = drawing.bands(1920).collect();
    // Some end between lines of text.
    let first = bands[0].height();
    assert!(bands[..bands.len() - 1].iter().any(|band| band.height() != first));
    assert!(bands.iter().flat_map(|band| band.iter()).eq(whole.iter()), "{scene}");
    whole
}

#[test]
fn times_are_those_of_the_table_without_shading() {
    let mut rendered = rendered(Order::Object, [4, 3], 1, true);
    let times = rendered.times.as_mut().unwrap();
    times.prepare.median = 1.5;
    times.visibility.median = 22.25;
    times.shading.median = 333.0;
    let [work, executed] = figures(&rendered).try_into().ok().expect("there are two groups");
    let has_times = |group: &Group| group.rows.iter().any(|(label, _)| label.contains("time"));
    assert!(!has_times(&work));
    let expected = [("time to prepare", "1.50 ms"), ("time for visibility", "22.2 ms")];
    let expected = expected.map(|(label, time)| (label, time.to_owned()));
    assert_eq!(executed.rows[executed.rows.len() - 2..], expected);
    rendered.times = None;
    assert!(!figures(&rendered).iter().any(has_times));
}

#[test]
fn the_two_sorts_of_counts_stand_apart_under_their_names() {
    let headings = |rendered: &Rendered| {
        let headings = figures(rendered).into_iter().map(|group| group.heading);
        headings.map(Option::unwrap_or_default).collect::<Vec<_>>()
    };
    let object_order = rendered(Order::Object, [4, 3], 20, true);
    let two = ["work for each primitive alone", "executed in 20 tiles"];
    assert_eq!(headings(&object_order), two);
    let mut image_order = rendered(Order::Image, [4, 3], 1, true);
    assert_eq!(headings(&image_order), ["work for each ray alone", "executed in 1 tile"]);
    image_order.executed = None;
    assert_eq!(headings(&image_order), ["work for each ray alone"]);
    image_order.work = Counts::LeftOut;
    assert_eq!(headings(&image_order), [""]);
}

#[test]
fn the_line_about_the_scene_is_drawn_below_its_name() {
    let lines = |about: Option<&str>| {
        let object_order = rendered(Order::Object, [4, 3], 1, true);
        let image_order = rendered(Order::Image, [4, 3], 1, true);
        let comparison = compare(&object_order.frame, &image_order.frame);
        let (primitives, threads) = (1, 1);
        let (object_order, image_order, comparison) = (&object_order, &image_order, &comparison);
        let pictures = [object_order, image_order].map(|one| picture(&one.frame));
        let pictures = pictures.each_ref();
        let slide = Slide {
            scene: "a",
            about,
            primitives,
            threads,
            object_order,
            image_order,
            pictures,
            comparison,
        };
        let slide = slide.draw(Theme::Dark).pixels(1920);
        [85..118, 120..152].map(|y| !is_blank(&slide, 72..400, y))
    };
    assert_eq!(lines(None), [true, false]);
    assert_eq!(lines(Some("What there is to see.")), [true, true]);
    // A very long name takes no time, and every letter is handled.
    assert_eq!(lines(Some(&"茶壺\u{202e}\u{7}".repeat(200_000))), [true, true]);
}

/// Whether nothing is drawn in an upright strip.
fn is_blank(slide: &RgbImage, x: std::ops::Range<u32>, y: std::ops::Range<u32>) -> bool {
    y.into_iter().all(|y| x.clone().all(|x| slide.get_pixel(x, y).0 == Theme::Dark.background()))
}

#[test]
fn margins_and_gutters_stay_blank() {
    let long = "a scene whose name goes on and on ".repeat(8);
    for (scene, size, count, match_) in [
        ("lecture", [640, 480], 1_234_567, true),
        (long.as_str(), [1, 1], 0, false),
        ("wide", [2000, 3], 9_999_999, true),
        ("tall", [3, 2000], 999_999_999_999_999, false),
    ] {
        let slide = slide(scene, size, count, match_);
        assert_eq!([slide.width(), slide.height()], [1920, 1080]);
        for x in [0..70, 1850..1920] {
            assert!(is_blank(&slide, x, 0..1080), "{scene}: a margin");
        }
        for x in [642..674, 1246..1278] {
            assert!(is_blank(&slide, x, 150..976), "{scene}: a gutter");
        }
        assert!(is_blank(&slide, 0..1920, 0..32) && is_blank(&slide, 0..1920, 1046..1080));
    }
}

#[test]
fn work_that_was_not_counted_has_its_rows() {
    let of = |work| {
        let (executed, rendered) = (None, rendered(Order::Image, [4, 4], 1, true));
        let [group] = figures(&Rendered { work, executed, ..rendered }).try_into().ok().unwrap();
        group
    };
    let Group { heading, rows } = of(Counts::TooMany { most: 1_074_790_400 });
    let shown = rows.iter().take(2).map(|(label, figure)| format!("{label}: {figure}"));
    let expected = ["work for a frame: not counted", "it is more than: 1,074,790,400 steps"];
    assert_eq!((shown.collect::<Vec<_>>(), heading), (expected.map(String::from).to_vec(), None));
    assert!(of(Counts::LeftOut).rows.iter().all(|(label, _)| label.starts_with("time")));
}

#[test]
fn one_differing_pixel_of_millions_is_seen() {
    let slide = slide("large", [2400, 1350], 1, false);
    let column = 1280..1848;
    let found = (282..708)
        .flat_map(|y| column.clone().map(move |x| (x, y)))
        .any(|(x, y)| slide.get_pixel(x, y).0 == Class::OnlyObjectOrder.color());
    assert!(found);
}
