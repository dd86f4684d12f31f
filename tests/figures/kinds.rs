//! Every kind of figure over every built-in scene: no text overlaps another or leaves the picture, the same input gives
//! the same bytes, and a second renderer draws the SVG as we draw the pixels.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use bothways::common::glam::Vec3;
use bothways::common::{Camera, CameraDescription, Mesh, Projection, Scene, Shape, Sphere, View};
use bothways::figure::{Drawing, Kind, Subject, Theme, work_maps};
use bothways::orders::{Method, Order, RenderOptions, Rules, render};
use bothways::scenes::{BUILT_IN, load};
use image::RgbImage;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

/// The size of the images in these figures.
const IMAGE: [u32; 2] = [20, 15];

fn camera(scene: &str, projection: Projection) -> (Scene, Camera) {
    let loaded = load(scene).unwrap();
    let mut description = CameraDescription { image: IMAGE, ..loaded.camera };
    if projection != description.projection {
        description.projection = projection;
        // Wide enough to see something, whatever the scene is.
        description.viewport =
            if projection == Projection::Parallel { [8.0, 6.0] } else { [1.6, 1.2] };
    }
    (loaded.scene, Camera::new(description).unwrap())
}

fn subject_of<'a>(
    (scene, camera): &'a (Scene, Camera),
    name: &'a str,
    theme: Theme,
) -> Subject<'a> {
    Subject {
        name,
        about: None,
        view: View::new(scene, camera),
        pixels: &[],
        samples: 1,
        rules: Rules::default(),
        theme,
    }
}

fn draw(kind: Kind, name: &str, subject: &(Scene, Camera), theme: Theme) -> Drawing {
    let drawn = kind.draw(&subject_of(subject, name, theme));
    drawn.unwrap_or_else(|error| panic!("{kind} of {name}: {error}"))
}

/// The picture that another renderer makes of an SVG file.
fn by_resvg(svg: &str, width: u32) -> RgbImage {
    let tree = Tree::from_str(svg, &Options::default()).expect("the file is well-formed");
    let scale = width as f32 / tree.size().width();
    let mut pixels = Pixmap::new(width, width * 9 / 16).unwrap();
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    RgbImage::from_fn(width, width * 9 / 16, |x, y| {
        let pixel = pixels.pixel(x, y).unwrap();
        image::Rgb([pixel.red(), pixel.green(), pixel.blue()])
    })
}

/// The mean difference of two pictures in steps of 255, and the part of pixels that differ by more than 64.
fn difference(one: &RgbImage, other: &RgbImage) -> (f64, f64) {
    let pixels = || one.pixels().zip(other.pixels());
    let steps = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| {
        (0..3).map(|channel| a[channel].abs_diff(b[channel])).max().unwrap_or(0)
    };
    let count = pixels().count() as f64;
    let mean = pixels().map(|pair| f64::from(steps(pair))).sum::<f64>() / count;
    (mean, pixels().filter(|pair| steps(*pair) > 64).count() as f64 / count)
}

/// Asserts that no text of any figure of any scene overlaps another one or leaves the picture.
fn check_texts(projection: Projection) {
    let mut faults = Vec::new();
    for scene in BUILT_IN {
        let subject = camera(scene.name, projection);
        for kind in Kind::ALL {
            let drawing = draw(kind, scene.name, &subject, Theme::Dark);
            let found = drawing.faults().into_iter();
            faults.extend(found.map(|fault| format!("{kind} of {}: {fault}", scene.name)));
        }
    }
    assert!(faults.is_empty(), "{projection:?}: {}", faults.join("\n"));
}

#[test]
fn no_text_of_a_perspective_figure_overlaps_another_or_leaves_the_picture() {
    check_texts(Projection::Perspective);
}

#[test]
fn no_text_of_a_parallel_figure_overlaps_another_or_leaves_the_picture() {
    check_texts(Projection::Parallel);
}

#[test]
fn another_renderer_draws_the_svg_as_we_draw_the_pixels() {
    for (scene, theme) in [("canonical", Theme::Dark), ("ties", Theme::Light)] {
        let subject = camera(scene, Projection::Perspective);
        for kind in Kind::ALL {
            let drawing = draw(kind, scene, &subject, theme);
            // Where enlarged pixels of a picture meet, each rounds to a side of its own.
            let (mean, part) = difference(&drawing.pixels(640), &by_resvg(&drawing.svg(), 640));
            assert!(
                mean < 2.0 && part < 0.012,
                "{kind} of {scene}: {mean:.2} of 255, {part:.4} of the pixels"
            );
        }
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let subject = camera("slivers", Projection::Perspective);
    for kind in Kind::ALL {
        let svg = || draw(kind, "slivers", &subject, Theme::Dark).svg();
        assert_eq!(svg(), svg(), "{kind}");
    }
}

#[test]
fn the_work_of_all_pixels_is_the_work_of_the_report() {
    for projection in [Projection::Perspective, Projection::Parallel] {
        let (scene, camera) = camera("overlap", projection);
        let view = View::new(&scene, &camera);
        for map in work_maps(&view) {
            let options = RenderOptions { no_times: true, ..RenderOptions::default() };
            let rendered = render(map.order, map.method, &view, &options).unwrap();
            let work = rendered.work().expect("it is counted");
            let total: u64 = map.counts.iter().sum();
            assert_eq!(total, work.tests + work.nodes, "{:?} {:?}", map.order, map.method);
            assert_eq!(map.counts.len(), map.size[0] * map.size[1]);
        }
        let maps = work_maps(&view);
        let uneven = |order: Order| {
            let fast = maps.iter().find(|map| map.order == order && map.method == Method::Fast);
            let counts = &fast.expect("both orders are counted").counts;
            counts.iter().min() < counts.iter().max()
        };
        assert!(uneven(Order::Object) && uneven(Order::Image));
    }
}

/// The scene with a texture that comes with the repository: its levels are drawn, with a column to look at.
#[test]
fn the_levels_of_a_floor_up_to_the_horizon_are_drawn() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/horizon/horizon.toml");
    let loaded = load(scene).unwrap();
    let camera = Camera::new(CameraDescription { image: [64, 48], ..loaded.camera }).unwrap();
    let subject = (loaded.scene, camera);
    for (theme, focus) in [(Theme::Dark, "#f0e442"), (Theme::Light, "#b03a86")] {
        let drawing = draw(Kind::Levels, "horizon", &subject, theme);
        assert_eq!(drawing.faults(), [""; 0], "{theme:?}");
        assert!(drawing.svg().contains(focus), "a column is framed");
    }
}

/// A sphere of radius 1 before the lecture's first camera.
fn sphere_at(z: f32, image: [u32; 2]) -> (Scene, Camera) {
    let sphere = Sphere { center: Vec3::new(0.0, 0.0, z), radius: 1.0 };
    let scene = Scene::new(vec![Shape::Sphere(sphere).into()]).unwrap();
    let [width, height] = image;
    (scene, Camera::canonical(height, width))
}

#[test]
fn levels_say_why_there_is_no_column_to_look_at() {
    let drawn = |subject| draw(Kind::Levels, "sphere", subject, Theme::Dark);
    for (subject, says) in [
        (&sphere_at(-1.001, [900, 900]), "All samples read level 0"),
        (&sphere_at(-100.0, [1, 1]), "All samples read the last level"),
        (&sphere_at(-3.0, [3, 3]), "No surface that reads between two levels is five rows high"),
    ] {
        let drawing = drawn(subject);
        assert_eq!(drawing.faults(), [""; 0], "{says}");
        assert!(drawing.svg().contains(says), "{says}");
    }

    let corners = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, -3.0));
    let mesh = Mesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
    let (scene, camera) =
        (Scene::new(vec![Shape::Mesh(mesh).into()]).unwrap(), Camera::canonical(9, 9));
    let refused = Kind::Levels.draw(&subject_of(&(scene, camera), "mesh", Theme::Dark));
    let error = refused.unwrap_err().to_string();
    assert!(error.contains("nothing that is seen has texture coordinates"), "{error}");
}

/// The camera from the side shows surfaces as lines, however few rows the picture has.
#[test]
fn a_picture_of_few_rows_has_a_profile_all_the_same() {
    let lines = |rows: u32| {
        let (scene, camera) = camera("canonical", Projection::Perspective);
        let description = CameraDescription { image: [rows; 2], ..*camera.description() };
        let subject = (scene, Camera::new(description).unwrap());
        let svg = draw(Kind::Camera, "canonical", &subject, Theme::Dark).svg();
        svg.matches(r##"stroke="#eef1f4" stroke-width="4""##).count()
    };
    let all = lines(481);
    for rows in [1, 2, 5, 100] {
        let few = lines(rows);
        assert!(few.abs_diff(all) < all / 3, "{rows} rows: {few} lines, not {all}");
    }
}
